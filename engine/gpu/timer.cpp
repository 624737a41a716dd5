// SPDX-License-Identifier: Apache-2.0
#include "gpu/timer.h"

#include <algorithm>
#include <array>
#include <cstring>

namespace candelabra::gpu
{
namespace
{
constexpr uint32_t stampsPerSlot = Timer::maxScopes + 1;

// Returns a mask of the timestamp bits that are valid on every queue that can dispatch, because the
// host may use any of them. Differences are taken modulo this mask, since narrow counters wrap.
uint64_t validBits(const Device& device)
{
    uint32_t count = 0;
    device.GetPhysicalDeviceQueueFamilyProperties(device.physicalDevice, &count, nullptr);
    std::vector<VkQueueFamilyProperties> families(count);
    device.GetPhysicalDeviceQueueFamilyProperties(device.physicalDevice, &count, families.data());
    uint32_t bits = 64;
    for (const VkQueueFamilyProperties& f : families)
        if (f.queueFlags & (VK_QUEUE_GRAPHICS_BIT | VK_QUEUE_COMPUTE_BIT))
            bits = std::min(bits, f.timestampValidBits);
    return bits < 64 ? (uint64_t(1) << bits) - 1 : ~uint64_t(0);
}
} // namespace

Timer::Timer(const Device& device, const char* name, uint32_t slots, bool enabled)
    : device_(&device), slots_(slots)
{
    if (!enabled)
        return;
    if (!device.limits.timestampComputeAndGraphics) {
        device.say(CND_MESSAGE_WARNING,
                   "%s: timestamps were asked for, but not all queues of the device have them: "
                   "there will be no kernel times",
                   name);
        return;
    }
    tickMask_ = validBits(device);
    const VkQueryPoolCreateInfo info{.sType = VK_STRUCTURE_TYPE_QUERY_POOL_CREATE_INFO,
                                     .queryType = VK_QUERY_TYPE_TIMESTAMP,
                                     .queryCount = slots * stampsPerSlot};
    VkQueryPool pool{};
    check(device.CreateQueryPool(device.handle, &info, device.allocationCallbacks, &pool),
          "creating the timestamp pool of ", name);
    pool_ = Handle(device, pool);
    device.name(VK_OBJECT_TYPE_QUERY_POOL, pool, std::string(name) + " timestamps");
}

void Timer::begin(VkCommandBuffer cmd, uint32_t slot) noexcept
{
    current_ = slot;
    slots_[slot].count = 0;
    if (!pool_)
        return;
    device_->CmdResetQueryPool(cmd, pool_.get(), slot * stampsPerSlot, stampsPerSlot);
    device_->CmdWriteTimestamp(cmd, VK_PIPELINE_STAGE_ALL_COMMANDS_BIT, pool_.get(),
                               slot * stampsPerSlot);
}

void Timer::stamp(VkCommandBuffer cmd, const char* name) noexcept
{
    if (!pool_) // an empty Timer, whose slots_ is empty too, has no pool either
        return;
    Slot& slot = slots_[current_];
    if (slot.count == maxScopes)
        return;
    slot.names[slot.count++] = name;
    device_->CmdWriteTimestamp(cmd, VK_PIPELINE_STAGE_ALL_COMMANDS_BIT, pool_.get(),
                               current_ * stampsPerSlot + slot.count);
}

CndResult Timer::read(uint32_t slotIndex, CndKernelTime* times, uint32_t& count) const noexcept
{
    const Slot& slot = slots_[slotIndex];
    count = 0;
    if (!pool_ || !slot.count)
        return CND_SUCCESS;
    std::array<uint64_t, stampsPerSlot> ticks{};
    const CndResult result = resultOf(device_->GetQueryPoolResults(
        device_->handle, pool_.get(), slotIndex * stampsPerSlot, slot.count + 1, sizeof ticks,
        ticks.data(), sizeof ticks[0], VK_QUERY_RESULT_64_BIT));
    if (result != CND_SUCCESS)
        return result;
    const double msPerTick = double(device_->limits.timestampPeriod) * 1e-6;
    for (uint32_t i = 0; i < slot.count; ++i) {
        const double ms = double((ticks[i + 1] - ticks[i]) & tickMask_) * msPerTick;
        const auto row = std::find_if(times, times + count, [&](const CndKernelTime& t) {
            return std::strcmp(t.name, slot.names[i]) == 0;
        });
        if (row != times + count)
            row->ms += ms;
        else if (count < CND_MAX_KERNEL_TIMES)
            times[count++] = {slot.names[i], ms};
    }
    return CND_SUCCESS;
}

} // namespace candelabra::gpu
