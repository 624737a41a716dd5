// SPDX-License-Identifier: Apache-2.0
#include "surfaces/host_kernels.h"

#include <algorithm>
#include <iterator>
#include <span>
#include <utility>

#include "candelabra_shaders.h"
#include "gpu/failure.h"

namespace candelabra::surfaces
{
namespace
{

struct Named {
    const char* name;
    const gpu::Spirv* spirv;
    bool evaluates = false; // lights: with a shadow term of the host's
};

#define FAMILIES(kernel, evaluates)                                                                \
    {#kernel ":PUNCTUAL", &spirv::kernel##_comp_punctual, evaluates},                              \
        {#kernel ":CONIC", &spirv::kernel##_comp_conic, evaluates},                                \
        {#kernel ":SPHERE", &spirv::kernel##_comp_sphere, evaluates},                              \
        {#kernel ":TUBE", &spirv::kernel##_comp_tube, evaluates},                                  \
        {#kernel ":RECTANGLE", &spirv::kernel##_comp_rectangle, evaluates},                        \
    {                                                                                              \
#kernel ":DISC", &spirv::kernel##_comp_disc, evaluates                                     \
    }
// All that may be replaced, in either module: those that read surfaces.
const Named builtIn[] = {FAMILIES(shade_tiles, true),
                         FAMILIES(shade_unlisted, true),
                         FAMILIES(shade_brute, true),
                         FAMILIES(count_pairs, false),
                         {"tile_clusters", &spirv::tile_clusters_comp},
                         {"split_tiles", &spirv::split_tiles_comp},
                         {"surface_overlay", &spirv::surface_overlay_comp},
                         {"shade_environment", &spirv::shade_environment_comp}};
#undef FAMILIES

[[noreturn]] void fail(const std::string& sentence)
{
    gpu::failArgument("CndHostKernels: " + sentence);
}

const gpu::Spirv& find(const CndKernelCode& code)
{
    if (!code.name || !code.words)
        fail("the name or the words of a kernel are null");
    const auto found =
        std::ranges::find(builtIn, std::string(code.name), [](const Named& n) { return n.name; });
    if (found == std::end(builtIn))
        fail("there is no kernel " + std::string(code.name) + " to replace");
    return *found->spirv;
}

} // namespace

HostKernels::HostKernels(const CndHostKernels& given, CndGBufferLayout layout)
    : setLayout_(given.setLayout), readSurfaces_(layout == CND_GBUFFER_CUSTOM)
{
    if (given.count && !given.kernels)
        fail("kernels is null but count is " + std::to_string(given.count));
    for (const CndKernelCode& code : std::span(given.kernels, given.count)) {
        const gpu::Spirv& replaced = find(code);
        std::vector<uint32_t> words(code.words, code.words + code.wordCount);
        gpu::Reflection reflection = gpu::reflect({code.name, words});
        const bool usesSet = std::exchange(reflection.usesHostSet, false);
        if (reflection != gpu::reflect(replaced))
            fail(std::string("kernel ") + code.name +
                 " has other bindings or parameters than this version's: compile it anew");
        // Moving a vector leaves its elements where they are.
        const gpu::Spirv spirv{replaced.name, words};
        kernels_.push_back({&replaced, std::move(words), spirv, usesSet});
    }
}

const gpu::Spirv& HostKernels::of(const gpu::Spirv& original) const
{
    const auto host = std::ranges::find(kernels_, &original, &Code::builtIn);
    if (host != kernels_.end()) {
        needsSet_ = needsSet_ || (host->usesSet && setLayout_); // without: refused as a pipeline
        return host->spirv;
    }
    const auto* const known = std::ranges::find(builtIn, &original, &Named::spirv);
    if (known != std::end(builtIn) && (readSurfaces_ || (!kernels_.empty() && known->evaluates)))
        fail(std::string("kernel ") + known->name +
             " is missing: name its light type and method in CndCompileDesc" +
             (readSurfaces_ ? ", and CND_HOST_READ_SURFACE_BIT" : ""));
    return original;
}

void HostKernels::requireSet(const char* frame, VkDescriptorSet set) const
{
    if (needsSet_ && !set)
        gpu::failArgument(std::string(frame) +
                          ": hostSet is null, but kernels of CndHostKernels use descriptor set 1");
}

} // namespace candelabra::surfaces
