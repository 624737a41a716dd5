// SPDX-License-Identifier: Apache-2.0
#include "render/frame_stamps.h"

#include "render/check.h"

namespace candelabra::app
{

FrameStamps::FrameStamps(const gpu::Device& device, uint32_t validBits, uint32_t slots,
                         uint32_t parts)
    : device_(&device), perSlot_(parts + 1), taken_(slots)
{
    if (!validBits)
        return;
    mask_ = validBits < 64 ? (uint64_t(1) << validBits) - 1 : ~uint64_t(0);
    const VkQueryPoolCreateInfo info{.sType = VK_STRUCTURE_TYPE_QUERY_POOL_CREATE_INFO,
                                     .queryType = VK_QUERY_TYPE_TIMESTAMP,
                                     .queryCount = slots * perSlot_};
    VkQueryPool pool{};
    check(vkCreateQueryPool(device.handle, &info, nullptr, &pool), "creating timestamps");
    pool_ = gpu::Handle(device, pool);
    device.name(VK_OBJECT_TYPE_QUERY_POOL, pool, "frame timestamps");
}

void FrameStamps::begin(VkCommandBuffer cmd, uint32_t slot)
{
    if (!pool_)
        return;
    vkCmdResetQueryPool(cmd, pool_.get(), slot * perSlot_, perSlot_);
    taken_[slot] = 0;
    stamp(cmd, slot);
}

void FrameStamps::stamp(VkCommandBuffer cmd, uint32_t slot)
{
    if (pool_)
        vkCmdWriteTimestamp2(cmd, VK_PIPELINE_STAGE_2_ALL_COMMANDS_BIT, pool_.get(),
                             slot * perSlot_ + taken_[slot]++);
}

std::vector<double> FrameStamps::read(uint32_t slot) const
{
    if (!count(slot))
        return {};
    std::vector<uint64_t> ticks(taken_[slot]);
    check(vkGetQueryPoolResults(device_->handle, pool_.get(), slot * perSlot_, taken_[slot],
                                ticks.size() * sizeof ticks[0], ticks.data(), sizeof ticks[0],
                                VK_QUERY_RESULT_64_BIT),
          "reading timestamps");
    const double msPerTick = double(device_->limits.timestampPeriod) * 1e-6;
    std::vector<double> out;
    for (size_t i = 1; i < ticks.size(); ++i)
        out.push_back(double((ticks[i] - ticks[0]) & mask_) * msPerTick);
    return out;
}

} // namespace candelabra::app
