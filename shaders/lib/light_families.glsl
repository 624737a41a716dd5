// SPDX-License-Identifier: Apache-2.0
// Families of lights and methods that share code. The kernels that shade are compiled once per family:
// drivers inline everything before they drop what specialisation rules out, and one module for all
// took them seconds per pipeline.
#ifndef CND_LIB_LIGHT_FAMILIES
#define CND_LIB_LIGHT_FAMILIES

#define FAMILY_PUNCTUAL 1  // point, spot, directional
#define FAMILY_CONIC 2     // sphere, distant sphere by SPECULAR_CONIC, SPECULAR_CONIC_FULL
#define FAMILY_SPHERE 3    // ... by the other methods
#define FAMILY_TUBE 4
#define FAMILY_RECTANGLE 5
#define FAMILY_DISC 6

#ifndef LIGHT_FAMILY
#error "shaders/CMakeLists.txt names the family: FILE:FAMILY"
#endif
#define HAS_SPHERES (LIGHT_FAMILY == FAMILY_CONIC || LIGHT_FAMILY == FAMILY_SPHERE)
#define HAS_COSINES (LIGHT_FAMILY != FAMILY_PUNCTUAL && LIGHT_FAMILY != FAMILY_CONIC)

#endif
