// SPDX-License-Identifier: Apache-2.0
// Tests the integrator along the outlines of lights: the lobe against closed forms and against
// quadrature over directions, the form factor against the other integrators, symmetries, limits,
// and inputs that are hard for floating point.
#include <algorithm>
#include <array>
#include <cmath>
#include <memory>
#include <random>
#include <vector>

#include <gtest/gtest.h>

#include "harness/constants.h"
#include "harness/full_tests.h"
#include "reference/arc_domain.h"
#include "reference/direction_domain.h"
#include "reference/quadrature.h"
#include "reference/truth.h"
#include "test_reference_support.h"

namespace candelabra::test
{

using namespace candelabra::reference;

namespace
{

using Corners = std::array<glm::dvec3, 4>;

SurfacePoint seenFrom(double angle)
{
    return {{0, 0, 0}, {0, 0, 1}, {std::sin(angle), 0, std::cos(angle)}};
}

Corners rectangle(const glm::dvec3& center, const glm::dvec3& u, const glm::dvec3& v)
{
    return {center - u - v, center + u - v, center + u + v, center - u + v};
}

// Random directions, sizes and lights.
class Draws
{
public:
    explicit Draws(uint64_t seed) : random_(seed) {}

    double unit() { return std::uniform_real_distribution<double>(0, 1)(random_); }
    double logarithmic(double low, double high) { return low * std::pow(high / low, unit()); }
    bool chance(double probability) { return unit() < probability; }
    glm::dvec3 direction()
    {
        const double z = 2 * unit() - 1, phi = 2 * pi * unit();
        const double across = std::sqrt(1 - z * z);
        return {across * std::cos(phi), across * std::sin(phi), z};
    }
    // Zero, a few rounding errors, or more.
    double hair()
    {
        const double sign = chance(0.5) ? 1 : -1;
        const double which = unit();
        return which < 0.25 ? 0 : sign * logarithmic(which < 0.5 ? 1e-16 : 1e-12, 0.1);
    }
    glm::dvec3 besides(const glm::dvec3& axis)
    {
        return glm::normalize(axis + hair() * direction());
    }

private:
    std::mt19937_64 random_;
};

// A light of any shape in both forms: for the integrator along outlines and as a set of directions.
struct Shape {
    CndLightType type;
    glm::dvec3 center, u, v; // a disc's normal is u
    double radius;

    LobeIntegral alongArcs(const SurfacePoint& surface, double alpha) const
    {
        switch (type) {
        case CND_LIGHT_SPHERE:
            return arcDomainCap(surface, alpha, sphereCap(center, radius));
        case CND_LIGHT_TUBE:
            return arcDomainCapsule(surface, alpha, center - u, center + u, radius);
        case CND_LIGHT_RECTANGLE:
            return arcDomainPolygon(surface, alpha, rectangle(center, u, v));
        default:
            return arcDomainDisc(surface, alpha, center, u, radius);
        }
    }

    std::unique_ptr<Outline> outline() const
    {
        switch (type) {
        case CND_LIGHT_SPHERE:
            return capOutline(sphereCap(center, radius));
        case CND_LIGHT_TUBE:
            return capsuleOutline(center - u, center + u, radius);
        case CND_LIGHT_RECTANGLE:
            return polygonOutline(rectangle(center, u, v));
        default:
            return discOutline(center, u, radius);
        }
    }
};

constexpr CndLightType shapeTypes[] = {CND_LIGHT_SPHERE, CND_LIGHT_TUBE, CND_LIGHT_RECTANGLE,
                                       CND_LIGHT_DISC};

Shape drawShape(CndLightType type, const SurfacePoint& surface, Draws& draw)
{
    const glm::dvec3 mirror(-surface.toEye.x, -surface.toEye.y, surface.toEye.z);
    for (;;) {
        const glm::dvec3 way =
            draw.chance(0.5) ? draw.direction() : glm::normalize(mirror + 0.4 * draw.direction());
        const glm::dvec3 center = (0.3 + 3 * draw.unit()) * way;
        const double size = draw.logarithmic(0.02, 2);
        // Some tubes point at the receiver.
        const glm::dvec3 u = type == CND_LIGHT_TUBE && draw.chance(0.2)
                                 ? glm::normalize(way + 0.1 * draw.direction())
                                 : draw.direction();
        const glm::dvec3 v = glm::normalize(glm::cross(u, draw.direction()));
        if (type == CND_LIGHT_DISC)
            return {type, center, u, v, size};
        Shape shape{type, center, size * u, size * (0.1 + draw.unit()) * v, size};
        if (type == CND_LIGHT_TUBE)
            shape.radius = draw.logarithmic(0.02, 0.6);
        const double along =
            type == CND_LIGHT_TUBE ? std::clamp(-glm::dot(center, u), -size, size) : 0;
        if (type == CND_LIGHT_RECTANGLE || glm::length(center + along * u) > 1.01 * shape.radius)
            return shape; // the receiver is outside the body
    }
}

// Integrates D (n . h) / (4 v . h) and the same times the slopes along x and y over the outline's
// part above the horizon: dw_h = dw_l / (4 v . h). In polar coordinates around the mirror
// direction.
std::array<double, 3> overDirections(const SurfacePoint& surface, double alpha,
                                     const Outline& outline)
{
    const glm::dvec3 &n = surface.normal, &v = surface.toEye;
    const glm::dvec3 mirror(-v.x, -v.y, v.z);
    const Frame pole = frameAround(mirror, n), horizon = frameAround(n, mirror);
    const auto spoke = [&](double phi) { return std::cos(phi) * pole.x + std::sin(phi) * pole.y; };
    const auto interval = [&](double phi) {
        std::optional<Arc> arc = outline.arc(mirror, spoke(phi));
        if (arc)
            arc =
                intersect(*arc, {std::atan2(glm::dot(n, spoke(phi)), glm::dot(n, mirror)), pi / 2});
        return arc ? intersect({pi / 2, pi / 2}, *arc) : arc;
    };
    std::vector<double> breaks = outline.angles(pole);
    if (const auto arc = outline.arc(horizon.x, horizon.y))
        for (const double t : {arc->centre - arc->halfWidth, arc->centre + arc->halfWidth}) {
            const glm::dvec3 meeting = std::cos(t) * horizon.x + std::sin(t) * horizon.y;
            breaks.push_back(std::atan2(glm::dot(meeting, pole.y), glm::dot(meeting, pole.x)));
        }
    for (double& phi : breaks)
        phi = std::remainder(phi, 2 * pi);
    breaks.insert(breaks.end(), {-pi, 0, pi});
    std::sort(breaks.begin(), breaks.end());
    const auto along = [&](double phi) {
        const auto arc = interval(phi);
        if (!arc)
            return std::array<double, 3>{};
        const double width = alpha * v.z / std::hypot(v.z * std::cos(phi), std::sin(phi));
        const auto toU = [&](double theta) {
            return std::atan(std::tan(std::clamp(theta, 0.0, pi) / 2) / width);
        };
        const std::array<double, 2> ends = {toU(arc->centre - arc->halfWidth),
                                            toU(arc->centre + arc->halfWidth)};
        return reference::integrate<3, 60>(
                   std::span<const double>(ends), 1e-8, negligible,
                   [&](double angle) {
                       const double t = width * std::tan(angle), t2 = t * t;
                       const glm::dvec3 l = ((1 - t2) * mirror + 2 * t * spoke(phi)) / (1 + t2);
                       const glm::dvec3 m = v + l;
                       const double length = glm::length(m);
                       if (!(length > 0))
                           return std::array<double, 3>{};
                       const double NoH = std::min(m.z / length, 1.0);
                       const double weight = ggxD(NoH, alpha) * NoH / (2 * length);
                       const double step = (1 + std::tan(angle) * std::tan(angle)) * 2 * width;
                       const double value = weight * step * 2 * t / ((1 + t2) * (1 + t2));
                       return std::array<double, 3>{value, value * m.x / m.z, value * m.y / m.z};
                   })
            .value;
    };
    return integratePanels<3>(
               std::span<const double>(breaks), 1e-7,
               [&](double phi) { return interval(phi).has_value(); }, along)
        .value;
}

double worstDifference(const LobeIntegral& a, const LobeIntegral& b)
{
    const double slopes = a.integral * glm::length(a.meanSlope - b.meanSlope);
    return std::max(
        {std::abs(a.integral - b.integral), slopes, glm::length(a.irradiance - b.irradiance)});
}

} // namespace

TEST(ReferenceArcs, lobesAndFormFactorsAreThoseOfQuadratureOverDirections)
{
    const int count = fullTests() ? 3000 : 100;
    for (const CndLightType type : shapeTypes) {
        Draws draw(5);
        WorstCase lobe, slope, formFactor;
        int crossing = 0;
        for (int i = 0; i < count; ++i) {
            const double alpha = draw.logarithmic(0.002, 1);
            const SurfacePoint surface = seenFrom(draw.unit() * 89 * pi / 180);
            const Shape shape = drawShape(type, surface, draw);
            const LobeIntegral arcs = shape.alongArcs(surface, alpha);
            EXPECT_TRUE(arcs.converged);
            const auto outline = shape.outline();
            const auto expected = overDirections(surface, alpha, *outline);
            const double f = directionDomainDiffuse(surface.normal, *outline, 1e-10).f;
            crossing += arcs.irradiance.z > 0 && shape.center.z < 0;
            const auto add = [&](WorstCase& worst, double error) {
                worst.add(error, "alpha", alpha, "NoV", surface.toEye.z, "center", shape.center.x,
                          shape.center.y, shape.center.z, "u", shape.u.x, shape.u.y, shape.u.z,
                          "radius", shape.radius);
            };
            add(lobe, std::abs(arcs.integral - expected[0]));
            add(slope, std::hypot(arcs.integral * arcs.meanSlope.x - expected[1],
                                  arcs.integral * arcs.meanSlope.y - expected[2]));
            add(formFactor, std::abs(arcs.irradiance.z - f) / std::max(f, 1e-6));
        }
        EXPECT_GT(crossing, count / 20) << "the horizon cuts too few lights of type " << type;
        EXPECT_TRUE(lobe.within(1e-7)) << type;
        EXPECT_TRUE(slope.within(1e-5)) << type; // slopes are not bounded; most weigh little
        EXPECT_TRUE(formFactor.within(1e-7)) << type;
    }
}

// A cap around the normal, seen along the normal: half vectors within half its angle.
TEST(ReferenceArcs, capsAroundTheNormalHaveTheClosedForm)
{
    WorstCase worst;
    for (const double alpha : {0.002, 0.03, 0.4, 1.0})
        for (const double angle : {1e-7, 1e-4, 0.01, 0.5, 1.5}) {
            const double s = std::sin(angle), tan2 = std::pow(std::tan(angle / 2), 2);
            const LobeIntegral arcs = arcDomainCap(seenFrom(0), alpha, {{0, 0, 1}, s * s});
            worst.add(std::abs(arcs.integral * (alpha * alpha + tan2) / tan2 - 1), alpha, angle);
            worst.add(std::abs(arcs.irradiance.z / (s * s) - 1), "form factor", alpha, angle);
        }
    EXPECT_TRUE(worst.within(1e-8));
}

TEST(ReferenceArcs, smallLightsArePoints)
{
    Draws draw(6);
    WorstCase worst;
    for (int i = 0; i < 200; ++i) {
        const SurfacePoint surface = seenFrom(draw.unit() * 80 * pi / 180);
        const double alpha = draw.logarithmic(0.05, 1);
        const glm::dvec3 to = glm::normalize(draw.direction() + glm::dvec3(0, 0, 1.5));
        const glm::dvec3 u = 1e-6 * glm::normalize(glm::cross(draw.direction(), to));
        const glm::dvec3 v = glm::cross(to, u);
        const glm::dvec3 half = glm::normalize(to + surface.toEye);
        const double density =
            ggxD(half.z, alpha) * half.z / (4 * glm::dot(half, surface.toEye)); // per solid angle
        const double area = 4 * glm::dot(u, u);
        const LobeIntegral arcs = arcDomainPolygon(surface, alpha, rectangle(to, u, v));
        worst.add(std::abs(arcs.integral / (area * density) - 1), "lobe", alpha, to.z);
        worst.add(glm::length(arcs.meanSlope - glm::dvec3(half.x, half.y, 0) / half.z), "slope",
                  alpha, to.z);
        worst.add(glm::length(arcs.irradiance * pi / area - to), "irradiance", alpha, to.z);
    }
    EXPECT_TRUE(worst.within(1e-5));
}

TEST(ReferenceArcs, windingMirroringAndExtraCornersChangeNothing)
{
    Draws draw(7);
    WorstCase worst;
    for (int i = 0; i < 300; ++i) {
        const SurfacePoint surface = seenFrom(draw.unit() * 89 * pi / 180);
        const double alpha = draw.logarithmic(0.002, 1);
        const Shape shape = drawShape(CND_LIGHT_RECTANGLE, surface, draw);
        const Corners corners = rectangle(shape.center, shape.u, shape.v);
        const LobeIntegral arcs = arcDomainPolygon(surface, alpha, corners);

        Corners reversed = corners, mirrored = corners;
        std::reverse(reversed.begin(), reversed.end());
        worst.add(worstDifference(arcs, arcDomainPolygon(surface, alpha, reversed)), "winding");

        for (glm::dvec3& corner : mirrored)
            corner.y = -corner.y;
        LobeIntegral back = arcDomainPolygon(surface, alpha, mirrored);
        back.irradiance.y = -back.irradiance.y;
        back.meanSlope.y = -back.meanSlope.y;
        worst.add(worstDifference(arcs, back), "mirrored");

        // A corner twice, and one in the middle of an edge.
        const std::array<glm::dvec3, 6> more = {corners[0], corners[0],
                                                corners[1], (corners[1] + corners[2]) / 2.0,
                                                corners[2], corners[3]};
        worst.add(worstDifference(arcs, arcDomainPolygon(surface, alpha, more)), "more corners");

        // Two triangles.
        const std::array<glm::dvec3, 3> first = {corners[0], corners[1], corners[2]};
        const std::array<glm::dvec3, 3> second = {corners[0], corners[2], corners[3]};
        const LobeIntegral a = arcDomainPolygon(surface, alpha, first);
        const LobeIntegral b = arcDomainPolygon(surface, alpha, second);
        worst.add(std::abs(a.integral + b.integral - arcs.integral), "halves");
        worst.add(glm::length(a.irradiance + b.irradiance - arcs.irradiance),
                  "irradiance of halves");
    }
    EXPECT_TRUE(worst.within(1e-9));
}

TEST(ReferenceArcs, lightsAtTheirLimitsMeet)
{
    const SurfacePoint surface = seenFrom(0.7);
    const glm::dvec3 place(-1, 0.5, 1), away = glm::normalize(place);
    const LobeIntegral ball = arcDomainCap(surface, 0.1, sphereCap(place, 0.4));
    EXPECT_GT(ball.integral, 0.1);
    WorstCase worst;
    const auto tube = [&](const glm::dvec3& end, double radius) {
        return arcDomainCapsule(surface, 0.1, place, end, radius);
    };
    worst.add(worstDifference(ball, tube(place, 0.4)), "no length");
    worst.add(worstDifference(ball, tube(place + glm::dvec3(0, 1e-10, 0), 0.4)),
              "hardly any length");
    worst.add(worstDifference(ball, tube(place + 3.0 * away, 0.4)), "seen along its axis");
    // Where the receiver is almost in the far sphere's extension, the rim passes to the tube's.
    const glm::dvec3 side = glm::normalize(glm::cross(away, glm::dvec3(0, 0, 1)));
    const double angle = std::asin(0.4 / glm::length(place));
    for (const double beside : {-1e-9, 1e-9}) {
        const glm::dvec3 along = std::cos(angle + beside) * away + std::sin(angle + beside) * side;
        worst.add(worstDifference(ball, tube(place + 3.0 * along, 0.4)), "beside its axis", beside);
    }
    // A receiver in the plane of a flat light, or above all of it, gets nothing.
    const glm::dvec3 x(1, 0, 0), z(0, 0, 1);
    for (const LobeIntegral& dark : {arcDomainPolygon(surface, 0.1, rectangle(2.0 * x, x, z)),
                                     arcDomainDisc(surface, 0.1, 2.0 * x, {0, 1, 0}, 0.5),
                                     arcDomainDisc(surface, 0.1, -z, z, 0.5),
                                     arcDomainCap(surface, 0.1, sphereCap({1, 0, -1}, 0.7)),
                                     arcDomainCapsule(surface, 0.1, -z, x - z, 0.5)})
        worst.add(worstDifference(dark, {}), "dark");
    EXPECT_TRUE(worst.within(1e-8));
}

// Flat and thin lights, lights around the mirror direction, the normal and the direction opposite
// the eye, eyes at the horizon, and receivers on the light.
TEST(ReferenceArcs, everyResultIsAShareOfTheLobe)
{
    const int count = fullTests() ? 100'000 : 4'000;
    for (const CndLightType type : shapeTypes) {
        Draws draw(8);
        WorstCase worst;
        for (int i = 0; i < count; ++i) {
            const double NoV =
                std::min(draw.chance(0.3) ? std::abs(draw.hair()) : draw.unit(), 1.0);
            const SurfacePoint surface = seenFrom(std::acos(NoV));
            const glm::dvec3 v = surface.toEye, mirror(-v.x, -v.y, v.z);
            const double alpha = draw.chance(0.3) ? 0.002 : draw.logarithmic(0.002, 1);
            const glm::dvec3 ways[] = {draw.direction(), draw.besides(mirror),
                                       draw.besides({0, 0, 1}), draw.besides(-v),
                                       draw.besides({std::cos(6.0 * i), std::sin(6.0 * i), 0})};
            const glm::dvec3 way = ways[i % 5];
            const double distance = draw.logarithmic(0.1, 100);
            const double size = distance * draw.logarithmic(1e-4, 10);
            const glm::dvec3 u = draw.chance(0.3) ? draw.besides(-way) : draw.direction();
            const glm::dvec3 w = glm::normalize(glm::cross(u, draw.direction()));
            const double thin = draw.logarithmic(1e-6, 1);
            CndLight light =
                makeSphere(glm::vec3(distance * way),
                           float(type == CND_LIGHT_TUBE ? size * thin : size), glm::vec3(1));
            if (draw.chance(0.2)) { // on the light, or nearly
                const glm::dvec3 on = size * (draw.unit() * u + draw.unit() * w) +
                                      draw.hair() * size * glm::cross(u, w);
                for (int k = 0; k < 3; ++k)
                    light.position[k] = float(on[k]);
            }
            light.type = type;
            light.twoSided = VK_TRUE;
            for (int k = 0; k < 3; ++k) {
                light.axisU[k] = float(size * u[k]);
                light.axisV[k] = float(size * thin * w[k]);
                light.direction[k] = float(glm::cross(u, w)[k]);
            }
            const LobeIntegral r = arcDomainLight(surface, alpha, light, glm::dvec3(0));
            const double f = r.irradiance.z;
            worst.add(std::max({-r.integral, r.integral - 1, -f, f - 1, 0.0}), "index", i);
            EXPECT_TRUE(std::isfinite(glm::length(r.meanSlope) + glm::length(r.irradiance))) << i;
        }
        EXPECT_TRUE(worst.within(1e-9)) << type;
    }
}

} // namespace candelabra::test
