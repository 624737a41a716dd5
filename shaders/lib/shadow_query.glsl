// SPDX-License-Identifier: Apache-2.0
// The shadow term that a host defines (CANDELABRA_VISIBILITY), and what it may depend on.
#ifndef CND_LIB_SHADOW_QUERY
#define CND_LIB_SHADOW_QUERY

#include "shared/lighting_data.h"

// A surface point and a light, in view space, in metres.
struct ShadowQuery {
    // Low half of the light's CndLightId or, for a light that the host left on the device,
    // LIGHT_OF_DEVICE + its index in CndDeviceLights::buffer.
    uint light;
    uint type;     // LIGHT_*
    vec3 position; // position of the surface point
    vec3 normal;   // unit normal of the surface
    vec3 toLight;  // from the surface point to the light's centre; a unit vector for distant lights
};

// Returns the factor by which the light is multiplied: 0 (in shadow) to 1 (all of the light is seen).
float candelabraVisibility(ShadowQuery query);

#endif
