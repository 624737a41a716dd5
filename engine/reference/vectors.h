// SPDX-License-Identifier: Apache-2.0
// Vectors of the public interface in double precision.
#pragma once

#include <vector>

#include <glm/glm.hpp>

#include "candelabra/candelabra.h"

namespace candelabra::reference
{

inline glm::dvec3 vec3(const float (&values)[3])
{
    return {values[0], values[1], values[2]};
}

// Returns the corners of a polygon light whose position is `center`, in their order.
inline std::vector<glm::dvec3> polygonCorners(const CndLight& light, const glm::dvec3& center)
{
    std::vector<glm::dvec3> out;
    for (uint32_t i = 0; i < light.polygon->cornerCount; ++i) {
        const float(&corner)[2] = light.polygon->corners[i];
        out.push_back(center + double(corner[0]) * vec3(light.axisU) +
                      double(corner[1]) * vec3(light.axisV));
    }
    return out;
}

} // namespace candelabra::reference
