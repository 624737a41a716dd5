// SPDX-License-Identifier: Apache-2.0
// Tests the meshes of the procedural scenes: they are well formed and have the volume that geometry
// predicts.
#include <cmath>
#include <set>

#include <glm/gtc/matrix_transform.hpp>
#include <gtest/gtest.h>

#include "generate/generators.h"
#include "generate/mesh_builder.h"
#include "generate/random.h"
#include "generate/shapes.h"
#include "harness/constants.h"
#include "scene/scene_options.h"

namespace candelabra::app
{
namespace
{

using test::pi;

// Computes the volume by the divergence theorem; it is positive if a closed mesh is wound
// counter-clockwise seen from outside.
double volume(const Mesh& mesh)
{
    double sum = 0;
    for (size_t i = 0; i < mesh.indices.size(); i += 3) {
        const glm::dvec3 a(mesh.vertices[mesh.indices[i]].position);
        const glm::dvec3 b(mesh.vertices[mesh.indices[i + 1]].position);
        const glm::dvec3 c(mesh.vertices[mesh.indices[i + 2]].position);
        sum += glm::dot(a, glm::cross(b, c)) / 6;
    }
    return sum;
}

// Returns what is wrong with the mesh; empty if nothing is.
std::string brokenMesh(const Mesh& mesh)
{
    if (mesh.indices.empty() || mesh.indices.size() % 3 != 0) {
        return std::to_string(mesh.indices.size()) + " indices";
    }
    for (const uint32_t index : mesh.indices) {
        if (index >= mesh.vertices.size()) {
            return "index " + std::to_string(index) + " of " + std::to_string(mesh.vertices.size());
        }
    }
    for (size_t i = 0; i < mesh.vertices.size(); ++i) {
        const Vertex& v = mesh.vertices[i];
        const glm::vec3 tangent(v.tangent);
        if (!(std::abs(glm::length(v.normal) - 1) < 1e-5f) ||
            !(std::abs(glm::length(tangent) - 1) < 1e-5f) ||
            !(std::abs(glm::dot(v.normal, tangent)) < 1e-4f) || std::abs(v.tangent.w) != 1) {
            return "frame of vertex " + std::to_string(i);
        }
    }
    for (size_t i = 0; i < mesh.indices.size(); i += 3) {
        const Vertex& a = mesh.vertices[mesh.indices[i]];
        const Vertex& b = mesh.vertices[mesh.indices[i + 1]];
        const Vertex& c = mesh.vertices[mesh.indices[i + 2]];
        const glm::vec3 area = glm::cross(b.position - a.position, c.position - a.position);
        if (!(glm::length(area) > 1e-8f)) {
            return "degenerate triangle " + std::to_string(i / 3);
        }
        for (const Vertex* v : {&a, &b, &c}) {
            if (!(glm::dot(glm::normalize(area), v->normal) > 0.2f)) {
                return "triangle " + std::to_string(i / 3) + " faces away from its normals";
            }
        }
    }
    return {};
}

TEST(Shapes, VolumesFollowFromGeometry)
{
    EXPECT_NEAR(volume(makeBox()), 1, 1e-6);
    EXPECT_NEAR(volume(makeCylinder(64)), pi, 0.006); // inscribed polygon: 1 - (2 pi / n)^2 / 6
    EXPECT_NEAR(volume(makeSphere(96, 48)), 4 * pi / 3, 0.01);
    EXPECT_NEAR(volume(makeTorus(2, 0.5f, 128, 64)), 2 * pi * pi * 2 * 0.25, 0.05);
    EXPECT_NEAR(volume(makeArchedWall(5, 3, 0.9f, 2, 96)), 0.9 * (15 - 0.5 * pi * 4), 0.01);
    EXPECT_NEAR(volume(makeArchRing(1, 2, 0.5f, static_cast<float>(pi), 96)),
                0.5 * 0.5 * pi * (4 - 1), 0.005);
    // Cone of radius 1 and height 2.
    EXPECT_NEAR(volume(makeLathe({{{0, 0}, {1, 0}}, {{1, 0}, {0, 2}}}, 128)), 2 * pi / 3, 0.002);
    // A box minus its edges (right triangles with sides b) and its corners, each counted once.
    const double b = 0.1, edge = 1 - 2 * b;
    const double corner = b * b * b - b * b * b / 6;
    EXPECT_NEAR(volume(makeBevelledBox(0.1f)), 1 - 12 * edge * b * b / 2 - 8 * corner, 1e-5);
}

TEST(Shapes, AreWellFormed)
{
    EXPECT_EQ(brokenMesh(makeBox()), "");
    EXPECT_EQ(brokenMesh(makeBevelledBox(0.02f)), "");
    EXPECT_EQ(brokenMesh(makeTile(0.01f)), "");
    EXPECT_EQ(brokenMesh(makeGround(3)), "");
    EXPECT_EQ(brokenMesh(makeSphere(7, 5)), "");
    EXPECT_EQ(brokenMesh(makeTorus(1, 0.2f, 12, 5)), "");
    EXPECT_EQ(brokenMesh(makeKnot(0.1f, 96, 10)), "");
    EXPECT_EQ(brokenMesh(makeCylinder(4)), "");
    EXPECT_EQ(brokenMesh(makeArchedWall(5, 2.7f, 0.9f, 2.05f, 24)), "");
    EXPECT_EQ(brokenMesh(makeArchRing(1, 1.1f, 0.2f, 3.0f, 20)), "");
    EXPECT_EQ(brokenMesh(makeVault(32)), "");
    EXPECT_EQ(brokenMesh(makeGabledHouse()), "");
}

TEST(Shapes, GeneratedScenesHoldOnlyWellFormedMeshes)
{
    SceneOptions options;
    options.lights = 0;
    for (const Scene& scene : {generateHall(options), generateField(options)}) {
        for (size_t i = 0; i < scene.meshes.size(); ++i) {
            EXPECT_EQ(brokenMesh(scene.meshes[i]), "") << scene.name << " mesh " << i;
        }
    }
}

TEST(Shapes, ClosedSurfacesCloseToTheBit)
{
    // In a closed surface every directed edge has its opposite. A seam that missed its start by one
    // bit would leave open edges.
    const Mesh mesh = makeTorus(1, 0.3f, 9, 5);
    std::set<std::array<float, 6>> edges;
    const auto edge = [&](uint32_t from, uint32_t to) {
        const glm::vec3 a = mesh.vertices[from].position, b = mesh.vertices[to].position;
        return std::array<float, 6>{a.x, a.y, a.z, b.x, b.y, b.z};
    };
    for (size_t i = 0; i < mesh.indices.size(); i += 3) {
        for (size_t k = 0; k < 3; ++k) {
            EXPECT_TRUE(
                edges.insert(edge(mesh.indices[i + k], mesh.indices[i + (k + 1) % 3])).second);
        }
    }
    for (const auto& e : edges) {
        EXPECT_TRUE(edges.count({e[3], e[4], e[5], e[0], e[1], e[2]})) << "open edge";
    }
}

TEST(Shapes, AppendedPartsKeepTheirNormalsUnderUnevenScale)
{
    Mesh mesh;
    appendMesh(mesh, makeSphere(24, 12), glm::scale(glm::mat4(1), {1, 3, 0.5f}));
    EXPECT_NEAR(volume(mesh), volume(makeSphere(24, 12)) * 1.5, 1e-4);
    for (const Vertex& v : mesh.vertices) {
        // The gradient of the ellipsoid's equation.
        const glm::vec3 gradient = v.position / glm::vec3(1, 9, 0.25f);
        EXPECT_GT(glm::dot(glm::normalize(gradient), v.normal), 0.9999f);
    }
}

TEST(Random, IsPcg32)
{
    // From the demo program of the PCG C library: seed 42, stream 54.
    Random random(42, 54);
    for (const uint32_t expected :
         {0xa15c02b7u, 0x7b47f409u, 0xba1d3330u, 0x83d2f293u, 0xbfa4784bu, 0xcbed606eu}) {
        EXPECT_EQ(random.bits(), expected);
    }
}

TEST(Random, StaysInRange)
{
    Random random(3);
    double sum = 0, bells = 0;
    for (int i = 0; i < 100000; ++i) {
        const float u = random.uniform();
        ASSERT_TRUE(u >= 0 && u < 1);
        sum += u;
        const float bell = random.bell();
        ASSERT_TRUE(bell >= -1 && bell < 1);
        bells += bell;
        ASSERT_LT(random.below(7), 7u);
    }
    // Tolerances of five standard errors.
    EXPECT_NEAR(sum / 100000, 0.5, 5 * 0.289 / 316);
    EXPECT_NEAR(bells / 100000, 0, 5 * 0.333 / 316);
}

} // namespace
} // namespace candelabra::app
