// SPDX-License-Identifier: Apache-2.0
// Makes the meshes of the generated scenes. Triangles are counter-clockwise seen from outside.
// Vertices have unit normals, unit tangents along +u, and uv coordinates in set 0. Lengths are in
// metres.
#pragma once

#include <cstdint>
#include <vector>

#include <glm/glm.hpp>

#include "scene/scene.h"

namespace candelabra::app
{

// One smooth part of a profile, as points (distance to the y axis, height) from the bottom up along
// the outside. There is a crease between two runs.
using ProfileRun = std::vector<glm::vec2>;

// A box with edges of length 1 around the origin. uv is 0..1 on the four sides, and 0 at top and
// bottom.
Mesh makeBox();
// The same box with its edges cut off by `bevel` (0 < bevel < 0.5).
Mesh makeBevelledBox(float bevel);
// A tile of 1 x 1 in x and z with its top at y = 0, a slanted rim of width `bevel` that goes down
// to y = -bevel, and no bottom.
Mesh makeTile(float bevel);
// A square of 1 x 1 around the origin in y = 0 that faces up, of cells x cells quads.
Mesh makeGround(uint32_t cells);
// A sphere of radius 1 around the origin.
Mesh makeSphere(uint32_t segments, uint32_t rings);
// A torus around the y axis.
Mesh makeTorus(float majorRadius, float minorRadius, uint32_t segments, uint32_t sides);
// A tube along the (2,3) torus knot, about 1 wide in all.
Mesh makeKnot(float tubeRadius, uint32_t segments, uint32_t sides);
// A solid of revolution around the y axis.
Mesh makeLathe(const std::vector<ProfileRun>& runs, uint32_t segments);
// A closed cylinder of radius 1 from y = 0 to y = 1.
Mesh makeCylinder(uint32_t segments);
// A closed wall in the xy plane: `width` wide around x = 0, `height` high above y = 0, and `depth`
// deep around z = 0, with a semicircular opening of `radius` (< width / 2, < height) around the
// origin.
Mesh makeArchedWall(float width, float height, float depth, float radius, uint32_t segments);
// A rectangular section swept around the z axis from angle 0 (+x) to `angle` <= 2 pi.
Mesh makeArchRing(float inner, float outer, float depth, float angle, uint32_t segments);
// The inside of half a tube of radius 1 around the x axis, with y >= 0 and x from -0.5 to 0.5.
Mesh makeVault(uint32_t segments);
// A house of 1 x 1 x 1 that stands on y = 0, with a ridge along x at y = 1 and eaves at y = 0.7.
Mesh makeGabledHouse();

} // namespace candelabra::app
