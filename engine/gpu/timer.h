// SPDX-License-Identifier: Apache-2.0
// Timer: GPU time of named, consecutive scopes of a frame.
#pragma once

#include <vector>

#include "gpu/handle.h"

namespace candelabra::gpu
{

// One stamp at the start of a frame and one after each scope, so a scope's time runs from the end
// of the one before it: n scopes cost n + 1 stamps and their times add up to the total. Scopes of
// the same name are summed into one row, in order of first use. A disabled timer records nothing.
class Timer
{
public:
    Timer() = default;
    // `slots` frames in flight, each at most maxScopes scopes with CND_MAX_KERNEL_TIMES names;
    // scopes beyond that are not timed.
    static constexpr uint32_t maxScopes = 511;
    Timer(const Device& device, const char* name, uint32_t slots, bool enabled);

    // Starts a frame; outside a render pass. The GPU must have finished the slot's previous frame.
    void begin(VkCommandBuffer cmd, uint32_t slot) noexcept;
    // Ends the scope `name` (static storage). Outside a render pass.
    void stamp(VkCommandBuffer cmd, const char* name) noexcept;

    // Writes the times of the last frame in `slot`. CND_NOT_READY while the GPU has not finished
    // it, an error when it never will.
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
