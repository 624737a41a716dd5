// SPDX-License-Identifier: Apache-2.0
// What the types of lights are called in scene descriptions, tables and results.
#pragma once

#include <cstdint>

#include "candelabra/candelabra.h"

namespace candelabra::app
{

inline const char* lightTypeName(uint32_t type)
{
    static constexpr const char* names[CND_LIGHT_TYPE_COUNT] = {
        "point", "sphere", "spot", "directional", "distant_sphere", "tube", "rectangle", "disc"};
    return names[type];
}

} // namespace candelabra::app
