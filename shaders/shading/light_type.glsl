// SPDX-License-Identifier: Apache-2.0
// The type of the lights at hand. All lights of a dispatch are of one type, a specialisation constant;
// shaders of hosts go from type to type.
#ifndef CND_SHADING_LIGHT_TYPE
#define CND_SHADING_LIGHT_TYPE

#include "shared/lighting.h"
#include "shading/light_families.glsl"

#ifdef LIGHT_FAMILY_ALL
uint lightType;
#define IS_DISTANT ((TYPES_WITH_POSITION >> lightType & 1u) == 0u)

#define X(id, NAME, family, fields) FAMILY_##family,
const uint FAMILY_OF_TYPE[LIGHT_TYPE_COUNT] = {CND_LIGHT_TYPES(X)};
#undef X
#else
layout(constant_id = SPEC_LIGHT_TYPE) const uint lightType = LIGHT_SPHERE;
const bool IS_DISTANT = (TYPES_WITH_POSITION >> lightType & 1u) == 0u;
#endif

// From the point to the light's centre; unit length for distant lights.
vec3 towardsLight(vec3 centre, vec3 position)
{
    return IS_DISTANT ? centre : centre - position;
}

#endif
