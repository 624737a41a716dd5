// SPDX-License-Identifier: Apache-2.0
#include "lighting/shade_kernels.h"

#include <bit>

#include "candelabra_shaders.h"
#include "lighting/lighting.h"

namespace candelabra::lighting
{

uint32_t lightsAsTexels(const gpu::Device& device)
{
    return device.limits.maxTexelBufferElements / gpu::LIGHT_CORE_STRIDE >=
           maxLights(device.limits);
}

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

ShadeKernels::ShadeKernels(const gpu::Device& device, uint32_t gbuffer, uint32_t methods)
    : device_(&device), gbuffer_(gbuffer), methods_(methods)
{
    require(CND_LIGHT_SPHERE);
}

void ShadeKernels::require(uint32_t lightType)
{
    if (!types_[lightType].made)
        types_[lightType] = make(lightType);
}

bool isDistant(uint32_t lightType)
{
    return lightType == CND_LIGHT_DIRECTIONAL || lightType == CND_LIGHT_DISTANT_SPHERE;
}

bool isSphere(uint32_t lightType)
{
    return lightType == CND_LIGHT_SPHERE || lightType == CND_LIGHT_DISTANT_SPHERE;
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
};

// shaders/lib/light_families.glsl.
Family familyOf(uint32_t lightType, CndSpecularMethod method)
{
    using namespace spirv;
    switch (lightType) {
    case CND_LIGHT_TUBE:
        return {&shade_tiles_comp_tube, &shade_unlisted_comp_tube, &shade_brute_comp_tube,
                &count_pairs_comp_tube};
    case CND_LIGHT_RECTANGLE:
        return {&shade_tiles_comp_rectangle, &shade_unlisted_comp_rectangle,
                &shade_brute_comp_rectangle, &count_pairs_comp_rectangle};
    case CND_LIGHT_DISC:
        return {&shade_tiles_comp_disc, &shade_unlisted_comp_disc, &shade_brute_comp_disc,
                &count_pairs_comp_disc};
    case CND_LIGHT_SPHERE:
    case CND_LIGHT_DISTANT_SPHERE:
        if (method == CND_SPECULAR_CONIC || method == CND_SPECULAR_CONIC_FULL)
            return {&shade_tiles_comp_conic, &shade_unlisted_comp_conic, &shade_brute_comp_conic,
                    &count_pairs_comp_conic};
        return {&shade_tiles_comp_sphere, &shade_unlisted_comp_sphere, &shade_brute_comp_sphere,
                &count_pairs_comp_sphere};
    default:
        return {&shade_tiles_comp_punctual, &shade_unlisted_comp_punctual,
                &shade_brute_comp_punctual, &count_pairs_comp_punctual};
    }
}

} // namespace

ShadeKernels::Variant ShadeKernels::makeVariant(uint32_t lightType, uint32_t method,
                                                bool withBudget) const
{
    const auto kernel = [&](const gpu::Spirv& spirv) {
        return Kernel(*device_, spirv,
                      {{gpu::SPEC_LIGHTS_AS_TEXELS, lightsAsTexels(*device_)},
                       {gpu::SPEC_SPECULAR_METHOD, method},
                       {gpu::SPEC_LIGHT_TYPE, lightType},
                       {gpu::SPEC_GBUFFER, gbuffer_},
                       {gpu::SPEC_ERROR_BUDGET, withBudget}});
    };
    const Family family = familyOf(lightType, CndSpecularMethod(method));
    return {.tiles = kernel(*family.tiles),
            .unlisted = kernel(*family.unlisted),
            .brute = kernel(*family.brute),
            .countPairs = kernel(*family.countPairs)};
}

ShadeKernels::OfType ShadeKernels::make(uint32_t lightType) const
{
    uint32_t methods = 0;
    for (uint32_t method = 0; method < CND_SPECULAR_METHOD_COUNT; ++method)
        if (allows(CndSpecularMethod(method)))
            methods |= 1u << canonicalMethod(lightType, CndSpecularMethod(method));
    OfType out;
    for (uint32_t method = 0; method < CND_SPECULAR_METHOD_COUNT; ++method) {
        if (!(methods >> method & 1))
            continue;
        out.variants[method][0] = makeVariant(lightType, method, false);
        if (takesBudget(lightType, CndSpecularMethod(method)))
            out.variants[method][1] = makeVariant(lightType, method, true);
    }
    out.made = true;
    return out;
}

const ShadeKernels::Variant& ShadeKernels::variant(uint32_t type, CndSpecularMethod method,
                                                   bool withBudget) const
{
    const CndSpecularMethod m = canonicalMethod(type, method);
    return types_[type].variants[m][withBudget && takesBudget(type, m)];
}

const ShadeKernels::Variant& ShadeKernels::anyVariant() const
{
    return types_[CND_LIGHT_SPHERE].variants[std::countr_zero(methods_)][0];
}

} // namespace candelabra::lighting
