// SPDX-License-Identifier: Apache-2.0
// The fitted table of linearly transformed cosines; shared/ltc.h says what it holds.
#pragma once

#include <span>

#include "shared/ltc.h"

namespace candelabra::tables
{

// LTC_TABLE_SIZE^2 * LTC_TEXELS texels of 4 floats, as a buffer of vec4 holds them.
std::span<const float> ltcTable();

} // namespace candelabra::tables
