// SPDX-License-Identifier: Apache-2.0
// Buffer and Image: rule-of-zero bundles of handles, each with its own memory, from the device or
// from the host's allocator.
#pragma once

#include <cstddef>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include "gpu/handle.h"

namespace candelabra::gpu
{

enum class MemoryUse {
    Device = CND_MEMORY_BUFFER,     // GPU only
    Scratch = CND_MEMORY_SCRATCH,   // GPU only; no recording needs what an earlier one left
    Upload = CND_MEMORY_UPLOAD,     // host writes once in order, GPU reads; mapped and coherent
    Readback = CND_MEMORY_READBACK, // GPU writes, host reads; mapped, coherent, perhaps cached
    Image = CND_MEMORY_IMAGE,       // GPU only
};

// Owner of the memory of one object.
class Memory
{
public:
    Memory() = default;
    // Throws Failure.
    Memory(const Device& device, const CndMemoryRequest& request);
    Memory(Memory&& other) noexcept { *this = std::move(other); }
    Memory& operator=(Memory&& other) noexcept
    {
        std::swap(device_, other.device_);
        std::swap(kind_, other.kind_);
        std::swap(size_, other.size_);
        std::swap(at_, other.at_);
        return *this;
    }
    ~Memory();
    VkDeviceMemory get() const { return at_.memory; }
    VkDeviceSize offset() const { return at_.offset; }
    std::byte* mapped() const { return static_cast<std::byte*>(at_.mapped); }

private:
    const Device* device_ = nullptr;
    CndMemoryKind kind_ = CND_MEMORY_BUFFER;
    VkDeviceSize size_ = 0;
    CndMemory at_{};
};

struct Buffer {
    // Members are destroyed in reverse order: the memory goes last.
    Memory memory;
    Handle<VkBuffer> buffer;
    Handle<VkBufferView> texels; // optional R32G32B32A32_SFLOAT view
    VkDeviceSize size = 0;
    std::byte* mapped = nullptr; // null for what is of the GPU only

    VkBuffer get() const { return buffer.get(); }
    template <typename T>
    std::span<T> as() const
    {
        return {reinterpret_cast<T*>(mapped), size_t(size / sizeof(T))};
    }
};

// `size` 0 is rounded up to 16 bytes so that every binding can always be written.
Buffer createBuffer(const Device& device, const std::string& name, VkDeviceSize size,
                    VkBufferUsageFlags usage, MemoryUse use);

// Adds a texel view over the first min(size, limit) bytes; needs UNIFORM_TEXEL_BUFFER usage.
void createTexelView(const Device& device, Buffer& buffer);

struct Image {
    Memory memory;
    Handle<VkImage> image;
    Handle<VkImageView> view;
    VkFormat format = VK_FORMAT_UNDEFINED;
    uint32_t width = 0, height = 0;
    uint32_t mipLevels = 1;
};

// 2D image, optimal tiling, one layer, with a view of all mip levels and the given aspect.
Image createImage(const Device& device, const std::string& name, VkFormat format, uint32_t width,
                  uint32_t height, VkImageUsageFlags usage, VkImageAspectFlags aspect,
                  uint32_t mipLevels = 1);

// R32G32B32A32_SFLOAT cube for sampling and for writing in compute.
struct CubeImage {
    Memory memory;
    Handle<VkImage> image;
    Handle<VkImageView> view;              // a cube, all mips
    std::vector<Handle<VkImageView>> mips; // each an array of six layers, for storage
};

// `size` texels a side.
CubeImage createCubeImage(const Device& device, const std::string& name, uint32_t size,
                          uint32_t mipLevels);

} // namespace candelabra::gpu
