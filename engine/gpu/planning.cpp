// SPDX-License-Identifier: Apache-2.0
#include "gpu/planning.h"

#include <algorithm>
#include <cstdlib>
#include <cstring>
#include <iterator>

#include "gpu/failure.h"
#include "gpu/functions.h"

namespace candelabra::gpu
{
namespace
{

// State of the current Planning, thread-local because Vulkan functions carry no user pointer.
struct Context {
    Planning* planning = nullptr;
    uint64_t handles = 0;   // number of handles given out
    uint32_t pipelines = 0; // of these, number of pipelines
};
thread_local Context context;

template <typename H>
H newHandle()
{
    return reinterpret_cast<H>(++context.handles); // NOLINT
}

// Nothing<F>::call has the signature of the Vulkan function F. It succeeds without doing anything,
// and returns made-up handles where F would create objects.
template <typename F>
struct Nothing;

template <typename R, typename... A>
struct Nothing<R(VKAPI_PTR*)(A...)> {
    static R VKAPI_CALL call(A...) { return R(); }
};

template <typename Info, typename H>
struct Nothing<VkResult(VKAPI_PTR*)(VkDevice, const Info*, const VkAllocationCallbacks*, H*)> {
    static VkResult VKAPI_CALL call(VkDevice, const Info*, const VkAllocationCallbacks*, H* out)
    {
        *out = newHandle<H>();
        return VK_SUCCESS;
    }
};

template <typename Info>
struct Nothing<VkResult(VKAPI_PTR*)(VkDevice, VkPipelineCache, uint32_t, const Info*,
                                    const VkAllocationCallbacks*, VkPipeline*)> {
    static VkResult VKAPI_CALL call(VkDevice, VkPipelineCache, uint32_t count, const Info*,
                                    const VkAllocationCallbacks*, VkPipeline* out)
    {
        for (uint32_t i = 0; i < count; ++i)
            out[i] = newHandle<VkPipeline>();
        context.pipelines += count;
        return VK_SUCCESS;
    }
};

template <>
struct Nothing<PFN_vkAllocateDescriptorSets> {
    static VkResult VKAPI_CALL call(VkDevice, const VkDescriptorSetAllocateInfo* info,
                                    VkDescriptorSet* out)
    {
        for (uint32_t i = 0; i < info->descriptorSetCount; ++i)
            out[i] = newHandle<VkDescriptorSet>();
        return VK_SUCCESS;
    }
};

// Buffers and images are created and take no memory, because only they know what memory they need.
bool isReal(const char* name)
{
    constexpr const char* real[] = {
        "vkCreateBuffer", "vkDestroyBuffer", "vkGetBufferMemoryRequirements",
        "vkCreateImage",  "vkDestroyImage",  "vkGetImageMemoryRequirements"};
    return std::any_of(std::begin(real), std::end(real),
                       [&](const char* r) { return std::strcmp(name, r) == 0; });
}

} // namespace

Planning::Planning(const CndDeviceDesc& device)
    : getInstanceProcAddr_(device.getInstanceProcAddr), desc_(device)
{
    const bool half = !device.allocator.allocate != !device.allocator.free;
    if (!device.instance || !device.device || !device.getInstanceProcAddr || half)
        return; // creating an object from desc() reports what is wrong
    getDeviceProcAddr_ = reinterpret_cast<PFN_vkGetDeviceProcAddr>(
        getInstanceProcAddr_(device.instance, "vkGetDeviceProcAddr"));
    if (!getDeviceProcAddr_)
        failUnsupported("the host's vkGetInstanceProcAddr has no vkGetDeviceProcAddr");
    context = {.planning = this};
    desc_.getInstanceProcAddr = instanceFunction;
    desc_.debugUtilsEnabled = VK_FALSE;
    desc_.allocator = {.allocate = allocate,
                       .free = [](void*, void* allocation) { std::free(allocation); }};
    // Messages belong to the real creation, which may follow.
    desc_.message = nullptr;
}

Planning::~Planning()
{
    context = {};
}

uint32_t Planning::pipelineCount() const
{
    return context.pipelines;
}

PFN_vkVoidFunction Planning::instanceFunction(VkInstance instance, const char* name)
{
    if (std::strcmp(name, "vkGetDeviceProcAddr") == 0)
        return reinterpret_cast<PFN_vkVoidFunction>(deviceFunction);
    return context.planning->getInstanceProcAddr_(instance, name);
}

PFN_vkVoidFunction Planning::deviceFunction(VkDevice device, const char* name)
{
    const PFN_vkVoidFunction found = context.planning->getDeviceProcAddr_(device, name);
    if (!found || isReal(name)) // creation will not find it either
        return found;
#define X(f)                                                                                       \
    if (std::strcmp(name, "vk" #f) == 0)                                                           \
        return reinterpret_cast<PFN_vkVoidFunction>(PFN_vk##f(Nothing<PFN_vk##f>::call));
    CND_DEVICE_FUNCTIONS(X)
    CND_RASTER_FUNCTIONS(X)
#undef X
    return nullptr;
}

VkResult Planning::allocate(void*, const CndMemoryRequest* request, CndMemory* memory)
{
    void* bytes = nullptr; // mapped memory is real: creation writes to a little of it
    if (request->required & VK_MEMORY_PROPERTY_HOST_VISIBLE_BIT) {
        bytes = std::malloc(size_t(request->requirements.size));
        if (!bytes)
            return VK_ERROR_OUT_OF_HOST_MEMORY;
    }
    *memory = {.memory = newHandle<VkDeviceMemory>(), .mapped = bytes, .allocation = bytes};
    return VK_SUCCESS;
}

} // namespace candelabra::gpu
