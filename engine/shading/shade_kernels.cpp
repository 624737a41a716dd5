// SPDX-License-Identifier: Apache-2.0
#include "shading/shade_kernels.h"

#include <iterator>
#include <utility>

#include "candelabra_shaders.h"
#include "lights/light_limits.h"
#include "shading/light_family.h"
#include "surfaces/radiance_format.h"

namespace candelabra::lighting
{

// The CMake build has compiled this kernel for every family of shared/light_types.h.
static_assert(std::size(spirv::shade_tiles_comp) == gpu::FAMILY_COUNT);

uint32_t tileClassesOf(const CndLightingDesc& desc)
{
    static_assert(CND_MATERIAL_DIFFUSE_ONLY << 1 == 1u << gpu::CLASS_DIFFUSE &&
                  CND_MATERIAL_SPECULAR_ONLY << 1 == 1u << gpu::CLASS_SPECULAR);
    const bool weighsSpecular = desc.gbufferLayout == CND_GBUFFER_FULL ||
                                desc.gbufferLayout == CND_GBUFFER_CUSTOM ||
                                (desc.gbufferLayout == CND_GBUFFER_HOST &&
                                 desc.gbuffer.reflectance == CND_REFLECTANCE_SPECULAR &&
                                 desc.gbuffer.f90 != CND_CHANNEL_NONE);
    const uint32_t stored =
        desc.materialClasses & ~uint32_t(weighsSpecular ? 0 : CND_MATERIAL_DIFFUSE_ONLY);
    return 1u << gpu::CLASS_ANY | stored << 1;
}

uint32_t shadingOf(const CndLightingFrame& frame)
{
    const bool brute = frame.culling == CND_CULLING_BRUTE;
    uint32_t out = brute ? CND_SHADING_BRUTE_BIT : CND_SHADING_CLUSTERED_BIT;
    if (frame.countPairs && !brute)
        out |= CND_SHADING_COUNT_PAIRS_BIT;
    if (frame.errorBudget > 0 && isClosedForm(frame.specularMethod))
        out |= CND_SHADING_ERROR_BUDGET_BIT;
    return out;
}

ShadeKernels::ShadeKernels(const gpu::Device& device, const surfaces::HostKernels& host,
                           uint32_t gbuffer, const CndLightingDesc& desc)
    : device_(&device),
      host_(&host),
      gbuffer_(gbuffer),
      radianceFormat_(desc.radianceFormat),
      tileClasses_(tileClassesOf(desc)),
      measures_(desc.influenceByError)
{
    add(desc.lightTypes | 1u << CND_LIGHT_SPHERE, desc.specularMethods, desc.shading);
}

bool ShadeKernels::add(uint32_t lightTypes, uint32_t methods, uint32_t shading)
{
    bool created = false;
    for (const Job& job : jobsOf(lightTypes, methods, shading))
        created |= run(job);
    for (uint32_t method = 0; method < CND_SPECULAR_METHOD_COUNT; ++method)
        if (methods >> method & 1)
            allowed_[method].fetch_or(shading);
    return created;
}

// Notes what is wanted, also for calls on other threads that have not finished, and returns what is
// missing of it for these light types and for these methods.
std::vector<ShadeKernels::Job> ShadeKernels::jobsOf(uint32_t lightTypes, uint32_t methods,
                                                    uint32_t shading)
{
    const std::lock_guard lock(mutex_);
    std::vector<Job> out;
    wantedTypes_ |= lightTypes;
    for (uint32_t method = 0; method < CND_SPECULAR_METHOD_COUNT; ++method) {
        const bool asked = methods >> method & 1;
        if (asked)
            wanted_[method] |= shading;
        for (uint32_t type = 0; type < CND_LIGHT_TYPE_COUNT; ++type)
            if (asked ? wantedTypes_ >> type & 1 : lightTypes >> type & 1)
                addJobs(out, type, CndSpecularMethod(method), wanted_[method]);
    }
    return out;
}

// Adds the jobs of what is missing for a type, a method and a mask of CndShadingBits.
void ShadeKernels::addJobs(std::vector<Job>& jobs, uint32_t lightType, CndSpecularMethod asked,
                           uint32_t shading) const
{
    const auto add = [&](const Job& job) {
        const Slot& slot = slots_[job.lightType][job.method][job.withBudget];
        if (!(slot.made.load() & job.bit()))
            jobs.push_back(job);
    };
    const auto addTiles = [&](CndSpecularMethod method, bool withBudget, uint32_t tileClass) {
        if (shading & CND_SHADING_CLUSTERED_BIT)
            add({lightType, method, withBudget, Lists, tileClass});
        if (shading & CND_SHADING_COUNT_PAIRS_BIT)
            add({lightType, method, withBudget, Counts, tileClass});
    };
    const CndSpecularMethod method = canonicalMethod(lightType, asked);
    const bool budget = shading & CND_SHADING_ERROR_BUDGET_BIT && takesBudget(lightType, method);
    for (const bool withBudget : {false, true}) {
        if (withBudget && !budget)
            continue;
        for (const uint32_t tileClass : {gpu::CLASS_ANY, gpu::CLASS_SPECULAR})
            if (tellsApart(tileClass))
                addTiles(method, withBudget, tileClass);
        if (shading & CND_SHADING_BRUTE_BIT)
            add({lightType, method, withBudget, Brute});
        if (measures_ && !withBudget && shading & CND_SHADING_CLUSTERED_BIT)
            add({lightType, method, withBudget, Measure});
    }
    if (tellsApart(gpu::CLASS_DIFFUSE))
        addTiles(CND_SPECULAR_NONE, false, gpu::CLASS_DIFFUSE);
}

// Returns false if the job has been done, by this or by another thread.
bool ShadeKernels::run(const Job& job)
{
    Slot& slot = slots_[job.lightType][job.method][job.withBudget];
    if (slot.made.load() & job.bit())
        return false;
    Variant made = make(job);
    const std::lock_guard lock(mutex_);
    if (slot.made.load() & job.bit())
        return false;
    Tiles &from = made.tiles[job.tileClass], &to = slot.kernels.tiles[job.tileClass];
    switch (job.part) {
    case Lists:
        to.shade = std::move(from.shade);
        to.unlisted = std::move(from.unlisted);
        break;
    case Counts:
        to.countPairs = std::move(from.countPairs);
        break;
    case Brute:
        slot.kernels.brute = std::move(made.brute);
        break;
    case Measure:
        slot.kernels.measure = std::move(made.measure);
        break;
    }
    slot.made.fetch_or(job.bit());
    return true;
}

ShadeKernels::Variant ShadeKernels::make(const Job& job) const
{
    Variant out;
    Tiles& tiles = out.tiles[job.tileClass];
    switch (job.part) {
    case Lists:
        tiles.shade = makeKernel<gpu::ShadeTilesParams>(spirv::shade_tiles_comp, job);
        tiles.unlisted = makeKernel<gpu::ShadeUnlistedParams>(spirv::shade_unlisted_comp, job);
        break;
    case Counts:
        tiles.countPairs = makeKernel<gpu::CountPairsParams>(spirv::count_pairs_comp, job);
        break;
    case Brute:
        out.brute = makeKernel<gpu::ShadeBruteParams>(spirv::shade_brute_comp, job);
        break;
    case Measure:
        out.measure = makeKernel<gpu::MeasureInfluenceParams>(spirv::measure_influence_comp, job);
        break;
    }
    return out;
}

template <typename Params>
gpu::Kernel<Params> ShadeKernels::makeKernel(std::span<const gpu::Spirv* const> families,
                                             const Job& job) const
{
    const gpu::Spirv* kernel = &host_->of(*families[familyOf(job.lightType, job.method)]);
    if (device_->lanesAreCpuVector && kernel == spirv::shade_tiles_comp[gpu::FAMILY_CONIC])
        kernel = &spirv::shade_tiles_comp_lanes_alone_conic;
    const gpu::FormattedSpirv code =
        surfaces::addingTo(radianceFormat_, *kernel, gpu::SHADE_RADIANCE);
    return gpu::Kernel<Params>(*device_, code,
                               {{gpu::SPEC_LIGHTS_AS_TEXELS, lightsAsTexels(*device_)},
                                {gpu::SPEC_SPECULAR_METHOD, uint32_t(job.method)},
                                {gpu::SPEC_LIGHT_TYPE, job.lightType},
                                {gpu::SPEC_GBUFFER, gbuffer_},
                                {gpu::SPEC_ERROR_BUDGET, job.withBudget},
                                {gpu::SPEC_TILE_CLASS, job.tileClass},
                                {gpu::SPEC_LANES_TOGETHER, !device_->lanesAreCpuVector}},
                               host_->setLayout());
}

const ShadeKernels::Variant& ShadeKernels::variant(uint32_t type, CndSpecularMethod method,
                                                   bool withBudget) const
{
    const CndSpecularMethod m = canonicalMethod(type, method);
    return slots_[type][m][withBudget && takesBudget(type, m)].kernels;
}

const ShadeKernels::Tiles& ShadeKernels::tiles(uint32_t type, CndSpecularMethod method,
                                               bool withBudget, uint32_t tileClass) const
{
    if (tileClass == gpu::CLASS_DIFFUSE) // it has no specular lobe, so all methods are the same
        return slots_[type][CND_SPECULAR_NONE][0].kernels.tiles[tileClass];
    return variant(type, method, withBudget).tiles[tileClass];
}

} // namespace candelabra::lighting
