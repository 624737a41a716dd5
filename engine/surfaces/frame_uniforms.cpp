// SPDX-License-Identifier: Apache-2.0
#include "surfaces/frame_uniforms.h"

namespace candelabra::surfaces
{

FrameUniforms::FrameUniforms(const gpu::Device& device, uint32_t slots)
    : buffer_(gpu::createBuffer(device, "frame parameters", slots * stride,
                                VK_BUFFER_USAGE_UNIFORM_BUFFER_BIT, gpu::MemoryUse::Upload))
{
}

void FrameUniforms::write(uint32_t slot, const gpu::FrameParams& params) const noexcept
{
    std::memcpy(buffer_.mapped + slot * stride, &params, sizeof params);
}

gpu::Binding FrameUniforms::at(uint32_t slot) const
{
    return {.binding = gpu::FRAME_PARAMS,
            .buffer = buffer_.get(),
            .offset = slot * stride,
            .range = sizeof(gpu::FrameParams)};
}

} // namespace candelabra::surfaces
