// SPDX-License-Identifier: Apache-2.0
#include "unit/emitter_rays.h"

#include <algorithm>
#include <cmath>

#include "harness/constants.h"

namespace candelabra::test
{
namespace
{

// Two unit vectors perpendicular to z and to each other.
std::array<glm::dvec3, 2> frameOf(const glm::dvec3& z)
{
    const glm::dvec3 other = std::abs(z.x) < 0.6 ? glm::dvec3(1, 0, 0) : glm::dvec3(0, 1, 0);
    const glm::dvec3 x = glm::normalize(glm::cross(other, z));
    return {x, glm::cross(z, x)};
}

// Adds a piece of a surface if its front faces the origin.
void addPiece(std::vector<EmitterRay>& out, const glm::dvec3& at, const glm::dvec3& normal,
              double area, bool twoSided)
{
    const double distance = glm::length(at);
    const double cosine = -glm::dot(at, normal) / distance;
    if (cosine > 0 || twoSided)
        out.push_back({at / distance, distance, area * std::abs(cosine) / (distance * distance)});
}

// Adds the directions of a cap around the z axis of equal solid angles.
std::vector<EmitterRay> capPoints(const glm::dvec3& direction, double sine, uint32_t side)
{
    const auto [x, y] = frameOf(direction);
    // 1 - cosine, without cancellation.
    const double height = sine * sine / (1 + std::sqrt(std::max(0.0, 1 - sine * sine)));
    std::vector<EmitterRay> out;
    for (uint32_t i = 0; i < side; ++i)
        for (uint32_t j = 0; j < side; ++j) {
            const double h = height * (i + 0.5) / side, azimuth = 2 * pi * (j + 0.5) / side;
            const double s = std::sqrt(h * (2 - h));
            const glm::dvec3 l =
                (1 - h) * direction + s * (std::cos(azimuth) * x + std::sin(azimuth) * y);
            out.push_back({glm::normalize(l), INFINITY, 2 * pi * height / (side * side)});
        }
    return out;
}

// Moeller and Trumbore 1997; both sides count.
bool crosses(const glm::dvec3& direction, double distance, const OccluderTriangle& t)
{
    const glm::dvec3 e1 = t[1] - t[0], e2 = t[2] - t[0], p = glm::cross(direction, e2);
    const double det = glm::dot(e1, p);
    if (det == 0)
        return false;
    const double u = -glm::dot(t[0], p) / det;
    if (u < 0 || u > 1)
        return false;
    const glm::dvec3 q = glm::cross(-t[0], e1);
    const double v = glm::dot(direction, q) / det, along = glm::dot(e2, q) / det;
    return v >= 0 && u + v <= 1 && along > 0 && along < distance;
}

bool missesBall(const EmitterRay& point, const glm::dvec3& centre, double radius)
{
    const double along = glm::dot(point.direction, centre);
    return along < -radius || along > point.distance + radius ||
           glm::length(centre - along * point.direction) > radius;
}

bool isInside(const glm::dvec2& at, const std::vector<glm::dvec2>& corners)
{
    for (size_t i = 0; i < corners.size(); ++i) {
        const glm::dvec2 edge = corners[(i + 1) % corners.size()] - corners[i];
        const glm::dvec2 d = at - corners[i];
        if (edge.x * d.y - edge.y * d.x < 0)
            return false;
    }
    return true;
}

} // namespace

Occluder makeBox(const glm::dvec3& centre, const glm::dmat3& halfAxes)
{
    Occluder out{.triangles = {},
                 .centre = centre,
                 .radius = glm::length(halfAxes[0]) + glm::length(halfAxes[1]) +
                           glm::length(halfAxes[2])};
    for (int axis = 0; axis < 3; ++axis)
        for (const double side : {-1.0, 1.0}) {
            const glm::dvec3 u = halfAxes[(axis + 1) % 3], v = halfAxes[(axis + 2) % 3];
            const glm::dvec3 c = centre + side * halfAxes[axis];
            if (u == glm::dvec3(0) || v == glm::dvec3(0) ||
                (side > 0 && halfAxes[axis] == glm::dvec3(0)))
                continue;
            out.triangles.push_back({c - u - v, c + u - v, c + u + v});
            out.triangles.push_back({c - u - v, c + u + v, c - u + v});
        }
    return out;
}

std::vector<EmitterRay> spherePoints(const glm::dvec3& centre, double radius, uint32_t side)
{
    const double distance = glm::length(centre);
    std::vector<EmitterRay> out = capPoints(centre / distance, radius / distance, side);
    for (EmitterRay& p : out) {
        const double along = glm::dot(p.direction, centre);
        const double aside2 = std::max(0.0, distance * distance - along * along);
        p.distance = along - std::sqrt(std::max(0.0, radius * radius - aside2));
    }
    return out;
}

std::vector<EmitterRay> distantSpherePoints(const glm::dvec3& direction, double sine, uint32_t side)
{
    return capPoints(direction, sine, side);
}

std::vector<EmitterRay> discPoints(const glm::dvec3& centre, const glm::dvec3& normal,
                                   double radius, uint32_t side)
{
    const auto [x, y] = frameOf(normal);
    std::vector<EmitterRay> out;
    for (uint32_t i = 0; i < side; ++i)
        for (uint32_t j = 0; j < side; ++j) {
            const double r = radius * std::sqrt((i + 0.5) / side);
            const double azimuth = 2 * pi * (j + 0.5) / side;
            addPiece(out, centre + r * (std::cos(azimuth) * x + std::sin(azimuth) * y), normal,
                     pi * radius * radius / (side * side), true);
        }
    return out;
}

std::vector<EmitterRay> polygonPoints(const glm::dvec3& centre, const glm::dvec3& axisU,
                                      const glm::dvec3& axisV,
                                      const std::vector<glm::dvec2>& corners, uint32_t side)
{
    const glm::dvec3 normal = glm::normalize(glm::cross(axisU, axisV));
    std::vector<EmitterRay> out;
    for (uint32_t i = 0; i < side; ++i)
        for (uint32_t j = 0; j < side; ++j) {
            const glm::dvec2 at(2 * (i + 0.5) / side - 1, 2 * (j + 0.5) / side - 1);
            if (isInside(at, corners))
                addPiece(out, centre + at.x * axisU + at.y * axisV, normal,
                         4 * glm::length(axisU) * glm::length(axisV) / (side * side), true);
        }
    return out;
}

std::vector<EmitterRay> tubePoints(const glm::dvec3& centre, const glm::dvec3& halfAxis,
                                   double radius, uint32_t side)
{
    const double size = glm::length(halfAxis);
    const glm::dvec3 along = halfAxis / size;
    const auto [x, y] = frameOf(along);
    // Half of the pieces face away from the origin, so there are twice as many. Pieces of the side
    // and of the ends have similar areas: the surface of a ball has the area of a cylinder around
    // it (Archimedes), so equal lengths along the axis have equal areas.
    const uint32_t rows = 2 * side;
    std::vector<EmitterRay> out;
    for (uint32_t i = 0; i < rows; ++i)
        for (uint32_t j = 0; j < side; ++j) {
            const double azimuth = 2 * pi * (j + 0.5) / side;
            const glm::dvec3 away = std::cos(azimuth) * x + std::sin(azimuth) * y;
            const double place = (2 * (i + 0.5) / rows - 1) * (size + radius);
            const double h = std::clamp((std::abs(place) - size) / radius, 0.0, 1.0);
            const glm::dvec3 normal = std::copysign(h, place) * along + std::sqrt(1 - h * h) * away;
            const double onAxis = std::clamp(place, -size, size);
            addPiece(out, centre + onAxis * along + radius * normal, normal,
                     2 * pi * radius * 2 * (size + radius) / (rows * side), false);
        }
    return out;
}

bool isHidden(const EmitterRay& point, const std::vector<Occluder>& occluders)
{
    return std::any_of(occluders.begin(), occluders.end(), [&](const Occluder& o) {
        return !missesBall(point, o.centre, o.radius) &&
               std::any_of(o.triangles.begin(), o.triangles.end(), [&](const auto& t) {
                   return crosses(point.direction, point.distance, t);
               });
    });
}

} // namespace candelabra::test
