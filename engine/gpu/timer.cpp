// SPDX-License-Identifier: Apache-2.0
#include "gpu/timer.h"

#include <array>

namespace candelabra::gpu
{
namespace
{
constexpr uint32_t stampsPerSlot = CND_MAX_KERNEL_TIMES + 1;
} // namespace

Timer::Timer(const Device& device, const char* name, uint32_t slots, bool enabled)
    : device_(&device), slots_(slots)
{
    if (!enabled || !device.limits.timestampComputeAndGraphics)
        return;
    const VkQueryPoolCreateInfo info{.sType = VK_STRUCTURE_TYPE_QUERY_POOL_CREATE_INFO,
                                     .queryType = VK_QUERY_TYPE_TIMESTAMP,
                                     .queryCount = slots * stampsPerSlot};
    VkQueryPool pool{};
    check(device.CreateQueryPool(device.handle, &info, device.allocationCallbacks, &pool),
          std::string("creating the timestamp pool of ") + name);
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
    device_->CmdWriteTimestamp2(cmd, VK_PIPELINE_STAGE_2_ALL_COMMANDS_BIT, pool_.get(),
                                slot * stampsPerSlot);
}

void Timer::stamp(VkCommandBuffer cmd, const char* name) noexcept
{
    Slot& slot = slots_[current_];
    if (!pool_ || slot.count == CND_MAX_KERNEL_TIMES)
        return;
    slot.names[slot.count++] = name;
    device_->CmdWriteTimestamp2(cmd, VK_PIPELINE_STAGE_2_ALL_COMMANDS_BIT, pool_.get(),
                                current_ * stampsPerSlot + slot.count);
}

bool Timer::read(uint32_t slotIndex, CndKernelTime* times, uint32_t& count) const noexcept
{
    const Slot& slot = slots_[slotIndex];
    count = slot.count;
    if (!pool_ || !count)
        return true;
    std::array<uint64_t, stampsPerSlot> ticks{};
    if (device_->GetQueryPoolResults(device_->handle, pool_.get(), slotIndex * stampsPerSlot,
                                     count + 1, sizeof ticks, ticks.data(), sizeof ticks[0],
                                     VK_QUERY_RESULT_64_BIT) != VK_SUCCESS)
        return false;
    const double msPerTick = double(device_->limits.timestampPeriod) * 1e-6;
    for (uint32_t i = 0; i < count; ++i)
        times[i] = {slot.names[i], double(ticks[i + 1] - ticks[i]) * msPerTick};
    return true;
}

} // namespace candelabra::gpu
