// SPDX-License-Identifier: Apache-2.0
// Tests which points of lights triangles hide on the GPU (shaders/lib/visibility), in float32.
#include <bit>
#include <cmath>
#include <vector>

#include <glm/glm.hpp>

#include "candelabra_probes.h"
#include "formula/visibility.h"
#include "gpu/probe.h"
#include "harness/full_tests.h"
#include "shared/visibility_points.h"
#include "shared/visibility_probe.h"
#include "tables/point_table.h"

namespace candelabra::test
{
namespace
{

using Input = gpu::VisibilityProbeInput;
using Output = gpu::VisibilityProbeOutput;
constexpr uint32_t side = gpu::SHEET_CELLS + 1;

uint64_t bitsOf(const glm::uvec2& mask)
{
    return uint64_t(mask.y) << 32u | mask.x;
}

// The relation of an instance's space to view space.
struct Placement {
    glm::dmat3 viewFromLocal{1};
    glm::dvec3 origin{0}; // of the instance in view space, m
};

formula::LightFacet facetInDouble(const Input& in)
{
    return formula::lightFacet(64, {},
                               {.type = in.type,
                                .centre = glm::dvec3(in.toLight),
                                .boundingRadius = in.boundingRadius,
                                .shape = in.shape});
}

std::vector<formula::Triangle> trianglesOf(const std::vector<glm::dvec3>& sheet)
{
    std::vector<formula::Triangle> out;
    for (uint32_t row = 0; row < gpu::SHEET_CELLS; ++row)
        for (uint32_t column = 0; column < gpu::SHEET_CELLS; ++column) {
            const auto vertex = [&](uint32_t x, uint32_t y) {
                return sheet[(row + y) * side + column + x];
            };
            out.push_back({vertex(0, 0), vertex(1, 0), vertex(1, 1)});
            out.push_back({vertex(0, 0), vertex(1, 1), vertex(0, 1)});
        }
    return out;
}

// Returns the triangles relative to the receiver in the space of the instance.
std::vector<formula::Triangle> trianglesOf(const Input& in)
{
    std::vector<glm::dvec3> sheet;
    for (const glm::vec3& vertex : in.vertices)
        sheet.emplace_back(vertex - in.localPosition);
    return trianglesOf(sheet);
}

// Returns whether the plane of a triangle passes so near to the receiver that the triangle counts
// as the receiver's own surface and hides nothing.
bool isSeenEdgeOn(const std::vector<glm::dvec3>& sheet)
{
    for (const auto& [a, b, c] : trianglesOf(sheet))
        if (std::abs(glm::dot(glm::normalize(glm::cross(b - a, c - a)), a)) < 1e-4)
            return true;
    return false;
}

class VisibilityProbeTest : public ProbeTest
{
protected:
    VisibilityProbeTest() { random_.seed(2026); }

    std::vector<Output> evaluate(const std::vector<Input>& inputs, uint32_t points = 64)
    {
        const gpu::Buffer table = upload("table of points", tables::pointTable(points));
        const gpu::Binding binding[] = {gpu::Binding::of(gpu::VISIBILITY_PROBE_TABLE, table)};
        return runProbe<Output>(spirv::visibility_comp, inputs,
                                {{gpu::VISIBILITY_PROBE_POINTS, points}}, binding);
    }
    glm::dvec3 anyDirection() { return direction(uniform(-1, 1)); }
    glm::dvec3 across(const glm::dvec3& axis)
    {
        return glm::normalize(glm::cross(axis, anyDirection()));
    }
    // Rotated, stretched and, in half of the cases, mirrored; `distance` from the view's origin.
    Placement anyPlacement(double distance)
    {
        const glm::dvec3 x = anyDirection(), y = across(x), z = glm::cross(x, y);
        const glm::dmat3 stretch(uniform(0.5, 2), uniform(-0.5, 0.5), 0, 0, uniform(0.5, 2), 0, 0,
                                 0, random_() % 2 ? uniform(0.5, 2) : -uniform(0.5, 2));
        return {glm::dmat3(x, y, z) * stretch, distance * anyDirection()};
    }
    // A light that is seen from the receiver under `sine` (of its bounding sphere's radius).
    Input anyLight(uint32_t type, double distance, double sine)
    {
        const glm::dvec3 a = anyDirection(), n = across(a) * uniform(-1, 1) + a;
        const glm::dvec3 u = across(n), v = glm::normalize(glm::cross(n, u));
        const double size = distance * sine;
        const bool distant = (gpu::TYPES_WITH_POSITION >> type & 1u) == 0;
        Input in{};
        in.type = type;
        in.toLight = glm::vec3(distant ? a : distance * a);
        in.boundingRadius = float(distant ? sine : size);
        in.shape.radius = float(size);
        in.shape.axisU = glm::vec3(0.7 * size * u);
        in.shape.axisV = glm::vec3(uniform(0.1, 0.7) * size * v);
        if (type == CND_LIGHT_DISC)
            in.shape.axisU = glm::vec3(glm::normalize(n));
        if (type == CND_LIGHT_TUBE) {
            in.shape.axisU = glm::vec3(uniform(0.1, 0.8) * size * anyDirection());
            in.shape.radius = float(0.2 * size);
        }
        in.n = glm::vec3(glm::normalize(a + 0.5 * anyDirection()));
        in.v = glm::vec3(glm::normalize(glm::dvec3(in.n) + 0.5 * anyDirection()));
        in.alpha = float(uniform(0.01, 1));
        return in;
    }
    // Sets the vertices, which are given relative to the receiver in view space.
    void placeSheet(Input& in, const std::vector<glm::dvec3>& vertices, const Placement& placement)
    {
        const glm::dmat3 localFromView = glm::inverse(placement.viewFromLocal);
        const glm::dvec3 p = localFromView * (glm::dvec3(in.position) - placement.origin);
        in.viewFromLocal = glm::mat3(placement.viewFromLocal);
        in.localFromView = glm::mat3(localFromView);
        in.localPosition = glm::vec3(p);
        for (size_t i = 0; i < vertices.size(); ++i)
            in.vertices[i] = glm::vec3(p + localFromView * vertices[i]);
    }
    // Vertices of a sheet around `centre`, relative to the receiver.
    std::vector<glm::dvec3> sheet(const glm::dvec3& centre, const glm::dvec3& halfU,
                                  const glm::dvec3& halfV, double jitter)
    {
        const glm::dvec3 w = glm::normalize(glm::cross(halfU, halfV)) * glm::length(halfU);
        std::vector<glm::dvec3> out;
        for (uint32_t row = 0; row < side; ++row)
            for (uint32_t column = 0; column < side; ++column) {
                const double u = 2.0 * column / gpu::SHEET_CELLS - 1;
                const double v = 2.0 * row / gpu::SHEET_CELLS - 1;
                const auto any = [&] { return uniform(-1, 1) * jitter / gpu::SHEET_CELLS; };
                const double du = any(), dv = any(), dw = any();
                out.push_back(centre + (u + du) * halfU + (v + dv) * halfV + dw * w);
            }
        return out;
    }
    // A jittered sheet between receiver and light that hides the whole light. In two of three pairs
    // a vertex or the middle of an edge hides a point of the light exactly. In half of the pairs
    // the receiver is the origin of all spaces, so that positions are hardly rounded.
    Input closedSheet(uint32_t type, double distance, double sine)
    {
        Input in = anyLight(type, distance, sine);
        const bool atOrigin = below(2) == 0;
        in.position = atOrigin ? glm::vec3(0) : glm::vec3(uniform(0, 10) * anyDirection());
        const glm::dvec3 a = glm::normalize(glm::dvec3(in.toLight));
        const double near = std::min(distance, 4.0) * (1 - sine) * uniform(0.2, 0.5);
        const double half = 3 * near * sine / std::sqrt(1 - sine * sine) + 1e-3 * near;
        const formula::LightFacet f = facetInDouble(in);
        std::vector<glm::dvec3> vertices;
        do {
            const glm::dvec3 n = glm::normalize(a + 0.3 * anyDirection());
            const glm::dvec3 u = across(n), v = glm::cross(n, u);
            vertices = sheet(near * a, half * u, half * v, 0.6);
            const uint32_t aim = below(3), point = below(64);
            const glm::dvec2 uv = f.shape == gpu::FACET_POINT
                                      ? glm::dvec2(0)
                                      : glm::dvec2(gpu::POINTS_64[f.shape * 64 + point]);
            const glm::dvec3 q = f.centre + uv.x * f.halfU + uv.y * f.halfV;
            const glm::dvec3 hit = q * (near / glm::dot(q, a));
            if (aim == 1)
                vertices[12] = hit;
            if (aim == 2)
                vertices[13] = 2.0 * hit - vertices[12];
        } while (isSeenEdgeOn(vertices));
        placeSheet(in, vertices, atOrigin ? Placement{} : anyPlacement(uniform(0, 30)));
        return in;
    }
    uint32_t below(uint32_t count) { return uint32_t(random_() % count); }
    uint32_t anyType() { return below(gpu::LIGHT_TYPE_COUNT); }
};

} // namespace

class VisibilityLeaks : public VisibilityProbeTest
{
};

// No point of a light is seen through a closed sheet, not even through its vertices and edges.
TEST_F(VisibilityLeaks, ClosedSheetsHideEverything)
{
    for (uint32_t round = 0; round < (fullTests() ? 24u : 2u); ++round) {
        const uint32_t points = round % 2 ? 32 : 64;
        std::vector<Input> inputs;
        for (uint32_t i = 0; i < 80000; ++i)
            inputs.push_back(closedSheet(anyType(), uniform(0.7, 8), uniform(0.001, 0.7)));
        uint64_t leaks = 0, tested = 0;
        const std::vector<Output> outputs = evaluate(inputs, points);
        for (const Output& out : outputs) {
            leaks += uint64_t(std::popcount(bitsOf(out.members) & ~bitsOf(out.hidden)));
            tested += uint64_t(std::popcount(bitsOf(out.members)));
            EXPECT_EQ(out.shares, glm::vec2(bitsOf(out.members) == 0 ? 1 : 0));
        }
        EXPECT_EQ(leaks, 0u) << points;
        EXPECT_GT(tested, inputs.size() * points / 2) << points;
    }
}

// The same with the smallest and the farthest lights.
TEST_F(VisibilityLeaks, ExtremeLightsAreHidden)
{
    std::vector<Input> inputs;
    for (uint32_t i = 0; i < 4000; ++i) {
        const double distance = i % 2 ? 1e15 / std::sqrt(3) : uniform(1, 4);
        const double size = i % 3 ? 2e-15 : 0.1 * distance;
        inputs.push_back(closedSheet(anyType(), distance, std::max(size / distance, 3e-30)));
        if (!((gpu::TYPES_WITH_POSITION >> inputs.back().type & 1u) != 0))
            inputs.back().boundingRadius = std::max(inputs.back().boundingRadius, 1e-15f);
    }
    uint32_t unshadowed = 0;
    for (const Output& out : evaluate(inputs)) {
        EXPECT_EQ(bitsOf(out.hidden), bitsOf(out.members));
        unshadowed += bitsOf(out.members) == 0;
        for (int k = 0; k < 3; ++k)
            EXPECT_TRUE(std::isfinite(out.largest[k])) << out.largest[k];
    }
    EXPECT_EQ(unshadowed, 0u);
}

class VisibilityMasks : public VisibilityProbeTest
{
protected:
    // A small sheet that hides a part of the light.
    Input partialSheet(uint32_t type)
    {
        Input in = anyLight(type, uniform(0.7, 8), uniform(0.1, 0.9));
        in.position = glm::vec3(uniform(0, 10) * anyDirection());
        const bool distant = (gpu::TYPES_WITH_POSITION >> type & 1u) == 0;
        const glm::dvec3 to = glm::dvec3(in.toLight) + anyDirection() * double(in.boundingRadius);
        const double size = glm::length(to) * uniform(0.03, 0.5) * (distant ? 3 : 1);
        const glm::dvec3 n = anyDirection(), u = across(n), v = glm::cross(n, u);
        placeSheet(in,
                   sheet(to * uniform(0.1, 0.9), size * u, size * uniform(0.1, 1) * v,
                         random_() % 2 ? 0.6 : 0.0),
                   anyPlacement(uniform(0, 10)));
        return in;
    }
};

TEST_F(VisibilityMasks, EqualThoseInDouble)
{
    std::vector<Input> inputs;
    for (uint32_t i = 0; i < 10000; ++i)
        inputs.push_back(partialSheet(anyType()));
    const std::vector<Output> outputs = evaluate(inputs);
    uint64_t different = 0, tested = 0, partial = 0;
    glm::dvec2 largest(0); // differences of the visible shares
    for (size_t i = 0; i < inputs.size(); ++i) {
        const Input& in = inputs[i];
        const Output& out = outputs[i];
        const formula::LightFacet facet = facetInDouble(in);
        if (facet.members == 0 || bitsOf(out.members) == 0)
            continue;
        const uint64_t hidden =
            formula::hiddenPoints(facet, {trianglesOf(in), glm::dmat3(in.viewFromLocal)}, {});
        different += uint64_t(std::popcount(hidden ^ bitsOf(out.hidden)));
        tested += uint64_t(std::popcount(facet.members));
        partial += hidden != 0 && hidden != facet.members;
        for (const float share : {out.shares.x, out.shares.y})
            EXPECT_TRUE(share >= 0 && share <= 1) << share;
        if (hidden == bitsOf(out.hidden) && facet.members == bitsOf(out.members)) {
            const glm::dvec2 shares =
                formula::visibleShares(facet, facet.members & ~hidden,
                                       {.n = glm::dvec3(in.n),
                                        .v = glm::dvec3(in.v),
                                        .perceptualRoughness = std::sqrt(double(in.alpha))});
            largest = glm::max(largest, glm::abs(shares - glm::dvec2(out.shares)));
        }
    }
    EXPECT_LE(double(different), 2e-5 * double(tested));
    EXPECT_GE(partial, inputs.size() / 4);
    EXPECT_LT(largest.x, 1e-5);
    EXPECT_LT(largest.y, 1e-5);
}

// No triangle that hides a point is in a box that the tests leave out.
TEST_F(VisibilityMasks, BoxTestsKeepWhatHides)
{
    uint32_t hiding = 0, lessThanAll = 0, tested = 0;
    for (uint32_t round = 0; round < (fullTests() ? 20u : 1u); ++round) {
        std::vector<Input> inputs;
        for (uint32_t i = 0; i < 40000; ++i)
            inputs.push_back(partialSheet(anyType()));
        for (const Output& out : evaluate(inputs)) {
            const uint64_t hidden = bitsOf(out.hidden), members = bitsOf(out.members);
            EXPECT_EQ(hidden & ~bitsOf(out.inBox), 0u);
            EXPECT_TRUE(hidden == 0 || out.touchesCone == 1);
            hiding += hidden != 0;
            lessThanAll += (bitsOf(out.inBox) & members) != members;
            ++tested;
        }
    }
    EXPECT_GE(hiding, tested / 2);
    EXPECT_GE(lessThanAll, tested / 8);
}

// The drawn surface of a rectangle light hides none of it.
TEST_F(VisibilityMasks, EmissiveQuadsDoNotHideTheirLight)
{
    std::vector<Input> inputs;
    for (uint32_t i = 0; i < 8000; ++i) {
        const double sines[] = {1, 0.3, 0.1, 0.02};
        Input in = anyLight(CND_LIGHT_RECTANGLE, uniform(0.7, 4), 0.2);
        const glm::dvec3 a = glm::normalize(glm::dvec3(in.toLight)), w = across(a);
        const double sine = sines[i % 4];
        const glm::dvec3 n = sine * a + std::sqrt(1 - sine * sine) * w;
        const glm::dvec3 u = across(n), v = glm::cross(n, u);
        in.position = glm::vec3(uniform(0, 10) * anyDirection());
        in.shape.axisU = glm::vec3(0.3 * u);
        in.shape.axisV = glm::vec3(0.15 * v);
        placeSheet(in, sheet(glm::dvec3(in.toLight), 0.5 * u, 0.5 * v, 0),
                   anyPlacement(uniform(0, 10)));
        inputs.push_back(in);
    }
    for (const Output& out : evaluate(inputs))
        EXPECT_EQ(bitsOf(out.hidden), 0u);
}

class VisibilityOwnSurface : public VisibilityProbeTest
{
protected:
    // A receiver on a flat sheet, with its position from 32-bit depth, and a light above the sheet.
    Input onSheet(double halfSize, double meshDistance)
    {
        Input in = anyLight(CND_LIGHT_SPHERE, uniform(0.7, 8), uniform(0.01, 0.2));
        const glm::dvec3 a = glm::normalize(glm::dvec3(in.toLight));
        const glm::dvec3 n = glm::normalize(a + 0.9 * across(a)), u = across(n);
        const double distance = uniform(1, 30);
        const double depthStep = distance * 0x1p-23;
        in.position = glm::vec3(distance * anyDirection());
        in.depthError = float(depthStep / 2);
        // The point of the sheet that is drawn, which depth moves along the view ray.
        const glm::dvec3 moved = glm::normalize(glm::dvec3(in.position)) * depthStep;
        const glm::dvec3 centre =
            halfSize * (uniform(-0.9, 0.9) * u + uniform(-0.9, 0.9) * glm::cross(n, u)) +
            uniform(-0.5, 0.5) * moved;
        placeSheet(in, sheet(centre, halfSize * u, halfSize * glm::cross(n, u), 0),
                   anyPlacement(meshDistance));
        return in;
    }
    // Returns the share of receivers that their own sheet shadows.
    double selfShadowed(double smallest, double largest, double nearest, double farthest)
    {
        std::vector<Input> inputs;
        for (uint32_t i = 0; i < 20000; ++i)
            inputs.push_back(onSheet(uniform(smallest, largest), uniform(nearest, farthest)));
        double shadowed = 0;
        for (const Output& out : evaluate(inputs))
            shadowed += bitsOf(out.hidden) != 0;
        return shadowed / double(inputs.size());
    }
};

TEST_F(VisibilityOwnSurface, TrianglesDoNotShadowThemselves)
{
    EXPECT_EQ(selfShadowed(0.4, 12, 0, 10), 0);
    EXPECT_EQ(selfShadowed(0.4, 12, 100, 100), 0); // a mesh far from its origin
    // Triangles of 2.5 to 10 km: float32 knows their planes to a millimetre only.
    EXPECT_LE(selfShadowed(5e3, 2e4, 0, 10), 1e-3);
}

} // namespace candelabra::test
