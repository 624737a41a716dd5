// SPDX-License-Identifier: Apache-2.0
// A window with its device and swapchain and two frames in flight, as every renderer has.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "host.hpp"

struct GLFWwindow;

constexpr uint32_t framesInFlight = 2;

// Layout, stage and access of images at the places where they are used.
constexpr ImageUse storageInCompute{VK_IMAGE_LAYOUT_GENERAL, VK_PIPELINE_STAGE_2_COMPUTE_SHADER_BIT,
                                    VK_ACCESS_2_SHADER_STORAGE_READ_BIT |
                                        VK_ACCESS_2_SHADER_STORAGE_WRITE_BIT};
constexpr ImageUse blitSource{VK_IMAGE_LAYOUT_TRANSFER_SRC_OPTIMAL, VK_PIPELINE_STAGE_2_BLIT_BIT,
                              VK_ACCESS_2_TRANSFER_READ_BIT};
constexpr ImageUse blitTarget{VK_IMAGE_LAYOUT_TRANSFER_DST_OPTIMAL, VK_PIPELINE_STAGE_2_BLIT_BIT,
                              VK_ACCESS_2_TRANSFER_WRITE_BIT};
constexpr ImageUse copySource{VK_IMAGE_LAYOUT_TRANSFER_SRC_OPTIMAL, VK_PIPELINE_STAGE_2_COPY_BIT,
                              VK_ACCESS_2_TRANSFER_READ_BIT};
constexpr ImageUse presented{VK_IMAGE_LAYOUT_PRESENT_SRC_KHR, VK_PIPELINE_STAGE_2_NONE, 0};

class Window
{
public:
    Window(const char* title, uint32_t width, uint32_t height);
    ~Window();
    Window(const Window&) = delete;
    Window& operator=(const Window&) = delete;

    const Host& host() const { return host_; }
    GLFWwindow* get() const { return window_; }
    VkExtent2D size() const { return size_; } // size of the swapchain in pixels
    VkFormat format() const { return format_; }
    uint32_t imageCount() const { return uint32_t(images_.size()); }

    struct Frame {
        VkCommandBuffer cmd; // recording has begun
        uint32_t slot;       // the GPU has finished the slot's previous frame
        uint32_t image;      // index in the swapchain
        HostImage target;    // that swapchain image as a HostImage; its contents are undefined when
                             // the frame begins
    };
    // Begins a frame. Returns nothing while the window has no area, or if its size has just
    // changed: ask size() again.
    std::optional<Frame> begin();
    // Submits and presents the frame; its target must be as `presented` says.
    void end(const Frame& frame);

    // Records a copy of the target, which must be as `copySource` says. end() of the same frame
    // waits for the copy and writes it as a PPM file.
    void copyTo(const Frame& frame, const std::string& file);

private:
    void createSwapchain();
    void destroyViews();
    void writeCopy();

    GLFWwindow* window_ = nullptr;
    Host host_{};
    VkSurfaceKHR surface_ = VK_NULL_HANDLE;
    VkSwapchainKHR swapchain_ = VK_NULL_HANDLE;
    VkFormat format_ = VK_FORMAT_UNDEFINED;
    VkExtent2D size_{};
    std::vector<HostImage> images_;
    std::vector<VkSemaphore> rendered_; // one per swapchain image
    struct Slot {
        VkCommandBuffer cmd;
        VkFence fence;
        VkSemaphore acquired;
    } slots_[framesInFlight]{};
    uint64_t frames_ = 0;
    bool stale_ = false; // the swapchain must be recreated

    std::string copyFile_; // empty: no copy is pending
    HostBuffer copy_{};
};
