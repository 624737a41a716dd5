// SPDX-License-Identifier: Apache-2.0
#include "render/edge_filter.h"

#include "candelabra_program_shaders.h"
#include "render/image_barrier.h"

namespace candelabra::app
{

EdgeFilter::EdgeFilter(const gpu::Device& device, PixelSize size, uint32_t framesInFlight)
    : device_(&device),
      size_(size),
      kernel_(device, spirv::edge_filter_comp),
      sets_(kernel_.createBindings(framesInFlight)),
      timer_(device, "edge filter", framesInFlight, true),
      input_(gpu::createImage(device, "display before the edge filter", VK_FORMAT_R8G8B8A8_UNORM,
                              size.width, size.height,
                              VK_IMAGE_USAGE_STORAGE_BIT | VK_IMAGE_USAGE_SAMPLED_BIT,
                              VK_IMAGE_ASPECT_COLOR_BIT))
{
}

VkImageView EdgeFilter::recordInput(VkCommandBuffer cmd) const
{
    constexpr ImageAccess filteredBefore{VK_PIPELINE_STAGE_2_COMPUTE_SHADER_BIT, VK_ACCESS_2_NONE,
                                         VK_IMAGE_LAYOUT_UNDEFINED};
    transition(cmd, input_.image.get(), filteredBefore, computeWrite);
    return input_.view.get();
}

void EdgeFilter::record(VkCommandBuffer cmd, uint32_t slot, VkImageView display)
{
    using gpu::Binding;
    timer_.begin(cmd, slot);
    transition(cmd, input_.image.get(), computeWrite, computeRead);
    sets_.write(slot, {Binding::sampled(gpu::EDGE_FILTER_INPUT, input_.view.get()),
                       Binding::storage(gpu::EDGE_FILTER_OUTPUT, display)});
    kernel_.dispatch({*device_, cmd, timer_, slot}, sets_.set(slot),
                     {.size = {size_.width, size_.height}},
                     gpu::divideUp(size_.width, gpu::EDGE_FILTER_GROUP),
                     gpu::divideUp(size_.height, gpu::EDGE_FILTER_ROWS));
}

} // namespace candelabra::app
