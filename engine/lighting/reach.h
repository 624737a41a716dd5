// SPDX-License-Identifier: Apache-2.0
// How far the lights of a set reach, to leave out types none of which reaches the view.
#pragma once

#include <array>
#include <span>

#include <glm/vec3.hpp>

#include "candelabra/candelabra.h"

namespace candelabra::lighting
{

// Holds the spheres of influence of lights, metres, relative to the set's origin. low > high: none.
struct ReachBox {
    glm::dvec3 low, high;
};
using ReachBoxes = std::array<ReachBox, CND_LIGHT_TYPE_COUNT>;

ReachBox endlessReach();

// By type; those of distant types are infinite.
ReachBoxes reachOf(std::span<const CndLight> lights);

// Makes boxes hold those of `more` as well.
void widen(ReachBoxes& boxes, const ReachBoxes& more);

// False only when no point that the camera shows is inside the box.
bool reachesView(const ReachBox& box, const double origin[3], const CndCamera& camera);

} // namespace candelabra::lighting
