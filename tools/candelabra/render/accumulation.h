// SPDX-License-Identifier: Apache-2.0
// Anti-aliasing: a frame is the mean of several frames, its samples, whose cameras are shifted by
// parts of a pixel. The mean of the display image is that of what the samples show (decision 59).
#pragma once

#include <glm/glm.hpp>

#include "candelabra/candelabra.h"
#include "gpu/kernel.h"
#include "io/parse.h"
#include "shared/accumulate.h"

namespace candelabra::app
{

struct FrameSample {
    uint32_t index = 0, count = 1;

    bool isLast() const { return index + 1 == count; }
    bool operator==(const FrameSample&) const = default;
};

// The largest number of samples of a frame.
constexpr uint32_t maxFrameSamples = 4096;
// The number of samples of a smooth picture, unless the user wants another: of the viewer's, and of
// a frame that `render` writes on a GPU.
constexpr uint32_t pictureSamples = 16;

// Returns where in its pixels a sample sees the scene, in pixels from their centres: a point of the
// Hammersley set (Hammersley 1960; Niederreiter 1992, p. 31). Any power of two of its points has
// equally many in all rectangles of that area. The only sample of a frame is at the centre.
glm::dvec2 sampleOffset(const FrameSample& sample);

// Shifts the image of a camera by that offset.
void shiftBySample(CndCamera& camera, const FrameSample& sample, PixelSize size);

class Accumulation
{
public:
    // `device` must outlive the pass.
    Accumulation(const gpu::Device& device, PixelSize size, uint32_t framesInFlight);

    // Discards what the image holds that receives the display image of a sample, and makes it
    // ready for the compute shader that writes it. Returns its view, which is R8G8B8A8_UNORM in
    // GENERAL.
    VkImageView recordInput(VkCommandBuffer cmd) const;
    // Adds radiance, which is in GENERAL, and that image to the sums of the samples before. The
    // last sample replaces radiance and display image by the means: of radiance, and of the light
    // of the samples' display images. Only then must `display` be in GENERAL; the samples before
    // leave it alone. `dither`: the display images are dithered. The recording begins with a
    // barrier that waits for what compute shaders wrote.
    void record(VkCommandBuffer cmd, uint32_t slot, const FrameSample& sample, VkImageView radiance,
                VkImageView display, bool dither);

private:
    const gpu::Device* device_;
    PixelSize size_;
    gpu::Kernel<gpu::AccumulateParams> kernel_;
    gpu::Bindings sets_;
    gpu::Image sample_, radianceSum_, displaySum_;
};

} // namespace candelabra::app
