// SPDX-License-Identifier: Apache-2.0
// Names that many tests use: they are compiled together, so each stands once.
#pragma once

#include <limits>
#include <numbers>

namespace candelabra::test
{

inline constexpr double pi = std::numbers::pi;
inline constexpr float infinity = std::numeric_limits<float>::infinity();

} // namespace candelabra::test
