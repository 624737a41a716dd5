// SPDX-License-Identifier: Apache-2.0
#include "scene/light_placement.h"

#include <cassert>

namespace candelabra::app
{

namespace
{

// True if the light is infinitely far away, so that its position means nothing.
bool isDistant(const CndLight& light)
{
    return light.type == CND_LIGHT_DIRECTIONAL || light.type == CND_LIGHT_DISTANT_SPHERE;
}

} // namespace

void placeLights(Scene& scene, const std::vector<glm::dvec3>& worldPositions)
{
    assert(worldPositions.size() == scene.lights.size());
    constexpr double nearOrigin = 1024; // metres
    glm::dvec3 low{0}, high{0};
    bool first = true;
    for (size_t i = 0; i < worldPositions.size(); ++i) {
        if (isDistant(scene.lights[i]))
            continue;
        low = first ? worldPositions[i] : glm::min(low, worldPositions[i]);
        high = first ? worldPositions[i] : glm::max(high, worldPositions[i]);
        first = false;
    }
    const glm::dvec3 extent = glm::max(glm::abs(low), glm::abs(high));
    const bool isNear = extent.x <= nearOrigin && extent.y <= nearOrigin && extent.z <= nearOrigin;
    scene.lightOrigin = isNear ? glm::dvec3(0) : 0.5 * (low + high);
    for (size_t i = 0; i < worldPositions.size(); ++i)
        for (int k = 0; k < 3 && !isDistant(scene.lights[i]); ++k)
            scene.lights[i].position[k] =
                static_cast<float>(worldPositions[i][k] - scene.lightOrigin[k]);
}

} // namespace candelabra::app
