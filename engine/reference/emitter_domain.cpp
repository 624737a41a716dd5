// SPDX-License-Identifier: Apache-2.0
#include "reference/emitter_domain.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <stdexcept>
#include <string>
#include <vector>

#include "reference/brdf.h"
#include "reference/quadrature.h"
#include "reference/vectors.h"

namespace candelabra::reference
{

namespace
{

using std::numbers::pi;
constexpr double infinity = std::numeric_limits<double>::infinity();

struct Range {
    double low, high;
};

// Returns the part of a range in which base + slope x > 0.
Range positivePart(Range range, double base, double slope)
{
    if (slope > 0)
        range.low = std::max(range.low, -base / slope);
    else if (slope < 0)
        range.high = std::min(range.high, -base / slope);
    else if (!(base > 0))
        range.high = range.low;
    return range;
}

// Appends the angles in [-pi, pi] with base + x cos t + y sin t = 0: none or two.
void addCircleRoots(double base, double x, double y, std::vector<double>& out)
{
    const double amplitude = std::hypot(x, y);
    if (!(std::abs(base) < amplitude))
        return;
    const double centre = std::atan2(y, x), width = std::acos(-base / amplitude);
    out.push_back(std::remainder(centre - width, 2 * pi));
    out.push_back(std::remainder(centre + width, 2 * pi));
}

// The surface point that receives the light, moved to the origin.
struct Receiver {
    SurfacePoint surface;
    double alpha;
    glm::dvec3 mirror;

    // Returns the integrand times the solid angle of a surface element of size `area` at p, where
    // `facing` is the cosine between the element's normal and the direction to the receiver.
    std::array<double, 3> element(const glm::dvec3& p, double facing, double area) const
    {
        const double distance2 = glm::dot(p, p);
        const glm::dvec3 l = p / std::sqrt(distance2);
        const double NoL = glm::dot(surface.normal, l);
        if (!(NoL > 0))
            return {};
        const double weight = NoL * area * std::max(facing, 0.0) / distance2;
        const SpecularBrdf brdf = ggxBrdf(surface.normal, surface.toEye, l, alpha);
        const double a = brdf.value * weight;
        return {a, a * brdf.schlickWeight, weight / pi};
    }

    // Returns x at which the line start + x step passes closest to the mirror ray.
    double nearMirror(const glm::dvec3& start, const glm::dvec3& step) const
    {
        const glm::dvec3 a = start - glm::dot(start, mirror) * mirror;
        const glm::dvec3 b = step - glm::dot(step, mirror) * mirror;
        return -glm::dot(a, b) / glm::dot(b, b);
    }
};

using Values = std::array<double, 6>;

void accumulate(Values& sum, const Integral<3>& part)
{
    for (size_t i = 0; i < 3; ++i) {
        sum[i] += part.value[i];
        sum[i + 3] += part.error[i];
    }
}

void accumulate(LightResponse& out, const Integral<6>& part)
{
    out.a += part.value[0];
    out.b += part.value[1];
    out.f += part.value[2];
    out.aError += part.error[0] + part.value[3];
    out.bError += part.error[1] + part.value[4];
    out.fError += part.error[2] + part.value[5];
    out.converged = out.converged && part.converged;
}

// Integrates f along one row, which is broken at `interesting` if that lies inside the range.
template <class F>
Integral<3> alongRow(const Range& range, double interesting, double relative, F&& f)
{
    std::array<double, 3> ends = {range.low, interesting, range.high};
    const bool broken = interesting > range.low && interesting < range.high;
    if (!broken)
        ends[1] = range.high;
    return integrate<3, 60>(std::span<const double>(ends.data(), broken ? 3 : 2), relative / 8, 0,
                            f);
}

// Returns the breaks inside the range, with its ends, sorted.
std::vector<double> panelsOf(const Range& range, std::vector<double> breaks)
{
    std::erase_if(breaks, [&](double x) { return !(x > range.low && x < range.high); });
    breaks.push_back(range.low);
    breaks.push_back(range.high);
    std::sort(breaks.begin(), breaks.end());
    return breaks;
}

// Integrates over points center + x u + y v with |x|, |y| <= 1 (rectangle) or x^2 + y^2 <= 1
// (disc).
LightResponse planarResponse(const Receiver& receiver, const glm::dvec3& center,
                             const glm::dvec3& u, const glm::dvec3& v, bool disc, double relative)
{
    const glm::dvec3& n = receiver.surface.normal;
    const glm::dvec3 areaNormal = glm::cross(u, v);
    const double area = glm::length(areaNormal);
    const glm::dvec3 normal = areaNormal / area;
    const double base = glm::dot(n, center), nu = glm::dot(n, u), nv = glm::dot(n, v);
    std::vector<double> breaks;
    if (disc) {
        std::vector<double> angles;
        addCircleRoots(base, nu, nv, angles);
        for (const double angle : angles)
            breaks.push_back(std::sin(angle));
        // The row that lies in the horizon.
        breaks.push_back(-base / nv);
    } else {
        breaks = {-(base + nu) / nv, -(base - nu) / nv};
    }
    // The row that the mirror ray hits: center + x u + y v is parallel to the mirror direction.
    const double approach = glm::dot(normal, receiver.mirror);
    if (approach != 0) {
        const glm::dvec3 hit = receiver.mirror * (glm::dot(normal, center) / approach) - center;
        breaks.push_back(glm::dot(glm::cross(u, hit), normal) / area);
    }
    const std::vector<double> panels = panelsOf({-1, 1}, breaks);
    const auto sum = integratePanels<3>(
        std::span<const double>(panels), relative, [](double) { return true; },
        [&](double y) {
            Values out{};
            const double reach = disc ? std::sqrt(std::max(0.0, 1 - y * y)) : 1;
            const glm::dvec3 start = center + y * v;
            const Range range = positivePart({-reach, reach}, base + y * nv, nu);
            if (!(range.low < range.high))
                return out;
            accumulate(out, alongRow(range, receiver.nearMirror(start, u), relative, [&](double x) {
                           const glm::dvec3 p = start + x * u;
                           const double facing = std::abs(glm::dot(normal, p)) / glm::length(p);
                           return receiver.element(p, facing, area);
                       }));
            return out;
        });
    LightResponse out;
    accumulate(out, sum);
    return out;
}

// Integrates over the triangle start + x u + x y v with x and y from 0 to 1. Rows are lines through
// `start`, along which x is twice the share of the area.
void addTriangle(const Receiver& receiver, const glm::dvec3& start, const glm::dvec3& u,
                 const glm::dvec3& v, double relative, LightResponse& out)
{
    const glm::dvec3& n = receiver.surface.normal;
    const glm::dvec3 areaNormal = glm::cross(u, v);
    const double area = glm::length(areaNormal); // of the parallelogram
    const glm::dvec3 normal = areaNormal / area;
    const double base = glm::dot(n, start), nu = glm::dot(n, u), nv = glm::dot(n, v);
    // The rows that leave the horizon at their ends, the row that lies along it, and the row that
    // the mirror ray hits.
    std::vector<double> breaks = {-(base + nu) / nv, -nu / nv};
    const double approach = glm::dot(normal, receiver.mirror);
    if (approach != 0) {
        const glm::dvec3 hit = receiver.mirror * (glm::dot(normal, start) / approach) - start;
        breaks.push_back(glm::dot(glm::cross(u, hit), normal) /
                         glm::dot(glm::cross(hit, v), normal));
    }
    const std::vector<double> panels = panelsOf({0, 1}, breaks);
    const auto sum = integratePanels<3>(
        std::span<const double>(panels), relative, [](double) { return true; },
        [&](double y) {
            Values values{};
            const glm::dvec3 row = u + y * v;
            const Range range = positivePart({0, 1}, base, glm::dot(n, row));
            if (!(range.low < range.high))
                return values;
            accumulate(values,
                       alongRow(range, receiver.nearMirror(start, row), relative, [&](double x) {
                           const glm::dvec3 p = start + x * row;
                           const double facing = std::abs(glm::dot(normal, p)) / glm::length(p);
                           return receiver.element(p, facing, x * area);
                       }));
            return values;
        });
    accumulate(out, sum);
}

struct Tube {
    glm::dvec3 center, axis; // unit
    double half, radius;     // half the length of the segment; radius
};

void addCylinder(const Receiver& receiver, const Tube& tube, double relative, LightResponse& out)
{
    const glm::dvec3 across = tube.center - glm::dot(tube.center, tube.axis) * tube.axis;
    const double distance = glm::length(across);
    if (!(distance > tube.radius) || tube.half == 0)
        return;
    const glm::dvec3& n = receiver.surface.normal;
    const glm::dvec3 e1 = -across / distance, e2 = glm::cross(tube.axis, e1);
    const double rim = std::acos(tube.radius / distance);
    std::vector<double> breaks = {0};
    for (const double end : {-tube.half, tube.half})
        addCircleRoots(glm::dot(n, tube.center + end * tube.axis), tube.radius * glm::dot(n, e1),
                       tube.radius * glm::dot(n, e2), breaks);
    // The angle at which the mirror ray, projected along the axis, meets the circle or passes it
    // closest.
    const double d1 = glm::dot(receiver.mirror, e1), d2 = glm::dot(receiver.mirror, e2);
    if (const double d = d1 * d1 + d2 * d2; d > 0) {
        const double inside =
            d1 * d1 * distance * distance - d * (distance * distance - tube.radius * tube.radius);
        const double t = (-distance * d1 - std::sqrt(std::max(0.0, inside))) / d;
        breaks.push_back(std::atan2(t * d2, distance + t * d1));
    }
    const std::vector<double> panels = panelsOf({-rim, rim}, breaks);
    const auto sum = integratePanels<3>(
        std::span<const double>(panels), relative, [](double) { return true; },
        [&](double psi) {
            Values values{};
            const glm::dvec3 normal = std::cos(psi) * e1 + std::sin(psi) * e2;
            const glm::dvec3 start = tube.center + tube.radius * normal;
            const Range range =
                positivePart({-tube.half, tube.half}, glm::dot(n, start), glm::dot(n, tube.axis));
            if (!(range.low < range.high))
                return values;
            accumulate(
                values,
                alongRow(range, receiver.nearMirror(start, tube.axis), relative, [&](double z) {
                    const glm::dvec3 p = start + z * tube.axis;
                    return receiver.element(p, -glm::dot(normal, p) / glm::length(p), tube.radius);
                }));
            return values;
        });
    accumulate(out, sum);
}

// Integrates over the half of a sphere around `center` whose normals point along `outward`, in
// polar coordinates of the normal around the direction to the receiver. It needs no breaks: halving
// panels finds the corners.
void addHemisphere(const Receiver& receiver, const glm::dvec3& center, const glm::dvec3& outward,
                   double radius, double relative, LightResponse& out)
{
    const double distance = glm::length(center);
    if (!(distance > radius))
        return;
    const glm::dvec3& n = receiver.surface.normal;
    const Frame pole = frameAround(-center / distance, n);
    const double rim = std::acos(radius / distance);
    const auto along = [&](double phi) {
        Values values{};
        const glm::dvec3 spoke = std::cos(phi) * pole.x + std::sin(phi) * pole.y;
        // outward . normal > 0 holds within pi / 2 of `middle`, which is in [-pi, pi].
        const double middle = std::atan2(glm::dot(outward, spoke), glm::dot(outward, pole.z));
        const Range range{std::max(0.0, middle - pi / 2), std::min(rim, middle + pi / 2)};
        // n . (center + radius normal) > 0 holds within `width` of `up`.
        const double x = glm::dot(n, pole.z), y = glm::dot(n, spoke);
        const double least = -glm::dot(n, center) / radius;
        const double up = std::atan2(y, x);
        const double width = std::acos(std::clamp(least / std::hypot(x, y), -1.0, 1.0));
        for (const double turn : {-2 * pi, 0.0, 2 * pi}) {
            const Range part{std::max(range.low, up + turn - width),
                             std::min(range.high, up + turn + width)};
            if (!(part.low < part.high))
                continue;
            accumulate(values, alongRow(part, infinity, relative, [&](double theta) {
                           const glm::dvec3 normal =
                               std::cos(theta) * pole.z + std::sin(theta) * spoke;
                           const glm::dvec3 p = center + radius * normal;
                           return receiver.element(p, -glm::dot(normal, p) / glm::length(p),
                                                   radius * radius * std::sin(theta));
                       }));
        }
        return values;
    };
    std::vector<double> breaks;
    for (int i = -4; i <= 4; ++i)
        breaks.push_back(i * pi / 4);
    accumulate(out, integrate<3, 200>(std::span<const double>(breaks), relative, 0, along));
}

LightResponse surfaceOfSphere(const Receiver& receiver, const glm::dvec3& center, double radius,
                              double relative)
{
    const glm::dvec3& n = receiver.surface.normal; // any direction does
    LightResponse out;
    addHemisphere(receiver, center, n, radius, relative, out);
    addHemisphere(receiver, center, -n, radius, relative, out);
    return out;
}

} // namespace

LightResponse emitterDomainResponse(const SurfacePoint& surface, double alpha,
                                    const CndLight& light, const glm::dvec3& lightOrigin,
                                    double relative)
{
    const SurfacePoint lifted = liftEye(surface);
    const glm::dvec3& n = lifted.normal;
    const Receiver receiver{lifted, alpha,
                            glm::normalize(2 * glm::dot(n, lifted.toEye) * n - lifted.toEye)};
    const glm::dvec3 center = lightOrigin + vec3(light.position) - surface.position;
    switch (light.type) {
    case CND_LIGHT_SPHERE:
        return surfaceOfSphere(receiver, center, light.radius, relative);
    case CND_LIGHT_RECTANGLE: {
        const glm::dvec3 u = vec3(light.axisU), v = vec3(light.axisV);
        if (!light.twoSided && !(glm::dot(glm::cross(u, v), center) < 0))
            return {};
        return planarResponse(receiver, center, u, v, false, relative);
    }
    case CND_LIGHT_POLYGON: {
        if (!light.twoSided &&
            !(glm::dot(glm::cross(vec3(light.axisU), vec3(light.axisV)), center) < 0))
            return {};
        const std::vector<glm::dvec3> corners = polygonCorners(light, center);
        LightResponse out;
        for (size_t i = 2; i < corners.size(); ++i)
            addTriangle(receiver, corners[0], corners[i - 1] - corners[0],
                        corners[i] - corners[i - 1], relative, out);
        return out;
    }
    case CND_LIGHT_DISC: {
        const glm::dvec3 normal = glm::normalize(vec3(light.direction));
        if (!light.twoSided && !(glm::dot(normal, center) < 0))
            return {};
        const Frame frame = frameAround(normal, n);
        const double radius = light.radius;
        return planarResponse(receiver, center, radius * frame.x, radius * frame.y, true, relative);
    }
    case CND_LIGHT_TUBE: {
        const glm::dvec3 half = vec3(light.axisU);
        const Tube tube{center, glm::normalize(half), glm::length(half), light.radius};
        LightResponse out;
        addCylinder(receiver, tube, relative, out);
        addHemisphere(receiver, center + half, tube.axis, tube.radius, relative, out);
        addHemisphere(receiver, center - half, -tube.axis, tube.radius, relative, out);
        return out;
    }
    default:
        throw std::invalid_argument("light type " + std::to_string(light.type) +
                                    " has no surface to integrate over");
    }
}

} // namespace candelabra::reference
