// SPDX-License-Identifier: Apache-2.0
// Which code the family of lights needs that a shader is compiled for. The build defines
// LIGHT_FAMILY_<name> with a name of shared/light_types.h. Shaders of hosts (lib/forward.glsl)
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

// The family needs the table of linearly transformed cosines, as all do except punctual lights,
// spheres in closed form and polygons.
#if defined(LIGHT_FAMILY_ALL) || !(defined(LIGHT_FAMILY_PUNCTUAL) || defined(LIGHT_FAMILY_CONIC) || \
                                   defined(LIGHT_FAMILY_POLYGON))
#define HAS_COSINES
#endif

#endif
