// SPDX-License-Identifier: Apache-2.0
// The type of the lights that are evaluated, and the specular method. All lights of a dispatch are of
// one type, which is a specialisation constant. Shaders of hosts evaluate one type after the other.
// specularMethod is a method that the type has (canonicalMethod() in engine/shading/light_family.h).
#ifndef CND_SHADING_LIGHT_TYPE
#define CND_SHADING_LIGHT_TYPE

#include "shared/lighting_data.h"
#include "shading/light_families.glsl"

#ifdef LIGHT_FAMILY_ALL
uint lightType;
#define IS_DISTANT ((TYPES_WITH_POSITION >> lightType & 1u) == 0u)
#define X(id, NAME, family, fields) FAMILY_##family,
const uint FAMILY_OF_TYPE[LIGHT_TYPE_COUNT] = {CND_LIGHT_TYPES(X)};
#undef X
#define TYPE_IS_OF(family) (FAMILY_OF_TYPE[lightType] == (family))
const uint specularMethod = SPECULAR_CONIC;
#else
layout(constant_id = SPEC_LIGHT_TYPE) const uint lightType = LIGHT_SPHERE;
const bool IS_DISTANT = (TYPES_WITH_POSITION >> lightType & 1u) == 0u;
#define TYPE_IS_OF(family) ((family) == LIGHT_FAMILY)
layout(constant_id = SPEC_SPECULAR_METHOD) const uint specularMethod = SPECULAR_CONIC;
#endif
const bool BY_OUTLINE = specularMethod == SPECULAR_CONIC || specularMethod == SPECULAR_CONIC_FULL;

// Returns the vector from the point to the light's centre, or the unit direction of a distant light.
vec3 towardsLight(vec3 centre, vec3 position)
{
    return IS_DISTANT ? centre : centre - position;
}

#endif
