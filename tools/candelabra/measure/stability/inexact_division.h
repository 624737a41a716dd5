// SPDX-License-Identifier: Apache-2.0
// Rounds the quotients and roots of a shader as badly as Vulkan allows GPUs to. CPU devices round
// them correctly, so a formula that relies on that fails on GPUs only.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

namespace candelabra::app
{

// Returns the words of the module with every 32-bit float that comes from a division, sqrt(),
// inversesqrt(), length(), distance() or normalize() moved by a few units in the last place:
// inversesqrt() by -1, 0 or 1, the others by -2 to 2. With the rounding of a device that rounds
// correctly they are wrong by at most 1.5 and 2.5 ULP, which are within the limits of the Vulkan
// specification, "Precision of Individual Operations" (2 ULP, 2.5 ULP, and what follows from these
// for the others). By how much follows from the value's bits, the instruction and `seed`. Values
// that are zero, denormal, huge, infinite or NaN stay as they are.
std::vector<uint32_t> withInexactDivision(std::span<const uint32_t> spirv, uint32_t seed);

} // namespace candelabra::app
