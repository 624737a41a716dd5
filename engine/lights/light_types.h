// SPDX-License-Identifier: Apache-2.0
// What a light type is, as far as all rooms above ask: whether its lights have a place, whether it
// is a sphere, and how many lights of each type there are.
#pragma once

#include <array>

#include "candelabra/candelabra.h"

namespace candelabra::lighting
{

using LightTypeCounts = std::array<uint32_t, CND_LIGHT_TYPE_COUNT>;

// Distant lights have a direction and no position: they light every surface, so there is no light
// tree over them and no list holds them.
constexpr bool isDistant(uint32_t lightType)
{
    return lightType == CND_LIGHT_DIRECTIONAL || lightType == CND_LIGHT_DISTANT_SPHERE;
}

constexpr bool isSphere(uint32_t lightType)
{
    return lightType == CND_LIGHT_SPHERE || lightType == CND_LIGHT_DISTANT_SPHERE;
}

} // namespace candelabra::lighting
