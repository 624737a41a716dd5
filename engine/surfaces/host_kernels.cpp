// SPDX-License-Identifier: Apache-2.0
#include "surfaces/host_kernels.h"

#include <algorithm>
#include <iterator>
#include <span>
#include <utility>

#include "candelabra_shaders.h"
#include "gpu/failure.h"
#include "shared/light_type_list.h"

namespace candelabra::surfaces
{
namespace
{

// A kernel of the lighting or the environment module that a host may replace.
struct BuiltIn {
    const char* name;
    const gpu::Spirv* spirv;
    bool evaluates = false;   // evaluates lights, so that a host's shadow term must be in it
    bool findsPoints = false; // the host's form of it finds visible points (CndHostFunctionBits)
};

// The kernels that read surfaces, apart from measure_influence, which hosts cannot replace.
const BuiltIn builtIn[] = {
#define X(index, NAME, iterations)                                                                 \
    {"shade_tiles:" #NAME, spirv::shade_tiles_comp[index], true},                                  \
        {"shade_unlisted:" #NAME, spirv::shade_unlisted_comp[index], true},                        \
        {"shade_brute:" #NAME, spirv::shade_brute_comp[index], true},                              \
        {"shade_tiles_shadows:" #NAME, spirv::shade_tiles_comp_shadows[index], true},              \
        {"shade_unlisted_shadows:" #NAME, spirv::shade_unlisted_comp_shadows[index], true},        \
        {"shade_brute_shadows:" #NAME, spirv::shade_brute_comp_shadows[index], true},              \
        {"shade_unlisted_points:" #NAME, spirv::shade_unlisted_comp_shadows[index], false, true},  \
        {"count_pairs:" #NAME, spirv::count_pairs_comp[index]},
    CND_LIGHT_FAMILIES(X)
#undef X
        {"pair_visibility", &spirv::pair_visibility_comp_sphere},
    {"pair_visibility_points", &spirv::pair_visibility_comp_sphere, false, true},
    {"tile_clusters", &spirv::tile_clusters_comp},
    {"split_tiles", &spirv::split_tiles_comp},
    {"cpu/tile_clusters", &spirv::cpu_tile_clusters_comp},
    {"cpu/split_tiles", &spirv::cpu_split_tiles_comp},
    {"surface_overlay", &spirv::surface_overlay_comp},
    {"shade_environment", &spirv::shade_environment_comp}};

[[noreturn]] void failKernels(const std::string& sentence)
{
    gpu::failArgument("CndHostKernels: " + sentence);
}

const BuiltIn& findBuiltIn(const CndKernelCode& code)
{
    if (!code.name || !code.words)
        failKernels("the name or the words of a kernel are null");
    const auto found =
        std::ranges::find(builtIn, std::string(code.name), [](const BuiltIn& b) { return b.name; });
    if (found == std::end(builtIn))
        failKernels("there is no kernel " + std::string(code.name) + " to replace");
    return *found;
}

} // namespace

HostKernels::HostKernels(const CndHostKernels& given, CndGBufferLayout layout)
    : setLayout_(given.setLayout), readSurfaces_(layout == CND_GBUFFER_CUSTOM)
{
    if (given.count && !given.kernels)
        failKernels("kernels is null but count is " + std::to_string(given.count));
    for (const CndKernelCode& code : std::span(given.kernels, given.count)) {
        const BuiltIn& replaced = findBuiltIn(code);
        std::vector<uint32_t> words(code.words, code.words + code.wordCount);
        gpu::Reflection reflection = gpu::reflect({code.name, words});
        const bool usesSet = std::exchange(reflection.usesHostSet, false);
        if (reflection != gpu::reflect(*replaced.spirv))
            failKernels(std::string("kernel ") + code.name +
                        " has other bindings or parameters than this version's: compile it again");
        // `spirv` points to the words. They stay where they are when the vector is moved.
        const gpu::Spirv spirv{replaced.spirv->name, words};
        kernels_.push_back(
            {replaced.spirv, std::move(words), spirv, usesSet, replaced.findsPoints});
        hasShadowTerm_ = hasShadowTerm_ || replaced.evaluates;
        findsPoints_ = findsPoints_ || replaced.findsPoints;
    }
}

const HostKernels::Code* HostKernels::find(const gpu::Spirv& original) const
{
    const BuiltIn* known = nullptr;
    for (const BuiltIn& b : builtIn)
        if (b.spirv == &original && (!known || (findsPoints_ && b.findsPoints)))
            known = &b;
    if (!known)
        return nullptr;
    for (const Code& code : kernels_)
        if (code.builtIn == &original && code.findsPoints == known->findsPoints)
            return &code;
    if (readSurfaces_ || (hasShadowTerm_ && known->evaluates) || known->findsPoints)
        failKernels(std::string("kernel ") + known->name +
                    " is missing: name its light type and method in CndCompileDesc, and "
                    "whether the module has shadows" +
                    (readSurfaces_ ? ", and CND_HOST_READ_SURFACE_BIT" : ""));
    return nullptr;
}

const gpu::Spirv& HostKernels::of(const gpu::Spirv& original) const
{
    const Code* host = find(original);
    return host ? host->spirv : original;
}

const gpu::Spirv& HostKernels::used(const gpu::Spirv& original) const
{
    const Code* host = find(original);
    // A kernel that uses the set needs its layout, or creating the pipeline fails.
    if (host && host->usesSet && setLayout_)
        needsSet_ = true;
    return host ? host->spirv : original;
}

void HostKernels::requireSet(const char* frame, VkDescriptorSet set) const
{
    if (needsSet_ && !set)
        gpu::failArgument(std::string(frame) +
                          ": hostSet is null, but kernels of CndHostKernels use descriptor set 1");
}

} // namespace candelabra::surfaces
