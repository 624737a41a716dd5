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
    bool samplerAnisotropy() const { return samplerAnisotropy_; }

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
    uint32_t queueFamily_ = 0;
    bool samplerAnisotropy_ = false;
    VkCommandPool pool_ = VK_NULL_HANDLE;
    CndDeviceDesc desc_{};
    std::unique_ptr<gpu::Device> gpu_;
};

} // namespace candelabra::app
