// SPDX-License-Identifier: Apache-2.0
// Boxes around the spheres of influence of a set's lights, by type and with the layers of the
// lights: light types none of which reaches the view are left out of a frame.
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
struct InfluenceBox {
    glm::dvec3 low, high;
    uint32_t layers = 0; // of any of them
};
using InfluenceBoxes = std::array<InfluenceBox, CND_LIGHT_TYPE_COUNT>;

InfluenceBox endlessBox(uint32_t layers);

// By type; those of distant types are infinite.
InfluenceBoxes influenceBoxesOf(std::span<const CndLight> lights);

// Makes boxes hold those of `more` as well.
void widen(InfluenceBoxes& boxes, const InfluenceBoxes& more);

// False only when no point that the camera shows is inside the box.
bool reachesView(const InfluenceBox& box, const double origin[3], const CndCamera& camera);

} // namespace candelabra::lighting
