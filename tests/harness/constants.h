// SPDX-License-Identifier: Apache-2.0
// Names that many tests use. Several test files are compiled as one, so each name may be defined
// only once.
#pragma once

#include <limits>
#include <numbers>

namespace candelabra::test
{

inline constexpr double pi = std::numbers::pi;
inline constexpr float infinity = std::numeric_limits<float>::infinity();
inline constexpr float nan = std::numeric_limits<float>::quiet_NaN();

} // namespace candelabra::test
