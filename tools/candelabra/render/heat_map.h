// SPDX-License-Identifier: Apache-2.0
// Heat maps: what finding and evaluating lights costs each pixel, in false colours with a legend.
#pragma once

#include "gpu/kernel.h"
#include "io/parse.h"
#include "shared/heat_map.h"

namespace candelabra::app
{

enum class HeatMap : uint32_t {
    None = 0,
    LightsPerPixel = gpu::HEAT_MAP_LISTED, // of the pixel's list
    Evaluated = gpu::HEAT_MAP_EVALUATED,   // turns of evaluation, waiting for neighbours included
    Efficiency = gpu::HEAT_MAP_EFFICIENCY, // lights that contribute, of those listed
    Class = gpu::HEAT_MAP_CLASS            // CndPixelClass
};
constexpr int heatMapCount = 5; // None included

class HeatMapPass
{
public:
    // `device` must outlive it.
    HeatMapPass(const gpu::Device& device, PixelSize size, uint32_t framesInFlight);

    VkImageView pairs() const { return pairs_.view.get(); }
    const gpu::Image& pairImage() const { return pairs_; } // GENERAL; may be copied from
    // Empties the pair image for the frame that is recorded next.
    void recordClear(VkCommandBuffer cmd) const;
    // Paints over the display image, which is in GENERAL; begins with a barrier for what compute
    // wrote.
    void record(VkCommandBuffer cmd, uint32_t slot, HeatMap which, VkImageView display);

private:
    struct Colours {
        gpu::Buffer buffer;
        glm::uvec2 legendSize{0};
    };

    const gpu::Device* device_;
    PixelSize size_;
    gpu::Kernel<gpu::HeatMapParams> kernel_;
    gpu::Bindings sets_;
    gpu::Image pairs_;
    Colours colours_[heatMapCount];
};

} // namespace candelabra::app
