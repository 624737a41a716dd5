// SPDX-License-Identifier: Apache-2.0
#include "reference/emitter_points.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

#include "reference/truth.h"
#include "reference/vectors.h"

namespace candelabra::reference
{

namespace
{

using std::numbers::pi;

bool isFlat(const CndLight& light)
{
    return light.type == CND_LIGHT_RECTANGLE || light.type == CND_LIGHT_DISC ||
           light.type == CND_LIGHT_POLYGON;
}

bool isCap(const CndLight& light)
{
    return light.type == CND_LIGHT_SPHERE || light.type == CND_LIGHT_DISTANT_SPHERE;
}

double doubledArea(const glm::dvec3& a, const glm::dvec3& b, const glm::dvec3& c)
{
    return glm::length(glm::cross(b - a, c - a));
}

// Returns the point of a capsule whose axial coordinate is the share u of its whole length: its
// area is evenly distributed along its axis (Archimedes), over the ends as over the side.
glm::dvec3 capsulePoint(const glm::dvec3& half, double radius, double u, double v)
{
    const double halfLength = glm::length(half);
    const Frame frame = frameAround(half / halfLength, {0, 1, 0});
    const double along = (2 * u - 1) * (halfLength + radius);
    const double beyond = std::max(std::abs(along) - halfLength, 0.0);
    const double ring = std::sqrt((radius - beyond) * (radius + beyond));
    const double angle = 2 * pi * v;
    return along * frame.z + ring * (std::cos(angle) * frame.x + std::sin(angle) * frame.y);
}

// Returns a point of the convex polygon, whose fan of triangles is filled evenly.
glm::dvec3 polygonPoint(const std::vector<glm::dvec3>& corners, double u, double v)
{
    double rest = 0;
    for (size_t i = 1; i + 1 < corners.size(); ++i)
        rest += doubledArea(corners[0], corners[i], corners[i + 1]);
    rest *= u;
    size_t i = 1;
    double area = doubledArea(corners[0], corners[1], corners[2]);
    while (rest >= area && i + 2 < corners.size()) {
        rest -= area;
        ++i;
        area = doubledArea(corners[0], corners[i], corners[i + 1]);
    }
    const double root = std::sqrt(std::min(rest / area, 1.0));
    return corners[0] + root * (glm::mix(corners[i], corners[i + 1], v) - corners[0]);
}

} // namespace

EmitterPoints::EmitterPoints(const CndLight& light, const glm::dvec3& lightOrigin,
                             const glm::dvec3& receiver)
    : light_(light),
      lightOrigin_(lightOrigin),
      receiver_(receiver),
      toCenter_(lightOrigin + vec3(light.position) - receiver)
{
    const glm::dvec3 u = vec3(light.axisU), v = vec3(light.axisV);
    const double radius = light.radius;
    constexpr double outside = 1 + 1e-9;
    switch (light.type) {
    case CND_LIGHT_DISTANT_SPHERE: {
        const double sine = std::min(radius, 1.0);
        cap_ = {-glm::normalize(vec3(light.direction)), sine * sine};
        break;
    }
    case CND_LIGHT_SPHERE:
        cap_ = sphereCap(toCenter_, radius);
        contain_ = !(glm::length(toCenter_) > outside * radius);
        break;
    case CND_LIGHT_TUBE: {
        const double t = std::clamp(-glm::dot(toCenter_, u) / glm::dot(u, u), -1.0, 1.0);
        contain_ = !(glm::length(toCenter_ + t * u) > outside * radius);
        area_ = 4 * pi * radius * (glm::length(u) + radius);
        break;
    }
    case CND_LIGHT_RECTANGLE:
        area_ = 4 * glm::length(glm::cross(u, v));
        break;
    case CND_LIGHT_DISC:
        area_ = pi * radius * radius;
        break;
    case CND_LIGHT_POLYGON:
        corners_ = polygonCorners(light, toCenter_);
        for (size_t i = 1; i + 1 < corners_.size(); ++i)
            area_ += doubledArea(corners_[0], corners_[i], corners_[i + 1]) / 2;
        break;
    default:
        break;
    }
    capHeight_ = cap_.sin2 / (1 + cap_.cosine());
    if (isFlat(light))
        normal_ =
            glm::normalize(light.type == CND_LIGHT_DISC ? vec3(light.direction) : glm::cross(u, v));
}

bool EmitterPoints::isPoint() const
{
    return light_.type == CND_LIGHT_POINT || light_.type == CND_LIGHT_SPOT ||
           light_.type == CND_LIGHT_DIRECTIONAL;
}

EmitterPoint EmitterPoints::onCap(const glm::dvec3& direction) const
{
    EmitterPoint out{direction, std::numeric_limits<double>::infinity(), 1 / (2 * pi * capHeight_)};
    if (light_.type == CND_LIGHT_SPHERE) {
        const double along = glm::dot(direction, toCenter_);
        const glm::dvec3 miss = toCenter_ - along * direction;
        const double depth2 = double(light_.radius) * light_.radius - glm::dot(miss, miss);
        out.distance = along - std::sqrt(std::max(depth2, 0.0));
    }
    return out;
}

EmitterPoint EmitterPoints::onSurface(const glm::dvec3& point) const
{
    const double distance = glm::length(point);
    const glm::dvec3 direction = point / distance;
    double facing = std::abs(glm::dot(normal_, direction));
    if (light_.type == CND_LIGHT_TUBE) {
        const glm::dvec3 half = vec3(light_.axisU), offset = point - toCenter_;
        const double t = std::clamp(glm::dot(offset, half) / glm::dot(half, half), -1.0, 1.0);
        facing = -glm::dot(offset - t * half, direction) / light_.radius;
    }
    return {direction, distance, facing > 0 ? distance * distance / (facing * area_) : 0};
}

glm::dvec3 EmitterPoints::surfacePoint(double u, double v) const
{
    switch (light_.type) {
    case CND_LIGHT_TUBE:
        return toCenter_ + capsulePoint(vec3(light_.axisU), light_.radius, u, v);
    case CND_LIGHT_RECTANGLE:
        return toCenter_ + (2 * u - 1) * vec3(light_.axisU) + (2 * v - 1) * vec3(light_.axisV);
    case CND_LIGHT_DISC: {
        const Frame frame = frameAround(normal_, {0, 1, 0});
        const double ring = light_.radius * std::sqrt(u), angle = 2 * pi * v;
        return toCenter_ + ring * (std::cos(angle) * frame.x + std::sin(angle) * frame.y);
    }
    default:
        return polygonPoint(corners_, u, v);
    }
}

EmitterPoint EmitterPoints::at(double u, double v) const
{
    if (isPoint()) {
        if (light_.type == CND_LIGHT_DIRECTIONAL)
            return {-glm::normalize(vec3(light_.direction)),
                    std::numeric_limits<double>::infinity(), 1};
        const double distance = glm::length(toCenter_);
        return {toCenter_ / distance, distance, 1};
    }
    if (!isCap(light_))
        return onSurface(surfacePoint(u, v));
    const double height = u * capHeight_, angle = 2 * pi * v;
    const double sine = std::sqrt(height * (2 - height));
    const Frame frame = frameAround(cap_.axis, {0, 1, 0});
    return onCap((1 - height) * frame.z +
                 sine * (std::cos(angle) * frame.x + std::sin(angle) * frame.y));
}

std::optional<EmitterPoint> EmitterPoints::along(const glm::dvec3& direction) const
{
    if (isPoint())
        return std::nullopt;
    if (isCap(light_)) {
        const glm::dvec3 chord = direction - cap_.axis; // its square is 2 (1 - cosine)
        return glm::dot(chord, chord) <= 2 * capHeight_ ? std::optional(onCap(direction))
                                                        : std::nullopt;
    }
    const auto distance = intersectLight(light_, lightOrigin_, {receiver_, direction});
    return distance ? std::optional(onSurface(*distance * direction)) : std::nullopt;
}

Shaft EmitterPoints::shaft() const
{
    const glm::dvec3 u = vec3(light_.axisU), v = vec3(light_.axisV);
    switch (light_.type) {
    case CND_LIGHT_DIRECTIONAL:
        return Shaft::distant(receiver_, -glm::normalize(vec3(light_.direction)), 0);
    case CND_LIGHT_DISTANT_SPHERE:
        return Shaft::distant(receiver_, cap_.axis, cap_.sine());
    case CND_LIGHT_POINT:
    case CND_LIGHT_SPOT:
        return {receiver_, toCenter_, 0};
    case CND_LIGHT_TUBE:
        return {receiver_, toCenter_, glm::length(u) + light_.radius};
    case CND_LIGHT_RECTANGLE:
        return {receiver_, toCenter_, std::max(glm::length(u + v), glm::length(u - v))};
    case CND_LIGHT_POLYGON: {
        double radius = 0;
        for (const glm::dvec3& corner : corners_)
            radius = std::max(radius, glm::distance(corner, toCenter_));
        return {receiver_, toCenter_, radius};
    }
    default:
        return {receiver_, toCenter_, light_.radius};
    }
}

} // namespace candelabra::reference
