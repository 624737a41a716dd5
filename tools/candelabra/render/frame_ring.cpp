// SPDX-License-Identifier: Apache-2.0
#include "render/frame_ring.h"

#include "render/check.h"

namespace candelabra::app
{

FrameRing::FrameRing(const VulkanContext& context, uint32_t slots)
    : context_(context), slots_(slots)
{
    try {
        for (Slot& slot : slots_)
            createSlot(slot);
    } catch (...) {
        destroy();
        throw;
    }
}

FrameRing::~FrameRing()
{
    context_.waitBeforeDestruction();
    destroy();
}

void FrameRing::createSlot(Slot& slot) const
{
    const VkDevice device = context_.desc().device;
    const VkCommandPoolCreateInfo pool{.sType = VK_STRUCTURE_TYPE_COMMAND_POOL_CREATE_INFO,
                                       .flags = VK_COMMAND_POOL_CREATE_TRANSIENT_BIT,
                                       .queueFamilyIndex = context_.queueFamily()};
    check(vkCreateCommandPool(device, &pool, nullptr, &slot.pool), "creating a command pool");
    const VkCommandBufferAllocateInfo allocate{.sType =
                                                   VK_STRUCTURE_TYPE_COMMAND_BUFFER_ALLOCATE_INFO,
                                               .commandPool = slot.pool,
                                               .level = VK_COMMAND_BUFFER_LEVEL_PRIMARY,
                                               .commandBufferCount = 1};
    check(vkAllocateCommandBuffers(device, &allocate, &slot.cmd), "allocating a command buffer");
    const VkFenceCreateInfo fence{.sType = VK_STRUCTURE_TYPE_FENCE_CREATE_INFO};
    check(vkCreateFence(device, &fence, nullptr, &slot.done), "creating a fence");
    const gpu::Device& names = context_.device();
    names.name(VK_OBJECT_TYPE_COMMAND_POOL, slot.pool, "frame commands");
    names.name(VK_OBJECT_TYPE_COMMAND_BUFFER, slot.cmd, "frame");
    names.name(VK_OBJECT_TYPE_FENCE, slot.done, "frame done");
}

void FrameRing::destroy() noexcept
{
    const VkDevice device = context_.desc().device;
    for (const Slot& slot : slots_) {
        vkDestroyFence(device, slot.done, nullptr);
        vkDestroyCommandPool(device, slot.pool, nullptr);
    }
}

FrameRing::Frame FrameRing::begin()
{
    Slot& slot = slots_[current_];
    const VkDevice device = context_.desc().device;
    const bool reused = slot.used;
    if (reused) {
        check(vkWaitForFences(device, 1, &slot.done, VK_TRUE, UINT64_MAX), "waiting for a frame");
        check(vkResetFences(device, 1, &slot.done), "resetting a fence");
        slot.used = false;
    }
    check(vkResetCommandPool(device, slot.pool, 0), "resetting a command pool");
    const VkCommandBufferBeginInfo info{.sType = VK_STRUCTURE_TYPE_COMMAND_BUFFER_BEGIN_INFO,
                                        .flags = VK_COMMAND_BUFFER_USAGE_ONE_TIME_SUBMIT_BIT};
    check(vkBeginCommandBuffer(slot.cmd, &info), "beginning a command buffer");
    return {slot.cmd, current_, reused};
}

void FrameRing::submit(VkSemaphore wait, VkSemaphore signal)
{
    Slot& slot = slots_[current_];
    check(vkEndCommandBuffer(slot.cmd), "ending a command buffer");
    const VkCommandBufferSubmitInfo cmd{.sType = VK_STRUCTURE_TYPE_COMMAND_BUFFER_SUBMIT_INFO,
                                        .commandBuffer = slot.cmd};
    const VkSemaphoreSubmitInfo waitInfo{.sType = VK_STRUCTURE_TYPE_SEMAPHORE_SUBMIT_INFO,
                                         .semaphore = wait,
                                         .stageMask =
                                             VK_PIPELINE_STAGE_2_COLOR_ATTACHMENT_OUTPUT_BIT |
                                             VK_PIPELINE_STAGE_2_ALL_TRANSFER_BIT};
    const VkSemaphoreSubmitInfo signalInfo{.sType = VK_STRUCTURE_TYPE_SEMAPHORE_SUBMIT_INFO,
                                           .semaphore = signal,
                                           .stageMask = VK_PIPELINE_STAGE_2_ALL_COMMANDS_BIT};
    const VkSubmitInfo2 info{.sType = VK_STRUCTURE_TYPE_SUBMIT_INFO_2,
                             .waitSemaphoreInfoCount = wait ? 1u : 0u,
                             .pWaitSemaphoreInfos = &waitInfo,
                             .commandBufferInfoCount = 1,
                             .pCommandBufferInfos = &cmd,
                             .signalSemaphoreInfoCount = signal ? 1u : 0u,
                             .pSignalSemaphoreInfos = &signalInfo};
    context_.submit(info, slot.done, "submitting a frame");
    slot.used = true;
    current_ = (current_ + 1) % slots();
}

bool FrameRing::waitFor(uint32_t slot, std::chrono::nanoseconds most) const
{
    if (!slots_[slot].used)
        return true;
    const VkResult result = vkWaitForFences(context_.desc().device, 1, &slots_[slot].done, VK_TRUE,
                                            uint64_t(most.count()));
    check(result == VK_TIMEOUT ? VK_SUCCESS : result, "waiting for a frame");
    return result == VK_SUCCESS;
}

void FrameRing::wait(uint32_t slot) const
{
    if (slots_[slot].used)
        check(vkWaitForFences(context_.desc().device, 1, &slots_[slot].done, VK_TRUE, UINT64_MAX),
              "waiting for a frame");
}

void FrameRing::wait() const
{
    for (uint32_t slot = 0; slot < slots(); ++slot)
        wait(slot);
}

} // namespace candelabra::app
