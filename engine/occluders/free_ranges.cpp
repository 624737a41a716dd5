// SPDX-License-Identifier: Apache-2.0
#include "occluders/free_ranges.h"

#include <algorithm>

#include "gpu/id_table.h"

namespace candelabra::lighting
{

void FreeRanges::reserve(size_t ranges)
{
    // There is at most one gap before each range, and one more while two are joined.
    gpu::reserveMore(gaps_, taken_ + ranges + 1 - gaps_.size());
}

uint32_t FreeRanges::take(uint32_t count) noexcept
{
    ++taken_;
    const auto gap = std::ranges::find_if(gaps_, [&](const Range& r) { return r.count >= count; });
    if (gap == gaps_.end()) {
        end_ += count;
        return end_ - count;
    }
    const uint32_t first = gap->first;
    *gap = {first + count, gap->count - count};
    if (!gap->count)
        gaps_.erase(gap);
    return first;
}

void FreeRanges::give(uint32_t first, uint32_t count) noexcept
{
    --taken_;
    auto gap = std::ranges::lower_bound(gaps_, first, {}, &Range::first);
    gap = gaps_.insert(gap, {first, count});
    const auto join = [&](auto lower) {
        if (lower->first + lower->count != (lower + 1)->first)
            return;
        lower->count += (lower + 1)->count;
        gaps_.erase(lower + 1);
    };
    if (gap + 1 != gaps_.end())
        join(gap);
    if (gap != gaps_.begin())
        join(gap - 1);
    if (!gaps_.empty() && gaps_.back().first + gaps_.back().count == end_) {
        end_ = gaps_.back().first;
        gaps_.pop_back();
    }
}

} // namespace candelabra::lighting
