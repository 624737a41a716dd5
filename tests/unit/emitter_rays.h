// SPDX-License-Identifier: Apache-2.0
// The visible share of a light by rays to points of the true emitter, in double precision. It uses
// no formula of the shaders.
#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include <glm/glm.hpp>

namespace candelabra::test
{

using OccluderTriangle = std::array<glm::dvec3, 3>;
struct Occluder {
    std::vector<OccluderTriangle> triangles;
    glm::dvec3 centre{0};
    double radius = 0; // of a ball that holds the triangles
};
// A box, or a sheet if one half axis is 0.
Occluder makeBox(const glm::dvec3& centre, const glm::dmat3& halfAxes);

// A point of an emitter as the origin sees it.
struct EmitterRay {
    glm::dvec3 direction;  // unit
    double distance = 0;   // INFINITY: a distant light
    double solidAngle = 0; // that it stands for
};
// The points of an emitter that face the origin, about `side` * `side` of them, on a regular grid.
std::vector<EmitterRay> spherePoints(const glm::dvec3& centre, double radius, uint32_t side);
std::vector<EmitterRay> distantSpherePoints(const glm::dvec3& direction, double sine,
                                            uint32_t side);
std::vector<EmitterRay> discPoints(const glm::dvec3& centre, const glm::dvec3& normal,
                                   double radius, uint32_t side);
// `corners`: of a convex polygon, in the coordinates of the half axes.
std::vector<EmitterRay> polygonPoints(const glm::dvec3& centre, const glm::dvec3& axisU,
                                      const glm::dvec3& axisV,
                                      const std::vector<glm::dvec2>& corners, uint32_t side);
std::vector<EmitterRay> tubePoints(const glm::dvec3& centre, const glm::dvec3& halfAxis,
                                   double radius, uint32_t side);

// Returns whether a triangle is on the way from the origin to the point.
bool isHidden(const EmitterRay& point, const std::vector<Occluder>& occluders);

} // namespace candelabra::test
