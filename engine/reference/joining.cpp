// SPDX-License-Identifier: Apache-2.0
#include "reference/joining.h"

#include <algorithm>

#include "reference/albedo.h"

namespace candelabra::reference
{

Material joinLobes(Material material, double NoV, CndLobeJoining lobes, bool energyCompensation)
{
    const bool specular = material.f0 != glm::dvec3(0) || material.specularWeight != 0;
    if (!specular || (lobes == CND_LOBES_SUM && !energyCompensation))
        return material;
    const DirectionalAlbedo albedo =
        specularAlbedo(std::clamp(NoV, 1e-4, 1.0), std::max(material.alpha, 0.002), 1e-5);
    if (energyCompensation)
        material.specularGain *= 1.0 + material.f0 * (1 / albedo.a - 1);
    if (lobes == CND_LOBES_CONSERVING) {
        const glm::dvec3 share =
            material.f0 * (albedo.a - albedo.b) + glm::dvec3(material.specularWeight * albedo.b);
        material.diffuseAlbedo *= glm::max(1.0 - material.specularGain * share, glm::dvec3(0));
    }
    return material;
}

} // namespace candelabra::reference
