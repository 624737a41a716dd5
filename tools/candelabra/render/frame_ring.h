// SPDX-License-Identifier: Apache-2.0
// FrameRing: command buffers of the frames in flight, and when the GPU is done with each.
#pragma once

#include <cstdint>
#include <vector>

#include "render/vulkan_context.h"

namespace candelabra::app
{

class FrameRing
{
public:
    // `slots` frames may be under way at once.
    FrameRing(const VulkanContext& context, uint32_t slots);
    ~FrameRing(); // waits for the GPU
    FrameRing(const FrameRing&) = delete;
    FrameRing& operator=(const FrameRing&) = delete;

    struct Frame {
        VkCommandBuffer cmd;
        uint32_t slot;
        bool reused; // a frame of this slot has finished since the ring was made: it has statistics
    };
    // Waits until the slot's previous frame is done and begins its command buffer.
    Frame begin();
    // Ends and submits what was recorded since begin(). Semaphores may be null: colour output and
    // transfers wait for `wait`; `signal` follows all of the frame.
    void submit(VkSemaphore wait = VK_NULL_HANDLE, VkSemaphore signal = VK_NULL_HANDLE);
    // Waits for all frames.
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
