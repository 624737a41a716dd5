// SPDX-License-Identifier: Apache-2.0
// Meshes for the procedural scenes. All are wound counter-clockwise seen from outside and carry
// unit normals, unit tangents along +u, and uv in set 0. Metres.
#pragma once

#include <cstdint>
#include <vector>

#include <glm/glm.hpp>

#include "scene/scene.h"

namespace candelabra::app
{

// One smooth part of a profile, (distance to the y axis, height), from the bottom up along the
// outside. A new run starts a crease.
using ProfileRun = std::vector<glm::vec2>;

// Edge length 1 around the origin. uv: 0..1 on the four sides, 0 at top and bottom.
Mesh makeBox();
// The same with its edges cut off by `bevel` (0 < bevel < 0.5).
Mesh makeBevelledBox(float bevel);
// 1 x 1 in x and z, top at y = 0, slanted rim of `bevel` that goes down to y = -bevel; no bottom.
Mesh makeTile(float bevel);
// Square of 1 x 1 around the origin in y = 0, facing up, cells x cells quads.
Mesh makeGround(uint32_t cells);
// Radius 1 around the origin.
Mesh makeSphere(uint32_t segments, uint32_t rings);
// Around the y axis.
Mesh makeTorus(float majorRadius, float minorRadius, uint32_t segments, uint32_t sides);
// Tube around the (2,3) torus knot; about 1 wide in all.
Mesh makeKnot(float tubeRadius, uint32_t segments, uint32_t sides);
// Solid of revolution around the y axis.
Mesh makeLathe(const std::vector<ProfileRun>& runs, uint32_t segments);
// Radius 1, from y = 0 to y = 1, closed.
Mesh makeCylinder(uint32_t segments);
// Wall in the xy plane, `width` around x = 0, `height` up from y = 0, `depth` around z = 0, with a
// half round opening of `radius` (< width / 2, < height) around the origin. Closed.
Mesh makeArchedWall(float width, float height, float depth, float radius, uint32_t segments);
// Rectangular section swept around the z axis from angle 0 (+x) to `angle` <= 2 pi.
Mesh makeArchRing(float inner, float outer, float depth, float angle, uint32_t segments);
// Inside of half a tube: radius 1, around the x axis, y >= 0, x from -0.5 to 0.5.
Mesh makeVault(uint32_t segments);
// Box of 1 x 1 x 1 standing on y = 0 with a ridge along x at y = 1 and eaves at y = 0.7.
Mesh makeGabledHouse();

} // namespace candelabra::app
