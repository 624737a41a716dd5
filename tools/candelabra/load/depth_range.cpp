// SPDX-License-Identifier: Apache-2.0
#include "load/depth_range.h"

#include <algorithm>
#include <limits>

#include "candelabra/glm.hpp"

namespace candelabra::app
{
namespace
{

// Adds the box around the emitter of a light, wherever its motion takes it.
void addEmitter(const Scene& scene, size_t index, Bounds& bounds)
{
    const CndLight& light = scene.lights[index];
    if (cndIsDistant(light.type) || cndIsPunctual(light.type))
        return;
    double reach = double{cndEmitterBoundingRadius(&light)};
    if (index < scene.lightMotions.size())
        reach += double{glm::length(scene.lightMotions[index].axisU)} +
                 double{glm::length(scene.lightMotions[index].axisV)};
    const glm::dvec3 centre = scene.lightOrigin + glm::dvec3(toGlm(light.position));
    bounds.min = glm::min(bounds.min, centre - reach);
    bounds.max = glm::max(bounds.max, centre + reach);
}

} // namespace

void fitDepthRanges(Scene& scene)
{
    constexpr double infinity = std::numeric_limits<double>::infinity();
    Bounds bounds{glm::dvec3(infinity), glm::dvec3(-infinity)};
    if (!scene.instances.empty())
        bounds = sceneBounds(scene);
    for (size_t i = 0; i < scene.lights.size(); ++i)
        addEmitter(scene, i, bounds);
    if (!(bounds.min.x <= bounds.max.x))
        return;
    const glm::dvec3 middle = 0.5 * (bounds.min + bounds.max), half = bounds.max - middle;
    for (Camera& camera : scene.cameras) {
        if (!camera.orthographic)
            continue;
        const double depth = glm::dot(middle - camera.position, camera.forward);
        const double reach = 3 * glm::length(half);
        const double nearPlane = std::max(camera.nearPlane, depth - reach);
        const double farPlane = std::min(camera.farPlane, depth + reach);
        if (farPlane > nearPlane) { // else the camera shows nothing
            camera.nearPlane = nearPlane;
            camera.farPlane = farPlane;
        }
    }
}

} // namespace candelabra::app
