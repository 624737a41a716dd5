// SPDX-License-Identifier: Apache-2.0
#include "reference/visible_lights.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <vector>

#include "reference/vectors.h"

namespace candelabra::reference
{

namespace
{

// Distances along a unit direction between which a ray is inside an emitter; from > to: never.
struct Inside {
    double from = std::numeric_limits<double>::infinity();
    double to = -std::numeric_limits<double>::infinity();

    void add(double t)
    {
        from = std::min(from, t);
        to = std::max(to, t);
    }
};

// Decides by the distance of the centre from the ray, as intersectBall of render.cpp does.
void addSphere(Inside& inside, const glm::dvec3& direction, const glm::dvec3& toCenter,
               double radius)
{
    const double nearest = glm::dot(toCenter, direction);
    const glm::dvec3 miss = toCenter - nearest * direction;
    const double depth2 = radius * radius - glm::dot(miss, miss);
    if (depth2 < 0)
        return;
    inside.add(nearest - std::sqrt(depth2));
    inside.add(nearest + std::sqrt(depth2));
}

// Returns where the ray is inside a capsule: the hull of the intervals of its two end balls and of
// the points where the ray passes through the side of the cylinder between them.
Inside insideTube(const glm::dvec3& direction, const glm::dvec3& toCenter, const glm::dvec3& half,
                  double radius)
{
    Inside inside;
    addSphere(inside, direction, toCenter - half, radius);
    addSphere(inside, direction, toCenter + half, radius);
    const double halfLength = glm::length(half);
    const glm::dvec3 axis = half / halfLength;
    const auto across = [&](const glm::dvec3& v) { return v - glm::dot(v, axis) * axis; };
    const glm::dvec3 flat = across(direction);
    const double speed2 = glm::dot(flat, flat);
    if (!(speed2 > 1e-24)) // the ray is parallel to the axis: it enters by one ball and leaves by
                           // the other
        return inside;
    const double nearest = glm::dot(across(toCenter), flat) / speed2;
    const glm::dvec3 miss = across(toCenter) - nearest * flat;
    const double depth2 = radius * radius - glm::dot(miss, miss);
    if (depth2 < 0)
        return inside;
    const double chord = std::sqrt(depth2 / speed2);
    for (const double t : {nearest - chord, nearest + chord})
        if (std::abs(glm::dot(t * direction - toCenter, axis)) <= halfLength)
            inside.add(t);
    return inside;
}

Inside insideFlat(const CndLight& light, const glm::dvec3& direction, const glm::dvec3& toCenter)
{
    const glm::dvec3 u = vec3(light.axisU), v = vec3(light.axisV);
    const bool rectangle = light.type == CND_LIGHT_RECTANGLE;
    const glm::dvec3 normal = rectangle ? glm::cross(u, v) : vec3(light.direction);
    const double slope = glm::dot(direction, normal);
    if (light.twoSided ? slope == 0 : slope >= 0)
        return {};
    const double t = glm::dot(toCenter, normal) / slope;
    const glm::dvec3 p = t * direction - toCenter;
    const bool hit = rectangle ? std::abs(glm::dot(p, u)) <= glm::dot(u, u) &&
                                     std::abs(glm::dot(p, v)) <= glm::dot(v, v)
                               : glm::length(p) <= light.radius;
    return hit ? Inside{t, t} : Inside{};
}

Inside insidePolygon(const CndLight& light, const glm::dvec3& direction, const glm::dvec3& toCenter)
{
    const glm::dvec3 normal = glm::cross(vec3(light.axisU), vec3(light.axisV));
    const double slope = glm::dot(direction, normal);
    if (light.twoSided ? slope == 0 : slope >= 0)
        return {};
    const double t = glm::dot(toCenter, normal) / slope;
    const glm::dvec3 p = t * direction;
    const std::vector<glm::dvec3> corners = polygonCorners(light, toCenter);
    for (size_t i = 0; i < corners.size(); ++i) {
        const glm::dvec3 edge = corners[(i + 1) % corners.size()] - corners[i];
        if (glm::dot(glm::cross(edge, p - corners[i]), normal) < 0)
            return {};
    }
    return {t, t};
}

} // namespace

std::optional<double> intersectLight(const CndLight& light, const glm::dvec3& lightOrigin,
                                     const Ray& ray)
{
    const double length = glm::length(ray.direction);
    const glm::dvec3 direction = ray.direction / length;
    const glm::dvec3 toCenter = lightOrigin + vec3(light.position) - ray.origin;
    Inside inside;
    switch (light.type) {
    case CND_LIGHT_SPHERE:
        addSphere(inside, direction, toCenter, light.radius);
        break;
    case CND_LIGHT_TUBE:
        inside = insideTube(direction, toCenter, vec3(light.axisU), light.radius);
        break;
    case CND_LIGHT_RECTANGLE:
    case CND_LIGHT_DISC:
        inside = insideFlat(light, direction, toCenter);
        break;
    case CND_LIGHT_POLYGON:
        inside = insidePolygon(light, direction, toCenter);
        break;
    default: // punctual or distant
        break;
    }
    if (!(inside.to > 0))
        return std::nullopt;
    return (inside.from > 0 ? inside.from : inside.to) / length;
}

std::optional<glm::dvec3> distantLuminance(std::span<const CndLight> lights,
                                           const glm::dvec3& direction)
{
    const glm::dvec3 d = glm::normalize(direction);
    std::optional<glm::dvec3> out;
    for (const CndLight& light : lights) {
        if (light.type != CND_LIGHT_DISTANT_SPHERE)
            continue;
        const glm::dvec3 toLight = -glm::normalize(vec3(light.direction));
        // Compares the sine itself: the cosine of a small angle cannot be told from that of a
        // smaller one.
        if (glm::dot(d, toLight) > 0 && glm::length(glm::cross(d, toLight)) <= light.radius)
            out = vec3(light.emission);
    }
    return out;
}

} // namespace candelabra::reference
