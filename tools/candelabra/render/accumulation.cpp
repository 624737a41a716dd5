// SPDX-License-Identifier: Apache-2.0
#include "render/accumulation.h"

#include "candelabra_program_shaders.h"
#include "render/image_barrier.h"

namespace candelabra::app
{
namespace
{

// The digits of `index` in base 2, in reverse order behind the point.
double radicalInverse(uint32_t index)
{
    double out = 0, digit = 0.5;
    for (; index; index >>= 1, digit /= 2)
        out += index & 1 ? digit : 0;
    return out;
}

constexpr ImageAccess overwritten{VK_PIPELINE_STAGE_2_COMPUTE_SHADER_BIT,
                                  VK_ACCESS_2_SHADER_STORAGE_WRITE_BIT, VK_IMAGE_LAYOUT_UNDEFINED};

gpu::Image createStorage(const gpu::Device& device, const char* name, VkFormat format,
                         PixelSize size)
{
    return gpu::createImage(device, name, format, size.width, size.height,
                            VK_IMAGE_USAGE_STORAGE_BIT, VK_IMAGE_ASPECT_COLOR_BIT);
}

gpu::Image createSum(const gpu::Device& device, const char* name, PixelSize size)
{
    return createStorage(device, name, VK_FORMAT_R32G32B32A32_SFLOAT, size);
}

} // namespace

glm::dvec2 sampleOffset(const FrameSample& sample)
{
    // Both coordinates are in the middles of their intervals: of 1 / count, and of the finest that
    // the radical inverse of `count` numbers has.
    double finest = 1;
    while (finest * sample.count > 1)
        finest /= 2;
    return {(sample.index + 0.5) / sample.count - 0.5,
            radicalInverse(sample.index) + finest / 2 - 0.5};
}

void shiftBySample(CndCamera& camera, const FrameSample& sample, PixelSize size)
{
    if (sample.count == 1)
        return; // the matrix keeps its bits
    // The image is 2 wide and high in coordinates that are clip coordinates divided by w, the
    // fourth row. It moves the other way, so that the centre of a pixel is where the offset was.
    const glm::dvec2 shift = -2.0 * sampleOffset(sample) / glm::dvec2(size.width, size.height);
    for (int column = 0; column < 4; ++column) {
        float* c = camera.clipFromView + 4 * column;
        c[0] = float(c[0] + shift.x * c[3]);
        c[1] = float(c[1] + shift.y * c[3]);
    }
}

Accumulation::Accumulation(const gpu::Device& device, PixelSize size, uint32_t framesInFlight)
    : device_(&device),
      size_(size),
      kernel_(device, spirv::accumulate_comp),
      sets_(kernel_.createBindings(framesInFlight)),
      sample_(createStorage(device, "display of a sample", VK_FORMAT_R8G8B8A8_UNORM, size)),
      radianceSum_(createSum(device, "sum of radiance", size)),
      displaySum_(createSum(device, "sum of display", size))
{
}

VkImageView Accumulation::recordInput(VkCommandBuffer cmd) const
{
    transition(cmd, sample_.image.get(), overwritten, computeWrite);
    return sample_.view.get();
}

void Accumulation::record(VkCommandBuffer cmd, uint32_t slot, const FrameSample& sample,
                          VkImageView radiance, VkImageView display, bool dither)
{
    using gpu::Binding;
    // All bindings need an image in GENERAL, also in a dispatch that leaves one alone.
    const VkImageView mean = sample.isLast() ? display : sample_.view.get();
    if (sample.index == 0)
        for (const gpu::Image* sum : {&radianceSum_, &displaySum_})
            transition(cmd, sum->image.get(), overwritten, computeWrite);
    sets_.write(slot, {Binding::storage(gpu::ACCUMULATE_RADIANCE, radiance),
                       Binding::storage(gpu::ACCUMULATE_SAMPLE, sample_.view.get()),
                       Binding::storage(gpu::ACCUMULATE_RADIANCE_SUM, radianceSum_.view.get()),
                       Binding::storage(gpu::ACCUMULATE_DISPLAY_SUM, displaySum_.view.get()),
                       Binding::storage(gpu::ACCUMULATE_DISPLAY, mean)});
    gpu::Timer untimed;
    const gpu::Frame f{*device_, cmd, untimed, slot};
    const auto dispatch = [&](uint32_t count) {
        f.barrier();
        kernel_.dispatch(f, sets_.set(slot),
                         {.size = {size_.width, size_.height},
                          .offset = glm::vec2(sampleOffset(sample)),
                          .index = sample.index,
                          .count = count,
                          .dither = dither ? 1u : 0u},
                         gpu::divideUp(size_.width, gpu::ACCUMULATE_GROUP),
                         gpu::divideUp(size_.height, gpu::ACCUMULATE_GROUP));
    };
    dispatch(0);
    if (sample.isLast())
        dispatch(sample.count);
}

} // namespace candelabra::app
