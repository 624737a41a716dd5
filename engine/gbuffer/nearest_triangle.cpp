// SPDX-License-Identifier: Apache-2.0
#include "gbuffer/nearest_triangle.h"

#include <numeric>

namespace candelabra::gbuffer
{
namespace
{

constexpr uint32_t leafTriangles = 4;

// The share of the way from a to b at which the line is nearest to `point`, within the segment.
double alongEdge(const glm::dvec3& point, const glm::dvec3& a, const glm::dvec3& b)
{
    const glm::dvec3 edge = b - a;
    const double squared = glm::dot(edge, edge);
    return squared > 0 ? std::clamp(glm::dot(point - a, edge) / squared, 0.0, 1.0) : 0;
}

} // namespace

glm::dvec3 nearestWeights(const glm::dvec3& point, const glm::dvec3& a, const glm::dvec3& b,
                          const glm::dvec3& c)
{
    // Above the triangle it is the foot of the perpendicular: its weights are the areas of the
    // three triangles that it makes with the edges.
    const glm::dvec3 normal = glm::cross(b - a, c - a);
    const double area = glm::dot(normal, normal);
    if (area > 0) {
        const glm::dvec3 w{glm::dot(normal, glm::cross(c - b, point - b)),
                           glm::dot(normal, glm::cross(a - c, point - c)),
                           glm::dot(normal, glm::cross(b - a, point - a))};
        if (w.x >= 0 && w.y >= 0 && w.z >= 0)
            return w / (w.x + w.y + w.z);
    }
    // Elsewhere it is on one of the edges.
    const double ab = alongEdge(point, a, b), bc = alongEdge(point, b, c),
                 ca = alongEdge(point, c, a);
    const glm::dvec3 candidates[] = {{1 - ab, ab, 0}, {0, 1 - bc, bc}, {ca, 0, 1 - ca}};
    const auto squaredDistance = [&](const glm::dvec3& w) {
        const glm::dvec3 away = point - (w.x * a + w.y * b + w.z * c);
        return glm::dot(away, away);
    };
    return *std::min_element(
        std::begin(candidates), std::end(candidates),
        [&](const auto& x, const auto& y) { return squaredDistance(x) < squaredDistance(y); });
}

TriangleTree::TriangleTree(std::span<const glm::dvec3> corners)
    : corners_(corners), order_(corners.size() / 3)
{
    std::iota(order_.begin(), order_.end(), 0u);
    nodes_.reserve(order_.size() + 1);
    nodes_.emplace_back();
    build(0, 0, uint32_t(order_.size()));
}

void TriangleTree::build(uint32_t node, uint32_t first, uint32_t count)
{
    glm::dvec3 low(std::numeric_limits<double>::max()), high(-low);
    for (uint32_t i = first; i < first + count; ++i) {
        for (size_t corner = 0; corner < 3; ++corner) {
            const glm::dvec3& p = corners_[3 * size_t(order_[i]) + corner];
            low = glm::min(low, p);
            high = glm::max(high, p);
        }
    }
    if (count <= leafTriangles) {
        nodes_[node] = {low, high, first, count};
        return;
    }
    const glm::dvec3 size = high - low;
    const int axis = size.x >= size.y && size.x >= size.z ? 0 : size.y >= size.z ? 1 : 2;
    const auto place = [&](uint32_t triangle) {
        const glm::dvec3* const p = &corners_[3 * size_t(triangle)];
        return p[0][axis] + p[1][axis] + p[2][axis];
    };
    const auto begin = order_.begin() + first;
    std::nth_element(begin, begin + count / 2, begin + count, [&](uint32_t a, uint32_t b) {
        return place(a) < place(b) || (place(a) == place(b) && a < b);
    });
    const uint32_t children = uint32_t(nodes_.size());
    nodes_[node] = {low, high, children, 0};
    nodes_.resize(nodes_.size() + 2);
    build(children, first, count / 2);
    build(children + 1, first + count / 2, count - count / 2);
}

} // namespace candelabra::gbuffer
