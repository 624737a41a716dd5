// SPDX-License-Identifier: Apache-2.0
// Looks at a scene from far away, to find out from where it shows its surfaces.
#pragma once

#include <cstdint>
#include <vector>

#include "scene/scene.h"

namespace candelabra::app
{

// What is seen of all instances from one direction, in shares of the pixels of a small picture that
// fits around them.
struct OutsideView {
    double drawn = 0;  // a surface is drawn: a front face, or a back face that the material shows
    double fronts = 0; // the nearest surface is a front face
    double backs = 0;  // the nearest surface is a back face, drawn or not
};

// So many triangles are drawn at most, those of all instances together and without those of boxes.
// A small file may have far more, because many instances may have the same mesh.
constexpr uint64_t mostTrianglesOutside = uint64_t{1} << 24;

// Returns what is seen along each of the directions, which point from the eye to the scene. Alpha
// masks are ignored. If the scene has more than mostTrianglesOutside triangles, the meshes with
// most of them are drawn as the boxes around them.
std::vector<OutsideView> seenFromOutside(const Scene& scene,
                                         const std::vector<glm::dvec3>& directions);

} // namespace candelabra::app
