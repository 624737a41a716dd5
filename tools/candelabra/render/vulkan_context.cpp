// SPDX-License-Identifier: Apache-2.0
#include "render/vulkan_context.h"

#include <malloc.h>
#include <vector>

#define GLFW_INCLUDE_NONE
#include <GLFW/glfw3.h>

#include "io/error.h"
#include "render/check.h"

namespace candelabra::app
{
namespace
{

std::vector<VkQueueFamilyProperties> queueFamilies(const DeviceInfo& device)
{
    uint32_t count = 0;
    vkGetPhysicalDeviceQueueFamilyProperties(device.handle, &count, nullptr);
    std::vector<VkQueueFamilyProperties> families(count);
    vkGetPhysicalDeviceQueueFamilyProperties(device.handle, &count, families.data());
    return families;
}

uint32_t findQueueFamily(const VulkanInstance& instance, const DeviceInfo& device)
{
    const std::vector<VkQueueFamilyProperties> families = queueFamilies(device);
    constexpr VkQueueFlags needed = VK_QUEUE_GRAPHICS_BIT | VK_QUEUE_COMPUTE_BIT;
    for (uint32_t i = 0; i < families.size(); ++i) {
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

// A driver that draws on the CPU allocates many megabytes for every pass that draws triangles, and
// frees them after it. By default the C library returns them to the system each time, and the next
// pass waits for page faults.
void keepFreedMemory()
{
#ifdef __GLIBC__
    constexpr int kept = 512 << 20, largestKept = 32 << 20; // bytes
    mallopt(M_TRIM_THRESHOLD, kept);
    mallopt(M_MMAP_THRESHOLD, largestKept);
#endif
}

// Some drivers compile a pipeline again each time that it is created, unless they find it in a
// cache. Null if there is no room for one.
VkPipelineCache createPipelineCache(VkDevice device)
{
    const VkPipelineCacheCreateInfo info{.sType = VK_STRUCTURE_TYPE_PIPELINE_CACHE_CREATE_INFO};
    VkPipelineCache cache{};
    return vkCreatePipelineCache(device, &info, nullptr, &cache) == VK_SUCCESS ? cache
                                                                               : VK_NULL_HANDLE;
}

} // namespace

VulkanContext::VulkanContext(const ContextOptions& options)
    : instance_(options.validation, options.presentation),
      info_(chooseDevice(instance_.devices(), options.device))
{
    if (info_.type == VK_PHYSICAL_DEVICE_TYPE_CPU)
        keepFreedMemory();
    queueFamily_ = findQueueFamily(instance_, info_);
    timestampValidBits_ = queueFamilies(info_)[queueFamily_].timestampValidBits;
    createDevice();
    vkGetDeviceQueue(device_, queueFamily_, 0, &queue_);
    desc_ = {.structSize = sizeof desc_,
             .instance = instance_.get(),
             .physicalDevice = info_.handle,
             .device = device_,
             .getInstanceProcAddr = options.engineFunctions,
             .pipelineCache = createPipelineCache(device_),
             .allocationCallbacks = nullptr,
             .debugUtilsEnabled = instance_.debugUtils()};
    try {
        gpu_ = std::make_unique<gpu::Device>(desc_, gpu::allModules | gpu::rasterPass);
        gpu_->name(VK_OBJECT_TYPE_QUEUE, queue_, "queue");
    } catch (...) {
        vkDestroyPipelineCache(device_, desc_.pipelineCache, nullptr);
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
    waitBeforeDestruction();
    gpu_.reset();
    vkDestroyPipelineCache(device_, desc_.pipelineCache, nullptr);
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
    gpu::requireFeatures(features, gpu::allModules | gpu::rasterPass);
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

void VulkanContext::submit(const VkSubmitInfo2& info, VkFence fence, const std::string& what) const
{
    const std::lock_guard lock(queueMutex_);
    check(vkQueueSubmit2(queue_, 1, &info, fence), what);
}

VkResult VulkanContext::present(const VkPresentInfoKHR& info) const
{
    const std::lock_guard lock(queueMutex_);
    return vkQueuePresentKHR(queue_, &info);
}

namespace
{

// The objects that one call of submitAndWait needs. A command pool belongs to one thread at a time.
struct OneTimeCommands {
    VkDevice device;
    VkCommandPool pool = VK_NULL_HANDLE;
    VkCommandBuffer cmd = VK_NULL_HANDLE;
    VkFence done = VK_NULL_HANDLE;

    explicit OneTimeCommands(VkDevice d) : device(d) {}
    OneTimeCommands(const OneTimeCommands&) = delete;
    ~OneTimeCommands()
    {
        vkDestroyFence(device, done, nullptr);
        vkDestroyCommandPool(device, pool, nullptr);
    }
};

} // namespace

void VulkanContext::submitAndWait(const std::function<void(VkCommandBuffer)>& record) const
{
    OneTimeCommands once(device_);
    const VkCommandPoolCreateInfo pool{.sType = VK_STRUCTURE_TYPE_COMMAND_POOL_CREATE_INFO,
                                       .flags = VK_COMMAND_POOL_CREATE_TRANSIENT_BIT,
                                       .queueFamilyIndex = queueFamily_};
    check(vkCreateCommandPool(device_, &pool, nullptr, &once.pool), "creating a command pool");
    gpu_->name(VK_OBJECT_TYPE_COMMAND_POOL, once.pool, "one-time commands");
    const VkCommandBufferAllocateInfo allocate{.sType =
                                                   VK_STRUCTURE_TYPE_COMMAND_BUFFER_ALLOCATE_INFO,
                                               .commandPool = once.pool,
                                               .level = VK_COMMAND_BUFFER_LEVEL_PRIMARY,
                                               .commandBufferCount = 1};
    check(vkAllocateCommandBuffers(device_, &allocate, &once.cmd), "allocating a command buffer");
    const VkFenceCreateInfo fence{.sType = VK_STRUCTURE_TYPE_FENCE_CREATE_INFO};
    check(vkCreateFence(device_, &fence, nullptr, &once.done), "creating a fence");

    const VkCommandBufferBeginInfo begin{.sType = VK_STRUCTURE_TYPE_COMMAND_BUFFER_BEGIN_INFO,
                                         .flags = VK_COMMAND_BUFFER_USAGE_ONE_TIME_SUBMIT_BIT};
    check(vkBeginCommandBuffer(once.cmd, &begin), "beginning a command buffer");
    record(once.cmd);
    check(vkEndCommandBuffer(once.cmd), "ending a command buffer");
    const VkCommandBufferSubmitInfo cmdInfo{.sType = VK_STRUCTURE_TYPE_COMMAND_BUFFER_SUBMIT_INFO,
                                            .commandBuffer = once.cmd};
    submit({.sType = VK_STRUCTURE_TYPE_SUBMIT_INFO_2,
            .commandBufferInfoCount = 1,
            .pCommandBufferInfos = &cmdInfo},
           once.done, "submitting to " + info_.name);
    check(vkWaitForFences(device_, 1, &once.done, VK_TRUE, UINT64_MAX),
          "waiting for " + info_.name);
}

void VulkanContext::waitIdle() const
{
    const std::lock_guard lock(queueMutex_);
    check(vkDeviceWaitIdle(device_), "waiting for " + info_.name);
}

void VulkanContext::waitBeforeDestruction() const noexcept
{
    const std::lock_guard lock(queueMutex_);
    vkDeviceWaitIdle(device_);
}

} // namespace candelabra::app
