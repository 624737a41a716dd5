// SPDX-License-Identifier: Apache-2.0
// Tests the levels of detail of meshes, and what their errors are measured with.
#include <algorithm>
#include <cmath>
#include <map>
#include <random>
#include <set>

#include <glm/gtc/type_ptr.hpp>
#include <gtest/gtest.h>

#include "gbuffer/levels.h"
#include "gbuffer/meshes.h"
#include "gbuffer/nearest_triangle.h"
#include "generate/shapes.h"
#include "shared/raster.h"

namespace candelabra::test
{
namespace
{

using gbuffer::Attributes;
using gbuffer::Level;

struct TestMesh {
    std::vector<gbuffer::Vertex> vertices;
    std::vector<uint32_t> indices;

    std::vector<glm::dvec3> corners(const std::vector<uint32_t>& of) const
    {
        std::vector<glm::dvec3> out;
        for (const uint32_t i : of)
            out.emplace_back(glm::make_vec3(vertices[i].position));
        return out;
    }
    std::vector<Level> levels(Attributes attributes = Attributes::Normals) const
    {
        return gbuffer::coarserLevels(vertices, indices, attributes);
    }
};

// The mesh with one vertex for each pair of position and normal.
TestMesh welded(const app::Mesh& mesh)
{
    TestMesh out;
    std::map<std::array<float, 6>, uint32_t> known;
    for (const uint32_t i : mesh.indices) {
        const app::Vertex& v = mesh.vertices[i];
        // Adding 0 turns -0 into 0.
        const std::array<float, 6> key{v.position.x + 0, v.position.y + 0, v.position.z + 0,
                                       v.normal.x + 0,   v.normal.y + 0,   v.normal.z + 0};
        const auto [entry, isNew] = known.try_emplace(key, uint32_t(out.vertices.size()));
        if (isNew)
            out.vertices.push_back({.position = {key[0], key[1], key[2]},
                                    .normal = {key[3], key[4], key[5]},
                                    .tangent = {1, 0, 0, 1},
                                    .uv0 = {v.uv[0].x, v.uv[0].y},
                                    .uv1 = {v.uv[1].x, v.uv[1].y},
                                    .color = {1, 1, 1, 1}});
        out.indices.push_back(entry->second);
    }
    return out;
}

// A grid of n x n quads in the unit square, with heights and texture coordinates of one's choice.
template <typename Height, typename Uv>
TestMesh grid(uint32_t n, Height&& height, Uv&& uv)
{
    TestMesh out;
    for (uint32_t y = 0; y <= n; ++y)
        for (uint32_t x = 0; x <= n; ++x) {
            const float u = float(x) / float(n), v = float(y) / float(n);
            const glm::vec2 t = uv(u, v);
            out.vertices.push_back({.position = {u, height(u, v), v},
                                    .normal = {0, 1, 0},
                                    .tangent = {1, 0, 0, 1},
                                    .uv0 = {t.x, t.y},
                                    .uv1 = {},
                                    .color = {1, 1, 1, 1}});
        }
    for (uint32_t y = 0; y < n; ++y)
        for (uint32_t x = 0; x < n; ++x) {
            const uint32_t a = y * (n + 1) + x, d = a + n + 1;
            out.indices.insert(out.indices.end(), {a, d + 1, a + 1, a, d, d + 1});
        }
    return out;
}

constexpr auto flat = [](float, float) { return 0.f; };
constexpr auto straight = [](float u, float v) { return glm::vec2(u, v); };

double nearestByAll(const glm::dvec3& point, const std::vector<glm::dvec3>& corners)
{
    double least = 1e300;
    for (size_t i = 0; i < corners.size(); i += 3) {
        const glm::dvec3 w =
            gbuffer::nearestWeights(point, corners[i], corners[i + 1], corners[i + 2]);
        least = std::min(least, glm::length(point - w.x * corners[i] - w.y * corners[i + 1] -
                                            w.z * corners[i + 2]));
    }
    return least;
}

std::set<std::pair<uint32_t, uint32_t>> openEdges(const std::vector<uint32_t>& indices)
{
    std::set<std::pair<uint32_t, uint32_t>> edges;
    for (size_t i = 0; i < indices.size(); i += 3)
        for (size_t k = 0; k < 3; ++k) {
            const uint32_t a = indices[i + k], b = indices[i + (k + 1) % 3];
            if (!edges.erase({b, a}))
                edges.insert({a, b});
        }
    return edges;
}

TEST(Levels, AreCoarserTrianglesOfTheSameVertices)
{
    for (const app::Mesh& mesh : {app::makeSphere(28, 16), app::makeTorus(1, 0.2f, 40, 12),
                                  app::makeKnot(0.11f, 96, 10), app::makeCylinder(32)}) {
        const TestMesh m = welded(mesh);
        const std::vector<Level> levels = m.levels();
        ASSERT_GE(levels.size(), 2u);
        ASSERT_LT(levels.size(), size_t(gpu::MESH_LEVELS));
        size_t before = m.indices.size();
        float error = 0;
        for (const Level& level : levels) {
            EXPECT_LE(level.indices.size(), before * 4 / 5);
            EXPECT_GE(level.error, error);
            EXPECT_GT(level.error, 0);
            ASSERT_EQ(level.indices.size() % 3, 0u);
            for (size_t i = 0; i < level.indices.size(); i += 3) {
                const uint32_t a = level.indices[i], b = level.indices[i + 1],
                               c = level.indices[i + 2];
                ASSERT_LT(std::max({a, b, c}), m.vertices.size());
                EXPECT_TRUE(a != b && b != c && c != a);
            }
            before = level.indices.size();
            error = level.error;
        }
    }
}

TEST(Levels, AreTheSameInEveryRun)
{
    const TestMesh m = welded(app::makeKnot(0.11f, 96, 10));
    const std::vector<Level> first = m.levels(), second = m.levels();
    ASSERT_EQ(first.size(), second.size());
    for (size_t i = 0; i < first.size(); ++i) {
        EXPECT_EQ(first[i].indices, second[i].indices);
        EXPECT_EQ(first[i].error, second[i].error);
    }
}

// The errors cover the distances of vertices and of points within coarse triangles.
TEST(Levels, ErrorsCoverDistances)
{
    const TestMesh m = welded(app::makeSphere(28, 16));
    const std::vector<glm::dvec3> original = m.corners(m.indices);
    for (const Level& level : m.levels()) {
        const std::vector<glm::dvec3> coarse = m.corners(level.indices);
        double farthest = 0;
        for (const glm::dvec3& p : original)
            farthest = std::max(farthest, nearestByAll(p, coarse));
        for (size_t i = 0; i < coarse.size(); i += 3)
            farthest =
                std::max(farthest,
                         nearestByAll((coarse[i] + coarse[i + 1] + coarse[i + 2]) / 3.0, original));
        EXPECT_GE(level.error, farthest);
        EXPECT_LE(level.error, 2 * farthest); // and are not far above them
    }
}

// Meshes that meet at their open edges must not come apart.
TEST(Levels, OpenEdgesStay)
{
    const TestMesh m = grid(
        16, [](float u, float v) { return 0.1f * std::sin(9 * u) * std::cos(7 * v); }, straight);
    const auto edges = openEdges(m.indices);
    ASSERT_EQ(edges.size(), 64u);
    const std::vector<Level> levels = m.levels();
    ASSERT_FALSE(levels.empty());
    for (const Level& level : levels)
        EXPECT_EQ(openEdges(level.indices), edges);
}

TEST(Levels, FlatMeshesLoseTrianglesWithoutError)
{
    const std::vector<Level> levels = grid(16, flat, straight).levels(Attributes::All);
    ASSERT_FALSE(levels.empty());
    EXPECT_LT(levels.front().error, 1e-6f);
    EXPECT_GT(levels.front().error, 0);
}

// A texture that slides over a flat mesh, and a normal that turns, are errors too.
TEST(Levels, AttributesCount)
{
    const TestMesh wavy =
        grid(16, flat, [](float u, float v) { return glm::vec2(u + 0.1f * std::sin(6 * v), v); });
    EXPECT_LT(wavy.levels(Attributes::Normals).back().error, 1e-6f);
    EXPECT_GT(wavy.levels(Attributes::All).back().error, 0.005f);

    TestMesh turned = grid(16, flat, straight);
    for (gbuffer::Vertex& v : turned.vertices) {
        const glm::vec3 n = glm::normalize(glm::vec3(0.3f * std::sin(20 * v.position[0]), 1, 0));
        std::copy_n(glm::value_ptr(n), 3, v.normal);
    }
    EXPECT_GT(turned.levels().back().error, 0.002f);

    TestMesh coloured = grid(16, flat, straight);
    for (gbuffer::Vertex& v : coloured.vertices)
        v.color[1] = 0.5f + 0.5f * std::sin(20 * v.position[2]);
    EXPECT_LT(coloured.levels(Attributes::Normals).back().error, 1e-6f);
    EXPECT_GT(coloured.levels(Attributes::All).back().error, 0.005f);
}

// Hard edges cannot be simplified without turning normals, and small meshes are not worth it.
TEST(Levels, BoxesHaveNone)
{
    EXPECT_TRUE(welded(app::makeBox()).levels().empty());
    EXPECT_TRUE(welded(app::makeBevelledBox(0.02f)).levels().empty());
}

TEST(Levels, PackedMeshesShareVertices)
{
    const TestMesh m = welded(app::makeSphere(28, 16));
    const gbuffer::Mesh meshes[] = {{m.vertices, m.indices}, {m.vertices, {}}};
    const gbuffer::PackedMeshes packed = gbuffer::packMeshes(meshes, {false, false});
    ASSERT_EQ(packed.meshes.size(), 2u);
    EXPECT_TRUE(packed.meshes[1].levels.empty());
    const std::vector<gbuffer::PackedLevel>& levels = packed.meshes[0].levels;
    ASSERT_GE(levels.size(), 3u);
    EXPECT_EQ(levels[0].indexCount, m.indices.size());
    EXPECT_EQ(levels[0].error, 0);
    uint32_t next = 0;
    for (const gbuffer::PackedLevel& level : levels) {
        EXPECT_EQ(level.firstIndex, next);
        next += level.indexCount;
    }
    EXPECT_EQ(packed.indices.size(), next);
    EXPECT_EQ(packed.core.size(), m.vertices.size());
}

// Vertices that differ in texture coordinates alone are one vertex where no texture is drawn.
TEST(Levels, UntexturedMeshesAreWeldedByWhatIsDrawn)
{
    TestMesh m;
    for (const app::Mesh mesh = app::makeSphere(14, 9); const app::Vertex& v : mesh.vertices)
        m.vertices.push_back({.position = {v.position.x + 0, v.position.y + 0, v.position.z + 0},
                              .normal = {v.normal.x + 0, v.normal.y + 0, v.normal.z + 0},
                              .tangent = {1, 0, 0, 1},
                              .uv0 = {v.uv[0].x, v.uv[0].y},
                              .uv1 = {},
                              .color = {1, 1, 1, 1}});
    m.indices = app::makeSphere(14, 9).indices;
    const gbuffer::Mesh meshes[] = {{m.vertices, m.indices}};
    const size_t plain = gbuffer::packMeshes(meshes, {false}).core.size();
    EXPECT_EQ(plain, 2u + 14 * 8);
    EXPECT_EQ(gbuffer::packMeshes(meshes, {true}).core.size(), 14u * 2 + 15 * 8);
    for (gbuffer::Vertex& v : m.vertices)
        v.color[0] = 0.5f;
    EXPECT_EQ(gbuffer::packMeshes(meshes, {false}).core.size(), 14u * 2 + 15 * 8);
}

TEST(NearestTriangle, WeightsNameTheNearestPoint)
{
    std::mt19937 engine(3);
    std::uniform_real_distribution<double> random(-1, 1);
    const auto point = [&] { return glm::dvec3(random(engine), random(engine), random(engine)); };
    for (int i = 0; i < 200; ++i) {
        const glm::dvec3 a = point(), b = i % 10 ? point() : a, c = point(), p = 2.0 * point();
        const glm::dvec3 w = gbuffer::nearestWeights(p, a, b, c);
        EXPECT_NEAR(w.x + w.y + w.z, 1, 1e-12);
        EXPECT_GE(std::min({w.x, w.y, w.z}), 0);
        const double found = glm::length(p - w.x * a - w.y * b - w.z * c);
        double least = 1e300;
        constexpr int steps = 100;
        for (int s = 0; s <= steps; ++s)
            for (int t = 0; s + t <= steps; ++t) {
                const double u = double(s) / steps, v = double(t) / steps;
                least = std::min(least, glm::length(p - (1 - u - v) * a - u * b - v * c));
            }
        EXPECT_LE(found, least + 1e-12);
        EXPECT_GE(found, least - 0.05);
    }
}

TEST(NearestTriangle, TreeFindsWhatTryingAllFinds)
{
    const TestMesh m = welded(app::makeKnot(0.11f, 96, 10));
    const std::vector<glm::dvec3> corners = m.corners(m.indices);
    const gbuffer::TriangleTree tree(corners);
    std::mt19937 engine(4);
    std::uniform_real_distribution<double> random(-1, 1);
    for (int i = 0; i < 100; ++i) {
        const glm::dvec3 p(random(engine), random(engine), random(engine));
        const double found =
            tree.least(p, [](uint32_t, const glm::dvec3&, double distance) { return distance; });
        EXPECT_NEAR(found, nearestByAll(p, corners), 1e-12);
    }
}

} // namespace
} // namespace candelabra::test
