// SPDX-License-Identifier: Apache-2.0
// Proofs that a mesh hides a light (shaders/lib/visibility/dark_proof.glsl, in double precision):
// no segment from a receiver to a light that is proven dark is open. And the neighbours of
// triangles, which proofs need.
#include <iostream>
#include <map>
#include <numbers>
#include <random>

#include <fmt/format.h>
#include <glm/matrix.hpp>
#include <gtest/gtest.h>

#include "formula/visibility.h"
#include "harness/full_tests.h"
#include "harness/occluder_walk.h"
#include "occluders/neighbours.h"

namespace candelabra::test
{
namespace
{

using Surface = std::vector<gpu::OccluderTriangle>;

class MeshMaker
{
public:
    explicit MeshMaker(uint64_t seed) : random_(seed) {}

    double uniform(double low, double high)
    {
        return std::uniform_real_distribution(low, high)(random_);
    }
    double logUniform(double low, double high)
    {
        return std::exp(uniform(std::log(low), std::log(high)));
    }
    uint32_t below(uint32_t count) { return uint32_t(random_() % count); }
    glm::dvec3 within(double size)
    {
        return {uniform(-size, size), uniform(-size, size), uniform(-size, size)};
    }
    glm::dvec3 direction()
    {
        const double z = uniform(-1, 1), azimuth = uniform(0, 2 * std::numbers::pi);
        const double s = std::sqrt(1 - z * z);
        return {s * std::cos(azimuth), s * std::sin(azimuth), z};
    }
    // Rotated, stretched, sheared and, in half of the cases, mirrored.
    glm::dmat3 transform()
    {
        glm::dmat3 m;
        for (int i = 0; i < 3; ++i)
            m[i] = within(0.35) + uniform(0.7, 1.5) * glm::dvec3(i == 0, i == 1, i == 2);
        m[0] *= below(2) ? 1 : -1;
        const glm::dvec3 a = direction(), b = glm::normalize(glm::cross(a, direction()));
        return glm::dmat3(a, b, glm::cross(a, b)) * m;
    }

    static constexpr uint32_t kinds = 9;
    static const char* nameOf(uint32_t kind)
    {
        constexpr const char* names[kinds] = {"box",        "icosphere",      "wall with a hole",
                                              "open sheet", "jittered sheet", "sheet of two sides",
                                              "T-junction", "book",           "bow-tie"};
        return names[kind];
    }
    // Returns a mesh of about 2 m, whose sheets face z, with its triangles in any order.
    Surface make(uint32_t kind)
    {
        Surface mesh;
        switch (kind) {
        case 0:
            addBox(mesh, {-1, -1, -uniform(0.02, 1)}, {1, 1, uniform(0.02, 1)});
            break;
        case 1:
            mesh = sphere(below(3));
            break;
        case 2:
            mesh = wallWithHole();
            break;
        case 6:
            mesh = tJunction();
            break;
        case 7: // two sheets that share an edge
            mesh = sheet(2 + below(4), 0);
            for (const glm::dvec3& end : {glm::dvec3(1, -1, 0), glm::dvec3(1, 1, 0)})
                add(mesh, {-1, -1, 0}, {-1, 1, 0}, end + glm::dvec3(0, 0, uniform(-1, 1)));
            break;
        case 8: // two fans that share a vertex
            for (const double side : {-1.0, 1.0})
                for (int i = 0; i < 6; ++i)
                    add(mesh, {0, 0, 0}, fanPoint(side, i), fanPoint(side, i + 1));
            break;
        default:
            mesh = sheet(1 + below(6), kind == 3 ? 0 : 0.05);
            if (kind == 5)
                for (size_t i = 0, end = mesh.size(); i < end; ++i)
                    mesh.push_back({{mesh[i].corners[0], mesh[i].corners[2], mesh[i].corners[1]}});
        }
        spoil(mesh);
        std::ranges::shuffle(mesh, random_);
        return mesh;
    }

private:
    static void add(Surface& mesh, const glm::dvec3& a, const glm::dvec3& b, const glm::dvec3& c)
    {
        mesh.push_back({{glm::vec3(a), glm::vec3(b), glm::vec3(c)}});
    }
    static void addQuad(Surface& mesh, const glm::dvec3& a, const glm::dvec3& b,
                        const glm::dvec3& c, const glm::dvec3& d)
    {
        add(mesh, a, b, c);
        add(mesh, a, c, d);
    }
    static void addBox(Surface& mesh, const glm::dvec3& low, const glm::dvec3& high)
    {
        const auto at = [&](int i) {
            return glm::dvec3(i & 1 ? high.x : low.x, i & 2 ? high.y : low.y,
                              i & 4 ? high.z : low.z);
        };
        for (const auto& q :
             {glm::ivec4(0, 2, 3, 1), glm::ivec4(4, 5, 7, 6), glm::ivec4(0, 1, 5, 4),
              glm::ivec4(2, 6, 7, 3), glm::ivec4(0, 4, 6, 2), glm::ivec4(1, 3, 7, 5)})
            addQuad(mesh, at(q.x), at(q.y), at(q.z), at(q.w));
    }
    static Surface sphere(uint32_t levels)
    {
        Surface mesh;
        for (int i = 0; i < 8; ++i) {
            const glm::dvec3 x(i & 1 ? 1 : -1, 0, 0), y(0, i & 2 ? 1 : -1, 0),
                z(0, 0, i & 4 ? 1 : -1);
            const bool flip = ((i & 1) + (i >> 1 & 1) + (i >> 2 & 1)) % 2 == 0;
            add(mesh, x, flip ? z : y, flip ? y : z);
        }
        for (; levels; --levels) {
            Surface finer;
            for (const auto& t : mesh) {
                glm::dvec3 middles[3];
                for (int i = 0; i < 3; ++i)
                    middles[i] = glm::normalize(glm::dvec3(t.corners[i]) +
                                                glm::dvec3(t.corners[(i + 1) % 3]));
                for (int i = 0; i < 3; ++i)
                    add(finer, t.corners[i], middles[i], middles[(i + 2) % 3]);
                add(finer, middles[0], middles[1], middles[2]);
            }
            mesh = finer;
        }
        return mesh;
    }
    Surface sheet(uint32_t side, double jitter)
    {
        std::vector<glm::dvec3> points;
        for (uint32_t y = 0; y <= side; ++y)
            for (uint32_t x = 0; x <= side; ++x)
                points.push_back(glm::dvec3(2.0 * x / side - 1, 2.0 * y / side - 1, 0) +
                                 within(jitter));
        Surface mesh;
        for (uint32_t y = 0; y < side; ++y)
            for (uint32_t x = 0; x < side; ++x) {
                const uint32_t i = y * (side + 1) + x;
                addQuad(mesh, points[i], points[i + 1], points[i + side + 2], points[i + side + 1]);
            }
        return mesh;
    }
    // A thin box around a hole, down to 0.1 mm wide.
    Surface wallWithHole()
    {
        Surface mesh;
        const double z = uniform(0.01, 0.1), half = 0.5 * logUniform(1e-4, 1);
        const glm::dvec2 at(uniform(-0.4, 0.4), uniform(-0.4, 0.4));
        const double xs[] = {-1, at.x - half, at.x + half, 1};
        const double ys[] = {-1, at.y - half, at.y + half, 1};
        for (int side = -1; side <= 1; side += 2)
            for (int x = 0; x < 3; ++x)
                for (int y = 0; y < 3; ++y)
                    if (x != 1 || y != 1)
                        addQuad(mesh, {xs[x], ys[y], side * z}, {xs[x + 1], ys[y], side * z},
                                {xs[x + 1], ys[y + 1], side * z}, {xs[x], ys[y + 1], side * z});
        for (int x = 1; x < 3; ++x)
            addQuad(mesh, {xs[x], ys[1], -z}, {xs[x], ys[2], -z}, {xs[x], ys[2], z},
                    {xs[x], ys[1], z});
        for (int y = 1; y < 3; ++y)
            addQuad(mesh, {xs[1], ys[y], -z}, {xs[2], ys[y], -z}, {xs[2], ys[y], z},
                    {xs[1], ys[y], z});
        return mesh;
    }
    Surface tJunction()
    {
        Surface mesh;
        const double x = uniform(-0.5, 0.5), gap = below(2) ? 0 : logUniform(1e-7, 1e-2);
        addQuad(mesh, {-1, -1, 0}, {1, -1, 0}, {1, -gap, 0}, {-1, -gap, 0});
        addQuad(mesh, {-1, 0, 0}, {x, 0, 0}, {x, 1, 0}, {-1, 1, 0});
        addQuad(mesh, {x, 0, 0}, {1, 0, 0}, {1, 1, 0}, {x, 1, 0});
        return mesh;
    }
    static glm::dvec3 fanPoint(double side, int i)
    {
        const double angle = (i / 6.0 - 0.5) * std::numbers::pi;
        return {side * std::cos(angle), std::sin(angle), 0};
    }
    // Turns some triangles round, and removes some.
    void spoil(Surface& mesh)
    {
        for (auto& t : mesh)
            if (below(8) == 0)
                std::swap(t.corners[1], t.corners[2]);
        if (below(3) == 0)
            for (uint32_t left = below(2) + 1; left && mesh.size() > 1; --left)
                mesh.erase(mesh.begin() + below(uint32_t(mesh.size())));
    }

    std::mt19937_64 random_;
};

// A box of receivers and a light, on both sides of a mesh as a rule.
struct ProofCase {
    Surface mesh;
    glm::dmat3 worldFromLocal, localFromWorld;
    formula::ReceiverBox box;
    formula::Light light;

    ProofCase(MeshMaker& make, uint32_t kind)
        : mesh(make.make(kind)),
          worldFromLocal(make.logUniform(0.5, 4) * make.transform()),
          localFromWorld(glm::inverse(worldFromLocal))
    {
        const glm::dvec3 across = make.below(4) == 0
                                      ? make.direction()
                                      : glm::normalize(worldFromLocal[2] + make.within(0.5));
        box.centre = across * make.logUniform(0.1, 4) + make.within(0.5);
        for (int axis = 0; axis < 3; ++axis)
            box.half[axis] = make.below(4) ? make.logUniform(0.001, 0.7) : 0;
        box.ownDistance = make.below(2) ? make.logUniform(1e-6, 0.05) : 1e-6;
        light.centre = -across * make.logUniform(0.1, 4) + make.within(0.5);
        constexpr uint32_t types[] = {CND_LIGHT_SPHERE, CND_LIGHT_POINT, CND_LIGHT_TUBE,
                                      CND_LIGHT_RECTANGLE, CND_LIGHT_DISC};
        light.type = types[make.below(5)];
        const double size = make.logUniform(0.001, 0.6);
        const glm::dvec3 u = make.direction(), v = glm::normalize(glm::cross(u, make.direction()));
        light.boundingRadius = light.type == CND_LIGHT_POINT ? 0 : size;
        if (light.type == CND_LIGHT_RECTANGLE) {
            light.shape.axisU = glm::vec3(0.8 * size * u);
            light.shape.axisV = glm::vec3(0.6 * size * v);
        } else {
            light.shape.axisU = glm::vec3(light.type == CND_LIGHT_TUBE ? 0.9 * size * u : u);
            light.shape.radius = float(light.type == CND_LIGHT_TUBE ? 0.1 * size : size);
        }
    }
    bool isProven(const lighting::Neighbours& neighbours) const
    {
        std::vector<formula::Triangle> triangles;
        for (const auto& t : mesh)
            triangles.push_back(
                {glm::dvec3(t.corners[0]), glm::dvec3(t.corners[1]), glm::dvec3(t.corners[2])});
        return formula::provesDarkness(box, light, {triangles, worldFromLocal}, neighbours);
    }
    // Tells whether a random segment from the box to the emitter's ball crosses a triangle that is
    // not the receiver's own surface.
    bool segmentIsBlocked(MeshMaker& make) const
    {
        glm::dvec3 from = box.centre, to = make.within(1);
        for (int axis = 0; axis < 3; ++axis)
            from[axis] += box.half[axis] * (make.below(4)   ? make.uniform(-1, 1)
                                            : make.below(2) ? 1.0
                                                            : -1.0);
        to = light.centre +
             light.boundingRadius * (make.below(2) ? glm::normalize(to) : to / std::sqrt(3.0));
        const Segment s{localFromWorld * from, localFromWorld * to};
        return std::ranges::any_of(mesh, [&](const gpu::OccluderTriangle& t) {
            if (!crosses(s, t))
                return false;
            const glm::dvec3 a = worldFromLocal * glm::dvec3(t.corners[0]);
            const glm::dvec3 n = glm::normalize(
                glm::cross(worldFromLocal * glm::dvec3(t.corners[1] - t.corners[0]),
                           worldFromLocal * glm::dvec3(t.corners[2] - t.corners[0])));
            return std::abs(glm::dot(n, from - a)) > box.ownDistance;
        });
    }
};

TEST(VisibilityProofs, NoSegmentToALightThatIsProvenDarkIsOpen)
{
    MeshMaker make(1);
    const uint32_t scenes = fullTests() ? 40'000 : 2000, segments = fullTests() ? 1000 : 200;
    struct Count {
        uint32_t tried = 0, dark = 0, proven = 0;
    };
    std::map<uint32_t, Count> counts;
    uint64_t tested = 0;
    for (uint32_t i = 0; i < scenes; ++i) {
        const uint32_t kind = i % MeshMaker::kinds;
        const ProofCase scene(make, kind);
        const bool proven = scene.isProven(lighting::findNeighbours(scene.mesh));
        bool dark = true;
        for (uint32_t k = 0; k < segments && dark; ++k)
            dark = scene.segmentIsBlocked(make);
        EXPECT_TRUE(dark || !proven) << MeshMaker::nameOf(kind) << ", scene " << i;
        tested += proven ? segments : 0;
        Count& count = counts[kind];
        ++count.tried;
        count.dark += dark;
        count.proven += proven;
    }
    Count all;
    for (const auto& [kind, c] : counts) {
        if (fullTests())
            std::cout << fmt::format("{:<20} {:6} scenes, {:6} dark, {:6} proven\n",
                                     MeshMaker::nameOf(kind), c.tried, c.dark, c.proven);
        all.dark += c.dark;
        all.proven += c.proven;
        EXPECT_GT(c.proven, 0u) << MeshMaker::nameOf(kind);
    }
    std::cout << fmt::format("{} scenes, {} dark, {} proven, {} segments\n", scenes, all.dark,
                             all.proven, tested);
    EXPECT_GT(all.proven, all.dark / 3);
}

} // namespace

} // namespace candelabra::test
