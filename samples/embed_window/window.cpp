// SPDX-License-Identifier: Apache-2.0
#include "window.h"

#include <algorithm>
#include <cstdio>
#include <cstdlib>
#include <utility>

#define GLFW_INCLUDE_NONE
#include <GLFW/glfw3.h>

namespace
{

[[noreturn]] void stop(const char* what)
{
    const char* reason = nullptr;
    glfwGetError(&reason);
    std::fprintf(stderr, "embed_window: %s%s%s\n", what, reason ? ": " : "", reason ? reason : "");
    std::exit(2);
}

VkSemaphore createSemaphore(VkDevice device)
{
    const VkSemaphoreCreateInfo info{.sType = VK_STRUCTURE_TYPE_SEMAPHORE_CREATE_INFO};
    VkSemaphore semaphore{};
    checkVulkan(vkCreateSemaphore(device, &info, nullptr, &semaphore), "creating a semaphore");
    return semaphore;
}

} // namespace

Window::Window(const char* title, uint32_t width, uint32_t height)
{
    if (!glfwInit())
        stop("there is no display");
    glfwWindowHint(GLFW_CLIENT_API, GLFW_NO_API);
    window_ = glfwCreateWindow(int(width), int(height), title, nullptr, nullptr);
    if (!window_)
        stop("cannot open a window");
    uint32_t count = 0;
    const char** const extensions = glfwGetRequiredInstanceExtensions(&count);
    if (!extensions)
        stop("Vulkan cannot show anything here");
    const char* const swapchain = VK_KHR_SWAPCHAIN_EXTENSION_NAME;
    createHostDevice(&host_, count, extensions, 1, &swapchain);
    checkVulkan(glfwCreateWindowSurface(host_.instance, window_, nullptr, &surface_),
                "creating the window's surface");
    VkBool32 supported = VK_FALSE;
    vkGetPhysicalDeviceSurfaceSupportKHR(host_.physicalDevice, host_.queueFamily, surface_,
                                         &supported);
    if (!supported)
        stop("the device cannot show anything in this window");

    for (Slot& slot : slots_) {
        const VkCommandBufferAllocateInfo buffer{.sType =
                                                     VK_STRUCTURE_TYPE_COMMAND_BUFFER_ALLOCATE_INFO,
                                                 .commandPool = host_.pool,
                                                 .commandBufferCount = 1};
        checkVulkan(vkAllocateCommandBuffers(host_.device, &buffer, &slot.cmd),
                    "allocating a command buffer");
        const VkFenceCreateInfo fence{.sType = VK_STRUCTURE_TYPE_FENCE_CREATE_INFO,
                                      .flags = VK_FENCE_CREATE_SIGNALED_BIT};
        checkVulkan(vkCreateFence(host_.device, &fence, nullptr, &slot.fence), "creating a fence");
        slot.acquired = createSemaphore(host_.device);
    }
    // A UNORM format, because Candelabra's display image is sRGB-encoded already.
    VkSurfaceFormatKHR formats[64];
    count = 64;
    vkGetPhysicalDeviceSurfaceFormatsKHR(host_.physicalDevice, surface_, &count, formats);
    for (uint32_t i = 0; i < count && format_ == VK_FORMAT_UNDEFINED; ++i)
        if (formats[i].format == VK_FORMAT_B8G8R8A8_UNORM ||
            formats[i].format == VK_FORMAT_R8G8B8A8_UNORM)
            format_ = formats[i].format;
    if (format_ == VK_FORMAT_UNDEFINED)
        stop("the window has no UNORM format of 8 bits");
    createSwapchain();
}

Window::~Window()
{
    vkDeviceWaitIdle(host_.device);
    destroyViews();
    vkDestroySwapchainKHR(host_.device, swapchain_, nullptr);
    for (const Slot& slot : slots_) {
        vkDestroySemaphore(host_.device, slot.acquired, nullptr);
        vkDestroyFence(host_.device, slot.fence, nullptr);
    }
    vkDestroySurfaceKHR(host_.instance, surface_, nullptr);
    destroyHostDevice(&host_);
    glfwDestroyWindow(window_);
    glfwTerminate();
}

void Window::destroyViews()
{
    for (const HostImage& image : images_)
        vkDestroyImageView(host_.device, image.view, nullptr);
    for (const VkSemaphore semaphore : rendered_)
        vkDestroySemaphore(host_.device, semaphore, nullptr);
    images_.clear();
    rendered_.clear();
}

void Window::createSwapchain()
{
    vkDeviceWaitIdle(host_.device);
    destroyViews();
    VkSurfaceCapabilitiesKHR can{};
    checkVulkan(vkGetPhysicalDeviceSurfaceCapabilitiesKHR(host_.physicalDevice, surface_, &can),
                "asking what the window can do");
    int width = 0, height = 0;
    glfwGetFramebufferSize(window_, &width, &height);
    size_ = can.currentExtent;
    if (size_.width == UINT32_MAX) // the program may choose the size
        size_ = {
            std::clamp(uint32_t(width), can.minImageExtent.width, can.maxImageExtent.width),
            std::clamp(uint32_t(height), can.minImageExtent.height, can.maxImageExtent.height)};
    const VkSwapchainKHR old = std::exchange(swapchain_, VkSwapchainKHR{});
    if (size_.width && size_.height) {
        const VkSwapchainCreateInfoKHR info{.sType = VK_STRUCTURE_TYPE_SWAPCHAIN_CREATE_INFO_KHR,
                                            .surface = surface_,
                                            .minImageCount = std::max(can.minImageCount, 2u),
                                            .imageFormat = format_,
                                            .imageColorSpace = VK_COLOR_SPACE_SRGB_NONLINEAR_KHR,
                                            .imageExtent = size_,
                                            .imageArrayLayers = 1,
                                            .imageUsage = VK_IMAGE_USAGE_TRANSFER_DST_BIT |
                                                          VK_IMAGE_USAGE_TRANSFER_SRC_BIT |
                                                          VK_IMAGE_USAGE_COLOR_ATTACHMENT_BIT,
                                            .preTransform = can.currentTransform,
                                            .compositeAlpha = VK_COMPOSITE_ALPHA_OPAQUE_BIT_KHR,
                                            .presentMode = VK_PRESENT_MODE_FIFO_KHR,
                                            .clipped = VK_TRUE,
                                            .oldSwapchain = old};
        checkVulkan(vkCreateSwapchainKHR(host_.device, &info, nullptr, &swapchain_),
                    "creating the swapchain");
    }
    vkDestroySwapchainKHR(host_.device, old, nullptr);
    stale_ = !swapchain_;
    if (stale_)
        return;
    uint32_t count = 0;
    vkGetSwapchainImagesKHR(host_.device, swapchain_, &count, nullptr);
    std::vector<VkImage> images(count);
    vkGetSwapchainImagesKHR(host_.device, swapchain_, &count, images.data());
    for (const VkImage image : images) {
        const VkImageViewCreateInfo view{
            .sType = VK_STRUCTURE_TYPE_IMAGE_VIEW_CREATE_INFO,
            .image = image,
            .viewType = VK_IMAGE_VIEW_TYPE_2D,
            .format = format_,
            .subresourceRange = {VK_IMAGE_ASPECT_COLOR_BIT, 0, 1, 0, 1}};
        images_.push_back({.image = image, .format = format_, .aspect = VK_IMAGE_ASPECT_COLOR_BIT});
        checkVulkan(vkCreateImageView(host_.device, &view, nullptr, &images_.back().view),
                    "viewing a window image");
        rendered_.push_back(createSemaphore(host_.device));
    }
}

std::optional<Window::Frame> Window::begin()
{
    glfwPollEvents();
    int width = 0, height = 0; // drivers may report a new size late
    glfwGetFramebufferSize(window_, &width, &height);
    if (stale_ || uint32_t(width) != size_.width || uint32_t(height) != size_.height) {
        createSwapchain();
        return {};
    }
    const uint32_t slotIndex = uint32_t(frames_ % framesInFlight);
    const Slot& slot = slots_[slotIndex];
    checkVulkan(vkWaitForFences(host_.device, 1, &slot.fence, VK_TRUE, UINT64_MAX),
                "waiting for a frame");
    uint32_t image = 0;
    const VkResult acquired = vkAcquireNextImageKHR(host_.device, swapchain_, UINT64_MAX,
                                                    slot.acquired, VK_NULL_HANDLE, &image);
    if (acquired == VK_ERROR_OUT_OF_DATE_KHR) {
        stale_ = true;
        return {};
    }
    if (acquired != VK_SUBOPTIMAL_KHR) // show it as it is; end() marks the swapchain stale
        checkVulkan(acquired, "acquiring a window image");
    checkVulkan(vkResetFences(host_.device, 1, &slot.fence), "resetting a fence");
    const VkCommandBufferBeginInfo info{.sType = VK_STRUCTURE_TYPE_COMMAND_BUFFER_BEGIN_INFO,
                                        .flags = VK_COMMAND_BUFFER_USAGE_ONE_TIME_SUBMIT_BIT};
    checkVulkan(vkBeginCommandBuffer(slot.cmd, &info), "beginning a command buffer");
    return Frame{slot.cmd, slotIndex, image, images_[image]};
}

void Window::end(const Frame& frame)
{
    const Slot& slot = slots_[frame.slot];
    checkVulkan(vkEndCommandBuffer(frame.cmd), "ending a command buffer");
    // The blit is the first command that accesses the window's image.
    const VkPipelineStageFlags waitStage = VK_PIPELINE_STAGE_TRANSFER_BIT;
    const VkSubmitInfo submit{.sType = VK_STRUCTURE_TYPE_SUBMIT_INFO,
                              .waitSemaphoreCount = 1,
                              .pWaitSemaphores = &slot.acquired,
                              .pWaitDstStageMask = &waitStage,
                              .commandBufferCount = 1,
                              .pCommandBuffers = &frame.cmd,
                              .signalSemaphoreCount = 1,
                              .pSignalSemaphores = &rendered_[frame.image]};
    checkVulkan(vkQueueSubmit(host_.queue, 1, &submit, slot.fence), "submitting a frame");
    const VkPresentInfoKHR present{.sType = VK_STRUCTURE_TYPE_PRESENT_INFO_KHR,
                                   .waitSemaphoreCount = 1,
                                   .pWaitSemaphores = &rendered_[frame.image],
                                   .swapchainCount = 1,
                                   .pSwapchains = &swapchain_,
                                   .pImageIndices = &frame.image};
    const VkResult result = vkQueuePresentKHR(host_.queue, &present);
    stale_ = result == VK_ERROR_OUT_OF_DATE_KHR || result == VK_SUBOPTIMAL_KHR;
    if (!stale_)
        checkVulkan(result, "presenting a frame");
    ++frames_;
    if (!copyFile_.empty())
        writeCopy();
}

void Window::copyTo(const Frame& frame, const std::string& file)
{
    copyFile_ = file;
    copy_ = createHostBuffer(&host_, VkDeviceSize(size_.width) * size_.height * 4,
                             VK_BUFFER_USAGE_TRANSFER_DST_BIT);
    copyToHost(frame.cmd, &frame.target, {}, {size_.width, size_.height, 1}, &copy_);
}

void Window::writeCopy()
{
    vkDeviceWaitIdle(host_.device);
    const auto* texel = static_cast<const unsigned char*>(copy_.mapped);
    std::FILE* file = std::fopen(copyFile_.c_str(), "wb");
    if (!file)
        stop(("cannot write " + copyFile_).c_str());
    std::fprintf(file, "P6\n%u %u\n255\n", size_.width, size_.height);
    const bool blueFirst = format_ == VK_FORMAT_B8G8R8A8_UNORM;
    for (size_t i = 0; i < size_t(size_.width) * size_.height; ++i, texel += 4) {
        const unsigned char rgb[3] = {texel[blueFirst ? 2 : 0], texel[1], texel[blueFirst ? 0 : 2]};
        std::fwrite(rgb, 1, 3, file);
    }
    if (std::fclose(file) != 0)
        stop(("cannot write " + copyFile_).c_str());
    destroyHostBuffer(&host_, copy_);
    copyFile_.clear();
}
