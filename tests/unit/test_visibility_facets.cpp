// SPDX-License-Identifier: Apache-2.0
// Compares the visible shares of lights that the shaders' masks give (tools/formula) with rays to
// the true emitters.
#include <algorithm>
#include <bit>
#include <cmath>
#include <functional>
#include <iostream>
#include <numbers>
#include <string>
#include <vector>

#include <fmt/format.h>
#include <gtest/gtest.h>

#include "formula/visibility.h"
#include "generate/random.h"
#include "harness/full_tests.h"
#include "lights/polygon.h"
#include "reference/brdf.h"
#include "scene/polygons.h"
#include "unit/emitter_rays.h"

namespace candelabra::test
{
namespace
{

// How a light lies to the receiver.
enum class View { Any, AcrossHorizon, EndOn };

// A kind of light, and the distances of its centre from the receiver.
struct Lamp {
    const char* name;
    uint32_t type;
    double size;  // m: radius; half length of an axis; sine of the angular radius
    double other; // m: radius of a tube, half width of a rectangle or polygon
    double nearest, farthest;
    View view = View::Any;
    std::vector<glm::dvec2> corners{{-1, -1}, {1, -1}, {1, 1}, {-1, 1}};
};

// Bounds of the root mean square errors: of the diffuse share with 64 and with 32 points, and of
// the specular share at alpha 0.1 and 0.5 with 64 points.
struct Bounds {
    double diffuse64, diffuse32, specular10, specular50;
};

// The receiver is the origin.
struct Case {
    formula::LightFacet facet;
    std::vector<EmitterRay> emitter;
    glm::dvec3 normal, toEye;
    std::vector<Occluder> occluders;
};

class Draw
{
public:
    explicit Draw(uint64_t seed) : random_(seed) {}

    double uniform(double low, double high) { return random_.uniform(float(low), float(high)); }
    uint32_t below(uint32_t count) { return random_.below(count); }
    glm::dvec3 direction()
    {
        const double z = uniform(-1, 1), azimuth = uniform(0, 2 * std::numbers::pi);
        const double s = std::sqrt(1 - z * z);
        return {s * std::cos(azimuth), s * std::sin(azimuth), z};
    }
    glm::dvec3 across(const glm::dvec3& axis)
    {
        return glm::normalize(glm::cross(axis, direction()));
    }
    // A direction at this cosine from the axis.
    glm::dvec3 around(const glm::dvec3& axis, double cosine)
    {
        return cosine * axis + std::sqrt(1 - cosine * cosine) * across(axis);
    }

private:
    app::Random random_;
};

uint32_t pointsPerSide()
{
    return fullTests() ? 64 : 46;
}

formula::LightFacet polygonFacet(const Lamp& lamp, uint32_t count, formula::Light light)
{
    const glm::dvec3 u(light.shape.axisU), v(light.shape.axisV);
    const double size = std::max(glm::length(u), glm::length(v));
    std::vector<glm::dvec2> corners;
    for (const auto& corner : lamp.corners)
        corners.push_back(glm::dvec2(corner[0] * glm::length(u), corner[1] * glm::length(v)) /
                          size);
    const formula::EnclosingRectangle r = formula::enclosingRectangle(count, corners);
    const auto inPlane = [&](const glm::dvec2& at) {
        return size * (at.x * glm::normalize(u) + at.y * glm::normalize(v));
    };
    light.centre += inPlane(r.centre);
    light.shape.axisU = inPlane(r.halfU);
    light.shape.axisV = inPlane(r.halfV);
    return formula::lightFacet(count, {}, light, r.points);
}

// Places the lamp, with its facet of `count` points and the points of its true emitter.
Case placeLamp(const Lamp& lamp, uint32_t count, Draw& draw)
{
    const double distance = draw.uniform(lamp.nearest, lamp.farthest);
    const glm::dvec3 a = draw.direction(), d = a * distance;
    const uint32_t side = pointsPerSide();
    formula::Light light{.type = lamp.type, .centre = d, .boundingRadius = lamp.size};
    Case out;
    if (lamp.type == CND_LIGHT_SPHERE) {
        out.emitter = spherePoints(d, lamp.size, side);
    } else if (lamp.type == CND_LIGHT_DISTANT_SPHERE) {
        light.centre = a;
        out.emitter = distantSpherePoints(a, lamp.size, side);
    } else if (lamp.type == CND_LIGHT_DISC) {
        const glm::dvec3 normal = draw.around(a, draw.uniform(0.15, 1));
        light.shape.axisU = normal;
        light.shape.radius = float(lamp.size);
        out.emitter = discPoints(d, normal, lamp.size, side);
    } else if (lamp.type == CND_LIGHT_TUBE) {
        const glm::dvec3 axis =
            lamp.size * (lamp.view == View::EndOn
                             ? draw.around(a, std::cos(draw.uniform(0, std::numbers::pi / 18)))
                             : draw.direction());
        light.shape.axisU = axis;
        light.shape.radius = float(lamp.other);
        out.emitter = tubePoints(d, axis, lamp.other, side);
    } else {
        const glm::dvec3 normal = draw.around(a, draw.uniform(0.15, 1));
        const glm::dvec3 u = draw.across(normal), v = glm::cross(normal, u);
        light.shape.axisU = lamp.size * u;
        light.shape.axisV = lamp.other * v;
        out.emitter = polygonPoints(d, lamp.size * u, lamp.other * v, lamp.corners, side);
    }
    if (lamp.type == CND_LIGHT_POLYGON)
        out.facet = polygonFacet(lamp, count, light);
    else
        out.facet = formula::lightFacet(count, {}, light);
    return out;
}

// Places one to three boxes or sheets between the receiver and points of the emitter.
void addOccluders(Case& c, double distance, Draw& draw)
{
    const uint32_t count = 1 + draw.below(3);
    for (uint32_t i = 0; i < count; ++i) {
        const EmitterRay& to = c.emitter[draw.below(uint32_t(c.emitter.size()))];
        const double size = distance * draw.uniform(0.03, 0.5);
        const glm::dvec3 x = draw.direction(), y = draw.across(x), z = glm::cross(x, y);
        const double length = std::min(to.distance, distance);
        const glm::dvec3 centre = to.direction * (length * draw.uniform(0.15, 0.85)) +
                                  draw.direction() * (size * draw.uniform(0, 0.7));
        const double depth = draw.below(2) == 0 ? 0 : draw.uniform(0.2, 1);
        const double width = draw.uniform(0.2, 1), height = draw.uniform(0.2, 1);
        c.occluders.push_back(
            makeBox(centre, 0.5 * size * glm::dmat3(width * x, height * y, depth * z)));
    }
}

// Turns the receiver towards the light, and the eye so that it sees the reflection of one of its
// points. Half of the receivers that see all of the light see that point near the horizon. Of a
// light across the horizon, a tenth at least is above it.
bool placeReceiver(Case& c, const Lamp& lamp, Draw& draw)
{
    const auto somePoint = [&] {
        return c.emitter[draw.below(uint32_t(c.emitter.size()))].direction;
    };
    const bool across = lamp.view == View::AcrossHorizon, grazing = draw.below(2) == 0;
    glm::dvec3 reflected = somePoint();
    c.normal = draw.around(reflected, across    ? draw.uniform(0, 0.1)
                                      : grazing ? draw.uniform(0.05, 0.3)
                                                : draw.uniform(0.3, 1));
    const auto isUp = [&](const EmitterRay& p) { return glm::dot(p.direction, c.normal) > 0; };
    const double up =
        double(std::count_if(c.emitter.begin(), c.emitter.end(), isUp)) / double(c.emitter.size());
    if (across ? up < 0.1 || up == 1 : up < 1)
        return false;
    while (across && glm::dot(reflected, c.normal) < 0.005)
        reflected = somePoint();
    c.toEye = 2 * glm::dot(reflected, c.normal) * c.normal - reflected;
    return true;
}

struct Shares {
    double diffuse = 0, specular10 = 0, specular50 = 0;
};

// Returns sums of weight over the emitter, of all or of its visible points.
Shares trueShares(const Case& c)
{
    Shares lit, sum;
    const auto cosine = [&](const glm::dvec3& l) { return std::min(glm::dot(c.normal, l), 1.0); };
    const double NoV = std::max(cosine(c.toEye), reference::minNoV);
    for (const EmitterRay& p : c.emitter) {
        const double NoL = cosine(p.direction);
        if (NoL <= 0)
            continue;
        const double NoH = cosine(glm::normalize(p.direction + c.toEye));
        const auto lobe = [&](double alpha) {
            return reference::ggxD(NoH, alpha) * reference::smithVisibility(NoL, NoV, alpha) * NoL *
                   p.solidAngle;
        };
        const Shares w{NoL * p.solidAngle, lobe(0.1), lobe(0.5)};
        const double seen = isHidden(p, c.occluders) ? 0 : 1;
        for (double Shares::*const s :
             {&Shares::diffuse, &Shares::specular10, &Shares::specular50}) {
            sum.*s += w.*s;
            lit.*s += seen * w.*s;
        }
    }
    return {lit.diffuse / sum.diffuse, lit.specular10 / sum.specular10,
            lit.specular50 / sum.specular50};
}

// Returns whether a sixteenth of the emitter's points is visible or hidden as a whole. Pairs in the
// penumbra are rare, and this finds most others soon.
bool isLitAlike(const Case& c)
{
    const bool first = isHidden(c.emitter[0], c.occluders);
    for (size_t i = 16; i < c.emitter.size(); i += 17)
        if (isHidden(c.emitter[i], c.occluders) != first)
            return false;
    return true;
}

Shares sharesOfMask(const Case& c)
{
    uint64_t lit = c.facet.members;
    for (const Occluder& o : c.occluders)
        lit &= ~formula::hiddenPoints(c.facet, {o.triangles}, {});
    const auto at = [&](double alpha) {
        return formula::visibleShares(
            c.facet, lit, {.n = c.normal, .v = c.toEye, .perceptualRoughness = std::sqrt(alpha)});
    };
    return {at(0.1).x, at(0.1).y, at(0.5).y};
}

struct Figures {
    Shares rms;
    double bias = 0; // of the diffuse share
};

// Compares pairs of a receiver and a light that are in the penumbra.
Figures compare(const Lamp& lamp, uint32_t count, uint32_t pairs)
{
    Draw draw(count);
    Figures out;
    uint32_t found = 0;
    while (found < pairs) {
        Case c = placeLamp(lamp, count, draw);
        if (c.facet.members == 0) // the receiver is inside
            continue;
        const double distance = lamp.type == CND_LIGHT_DISTANT_SPHERE
                                    ? 1
                                    : glm::length(c.facet.centre) / c.facet.inverseDistance;
        addOccluders(c, distance, draw);
        if (!placeReceiver(c, lamp, draw))
            continue;
        if (isLitAlike(c))
            continue;
        const Shares truth = trueShares(c);
        if (!(truth.diffuse > 0.002 && truth.diffuse < 0.998))
            continue;
        ++found;
        const Shares ours = sharesOfMask(c);
        out.bias += (ours.diffuse - truth.diffuse) / pairs;
        for (double Shares::*const s : {&Shares::diffuse, &Shares::specular10, &Shares::specular50})
            out.rms.*s += (ours.*s - truth.*s) * (ours.*s - truth.*s) / pairs;
    }
    return {
        {std::sqrt(out.rms.diffuse), std::sqrt(out.rms.specular10), std::sqrt(out.rms.specular50)},
        out.bias};
}

void expectWithin(const Lamp& lamp, const Bounds& bounds)
{
    const uint32_t pairs = fullTests() ? 400 : 60;
    const Figures with64 = compare(lamp, 64, pairs), with32 = compare(lamp, 32, pairs);
    std::cout << fmt::format("{:34} rms {:.3f} ({:.3f}), 32: {:.3f} ({:.3f}); specular {:.3f} "
                             "({:.3f}), {:.3f} ({:.3f}); bias {:+.4f}\n",
                             lamp.name, with64.rms.diffuse, bounds.diffuse64, with32.rms.diffuse,
                             bounds.diffuse32, with64.rms.specular10, bounds.specular10,
                             with64.rms.specular50, bounds.specular50, with64.bias);
    const double slack = fullTests() ? 1.1 : 1.8; // figures of few pairs scatter
    EXPECT_LE(with64.rms.diffuse, slack * bounds.diffuse64) << lamp.name;
    EXPECT_LE(with32.rms.diffuse, slack * bounds.diffuse32) << lamp.name;
    EXPECT_LE(with64.rms.specular10, slack * bounds.specular10) << lamp.name;
    EXPECT_LE(with64.rms.specular50, slack * bounds.specular50) << lamp.name;
}

} // namespace

// The bounds are those of the design (400 pairs).
TEST(VisibilityFacets, Spheres)
{
    expectWithin({"sphere 0.05", CND_LIGHT_SPHERE, 0.05, 0, 0.7, 4}, {0.016, 0.027, 0.056, 0.018});
    expectWithin({"sphere 0.5", CND_LIGHT_SPHERE, 0.5, 0, 0.7, 4}, {0.016, 0.027, 0.056, 0.018});
    expectWithin({"sphere at 1.05..2 R", CND_LIGHT_SPHERE, 1, 0, 1.05, 2},
                 {0.026, 0.043, 0.088, 0.028});
    expectWithin(
        {"sphere across the horizon", CND_LIGHT_SPHERE, 0.5, 0, 0.7, 4, View::AcrossHorizon},
        {0.028, 0.045, 0.108, 0.031});
}

TEST(VisibilityFacets, DistantSpheres)
{
    expectWithin({"distant, sine 0.1", CND_LIGHT_DISTANT_SPHERE, 0.1, 0, 1, 1},
                 {0.014, 0.023, 0.022, 0.015});
    expectWithin({"the Sun", CND_LIGHT_DISTANT_SPHERE, 0.00465, 0, 1, 1},
                 {0.013, 0.020, 0.022, 0.015});
    expectWithin({"distant, sine 0.7", CND_LIGHT_DISTANT_SPHERE, 0.7, 0, 1, 1},
                 {0.020, 0.035, 0.1, 0.025});
}

TEST(VisibilityFacets, FlatLights)
{
    expectWithin({"rectangle 0.6 x 0.3", CND_LIGHT_RECTANGLE, 0.3, 0.15, 0.7, 4},
                 {0.016, 0.028, 0.032, 0.017});
    expectWithin({"rectangle 1.2 x 1.2", CND_LIGHT_RECTANGLE, 0.6, 0.6, 0.7, 4},
                 {0.031, 0.058, 0.060, 0.035});
    expectWithin(
        {"the same across the horizon", CND_LIGHT_RECTANGLE, 0.6, 0.6, 0.7, 4, View::AcrossHorizon},
        {0.037, 0.068, 0.108, 0.045});
    expectWithin({"rectangle 1.2 x 1.2 at 0.12..1.2", CND_LIGHT_RECTANGLE, 0.6, 0.6, 0.12, 1.2},
                 {0.082, 0.107, 0.107, 0.084});
    expectWithin({"disc 0.2", CND_LIGHT_DISC, 0.2, 0, 0.7, 4}, {0.015, 0.027, 0.028, 0.016});
    expectWithin({"disc 0.5 at 0.1..1", CND_LIGHT_DISC, 0.5, 0, 0.1, 1},
                 {0.068, 0.094, 0.107, 0.084});
}

// The points of a rectangle that is seen from its edge move a little, so that its light coordinates
// are precise. A wall that it lies flush in still hides none of them.
TEST(VisibilityFacets, FlatLightsAreSeenAtALeastSine)
{
    constexpr double least = 0x1p-6;
    formula::Light light{.type = CND_LIGHT_RECTANGLE};
    light.shape.axisU = {0.7, 0, 0};
    light.shape.axisV = {0, 0, 0.4};
    for (const double sine : {0.0, 1e-6, -3e-4, 0.015, -0.015, -0.016, 0.1}) {
        light.centre = 4.0 * glm::normalize(glm::dvec3(0.6, sine, 0.8));
        const formula::LightFacet f = formula::lightFacet(64, {}, light);
        EXPECT_EQ(f.members, ~uint64_t{0}) << sine;
        const glm::dvec3 n = glm::normalize(glm::cross(f.halfU, f.halfV));
        const double seen = std::abs(glm::dot(n, glm::normalize(f.centre)));
        const double unit = 1 / f.inverseDistance;
        if (std::abs(sine) < least) {
            EXPECT_GE(seen, 0.499 * least) << sine;
            EXPECT_LE(glm::distance(unit * f.halfU, glm::dvec3(0.7, 0, 0)), 0.7 * least) << sine;
            EXPECT_LE(glm::distance(unit * f.halfV, glm::dvec3(0, 0, 0.4)), 0.4 * least) << sine;
            EXPECT_LE(glm::distance(unit * f.centre, light.centre), 1.1 * least) << sine;
        } else {
            EXPECT_NEAR(seen, std::abs(sine), 0.01 * seen) << sine;
            EXPECT_LE(glm::distance(unit * f.halfU, glm::dvec3(0.7, 0, 0)), 1e-7) << sine;
        }
        const double y = light.centre.y;
        const formula::Triangle wall[] = {{{{-99, y, -99}, {99, y, -99}, {0, y, 99}}}};
        EXPECT_EQ(formula::hiddenPoints(f, {.triangles = wall}, {}), 0u) << sine;
    }
}

TEST(VisibilityFacets, Polygons)
{
    const std::vector<glm::dvec2> triangle{{-1, -1}, {1, -1}, {0.2, 1}};
    const std::vector<glm::dvec2> needle{{-1, -0.2}, {1, 0}, {-1, 0.2}};
    std::vector<glm::dvec2> hexagon, octagon;
    for (int i = 0; i < 8; ++i) {
        const double six = i * std::numbers::pi / 3, eight = i * std::numbers::pi / 4;
        if (i < 6)
            hexagon.emplace_back(std::cos(six), std::sin(six));
        octagon.emplace_back(std::cos(eight), std::sin(eight));
    }
    expectWithin({"triangle", CND_LIGHT_POLYGON, 0.4, 0.4, 0.7, 4, View::Any, triangle},
                 {0.037, 0.056, 0.066, 0.038});
    expectWithin({"needle", CND_LIGHT_POLYGON, 0.4, 0.4, 0.7, 4, View::Any, needle},
                 {0.039, 0.069, 0.066, 0.038});
    expectWithin({"hexagon", CND_LIGHT_POLYGON, 0.4, 0.4, 0.7, 4, View::Any, hexagon},
                 {0.027, 0.033, 0.066, 0.038});
    expectWithin(
        {"octagon at 0.06..0.6", CND_LIGHT_POLYGON, 0.3, 0.3, 0.06, 0.6, View::Any, octagon},
        {0.096, 0.124, 0.113, 0.082});
}

TEST(VisibilityFacets, Tubes)
{
    expectWithin({"tube 1.2 / 0.02", CND_LIGHT_TUBE, 0.6, 0.02, 0.7, 4},
                 {0.025, 0.044, 0.048, 0.023});
    expectWithin(
        {"the same across the horizon", CND_LIGHT_TUBE, 0.6, 0.02, 0.7, 4, View::AcrossHorizon},
        {0.046, 0.074, 0.108, 0.045});
    expectWithin({"tube 0.6 / 0.1", CND_LIGHT_TUBE, 0.3, 0.1, 0.7, 4},
                 {0.037, 0.049, 0.041, 0.033});
    expectWithin({"tube 0.1 / 0.3", CND_LIGHT_TUBE, 0.05, 0.3, 0.7, 4},
                 {0.020, 0.039, 0.041, 0.033});
    expectWithin({"tube 0.6 / 0.1 end-on", CND_LIGHT_TUBE, 0.3, 0.1, 0.7, 4, View::EndOn},
                 {0.037, 0.093, 0.128, 0.086});
    expectWithin({"tube 1.2 / 0.02 end-on", CND_LIGHT_TUBE, 0.6, 0.02, 0.7, 4, View::EndOn},
                 {0.093, 0.103, 0.128, 0.086});
    expectWithin({"tube 0.6 / 0.1 at 0.15..0.5", CND_LIGHT_TUBE, 0.3, 0.1, 0.15, 0.5},
                 {0.095, 0.102, 0.178, 0.100});
}

// No rectangle in any of 1,800 directions is smaller. At least half of it is filled.
TEST(VisibilityFacets, EnclosingRectanglesAreSmallest)
{
    for (uint32_t i = 0; i < 12; ++i) {
        const CndPolygon& polygon = *app::somePolygon(i);
        const double width = 1, height = 0.25;
        std::vector<glm::dvec2> corners;
        for (uint32_t j = 0; j < polygon.cornerCount; ++j)
            corners.emplace_back(width * polygon.corners[j][0], height * polygon.corners[j][1]);
        const formula::EnclosingRectangle r = formula::enclosingRectangle(64, corners);
        EXPECT_NEAR(glm::dot(r.halfU, r.halfV), 0, 1e-12);
        const double area = 4 * glm::length(r.halfU) * glm::length(r.halfV);
        EXPECT_GE(lighting::polygonArea(polygon) * width * height, 0.5 * area) << i;
        for (const glm::dvec2& corner : corners) {
            EXPECT_LE(std::abs(glm::dot(corner - r.centre, r.halfU)),
                      (1 + 1e-9) * glm::dot(r.halfU, r.halfU));
            EXPECT_LE(std::abs(glm::dot(corner - r.centre, r.halfV)),
                      (1 + 1e-9) * glm::dot(r.halfV, r.halfV));
        }
        double smallest = INFINITY;
        for (uint32_t k = 0; k < 1800; ++k) {
            const double angle = k * std::numbers::pi / 3600;
            const glm::dvec2 along(std::cos(angle), std::sin(angle)), across(-along.y, along.x);
            glm::dvec2 low(INFINITY), high(-INFINITY);
            for (const glm::dvec2& corner : corners) {
                const glm::dvec2 at(glm::dot(along, corner), glm::dot(across, corner));
                low = glm::min(low, at);
                high = glm::max(high, at);
            }
            smallest = std::min(smallest, (high.x - low.x) * (high.y - low.y));
        }
        EXPECT_LE(area, smallest * (1 + 1e-9)) << i;
        EXPECT_GE(std::popcount(r.points), 29) << i;
        EXPECT_GE(std::popcount(formula::enclosingRectangle(32, corners).points), 14) << i;
    }
    const std::vector<glm::dvec2> square{{-1, -1}, {1, -1}, {1, 1}, {-1, 1}};
    EXPECT_EQ(formula::enclosingRectangle(64, square).points, ~uint64_t{0});
    EXPECT_EQ(formula::enclosingRectangle(32, square).points, uint64_t{UINT32_MAX});
}

} // namespace candelabra::test
