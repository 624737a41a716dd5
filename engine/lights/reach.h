// SPDX-License-Identifier: Apache-2.0
// How far the lights of a set reach, and in which layers, to leave out types none of which reaches
// the view.
#pragma once

#include <array>
#include <span>

#include <glm/vec3.hpp>

#include "candelabra/candelabra.h"
#include "shared/lighting.h"

namespace candelabra::lighting
{

// Masks of layers as the public structs have them.
constexpr bool areLayers(uint32_t mask)
{
    return !(mask & ~gpu::ALL_LAYERS);
}
constexpr uint32_t layersOf(uint32_t mask)
{
    return mask ? mask : gpu::ALL_LAYERS;
}

// Holds the spheres of influence of lights, metres, relative to the set's origin. low > high: none.
struct ReachBox {
    glm::dvec3 low, high;
    uint32_t layers = 0; // of any of them
};
using ReachBoxes = std::array<ReachBox, CND_LIGHT_TYPE_COUNT>;

ReachBox endlessReach(uint32_t layers);

// By type; those of distant types are infinite.
ReachBoxes reachOf(std::span<const CndLight> lights);

// Makes boxes hold those of `more` as well.
void widen(ReachBoxes& boxes, const ReachBoxes& more);

// False only when no point that the camera shows is inside the box.
bool reachesView(const ReachBox& box, const double origin[3], const CndCamera& camera);

} // namespace candelabra::lighting
