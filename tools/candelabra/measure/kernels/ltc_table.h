// SPDX-License-Identifier: Apache-2.0
// The fitted table of linearly transformed cosines; shared/ltc.h describes its contents.
#pragma once

#include <span>

#include "shared/ltc.h"

namespace candelabra::app
{

// Returns LTC_TABLE_SIZE^2 * LTC_TEXELS texels of 4 floats, laid out as an array of vec4.
std::span<const float> ltcTable();

} // namespace candelabra::app
