// SPDX-License-Identifier: Apache-2.0
// Radii of influence that follow from an error of the display (CND_INFLUENCE_BY_ERROR,
// shared/influence_data.h): what a view stores for this, and the passes that compute the radii.
// They run after prepare_lights and before every pass that reads radii.
#pragma once

#include "candelabra/candelabra.h"
#include "clusters/clusters.h"
#include "gpu/kernel.h"
#include "shared/influence_data.h"
#include "shared/lighting_data.h"
#include "surfaces/host_gbuffer.h"

namespace candelabra::lighting
{

// Returns the rule that a frame follows. It is CND_INFLUENCE_UNCUT instead of
// CND_INFLUENCE_BY_ERROR for brute force and for frames without an exposure.
CndInfluenceRule influenceOf(const CndLightingFrame& frame);
// Throws gpu::Failure naming the first member outside its documented range. `byError`:
// CndLightingDesc::influenceByError.
void checkInfluence(const CndInfluence& influence, bool byError);

// The kernels that know no light type. Those that measure are in ShadeKernels, one for each light
// type and specular method.
struct InfluenceKernels {
    InfluenceKernels() = default;
    InfluenceKernels(const gpu::Device& device, VkFormat radianceFormat);
    gpu::Kernel<gpu::ChooseInfluenceParams> choose;
    gpu::Kernel<gpu::CutLightsParams> cutLights;
};

class Influence
{
public:
    using MeasureKernel = gpu::Kernel<gpu::MeasureInfluenceParams>;
    // `maxSize`: largest size of a frame in pixels. `kernels` must outlive this object.
    Influence(const gpu::Device& device, const InfluenceKernels& kernels, uint32_t slots,
              glm::uvec2 maxSize);

    struct Inputs {
        const surfaces::GBufferViews& gbuffer;
        const surfaces::FrameUniforms& uniforms;
        VkImageView radiance;
        const gpu::Buffer &core, &shapes, &ids, &directionalAlbedo, &counters;
    };
    void writeBindings(uint32_t slot, const Inputs& inputs) const;

    // These functions are called in this order, and each ends with a barrier. recordBegin returns
    // the number of rounds. Every round takes one call of recordRound, one of recordMeasure per
    // light type and batch of lights, and one of recordChoice. recordCut follows the last round.
    uint32_t recordBegin(const gpu::Frame& f, const CndLightingFrame& frame,
                         const gpu::FrameParams& params) noexcept;
    void recordRound(const gpu::Frame& f) const noexcept;
    void recordMeasure(const gpu::Frame& f, const MeasureKernel& kernel,
                       gpu::MeasureInfluenceParams params) const noexcept;
    void recordChoice(const gpu::Frame& f, uint32_t round) const noexcept;
    // `types`: number of lights by type, 0 for types that the frame leaves out. At least one type
    // that is not distant is present.
    void recordCut(const gpu::Frame& f, const LightTypeCounts& types,
                   const TreeShapes& lights) const noexcept;

private:
    const InfluenceKernels& kernels_;
    gpu::InfluenceFrame frame_{}; // the frame recorded last
    float maxError_ = 0;          // CndInfluence::maxError of the frame recorded last
    gpu::Buffer data_, sums_;
    gpu::Bindings measure_, choose_, cut_; // per slot
};

} // namespace candelabra::lighting
