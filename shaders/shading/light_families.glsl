// SPDX-License-Identifier: Apache-2.0
// Families of lights and methods that share code. The kernels that shade are compiled once per family:
// drivers inline everything before they drop what specialisation rules out, and one module for all
// took them seconds per pipeline.
#ifndef CND_SHADING_LIGHT_FAMILIES
#define CND_SHADING_LIGHT_FAMILIES

#define FAMILY_PUNCTUAL 1  // point, spot, directional
#define FAMILY_CONIC 2     // sphere, distant sphere by SPECULAR_CONIC, SPECULAR_CONIC_FULL
#define FAMILY_SPHERE 3    // ... by the other methods
#define FAMILY_TUBE 4
#define FAMILY_RECTANGLE 5
#define FAMILY_DISC 6
#define FAMILY_ALL 7       // every light, by SPECULAR_CONIC: shaders of hosts (lib/forward.glsl)

#ifndef LIGHT_FAMILY
#error "shaders/CMakeLists.txt names the family: FILE:FAMILY"
#endif
#define HAS_CONIC (LIGHT_FAMILY == FAMILY_CONIC || LIGHT_FAMILY == FAMILY_ALL)
#define HAS_SPHERES (HAS_CONIC || LIGHT_FAMILY == FAMILY_SPHERE)
#define HAS_TUBES (LIGHT_FAMILY == FAMILY_TUBE || LIGHT_FAMILY == FAMILY_ALL)
#define HAS_RECTANGLES (LIGHT_FAMILY == FAMILY_RECTANGLE || LIGHT_FAMILY == FAMILY_ALL)
#define HAS_DISCS (LIGHT_FAMILY == FAMILY_DISC || LIGHT_FAMILY == FAMILY_ALL)
#define HAS_PUNCTUAL (LIGHT_FAMILY == FAMILY_PUNCTUAL || LIGHT_FAMILY == FAMILY_ALL)
#define HAS_COSINES (LIGHT_FAMILY != FAMILY_PUNCTUAL && LIGHT_FAMILY != FAMILY_CONIC)

#endif
