// SPDX-License-Identifier: Apache-2.0
// Which triangles the shaft between the samples of a cluster and a light leaves out
// (tools/formula): none that a segment between them crosses.
#include <cmath>

#include <glm/gtc/matrix_transform.hpp>
#include <gtest/gtest.h>

#include "formula/visibility.h"
#include "generate/random.h"
#include "harness/full_tests.h"
#include "harness/occluder_walk.h"

namespace candelabra::test
{
namespace
{

class ShaftDraw
{
public:
    explicit ShaftDraw(uint64_t seed) : random_(seed) {}

    double uniform(double low, double high)
    {
        return low + (high - low) * double(random_.uniform());
    }
    glm::dvec3 inBox(const glm::dvec3& low, const glm::dvec3& high)
    {
        return {uniform(low.x, high.x), uniform(low.y, high.y), uniform(low.z, high.z)};
    }
    glm::dvec3 inBall(double radius)
    {
        for (;;) {
            const glm::dvec3 at = inBox(glm::dvec3(-1), glm::dvec3(1));
            if (glm::length(at) <= 1)
                return radius * at;
        }
    }
    // Half of the boxes are flat, as those of floors and walls are.
    formula::Shaft shaft()
    {
        formula::Shaft out;
        glm::dvec3 extent = inBox(glm::dvec3(0), glm::dvec3(0.3));
        const int flat = int(uniform(0, 6));
        if (flat < 3)
            extent[flat] = 0;
        const glm::dvec3 middle = inBox(glm::dvec3(-2), glm::dvec3(2));
        out.low = middle - extent;
        out.high = middle + extent;
        out.radius = std::exp2(uniform(-8, 0));
        out.ball = middle + (out.radius + uniform(0.4, 4)) * glm::normalize(inBall(1));
        out.ownDistance = uniform(0, 1) < 0.5 ? 0 : 1e-3;
        return out;
    }
    // A triangle near a segment from a sample to the ball. Some are in the plane of a flat box.
    formula::Triangle triangle(const formula::Shaft& s)
    {
        const glm::dvec3 from = inBox(s.low, s.high), to = s.ball + inBall(s.radius);
        const glm::dvec3 at = from + uniform(-0.1, 1.1) * (to - from);
        const double size = std::exp2(uniform(-5, 2));
        formula::Triangle out;
        const bool level = uniform(0, 1) < 0.3;
        for (glm::dvec3& corner : out) {
            corner = at + size * inBall(1);
            for (int axis = 0; level && axis < 3; ++axis)
                if (s.low[axis] == s.high[axis])
                    corner[axis] = s.low[axis];
        }
        return out;
    }
    glm::dmat3 transform()
    {
        glm::dmat3 out(glm::rotate(glm::dmat4(1), uniform(0, 6), glm::normalize(inBall(1))));
        const double mirror = uniform(0, 1) < 0.5 ? -1 : 1;
        return out *
               glm::dmat3(glm::scale(glm::dmat4(1), glm::dvec3(mirror * std::exp2(uniform(-3, 3)),
                                                               std::exp2(uniform(-3, 3)), 1)));
    }

private:
    Random random_;
};

} // namespace

TEST(VisibilityShaft, LeavesOutNoTriangleThatHidesALight)
{
    constexpr int segments = 40;
    const int shafts = fullTests() ? 100000 : 2000;
    ShaftDraw draw(5);
    int leftOut = 0, kept = 0, own = 0;
    for (int i = 0; i < shafts; ++i) {
        const formula::Shaft shaft = draw.shaft();
        for (int k = 0; k < 10; ++k) {
            const formula::Triangle world = draw.triangle(shaft);
            const glm::dmat3 worldFromLocal = k % 2 ? draw.transform() : glm::dmat3(1);
            const glm::dmat3 localFromWorld = glm::inverse(worldFromLocal);
            const formula::Triangle local{localFromWorld * world[0], localFromWorld * world[1],
                                          localFromWorld * world[2]};
            const formula::OccludingMesh mesh{.worldFromLocal = worldFromLocal};
            if (!leavesOut(shaft, mesh, local)) {
                ++kept;
                continue;
            }
            ++leftOut;
            const glm::dvec3 normal =
                glm::normalize(glm::cross(world[1] - world[0], world[2] - world[0]));
            for (int segment = 0; segment < segments; ++segment) {
                const glm::dvec3 from = draw.inBox(shaft.low, shaft.high);
                const glm::dvec3 to = shaft.ball + draw.inBall(shaft.radius);
                if (!crosses({from, to}, {glm::vec3(world[0]), world[1], world[2]}))
                    continue;
                const double distance = std::abs(glm::dot(normal, from - world[0]));
                EXPECT_LE(distance, shaft.ownDistance + 1e-6) << i << " " << k;
                own += distance <= shaft.ownDistance;
            }
        }
    }
    EXPECT_GT(leftOut, kept / 10);
    EXPECT_GT(kept, leftOut / 10);
    EXPECT_GT(own, 0);
}

// A floor hides no lamp above it from its own samples, and a table between them does.
TEST(VisibilityShaft, LeavesOutTheFloorAndKeepsTheTable)
{
    formula::Shaft shaft{.low = {-0.1, 0, -0.1}, .high = {0.1, 0, 0.1}, .ball = {1, 2, 0}};
    shaft.radius = 0.1;
    const auto level = [](double height, double size) {
        return formula::Triangle{glm::dvec3(-size, height, -size), glm::dvec3(size, height, -size),
                                 glm::dvec3(0, height, 2 * size)};
    };
    EXPECT_TRUE(leavesOut(shaft, {}, level(0, 50)));
    EXPECT_TRUE(leavesOut(shaft, {}, level(-0.1, 50)));
    EXPECT_TRUE(leavesOut(shaft, {}, level(3, 50)));
    EXPECT_TRUE(leavesOut(shaft, {}, level(1, 0.1)));
    EXPECT_FALSE(leavesOut(shaft, {}, level(1, 2)));
    // A floor hides nothing from samples that lie below it by less than the own distance.
    shaft.low.y = -1e-5;
    EXPECT_FALSE(leavesOut(shaft, {}, level(0, 50)));
    shaft.ownDistance = 2e-5;
    EXPECT_TRUE(leavesOut(shaft, {}, level(0, 50)));
}

} // namespace candelabra::test
