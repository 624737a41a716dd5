// SPDX-License-Identifier: Apache-2.0
// Radii of influence from an error (CND_INFLUENCE_BY_ERROR): what a view keeps for it, and the
// passes between prepare_lights and everything that reads how far lights reach
// (shared/influence.h).
#pragma once

#include "candelabra/candelabra.h"
#include "clusters/clusters.h"
#include "gpu/kernel.h"
#include "shared/influence.h"
#include "shared/lighting.h"
#include "surfaces/host_gbuffer.h"

namespace candelabra::lighting
{

// The rule that a frame follows: brute force and frames without an exposure cut nothing.
CndInfluenceRule influenceOf(const CndLightingFrame& frame);
// Throws gpu::Failure. `byError`: CndLightingDesc::influenceByError.
void checkInfluence(const CndInfluence& influence, bool byError);

// Besides those that measure: shading has one for every light type and method.
struct InfluenceKernels {
    InfluenceKernels() = default;
    explicit InfluenceKernels(const gpu::Device& device);
    gpu::Kernel<gpu::ChooseInfluenceParams> choose;
    gpu::Kernel<gpu::CutLightsParams> cutLights;
};

class Influence
{
public:
    using MeasureKernel = gpu::Kernel<gpu::MeasureInfluenceParams>;
    // `measure`: a kernel of ShadeKernels, since binding layouts are the same for all. `maxSize`:
    // pixels of frames. `kernels` must outlive it.
    Influence(const gpu::Device& device, const InfluenceKernels& kernels,
              const MeasureKernel& measure, uint32_t slots, glm::uvec2 maxSize);

    struct Inputs {
        const surfaces::GBufferViews& gbuffer;
        const surfaces::FrameUniforms& uniforms;
        VkImageView radiance;
        const gpu::Buffer &core, &shapes, &ids, &directionalAlbedo, &transformedCosines, &counters;
    };
    void writeBindings(uint32_t slot, const Inputs& inputs) const;

    // They are called in this order, and each ends with a barrier. All but the first and the last
    // are called once per round, recordMeasure as often as lights need it. Returns the rounds.
    uint32_t recordBegin(const gpu::Frame& f, const CndLightingFrame& frame) noexcept;
    void recordRound(const gpu::Frame& f) const noexcept;
    void recordMeasure(const gpu::Frame& f, const MeasureKernel& kernel,
                       const gpu::MeasureInfluenceParams& params) const noexcept;
    void recordChoice(const gpu::Frame& f, uint32_t round) const noexcept;
    // `types`: those of the frame, not 0; one has a place at least.
    void recordCut(const gpu::Frame& f, const LightTypeCounts& types,
                   const TreeShapes& lights) const noexcept;

private:
    const InfluenceKernels& kernels_;
    gpu::InfluenceFrame frame_{}; // recorded last
    float maxError_ = 0;          // of the history
    gpu::Buffer data_, sums_;
    gpu::Bindings measure_, choose_, cut_; // per slot
};

} // namespace candelabra::lighting
