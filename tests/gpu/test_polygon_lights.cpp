// SPDX-License-Identifier: Apache-2.0
// Polygons on the device: they equal the lights of which they are special cases, and mirrored ones
// light the mirrored surface.
#include <cmath>
#include <iostream>
#include <random>

#include "gpu/lighting_harness.h"
#include "measure/kernels/light_kernels.h"
#include "measure/kernels/vectors.h"
#include "reference/truth.h"
#include "render/setting_names.h"
#include "scene/polygons.h"
#include "shading/light_family.h"

namespace candelabra::test
{
namespace
{

using app::LightEvaluator;
using app::set;
using app::specularName;

struct Case {
    gpu::BenchReceiver receiver;
    CndLight light;
};

glm::vec3 vec(const float (&v)[3])
{
    return {v[0], v[1], v[2]};
}

// Receivers at the origin that face up, under rectangles of all sizes, some of which cross the
// horizon or are seen from behind.
std::vector<Case> rectangles(uint32_t count)
{
    std::mt19937 random(11);
    std::uniform_real_distribution<float> unit(-1, 1);
    const auto direction = [&] {
        return glm::normalize(glm::vec3(unit(random), unit(random), unit(random)) + 1e-3f);
    };
    std::vector<Case> out;
    for (uint32_t i = 0; i < count; ++i) {
        const float NoV = 0.5f * (1.01f + unit(random)) / 1.01f,
                    size = std::pow(10.0f, unit(random));
        Case c{.receiver = {.n = {0, 0, 1},
                            .v = {std::sqrt(1 - NoV * NoV), 0, NoV},
                            .perceptualRoughness = 0.55f + 0.45f * unit(random)},
               .light = {.type = CND_LIGHT_RECTANGLE,
                         .emission = {1, 1, 1},
                         .influenceRadius = INFINITY}};
        const glm::vec3 u = direction(), v = glm::normalize(glm::cross(u, direction()));
        set(c.light.position, (1 + unit(random)) * 3.0f * direction());
        set(c.light.axisU, size * u);
        set(c.light.axisV, size * (0.6f + 0.5f * unit(random)) * v);
        c.light.twoSided = i % 2;
        out.push_back(c);
    }
    return out;
}

class PolygonLights : public LightingTest
{
protected:
    std::vector<gpu::BenchResponse> evaluate(const std::vector<Case>& cases,
                                             CndSpecularMethod method)
    {
        std::vector<gpu::BenchReceiver> receivers;
        std::vector<CndLight> lights;
        for (const Case& c : cases) {
            receivers.push_back(c.receiver);
            lights.push_back(c.light);
        }
        const LightEvaluator evaluator(context(),
                                       {.lightType = cases.front().light.type, .method = method});
        return evaluator.evaluate(receivers, lights);
    }

    // Expects the same responses up to rounding. The closed form amplifies it where the outline
    // passes the mirror direction of a narrow lobe: up to 6.5e-4 of the largest response on
    // llvmpipe, and 1.24e-3 on an NVIDIA H200.
    static void expectSame(const std::vector<gpu::BenchResponse>& a,
                           const std::vector<gpu::BenchResponse>& b, CndSpecularMethod method,
                           double closedFormTolerance = 2e-3)
    {
        ASSERT_EQ(a.size(), b.size());
        const double tolerance = method == CND_SPECULAR_CONIC ? closedFormTolerance : 2e-5;
        double largest = 0, worst = 0, worstF = 0;
        for (size_t i = 0; i < a.size(); ++i) {
            largest = std::max(largest, double(a[i].a));
            worst = std::max({worst, std::abs(double(a[i].a) - double(b[i].a)),
                              std::abs(double(a[i].b) - double(b[i].b))});
            worstF = std::max(worstF, std::abs(double(a[i].f) - double(b[i].f)));
        }
        std::cout << specularName(method) << ": largest specular difference " << worst << " of "
                  << largest << ", form factor " << worstF << "\n";
        EXPECT_GT(largest, 0.1);
        EXPECT_LE(worst, tolerance * largest);
        EXPECT_LE(worstF, 2e-6);
    }

    // The methods that polygons and rectangles share, without samples, which differ.
    static std::vector<CndSpecularMethod> methods()
    {
        std::vector<CndSpecularMethod> out = app::methodsOf(CND_LIGHT_POLYGON);
        std::erase_if(out, [](CndSpecularMethod method) {
            return method == CND_SPECULAR_SAMPLED ||
                   lighting::canonicalMethod(CND_LIGHT_RECTANGLE, method) != method;
        });
        return out;
    }
};

TEST_F(PolygonLights, WithFourCornersEqualTheRectangle)
{
    const std::vector<Case> wanted = rectangles(4000);
    std::vector<Case> polygons = wanted;
    const CndPolygon square{4, {{1, -1}, {1, 1}, {-1, 1}, {-1, -1}}};
    for (Case& c : polygons) {
        c.light.type = CND_LIGHT_POLYGON;
        c.light.polygon = &square;
    }
    for (const CndSpecularMethod method : methods())
        expectSame(evaluate(polygons, method), evaluate(wanted, method), method);
}

TEST_F(PolygonLights, FormFactorsAreTrue)
{
    std::vector<Case> cases = rectangles(1200);
    for (uint32_t i = 0; i < cases.size(); ++i) {
        cases[i].light.type = CND_LIGHT_POLYGON;
        cases[i].light.polygon = app::somePolygon(i);
    }
    const std::vector<gpu::BenchResponse> responses = evaluate(cases, CND_SPECULAR_KARIS);
    double worst[12] = {};
    for (uint32_t i = 0; i < cases.size(); ++i) {
        const reference::SurfacePoint surface{{0, 0, 0}, {0, 0, 1}, {0, 0, 1}};
        const double truth =
            reference::truthResponse(surface, 0, cases[i].light, glm::dvec3(0), 1e-7).f;
        worst[i % 12] = std::max(worst[i % 12], std::abs(double(responses[i].f) - truth));
    }
    for (uint32_t i = 0; i < 12; ++i) {
        std::cout << "polygon " << i << " with " << app::somePolygon(i)->cornerCount
                  << " corners: largest error of the form factor " << worst[i] << "\n";
        EXPECT_LE(worst[i], 5e-6);
    }
}

// The choice of the first corner changes nothing. A corner between others on a straight edge makes
// two arcs of one, which the closed form approximates differently.
TEST_F(PolygonLights, TheListOfCornersMayStartAnywhere)
{
    std::vector<Case> some = rectangles(4000);
    for (Case& c : some)
        c.light.type = CND_LIGHT_POLYGON;
    const CndPolygon hexagons[] = {
        {6, {{-1, -1}, {0.2f, -1}, {1, -1}, {1, 0.5f}, {0.5f, 1}, {-1, 1}}},
        {6, {{0.5f, 1}, {-1, 1}, {-1, -1}, {0.2f, -1}, {1, -1}, {1, 0.5f}}},
        {5, {{-1, -1}, {1, -1}, {1, 0.5f}, {0.5f, 1}, {-1, 1}}}};
    for (const CndSpecularMethod method : methods()) {
        std::vector<gpu::BenchResponse> responses[3];
        for (int i = 0; i < 3; ++i) {
            for (Case& c : some)
                c.light.polygon = &hexagons[i];
            responses[i] = evaluate(some, method);
        }
        expectSame(responses[1], responses[0], method);
        expectSame(responses[2], responses[0], method, 5e-3);
    }
}

// Mirrored at a plane through the receiver's normal, a polygon gives the mirrored eye the same
// light from its mirrored front. One-sided polygons would otherwise show their back.
TEST_F(PolygonLights, MirroredOnesKeepTheirFront)
{
    std::vector<Case> some = rectangles(3000), mirrored = some;
    std::vector<CndPolygon> reversed(12);
    for (uint32_t i = 0; i < reversed.size(); ++i) {
        const CndPolygon& outline = *app::somePolygon(i);
        reversed[i].cornerCount = outline.cornerCount;
        for (uint32_t k = 0; k < outline.cornerCount; ++k) { // mirrored, in the reverse order
            const float(&corner)[2] = outline.corners[outline.cornerCount - 1 - k];
            reversed[i].corners[k][0] = corner[0];
            reversed[i].corners[k][1] = -corner[1];
        }
    }
    const glm::vec3 mirror(-1, 1, 1);
    for (uint32_t i = 0; i < some.size(); ++i) {
        CndLight &light = some[i].light, &other = mirrored[i].light;
        light.type = other.type = CND_LIGHT_POLYGON;
        light.polygon = app::somePolygon(i);
        other.polygon = &reversed[i % reversed.size()];
        set(other.position, mirror * vec(light.position));
        set(other.axisU, mirror * vec(light.axisU));
        set(other.axisV, -mirror * vec(light.axisV));
        mirrored[i].receiver.v *= mirror;
    }
    for (const CndSpecularMethod method : methods())
        expectSame(evaluate(mirrored, method), evaluate(some, method), method);
}

TEST_F(PolygonLights, TheBackEmitsOnlyIfTwoSided)
{
    std::vector<Case> cases = rectangles(2000);
    for (uint32_t i = 0; i < cases.size(); ++i) {
        CndLight& light = cases[i].light;
        light.type = CND_LIGHT_POLYGON;
        light.polygon = app::somePolygon(i);
    }
    for (const CndSpecularMethod method : app::methodsOf(CND_LIGHT_POLYGON)) {
        std::vector<gpu::BenchResponse> sides[2];
        for (const VkBool32 twoSided : {VK_FALSE, VK_TRUE}) {
            for (Case& c : cases)
                c.light.twoSided = twoSided;
            sides[twoSided] = evaluate(cases, method);
        }
        size_t behind = 0;
        for (size_t i = 0; i < cases.size(); ++i) {
            const CndLight& light = cases[i].light;
            const bool front =
                glm::dot(glm::cross(vec(light.axisU), vec(light.axisV)), vec(light.position)) < 0;
            if (front) {
                EXPECT_EQ(sides[0][i].a, sides[1][i].a) << i;
                EXPECT_EQ(sides[0][i].f, sides[1][i].f) << i;
            } else {
                EXPECT_EQ(sides[0][i].a, 0) << i;
                EXPECT_EQ(sides[0][i].f, 0) << i;
                behind += sides[1][i].f > 0;
            }
        }
        EXPECT_GT(behind, 500u);
    }
}

} // namespace
} // namespace candelabra::test
