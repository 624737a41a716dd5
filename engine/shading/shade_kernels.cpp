// SPDX-License-Identifier: Apache-2.0
#include "shading/shade_kernels.h"

#include <iterator>
#include <utility>

#include "candelabra_shaders.h"
#include "clusters/clusters.h"
#include "lights/light_limits.h"
#include "shading/light_batches.h"
#include "shading/light_family.h"
#include "surfaces/radiance_format.h"

namespace candelabra::lighting
{

// The CMake build has compiled this kernel for every family of shared/light_type_list.h.
static_assert(std::size(spirv::shade_tiles_comp) == gpu::FAMILY_COUNT);
// pixelOfLane() of shaders/lib/tile_pixels.glsl knows the pixels of such a tile only.
static_assert(gpu::TILE_SIZE == 8);

bool findsDiffuseTiles(const CndLightingDesc& desc)
{
    const bool weighsSpecular = desc.gbufferLayout == CND_GBUFFER_FULL ||
                                desc.gbufferLayout == CND_GBUFFER_CUSTOM ||
                                (desc.gbufferLayout == CND_GBUFFER_HOST &&
                                 desc.gbuffer.reflectance == CND_REFLECTANCE_SPECULAR &&
                                 desc.gbuffer.f90 != CND_CHANNEL_NONE);
    return desc.diffuseOnlyTiles && weighsSpecular;
}

uint32_t shadingOf(const CndLightingFrame& frame)
{
    const bool brute = frame.culling == CND_CULLING_BRUTE;
    uint32_t out = brute ? CND_SHADING_BRUTE_BIT : CND_SHADING_CLUSTERED_BIT;
    if (frame.countPairs && !brute)
        out |= CND_SHADING_COUNT_PAIRS_BIT;
    return out;
}

ShadeKernels::ShadeKernels(const gpu::Device& device, const surfaces::HostKernels& host,
                           uint32_t gbuffer, const CndLightingDesc& desc)
    : device_(&device),
      host_(&host),
      gbuffer_(gbuffer),
      radianceFormat_(desc.radianceFormat),
      findsDiffuse_(findsDiffuseTiles(desc)),
      measures_(desc.influenceByError),
      shadowPoints_(desc.shadows.points)
{
    add(desc.lightTypes | 1u << CND_LIGHT_SPHERE, desc.specularMethods, desc.shading);
}

// A call of add() that has not ended. Of two calls on different threads, such as one for a light
// type and one for a method, the later one makes what only both together need.
class ShadeKernels::Running
{
public:
    Running(ShadeKernels& kernels, const Request& request) : kernels_(kernels)
    {
        const std::lock_guard lock(kernels.mutex_);
        jobs = kernels.jobsOf(request);
        at_ = kernels.running_.insert(kernels.running_.end(), request);
    }
    ~Running()
    {
        const std::lock_guard lock(kernels_.mutex_);
        kernels_.running_.erase(at_);
    }
    Running(const Running&) = delete;
    Running& operator=(const Running&) = delete;

    std::vector<Job> jobs;

private:
    ShadeKernels& kernels_;
    std::list<Request>::const_iterator at_;
};

uint32_t ShadeKernels::add(uint32_t lightTypes, uint32_t methods, uint32_t shading)
{
    if (!methods && !(lightTypes & ~knownTypes_.load()))
        return 0;
    const Request request{lightTypes, methods, shading};
    const Running running(*this, request);
    uint32_t created = 0;
    for (const Job& job : running.jobs)
        if (runJob(job))
            created |= 1u << job.lightType;
    publish(request, running.jobs);
    return created;
}

// Returns the jobs whose pipelines the request needs, beside the existing ones and those that other
// threads are making. Some of the jobs may have been done.
std::vector<ShadeKernels::Job> ShadeKernels::jobsOf(const Request& request) const
{
    uint32_t types = knownTypes_.load() | request.lightTypes;
    for (const Request& other : running_)
        types |= other.lightTypes;
    std::vector<Job> out;
    for (uint32_t method = 0; method < CND_SPECULAR_METHOD_COUNT; ++method) {
        const bool asked = request.methods >> method & 1;
        uint32_t shading = allowed_[method].load() | (asked ? request.shading : 0);
        for (const Request& other : running_)
            if (other.methods >> method & 1)
                shading |= other.shading;
        for (uint32_t type = 0; type < CND_LIGHT_TYPE_COUNT; ++type)
            if ((asked ? types : request.lightTypes) >> type & 1)
                addJobs(out, type, CndSpecularMethod(method), shading);
    }
    return out;
}

// Lets frames and later requests know of a request all of whose jobs have been done.
void ShadeKernels::publish(const Request& request, const std::vector<Job>& jobs)
{
    const std::lock_guard lock(mutex_);
    for (const Job& job : jobs)
        for (const gpu::Spirv* kernel : kernelsOf(job))
            if (kernel)
                host_->used(*kernel);
    knownTypes_.fetch_or(request.lightTypes);
    for (uint32_t method = 0; method < CND_SPECULAR_METHOD_COUNT; ++method)
        if (request.methods >> method & 1)
            allowed_[method].fetch_or(request.shading);
}

// Adds the jobs for a type, a method and a mask of CndShadingBits.
void ShadeKernels::addJobs(std::vector<Job>& jobs, uint32_t lightType, CndSpecularMethod asked,
                           uint32_t shading) const
{
    const auto want = [&](const Job& job) { jobs.push_back(job); };
    const auto addTiles = [&](CndSpecularMethod method, uint32_t tileClass) {
        if (shading & CND_SHADING_CLUSTERED_BIT)
            want({lightType, method, Lists, tileClass});
        if (shading & CND_SHADING_COUNT_PAIRS_BIT)
            want({lightType, method, Counts, tileClass});
    };
    const CndSpecularMethod method = canonicalMethod(lightType, asked);
    addTiles(method, gpu::CLASS_ANY);
    if (shading & CND_SHADING_BRUTE_BIT)
        want({lightType, method, Brute});
    if (measures_ && shading & CND_SHADING_CLUSTERED_BIT)
        want({lightType, method, Measure});
    if (shadowPoints_)
        want({lightType, CND_SPECULAR_NONE, Visibility});
    if (findsDiffuse_)
        addTiles(CND_SPECULAR_NONE, gpu::CLASS_DIFFUSE);
}

// Returns false if the job has been done, by this or by another thread.
bool ShadeKernels::runJob(const Job& job)
{
    Slot& slot = slots_[job.lightType][job.method];
    if (slot.made.load() & job.bit())
        return false;
    Variant made = make(job);
    const std::lock_guard lock(mutex_);
    if (slot.made.load() & job.bit())
        return false;
    Tiles &from = made.tiles[job.tileClass], &to = slot.kernels.tiles[job.tileClass];
    switch (job.part) {
    case Lists:
        std::ranges::move(from.shade, to.shade);
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
    case Visibility:
        std::ranges::move(made.visibility, slot.kernels.visibility);
        break;
    }
    slot.made.fetch_or(job.bit());
    return true;
}

// Returns the built-in kernels of a job: shade and unlisted of Lists, and one kernel and null of
// other parts.
std::array<const gpu::Spirv*, 2> ShadeKernels::kernelsOf(const Job& job) const
{
    const uint32_t family = familyOf(job.lightType, job.method);
    switch (job.part) {
    case Lists:
        if (shadowPoints_)
            return {spirv::shade_tiles_comp_shadows[family],
                    spirv::shade_unlisted_comp_shadows[family]};
        return {spirv::shade_tiles_comp[family], spirv::shade_unlisted_comp[family]};
    case Counts:
        return {spirv::count_pairs_comp[family], nullptr};
    case Brute:
        return {shadowPoints_ ? spirv::shade_brute_comp_shadows[family]
                              : spirv::shade_brute_comp[family],
                nullptr};
    case Visibility:
        return {&spirv::pair_visibility_comp_sphere, nullptr};
    case Measure:
        break;
    }
    return {spirv::measure_influence_comp[family], nullptr};
}

ShadeKernels::Variant ShadeKernels::make(const Job& job) const
{
    const auto kernels = kernelsOf(job);
    Variant out;
    Tiles& tiles = out.tiles[job.tileClass];
    switch (job.part) {
    case Lists:
        for (uint32_t height = 0; height < tileHeightsOf(*device_, job.lightType); ++height)
            tiles.shade[height] = makeKernel<gpu::ShadeTilesParams>(*kernels[0], job, height);
        tiles.unlisted = makeKernel<gpu::ShadeUnlistedParams>(*kernels[1], job);
        break;
    case Counts:
        tiles.countPairs = makeKernel<gpu::CountPairsParams>(*kernels[0], job);
        break;
    case Brute:
        out.brute = makeKernel<gpu::ShadeBruteParams>(*kernels[0], job);
        break;
    case Measure:
        out.measure = makeKernel<gpu::MeasureInfluenceParams>(*kernels[0], job);
        break;
    case Visibility:
        for (uint32_t kind = 0; kind < pairKinds(job.lightType); ++kind)
            out.visibility[kind] =
                makeKernel<gpu::PairVisibilityParams>(*kernels[0], job, gpu::ANY_HEIGHT, kind);
        break;
    }
    return out;
}

template <typename Params>
gpu::Kernel<Params> ShadeKernels::makeKernel(const gpu::Spirv& builtIn, const Job& job,
                                             uint32_t height, uint32_t pairKind) const
{
    const gpu::FormattedSpirv code =
        surfaces::addingTo(radianceFormat_, host_->of(builtIn), gpu::RADIANCE_IMAGE);
    return gpu::Kernel<Params>(*device_, code,
                               {{gpu::SPEC_FOR_CPU, forCpu(*device_)},
                                {gpu::SPEC_SPECULAR_METHOD, uint32_t(job.method)},
                                {gpu::SPEC_LIGHT_TYPE, job.lightType},
                                {gpu::SPEC_GBUFFER, gbuffer_},
                                {gpu::SPEC_TILE_CLASS, job.tileClass},
                                {gpu::SPEC_TILE_HEIGHT, height},
                                {gpu::SPEC_VISIBILITY_POINTS, shadowPoints_},
                                {gpu::SPEC_WALK_TURNS, walkTurns(*device_)},
                                {gpu::SPEC_PAIR_KIND, pairKind}},
                               host_->setLayout());
}

const ShadeKernels::Variant& ShadeKernels::variant(uint32_t type, CndSpecularMethod method) const
{
    return slots_[type][canonicalMethod(type, method)].kernels;
}

const ShadeKernels::Tiles& ShadeKernels::tiles(uint32_t type, CndSpecularMethod method,
                                               uint32_t tileClass) const
{
    if (tileClass == gpu::CLASS_DIFFUSE) // it has no specular lobe, so all methods are the same
        return slots_[type][CND_SPECULAR_NONE].kernels.tiles[tileClass];
    return variant(type, method).tiles[tileClass];
}

} // namespace candelabra::lighting
