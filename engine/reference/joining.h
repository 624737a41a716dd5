// SPDX-License-Identifier: Apache-2.0
// Divides the light between the two lobes of a material, in double precision.
#pragma once

#include "candelabra/candelabra.h"
#include "reference/surface.h"

namespace candelabra::reference
{

// Returns the material as it appears to an eye at this cosine. With A = F0 (a - b) + F90 b, the
// share of uniform surroundings that its specular lobe reflects (albedo.h):
//   energyCompensation: the specular lobe is multiplied by g = 1 + F0 (1 / a - 1) (Turquin 2019,
//     eq. 16);
//   CND_LOBES_CONSERVING: the diffuse lobe is multiplied by 1 - g A, at least 0.
// Albedos are evaluated at NoV >= 1e-4 and alpha >= 0.002, where a differs from 1 by less than
// 1e-6.
Material joinLobes(Material material, double NoV, CndLobeJoining lobes, bool energyCompensation);

} // namespace candelabra::reference
