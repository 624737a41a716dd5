// SPDX-License-Identifier: Apache-2.0
// Draws a frame of a scene by linearly transformed cosines, which compete with the engine's closed
// forms. The functions of shaders/bench/ltc evaluate every area light at every pixel.
#pragma once

#include <vector>

#include "measure/kernels/light_kernels.h"
#include "render/renderer.h"
#include "shared/lighting_data.h"
#include "surfaces/frame_uniforms.h"
#include "surfaces/host_gbuffer.h"
#include "tables/dfg_table.h"

namespace candelabra::app
{

class LtcFrame
{
public:
    // Prepares for one frame that `renderer` draws of `scene`; both must outlive the object. The
    // area lights of the scene are of types that rivalKnows().
    LtcFrame(const VulkanContext& context, Renderer& renderer, const Scene& scene,
             const FrameOptions& options);

    // Draws the frame. The radiance ends as after Renderer::record. Returns the GPU time in ms of
    // the kernels that evaluate area lights, 0 on devices without timestamps.
    double draw();

private:
    // The area lights of one type, in view space.
    struct OfType {
        DeviceLights lights;
        gpu::Kernel<gpu::LightBatch> kernel;
        gpu::Bindings bindings;
    };
    void add(uint32_t lightType, const std::vector<CndLight>& lights);

    const VulkanContext& context_;
    Renderer& renderer_;
    FrameOptions options_;
    CndLightingFrame frame_;
    surfaces::GBufferSource gbuffer_;
    gpu::Timer timer_;
    tables::DfgTable dfg_;
    gpu::Buffer ltcTable_;
    surfaces::FrameUniforms uniforms_;
    std::vector<CndLight> punctual_; // lights without a size, which the engine evaluates
    std::vector<OfType> types_;
};

} // namespace candelabra::app
