// SPDX-License-Identifier: Apache-2.0
// VulkanContext creates a Vulkan device with one queue and hosts the engine's modules on it.
#pragma once

#include <functional>
#include <memory>
#include <mutex>
#include <string>

#include "candelabra/candelabra.h"
#include "gpu/device.h"
#include "render/vulkan_instance.h"

namespace candelabra::app
{

struct ContextOptions {
    std::string device; // `wanted` of chooseDevice
    Validation validation = Validation::Off;
    Presentation presentation = Presentation::Headless;
    // The function by which the engine finds Vulkan's functions.
    PFN_vkGetInstanceProcAddr engineFunctions = vkGetInstanceProcAddr;
};

class VulkanContext
{
public:
    // Throws UsageError, RunError or gpu::Failure.
    explicit VulkanContext(const ContextOptions& options);
    ~VulkanContext();
    VulkanContext(const VulkanContext&) = delete;
    VulkanContext& operator=(const VulkanContext&) = delete;

    const VulkanInstance& instance() const { return instance_; }
    const DeviceInfo& info() const { return info_; }
    // The description from which modules are created. It is valid as long as the context.
    const CndDeviceDesc& desc() const { return desc_; }
    const gpu::Device& device() const { return *gpu_; }
    // The queue does graphics, compute and transfers, and presentation with Presentation::Window.
    // Who uses it directly must know that no other thread uses it at the same time; the functions
    // below see to that themselves.
    VkQueue queue() const { return queue_; }
    uint32_t queueFamily() const { return queueFamily_; }
    uint32_t timestampValidBits() const { return timestampValidBits_; } // of the queue
    bool samplerAnisotropy() const { return samplerAnisotropy_; }

    // These functions use the queue. Several threads may call them at the same time.
    //
    // Submits to the queue. `what` is for the message if that fails.
    void submit(const VkSubmitInfo2& info, VkFence fence, const std::string& what) const;
    VkResult present(const VkPresentInfoKHR& info) const;
    // Lets `record` record commands, submits them, and waits until the GPU has finished them.
    void submitAndWait(const std::function<void(VkCommandBuffer)>& record) const;
    void waitIdle() const;
    // The same for destructors: what they destroy is gone from a lost device as well.
    void waitBeforeDestruction() const noexcept;

    // Destroys everything but instance() and its messages, among which the validation layers then
    // report leaks.
    void destroyDevice();

private:
    void createDevice();

    VulkanInstance instance_;
    DeviceInfo info_;
    VkDevice device_ = VK_NULL_HANDLE;
    VkQueue queue_ = VK_NULL_HANDLE;
    mutable std::mutex queueMutex_; // Vulkan lets one thread at a time use a queue
    uint32_t queueFamily_ = 0, timestampValidBits_ = 0;
    bool samplerAnisotropy_ = false;
    CndDeviceDesc desc_{};
    std::unique_ptr<gpu::Device> gpu_;
};

} // namespace candelabra::app
