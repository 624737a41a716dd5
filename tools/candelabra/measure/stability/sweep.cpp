// SPDX-License-Identifier: Apache-2.0
#include "measure/stability/sweep.h"

#include <algorithm>
#include <cmath>

#include <fmt/format.h>

#include "candelabra_bench_shaders.h"
#include "measure/kernels/vectors.h"
#include "measure/stability/inexact_division.h"
#include "scene/polygons.h"

namespace candelabra::app
{
namespace
{

// Lanes of a dispatch. They are a second of work at most on a software device.
constexpr uint32_t maxLanes = 1u << 20;

gpu::Kernel<gpu::SweepParams> makeKernel(const gpu::Device& device, const Evaluation& evaluation,
                                         uint32_t seed, bool inexactDivision)
{
    gpu::Spirv spirv = ofFamily(spirv::sweep_inputs_comp, evaluation);
    std::vector<uint32_t> words;
    if (inexactDivision) {
        words = withInexactDivision(spirv.words, seed);
        spirv.words = words;
    }
    return {device,
            spirv,
            {{gpu::SPEC_SPECULAR_METHOD, evaluation.method.specular},
             {gpu::SPEC_LIGHT_TYPE, evaluation.lightType}}};
}

gpu::Buffer makeRecords(const gpu::Device& device, size_t count)
{
    return gpu::createBuffer(device, "sweep records", count * sizeof(gpu::SweepRecord),
                             VK_BUFFER_USAGE_STORAGE_BUFFER_BIT, gpu::MemoryUse::Readback);
}

std::string text(const glm::vec3& v)
{
    return fmt::format("({}, {}, {})", v.x, v.y, v.z);
}

std::string text(const glm::vec4& v)
{
    return fmt::format("({}, {}, {}, {})", v.x, v.y, v.z, v.w);
}

} // namespace

const char* sliceText(uint32_t slice)
{
    static constexpr const char* texts[] = {
#define X(id, NAME, words) words,
        CND_SWEEP_SLICES(X)
#undef X
    };
    static_assert(std::size(texts) == sweepSliceCount);
    return texts[slice];
}

Sweep::Sweep(const VulkanContext& context, const Evaluation& evaluation, uint32_t seed,
             bool inexactDivision)
    : context_(context),
      evaluation_(evaluation),
      seed_(seed),
      kernel_(makeKernel(context.device(), evaluation, seed, inexactDivision)),
      bindings_(kernel_.createBindings(1)),
      counters_(gpu::createBuffer(context.device(), "sweep counters", sizeof(gpu::SweepCounters),
                                  VK_BUFFER_USAGE_STORAGE_BUFFER_BIT, gpu::MemoryUse::Readback)),
      bad_(makeRecords(context.device(), gpu::SWEEP_MAX_BAD)),
      timer_(context.device(), "sweep", 1, false)
{
}

void Sweep::dispatch(const gpu::SweepParams& params, const gpu::Buffer& records)
{
    bindings_.write(0, {gpu::Binding::of(gpu::SWEEP_OUTPUT, records),
                        gpu::Binding::of(gpu::SWEEP_COUNTERS, counters_)});
    counters_.as<gpu::SweepCounters>()[0] = {};
    context_.submitAndWait([&](VkCommandBuffer cmd) {
        timer_.begin(cmd, 0);
        kernel_.dispatch(gpu::Frame{context_.device(), cmd, timer_, 0}, bindings_.set(0), params,
                         gpu::divideUp(params.count, gpu::BENCH_GROUP));
        shaderToHostBarrier(context_.device(), cmd);
    });
}

SweepCount Sweep::count(uint32_t slice, uint32_t first, uint64_t configurations,
                        const std::function<void(uint64_t)>& onDone)
{
    SweepCount out;
    while (out.tried < configurations) {
        const auto lanes = uint32_t(std::min<uint64_t>(configurations - out.tried, maxLanes));
        dispatch({.count = lanes,
                  .slice = slice,
                  .seed = seed_,
                  .firstIndex = first + uint32_t(out.tried),
                  .sampleCount = evaluation_.sampleCount},
                 bad_);
        const gpu::SweepCounters& c = counters_.as<gpu::SweepCounters>()[0];
        out.tried += lanes;
        out.nan += c.nan;
        out.infinite += c.infinite;
        out.negative += c.negative;
        out.above += c.above;
        const auto records = bad_.as<gpu::SweepRecord>();
        for (uint32_t i = 0; i < std::min(c.bad, gpu::SWEEP_MAX_BAD) && out.bad.size() < 4; ++i)
            out.bad.push_back(records[i]);
        onDone(lanes);
    }
    return out;
}

std::vector<gpu::SweepRecord> Sweep::record(uint32_t slice, uint32_t first, uint32_t configurations)
{
    const gpu::Buffer records = makeRecords(context_.device(), configurations);
    dispatch({.count = configurations,
              .slice = slice,
              .seed = seed_,
              .firstIndex = first,
              .sampleCount = evaluation_.sampleCount,
              .recordAll = 1},
             records);
    const auto values = records.as<gpu::SweepRecord>();
    return {values.begin(), values.begin() + configurations};
}

CndLight lightOf(const gpu::SweepRecord& r, uint32_t lightType)
{
    CndLight light{.type = lightType, .emission = {1, 1, 1}};
    light.influenceRadius = INFINITY;
    const glm::vec3 centre(r.centreRadius);
    set(light.position, centre - r.position);
    light.radius = r.shape.radius;
    set(light.axisU, r.shape.axisU);
    set(light.axisV, r.shape.axisV);
    set(light.direction, cndIsDistant(lightType) ? -centre : r.shape.axisU);
    light.twoSided = (r.shape.flags & gpu::LIGHT_TWO_SIDED) != 0;
    if (lightType == CND_LIGHT_POLYGON)
        light.polygon = regularPolygon(uint32_t(r.shape.radius));
    return light;
}

std::string describeRecord(const gpu::SweepRecord& r)
{
    return fmt::format(
        "index {}: position {}, n {}, v {}, perceptualRoughness {}, centre and bounding "
        "radius {}, emission and squared influence {}, axes {} {}, radius {}, two-sided {}; "
        "response {}",
        r.index, text(r.position), text(r.n), text(r.v), r.perceptualRoughness,
        text(r.centreRadius), text(r.emissionInfluence), text(r.shape.axisU), text(r.shape.axisV),
        r.shape.radius, (r.shape.flags & gpu::LIGHT_TWO_SIDED) != 0, text(r.response));
}

} // namespace candelabra::app
