// SPDX-License-Identifier: Apache-2.0
// Boxes around the spheres of influence of a set's lights, one per light type, with the layers of
// these lights. A frame leaves out the light types whose box is outside the view.
#pragma once

#include <array>
#include <span>

#include <glm/vec3.hpp>

#include "candelabra/candelabra.h"
#include "shared/lighting_data.h"
#include "shared/occluder_data.h"

namespace candelabra::lighting
{

// Tells whether `mask` is a mask of layers as in the public structs, where 0 stands for all layers.
constexpr bool areLayers(uint32_t mask)
{
    return !(mask & ~gpu::ALL_LAYERS);
}
// Returns the layers that such a mask stands for.
constexpr uint32_t layersOf(uint32_t mask)
{
    return mask ? mask : gpu::ALL_LAYERS;
}

// Returns the bits of LightRecord::flags that say which occluders shadow a light. The arguments are
// members of CndLight.
constexpr uint32_t flagsOfShadows(VkBool32 unshadowed, uint32_t unshadowedBy)
{
    return (unshadowed ? gpu::LIGHT_UNSHADOWED : 0) | unshadowedBy
                                                          << gpu::LIGHT_UNSHADOWED_BY_SHIFT;
}

// A box that holds the spheres of influence of some lights, in metres relative to the set's origin.
// low > high: there are no lights.
struct InfluenceBox {
    glm::dvec3 low, high;
    uint32_t layers = 0; // every layer that one of the lights is in
};
using InfluenceBoxes = std::array<InfluenceBox, CND_LIGHT_TYPE_COUNT>;

// Returns a box without bounds, for lights in these layers.
InfluenceBox endlessBox(uint32_t layers);

// Returns the box of each light type. The boxes of distant types have no bounds.
InfluenceBoxes influenceBoxesOf(std::span<const CndLight> lights);

// Grows each box until it holds the box of the same type in `more`, and adds that box's layers.
void widenBoxes(InfluenceBoxes& boxes, const InfluenceBoxes& more);
// Does the same for the lights of each type.
void widenBoxes(InfluenceBoxes& boxes, std::span<const CndLight> lights);

// Returns false only if no point that the camera shows is inside the box.
bool reachesView(const InfluenceBox& box, const double origin[3], const CndCamera& camera);

} // namespace candelabra::lighting
