// SPDX-License-Identifier: Apache-2.0
// FrameStamps measures when the parts of a frame end on the GPU, with timestamps between them.
#pragma once

#include <vector>

#include "gpu/device.h"
#include "gpu/handle.h"

namespace candelabra::app
{

class FrameStamps
{
public:
    FrameStamps() = default; // takes no timestamps
    // `validBits` is the number of valid bits in timestamps of the queue that frames are submitted
    // to; with 0 the queue has no timestamps, and none are taken. `parts` is the number of parts of
    // a frame.
    FrameStamps(const gpu::Device& device, uint32_t validBits, uint32_t slots, uint32_t parts);

    // Call begin() before the first part of a frame and stamp() after each part, outside render
    // passes.
    void begin(VkCommandBuffer cmd, uint32_t slot);
    void stamp(VkCommandBuffer cmd, uint32_t slot);

    // Returns when each part of the slot's last frame ended, in ms since the start of the frame.
    // Empty without timestamps. The GPU must have finished the frame.
    std::vector<double> read(uint32_t slot) const;
    // The number of timestamps of the slot's last frame.
    uint32_t count(uint32_t slot) const { return slot < taken_.size() ? taken_[slot] : 0; }

private:
    const gpu::Device* device_ = nullptr;
    gpu::Handle<VkQueryPool> pool_;
    uint64_t mask_ = 0;
    uint32_t perSlot_ = 0;
    std::vector<uint32_t> taken_;
};

} // namespace candelabra::app
