// SPDX-License-Identifier: Apache-2.0
// Swapchain: the images of a window, and what it takes to draw into and present them.
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
    // Creates 8-bit UNORM images that can be blitted into and used by renderPass(). What is written
    // into them must be sRGB-encoded already. Throws RunError or gpu::Failure.
    Swapchain(const VulkanContext& context, const Window& window, uint32_t framesInFlight);
    ~Swapchain();
    Swapchain(const Swapchain&) = delete;
    Swapchain& operator=(const Swapchain&) = delete;

    // Creates the images again for the current size of the window, which must not be 0x0. Waits for
    // the GPU.
    void recreate();

    struct Target {
        uint32_t index;
        VkImage image;
        VkFramebuffer framebuffer;
        VkSemaphore acquired;  // signalled when the image may be written
        VkSemaphore presented; // to be signalled by the caller when the image is written
    };
    // Acquires the next image for the frame in flight `slot`. Empty if the window has changed: call
    // recreate() first.
    std::optional<Target> acquire(uint32_t slot);
    // Presents an image. Returns false if recreate() must be called before the next frame.
    bool present(const Target& target);

    PixelSize size() const { return size_; }
    VkFormat format() const { return format_; }
    uint32_t imageCount() const { return uint32_t(images_.size()); }
    uint32_t minImageCount() const { return minImageCount_; }
    bool readable() const { return readable_; } // the images can be copied from
    // A render pass with one colour attachment, which it loads in layout COLOR_ATTACHMENT_OPTIMAL
    // and leaves in PRESENT_SRC.
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
