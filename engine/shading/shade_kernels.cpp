// SPDX-License-Identifier: Apache-2.0
#include "shading/shade_kernels.h"

#include <bit>

#include "candelabra_shaders.h"
#include "lights/light_limits.h"
#include "lights/light_types.h"

namespace candelabra::lighting
{

CndSpecularMethod canonicalMethod(uint32_t lightType, CndSpecularMethod method)
{
    if (method == CND_SPECULAR_NONE)
        return method;
    switch (lightType) {
    case CND_LIGHT_POINT:
    case CND_LIGHT_SPOT:
    case CND_LIGHT_DIRECTIONAL:
        return CND_SPECULAR_POINT;
    case CND_LIGHT_TUBE:
    case CND_LIGHT_RECTANGLE:
    case CND_LIGHT_DISC:
        if (method == CND_SPECULAR_SAMPLED)
            return method;
        return method == CND_SPECULAR_POINT || method == CND_SPECULAR_KARIS ||
                       method == CND_SPECULAR_KX
                   ? CND_SPECULAR_KARIS
                   : CND_SPECULAR_LTC;
    default:
        return method;
    }
}

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
                           uint32_t gbuffer, uint32_t methods, uint32_t tileClasses, bool measures)
    : device_(&device),
      host_(&host),
      gbuffer_(gbuffer),
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

bool takesBudget(uint32_t lightType, CndSpecularMethod method)
{
    return isSphere(lightType) &&
           (method == CND_SPECULAR_CONIC || method == CND_SPECULAR_CONIC_FULL);
}

namespace
{

struct Family {
    const gpu::Spirv* tiles;
    const gpu::Spirv* unlisted;
    const gpu::Spirv* brute;
    const gpu::Spirv* countPairs;
    const gpu::Spirv* measure;
};

// shaders/shading/light_families.glsl.
Family familyOf(uint32_t lightType, CndSpecularMethod method)
{
    using namespace spirv;
    switch (lightType) {
    case CND_LIGHT_TUBE:
        return {&shade_tiles_comp_tube, &shade_unlisted_comp_tube, &shade_brute_comp_tube,
                &count_pairs_comp_tube, &measure_influence_comp_tube};
    case CND_LIGHT_RECTANGLE:
        return {&shade_tiles_comp_rectangle, &shade_unlisted_comp_rectangle,
                &shade_brute_comp_rectangle, &count_pairs_comp_rectangle,
                &measure_influence_comp_rectangle};
    case CND_LIGHT_DISC:
        return {&shade_tiles_comp_disc, &shade_unlisted_comp_disc, &shade_brute_comp_disc,
                &count_pairs_comp_disc, &measure_influence_comp_disc};
    case CND_LIGHT_SPHERE:
    case CND_LIGHT_DISTANT_SPHERE:
        if (method == CND_SPECULAR_CONIC || method == CND_SPECULAR_CONIC_FULL)
            return {&shade_tiles_comp_conic, &shade_unlisted_comp_conic, &shade_brute_comp_conic,
                    &count_pairs_comp_conic, &measure_influence_comp_conic};
        return {&shade_tiles_comp_sphere, &shade_unlisted_comp_sphere, &shade_brute_comp_sphere,
                &count_pairs_comp_sphere, &measure_influence_comp_sphere};
    default:
        return {&shade_tiles_comp_punctual, &shade_unlisted_comp_punctual,
                &shade_brute_comp_punctual, &count_pairs_comp_punctual,
                &measure_influence_comp_punctual};
    }
}

} // namespace

ShadeKernels::Kernel ShadeKernels::makeKernel(const gpu::Spirv& spirv, uint32_t lightType,
                                              CndSpecularMethod method, bool withBudget,
                                              uint32_t tileClass) const
{
    return Kernel(*device_, host_->of(spirv),
                  {{gpu::SPEC_LIGHTS_AS_TEXELS, lightsAsTexels(*device_)},
                   {gpu::SPEC_SPECULAR_METHOD, uint32_t(method)},
                   {gpu::SPEC_LIGHT_TYPE, lightType},
                   {gpu::SPEC_GBUFFER, gbuffer_},
                   {gpu::SPEC_ERROR_BUDGET, withBudget},
                   {gpu::SPEC_TILE_CLASS, tileClass}},
                  host_->setLayout());
}

ShadeKernels::Tiles ShadeKernels::makeTiles(uint32_t lightType, CndSpecularMethod method,
                                            bool withBudget, uint32_t tileClass) const
{
    const Family family = familyOf(lightType, method);
    return {.shade = makeKernel(*family.tiles, lightType, method, withBudget, tileClass),
            .unlisted = makeKernel(*family.unlisted, lightType, method, withBudget, tileClass),
            .countPairs = makeKernel(*family.countPairs, lightType, method, withBudget, tileClass)};
}

ShadeKernels::Variant ShadeKernels::makeVariant(uint32_t lightType, CndSpecularMethod method,
                                                bool withBudget) const
{
    const Family family = familyOf(lightType, method);
    Variant out{.any = makeTiles(lightType, method, withBudget, gpu::CLASS_ANY),
                .brute = makeKernel(*family.brute, lightType, method, withBudget, gpu::CLASS_ANY)};
    if (tellsApart(gpu::CLASS_SPECULAR))
        out.specular = makeTiles(lightType, method, withBudget, gpu::CLASS_SPECULAR);
    if (measures_ && !withBudget)
        out.measure = makeKernel(*family.measure, lightType, method, withBudget, gpu::CLASS_ANY);
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
