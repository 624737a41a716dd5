// SPDX-License-Identifier: Apache-2.0
// Brute force evaluates every light at every pixel, which may take minutes. It is recorded in
// dispatches of a limited amount of work, as measuring influence is: many systems reset a GPU on
// which one dispatch runs for longer than about two seconds, because they cannot interrupt it.
#pragma once

#include <algorithm>

#include "shared/lighting_data.h"

namespace candelabra::lighting
{

// The most pairs of pixel and light of a dispatch, as far as one work group stays below it. A GPU
// that evaluates 300 million pairs a second, as a small integrated one may, takes 0.9 s.
inline constexpr uint64_t brutePairsPerDispatch = uint64_t(1) << 28;

// Divides the pixels first <= pixel < end into rectangles of whole work groups whose pairs with
// `lights` lights are at most `largest`, if that is enough for one work group. Calls `record` with
// the first and the end pixel of each.
template <typename Record>
void inBruteRects(glm::uvec2 first, glm::uvec2 end, uint64_t lights, uint64_t largest,
                  Record&& record) noexcept
{
    constexpr uint32_t side = gpu::TILE_SIZE;
    const glm::uvec2 groups = (end - first + side - 1u) / side;
    const uint64_t most = std::max<uint64_t>(largest / (lights * side * side), 1);
    const glm::uvec2 step(std::min<uint64_t>(most, groups.x),
                          std::clamp<uint64_t>(most / groups.x, 1, groups.y));
    for (uint32_t y = 0; y < groups.y; y += step.y)
        for (uint32_t x = 0; x < groups.x; x += step.x) {
            const glm::uvec2 at(x, y);
            record(first + side * at, glm::min(first + side * (at + step), end));
        }
}

} // namespace candelabra::lighting
