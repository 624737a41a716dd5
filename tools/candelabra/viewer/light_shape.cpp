// SPDX-License-Identifier: Apache-2.0
#include "viewer/light_shape.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <tuple>

#include "scene/fit_camera.h"

namespace candelabra::app
{
namespace
{

constexpr int circleSteps = 48;

glm::dvec3 toDouble(const float (&v)[3])
{
    return {v[0], v[1], v[2]};
}

// Two unit vectors that are perpendicular to `n` and to one another.
std::pair<glm::dvec3, glm::dvec3> axesAcross(const glm::dvec3& n)
{
    const glm::dvec3 other = std::abs(n.y) < 0.9 ? glm::dvec3(0, 1, 0) : glm::dvec3(1, 0, 0);
    const glm::dvec3 u = glm::normalize(glm::cross(other, n));
    return {u, glm::cross(n, u)};
}

// The outline of a flat emitter, which is convex, or nothing for other types. Its first corner is
// repeated at the end.
std::vector<glm::dvec3> flatOutline(const CndLight& light, const glm::dvec3& centre)
{
    const glm::dvec3 u = toDouble(light.axisU), v = toDouble(light.axisV);
    std::vector<glm::dvec3> out;
    if (light.type == CND_LIGHT_RECTANGLE) {
        out = {centre - u - v, centre + u - v, centre + u + v, centre - u + v};
    } else if (light.type == CND_LIGHT_POLYGON) {
        for (uint32_t i = 0; i < light.polygon->cornerCount; ++i)
            out.push_back(centre + double(light.polygon->corners[i][0]) * u +
                          double(light.polygon->corners[i][1]) * v);
    } else if (light.type == CND_LIGHT_DISC) {
        const auto [a, b] = axesAcross(glm::normalize(toDouble(light.direction)));
        return circle(centre, light.radius, a, b);
    } else {
        return out;
    }
    out.push_back(out.front());
    return out;
}

// The closest approach of a line to something: the distance, and its place on the line.
struct Approach {
    double miss = std::numeric_limits<double>::infinity(), along = 0;
};

Approach approachSegment(const Projection::Line& line, const glm::dvec3& a, const glm::dvec3& b)
{
    const glm::dvec3 d = b - a, w = a - line.origin;
    const double dd = glm::dot(d, d), dn = glm::dot(d, line.direction);
    const double wd = glm::dot(w, d), wn = glm::dot(w, line.direction);
    const double across = dd - dn * dn;
    const double t = across > 1e-12 * dd ? std::clamp((dn * wn - wd) / across, 0.0, 1.0) : 0;
    const glm::dvec3 point = w + t * d;
    const double along = glm::dot(point, line.direction);
    return {glm::length(point - along * line.direction), along};
}

Approach approachFlat(const Projection::Line& line, const std::vector<glm::dvec3>& outline)
{
    const glm::dvec3 normal = glm::normalize(
        glm::cross(outline[1] - outline[0], outline[outline.size() / 2] - outline[0]));
    const double facing = glm::dot(normal, line.direction);
    Approach best;
    if (std::abs(facing) > 1e-9) {
        const double along = glm::dot(normal, outline[0] - line.origin) / facing;
        const glm::dvec3 hit = line.origin + along * line.direction;
        bool inside = true;
        for (size_t i = 0; i + 1 < outline.size(); ++i)
            inside &=
                glm::dot(glm::cross(outline[i + 1] - outline[i], hit - outline[i]), normal) >= 0;
        if (inside)
            return {0, along};
    }
    for (size_t i = 0; i + 1 < outline.size(); ++i) {
        const Approach edge = approachSegment(line, outline[i], outline[i + 1]);
        if (edge.miss < best.miss)
            best = edge;
    }
    return best;
}

Approach approachLight(const Projection::Line& line, const CndLight& light,
                       const glm::dvec3& centre)
{
    if (const auto outline = flatOutline(light, centre); !outline.empty())
        return approachFlat(line, outline);
    const bool tube = light.type == CND_LIGHT_TUBE;
    const glm::dvec3 half = tube ? toDouble(light.axisU) : glm::dvec3(0);
    Approach out = approachSegment(line, centre - half, centre + half);
    const double radius = cndIsPunctual(light.type) ? 0 : double(light.radius);
    out.miss = std::max(out.miss - radius, 0.0);
    out.along -= radius;
    return out;
}

} // namespace

Projection::Projection(const Camera& camera, PixelSize size)
    : camera_(cameraOfPicture(camera, double(size.width) / size.height)),
      size_(size.width, size.height)
{
    forward_ = glm::normalize(camera.forward);
    right_ = glm::normalize(glm::cross(forward_, camera.up));
    up_ = glm::cross(right_, forward_);
    const double half = camera_.orthographic ? 0.5 * camera_.orthographicHeight
                                             : std::tan(0.5 * camera_.verticalFov);
    slope_ = {half * size_.x / size_.y, half};
}

Projection::Line Projection::lineAt(glm::dvec2 place) const
{
    const glm::dvec2 ndc = 2.0 * place / size_ - 1.0;
    const glm::dvec3 across = ndc.x * slope_.x * right_ - ndc.y * slope_.y * up_;
    if (camera_.orthographic)
        return {camera_.position + across, forward_};
    return {camera_.position, glm::normalize(forward_ + across)};
}

double Projection::metresPerPixel(double distance) const
{
    return 2 * slope_.y / size_.y * (camera_.orthographic ? 1 : distance);
}

double Projection::depthOf(const glm::dvec3& point) const
{
    return glm::dot(point - camera_.position, forward_);
}

glm::dvec2 Projection::place(const glm::dvec3& point) const
{
    const glm::dvec3 p = point - camera_.position;
    const glm::dvec2 at = glm::dvec2(glm::dot(p, right_), -glm::dot(p, up_)) / slope_ /
                          (camera_.orthographic ? 1.0 : depthOf(point));
    return 0.5 * (at + 1.0) * size_;
}

std::vector<glm::dvec2> Projection::segments(const std::vector<glm::dvec3>& polyline) const
{
    std::vector<glm::dvec2> out;
    const double nearPlane = camera_.nearPlane;
    for (size_t i = 0; i + 1 < polyline.size(); ++i) {
        glm::dvec3 a = polyline[i], b = polyline[i + 1];
        const double da = depthOf(a), db = depthOf(b);
        if (da < nearPlane && db < nearPlane)
            continue;
        const glm::dvec3 cut = a + (b - a) * ((nearPlane - da) / (db - da));
        if (da < nearPlane)
            a = cut;
        else if (db < nearPlane)
            b = cut;
        out.push_back(place(a));
        out.push_back(place(b));
    }
    return out;
}

std::vector<glm::dvec3> circle(const glm::dvec3& centre, double radius, const glm::dvec3& u,
                               const glm::dvec3& v)
{
    std::vector<glm::dvec3> out;
    for (int i = 0; i <= circleSteps; ++i) {
        const double angle = 2 * std::numbers::pi * (i % circleSteps) / circleSteps;
        out.push_back(centre + radius * (std::cos(angle) * u + std::sin(angle) * v));
    }
    return out;
}

std::vector<std::vector<glm::dvec3>> outlineOf(const CndLight& light, const glm::dvec3& origin,
                                               const Projection& view)
{
    if (cndIsDistant(light.type))
        return {};
    const glm::dvec3 centre = origin + toDouble(light.position);
    if (const auto flat = flatOutline(light, centre); !flat.empty())
        return {flat};
    if (light.type == CND_LIGHT_TUBE) {
        const glm::dvec3 half = toDouble(light.axisU);
        const double r = light.radius;
        std::vector<std::vector<glm::dvec3>> out{circle(centre - half, r, view.right(), view.up()),
                                                 circle(centre + half, r, view.right(), view.up())};
        const glm::dvec3 across = glm::cross(half, glm::cross(view.right(), view.up()));
        if (const double length = glm::length(across); length > 1e-6 * glm::length(half))
            for (const double side : {r / length, -r / length})
                out.push_back({centre - half + side * across, centre + half + side * across});
        return out;
    }
    if (!cndIsPunctual(light.type))
        return {circle(centre, light.radius, view.right(), view.up())};
    // A light without a size: a ring that is always as large in the picture.
    const double ring = 7 * view.metresPerPixel(std::max(view.depthOf(centre), 0.0));
    std::vector<std::vector<glm::dvec3>> out{circle(centre, ring, view.right(), view.up())};
    if (light.type == CND_LIGHT_SPOT) {
        const glm::dvec3 down = glm::normalize(toDouble(light.direction));
        const auto [u, v] = axesAcross(down);
        const double length = std::isfinite(light.influenceRadius)
                                  ? std::min(0.25 * double(light.influenceRadius), 2.0)
                                  : 2.0;
        const double angle = light.outerConeAngle;
        const glm::dvec3 end = centre + length * std::cos(angle) * down;
        const double r = length * std::sin(angle);
        out.push_back(circle(end, r, u, v));
        for (const glm::dvec3& side : {u, v, -u, -v})
            out.push_back({centre, end + r * side});
    }
    return out;
}

std::optional<uint32_t> lightAt(const std::vector<CndLight>& lights, const glm::dvec3& origin,
                                const Projection& view, glm::dvec2 place, double slack,
                                double farthest)
{
    const Projection::Line line = view.lineAt(place);
    std::tuple<double, double, uint32_t> best{std::numeric_limits<double>::infinity(), 0, 0};
    for (uint32_t i = 0; i < lights.size(); ++i) {
        const CndLight& light = lights[i];
        if (cndIsDistant(light.type))
            continue;
        // Most lights are far from the line: this needs no shape.
        const glm::dvec3 centre = origin + toDouble(light.position);
        const double bound = double(cndEmitterBoundingRadius(&light));
        const glm::dvec3 to = centre - line.origin;
        const double along = glm::dot(to, line.direction);
        const double reach = bound + slack * view.metresPerPixel(std::max(along, 0.0) + bound);
        if (along + bound <= 0 || glm::dot(to, to) - along * along > reach * reach ||
            along - bound > farthest)
            continue;
        const Approach near = approachLight(line, light, centre);
        const double pixels = near.miss / view.metresPerPixel(std::max(near.along, 1e-6));
        if (near.along + 2 * bound > 0 && pixels <= slack)
            best = std::min(best, {pixels, near.along, i});
    }
    if (std::isinf(std::get<0>(best)))
        return {};
    return std::get<2>(best);
}

} // namespace candelabra::app
