// SPDX-License-Identifier: Apache-2.0
#include "viewer/light_handles.h"

#include <algorithm>
#include <bit>
#include <cmath>

namespace candelabra::app
{
namespace
{

// A handle cannot be dragged if the sine of its angle to the view is smaller.
constexpr double smallestSine = 0.1;

// Returns the direction of an axis, which is given by its bit in the mask of a handle.
glm::dvec3 directionOf(uint32_t axisBit)
{
    return {axisBit == 1, axisBit == 2, axisBit == 4};
}

bool isLine(uint32_t handle)
{
    return std::has_single_bit(handle);
}

double distanceToSegment(glm::dvec2 p, glm::dvec2 a, glm::dvec2 b)
{
    const glm::dvec2 d = b - a;
    const double t = std::clamp(glm::dot(p - a, d) / std::max(glm::dot(d, d), 1e-12), 0.0, 1.0);
    return glm::length(a + t * d - p);
}

// Tells whether the point `p` of the picture is inside a quadrilateral. `edges` holds both ends of
// every edge that is in front of the camera. The function returns false unless all four are.
bool isInside(glm::dvec2 p, const std::vector<glm::dvec2>& edges)
{
    int left = 0, right = 0;
    for (size_t i = 0; i + 1 < edges.size(); i += 2) {
        const glm::dvec2 d = edges[i + 1] - edges[i], e = p - edges[i];
        (d.x * e.y - d.y * e.x < 0 ? left : right) += 1;
    }
    return edges.size() == 8 && (left == 0 || right == 0);
}

} // namespace

std::vector<glm::dvec3> LightHandles::outlineOf(uint32_t handle) const
{
    std::vector<glm::dvec3> axes;
    for (const uint32_t axis : {1u, 2u, 4u})
        if (handle & axis)
            axes.push_back(length * directionOf(axis));
    if (axes.size() == 1)
        return {centre + 0.15 * axes[0], centre + axes[0]};
    const glm::dvec3 near = centre + 0.3 * (axes[0] + axes[1]), u = 0.25 * axes[0],
                     v = 0.25 * axes[1];
    return {near, near + u, near + u + v, near + v, near};
}

std::optional<uint32_t> LightHandles::at(const Projection& view, glm::dvec2 place,
                                         double slack) const
{
    std::optional<uint32_t> nearest;
    double best = slack;
    for (const uint32_t handle : all) {
        const std::vector<glm::dvec2> ends = view.segments(outlineOf(handle));
        if (!isLine(handle) && isInside(place, ends) && pointOn(handle, view, place))
            return handle;
        if (!isLine(handle) || ends.empty() || !pointOn(handle, view, place))
            continue;
        if (const double miss = distanceToSegment(place, ends[0], ends[1]); miss <= best) {
            best = miss;
            nearest = handle;
        }
    }
    return nearest;
}

std::optional<glm::dvec3> LightHandles::pointOn(uint32_t handle, const Projection& view,
                                                glm::dvec2 place) const
{
    const Projection::Line line = view.lineAt(place);
    const glm::dvec3 w = centre - line.origin;
    if (!isLine(handle)) {
        const glm::dvec3 normal = directionOf(7 ^ handle);
        const double facing = glm::dot(normal, line.direction);
        const double along = glm::dot(normal, w) / facing;
        if (std::abs(facing) < smallestSine || along <= 0)
            return {};
        return line.origin + along * line.direction;
    }
    // The point of the axis that is nearest to the line of sight.
    const glm::dvec3 axis = directionOf(handle);
    const double across = glm::dot(axis, line.direction);
    const double slope = 1 - across * across;
    const double t =
        (across * glm::dot(w, line.direction) - glm::dot(w, axis)) / std::max(slope, 1e-12);
    const glm::dvec3 point = centre + t * axis;
    if (slope < smallestSine * smallestSine || glm::dot(point - line.origin, line.direction) <= 0)
        return {};
    return point;
}

} // namespace candelabra::app
