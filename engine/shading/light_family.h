// SPDX-License-Identifier: Apache-2.0
// The family of kernels (shared/light_type_list.h) that evaluates a light type by a specular
// method.
#pragma once

#include <string>

#include "candelabra/lighting.h"
#include "gpu/failure.h"
#include "lights/light_types.h"
#include "shared/specular_methods.h"

namespace candelabra::lighting
{

#define X(id, NAME, name) static_assert(gpu::SPECULAR_##NAME == uint32_t{CND_SPECULAR_##NAME});
CND_SPECULAR_METHODS(X)
#undef X
// Every value but CND_SPECULAR_DEFAULT is a method.
static_assert((gpu::ALL_SPECULAR_METHODS ^ 1u << CND_SPECULAR_DEFAULT) ==
              (1u << CND_SPECULAR_METHOD_COUNT) - 1);

constexpr bool isClosedForm(CndSpecularMethod method)
{
    return method == CND_SPECULAR_CONIC || method == CND_SPECULAR_CONIC_FULL;
}

constexpr uint32_t familyOf(uint32_t lightType, CndSpecularMethod method)
{
    return isSphere(lightType) && isClosedForm(method) ? gpu::FAMILY_CONIC
                                                       : baseFamilyOf(lightType);
}

// Returns the method by which lights of the type are evaluated if the frame asks for `method`.
// Spheres know all methods and punctual lights one. The other area lights know three:
// representative point (KARIS), the closed form (CONIC) and samples (SAMPLED).
constexpr CndSpecularMethod canonicalMethod(uint32_t lightType, CndSpecularMethod method)
{
    if (method == CND_SPECULAR_NONE || isSphere(lightType))
        return method;
    if (baseFamilyOf(lightType) == gpu::FAMILY_PUNCTUAL)
        return CND_SPECULAR_POINT;
    if (method == CND_SPECULAR_SAMPLED)
        return method;
    const bool closed = method == CND_SPECULAR_DEFAULT || isClosedForm(method);
    return closed ? CND_SPECULAR_CONIC : CND_SPECULAR_KARIS;
}

// Throws gpu::Failure if a bit of specularMethods, a member of the struct `owner`, stands for no
// method.
inline void checkSpecularMethods(const char* owner, uint32_t specularMethods)
{
    const std::string member = std::string(owner) + ": specularMethods has ";
    if (specularMethods >> CND_SPECULAR_METHOD_COUNT)
        gpu::failArgument(member + "bits beyond the last CndSpecularMethod");
    if (specularMethods & 1u << CND_SPECULAR_DEFAULT)
        gpu::failArgument(member + "bit 0, CND_SPECULAR_DEFAULT, which is no method: name methods, "
                                   "or pass 0");
}

} // namespace candelabra::lighting
