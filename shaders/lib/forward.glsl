// SPDX-License-Identifier: Apache-2.0
// The lights of a view for shaders of hosts: transparent surfaces, particles, volumes. The same lights
// and the same functions as those of the opaque surfaces, by CND_SPECULAR_CONIC, at any position that
// the view's camera shows; found through the light tree, so none is missed. Positions and directions
// are in view space, metres.
//
// The includer defines FORWARD_SET, the number of the descriptor set (cndGetForwardSet). One line
// does it:
//   vec3 luminance = litSurface(surface, position); // Surface: lib/gbuffer.glsl
// With CANDELABRA_VISIBILITY defined before the include, the includer also defines the shadow term of
// lib/shadow_query.glsl behind it.
// Light by light, with more than that for instance (lightIds[cursor.light]: which light it is):
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
#include "shading/forward.glsl"

#endif
