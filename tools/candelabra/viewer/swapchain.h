// SPDX-License-Identifier: Apache-2.0
// Swapchain: the images of a window.
#pragma once

#include <optional>
#include <vector>

#include "render/vulkan_context.h"
#include "viewer/window.h"

namespace candelabra::app
{

class Swapchain
{
public:
    // 8-bit UNORM images that take blits and a render pass; what is written into them is
    // sRGB-encoded already. Throws RunError or gpu::Failure.
    Swapchain(const VulkanContext& context, const Window& window, uint32_t framesInFlight);
    ~Swapchain();
    Swapchain(const Swapchain&) = delete;
    Swapchain& operator=(const Swapchain&) = delete;

    // For the window's new size, which must not be 0x0; waits for the GPU.
    void recreate();

    struct Target {
        uint32_t index;
        VkImage image;
        VkFramebuffer framebuffer;
        VkSemaphore acquired;  // the image may be written once this is signalled
        VkSemaphore presented; // signal this when it is written
    };
    // Empty: the window changed, recreate first.
    std::optional<Target> acquire(uint32_t slot);
    // False: recreate before the next frame.
    bool present(const Target& target);

    PixelSize size() const { return size_; }
    VkFormat format() const { return format_; }
    uint32_t imageCount() const { return uint32_t(images_.size()); }
    uint32_t minImageCount() const { return minImageCount_; }
    bool readable() const { return readable_; } // images can be copied from
    // One colour attachment that is loaded, from COLOR_ATTACHMENT_OPTIMAL to PRESENT_SRC.
    VkRenderPass renderPass() const { return renderPass_; }

private:
    void chooseFormat();
    void createRenderPass();
    void createImages(VkSwapchainKHR old);
    void createViews();
    void destroyImages() noexcept;
    void destroyAll() noexcept;
    VkSemaphore createSemaphore() const;

    const VulkanContext& context_;
    const Window& window_;
    VkSurfaceKHR surface_ = VK_NULL_HANDLE;
    VkSwapchainKHR swapchain_ = VK_NULL_HANDLE;
    VkRenderPass renderPass_ = VK_NULL_HANDLE;
    VkFormat format_ = VK_FORMAT_UNDEFINED;
    VkColorSpaceKHR colorSpace_ = VK_COLOR_SPACE_SRGB_NONLINEAR_KHR;
    PixelSize size_;
    uint32_t minImageCount_ = 2;
    bool readable_ = false;
    std::vector<VkImage> images_;
    std::vector<VkImageView> views_;
    std::vector<VkFramebuffer> framebuffers_;
    std::vector<VkSemaphore> presented_; // one per image
    std::vector<VkSemaphore> acquired_;  // one per frame in flight
};

} // namespace candelabra::app
