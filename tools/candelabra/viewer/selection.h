// SPDX-License-Identifier: Apache-2.0
// Shows in the viewer's picture what is selected.
#pragma once

#include <optional>
#include <vector>

#include "generate/ray_caster.h"
#include "scene/scene.h"
#include "viewer/light_handles.h"

namespace candelabra::app
{

struct PanelState;

std::vector<glm::dvec3> cornersOf(const Bounds& bounds);

// Draws the outline and the name of the selected light, which is `light`, or of the selected
// object. The name of a light with handles is at the tip of handle y, where no other handle is.
void drawSelection(const PanelState& state, const Projection& view,
                   const std::optional<CndLight>& light, const glm::dvec3& lightOrigin,
                   const std::optional<LightHandles>& handles);
// Draws the handles of a light in the colours of their axes; `active`: the one under the mouse.
void drawHandles(const LightHandles& handles, const Projection& view,
                 std::optional<uint32_t> active);

// Moves a camera that was fitted to an object forward until no surface hides `front`, the nearest
// point of the object's bounds. `rays` must belong to the same scene.
Camera beforeOccluders(Camera fitted, const glm::dvec3& front, RayCaster& rays);

} // namespace candelabra::app
