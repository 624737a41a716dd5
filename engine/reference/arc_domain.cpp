// SPDX-License-Identifier: Apache-2.0
#include "reference/arc_domain.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <stdexcept>
#include <string>
#include <vector>

#include "reference/quadrature.h"
#include "reference/truth.h"
#include "reference/vectors.h"

namespace candelabra::reference
{

namespace
{

using std::numbers::pi;

// Part of an outline: the directions of centre + cos(t) cosine + sin(t) sine for t from low to
// high. Circles on the sphere of directions, great and small, have this form with vectors of length
// 1, and so has the rim of a disc, with vectors of any length.
struct Curve {
    glm::dvec3 centre, cosine, sine;
    double low, high;

    glm::dvec3 point(double t) const { return centre + std::cos(t) * cosine + std::sin(t) * sine; }
    glm::dvec3 direction(double t) const { return glm::normalize(point(t)); }
};

// Returns the great circle from a direction by an angle around another one; both are unit vectors,
// perpendicular to each other.
Curve greatCircle(const glm::dvec3& from, const glm::dvec3& around, double angle)
{
    const glm::dvec3 side = glm::cross(around, from);
    const double half = angle / 2, cosine = std::cos(half), sine = std::sin(half);
    return {glm::dvec3(0), cosine * from + sine * side, cosine * side - sine * from, -half, half};
}

// Returns the circle of directions at an angle to `axis` whose cosine and sine are given, from
// -half to half around the point that lies towards `middle` (unit, perpendicular to the axis).
Curve smallCircle(const SphereCap& cap, const glm::dvec3& middle, double half)
{
    return {cap.cosine() * cap.axis, cap.sine() * middle, cap.sine() * glm::cross(cap.axis, middle),
            -half, half};
}

// The outline's parts above the horizon, in order, and the arcs of the horizon that close it.
std::vector<Curve> clip(const std::vector<Curve>& outline, const glm::dvec3& normal)
{
    struct Part {
        Curve curve;
        bool above;
    };
    std::vector<Part> parts;
    for (const Curve& curve : outline) {
        const double base = glm::dot(normal, curve.centre);
        const double x = glm::dot(normal, curve.cosine), y = glm::dot(normal, curve.sine);
        std::vector<double> ends = {curve.low};
        const double amplitude = std::hypot(x, y);
        if (std::abs(base) < amplitude) {
            const double towards = std::atan2(y, x);
            const double width =
                std::atan2(std::sqrt((amplitude - base) * (amplitude + base)), -base);
            for (const double root : {towards - width, towards + width}) {
                const double turns = std::ceil((curve.low - root) / (2 * pi));
                const double t = root + turns * 2 * pi; // the first one from `low` on
                if (t > curve.low && t < curve.high)
                    ends.push_back(t);
            }
        }
        ends.push_back(curve.high);
        std::sort(ends.begin(), ends.end());
        for (size_t i = 0; i + 1 < ends.size(); ++i) {
            Part part{curve, glm::dot(normal, curve.point((ends[i] + ends[i + 1]) / 2)) > 0};
            part.curve.low = ends[i];
            part.curve.high = ends[i + 1];
            if (part.curve.low < part.curve.high)
                parts.push_back(part);
        }
    }
    std::vector<Curve> out;
    for (size_t i = 0; i < parts.size(); ++i) {
        if (!parts[i].above)
            continue;
        out.push_back(parts[i].curve);
        size_t next = (i + 1) % parts.size();
        if (parts[next].above)
            continue;
        while (!parts[next].above)
            next = (next + 1) % parts.size();
        const auto onHorizon = [&](const glm::dvec3& direction) {
            return glm::normalize(direction - glm::dot(normal, direction) * normal);
        };
        const glm::dvec3 from = onHorizon(parts[i].curve.direction(parts[i].curve.high));
        const glm::dvec3 to = onHorizon(parts[next].curve.direction(parts[next].curve.low));
        double angle = std::atan2(glm::dot(normal, glm::cross(from, to)), glm::dot(from, to));
        if (angle < -pi / 2) // nearly half a turn
            angle += 2 * pi;
        out.push_back(greatCircle(from, normal, std::max(angle, 0.0)));
    }
    return out;
}

// The shaded point, in coordinates with the normal as z and the eye in the xz plane.
struct Lobe {
    Frame frame;
    glm::dvec3 v;
    double alpha;

    Lobe(const SurfacePoint& given, double width) : alpha(width)
    {
        const SurfacePoint surface = liftEye(given);
        frame = frameAround(surface.normal, surface.toEye);
        v = glm::dvec3(glm::dot(surface.toEye, frame.x), 0, glm::dot(surface.toEye, frame.z));
    }

    glm::dvec3 local(const glm::dvec3& a) const
    {
        return {glm::dot(a, frame.x), glm::dot(a, frame.y), glm::dot(a, frame.z)};
    }
    glm::dvec3 stretched(const glm::dvec3& a) const { return {a.x, a.y, alpha * a.z}; }
};

// Returns where an integral over a curve is divided: at its ends, and next to the mirror direction,
// where a narrow lobe has its peak.
std::vector<double> breaksOf(const Curve& c, const Lobe& lobe)
{
    const glm::dvec3 mirror(-lobe.v.x, 0, lobe.v.z);
    const double nearest = std::atan2(glm::dot(mirror, c.sine), glm::dot(mirror, c.cosine));
    std::vector<double> breaks = {c.low, c.high};
    for (const double t : {nearest, nearest + 2 * pi, nearest - 2 * pi})
        if (t > c.low && t < c.high)
            breaks.push_back(t);
    std::sort(breaks.begin(), breaks.end());
    return breaks;
}

// Returns the integrals over the region with this outline (in world coordinates, counterclockwise
// as seen from the receiver).
//
// The terms of a small light are as long as the light and sum to its area. So they are integrated
// as differences from the direction `centre` inside the light: with w = wc + d,
//     (w x dw) / |w|^2 = (d x dw) / |w|^2 + (wc x dw) (1 / |w|^2 - 1 / D2) + (wc x dw) / D2,
// whose last term has the closed integral 0 for every constant D2. |w|^2 = |wc|^2 + 2 wc . d +
// |d|^2.
LobeIntegral integrateRegion(const SurfacePoint& surface, double alpha,
                             const std::vector<Curve>& outline, const glm::dvec3& centre)
{
    const Lobe lobe(surface, alpha);
    const glm::dvec3 lc = lobe.local(centre), wc = lobe.stretched(lobe.v + lc);
    std::vector<Curve> curves = clip(outline, surface.normal);
    double reach2 = 0;
    for (Curve& c : curves) {
        c = {lobe.local(c.centre), lobe.local(c.cosine), lobe.local(c.sine), c.low, c.high};
        const glm::dvec3 d = lobe.stretched(c.direction(c.low) - lc);
        reach2 = std::max(reach2, glm::dot(d, d));
    }
    const double D2 = glm::dot(wc, wc) + reach2;
    glm::dvec3 phi(0), irradiance(0);
    LobeIntegral out;
    for (const Curve& c : curves) {
        // p(t) = size lc + offset(t), where rounding errors of the offset are as small as the
        // light.
        const double size = glm::length(c.point(0));
        const glm::dvec3 start = c.point(0) - size * lc;
        const auto integrand = [&](double t) {
            const double sine = std::sin(t), sineOfHalf = std::sin(t / 2);
            const glm::dvec3 offset =
                start + sine * c.sine - 2 * sineOfHalf * sineOfHalf * c.cosine;
            const glm::dvec3 p = size * lc + offset;
            const double length = glm::length(p);
            const double longer =
                glm::dot(offset, p + size * lc) / (length + size);         // length - size
            const glm::dvec3 fromCentre = (offset - longer * lc) / length; // l - lc
            const glm::dvec3 l = p / length;
            const glm::dvec3 dp = std::cos(t) * c.sine - sine * c.cosine;
            const glm::dvec3 dl = (dp - glm::dot(dp, l) * l) / length;
            const glm::dvec3 d = lobe.stretched(fromCentre), dw = lobe.stretched(dl);
            const glm::dvec3 w = wc + d;
            const double change = glm::dot(d, w + wc); // |w|^2 - |wc|^2
            const glm::dvec3 a =
                (glm::cross(d, dw) + glm::cross(wc, dw) * ((reach2 - change) / D2)) /
                glm::dot(w, w);
            const glm::dvec3 b = glm::cross(fromCentre, dl);
            return std::array<double, 6>{a.x, a.y, a.z, b.x, b.y, b.z};
        };
        const auto part = integrate<6, 200>(breaksOf(c, lobe), 1e-12, negligible, integrand);
        phi += glm::dvec3(part.value[0], part.value[1], part.value[2]);
        irradiance += glm::dvec3(part.value[3], part.value[4], part.value[5]);
        out.converged = out.converged && part.converged;
    }
    phi /= 2 * pi;
    irradiance /= 2 * pi;
    out.integral = phi.z;
    if (phi.z > 0)
        out.meanSlope = alpha / phi.z * (phi.x * lobe.frame.x + phi.y * lobe.frame.y);
    out.irradiance =
        irradiance.x * lobe.frame.x + irradiance.y * lobe.frame.y + irradiance.z * lobe.frame.z;
    return out;
}

} // namespace

LobeIntegral arcDomainPolygon(const SurfacePoint& surface, double alpha,
                              std::span<const glm::dvec3> corners)
{
    glm::dvec3 centre(0), area(0); // area: twice the vector area
    for (const glm::dvec3& corner : corners)
        centre += corner / double(corners.size());
    for (size_t i = 0; i < corners.size(); ++i)
        area += glm::cross(corners[i] - centre, corners[(i + 1) % corners.size()] - centre);
    const double side = glm::dot(area, centre);
    if (side == 0)
        return {};
    std::vector<glm::dvec3> ordered(corners.begin(), corners.end());
    if (side < 0)
        std::reverse(ordered.begin(), ordered.end());
    std::vector<Curve> outline;
    for (size_t i = 0; i < ordered.size(); ++i) {
        const glm::dvec3& from = ordered[i];
        const glm::dvec3 step = ordered[(i + 1) % ordered.size()] - from;
        const glm::dvec3 across = glm::cross(from, step);
        const double size = glm::length(across);
        if (size > 0) // otherwise all of the edge lies in one direction
            outline.push_back(greatCircle(glm::normalize(from), across / size,
                                          std::atan2(size, glm::dot(from, from + step))));
    }
    return integrateRegion(surface, alpha, outline, glm::normalize(centre));
}

LobeIntegral arcDomainDisc(const SurfacePoint& surface, double alpha, const glm::dvec3& center,
                           const glm::dvec3& normal, double radius)
{
    const double height = glm::dot(center, normal);
    if (height == 0)
        return {};
    // The plane's normal that points away from the receiver has the rim on its left.
    const Frame frame = frameAround(height > 0 ? normal : -normal, center);
    const Curve rim{center, radius * frame.x, radius * frame.y, -pi, pi};
    return integrateRegion(surface, alpha, {rim}, glm::normalize(center));
}

LobeIntegral arcDomainCap(const SurfacePoint& surface, double alpha, const SphereCap& cap)
{
    const Frame frame = frameAround(cap.axis, surface.normal);
    return integrateRegion(surface, alpha, {smallCircle(cap, frame.x, pi)}, cap.axis);
}

LobeIntegral arcDomainCapsule(const SurfacePoint& surface, double alpha, const glm::dvec3& end0,
                              const glm::dvec3& end1, double radius)
{
    const double length = glm::length(end1 - end0);
    const glm::dvec3& near = glm::length(end0) <= glm::length(end1) ? end0 : end1;
    const glm::dvec3 axis = length > 0 ? (end1 - end0) / length : glm::dvec3(0);
    const glm::dvec3 across = near - glm::dot(near, axis) * axis;
    const double distance = glm::length(across);
    // Seen along its axis, the nearer sphere hides the rest.
    if (!(length > 0 && distance > radius))
        return arcDomainCap(surface, alpha, sphereCap(near, radius));
    const glm::dvec3 outward = across / distance, side = glm::cross(axis, outward);
    const double sine = radius / distance, cosine = std::sqrt((1 - sine) * (1 + sine));
    std::vector<Curve> outline;
    // The outline has four arcs. A plane through the receiver touches the capsule on either side;
    // its normal sine * outward + sign * cosine * side points towards the capsule. Each turn of the
    // loop adds the arc along one of these planes, from one end to the other, and then the rim of
    // the sphere at that end, up to the other plane.
    for (const double sign : {1.0, -1.0}) {
        const glm::dvec3 inward = sine * outward + sign * cosine * side;
        const glm::dvec3& from = sign > 0 ? end1 : end0;
        const glm::dvec3& to = sign > 0 ? end0 : end1;
        const glm::dvec3 first = from - radius * inward, last = to - radius * inward;
        outline.push_back(greatCircle(
            glm::normalize(first), inward,
            std::atan2(glm::dot(inward, glm::cross(first, last)), glm::dot(first, last))));
        // The rim is symmetric to the plane of the axis and the receiver.
        const SphereCap cap = sphereCap(to, radius);
        const glm::dvec3 middle =
            glm::normalize(-sign * (axis - glm::dot(axis, cap.axis) * cap.axis));
        const glm::dvec3 start = -inward;
        const double half = std::atan2(std::abs(glm::dot(start, side)), glm::dot(start, middle));
        outline.push_back(smallCircle(cap, middle, half));
    }
    return integrateRegion(surface, alpha, outline,
                           glm::normalize(glm::normalize(end0) + glm::normalize(end1)));
}

LobeIntegral arcDomainLight(const SurfacePoint& surface, double alpha, const CndLight& light,
                            const glm::dvec3& lightOrigin)
{
    const glm::dvec3 center = lightOrigin + vec3(light.position) - surface.position;
    const glm::dvec3 u = vec3(light.axisU), v = vec3(light.axisV);
    switch (light.type) {
    case CND_LIGHT_SPHERE:
        return arcDomainCap(surface, alpha, sphereCap(center, light.radius));
    case CND_LIGHT_DISTANT_SPHERE:
        return arcDomainCap(surface, alpha,
                            sphereCap(-glm::normalize(vec3(light.direction)), light.radius));
    case CND_LIGHT_TUBE: {
        const double along = std::clamp(-glm::dot(center, u) / glm::dot(u, u), -1.0, 1.0);
        const glm::dvec3 nearest = center + along * u;
        if (!(glm::length(nearest) > light.radius * (1 + 1e-12)))
            return arcDomainCap(surface, alpha, sphereCap(nearest, light.radius));
        return arcDomainCapsule(surface, alpha, center - u, center + u, light.radius);
    }
    case CND_LIGHT_RECTANGLE: {
        if (!light.twoSided && !(glm::dot(glm::cross(u, v), center) < 0))
            return {};
        const std::array<glm::dvec3, 4> corners = {center - u - v, center + u - v, center + u + v,
                                                   center - u + v};
        return arcDomainPolygon(surface, alpha, corners);
    }
    case CND_LIGHT_POLYGON:
        if (!light.twoSided && !(glm::dot(glm::cross(u, v), center) < 0))
            return {};
        return arcDomainPolygon(surface, alpha, polygonCorners(light, center));
    case CND_LIGHT_DISC: {
        const glm::dvec3 normal = glm::normalize(vec3(light.direction));
        if (!light.twoSided && !(glm::dot(normal, center) < 0))
            return {};
        return arcDomainDisc(surface, alpha, center, normal, light.radius);
    }
    default:
        throw std::invalid_argument("light type " + std::to_string(light.type) +
                                    " is no area light");
    }
}

} // namespace candelabra::reference
