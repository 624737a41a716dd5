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
    case MemoryUse::Scratch:
    case MemoryUse::Image:
        return {0, VK_MEMORY_PROPERTY_DEVICE_LOCAL_BIT};
    case MemoryUse::Upload:
        return {host, 0};
    case MemoryUse::Readback:
        return {host, VK_MEMORY_PROPERTY_HOST_CACHED_BIT};
    }
    return {};
}

CndMemoryRequest requestOf(const VkMemoryRequirements& needs, MemoryUse use,
                           const std::string& name)
{
    const MemoryFlags flags = flagsOf(use);
    return {.requirements = needs,
            .required = flags.required,
            .preferred = flags.preferred,
            .kind = CndMemoryKind(use),
            .name = name.c_str()};
}

std::string bytesFor(const CndMemoryRequest& request)
{
    return std::to_string(request.requirements.size) + " bytes for " + request.name;
}

bool isMapped(const CndMemoryRequest& request)
{
    return request.required & VK_MEMORY_PROPERTY_HOST_VISIBLE_BIT;
}

// Returns what is wrong with the memory that the host's allocator gave, or null.
const char* faultOf(const CndMemoryRequest& request, const CndMemory& given)
{
    if (!given.memory)
        return "no memory";
    if (request.requirements.alignment && given.offset % request.requirements.alignment)
        return "an offset that is no multiple of the alignment";
    if (isMapped(request) && !given.mapped)
        return "memory that is not mapped";
    return nullptr;
}

CndMemory fromHost(const CndAllocator& host, const CndMemoryRequest& request)
{
    CndMemory out{};
    const VkResult result = host.allocate(host.user, &request, &out);
    if (result != VK_SUCCESS)
        throw Failure{result < 0 ? resultOf(result) : CND_ERROR_OUT_OF_MEMORY, result,
                      "CndAllocator: allocate failed for " + bytesFor(request) + " (" +
                          resultName(result) + ")"};
    if (const char* fault = faultOf(request, out)) {
        host.free(host.user, out.allocation);
        failArgument(std::string("CndAllocator: allocate gave ") + fault + " for " + request.name);
    }
    return out;
}

void release(const Device& device, const CndMemory& memory)
{
    if (device.allocator.free)
        device.allocator.free(device.allocator.user, memory.allocation);
    else
        device.FreeMemory(device.handle, memory.memory, device.allocationCallbacks);
}

CndMemory fromDevice(const Device& device, const CndMemoryRequest& request)
{
    const VkMemoryRequirements& needs = request.requirements;
    const VkMemoryAllocateInfo info{.sType = VK_STRUCTURE_TYPE_MEMORY_ALLOCATE_INFO,
                                    .allocationSize = needs.size,
                                    .memoryTypeIndex = device.memoryType(
                                        needs.memoryTypeBits, request.required, request.preferred)};
    CndMemory out{};
    const VkResult allocated =
        device.AllocateMemory(device.handle, &info, device.allocationCallbacks, &out.memory);
    if (allocated < 0)
        check(allocated, "allocating ", bytesFor(request));
    try {
        device.name(VK_OBJECT_TYPE_DEVICE_MEMORY, out.memory,
                    std::string(request.name) + " memory");
        if (isMapped(request))
            check(device.MapMemory(device.handle, out.memory, 0, VK_WHOLE_SIZE, 0, &out.mapped),
                  "mapping ", request.name);
    } catch (...) {
        release(device, out);
        throw;
    }
    return out;
}

void bindImage(const Device& device, const std::string& name, const VkImageCreateInfo& info,
               Handle<VkImage>& image, Memory& memory)
{
    VkImage created{};
    check(device.CreateImage(device.handle, &info, device.allocationCallbacks, &created),
          "creating image ", name);
    image = Handle(device, created);
    VkMemoryRequirements needs{};
    device.GetImageMemoryRequirements(device.handle, created, &needs);
    CndMemoryRequest request = requestOf(needs, MemoryUse::Image, name);
    request.image = created;
    memory = Memory(device, request);
    check(device.BindImageMemory(device.handle, created, memory.get(), memory.offset()),
          "binding memory of image ", name);
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
          "creating a view of image ", name);
    Handle<VkImageView> owner(device, view);
    device.name(VK_OBJECT_TYPE_IMAGE_VIEW, view, name);
    return owner;
}

} // namespace

Memory::Memory(const Device& device, const CndMemoryRequest& request)
    : device_(&device),
      kind_(request.kind),
      size_(request.requirements.size),
      at_(device.allocator.allocate ? fromHost(device.allocator, request)
                                    : fromDevice(device, request))
{
    const std::lock_guard lock(device.usageMutex);
    CndMemoryUsage& usage = device.usage;
    VkDeviceSize& alignment = usage.alignment[kind_];
    uint32_t& types = usage.memoryTypeBits[kind_];
    const VkMemoryRequirements& needs = request.requirements;
    types = alignment ? types & needs.memoryTypeBits : needs.memoryTypeBits;
    alignment = std::max(alignment, needs.alignment);
    ++usage.allocations[kind_];
    usage.bytes[kind_] += size_;
}

Memory::~Memory()
{
    if (!at_.memory)
        return;
    {
        const std::lock_guard lock(device_->usageMutex);
        --device_->usage.allocations[kind_];
        device_->usage.bytes[kind_] -= size_;
    }
    release(*device_, at_);
}

Buffer createBuffer(const Device& device, const std::string& name, VkDeviceSize size,
                    VkBufferUsageFlags usage, MemoryUse use)
{
    Buffer result;
    result.size = std::max<VkDeviceSize>(size, 16);
    const VkBufferCreateInfo info{
        .sType = VK_STRUCTURE_TYPE_BUFFER_CREATE_INFO, .size = result.size, .usage = usage};
    VkBuffer buffer{};
    check(device.CreateBuffer(device.handle, &info, device.allocationCallbacks, &buffer),
          "creating buffer ", name);
    result.buffer = Handle(device, buffer);
    VkMemoryRequirements needs{};
    device.GetBufferMemoryRequirements(device.handle, buffer, &needs);
    CndMemoryRequest request = requestOf(needs, use, name);
    request.buffer = buffer;
    result.memory = Memory(device, request);
    result.mapped = isMapped(request) ? result.memory.mapped() : nullptr;
    check(
        device.BindBufferMemory(device.handle, buffer, result.memory.get(), result.memory.offset()),
        "binding memory of buffer ", name);
    device.name(VK_OBJECT_TYPE_BUFFER, buffer, name);
    return result;
}

void createTexelView(const Device& device, Buffer& buffer, VkFormat format, VkDeviceSize texelBytes)
{
    const VkDeviceSize texels =
        std::min<VkDeviceSize>(buffer.size / texelBytes, device.limits.maxTexelBufferElements);
    const VkBufferViewCreateInfo info{.sType = VK_STRUCTURE_TYPE_BUFFER_VIEW_CREATE_INFO,
                                      .buffer = buffer.get(),
                                      .format = format,
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
                                 .usage = VK_IMAGE_USAGE_STORAGE_BIT | VK_IMAGE_USAGE_SAMPLED_BIT |
                                          VK_IMAGE_USAGE_TRANSFER_SRC_BIT |
                                          VK_IMAGE_USAGE_TRANSFER_DST_BIT};
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
