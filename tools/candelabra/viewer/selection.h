// SPDX-License-Identifier: Apache-2.0
// Shows in the viewer's picture what is selected.
#pragma once

#include <optional>
#include <vector>

#include "scene/scene.h"
#include "viewer/light_shape.h"

namespace candelabra::app
{

struct PanelState;

std::vector<glm::dvec3> cornersOf(const Bounds& bounds);

// Draws the outline of the selected light, which is `light`, or of the selected object.
void drawSelection(const PanelState& state, const Projection& view,
                   const std::optional<CndLight>& light, const glm::dvec3& lightOrigin);

} // namespace candelabra::app
