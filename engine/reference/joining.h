// SPDX-License-Identifier: Apache-2.0
// How the two lobes of a material share the light, in double.
#pragma once

#include "candelabra/candelabra.h"
#include "reference/surface.h"

namespace candelabra::reference
{

// The material as an eye at this cosine sees it, with A = F0 (a - b) + F90 b the share of a white
// surrounding that its specular lobe reflects (albedo.h):
//   energyCompensation: the lobe times g = 1 + F0 (1 / a - 1) (Turquin 2019, eq. 16);
//   CND_LOBES_CONSERVING: the diffuse lobe times 1 - g A, not below 0.
// Albedos are taken at no less than NoV 1e-4 and alpha 0.002, where a is 1 to 1e-6 already.
Material joinLobes(Material material, double NoV, CndLobeJoining lobes, bool energyCompensation);

} // namespace candelabra::reference
