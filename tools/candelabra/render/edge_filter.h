// SPDX-License-Identifier: Apache-2.0
// EdgeFilter smooths the edges of a display image that has one sample per pixel (decision 64).
#pragma once

#include "gpu/kernel.h"
#include "io/parse.h"
#include "shared/edge_filter.h"

namespace candelabra::app
{

class EdgeFilter
{
public:
    // `device` must outlive the filter.
    EdgeFilter(const gpu::Device& device, PixelSize size, uint32_t framesInFlight);

    // Discards what the input image holds, and makes it ready for the compute shader that writes
    // the display image to be filtered. Returns its view, which is R8G8B8A8_UNORM in GENERAL.
    VkImageView recordInput(VkCommandBuffer cmd) const;
    // Filters the input image into the display image, which is in GENERAL. The recording begins
    // with a barrier that waits for what compute shaders wrote.
    void record(VkCommandBuffer cmd, uint32_t slot, VkImageView display);

    // The time of the last frame in `slot`.
    const gpu::Timer& timer() const { return timer_; }

private:
    const gpu::Device* device_;
    PixelSize size_;
    gpu::Kernel<gpu::EdgeFilterParams> kernel_;
    gpu::Bindings sets_;
    gpu::Timer timer_;
    gpu::Image input_;
};

} // namespace candelabra::app
