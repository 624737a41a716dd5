// SPDX-License-Identifier: Apache-2.0
// Handle: move-only owner of one Vulkan object. vkDestroy* is called nowhere else (memory is freed
// in gpu/memory.cpp).
#pragma once

#include <utility>

#include "gpu/device.h"

namespace candelabra::gpu
{

#define CND_RELEASE(Type, function)                                                                \
    inline void release(const Device& d, Type h)                                                   \
    {                                                                                              \
        d.function(d.handle, h, d.allocationCallbacks);                                            \
    }
CND_RELEASE(VkBuffer, DestroyBuffer)
CND_RELEASE(VkBufferView, DestroyBufferView)
CND_RELEASE(VkDescriptorPool, DestroyDescriptorPool)
CND_RELEASE(VkDescriptorSetLayout, DestroyDescriptorSetLayout)
CND_RELEASE(VkImage, DestroyImage)
CND_RELEASE(VkImageView, DestroyImageView)
CND_RELEASE(VkPipeline, DestroyPipeline)
CND_RELEASE(VkPipelineLayout, DestroyPipelineLayout)
CND_RELEASE(VkQueryPool, DestroyQueryPool)
CND_RELEASE(VkSampler, DestroySampler)
CND_RELEASE(VkShaderModule, DestroyShaderModule)
#undef CND_RELEASE

template <typename T>
class Handle
{
public:
    Handle() = default;
    Handle(const Device& device, T handle) : device_(&device), handle_(handle) {}
    Handle(Handle&& other) noexcept
        : device_(other.device_), handle_(std::exchange(other.handle_, T{}))
    {
    }
    Handle& operator=(Handle&& other) noexcept
    {
        std::swap(device_, other.device_);
        std::swap(handle_, other.handle_);
        return *this;
    }
    ~Handle()
    {
        if (handle_)
            release(*device_, handle_);
    }
    T get() const { return handle_; }
    explicit operator bool() const { return handle_ != T{}; }

private:
    const Device* device_ = nullptr;
    T handle_{};
};

} // namespace candelabra::gpu
