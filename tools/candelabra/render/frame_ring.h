// SPDX-License-Identifier: Apache-2.0
// FrameRing has one command buffer per frame in flight and knows when the GPU has finished each.
#pragma once

#include <chrono>
#include <cstdint>
#include <vector>

#include "render/vulkan_context.h"

namespace candelabra::app
{

class FrameRing
{
public:
    // `slots` is the number of frames that may be in flight at the same time.
    FrameRing(const VulkanContext& context, uint32_t slots);
    ~FrameRing(); // waits for the GPU
    FrameRing(const FrameRing&) = delete;
    FrameRing& operator=(const FrameRing&) = delete;

    struct Frame {
        VkCommandBuffer cmd;
        uint32_t slot;
        // A frame of this slot has finished since the ring was created, so there are statistics.
        bool reused;
    };
    // Waits until the previous frame of the next slot is finished, and begins the command buffer of
    // that slot.
    Frame begin();
    // Ends and submits what was recorded since begin(). Colour output and transfers wait for the
    // semaphore `wait`; `signal` is signalled when the whole frame is finished. Both may be null.
    void submit(VkSemaphore wait = VK_NULL_HANDLE, VkSemaphore signal = VK_NULL_HANDLE);
    // Waits until begin() need not wait, but no longer than `most`. Returns whether that is so.
    bool waitForNext(std::chrono::nanoseconds most) const { return waitFor(current_, most); }
    // Waits, no longer than `most`, until the GPU has finished the frame of a slot, and returns
    // whether it has.
    bool waitFor(uint32_t slot, std::chrono::nanoseconds most) const;
    // Waits until the GPU has finished the frame of a slot.
    void wait(uint32_t slot) const;
    // Waits until the GPU has finished all frames.
    void wait() const;
    uint32_t slots() const { return uint32_t(slots_.size()); }

private:
    struct Slot {
        VkCommandPool pool = VK_NULL_HANDLE;
        VkCommandBuffer cmd = VK_NULL_HANDLE;
        VkFence done = VK_NULL_HANDLE;
        bool used = false;
    };
    void createSlot(Slot& slot) const;
    void destroy() noexcept;

    const VulkanContext& context_;
    std::vector<Slot> slots_;
    uint32_t current_ = 0;
};

} // namespace candelabra::app
