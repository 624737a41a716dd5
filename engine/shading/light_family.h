// SPDX-License-Identifier: Apache-2.0
// Which family of shared/light_families.h evaluates a light type by a specular method.
#pragma once

#include "candelabra/lighting.h"
#include "lights/light_types.h"

namespace candelabra::lighting
{

constexpr bool isClosedForm(CndSpecularMethod method)
{
    return method == CND_SPECULAR_CONIC || method == CND_SPECULAR_CONIC_FULL;
}

constexpr uint32_t familyOf(uint32_t lightType, CndSpecularMethod method)
{
    return isSphere(lightType) && isClosedForm(method) ? gpu::FAMILY_CONIC
                                                       : baseFamilyOf(lightType);
}

// Whether an error budget changes the evaluation: the closed form of spheres has cheaper bounds.
constexpr bool takesBudget(uint32_t lightType, CndSpecularMethod method)
{
    return familyOf(lightType, method) == gpu::FAMILY_CONIC;
}

// Returns the method that stands for `method` where the light type has fewer: punctual lights have
// one; area lights other than spheres have a representative point, transformed cosines and samples.
constexpr CndSpecularMethod canonicalMethod(uint32_t lightType, CndSpecularMethod method)
{
    if (method == CND_SPECULAR_NONE || isSphere(lightType))
        return method;
    if (baseFamilyOf(lightType) == gpu::FAMILY_PUNCTUAL)
        return CND_SPECULAR_POINT;
    switch (method) {
    case CND_SPECULAR_SAMPLED:
        return method;
    case CND_SPECULAR_KARIS:
    case CND_SPECULAR_POINT:
    case CND_SPECULAR_KX:
        return CND_SPECULAR_KARIS;
    default:
        return CND_SPECULAR_LTC;
    }
}

} // namespace candelabra::lighting
