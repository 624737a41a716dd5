// SPDX-License-Identifier: Apache-2.0
#include "gpu/memory.h"

#include <algorithm>

namespace candelabra::gpu
{
namespace
{

struct MemoryFlags {
    VkMemoryPropertyFlags required, preferred;
};

MemoryFlags flagsOf(MemoryUse use)
{
    constexpr VkMemoryPropertyFlags host =
        VK_MEMORY_PROPERTY_HOST_VISIBLE_BIT | VK_MEMORY_PROPERTY_HOST_COHERENT_BIT;
    switch (use) {
    case MemoryUse::Device:
        return {0, VK_MEMORY_PROPERTY_DEVICE_LOCAL_BIT};
    case MemoryUse::Upload:
        return {host, 0};
    case MemoryUse::Readback:
        return {host, VK_MEMORY_PROPERTY_HOST_CACHED_BIT};
    }
    return {};
}

Handle<VkDeviceMemory> allocate(const Device& device, const VkMemoryRequirements& needs,
                                MemoryUse use, const std::string& name)
{
    const MemoryFlags flags = flagsOf(use);
    const VkMemoryAllocateInfo info{.sType = VK_STRUCTURE_TYPE_MEMORY_ALLOCATE_INFO,
                                    .allocationSize = needs.size,
                                    .memoryTypeIndex = device.memoryType(
                                        needs.memoryTypeBits, flags.required, flags.preferred)};
    VkDeviceMemory memory{};
    check(device.AllocateMemory(device.handle, &info, device.allocationCallbacks, &memory),
          "allocating " + std::to_string(needs.size) + " bytes for " + name);
    Handle<VkDeviceMemory> owner(device, memory);
    device.name(VK_OBJECT_TYPE_DEVICE_MEMORY, memory, name + " memory");
    return owner;
}

void bindImage(const Device& device, const std::string& name, const VkImageCreateInfo& info,
               Handle<VkImage>& image, Handle<VkDeviceMemory>& memory)
{
    VkImage created{};
    check(device.CreateImage(device.handle, &info, device.allocationCallbacks, &created),
          "creating image " + name);
    image = Handle(device, created);
    VkMemoryRequirements needs{};
    device.GetImageMemoryRequirements(device.handle, created, &needs);
    memory = allocate(device, needs, MemoryUse::Device, name);
    check(device.BindImageMemory(device.handle, created, memory.get(), 0),
          "binding memory of image " + name);
    device.name(VK_OBJECT_TYPE_IMAGE, created, name);
}

Handle<VkImageView> createView(const Device& device, const std::string& name, VkImage image,
                               VkImageViewType type, VkFormat format,
                               const VkImageSubresourceRange& range)
{
    const VkImageViewCreateInfo info{.sType = VK_STRUCTURE_TYPE_IMAGE_VIEW_CREATE_INFO,
                                     .image = image,
                                     .viewType = type,
                                     .format = format,
                                     .subresourceRange = range};
    VkImageView view{};
    check(device.CreateImageView(device.handle, &info, device.allocationCallbacks, &view),
          "creating a view of image " + name);
    Handle<VkImageView> owner(device, view);
    device.name(VK_OBJECT_TYPE_IMAGE_VIEW, view, name);
    return owner;
}

} // namespace

Buffer createBuffer(const Device& device, const std::string& name, VkDeviceSize size,
                    VkBufferUsageFlags usage, MemoryUse use)
{
    Buffer result;
    result.size = std::max<VkDeviceSize>(size, 16);
    const VkBufferCreateInfo info{
        .sType = VK_STRUCTURE_TYPE_BUFFER_CREATE_INFO, .size = result.size, .usage = usage};
    VkBuffer buffer{};
    check(device.CreateBuffer(device.handle, &info, device.allocationCallbacks, &buffer),
          "creating buffer " + name);
    result.buffer = Handle(device, buffer);
    VkMemoryRequirements needs{};
    device.GetBufferMemoryRequirements(device.handle, buffer, &needs);
    result.memory = allocate(device, needs, use, name);
    check(device.BindBufferMemory(device.handle, buffer, result.memory.get(), 0),
          "binding memory of buffer " + name);
    device.name(VK_OBJECT_TYPE_BUFFER, buffer, name);
    if (use != MemoryUse::Device) {
        void* data = nullptr;
        check(device.MapMemory(device.handle, result.memory.get(), 0, VK_WHOLE_SIZE, 0, &data),
              "mapping buffer " + name);
        result.mapped = static_cast<std::byte*>(data);
    }
    return result;
}

void createTexelView(const Device& device, Buffer& buffer)
{
    constexpr VkDeviceSize texelBytes = 16;
    const VkDeviceSize texels =
        std::min<VkDeviceSize>(buffer.size / texelBytes, device.limits.maxTexelBufferElements);
    const VkBufferViewCreateInfo info{.sType = VK_STRUCTURE_TYPE_BUFFER_VIEW_CREATE_INFO,
                                      .buffer = buffer.get(),
                                      .format = VK_FORMAT_R32G32B32A32_SFLOAT,
                                      .range = texels * texelBytes};
    VkBufferView view{};
    check(device.CreateBufferView(device.handle, &info, device.allocationCallbacks, &view),
          "creating a texel view");
    buffer.texels = Handle(device, view);
}

Image createImage(const Device& device, const std::string& name, VkFormat format, uint32_t width,
                  uint32_t height, VkImageUsageFlags usage, VkImageAspectFlags aspect,
                  uint32_t mipLevels)
{
    Image result;
    result.format = format;
    result.width = width;
    result.height = height;
    result.mipLevels = mipLevels;
    const VkImageCreateInfo info{.sType = VK_STRUCTURE_TYPE_IMAGE_CREATE_INFO,
                                 .imageType = VK_IMAGE_TYPE_2D,
                                 .format = format,
                                 .extent = {width, height, 1},
                                 .mipLevels = mipLevels,
                                 .arrayLayers = 1,
                                 .samples = VK_SAMPLE_COUNT_1_BIT,
                                 .tiling = VK_IMAGE_TILING_OPTIMAL,
                                 .usage = usage};
    bindImage(device, name, info, result.image, result.memory);
    result.view = createView(device, name, result.image.get(), VK_IMAGE_VIEW_TYPE_2D, format,
                             {aspect, 0, mipLevels, 0, 1});
    return result;
}

CubeImage createCubeImage(const Device& device, const std::string& name, uint32_t size,
                          uint32_t mipLevels)
{
    constexpr VkFormat format = VK_FORMAT_R32G32B32A32_SFLOAT;
    constexpr VkImageAspectFlags colour = VK_IMAGE_ASPECT_COLOR_BIT;
    constexpr uint32_t faces = 6;
    CubeImage result;
    const VkImageCreateInfo info{.sType = VK_STRUCTURE_TYPE_IMAGE_CREATE_INFO,
                                 .flags = VK_IMAGE_CREATE_CUBE_COMPATIBLE_BIT,
                                 .imageType = VK_IMAGE_TYPE_2D,
                                 .format = format,
                                 .extent = {size, size, 1},
                                 .mipLevels = mipLevels,
                                 .arrayLayers = faces,
                                 .samples = VK_SAMPLE_COUNT_1_BIT,
                                 .tiling = VK_IMAGE_TILING_OPTIMAL,
                                 .usage = VK_IMAGE_USAGE_STORAGE_BIT | VK_IMAGE_USAGE_SAMPLED_BIT};
    bindImage(device, name, info, result.image, result.memory);
    const VkImage image = result.image.get();
    result.view = createView(device, name, image, VK_IMAGE_VIEW_TYPE_CUBE, format,
                             {colour, 0, mipLevels, 0, faces});
    for (uint32_t mip = 0; mip < mipLevels; ++mip)
        result.mips.push_back(createView(device, name + " mip " + std::to_string(mip), image,
                                         VK_IMAGE_VIEW_TYPE_2D_ARRAY, format,
                                         {colour, mip, 1, 0, faces}));
    return result;
}

} // namespace candelabra::gpu
