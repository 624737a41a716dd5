// SPDX-License-Identifier: Apache-2.0
#include "host.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

static void stop(const char* what, int code)
{
    fprintf(stderr, "%s (%d)\n", what, code);
    exit(2);
}

void checkVulkan(VkResult result, const char* what)
{
    if (result != VK_SUCCESS)
        stop(what, result);
}

#define VK(call) checkVulkan((call), #call " failed")

// Returns the first device that has everything Candelabra needs.
static VkPhysicalDevice choosePhysicalDevice(VkInstance instance)
{
    VkPhysicalDevice devices[16];
    uint32_t count = 16;
    vkEnumeratePhysicalDevices(instance, &count, devices);
    for (uint32_t i = 0; i < count; ++i) {
        const CndDeviceDesc desc = {.structSize = sizeof desc,
                                    .instance = instance,
                                    .physicalDevice = devices[i],
                                    .getInstanceProcAddr = vkGetInstanceProcAddr};
        CndError error;
        if (cndCheckDevice(&desc, 0, &error) == CND_SUCCESS)
            return devices[i];
        fprintf(stderr, "device %u: %s\n", i, error.message);
    }
    stop("no Vulkan device that Candelabra can use", 0);
    return VK_NULL_HANDLE;
}

static uint32_t chooseQueueFamily(VkPhysicalDevice device)
{
    VkQueueFamilyProperties families[16];
    uint32_t count = 16;
    vkGetPhysicalDeviceQueueFamilyProperties(device, &count, families);
    for (uint32_t i = 0; i < count; ++i)
        if (families[i].queueFlags & VK_QUEUE_GRAPHICS_BIT)
            return i;
    stop("no graphics queue", 0);
    return 0;
}

void createHostDevice(Host* host, uint32_t instanceExtensionCount,
                      const char* const* instanceExtensions, uint32_t deviceExtensionCount,
                      const char* const* deviceExtensions)
{
    const VkApplicationInfo application = {.sType = VK_STRUCTURE_TYPE_APPLICATION_INFO,
                                           .apiVersion = VK_API_VERSION_1_3};
    const VkInstanceCreateInfo instance = {.sType = VK_STRUCTURE_TYPE_INSTANCE_CREATE_INFO,
                                           .pApplicationInfo = &application,
                                           .enabledExtensionCount = instanceExtensionCount,
                                           .ppEnabledExtensionNames = instanceExtensions};
    VK(vkCreateInstance(&instance, NULL, &host->instance));
    host->physicalDevice = choosePhysicalDevice(host->instance);
    host->queueFamily = chooseQueueFamily(host->physicalDevice);

    VkPhysicalDeviceVulkan13Features core13 = {
        .sType = VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_VULKAN_1_3_FEATURES};
    VkPhysicalDeviceVulkan12Features core12 = {
        .sType = VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_VULKAN_1_2_FEATURES, .pNext = &core13};
    VkPhysicalDeviceFeatures2 features = {.sType = VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_FEATURES_2,
                                          .pNext = &core12};
    cndRequireFeatures(0, &features, NULL);
    core13.dynamicRendering = core13.synchronization2 = VK_TRUE; // for the samples' own work
    const float priority = 1;
    const VkDeviceQueueCreateInfo queue = {.sType = VK_STRUCTURE_TYPE_DEVICE_QUEUE_CREATE_INFO,
                                           .queueFamilyIndex = host->queueFamily,
                                           .queueCount = 1,
                                           .pQueuePriorities = &priority};
    const VkDeviceCreateInfo device = {.sType = VK_STRUCTURE_TYPE_DEVICE_CREATE_INFO,
                                       .pNext = &features,
                                       .queueCreateInfoCount = 1,
                                       .pQueueCreateInfos = &queue,
                                       .enabledExtensionCount = deviceExtensionCount,
                                       .ppEnabledExtensionNames = deviceExtensions};
    VK(vkCreateDevice(host->physicalDevice, &device, NULL, &host->device));
    vkGetDeviceQueue(host->device, host->queueFamily, 0, &host->queue);

    const VkCommandPoolCreateInfo pool = {.sType = VK_STRUCTURE_TYPE_COMMAND_POOL_CREATE_INFO,
                                          .flags = VK_COMMAND_POOL_CREATE_RESET_COMMAND_BUFFER_BIT,
                                          .queueFamilyIndex = host->queueFamily};
    VK(vkCreateCommandPool(host->device, &pool, NULL, &host->pool));
    const VkCommandBufferAllocateInfo buffer = {.sType =
                                                    VK_STRUCTURE_TYPE_COMMAND_BUFFER_ALLOCATE_INFO,
                                                .commandPool = host->pool,
                                                .commandBufferCount = 1};
    VK(vkAllocateCommandBuffers(host->device, &buffer, &host->cmd));
}

void destroyHostDevice(Host* host)
{
    vkDestroyCommandPool(host->device, host->pool, NULL);
    vkDestroyDevice(host->device, NULL);
    vkDestroyInstance(host->instance, NULL);
}

static VkDeviceMemory allocateMemory(const Host* host, VkMemoryRequirements needs,
                                     VkMemoryPropertyFlags flags)
{
    VkPhysicalDeviceMemoryProperties memory;
    vkGetPhysicalDeviceMemoryProperties(host->physicalDevice, &memory);
    uint32_t type = 0;
    while (type < memory.memoryTypeCount &&
           (!(needs.memoryTypeBits >> type & 1) ||
            (memory.memoryTypes[type].propertyFlags & flags) != flags))
        ++type;
    if (type == memory.memoryTypeCount)
        stop("no memory type", (int)flags);
    const VkMemoryAllocateInfo info = {.sType = VK_STRUCTURE_TYPE_MEMORY_ALLOCATE_INFO,
                                       .allocationSize = needs.size,
                                       .memoryTypeIndex = type};
    VkDeviceMemory result;
    VK(vkAllocateMemory(host->device, &info, NULL, &result));
    return result;
}

HostBuffer createHostBuffer(const Host* host, VkDeviceSize size, VkBufferUsageFlags usage)
{
    HostBuffer result;
    const VkBufferCreateInfo info = {
        .sType = VK_STRUCTURE_TYPE_BUFFER_CREATE_INFO, .size = size, .usage = usage};
    VK(vkCreateBuffer(host->device, &info, NULL, &result.buffer));
    VkMemoryRequirements needs;
    vkGetBufferMemoryRequirements(host->device, result.buffer, &needs);
    result.memory = allocateMemory(
        host, needs, VK_MEMORY_PROPERTY_HOST_VISIBLE_BIT | VK_MEMORY_PROPERTY_HOST_COHERENT_BIT);
    VK(vkBindBufferMemory(host->device, result.buffer, result.memory, 0));
    VK(vkMapMemory(host->device, result.memory, 0, VK_WHOLE_SIZE, 0, &result.mapped));
    return result;
}

void destroyHostBuffer(const Host* host, HostBuffer buffer)
{
    vkDestroyBuffer(host->device, buffer.buffer, NULL);
    vkFreeMemory(host->device, buffer.memory, NULL);
}

HostImage createHostImage(const Host* host, VkFormat format, uint32_t width, uint32_t height,
                          VkImageUsageFlags usage)
{
    const int isDepth = format == VK_FORMAT_D32_SFLOAT || format == VK_FORMAT_D32_SFLOAT_S8_UINT;
    HostImage result = {.format = format,
                        .aspect = isDepth ? VK_IMAGE_ASPECT_DEPTH_BIT : VK_IMAGE_ASPECT_COLOR_BIT};
    const VkImageCreateInfo image = {.sType = VK_STRUCTURE_TYPE_IMAGE_CREATE_INFO,
                                     .imageType = VK_IMAGE_TYPE_2D,
                                     .format = format,
                                     .extent = {width, height, 1},
                                     .mipLevels = 1,
                                     .arrayLayers = 1,
                                     .samples = VK_SAMPLE_COUNT_1_BIT,
                                     .usage = usage | VK_IMAGE_USAGE_TRANSFER_DST_BIT |
                                              VK_IMAGE_USAGE_TRANSFER_SRC_BIT};
    VK(vkCreateImage(host->device, &image, NULL, &result.image));
    VkMemoryRequirements needs;
    vkGetImageMemoryRequirements(host->device, result.image, &needs);
    result.memory = allocateMemory(host, needs, 0);
    VK(vkBindImageMemory(host->device, result.image, result.memory, 0));
    const VkImageViewCreateInfo view = {.sType = VK_STRUCTURE_TYPE_IMAGE_VIEW_CREATE_INFO,
                                        .image = result.image,
                                        .viewType = VK_IMAGE_VIEW_TYPE_2D,
                                        .format = format,
                                        .subresourceRange = {result.aspect, 0, 1, 0, 1}};
    VK(vkCreateImageView(host->device, &view, NULL, &result.view));
    return result;
}

void destroyHostImage(const Host* host, HostImage image)
{
    vkDestroyImageView(host->device, image.view, NULL);
    vkDestroyImage(host->device, image.image, NULL);
    vkFreeMemory(host->device, image.memory, NULL);
}

static HostImage createImage(const Host* host, VkFormat format, VkImageUsageFlags usage)
{
    return createHostImage(host, format, host->width, host->height, usage);
}

#define NEAR_PLANE 0.1f // metres

Host createHost(uint32_t width, uint32_t height)
{
    Host host = {.width = width, .height = height};
    createHostDevice(&host, 0, NULL, 0, NULL);
    const VkImageUsageFlags sampled = VK_IMAGE_USAGE_SAMPLED_BIT;
    const VkImageUsageFlags storage = VK_IMAGE_USAGE_STORAGE_BIT;
    const VkImageUsageFlags drawn = sampled | VK_IMAGE_USAGE_COLOR_ATTACHMENT_BIT;
    host.normalRoughness = createImage(&host, VK_FORMAT_R32G32_UINT, drawn);
    host.albedo = createImage(&host, VK_FORMAT_R32G32_UINT, drawn);
    host.specular = createImage(&host, VK_FORMAT_R32G32_UINT, drawn);
    host.depth = createImage(&host, VK_FORMAT_D32_SFLOAT,
                             sampled | VK_IMAGE_USAGE_DEPTH_STENCIL_ATTACHMENT_BIT);
    host.radiance = createImage(&host, VK_FORMAT_R32G32B32A32_SFLOAT,
                                sampled | storage | VK_IMAGE_USAGE_COLOR_ATTACHMENT_BIT);
    host.display = createImage(&host, VK_FORMAT_R8G8B8A8_UNORM, storage);

    const float cotangent = 2; // cotangent of half the vertical field of view, which is 53 degrees
    for (int i = 0; i < 4; ++i)
        host.camera.viewFromWorld[5 * i] = 1;
    // Reversed depth with an infinite far plane: depth = near plane / distance.
    host.camera.clipFromView[0] = cotangent * (float)height / (float)width;
    host.camera.clipFromView[5] = -cotangent; // Vulkan's y points down
    host.camera.clipFromView[11] = -1;
    host.camera.clipFromView[14] = NEAR_PLANE;
    return host;
}

void destroyHost(Host* host)
{
    const HostImage images[] = {host->normalRoughness, host->albedo,   host->specular,
                                host->depth,           host->radiance, host->display};
    for (size_t i = 0; i < sizeof images / sizeof images[0]; ++i)
        destroyHostImage(host, images[i]);
    destroyHostDevice(host);
}

VkCommandBuffer beginFrame(Host* host)
{
    const VkCommandBufferBeginInfo info = {.sType = VK_STRUCTURE_TYPE_COMMAND_BUFFER_BEGIN_INFO,
                                           .flags = VK_COMMAND_BUFFER_USAGE_ONE_TIME_SUBMIT_BIT};
    VK(vkBeginCommandBuffer(host->cmd, &info));
    return host->cmd;
}

void endFrame(Host* host)
{
    VK(vkEndCommandBuffer(host->cmd));
    const VkSubmitInfo submit = {.sType = VK_STRUCTURE_TYPE_SUBMIT_INFO,
                                 .commandBufferCount = 1,
                                 .pCommandBuffers = &host->cmd};
    VK(vkQueueSubmit(host->queue, 1, &submit, VK_NULL_HANDLE));
    VK(vkQueueWaitIdle(host->queue));
}

void imageBarrier(VkCommandBuffer cmd, const HostImage* image, ImageUse from, ImageUse to)
{
    const VkImageMemoryBarrier2 barrier = {.sType = VK_STRUCTURE_TYPE_IMAGE_MEMORY_BARRIER_2,
                                           .srcStageMask = from.stage,
                                           .srcAccessMask = from.access,
                                           .dstStageMask = to.stage,
                                           .dstAccessMask = to.access,
                                           .oldLayout = from.layout,
                                           .newLayout = to.layout,
                                           .srcQueueFamilyIndex = VK_QUEUE_FAMILY_IGNORED,
                                           .dstQueueFamilyIndex = VK_QUEUE_FAMILY_IGNORED,
                                           .image = image->image,
                                           .subresourceRange = {image->aspect, 0, 1, 0, 1}};
    const VkDependencyInfo info = {.sType = VK_STRUCTURE_TYPE_DEPENDENCY_INFO,
                                   .imageMemoryBarrierCount = 1,
                                   .pImageMemoryBarriers = &barrier};
    vkCmdPipelineBarrier2(cmd, &info);
}

static const ImageUse undefined = {VK_IMAGE_LAYOUT_UNDEFINED, VK_PIPELINE_STAGE_2_NONE, 0};
static const ImageUse cleared = {VK_IMAGE_LAYOUT_TRANSFER_DST_OPTIMAL,
                                 VK_PIPELINE_STAGE_2_CLEAR_BIT, VK_ACCESS_2_TRANSFER_WRITE_BIT};
static const ImageUse sampledInCompute = {VK_IMAGE_LAYOUT_SHADER_READ_ONLY_OPTIMAL,
                                          VK_PIPELINE_STAGE_2_COMPUTE_SHADER_BIT,
                                          VK_ACCESS_2_SHADER_SAMPLED_READ_BIT};
static const ImageUse storageInCompute = {
    VK_IMAGE_LAYOUT_GENERAL, VK_PIPELINE_STAGE_2_COMPUTE_SHADER_BIT,
    VK_ACCESS_2_SHADER_STORAGE_READ_BIT | VK_ACCESS_2_SHADER_STORAGE_WRITE_BIT};

static void clearColour(VkCommandBuffer cmd, const HostImage* image, VkClearColorValue value,
                        ImageUse after)
{
    const VkImageSubresourceRange all = {image->aspect, 0, 1, 0, 1};
    imageBarrier(cmd, image, undefined, cleared);
    vkCmdClearColorImage(cmd, image->image, cleared.layout, &value, 1, &all);
    imageBarrier(cmd, image, cleared, after);
}

// All pixels are equal, so clears draw the wall. A real pass packs normals with lib/gbuffer.glsl.
void drawWall(Host* host)
{
    // The view-space normal (0, 0, 1) is (0, 0) in octahedral encoding; roughness 0x3FFFF is 1.
    const VkClearColorValue facing = {.uint32 = {0xFF800000u, 0xFF800000u}};
    const uint32_t half = WALL_ALBEDO_CODE; // red, green and blue
    const VkClearColorValue albedo = {.uint32 = {half | half << 21, half | half >> 11 << 21}};
    const VkClearColorValue zero = {.uint32 = {0}};
    clearColour(host->cmd, &host->normalRoughness, facing, sampledInCompute);
    clearColour(host->cmd, &host->albedo, albedo, sampledInCompute);
    clearColour(host->cmd, &host->specular, zero, sampledInCompute);
    clearColour(host->cmd, &host->radiance, zero, storageInCompute);
    imageBarrier(host->cmd, &host->display, undefined, storageInCompute);

    const VkClearDepthStencilValue depth = {.depth = NEAR_PLANE / WALL_DISTANCE};
    const VkImageSubresourceRange all = {host->depth.aspect, 0, 1, 0, 1};
    imageBarrier(host->cmd, &host->depth, undefined, cleared);
    vkCmdClearDepthStencilImage(host->cmd, host->depth.image, cleared.layout, &depth, 1, &all);
    imageBarrier(host->cmd, &host->depth, cleared, sampledInCompute);
}

void copyToHost(VkCommandBuffer cmd, const HostImage* image, VkOffset3D offset, VkExtent3D extent,
                const HostBuffer* buffer)
{
    const VkBufferImageCopy region = {
        .imageSubresource = {image->aspect, 0, 0, 1}, .imageOffset = offset, .imageExtent = extent};
    const VkMemoryBarrier2 toHost = {.sType = VK_STRUCTURE_TYPE_MEMORY_BARRIER_2,
                                     .srcStageMask = VK_PIPELINE_STAGE_2_COPY_BIT,
                                     .srcAccessMask = VK_ACCESS_2_TRANSFER_WRITE_BIT,
                                     .dstStageMask = VK_PIPELINE_STAGE_2_HOST_BIT,
                                     .dstAccessMask = VK_ACCESS_2_HOST_READ_BIT};
    const VkDependencyInfo dependency = {.sType = VK_STRUCTURE_TYPE_DEPENDENCY_INFO,
                                         .memoryBarrierCount = 1,
                                         .pMemoryBarriers = &toHost};
    vkCmdCopyImageToBuffer(cmd, image->image, VK_IMAGE_LAYOUT_TRANSFER_SRC_OPTIMAL, buffer->buffer,
                           1, &region);
    vkCmdPipelineBarrier2(cmd, &dependency);
}

static void readRegion(Host* host, const HostImage* image, ImageUse written, VkOffset3D offset,
                       VkExtent3D extent, void* pixels, size_t size)
{
    const HostBuffer buffer = createHostBuffer(host, size, VK_BUFFER_USAGE_TRANSFER_DST_BIT);
    const ImageUse copied = {VK_IMAGE_LAYOUT_TRANSFER_SRC_OPTIMAL, VK_PIPELINE_STAGE_2_COPY_BIT,
                             VK_ACCESS_2_TRANSFER_READ_BIT};
    beginFrame(host);
    imageBarrier(host->cmd, image, written, copied);
    copyToHost(host->cmd, image, offset, extent, &buffer);
    endFrame(host);
    memcpy(pixels, buffer.mapped, size);
    destroyHostBuffer(host, buffer);
}

void readPixels(Host* host, const HostImage* image, ImageUse written, void* pixels, size_t size)
{
    const VkOffset3D first = {0, 0, 0};
    const VkExtent3D all = {host->width, host->height, 1};
    readRegion(host, image, written, first, all, pixels, size);
}

void readCentre(Host* host, const HostImage* image, VkImageLayout layout, void* pixel, size_t size)
{
    const ImageUse written = {layout, VK_PIPELINE_STAGE_2_COMPUTE_SHADER_BIT,
                              VK_ACCESS_2_SHADER_STORAGE_WRITE_BIT};
    const VkOffset3D centre = {(int32_t)host->width / 2, (int32_t)host->height / 2, 0};
    const VkExtent3D one = {1, 1, 1};
    readRegion(host, image, written, centre, one, pixel, size);
}
