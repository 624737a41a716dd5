// SPDX-License-Identifier: Apache-2.0
// What the family of lights that a shader is compiled for needs. The build defines LIGHT_FAMILY_ and a
// name of shared/light_families.h, shaders of hosts (lib/forward.glsl) LIGHT_FAMILY_ALL: every light,
// with spheres by SPECULAR_CONIC.
#ifndef CND_SHADING_LIGHT_FAMILIES
#define CND_SHADING_LIGHT_FAMILIES

#ifdef LIGHT_FAMILY_ALL
#define LIGHT_FAMILY_CONIC
#endif

// Spheres, near and distant, whatever the specular method.
#if defined(LIGHT_FAMILY_CONIC) || defined(LIGHT_FAMILY_SPHERE)
#define HAS_SPHERES
#endif

// The table of transformed cosines: all but punctual lights and spheres in closed form.
#if defined(LIGHT_FAMILY_ALL) || !(defined(LIGHT_FAMILY_PUNCTUAL) || defined(LIGHT_FAMILY_CONIC))
#define HAS_COSINES
#endif

#endif
