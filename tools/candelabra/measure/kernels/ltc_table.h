// SPDX-License-Identifier: Apache-2.0
// The fitted table of linearly transformed cosines; shared/ltc.h describes its contents.
#pragma once

#include <vector>

#include <glm/glm.hpp>

namespace candelabra::app
{

// Returns LTC_TABLE_SIZE^2 * LTC_TEXELS texels.
std::vector<glm::vec4> ltcTable();

} // namespace candelabra::app
