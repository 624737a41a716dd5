// SPDX-License-Identifier: Apache-2.0
// The shadow term, which the host provides with CANDELABRA_VISIBILITY. The includer then provides
// lightIds[].
#ifndef CND_SHADING_SHADOW_TERM
#define CND_SHADING_SHADOW_TERM

#include "shading/light_type.glsl"

#ifdef CANDELABRA_VISIBILITY
#include "lib/shadow_query.glsl"

const bool HAS_SHADOW_TERM = true;
#define SHADOW_TERM(light, position, n, toLight)                                                   \
    candelabraVisibility(ShadowQuery(lightIds[light], lightType, position, n, toLight))
#else
const bool HAS_SHADOW_TERM = false;
#define SHADOW_TERM(light, position, n, toLight) 1.0
#endif

#endif
