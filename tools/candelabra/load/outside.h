// SPDX-License-Identifier: Apache-2.0
// Looks at a scene from far away, to find out from where it shows its surfaces.
#pragma once

#include <cstdint>
#include <vector>

#include "scene/scene.h"

namespace candelabra::app
{

// The visible part of all instances from one direction, in shares of the pixels of a small picture
// that fits around them.
struct OutsideView {
    double drawn = 0;  // a surface is drawn: a front face, or a back face that the material shows
    double fronts = 0; // the nearest surface is a front face
    double backs = 0;  // the nearest surface is a back face, drawn or not
};

// A scene may have far more triangles in all its instances than its file has, because many
// instances may have the same mesh. From the 15 directions by which cameras and rooms are found,
// this number of triangles takes about 6 s of CPU time.
constexpr uint64_t mostTrianglesOutside = uint64_t{1} << 24;

// Returns what is seen along each of the directions, which point from the eye to the scene. Alpha
// masks are ignored. No more than `most` triangles are drawn, or as many as the meshes have if each
// is counted once, whichever is larger. If the instances have more, the meshes with most triangles
// in all their instances are drawn as the boxes around them.
std::vector<OutsideView> seenFromOutside(const Scene& scene,
                                         const std::vector<glm::dvec3>& directions,
                                         uint64_t most = mostTrianglesOutside);

} // namespace candelabra::app
