// SPDX-License-Identifier: Apache-2.0
#include "gbuffer/levels.h"

#include <algorithm>
#include <cfloat>
#include <cmath>

#include <glm/gtc/type_ptr.hpp>
#include <meshoptimizer.h>

#include "gbuffer/nearest_triangle.h"
#include "shared/raster.h"

namespace candelabra::gbuffer
{
namespace
{

constexpr size_t smallestMesh = 24;  // triangles; there is little to gain with fewer
constexpr size_t coarsestLevel = 12; // triangles that the coarsest level is asked for
// The coarsest level is asked for no less than this share of the mesh's triangles.
constexpr double coarsestShare = 1.0 / 256;
// A level must have at most this share of the triangles of the level before it.
constexpr double worthwhile = 0.8;

std::vector<glm::dvec3> cornersOf(std::span<const Vertex> vertices,
                                  std::span<const uint32_t> indices)
{
    std::vector<glm::dvec3> out;
    out.reserve(indices.size());
    for (const uint32_t i : indices)
        out.emplace_back(glm::make_vec3(vertices[i].position));
    return out;
}

double areaOf(const glm::dvec3* p)
{
    return 0.5 * glm::length(glm::cross(p[1] - p[0], p[2] - p[0]));
}

// The smallest of the three heights of a triangle.
double widthOf(const glm::dvec3* p)
{
    const double longest =
        std::max({glm::length(p[1] - p[0]), glm::length(p[2] - p[1]), glm::length(p[0] - p[2])});
    return longest > 0 ? 2 * areaOf(p) / longest : 0;
}

template <size_t N>
double difference(const float (&a)[N], const double (&b)[N])
{
    double squared = 0;
    for (size_t i = 0; i < N; ++i)
        squared += (a[i] - b[i]) * (a[i] - b[i]);
    return std::sqrt(squared);
}

// Measures how far vertex attributes are off, in units of object space. Normals and colours: the
// difference times a quarter of the width of the coarse triangle, which is the height of a roof of
// that width with such a difference between its two slopes. Texture coordinates: the difference
// times the length that a difference of 1 has on average, which is how far a texture slides.
class AttributeError
{
public:
    AttributeError(std::span<const Vertex> vertices, std::span<const uint32_t> indices,
                   Attributes attributes)
        : vertices_(vertices), attributes_(attributes)
    {
        if (attributes == Attributes::Normals)
            return;
        double area = 0, uvAreas[2]{};
        const std::vector<glm::dvec3> corners = cornersOf(vertices, indices);
        for (size_t i = 0; i < indices.size(); i += 3) {
            area += areaOf(&corners[i]);
            const Vertex &a = vertices[indices[i]], &b = vertices[indices[i + 1]],
                         &c = vertices[indices[i + 2]];
            uvAreas[0] += uvArea(a.uv0, b.uv0, c.uv0);
            uvAreas[1] += uvArea(a.uv1, b.uv1, c.uv1);
        }
        for (int set = 0; set < 2; ++set)
            lengthPerUv_[set] = uvAreas[set] > 0 ? std::sqrt(area / uvAreas[set]) : 0;
    }

    // The error at vertex v, for which the point of a triangle at `weights` is shown instead.
    double at(const Vertex& v, const uint32_t* triangle, const glm::dvec3& weights,
              double width) const
    {
        const Vertex *a = &vertices_[triangle[0]], *b = &vertices_[triangle[1]],
                     *c = &vertices_[triangle[2]];
        const auto mixed = [&](auto member, auto& out) {
            for (size_t i = 0; i < std::size(out); ++i)
                out[i] = weights.x * (a->*member)[i] + weights.y * (b->*member)[i] +
                         weights.z * (c->*member)[i];
        };
        double normal[3];
        mixed(&Vertex::normal, normal);
        const double length = glm::length(glm::make_vec3(normal));
        for (double& x : normal)
            x /= std::max(length, DBL_MIN);
        double worst = 0.25 * width * difference(v.normal, normal);
        if (attributes_ == Attributes::Normals)
            return worst;
        double color[4], uv0[2], uv1[2];
        mixed(&Vertex::color, color);
        mixed(&Vertex::uv0, uv0);
        mixed(&Vertex::uv1, uv1);
        return std::max({worst, 0.25 * width * difference(v.color, color),
                         lengthPerUv_[0] * difference(v.uv0, uv0),
                         lengthPerUv_[1] * difference(v.uv1, uv1)});
    }

private:
    static double uvArea(const float (&a)[2], const float (&b)[2], const float (&c)[2])
    {
        return 0.5 * std::abs((double(b[0]) - a[0]) * (double(c[1]) - a[1]) -
                              (double(c[0]) - a[0]) * (double(b[1]) - a[1]));
    }

    std::span<const Vertex> vertices_;
    Attributes attributes_;
    double lengthPerUv_[2]{};
};

// A mesh as what its levels are compared with.
class Original
{
public:
    Original(std::span<const Vertex> vertices, std::span<const uint32_t> indices,
             Attributes attributes)
        : vertices_(vertices),
          corners_(cornersOf(vertices, indices)),
          tree_(corners_),
          attributeError_(vertices, indices, attributes),
          used_(indices.begin(), indices.end())
    {
        std::sort(used_.begin(), used_.end());
        used_.erase(std::unique(used_.begin(), used_.end()), used_.end());
    }

    double errorOf(const std::vector<uint32_t>& level) const
    {
        const std::vector<glm::dvec3> corners = cornersOf(vertices_, level);
        return std::max(errorAtVertices(level, corners), distanceOf(corners));
    }

private:
    double errorAtVertices(const std::vector<uint32_t>& level,
                           const std::vector<glm::dvec3>& corners) const
    {
        const TriangleTree tree(corners);
        double worst = 0;
        for (const uint32_t i : used_) {
            const Vertex& v = vertices_[i];
            const auto cost = [&](uint32_t triangle, const glm::dvec3& weights, double distance) {
                const size_t first = 3 * size_t(triangle);
                return std::max(distance, attributeError_.at(v, &level[first], weights,
                                                             widthOf(&corners[first])));
            };
            worst =
                std::max(worst, tree.least(glm::dvec3(glm::make_vec3(v.position)), cost, worst));
        }
        return worst;
    }

    double distanceOf(const std::vector<glm::dvec3>& corners) const
    {
        const auto distance = [](uint32_t, const glm::dvec3&, double d) { return d; };
        double worst = 0;
        for (size_t i = 0; i < corners.size(); i += 3) {
            const glm::dvec3 &a = corners[i], &b = corners[i + 1], &c = corners[i + 2];
            for (const glm::dvec3& sample :
                 {0.5 * (a + b), 0.5 * (b + c), 0.5 * (c + a), (a + b + c) / 3.0})
                worst = std::max(worst, tree_.least(sample, distance, worst));
        }
        return worst;
    }

    std::span<const Vertex> vertices_;
    std::vector<glm::dvec3> corners_;
    TriangleTree tree_;
    AttributeError attributeError_;
    std::vector<uint32_t> used_; // vertices, in ascending order
};

std::vector<uint32_t> simplified(std::span<const Vertex> vertices,
                                 std::span<const uint32_t> indices, size_t triangles)
{
    std::vector<uint32_t> out(indices.size()), ordered;
    out.resize(meshopt_simplify(out.data(), indices.data(), indices.size(),
                                vertices.front().position, vertices.size(), sizeof(Vertex),
                                3 * triangles, FLT_MAX, meshopt_SimplifyLockBorder, nullptr));
    ordered.resize(out.size());
    meshopt_optimizeVertexCache(ordered.data(), out.data(), out.size(), vertices.size());
    return ordered;
}

} // namespace

std::vector<Level> coarserLevels(std::span<const Vertex> vertices,
                                 std::span<const uint32_t> indices, Attributes attributes)
{
    const size_t triangles = indices.size() / 3;
    std::vector<Level> levels;
    if (triangles < smallestMesh)
        return levels;
    const double last =
        std::max(double(coarsestLevel) / double(triangles), coarsestShare); // share of all
    const double step = std::pow(last, 1.0 / (gpu::MESH_LEVELS - 1));
    const Original original(vertices, indices, attributes);
    size_t before = indices.size();
    double share = 1;
    for (uint32_t level = 1; level < gpu::MESH_LEVELS; ++level) {
        share *= step;
        std::vector<uint32_t> coarse =
            simplified(vertices, indices, size_t(share * double(triangles)));
        if (coarse.empty() || double(coarse.size()) > worthwhile * double(before))
            continue;
        before = coarse.size();
        // Rounding to float must not make the error smaller.
        float error = std::nextafter(float(original.errorOf(coarse)), FLT_MAX);
        if (!levels.empty())
            error = std::max(error, levels.back().error);
        levels.push_back({std::move(coarse), error});
    }
    return levels;
}

} // namespace candelabra::gbuffer
