// SPDX-License-Identifier: Apache-2.0
// FrameStamps: when the parts of a frame began on the GPU, one after another.
#pragma once

#include <vector>

#include "gpu/device.h"
#include "gpu/handle.h"

namespace candelabra::app
{

class FrameStamps
{
public:
    FrameStamps() = default; // does nothing
    // `validBits`: of timestamps of the queue that frames are submitted to; 0: there are none.
    FrameStamps(const gpu::Device& device, uint32_t validBits, uint32_t slots, uint32_t parts);

    // Outside render passes: begin(), then stamp() behind each part.
    void begin(VkCommandBuffer cmd, uint32_t slot);
    void stamp(VkCommandBuffer cmd, uint32_t slot);

    struct Times {
        double startMs = 0;         // on the device's clock
        std::vector<double> endsMs; // of the parts, since the start; empty without stamps
    };
    // Of a frame that the GPU has finished.
    Times read(uint32_t slot) const;
    uint32_t count(uint32_t slot) const { return slot < taken_.size() ? taken_[slot] : 0; }

private:
    const gpu::Device* device_ = nullptr;
    gpu::Handle<VkQueryPool> pool_;
    uint64_t mask_ = 0;
    uint32_t perSlot_ = 0;
    std::vector<uint32_t> taken_;
};

} // namespace candelabra::app
