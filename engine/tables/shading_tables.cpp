// SPDX-License-Identifier: Apache-2.0
#include "tables/shading_tables.h"

#include "tables/ltc_table.h"

namespace candelabra::tables
{
namespace
{

gpu::Buffer createLtcBuffer(const gpu::Device& device)
{
    const VkDeviceSize bytes = ltcTable().size_bytes();
    constexpr VkDeviceSize maxUpdate = 65536; // bytes, the limit of vkCmdUpdateBuffer
    static_assert(gpu::LTC_TABLE_SIZE * gpu::LTC_TABLE_SIZE * gpu::LTC_TEXELS * sizeof(glm::vec4) <=
                  maxUpdate);
    gpu::Buffer out = gpu::createBuffer(device, "transformed cosines", bytes,
                                        VK_BUFFER_USAGE_UNIFORM_TEXEL_BUFFER_BIT |
                                            VK_BUFFER_USAGE_TRANSFER_DST_BIT,
                                        gpu::MemoryUse::Device);
    gpu::createTexelView(device, out);
    return out;
}

} // namespace

ShadingTables::ShadingTables(const gpu::Device& device)
    : dfg_(device), ltc_(createLtcBuffer(device))
{
}

void ShadingTables::record(const gpu::Frame& frame, bool directionalAlbedo) noexcept
{
    if (directionalAlbedo)
        dfg_.recordFill(frame);
    if (ltcFilled_)
        return;
    ltcFilled_ = true;
    const std::span<const float> transformedCosines = ltcTable();
    frame.device.CmdUpdateBuffer(frame.cmd, ltc_.get(), 0, transformedCosines.size_bytes(),
                                 transformedCosines.data());
}

} // namespace candelabra::tables
