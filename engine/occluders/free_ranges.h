// SPDX-License-Identifier: Apache-2.0
// Hands out ranges of an array that grows.
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

namespace candelabra::lighting
{

class FreeRanges
{
public:
    // Allocates the memory that take() and give() need for `ranges` ranges more than are handed
    // out.
    void reserve(size_t ranges);
    // Returns the first element of a range of so many elements: the first gap that is wide enough,
    // or the end of the array.
    uint32_t take(uint32_t count) noexcept;
    void give(uint32_t first, uint32_t count) noexcept;
    uint32_t end() const { return end_; } // of the last range that is handed out

private:
    struct Range {
        uint32_t first, count;
    };
    uint32_t end_ = 0;
    size_t taken_ = 0;
    std::vector<Range> gaps_; // in order, with elements in use between any two
};

} // namespace candelabra::lighting
