// SPDX-License-Identifier: Apache-2.0
// Walks of the trees of occluders in double precision, with which tests compare what kernels find
// and what a look at every triangle finds.
#pragma once

#include <algorithm>
#include <cmath>
#include <span>
#include <tuple>
#include <vector>

#include <glm/geometric.hpp>
#include <glm/mat3x3.hpp>

#include "occluders/occluder_tree.h"

namespace candelabra::test
{

struct Segment {
    glm::dvec3 from, to;
};

// Tells whether a segment crosses a triangle. The signs of four volumes decide: the ends are on
// different sides of the plane, and the line passes all edges on the same side.
inline bool crosses(const Segment& s, const gpu::OccluderTriangle& triangle)
{
    const glm::dvec3 along = s.to - s.from;
    glm::dvec3 corners[3];
    for (int i = 0; i < 3; ++i)
        corners[i] = glm::dvec3(triangle.corners[i]) - s.from;
    const auto volume = [](const glm::dvec3& a, const glm::dvec3& b, const glm::dvec3& c) {
        return glm::dot(glm::cross(a, b), c);
    };
    const double edges[3] = {volume(corners[0], corners[1], along),
                             volume(corners[1], corners[2], along),
                             volume(corners[2], corners[0], along)};
    const auto [low, high] = std::minmax_element(edges, edges + 3);
    if ((*low < 0 && *high > 0) || (*low == 0 && *high == 0)) // of both signs; or no area
        return false;
    const glm::dvec3 normal = glm::cross(corners[1] - corners[0], corners[2] - corners[0]);
    const double atFrom = glm::dot(normal, corners[0]);
    const double atTo = glm::dot(normal, corners[0] - along);
    return (atFrom >= 0) != (atTo >= 0);
}

// Tells whether a segment touches a box that is a little wider than this one.
inline bool touches(const Segment& s, const lighting::Box& box)
{
    double first = 0, last = 1;
    for (int axis = 0; axis < 3; ++axis) {
        const double from = s.from[axis], along = s.to[axis] - from;
        const double margin = 1e-9 * (1 + std::abs(from));
        const double low = box.low[axis] - margin, high = box.high[axis] + margin;
        if (along == 0) {
            if (from < low || from > high)
                return false;
            continue;
        }
        const double a = (low - from) / along, b = (high - from) / along;
        first = std::max(first, std::min(a, b));
        last = std::min(last, std::max(a, b));
    }
    return first <= last;
}

// Calls `visit` with the index of each item in the leaves that a segment touches.
template <typename Visit>
void walkTree(std::span<const gpu::OccluderNode> nodes, const Segment& s, Visit&& visit)
{
    const uint32_t end = nodes.empty() ? 0 : nodes[0].skip;
    for (uint32_t node = 0; node < end;) {
        const gpu::OccluderNode& n = nodes[node];
        const bool enters = touches(s, lighting::boxOf(n));
        for (uint32_t i = lighting::leafFirst(n); enters && i < lighting::leafEnd(n); ++i)
            visit(i);
        node = enters && !n.leaf ? node + 1 : n.skip;
    }
}

} // namespace candelabra::test
