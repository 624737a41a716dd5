// SPDX-License-Identifier: Apache-2.0
#include "scene/light_placement.h"

#include <cassert>

namespace candelabra::app
{

void placeLights(Scene& scene, const std::vector<glm::dvec3>& worldPositions)
{
    assert(worldPositions.size() == scene.lights.size());
    constexpr double nearOrigin = 1024; // metres
    glm::dvec3 low{0}, high{0};
    bool first = true;
    for (size_t i = 0; i < worldPositions.size(); ++i) {
        if (cndIsDistant(scene.lights[i].type))
            continue;
        low = first ? worldPositions[i] : glm::min(low, worldPositions[i]);
        high = first ? worldPositions[i] : glm::max(high, worldPositions[i]);
        first = false;
    }
    const glm::dvec3 extent = glm::max(glm::abs(low), glm::abs(high));
    const bool isNear = extent.x <= nearOrigin && extent.y <= nearOrigin && extent.z <= nearOrigin;
    scene.lightOrigin = isNear ? glm::dvec3(0) : 0.5 * (low + high);
    for (size_t i = 0; i < worldPositions.size(); ++i)
        for (int k = 0; k < 3 && !cndIsDistant(scene.lights[i].type); ++k)
            scene.lights[i].position[k] = float(worldPositions[i][k] - scene.lightOrigin[k]);
}

} // namespace candelabra::app
