// SPDX-License-Identifier: Apache-2.0
#include "occluders/neighbours.h"

#include <algorithm>
#include <bit>
#include <compare>

namespace candelabra::lighting
{
namespace
{

// The corners of a mesh are counted as 3 triangle + corner, and so are its edges: an edge begins at
// its corner.
constexpr uint32_t nextCorner(uint32_t corner)
{
    return corner % 3 == 2 ? corner - 2 : corner + 1;
}

// Returns an index for each corner; equal positions have equal ones.
std::vector<uint32_t> vertexIndices(std::span<const gpu::OccluderTriangle> triangles)
{
    struct Corner {
        uint32_t x, y, z, corner;
        auto operator<=>(const Corner&) const = default;
    };
    std::vector<Corner> corners;
    corners.reserve(3 * triangles.size());
    for (const gpu::OccluderTriangle& t : triangles)
        for (const glm::vec3& p : t.corners)
            corners.push_back({std::bit_cast<uint32_t>(p.x), std::bit_cast<uint32_t>(p.y),
                               std::bit_cast<uint32_t>(p.z), uint32_t(corners.size())});
    std::ranges::sort(corners);
    std::vector<uint32_t> out(corners.size());
    uint32_t index = 0;
    for (size_t i = 0; i < corners.size(); ++i) {
        const Corner &a = corners[i], &b = corners[i ? i - 1 : 0];
        index += a.x != b.x || a.y != b.y || a.z != b.z;
        out[a.corner] = index;
    }
    return out;
}

// Copies the neighbours at whose edge the ends are the same in both triangles. `end` returns what
// stands for a corner of a triangle.
template <typename End>
void copyNeighbours(std::span<const gpu::OccluderNeighbours> neighbours,
                    std::span<gpu::OccluderNeighbours> out, End&& end) noexcept
{
    const auto meets = [&](uint32_t triangle, uint32_t edge) {
        const uint32_t word = neighbours[triangle].edges[edge], other = word >> 1;
        if (word == gpu::NO_NEIGHBOUR)
            return false;
        for (uint32_t i = 0; i < 3; ++i) {
            if (neighbours[other].edges[i] != (triangle << 1 | (word & 1)))
                continue;
            const uint32_t from = word & 1 ? i : nextCorner(i), to = word & 1 ? nextCorner(i) : i;
            if (end(triangle, edge) == end(other, from) &&
                end(triangle, nextCorner(edge)) == end(other, to))
                return true;
        }
        return false;
    };
    for (uint32_t t = 0; t < neighbours.size(); ++t)
        for (uint32_t edge = 0; edge < 3; ++edge)
            out[t].edges[edge] = meets(t, edge) ? neighbours[t].edges[edge] : gpu::NO_NEIGHBOUR;
}

} // namespace

Neighbours findNeighbours(std::span<const gpu::OccluderTriangle> triangles)
{
    struct Edge {
        uint32_t low, high, edge; // the indices of its ends, in order
        bool joins(const Edge& other) const { return low == other.low && high == other.high; }
        auto operator<=>(const Edge&) const = default;
    };
    const std::vector<uint32_t> vertices = vertexIndices(triangles);
    std::vector<Edge> edges;
    edges.reserve(vertices.size());
    for (uint32_t i = 0; i < vertices.size(); ++i) {
        const auto [low, high] = std::minmax(vertices[i], vertices[nextCorner(i)]);
        if (low != high)
            edges.push_back({low, high, i});
    }
    std::ranges::sort(edges);
    constexpr uint32_t none = gpu::NO_NEIGHBOUR;
    Neighbours out(triangles.size(), {{none, none, none}});
    for (size_t first = 0, end = 0; first < edges.size(); first = end) {
        end = first + 1;
        while (end < edges.size() && edges[end].joins(edges[first]))
            ++end;
        const uint32_t a = edges[first].edge, b = edges[end - 1].edge;
        if (end - first != 2 || a / 3 == b / 3)
            continue;
        const uint32_t turned = vertices[a] == vertices[b];
        out[a / 3].edges[a % 3] = b / 3 << 1 | turned;
        out[b / 3].edges[b % 3] = a / 3 << 1 | turned;
    }
    return out;
}

void copyNeighboursThatMeet(std::span<const gpu::OccluderTriangle> triangles,
                            std::span<const gpu::OccluderNeighbours> neighbours,
                            std::span<gpu::OccluderNeighbours> out) noexcept
{
    copyNeighbours(neighbours, out, [&](uint32_t triangle, uint32_t corner) {
        return triangles[triangle].corners[corner];
    });
}

void copyNeighboursOfVertices(std::span<const glm::uvec3> corners,
                              std::span<const gpu::OccluderNeighbours> neighbours,
                              std::span<gpu::OccluderNeighbours> out) noexcept
{
    copyNeighbours(neighbours, out, [&](uint32_t triangle, uint32_t corner) {
        return corners[triangle][int(corner)];
    });
}

} // namespace candelabra::lighting
