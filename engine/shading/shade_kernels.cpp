// SPDX-License-Identifier: Apache-2.0
#include "shading/shade_kernels.h"

#include <bit>
#include <iterator>

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

ShadeKernels::ShadeKernels(const gpu::Device& device, const surfaces::HostKernels& host,
                           uint32_t gbuffer, VkFormat radianceFormat, uint32_t methods,
                           uint32_t tileClasses, bool measures)
    : device_(&device),
      host_(&host),
      gbuffer_(gbuffer),
      radianceFormat_(radianceFormat),
      methods_(methods),
      tileClasses_(tileClasses),
      measures_(measures)
{
    require(CND_LIGHT_SPHERE);
}

bool ShadeKernels::require(uint32_t lightType)
{
    if (types_[lightType].made)
        return false;
    types_[lightType] = make(lightType);
    return true;
}

template <typename Params>
gpu::Kernel<Params> ShadeKernels::makeKernel(std::span<const gpu::Spirv* const> families,
                                             uint32_t lightType, CndSpecularMethod method,
                                             bool withBudget, uint32_t tileClass) const
{
    const gpu::Spirv* kernel = &host_->of(*families[familyOf(lightType, method)]);
    if (device_->lanesAreCpuVector && kernel == spirv::shade_tiles_comp[gpu::FAMILY_CONIC])
        kernel = &spirv::shade_tiles_comp_lanes_alone_conic;
    const gpu::FormattedSpirv code =
        surfaces::addingTo(radianceFormat_, *kernel, gpu::SHADE_RADIANCE);
    return gpu::Kernel<Params>(*device_, code,
                               {{gpu::SPEC_LIGHTS_AS_TEXELS, lightsAsTexels(*device_)},
                                {gpu::SPEC_SPECULAR_METHOD, uint32_t(method)},
                                {gpu::SPEC_LIGHT_TYPE, lightType},
                                {gpu::SPEC_GBUFFER, gbuffer_},
                                {gpu::SPEC_ERROR_BUDGET, withBudget},
                                {gpu::SPEC_TILE_CLASS, tileClass},
                                {gpu::SPEC_LANES_TOGETHER, !device_->lanesAreCpuVector}},
                               host_->setLayout());
}

ShadeKernels::Tiles ShadeKernels::makeTiles(uint32_t lightType, CndSpecularMethod method,
                                            bool withBudget, uint32_t tileClass) const
{
    return {.shade = makeKernel<gpu::ShadeTilesParams>(spirv::shade_tiles_comp, lightType, method,
                                                       withBudget, tileClass),
            .unlisted = makeKernel<gpu::ShadeUnlistedParams>(spirv::shade_unlisted_comp, lightType,
                                                             method, withBudget, tileClass),
            .countPairs = makeKernel<gpu::CountPairsParams>(spirv::count_pairs_comp, lightType,
                                                            method, withBudget, tileClass)};
}

ShadeKernels::Variant ShadeKernels::makeVariant(uint32_t lightType, CndSpecularMethod method,
                                                bool withBudget) const
{
    Variant out{.any = makeTiles(lightType, method, withBudget, gpu::CLASS_ANY),
                .brute = makeKernel<gpu::ShadeBruteParams>(spirv::shade_brute_comp, lightType,
                                                           method, withBudget, gpu::CLASS_ANY)};
    if (tellsApart(gpu::CLASS_SPECULAR))
        out.specular = makeTiles(lightType, method, withBudget, gpu::CLASS_SPECULAR);
    if (measures_ && !withBudget)
        out.measure = makeKernel<gpu::MeasureInfluenceParams>(
            spirv::measure_influence_comp, lightType, method, withBudget, gpu::CLASS_ANY);
    return out;
}

ShadeKernels::OfType ShadeKernels::make(uint32_t lightType) const
{
    uint32_t methods = 0;
    for (uint32_t method = 0; method < CND_SPECULAR_METHOD_COUNT; ++method)
        if (allows(CndSpecularMethod(method)))
            methods |= 1u << canonicalMethod(lightType, CndSpecularMethod(method));
    OfType out;
    for (uint32_t i = 0; i < CND_SPECULAR_METHOD_COUNT; ++i) {
        if (!(methods >> i & 1))
            continue;
        const CndSpecularMethod method = CndSpecularMethod(i);
        out.variants[method][0] = makeVariant(lightType, method, false);
        if (takesBudget(lightType, method))
            out.variants[method][1] = makeVariant(lightType, method, true);
    }
    if (tellsApart(gpu::CLASS_DIFFUSE))
        out.diffuse = makeTiles(lightType, CND_SPECULAR_NONE, false, gpu::CLASS_DIFFUSE);
    out.made = true;
    return out;
}

const ShadeKernels::Variant& ShadeKernels::variant(uint32_t type, CndSpecularMethod method,
                                                   bool withBudget) const
{
    const CndSpecularMethod m = canonicalMethod(type, method);
    return types_[type].variants[m][withBudget && takesBudget(type, m)];
}

const ShadeKernels::Tiles& ShadeKernels::tiles(uint32_t type, CndSpecularMethod method,
                                               bool withBudget, uint32_t tileClass) const
{
    if (tileClass == gpu::CLASS_DIFFUSE)
        return types_[type].diffuse;
    const Variant& v = variant(type, method, withBudget);
    return tileClass == gpu::CLASS_SPECULAR ? v.specular : v.any;
}

const ShadeKernels::Variant& ShadeKernels::anyVariant() const
{
    return types_[CND_LIGHT_SPHERE].variants[std::countr_zero(methods_)][0];
}

} // namespace candelabra::lighting
