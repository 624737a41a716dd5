// SPDX-License-Identifier: Apache-2.0
// Heat maps show in false colours, with a legend, what finding and evaluating lights costs each
// pixel.
#pragma once

#include "gpu/kernel.h"
#include "io/parse.h"
#include "shared/heat_map.h"

namespace candelabra::app
{

enum class HeatMap : uint32_t {
    None = 0,
    LightsPerPixel = gpu::HEAT_MAP_LISTED, // lights in the pixel's list
    // Lights evaluated, including loop turns in which the pixel waits for its neighbours.
    Evaluated = gpu::HEAT_MAP_EVALUATED,
    Efficiency = gpu::HEAT_MAP_EFFICIENCY, // the share of the listed lights that contribute
    PixelClass = gpu::HEAT_MAP_CLASS,      // CndPixelClass
    Shadow = gpu::HEAT_MAP_SHADOW          // how much the pixel sees of the lights; needs shadows
};
constexpr int heatMapCount = 6; // including None

// Returns the number of lights at the end of a scale, for 0 <= scale < gpu::HEAT_MAP_SCALES. The
// map of a frame has the smallest scale that holds 99% of its pixels with a surface, or else the
// last.
uint32_t heatMapScaleEnd(uint32_t scale);

class HeatMapPass
{
public:
    // `device` must outlive the pass.
    HeatMapPass(const gpu::Device& device, PixelSize size, uint32_t framesInFlight);

    // The target of CndLightingFrame::pairImage or, for HeatMap::Shadow, of its shadowImage.
    VkImageView pairs() const { return pairs_.view.get(); }
    const gpu::Image& pairImage() const { return pairs_; } // in GENERAL; may be copied from
    // Sets the pair image to 0 for the frame that is recorded next.
    void recordClear(VkCommandBuffer cmd) const;
    // Paints the heat map over the display image, which is in GENERAL. The recording begins with a
    // barrier that waits for what compute shaders wrote.
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
    gpu::Buffer counts_;
    Colours colours_[heatMapCount];
};

} // namespace candelabra::app
