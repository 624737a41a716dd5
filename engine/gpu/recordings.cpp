// SPDX-License-Identifier: Apache-2.0
#include "gpu/recordings.h"

namespace candelabra::gpu
{

uint64_t Recordings::oldest(uint64_t (RecordingSlots::*ofView)() const) const
{
    uint64_t result = last_ + 1;
    for (const RecordingSlots* view : views_)
        if (const uint64_t recording = (view->*ofView)())
            result = std::min(result, recording);
    return result;
}

uint64_t Recordings::oldestRunning() const
{
    return oldest(&RecordingSlots::oldestRunning);
}

uint64_t Recordings::oldestPending() const
{
    return oldest(&RecordingSlots::oldestPending);
}

void Recordings::freeRetired()
{
    const uint64_t pending = oldestPending();
    std::erase_if(retired_, [&](const Retired& r) { return r.lastUser < pending; });
}

RecordingSlots::RecordingSlots(Recordings& recordings, const Device& device,
                               const std::string& name, uint32_t count, VkDeviceSize readBytes)
    : recordings_(recordings), readBytes_(readBytes)
{
    for (uint32_t slot = 0; slot < count; ++slot) {
        slots_.push_back({createBuffer(device, name, readBytes + sizeof(uint32_t),
                                       VK_BUFFER_USAGE_TRANSFER_DST_BIT, MemoryUse::Readback)});
        // Memory that is used again may hold the marker of an earlier view's recording.
        marker(slot) = 0;
    }
    recordings.views_.push_back(this);
}

uint32_t& RecordingSlots::marker(uint32_t slot) const
{
    return slots_[slot].readback.as<uint32_t>()[readBytes_ / sizeof(uint32_t)];
}

uint64_t RecordingSlots::begin(uint32_t slot) noexcept
{
    return slots_[slot].recording = ++recordings_.last_;
}

void RecordingSlots::recordEnd(const Frame& f, const Buffer& from) const noexcept
{
    const VkBuffer target = slots_[f.slot].readback.get();
    const VkBufferCopy copy{.size = readBytes_};
    f.device.CmdCopyBuffer(f.cmd, from.get(), target, 1, &copy);
    f.barrier(); // the marker says that everything before it is done
    f.device.CmdFillBuffer(f.cmd, target, readBytes_, sizeof(uint32_t),
                           uint32_t(slots_[f.slot].recording));
    f.hostBarrier();
}

bool RecordingSlots::hasRun(uint32_t slot) const
{
    return hasArrived(marker(slot), uint32_t(slots_[slot].recording));
}

uint64_t RecordingSlots::oldestRunning() const
{
    uint64_t oldest = 0;
    for (uint32_t slot = 0; slot < count(); ++slot) {
        const uint64_t recording = slots_[slot].recording;
        if (recording && !hasRun(slot) && (!oldest || recording < oldest))
            oldest = recording;
    }
    return oldest;
}

uint64_t RecordingSlots::oldestPending() const
{
    uint64_t oldest = 0;
    for (const Slot& slot : slots_)
        if (slot.recording && (!oldest || slot.recording < oldest))
            oldest = slot.recording;
    return oldest;
}

} // namespace candelabra::gpu
