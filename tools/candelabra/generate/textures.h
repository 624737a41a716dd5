// SPDX-License-Identifier: Apache-2.0
// Textures that the procedural scenes paint themselves.
#pragma once

#include <vector>

#include <glm/glm.hpp>

#include "scene/scene.h"

namespace candelabra::app
{

// Makes a texture one texel wide with one texel per colour from v = 0 to v = 1, clamped beyond. The
// colours are linear Rec.709 in [0, 1].
Texture makeGradient(const std::vector<glm::vec3>& colours);

// Makes 16 x 16 panes of coloured glass between strips of lead, as a map of emission.
Texture makeLeadedGlass();

} // namespace candelabra::app
