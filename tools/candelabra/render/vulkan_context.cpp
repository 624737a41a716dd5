// SPDX-License-Identifier: Apache-2.0
#include "render/vulkan_context.h"

#include <vector>

#define GLFW_INCLUDE_NONE
#include <GLFW/glfw3.h>

#include "render/error.h"

namespace candelabra::app
{
namespace
{

uint32_t findQueueFamily(const VulkanInstance& instance, const DeviceInfo& device)
{
    uint32_t count = 0;
    vkGetPhysicalDeviceQueueFamilyProperties(device.handle, &count, nullptr);
    std::vector<VkQueueFamilyProperties> families(count);
    vkGetPhysicalDeviceQueueFamilyProperties(device.handle, &count, families.data());
    constexpr VkQueueFlags needed = VK_QUEUE_GRAPHICS_BIT | VK_QUEUE_COMPUTE_BIT;
    for (uint32_t i = 0; i < count; ++i) {
        if ((families[i].queueFlags & needed) != needed)
            continue;
        if (instance.presentation() == Presentation::Headless ||
            glfwGetPhysicalDevicePresentationSupport(instance.get(), device.handle, i))
            return i;
    }
    throw RunError("device " + device.name +
                   (instance.presentation() == Presentation::Headless
                        ? " has no queue for graphics and compute"
                        : " has no queue for graphics and compute that can present to this "
                          "display"));
}

} // namespace

VulkanContext::VulkanContext(const ContextOptions& options)
    : instance_(options.validation, options.presentation),
      info_(chooseDevice(instance_.devices(), options.device))
{
    queueFamily_ = findQueueFamily(instance_, info_);
    createDevice();
    vkGetDeviceQueue(device_, queueFamily_, 0, &queue_);
    desc_ = {.structSize = sizeof desc_,
             .instance = instance_.get(),
             .physicalDevice = info_.handle,
             .device = device_,
             .getInstanceProcAddr = vkGetInstanceProcAddr,
             .pipelineCache = VK_NULL_HANDLE,
             .allocationCallbacks = nullptr,
             .debugUtilsEnabled = instance_.debugUtils()};
    const VkCommandPoolCreateInfo pool{.sType = VK_STRUCTURE_TYPE_COMMAND_POOL_CREATE_INFO,
                                       .flags = VK_COMMAND_POOL_CREATE_TRANSIENT_BIT,
                                       .queueFamilyIndex = queueFamily_};
    try {
        gpu_ = std::make_unique<gpu::Device>(desc_);
        check(vkCreateCommandPool(device_, &pool, nullptr, &pool_), "creating a command pool");
        gpu_->name(VK_OBJECT_TYPE_COMMAND_POOL, pool_, "one-time commands");
        gpu_->name(VK_OBJECT_TYPE_QUEUE, queue_, "queue");
    } catch (...) {
        vkDestroyDevice(device_, nullptr);
        throw;
    }
}

VulkanContext::~VulkanContext()
{
    destroyDevice();
}

void VulkanContext::destroyDevice()
{
    if (!device_)
        return;
    vkDeviceWaitIdle(device_);
    vkDestroyCommandPool(device_, pool_, nullptr);
    gpu_.reset();
    vkDestroyDevice(device_, nullptr);
    device_ = VK_NULL_HANDLE;
}

void VulkanContext::createDevice()
{
    VkPhysicalDeviceFeatures available{};
    vkGetPhysicalDeviceFeatures(info_.handle, &available);
    samplerAnisotropy_ = available.samplerAnisotropy;

    VkPhysicalDeviceVulkan13Features core13{
        .sType = VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_VULKAN_1_3_FEATURES};
    VkPhysicalDeviceVulkan12Features core12{
        .sType = VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_VULKAN_1_2_FEATURES, .pNext = &core13};
    VkPhysicalDeviceFeatures2 features{.sType = VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_FEATURES_2,
                                       .pNext = &core12};
    cndRequireFeatures(&features.features, &core12, &core13);
    features.features.samplerAnisotropy = available.samplerAnisotropy;

    const float priority = 1.0f;
    const VkDeviceQueueCreateInfo queue{.sType = VK_STRUCTURE_TYPE_DEVICE_QUEUE_CREATE_INFO,
                                        .queueFamilyIndex = queueFamily_,
                                        .queueCount = 1,
                                        .pQueuePriorities = &priority};
    std::vector<const char*> extensions;
    if (instance_.presentation() == Presentation::Window)
        extensions.push_back(VK_KHR_SWAPCHAIN_EXTENSION_NAME);
    const VkDeviceCreateInfo info{.sType = VK_STRUCTURE_TYPE_DEVICE_CREATE_INFO,
                                  .pNext = &features,
                                  .queueCreateInfoCount = 1,
                                  .pQueueCreateInfos = &queue,
                                  .enabledExtensionCount = uint32_t(extensions.size()),
                                  .ppEnabledExtensionNames = extensions.data()};
    check(vkCreateDevice(info_.handle, &info, nullptr, &device_),
          "creating a device on " + info_.name);
}

void VulkanContext::submitAndWait(const std::function<void(VkCommandBuffer)>& record) const
{
    const VkCommandBufferAllocateInfo allocate{.sType =
                                                   VK_STRUCTURE_TYPE_COMMAND_BUFFER_ALLOCATE_INFO,
                                               .commandPool = pool_,
                                               .level = VK_COMMAND_BUFFER_LEVEL_PRIMARY,
                                               .commandBufferCount = 1};
    VkCommandBuffer cmd{};
    check(vkAllocateCommandBuffers(device_, &allocate, &cmd), "allocating a command buffer");
    struct Free {
        const VulkanContext& context;
        VkCommandBuffer cmd;
        ~Free() { vkFreeCommandBuffers(context.device_, context.pool_, 1, &cmd); }
    } free{*this, cmd};

    const VkCommandBufferBeginInfo begin{.sType = VK_STRUCTURE_TYPE_COMMAND_BUFFER_BEGIN_INFO,
                                         .flags = VK_COMMAND_BUFFER_USAGE_ONE_TIME_SUBMIT_BIT};
    check(vkBeginCommandBuffer(cmd, &begin), "beginning a command buffer");
    record(cmd);
    check(vkEndCommandBuffer(cmd), "ending a command buffer");
    const VkCommandBufferSubmitInfo cmdInfo{.sType = VK_STRUCTURE_TYPE_COMMAND_BUFFER_SUBMIT_INFO,
                                            .commandBuffer = cmd};
    const VkSubmitInfo2 submit{.sType = VK_STRUCTURE_TYPE_SUBMIT_INFO_2,
                               .commandBufferInfoCount = 1,
                               .pCommandBufferInfos = &cmdInfo};
    check(vkQueueSubmit2(queue_, 1, &submit, VK_NULL_HANDLE), "submitting to " + info_.name);
    check(vkQueueWaitIdle(queue_), "waiting for " + info_.name);
}

void VulkanContext::waitIdle() const
{
    check(vkDeviceWaitIdle(device_), "waiting for " + info_.name);
}

} // namespace candelabra::app
