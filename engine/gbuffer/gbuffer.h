// SPDX-License-Identifier: Apache-2.0
// GBuffer: the default raster pass. It culls and draws a Geometry, exact planes and balls, and
// visible area lights into the G-buffer that the lighting module reads.
#pragma once

#include <cstdint>
#include <memory>
#include <span>
#include <vector>

#include "candelabra/candelabra.h"
#include "gbuffer/geometry.h"
#include "gbuffer/mesh_variant.h"
#include "gbuffer/targets.h"
#include "gpu/device.h"

namespace candelabra::gbuffer
{

struct GBufferDesc {
    uint32_t framesInFlight = 2; // 1..8
    CndGBufferLayout layout = CND_GBUFFER_FULL;
    bool timestamps = false; // timer rows: cull_instances, compact_instances, cull_emitters,
                             // cull_triangles, gbuffer_raster
};

// Smaller than what separates two samples, so that edges move by less than they do when the camera
// moves by half a pixel.
constexpr float defaultMaxLevelError = 0.25f; // pixels

struct FrameInputs {
    uint32_t slot = 0; // 0..framesInFlight-1; the GPU must have finished the slot's previous frame
    CndCamera camera;
    float clearDepth = 0;         // 0: reversed depth, compared with GREATER; 1: compared with LESS
    float background[3]{0, 0, 0}; // luminance of pixels without a surface, cd/m^2
    Attachments attachments;
    uint32_t width = 0, height = 0; // pixels, at most the size of the images
    bool cullInstances = true;      // false: draw every instance (to check the culling)
    bool cullTriangles = true;      // false: draw every triangle and light (to check the culling)
    // The coarser levels of meshes are drawn where they are off by no more than this, in pixels.
    float maxLevelError = defaultMaxLevelError;
    // The number of this frame among several that are averaged. Surfaces of Coverage::Dithered
    // cover other pixels in each, so that their average has each pixel covered by the right share.
    uint32_t coverageFrame = 0;
    bool drawInstances = true;
    bool drawAnalytic = true;
    bool drawEmitters = true;
};

// Each frame slot holds one frame, so use one GBuffer per view. Submit all frames to one queue.
class GBuffer
{
public:
    // Throws gpu::Failure.
    GBuffer(const gpu::Device& device, const GBufferDesc& desc);
    ~GBuffer();
    GBuffer(GBuffer&&) noexcept;
    GBuffer& operator=(GBuffer&&) noexcept;

    // Creates the pipelines that drawing `geometry` needs and that do not exist yet. Call it before
    // the first recording with that geometry. Throws gpu::Failure.
    void prepare(const Geometry& geometry);
    // The same for given variants of meshes.
    void prepare(std::span<const MeshVariant> variants);

    // Sets the area lights to show; punctual lights are skipped. Positions are relative to
    // `origin`. The dark back of a one-sided light is not drawn. Distant spheres are drawn where
    // there is no surface; if several overlap, the last one is visible. The lights are read before
    // the call returns and shown from the next recording on. May allocate memory when their number
    // grows. Throws gpu::Failure; then the previous set stays.
    void setEmitters(std::span<const CndLight> lights, const double origin[3]);

    // Tells whether frames leave out the emitters of the present set that cover no sample.
    bool cullsEmitters() const;
    // If so, the draws of the last frame of `slot`, a VkDrawIndirectCommand each.
    std::vector<DrawRange> emitterDraws(uint32_t slot) const;

    // Records one frame, outside a render pass. On entry the attachments may be in any state: their
    // contents are discarded, and all earlier work is waited for. On exit normalRoughness, albedo,
    // specular and depth are in SHADER_READ_ONLY_OPTIMAL and radiance in GENERAL, visible to
    // COMPUTE_SHADER as CndLightingFrame requires. Changes graphics and compute state of the
    // command buffer.
    void record(VkCommandBuffer cmd, const Geometry& geometry, const FrameInputs& in) noexcept;

    // Writes the kernel times of the last frame recorded in `slot` to an array of
    // CND_MAX_KERNEL_TIMES. The host must have waited for that frame. Returns false if the device
    // cannot tell the times.
    bool times(uint32_t slot, CndKernelTime* times, uint32_t& count) const noexcept;

private:
    struct Impl;
    std::unique_ptr<Impl> impl_;
};

} // namespace candelabra::gbuffer
