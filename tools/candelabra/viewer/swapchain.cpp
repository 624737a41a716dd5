// SPDX-License-Identifier: Apache-2.0
#include "viewer/swapchain.h"

#include <algorithm>

#define GLFW_INCLUDE_NONE
#include <GLFW/glfw3.h>

#include "io/error.h"
#include "render/check.h"

namespace candelabra::app
{

Swapchain::Swapchain(const VulkanContext& context, const Window& window, uint32_t framesInFlight)
    : context_(context), window_(window), acquired_(framesInFlight)
{
    check(glfwCreateWindowSurface(context.instance().get(), window.get(), nullptr, &surface_),
          "creating the window's surface");
    try {
        chooseFormat();
        createRenderPass();
        for (VkSemaphore& semaphore : acquired_)
            semaphore = createSemaphore();
        createImages(VK_NULL_HANDLE);
    } catch (...) {
        destroyAll();
        throw;
    }
}

Swapchain::~Swapchain()
{
    context_.waitBeforeDestruction();
    destroyAll();
}

void Swapchain::destroyAll() noexcept
{
    const VkDevice device = context_.desc().device;
    destroyImages();
    for (const VkSemaphore semaphore : acquired_)
        vkDestroySemaphore(device, semaphore, nullptr);
    vkDestroySwapchainKHR(device, swapchain_, nullptr);
    vkDestroyRenderPass(device, renderPass_, nullptr);
    vkDestroySurfaceKHR(context_.instance().get(), surface_, nullptr);
}

VkSemaphore Swapchain::createSemaphore() const
{
    const VkSemaphoreCreateInfo info{.sType = VK_STRUCTURE_TYPE_SEMAPHORE_CREATE_INFO};
    VkSemaphore semaphore{};
    check(vkCreateSemaphore(context_.desc().device, &info, nullptr, &semaphore),
          "creating a semaphore");
    context_.device().name(VK_OBJECT_TYPE_SEMAPHORE, semaphore, "window image");
    return semaphore;
}

void Swapchain::chooseFormat()
{
    uint32_t count = 0;
    const VkPhysicalDevice device = context_.info().handle;
    check(vkGetPhysicalDeviceSurfaceFormatsKHR(device, surface_, &count, nullptr),
          "listing the surface formats of the window");
    std::vector<VkSurfaceFormatKHR> formats(count);
    check(vkGetPhysicalDeviceSurfaceFormatsKHR(device, surface_, &count, formats.data()),
          "listing the surface formats of the window");
    for (const VkFormat wanted : {VK_FORMAT_B8G8R8A8_UNORM, VK_FORMAT_R8G8B8A8_UNORM})
        for (const VkSurfaceFormatKHR& f : formats)
            if (f.format == wanted && f.colorSpace == VK_COLOR_SPACE_SRGB_NONLINEAR_KHR) {
                format_ = f.format;
                colorSpace_ = f.colorSpace;
                return;
            }
    throw RunError("the window has no 8-bit UNORM format on " + context_.info().name);
}

void Swapchain::createRenderPass()
{
    const VkAttachmentDescription color{.format = format_,
                                        .samples = VK_SAMPLE_COUNT_1_BIT,
                                        .loadOp = VK_ATTACHMENT_LOAD_OP_LOAD,
                                        .storeOp = VK_ATTACHMENT_STORE_OP_STORE,
                                        .stencilLoadOp = VK_ATTACHMENT_LOAD_OP_DONT_CARE,
                                        .stencilStoreOp = VK_ATTACHMENT_STORE_OP_DONT_CARE,
                                        .initialLayout = VK_IMAGE_LAYOUT_COLOR_ATTACHMENT_OPTIMAL,
                                        .finalLayout = VK_IMAGE_LAYOUT_PRESENT_SRC_KHR};
    const VkAttachmentReference reference{0, VK_IMAGE_LAYOUT_COLOR_ATTACHMENT_OPTIMAL};
    const VkSubpassDescription subpass{.pipelineBindPoint = VK_PIPELINE_BIND_POINT_GRAPHICS,
                                       .colorAttachmentCount = 1,
                                       .pColorAttachments = &reference};
    // A copy for a screenshot, which may follow the pass, waits for the pass and for its transition
    // to the final layout.
    const VkSubpassDependency after{.srcSubpass = 0,
                                    .dstSubpass = VK_SUBPASS_EXTERNAL,
                                    .srcStageMask = VK_PIPELINE_STAGE_COLOR_ATTACHMENT_OUTPUT_BIT,
                                    .dstStageMask = VK_PIPELINE_STAGE_TRANSFER_BIT,
                                    .srcAccessMask = VK_ACCESS_COLOR_ATTACHMENT_WRITE_BIT,
                                    .dstAccessMask = VK_ACCESS_TRANSFER_READ_BIT};
    const VkRenderPassCreateInfo info{.sType = VK_STRUCTURE_TYPE_RENDER_PASS_CREATE_INFO,
                                      .attachmentCount = 1,
                                      .pAttachments = &color,
                                      .subpassCount = 1,
                                      .pSubpasses = &subpass,
                                      .dependencyCount = 1,
                                      .pDependencies = &after};
    check(vkCreateRenderPass(context_.desc().device, &info, nullptr, &renderPass_),
          "creating the overlay's render pass");
    context_.device().name(VK_OBJECT_TYPE_RENDER_PASS, renderPass_, "overlay");
}

void Swapchain::createImages(VkSwapchainKHR old)
{
    const VkDevice device = context_.desc().device;
    VkSurfaceCapabilitiesKHR caps{};
    check(vkGetPhysicalDeviceSurfaceCapabilitiesKHR(context_.info().handle, surface_, &caps),
          "querying the surface capabilities of the window");
    if (!(caps.supportedUsageFlags & VK_IMAGE_USAGE_TRANSFER_DST_BIT))
        throw RunError("the window's images cannot be copied into on " + context_.info().name);
    readable_ = caps.supportedUsageFlags & VK_IMAGE_USAGE_TRANSFER_SRC_BIT;
    const PixelSize window = window_.framebufferSize();
    // A surface that lets the swapchain choose the size reports a width of 0xFFFFFFFF.
    size_ = caps.currentExtent.width != UINT32_MAX
                ? PixelSize{caps.currentExtent.width, caps.currentExtent.height}
                : PixelSize{std::clamp(window.width, caps.minImageExtent.width,
                                       caps.maxImageExtent.width),
                            std::clamp(window.height, caps.minImageExtent.height,
                                       caps.maxImageExtent.height)};
    minImageCount_ = std::max(2u, caps.minImageCount);
    const uint32_t limit = caps.maxImageCount ? caps.maxImageCount : UINT32_MAX;
    VkImageUsageFlags usage = VK_IMAGE_USAGE_COLOR_ATTACHMENT_BIT | VK_IMAGE_USAGE_TRANSFER_DST_BIT;
    if (readable_)
        usage |= VK_IMAGE_USAGE_TRANSFER_SRC_BIT;
    const VkSwapchainCreateInfoKHR info{.sType = VK_STRUCTURE_TYPE_SWAPCHAIN_CREATE_INFO_KHR,
                                        .surface = surface_,
                                        .minImageCount = std::min(caps.minImageCount + 1, limit),
                                        .imageFormat = format_,
                                        .imageColorSpace = colorSpace_,
                                        .imageExtent = {size_.width, size_.height},
                                        .imageArrayLayers = 1,
                                        .imageUsage = usage,
                                        .imageSharingMode = VK_SHARING_MODE_EXCLUSIVE,
                                        .preTransform = caps.currentTransform,
                                        .compositeAlpha = VK_COMPOSITE_ALPHA_OPAQUE_BIT_KHR,
                                        .presentMode = VK_PRESENT_MODE_FIFO_KHR, // always supported
                                        .clipped = VK_TRUE,
                                        .oldSwapchain = old};
    check(vkCreateSwapchainKHR(device, &info, nullptr, &swapchain_), "creating the swapchain");
    vkDestroySwapchainKHR(device, old, nullptr);
    createViews();
}

void Swapchain::createViews()
{
    const VkDevice device = context_.desc().device;
    uint32_t count = 0;
    check(vkGetSwapchainImagesKHR(device, swapchain_, &count, nullptr), "listing window images");
    images_.resize(count);
    check(vkGetSwapchainImagesKHR(device, swapchain_, &count, images_.data()),
          "listing window images");
    for (const VkImage image : images_) {
        const VkImageViewCreateInfo view{
            .sType = VK_STRUCTURE_TYPE_IMAGE_VIEW_CREATE_INFO,
            .image = image,
            .viewType = VK_IMAGE_VIEW_TYPE_2D,
            .format = format_,
            .subresourceRange = {VK_IMAGE_ASPECT_COLOR_BIT, 0, 1, 0, 1}};
        views_.push_back({});
        check(vkCreateImageView(device, &view, nullptr, &views_.back()), "viewing a window image");
        const VkFramebufferCreateInfo framebuffer{.sType =
                                                      VK_STRUCTURE_TYPE_FRAMEBUFFER_CREATE_INFO,
                                                  .renderPass = renderPass_,
                                                  .attachmentCount = 1,
                                                  .pAttachments = &views_.back(),
                                                  .width = size_.width,
                                                  .height = size_.height,
                                                  .layers = 1};
        framebuffers_.push_back({});
        check(vkCreateFramebuffer(device, &framebuffer, nullptr, &framebuffers_.back()),
              "creating a framebuffer");
        presented_.push_back(createSemaphore());
        const gpu::Device& names = context_.device();
        names.name(VK_OBJECT_TYPE_IMAGE, image, "window");
        names.name(VK_OBJECT_TYPE_IMAGE_VIEW, views_.back(), "window");
        names.name(VK_OBJECT_TYPE_FRAMEBUFFER, framebuffers_.back(), "window");
    }
}

void Swapchain::destroyImages() noexcept
{
    const VkDevice device = context_.desc().device;
    for (const VkFramebuffer framebuffer : framebuffers_)
        vkDestroyFramebuffer(device, framebuffer, nullptr);
    for (const VkImageView view : views_)
        vkDestroyImageView(device, view, nullptr);
    for (const VkSemaphore semaphore : presented_)
        vkDestroySemaphore(device, semaphore, nullptr);
    framebuffers_.clear();
    views_.clear();
    presented_.clear();
    images_.clear();
}

void Swapchain::recreate()
{
    context_.waitIdle();
    destroyImages();
    createImages(std::exchange(swapchain_, VkSwapchainKHR{}));
}

std::optional<Swapchain::Target> Swapchain::acquire(uint32_t slot)
{
    uint32_t index = 0;
    const VkResult result = vkAcquireNextImageKHR(context_.desc().device, swapchain_, UINT64_MAX,
                                                  acquired_[slot], VK_NULL_HANDLE, &index);
    if (result == VK_ERROR_OUT_OF_DATE_KHR)
        return std::nullopt;
    check(result, "acquiring a window image");
    return Target{index, images_[index], framebuffers_[index], acquired_[slot], presented_[index]};
}

bool Swapchain::present(const Target& target)
{
    const VkPresentInfoKHR info{.sType = VK_STRUCTURE_TYPE_PRESENT_INFO_KHR,
                                .waitSemaphoreCount = 1,
                                .pWaitSemaphores = &target.presented,
                                .swapchainCount = 1,
                                .pSwapchains = &swapchain_,
                                .pImageIndices = &target.index};
    const VkResult result = context_.present(info);
    if (result == VK_ERROR_OUT_OF_DATE_KHR || result == VK_SUBOPTIMAL_KHR)
        return false;
    check(result, "presenting a window image");
    return true;
}

} // namespace candelabra::app
