// SPDX-License-Identifier: Apache-2.0
// The lights of a view for shaders of hosts: transparent surfaces, particles, volumes. They light any
// position that the view's camera shows, with the functions that shade opaque surfaces by
// CND_SPECULAR_CONIC. The light tree finds the lights of a position and misses none. Positions and
// directions are in view space, in metres.
//
// The includer defines FORWARD_SET, the number of the descriptor set (cndGetForwardSet). One call
// returns the light of all lights:
//   vec3 luminance = litSurface(surface, position); // Surface: lib/gbuffer.glsl
// A shader that defines CANDELABRA_SHADOWS before the include finds the shadows of the module's
// occluders, for which the module needs CndLightingDesc::shadows. Each invocation walks through them,
// and its stage needs subgroup votes and arithmetic. Positions count as exact to 2^-18 of their
// distance. If the module's kernels have rays of the host (CND_HOST_VISIBLE_POINTS_BIT), a shader
// defines CANDELABRA_VISIBLE_POINTS instead, and the function of lib/visibility_query.glsl after the
// include. A shader of the wrong kind does not fit the set: validation says so when its pipeline is
// made.
// A shader with a shadow term defines CANDELABRA_VISIBILITY before the include, and the function of
// lib/shadow_query.glsl after it.
// A loop over the lights gives access to each of them, for instance for a shadow term that needs more
// than a ShadowQuery. lightIds[cursor.light] identifies the light:
//   const Receiver receiver = forwardReceiver(surface, position);
//   for (uint type = 0u; type < LIGHT_TYPE_COUNT; ++type) {
//       LightCursor cursor = lightsAt(type, position);
//       while (nextLight(cursor))
//           luminance += shadow(cursor.light) * evaluateLight(receiver, cursor.light);
//   }
#ifndef CND_LIB_FORWARD
#define CND_LIB_FORWARD

#ifndef FORWARD_SET
#error "define FORWARD_SET, the number of the set of cndGetForwardSet, before lib/forward.glsl"
#endif
#include "shading/forward_lights.glsl"

#endif
