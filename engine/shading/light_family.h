// SPDX-License-Identifier: Apache-2.0
// The family of kernels (shared/light_types.h) that evaluates a light type by a specular method.
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

// Tells whether an error budget changes the evaluation. It does for the closed forms of area
// lights, which know how large the error of cheaper evaluations may be.
constexpr bool takesBudget(uint32_t lightType, CndSpecularMethod method)
{
    return baseFamilyOf(lightType) != gpu::FAMILY_PUNCTUAL &&
           (method == CND_SPECULAR_CONIC || method == CND_SPECULAR_CONIC_FULL);
}

// Returns the method by which lights of the type are evaluated if the frame asks for `method`.
// Spheres know all methods and punctual lights one. The other area lights know four: representative
// point (KARIS), transformed cosines (LTC), the closed form (CONIC) and samples (SAMPLED). Polygons
// have no transformed cosines.
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
    case CND_SPECULAR_LTC:
        return lightType == CND_LIGHT_POLYGON ? CND_SPECULAR_CONIC : method;
    default:
        return CND_SPECULAR_CONIC;
    }
}

} // namespace candelabra::lighting
