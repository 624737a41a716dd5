// SPDX-License-Identifier: Apache-2.0
// Looks at a scene from far away, to find out from where it shows its surfaces.
#pragma once

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

// Returns what is seen along each of the directions, which point from the eye to the scene. Alpha
// masks are ignored.
std::vector<OutsideView> seenFromOutside(const Scene& scene,
                                         const std::vector<glm::dvec3>& directions);

} // namespace candelabra::app
