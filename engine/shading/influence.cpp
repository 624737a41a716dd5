// SPDX-License-Identifier: Apache-2.0
#include "shading/influence.h"

#include <algorithm>
#include <atomic>
#include <cmath>

#include "candelabra_shaders.h"
#include "lights/light_types.h"
#include "shading/brute_rects.h"
#include "shared/exposure_data.h"
#include "surfaces/radiance_format.h"

namespace candelabra::lighting
{
namespace
{

static_assert(gpu::TONEMAP_REINHARD == CND_TONEMAP_REINHARD);
static_assert(gpu::TONEMAP_ACES == CND_TONEMAP_ACES);
static_assert(gpu::TONEMAP_PBR_NEUTRAL == CND_TONEMAP_PBR_NEUTRAL);
static_assert(gpu::TONEMAP_AGX == CND_TONEMAP_AGX);

// The display error that sampled pixels may have, as a share of the error that all pixels may have:
// pixels between the samples have larger errors (DECISIONS 30).
constexpr float sampleShare = 0.5f;

// Returns a number that marks one history of cuts in device memory. No two histories of the process
// have the same number, and memory that was never written is unlikely to hold it by chance.
uint32_t nextOwner() noexcept
{
    static std::atomic<uint32_t> next{0x1F10E4CEu};
    return next++;
}

glm::uvec2 squares(glm::uvec2 size, uint32_t spacing)
{
    return {gpu::divideUp(size.x, spacing), gpu::divideUp(size.y, spacing)};
}

uint32_t area(glm::uvec2 size)
{
    return size.x * size.y;
}

VkDeviceSize sumBytes(uint32_t samples)
{
    return VkDeviceSize(samples) * gpu::INFLUENCE_SLOTS * sizeof(glm::vec3);
}

uint32_t spacingOf(glm::uvec2 size)
{
    uint32_t spacing = gpu::INFLUENCE_MIN_SPACING;
    while (area(squares(size, spacing)) > gpu::INFLUENCE_MAX_SAMPLES)
        spacing *= 2;
    return spacing;
}

} // namespace

CndInfluenceRule influenceOf(const CndLightingFrame& frame)
{
    const CndInfluence& i = frame.influence;
    const bool measured = frame.culling != CND_CULLING_BRUTE && i.exposure > 0;
    return i.rule == CND_INFLUENCE_BY_ERROR && !measured ? CND_INFLUENCE_UNCUT : i.rule;
}

void checkInfluence(const CndInfluence& i, bool byError)
{
    if (uint32_t(i.rule) > CND_INFLUENCE_BY_ERROR)
        gpu::failArgument("CndLightingFrame: influence.rule is not a CndInfluenceRule");
    if (i.rule != CND_INFLUENCE_BY_ERROR)
        return;
    if (!byError)
        gpu::failArgument("CndLightingFrame: influence.rule BY_ERROR needs "
                          "CndLightingDesc::influenceByError");
    if (!(i.maxError > 0 && i.maxError <= 1))
        gpu::failArgument("CndLightingFrame: influence.maxError must be above 0 and at most 1");
    if (!(i.exposure >= 0 && std::isfinite(i.exposure)))
        gpu::failArgument("CndLightingFrame: influence.exposure must be finite and >= 0");
    if (uint32_t(i.toneMap) >= CND_TONEMAP_COUNT)
        gpu::failArgument("CndLightingFrame: influence.toneMap is not a CndToneMap");
}

InfluenceKernels::InfluenceKernels(const gpu::Device& device, VkFormat radianceFormat)
    : choose(device, surfaces::addingTo(radianceFormat, spirv::choose_influence_comp,
                                        gpu::CHOOSE_INFLUENCE_RADIANCE)),
      cutLights(device, spirv::cut_lights_comp)
{
}

Influence::Influence(const gpu::Device& device, const InfluenceKernels& kernels, uint32_t slots,
                     glm::uvec2 maxSize)
    : kernels_(kernels),
      measure_(device, *spirv::measure_influence_comp[0], slots), // the same in all families
      choose_(kernels.choose.createBindings(slots)),
      cut_(kernels.cutLights.createBindings(slots))
{
    const uint32_t samples =
        std::min(area(squares(maxSize, gpu::INFLUENCE_MIN_SPACING)), gpu::INFLUENCE_MAX_SAMPLES);
    constexpr VkBufferUsageFlags use =
        VK_BUFFER_USAGE_STORAGE_BUFFER_BIT | VK_BUFFER_USAGE_TRANSFER_DST_BIT;
    data_ = gpu::createBuffer(device, "influence", sizeof(gpu::InfluenceData), use,
                              gpu::MemoryUse::Device);
    sums_ = gpu::createBuffer(device, "influence sums", sumBytes(samples), use,
                              gpu::MemoryUse::Scratch);
}

void Influence::writeBindings(uint32_t slot, const Inputs& in) const
{
    using namespace gpu;
    const surfaces::GBufferViews& g = in.gbuffer;
    measure_.write(slot,
                   {Binding::ofTexels(LIGHT_CORE_TEXELS, in.core), Binding::of(LIGHT_CORE, in.core),
                    Binding::of(SHADE_SHAPES, in.shapes), Binding::of(SHADE_LIGHT_IDS, in.ids),
                    Binding::sampled(SHADE_DEPTH, g.depth), in.uniforms.at(slot),
                    Binding::ofTexels(SHADE_DFG, in.directionalAlbedo),
                    Binding::of(MEASURE_INFLUENCE_DATA, data_),
                    Binding::of(MEASURE_INFLUENCE_SUMS, sums_)},
                   g.bindings());
    choose_.write(slot, {Binding::of(CHOOSE_INFLUENCE_DATA, data_),
                         Binding::of(CHOOSE_INFLUENCE_SUMS, sums_),
                         Binding::sampled(CHOOSE_INFLUENCE_DEPTH, g.depth),
                         Binding::storage(CHOOSE_INFLUENCE_RADIANCE, in.radiance)});
    cut_.write(slot, {Binding::of(CUT_LIGHTS_DATA, data_), Binding::of(CUT_LIGHTS_CORE, in.core),
                      Binding::of(CUT_LIGHTS_SHAPES, in.shapes),
                      Binding::of(CUT_LIGHTS_COUNTERS, in.counters)});
}

uint32_t Influence::recordBegin(const gpu::Frame& f, const CndLightingFrame& frame,
                                const gpu::FrameParams& params) noexcept
{
    const glm::uvec2 size{frame.width, frame.height};
    const bool begins = maxError_ != frame.influence.maxError;
    if (begins)
        frame_.owner = nextOwner();
    maxError_ = frame.influence.maxError;
    frame_.size = size;
    frame_.spacing = spacingOf(size);
    frame_.rounds = std::min(frame_.spacing * frame_.spacing, gpu::INFLUENCE_MAX_ROUNDS);
    frame_.samples = squares(size, frame_.spacing);
    frame_.previous = 1 - frame_.previous;
    frame_.toneMap = uint32_t(frame.influence.toneMap);
    frame_.clearDepth = frame.clearDepth;
    frame_.exposure = frame.influence.exposure;
    frame_.maxError = sampleShare * maxError_;
    frame_.firstTexel = params.firstTexel;
    frame_.firstDepthTexel = params.firstDepthTexel;
    struct {
        gpu::InfluenceFrame frame;
        uint32_t allowed;
    } const terms{frame_, gpu::INFLUENCE_BINS - 1};
    static_assert(sizeof terms == offsetof(gpu::InfluenceData, states));
    f.device.CmdUpdateBuffer(f.cmd, data_.get(), 0, sizeof terms, &terms);
    f.barrier();
    return begins ? frame_.rounds : 1;
}

void Influence::recordRound(const gpu::Frame& f) const noexcept
{
    f.device.CmdFillBuffer(f.cmd, sums_.get(), 0, sumBytes(area(frame_.samples)), 0);
    f.barrier();
}

void Influence::recordMeasure(const gpu::Frame& f, const MeasureKernel& kernel,
                              gpu::MeasureInfluenceParams params) const noexcept
{
    constexpr uint32_t perGroup = gpu::MEASURE_INFLUENCE_GROUP / gpu::MEASURE_INFLUENCE_LANES;
    const uint32_t groups = gpu::divideUp(area(frame_.samples), perGroup);
    const uint64_t most =
        std::max<uint64_t>(brutePairsPerDispatch / params.batch.count / perGroup, 1);
    for (uint32_t done = 0; done < groups;) {
        const uint32_t some = uint32_t(std::min<uint64_t>(most, groups - done));
        params.firstSample = done * perGroup;
        kernel.dispatch(f, measure_.set(f.slot), params, some);
        done += some;
    }
    f.barrier();
}

void Influence::recordChoice(const gpu::Frame& f, uint32_t round) const noexcept
{
    const uint32_t samples = area(frame_.samples);
    kernels_.choose.dispatch(f, choose_.set(f.slot), {samples, round},
                             gpu::divideUp(samples, gpu::CHOOSE_INFLUENCE_GROUP));
    f.barrier();
}

void Influence::recordCut(const gpu::Frame& f, const LightTypeCounts& types,
                          const TreeShapes& lights) const noexcept
{
    for (uint32_t type = 0; type < CND_LIGHT_TYPE_COUNT; ++type)
        if (types[type] && !isDistant(type))
            kernels_.cutLights.dispatch(
                f, cut_.set(f.slot), {lights[type].firstLight, lights[type].lightCount, type},
                gpu::divideUp(lights[type].lightCount, gpu::CUT_LIGHTS_GROUP));
    f.barrier();
}

} // namespace candelabra::lighting
