// SPDX-License-Identifier: Apache-2.0
// A Vulkan device with one queue, as the host of the candelabra modules.
#pragma once

#include <functional>
#include <memory>
#include <string>

#include "candelabra/candelabra.h"
#include "gpu/device.h"
#include "render/vulkan_instance.h"

namespace candelabra::app
{

struct ContextOptions {
    std::string device; // as for chooseDevice
    Validation validation = Validation::Off;
    Presentation presentation = Presentation::Headless;
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
    // Valid as long as the context.
    const CndDeviceDesc& desc() const { return desc_; }
    const gpu::Device& device() const { return *gpu_; }
    VkQueue queue() const { return queue_; } // graphics, compute, transfer (and presentation)
    uint32_t queueFamily() const { return queueFamily_; }
    uint32_t timestampValidBits() const { return timestampValidBits_; } // of the queue
    bool samplerAnisotropy() const { return samplerAnisotropy_; }
    // Asks the device's timestamps and CLOCK_MONOTONIC at once, and the extension it is of; null
    // where the device cannot.
    PFN_vkGetCalibratedTimestampsEXT getCalibratedTimestamps() const
    {
        return getCalibratedTimestamps_;
    }
    const char* calibratedTimestampsExtension() const { return calibratedTimestamps_; }

    // Records with `record`, submits, and waits until the GPU has finished.
    void submitAndWait(const std::function<void(VkCommandBuffer)>& record) const;
    void waitIdle() const;

    // Ends the context's life but for instance() and its messages: leaks are reported there.
    void destroyDevice();

private:
    void createDevice();

    VulkanInstance instance_;
    DeviceInfo info_;
    VkDevice device_ = VK_NULL_HANDLE;
    VkQueue queue_ = VK_NULL_HANDLE;
    uint32_t queueFamily_ = 0, timestampValidBits_ = 0;
    bool samplerAnisotropy_ = false;
    const char* calibratedTimestamps_ = nullptr;
    PFN_vkGetCalibratedTimestampsEXT getCalibratedTimestamps_ = nullptr;
    VkCommandPool pool_ = VK_NULL_HANDLE;
    CndDeviceDesc desc_{};
    std::unique_ptr<gpu::Device> gpu_;
};

} // namespace candelabra::app
