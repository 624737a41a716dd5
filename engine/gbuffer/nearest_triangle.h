// SPDX-License-Identifier: Apache-2.0
// Finds the triangle of a mesh that is nearest to a point, by a tree of boxes.
#pragma once

#include <algorithm>
#include <cstdint>
#include <limits>
#include <span>
#include <vector>

#include <glm/common.hpp>
#include <glm/geometric.hpp>
#include <glm/vec3.hpp>

namespace candelabra::gbuffer
{

// The point of the triangle a, b, c that is nearest to `point`, as weights of the three corners.
glm::dvec3 nearestWeights(const glm::dvec3& point, const glm::dvec3& a, const glm::dvec3& b,
                          const glm::dvec3& c);

class TriangleTree
{
public:
    // `corners` has three points per triangle and must outlive the tree.
    explicit TriangleTree(std::span<const glm::dvec3> corners);

    // Returns the least cost(triangle, weights, distance) of all triangles, where `weights` names
    // the point of the triangle nearest to `point` and `distance` is how far that is. A cost must
    // not be lower than the distance. The first cost found that is at most `enough` is returned
    // without a look at other triangles.
    template <typename Cost>
    double least(const glm::dvec3& point, Cost&& cost, double enough = 0) const
    {
        double limit = std::numeric_limits<double>::max();
        uint32_t stack[maxDepth];
        uint32_t size = 0;
        stack[size++] = 0;
        while (size && limit > enough) {
            const Node& node = nodes_[stack[--size]];
            if (distance(node, point) >= limit)
                continue;
            if (node.count) {
                for (uint32_t i = node.first; i < node.first + node.count; ++i)
                    limit = std::min(limit, triangleCost(order_[i], point, cost));
                continue;
            }
            // The nearer child is on top of the stack, so that it is visited first.
            const uint32_t left = node.first, right = node.first + 1;
            const bool leftFirst = distance(nodes_[left], point) <= distance(nodes_[right], point);
            stack[size++] = leftFirst ? right : left;
            stack[size++] = leftFirst ? left : right;
        }
        return limit;
    }

private:
    // Halving at the median makes the tree no deeper than the bits of an index; a walk keeps at
    // most one node per level and the two children of the last.
    static constexpr uint32_t maxDepth = 64;
    struct Node {
        glm::dvec3 low, high;
        uint32_t first; // leaf: its first triangle in order_; otherwise the first of two children
        uint32_t count; // leaf: its number of triangles; otherwise 0
    };

    static double distance(const Node& node, const glm::dvec3& point)
    {
        return glm::length(point - glm::clamp(point, node.low, node.high));
    }
    template <typename Cost>
    double triangleCost(uint32_t triangle, const glm::dvec3& point, Cost& cost) const
    {
        const glm::dvec3* const p = &corners_[3 * size_t(triangle)];
        const glm::dvec3 weights = nearestWeights(point, p[0], p[1], p[2]);
        const glm::dvec3 nearest = weights.x * p[0] + weights.y * p[1] + weights.z * p[2];
        return cost(triangle, weights, glm::length(point - nearest));
    }
    void build(uint32_t node, uint32_t first, uint32_t count);

    std::span<const glm::dvec3> corners_;
    std::vector<uint32_t> order_; // triangles, those of a leaf one after another
    std::vector<Node> nodes_;     // [0] is the root
};

} // namespace candelabra::gbuffer
