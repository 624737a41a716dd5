// SPDX-License-Identifier: Apache-2.0
// Which lights can reach a point. All lights of a dispatch are of one type, a specialisation constant;
// shaders of hosts go from type to type.
#ifndef CND_SHADING_LIGHT_REACH
#define CND_SHADING_LIGHT_REACH

#include "shared/lighting.h"
#include "shading/light_families.glsl"

#if LIGHT_FAMILY == FAMILY_ALL
uint lightType; // of the lights at hand
#define IS_DISTANT (lightType == LIGHT_DIRECTIONAL || lightType == LIGHT_DISTANT_SPHERE)
#define IS_SPHERE (lightType == LIGHT_SPHERE || lightType == LIGHT_DISTANT_SPHERE)
#else
layout(constant_id = SPEC_LIGHT_TYPE) const uint lightType = LIGHT_SPHERE;

const bool IS_DISTANT = lightType == LIGHT_DIRECTIONAL || lightType == LIGHT_DISTANT_SPHERE;
const bool IS_SPHERE = lightType == LIGHT_SPHERE || lightType == LIGHT_DISTANT_SPHERE;
#endif

// From the point to the light's centre; unit length for distant lights.
vec3 towardsLight(vec3 centre, vec3 position)
{
    return IS_DISTANT ? centre : centre - position;
}

#endif
