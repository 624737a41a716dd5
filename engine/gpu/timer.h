// SPDX-License-Identifier: Apache-2.0
// Timer: measures the GPU time of named, consecutive scopes of a frame.
#pragma once

#include <vector>

#include "gpu/handle.h"

namespace candelabra::gpu
{

// One timestamp is written at the start of a frame and one after each scope, so a scope lasts from
// the end of the previous one to its own end, its waits for barriers included: n scopes take n + 1
// timestamps, and their times add up to the total. Scopes with the same name are summed in one row;
// rows are in order of first use. A disabled timer records nothing.
//
// A timestamp waits until all work before it is done, and on some devices work after it waits for
// the timestamp. So dispatches that may run at the same time, because there is no barrier between
// them, share a scope, which ends where the next barrier makes everything wait anyway. The
// dispatches get an UntimedFrame.
class Timer
{
public:
    Timer() = default;
    // `slots`: number of frames in flight. Each frame has at most maxScopes scopes, with at most
    // CND_MAX_KERNEL_TIMES different names; further scopes are not timed.
    static constexpr uint32_t maxScopes = 511;
    Timer(const Device& device, const char* name, uint32_t slots, bool enabled);

    // Starts a frame. Must be recorded outside a render pass; the GPU must have finished the slot's
    // previous frame.
    void begin(VkCommandBuffer cmd, uint32_t slot) noexcept;
    // Ends the scope `name` (static storage). Must be recorded outside a render pass.
    void stamp(VkCommandBuffer cmd, const char* name) noexcept;

    // Writes the times of the last frame in `slot`. Returns CND_NOT_READY while the GPU has not
    // finished it, an error if it never will.
    CndResult read(uint32_t slot, CndKernelTime* times, uint32_t& count) const noexcept;

private:
    struct Slot {
        const char* names[maxScopes];
        uint32_t count = 0;
    };
    const Device* device_ = nullptr;
    Handle<VkQueryPool> pool_;
    std::vector<Slot> slots_;
    uint32_t current_ = 0;
    uint64_t tickMask_ = 0;
};

} // namespace candelabra::gpu
