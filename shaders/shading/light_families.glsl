// SPDX-License-Identifier: Apache-2.0
// Which code the family of lights needs that a shader is compiled for. The build defines
// LIGHT_FAMILY_<name> with a name of shared/light_type_list.h. Shaders of hosts (lib/forward.glsl)
// define LIGHT_FAMILY_ALL and evaluate every light, spheres by SPECULAR_CONIC.
#ifndef CND_SHADING_LIGHT_FAMILIES
#define CND_SHADING_LIGHT_FAMILIES

#ifdef LIGHT_FAMILY_ALL
#define LIGHT_FAMILY_CONIC
#endif

// The family has spheres, near or distant, with any specular method.
#if defined(LIGHT_FAMILY_CONIC) || defined(LIGHT_FAMILY_SPHERE)
#define HAS_SPHERES
#endif

// The family has lights that are evaluated by their outlines.
#if defined(LIGHT_FAMILY_ALL) || defined(LIGHT_FAMILY_TUBE) || defined(LIGHT_FAMILY_RECTANGLE) || \
    defined(LIGHT_FAMILY_DISC) || defined(LIGHT_FAMILY_POLYGON)
#define HAS_OUTLINES
#endif

// The evaluation of the family's lights that are wholly above the horizon, and easy otherwise, has a
// loop of its own (light_walk.glsl).
#if defined(HAS_SPHERES) || defined(HAS_OUTLINES)
#define HAS_ABOVE
#endif

#endif
