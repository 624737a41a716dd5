// SPDX-License-Identifier: Apache-2.0
// How the diffuse and the specular lobe share the light. Decided once per pixel by scaling the
// material, so that no light pays for it.
#ifndef CND_LIB_JOINING
#define CND_LIB_JOINING

#include "shared/dfg.h"
#include "lib/brdf.glsl"

// `albedo`: directional albedo of the point's lobe (lib/dfg.glsl), x > 0.
// energyCompensation: Turquin 2019, "Practical multiple scattering compensation for microfacet
//   models", eq. 16: what the microfacets lose between them comes back in the shape of the single
//   bounce, times F0 for the extra bounce; a white metal reflects all light at any alpha.
// joining LOBES_SUM: the lobes are added, nothing is taken from the diffuse one.
// joining LOBES_CONSERVING: the diffuse lobe gets what the specular one leaves of a white
//   surrounding. Deviation from glTF 2.0, appendix B, whose mix by F(VoH) reflects more light than
//   there is at grazing angles (engine/DECISIONS.md, 14).
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
