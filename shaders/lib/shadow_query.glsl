// SPDX-License-Identifier: Apache-2.0
// What the host's shadow term may depend on; the host defines it (CANDELABRA_VISIBILITY).
#ifndef CND_LIB_SHADOW_QUERY
#define CND_LIB_SHADOW_QUERY

#include "shared/lighting.h"

// View space, metres.
struct ShadowQuery {
    uint light;    // low half of its CndLightId; LIGHT_OF_DEVICE + its index in CndDeviceLights::buffer
    uint type;     // LIGHT_*
    vec3 position; // of the surface
    vec3 normal;   // unit, of the surface
    vec3 toLight;  // from there to the light's centre; distant lights: unit
};

// 0 (in shadow) to 1 (all of the light is seen): the light is multiplied by it.
float candelabraVisibility(ShadowQuery query);

#endif
