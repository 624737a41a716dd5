// SPDX-License-Identifier: Apache-2.0
// The parameters that all kernels of a frame share (shared/frame.h): made from a frame of the host,
// and held in a uniform buffer.
#pragma once

#include <cstring>

#include <glm/mat3x3.hpp>
#include <glm/mat4x4.hpp>

#include "gpu/kernel.h"
#include "shared/frame.h"
#include "surfaces/host_gbuffer.h"
#include "surfaces/radiance_format.h"
#include "surfaces/stored_depth.h"

namespace candelabra::surfaces
{

// Returns the parameters of a frame, apart from sampleCount and sampleSeed, which are 0. `frame` is
// a CndLightingFrame or a CndEnvironmentFrame, whose camera has passed checkCamera. Throws
// gpu::Failure if the projection is none that projectionOf takes.
template <typename Frame>
gpu::FrameParams frameParams(const Frame& frame, const GBufferSource& gbuffer,
                             VkFormat radianceFormat)
{
    const CndGBufferDesc& desc = gbuffer.desc();
    const FrameDepth depth = frameDepth(desc.depthKind, frame.camera, frame.clearDepth);
    glm::dmat4 viewFromWorld;
    std::memcpy(&viewFromWorld, frame.camera.viewFromWorld, sizeof viewFromWorld);
    return {.viewFromWorld = glm::mat3(glm::dmat3(viewFromWorld)),
            .projection = depth.projection,
            .size = {frame.width, frame.height},
            .invImageSize = 1.0f / glm::vec2(frame.width, frame.height),
            .clearDepth = depth.clear,
            .dielectricF0 = gbuffer.dielectricF0(),
            .lobes =
                uint32_t(frame.lobes) | (frame.energyCompensation ? gpu::COMPENSATE_ENERGY : 0),
            .largestRadiance = largestRadiance(radianceFormat),
            .constantRoughness = desc.constantRoughness,
            .constantMetalness = desc.constantMetalness,
            .firstTexel = {frame.x, frame.y},
            .firstDepthTexel = {frame.x, frame.y}};
}

// A uniform buffer with room for the parameters of one frame per frame slot.
class FrameUniforms
{
public:
    // `device` must outlive it.
    FrameUniforms(const gpu::Device& device, uint32_t slots);
    // The GPU must have finished the slot's previous frame.
    void write(uint32_t slot, const gpu::FrameParams& params) const noexcept;
    // Returns the parameters of the slot as the binding FRAME_PARAMS.
    gpu::Binding at(uint32_t slot) const;

private:
    // The offset of each slot is a multiple of this, the largest minUniformBufferOffsetAlignment
    // that Vulkan allows a device.
    static constexpr VkDeviceSize stride = 256;
    static_assert(sizeof(gpu::FrameParams) <= stride);
    gpu::Buffer buffer_;
};

} // namespace candelabra::surfaces
