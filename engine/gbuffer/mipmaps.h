// SPDX-License-Identifier: Apache-2.0
// Mip chains of 8-bit textures, filtered on the CPU.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "gbuffer/geometry.h"

namespace candelabra::gbuffer
{

struct MipLevel {
    uint32_t width, height;
    size_t offset; // bytes from the start of the chain
};

// Returns the levels down to 1x1, each half as large (rounded down), packed one after the other, 4
// bytes per texel.
std::vector<MipLevel> mipLayout(uint32_t width, uint32_t height);
size_t chainBytes(const std::vector<MipLevel>& levels);

// Writes all levels. Each texel is the average over exactly its area in the next larger level, also
// when a side is odd (three weighted taps). RGB of sRGB textures is averaged in linear space, alpha
// is averaged as it is. Intermediate levels are not rounded, so the error is half a step of 8 bits.
void writeMips(const Texture& texture, const std::vector<MipLevel>& levels,
               std::span<std::byte> chain);

} // namespace candelabra::gbuffer
