// SPDX-License-Identifier: Apache-2.0
// Buffer and Image: Vulkan objects bundled with their own memory, which comes from the device or
// from the host's allocator. They follow the rule of zero.
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
    Device = CND_MEMORY_BUFFER,     // accessed by the GPU only
    Scratch = CND_MEMORY_SCRATCH,   // accessed by the GPU only; contents need not survive between
                                    // recordings
    Upload = CND_MEMORY_UPLOAD,     // written sequentially by the host, read by the GPU; mapped and
                                    // coherent
    Readback = CND_MEMORY_READBACK, // written by the GPU, read by the host; mapped, coherent,
                                    // cached if possible
    Image = CND_MEMORY_IMAGE,       // accessed by the GPU only
};

// Owner of the memory of one buffer or image.
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
    // The members are destroyed in reverse order, so that the memory is freed last.
    Memory memory;
    Handle<VkBuffer> buffer;
    Handle<VkBufferView> texels; // optional view
    VkDeviceSize size = 0;
    std::byte* mapped = nullptr; // null if only the GPU accesses the buffer

    VkBuffer get() const { return buffer.get(); }
    template <typename T>
    std::span<T> as() const
    {
        return {reinterpret_cast<T*>(mapped), size_t(size / sizeof(T))};
    }
};

// Creates a buffer of at least 16 bytes, so that even an empty one can be bound.
Buffer createBuffer(const Device& device, const std::string& name, VkDeviceSize size,
                    VkBufferUsageFlags usage, MemoryUse use);

// Adds a texel view of the buffer's first bytes, as many as maxTexelBufferElements allows.
// `texelBytes` is the size of a texel of the format. The buffer needs usage UNIFORM_TEXEL_BUFFER.
void createTexelView(const Device& device, Buffer& buffer,
                     VkFormat format = VK_FORMAT_R32G32B32A32_SFLOAT, VkDeviceSize texelBytes = 16);

struct Image {
    Memory memory;
    Handle<VkImage> image;
    Handle<VkImageView> view;
    VkFormat format = VK_FORMAT_UNDEFINED;
    uint32_t width = 0, height = 0;
    uint32_t mipLevels = 1;
};

// Creates a 2D image with optimal tiling and one layer, and a view of all its mip levels with the
// given aspect.
Image createImage(const Device& device, const std::string& name, VkFormat format, uint32_t width,
                  uint32_t height, VkImageUsageFlags usage, VkImageAspectFlags aspect,
                  uint32_t mipLevels = 1);

// An R32G32B32A32_SFLOAT cube map that can be sampled and written by compute shaders, and copied.
struct CubeImage {
    Memory memory;
    Handle<VkImage> image;
    Handle<VkImageView> view;              // cube view of all mip levels
    std::vector<Handle<VkImageView>> mips; // per mip level, an array view of the six faces, for
                                           // storage
};

// `size`: texels per side of a face.
CubeImage createCubeImage(const Device& device, const std::string& name, uint32_t size,
                          uint32_t mipLevels);

} // namespace candelabra::gpu
