// SPDX-License-Identifier: Apache-2.0
// How the diffuse and the specular lobe share the light. It is settled once per pixel by scaling the
// material, so that it costs nothing per light.
#ifndef CND_LIB_JOINING
#define CND_LIB_JOINING

#include "shared/dfg.h"
#include "lib/brdf.glsl"

// Scales the material of a point.
// `albedo`: directional albedo of the point's lobe (lib/dfg.glsl), x > 0.
// `energyCompensation`: eq. 16 of Turquin 2019, "Practical multiple scattering compensation for
//   microfacet models". Light that is lost between microfacets is given back with the directional
//   distribution of the single bounce, times F0 for the additional bounce. So a white metal reflects
//   all light at any alpha.
// `joining` LOBES_SUM: the lobes are added, and the diffuse lobe is not reduced.
// `joining` LOBES_CONSERVING: the diffuse lobe is scaled by the share of a uniform environment's light
//   that the specular lobe does not reflect. This deviates from glTF 2.0, appendix B, whose mix by
//   F(VoH) reflects more light than arrives at grazing angles (engine/DECISIONS.md, 14).
void joinLobes(inout ShadingPoint p, vec2 albedo, uint joining, uint energyCompensation)
{
    if (energyCompensation != 0u) {
        const vec3 gain = 1.0 + p.F0 * (1.0 / albedo.x - 1.0);
        p.F0 *= gain;
        p.F90 *= gain;
    }
    if (joining == LOBES_CONSERVING)
        p.albedo *= max(1.0 - schlick(p, albedo), 0.0);
}

#endif
