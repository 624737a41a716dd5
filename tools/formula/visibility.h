// SPDX-License-Identifier: Apache-2.0
// The shaders' facets, masks and visible shares of lights (shaders/lib/visibility), compiled as C++
// in double precision.
#pragma once

#include <array>
#include <cstdint>
#include <span>

#include <glm/mat3x3.hpp>
#include <glm/vec2.hpp>
#include <glm/vec3.hpp>

#include "formula/formula.h"
#include "shared/occluder_data.h"

namespace candelabra::formula
{

// The facet of a light, as Facet in lib/visibility/facet.glsl.
struct LightFacet {
    uint32_t count = 64; // of points
    glm::dvec3 centre, halfU, halfV;
    double inverseDistance = 0, kappa = 0, roundEnd = 1;
    uint32_t shape = 0;
    uint64_t members = 0;
};

// `receiver` gives the position, and `light` the centre; view space is the world. A polygon is
// given by the rectangle around it and the points in it.
LightFacet lightFacet(uint32_t count, const Receiver& receiver, const Light& light,
                      uint64_t polygonPoints = ~uint64_t{0});

// The smallest rectangle around a polygon, and which of its points are in the polygon.
struct EnclosingRectangle {
    glm::dvec2 centre, halfU, halfV;
    uint64_t points = 0;
};
// `count`: 64 or 32 points. The corners of the polygon, at most MAX_RECORD_CORNERS, go
// counterclockwise, and their coordinates are near 1.
EnclosingRectangle enclosingRectangle(uint32_t count, std::span<const glm::dvec2> corners);

using Triangle = std::array<glm::dvec3, 3>;
// A mesh whose vertices are in a space of its own; its transform is linear.
struct OccludingMesh {
    std::span<const Triangle> triangles;
    glm::dmat3 worldFromLocal{1};
};
// Returns the points that the triangles hide. ownDistance: metres.
uint64_t hiddenPoints(const LightFacet& facet, const OccludingMesh& mesh, const Receiver& receiver,
                      double ownDistance = 0);

// Samples in a box, and a ball, in the world.
struct Shaft {
    glm::dvec3 low, high; // of the box
    glm::dvec3 ball;
    double radius = 0;
    double ownDistance = 0; // metres
};
// Tells whether list_occluders leaves out a triangle because it hides no point of the ball from any
// sample.
bool leavesOut(const Shaft& shaft, const OccludingMesh& mesh, const Triangle& triangle);
// Receivers in a box, and how near to a triangle's plane it may be their own surface.
struct ReceiverBox {
    glm::dvec3 centre, half;
    double ownDistance = 0;
};
// Returns whether a mesh is proven to hide all of a light from all receivers in the box, by the
// steps of prove_dark.comp without its trees. `neighbours`: as findNeighbours() returns them for
// the triangles of the mesh.
bool provesDarkness(const ReceiverBox& box, const Light& light, const OccludingMesh& mesh,
                    std::span<const gpu::OccluderNeighbours> neighbours);

// Returns the visible shares of the diffuse and of the specular response. `lit`: visible points.
glm::dvec2 visibleShares(const LightFacet& facet, uint64_t lit, const Receiver& receiver);

} // namespace candelabra::formula
