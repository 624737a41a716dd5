// SPDX-License-Identifier: Apache-2.0
#include "mock/mock_vulkan.h"

#include <algorithm>
#include <cstring>
#include <span>
#include <utility>

#include "gpu/functions.h"
#include "mock/mock_physical_device.h"

namespace candelabra::test
{
namespace
{

MockVulkan* mock = nullptr;

// Handles are numbers, each given out only once.
template <typename H>
H toHandle(uint64_t number)
{
    return reinterpret_cast<H>(number); // NOLINT
}
template <typename H>
uint64_t toNumber(H handle)
{
    return reinterpret_cast<uint64_t>(handle);
}

// The callbacks need no state: only their address is compared.
const VkAllocationCallbacks callbacks{};

uint64_t nextHandle()
{
    static uint64_t last = 0x1000;
    return ++last;
}

void misuse(const std::string& what)
{
    mock->misuse.push_back(what);
}

void expectCallbacks(const char* name, const VkAllocationCallbacks* given)
{
    if (given != &callbacks)
        misuse(std::string(name) + " without the host's allocation callbacks");
}

// Every mocked function begins with a Call, which records the call and decides whether it fails.
class Call
{
public:
    explicit Call(const char* name, bool failable = false)
    {
        mock->called.insert(name);
        if (!failable)
            return;
        mock->failableCalls.push_back(name);
        if (mock->failableCalls.size() - 1 != mock->failingCall)
            return;
        mock->failed = name;
        fails_ = true;
    }
    bool fails() const { return fails_; }

private:
    HostAllocations::Pause pause_;
    bool fails_ = false;
};

void created(const char* name, uint64_t handle)
{
    mock->alive[handle] = name + std::strlen("Create");
}

void expectIdle(const char* name, uint64_t handle)
{
    for (const auto& [submission, commands] : mock->inFlight)
        if (commands.used.contains(handle))
            misuse(std::string(name) + " of what submission " + std::to_string(submission) +
                   " uses");
}

// The name of a function, as a template argument.
template <size_t n>
struct Name {
    char text[n]{};
    constexpr Name(const char (&from)[n]) { std::copy_n(from, n, text); } // NOLINT
};

// A mock made from the signature of a function alone; null for signatures that need an Override.
template <Name N, typename F>
struct Mock {
    static constexpr F call = nullptr;
};

template <Name N, typename Info, typename H>
struct Mock<N, VkResult(VKAPI_PTR*)(VkDevice, const Info*, const VkAllocationCallbacks*, H*)> {
    static VkResult VKAPI_CALL call(VkDevice, const Info* info,
                                    const VkAllocationCallbacks* allocator, H* out)
    {
        const Call c(N.text, true);
        expectCallbacks(N.text, allocator);
        if (c.fails())
            return mock->error;
        *out = toHandle<H>(nextHandle());
        created(N.text, toNumber(*out));
        if constexpr (std::is_same_v<Info, VkBufferCreateInfo>)
            mock->buffers[*out] = {info->size};
        if constexpr (std::is_same_v<Info, VkMemoryAllocateInfo>)
            mock->memories[*out].size = info->allocationSize;
        if constexpr (std::is_same_v<Info, VkShaderModuleCreateInfo>)
            if (mock->shaders)
                mock->shaders->emplace_back(info->pCode, info->pCode + info->codeSize / 4);
        return VK_SUCCESS;
    }
};

template <Name N, typename Info>
struct Mock<N, VkResult(VKAPI_PTR*)(VkDevice, VkPipelineCache, uint32_t, const Info*,
                                    const VkAllocationCallbacks*, VkPipeline*)> {
    static VkResult VKAPI_CALL call(VkDevice, VkPipelineCache, uint32_t count, const Info*,
                                    const VkAllocationCallbacks* allocator, VkPipeline* out)
    {
        const Call c(N.text, true);
        expectCallbacks(N.text, allocator);
        for (uint32_t i = 0; i < count; ++i) {
            out[i] = c.fails() ? VK_NULL_HANDLE : toHandle<VkPipeline>(nextHandle());
            if (out[i])
                created(N.text, toNumber(out[i]));
        }
        return c.fails() ? mock->error : VK_SUCCESS;
    }
};

template <Name N, typename H>
struct Mock<N, void(VKAPI_PTR*)(VkDevice, H, const VkAllocationCallbacks*)> {
    static void VKAPI_CALL call(VkDevice, H handle, const VkAllocationCallbacks* allocator)
    {
        const Call c(N.text);
        expectCallbacks(N.text, allocator);
        if (handle && !mock->alive.erase(toNumber(handle)))
            misuse(std::string(N.text) + " of what is not alive");
        if (handle)
            expectIdle(N.text, toNumber(handle));
        if constexpr (std::is_same_v<H, VkDeviceMemory>)
            mock->memories.erase(handle);
        if constexpr (std::is_same_v<H, VkBuffer>)
            mock->buffers.erase(handle);
    }
};

template <Name N, typename... A>
struct Mock<N, void(VKAPI_PTR*)(VkCommandBuffer, A...)> {
    static void VKAPI_CALL call(VkCommandBuffer, A...) { const Call c(N.text); }
};

std::byte* bytesOf(VkBuffer buffer)
{
    const auto known = mock->buffers.find(buffer);
    if (known == mock->buffers.end())
        return nullptr;
    const auto memory = mock->memories.find(known->second.memory);
    if (memory == mock->memories.end() || !memory->second.bytes)
        return nullptr;
    return memory->second.bytes.get() + known->second.offset;
}

void use(VkBuffer buffer)
{
    if (!mock->alive.contains(toNumber(buffer)))
        misuse("a command with a buffer that is not alive");
    mock->recorded.used.insert(toNumber(buffer));
}

struct Override {
    static void VKAPI_CALL CmdFillBuffer(VkCommandBuffer, VkBuffer buffer, VkDeviceSize offset,
                                         VkDeviceSize size, uint32_t data)
    {
        const Call c("CmdFillBuffer");
        use(buffer);
        mock->recorded.fills.push_back({buffer, offset, size, data});
    }
    static void VKAPI_CALL CmdCopyBuffer(VkCommandBuffer, VkBuffer from, VkBuffer to,
                                         uint32_t count, const VkBufferCopy* regions)
    {
        const Call c("CmdCopyBuffer");
        use(from);
        use(to);
        if (const std::byte* bytes = bytesOf(from))
            for (const VkBufferCopy& r : std::span(regions, count))
                mock->recorded.reads.push_back(
                    {from, r.srcOffset, {bytes + r.srcOffset, bytes + r.srcOffset + r.size}});
    }
    static void VKAPI_CALL CmdDispatchIndirect(VkCommandBuffer, VkBuffer arguments, VkDeviceSize)
    {
        const Call c("CmdDispatchIndirect");
        use(arguments);
    }
    static void VKAPI_CALL CmdDrawIndexedIndirect(VkCommandBuffer, VkBuffer arguments, VkDeviceSize,
                                                  uint32_t, uint32_t)
    {
        const Call c("CmdDrawIndexedIndirect");
        use(arguments);
    }
    static void VKAPI_CALL CmdDrawIndirect(VkCommandBuffer, VkBuffer arguments, VkDeviceSize,
                                           uint32_t, uint32_t)
    {
        const Call c("CmdDrawIndirect");
        use(arguments);
    }
    static void VKAPI_CALL CmdBindVertexBuffers(VkCommandBuffer, uint32_t, uint32_t count,
                                                const VkBuffer* buffers, const VkDeviceSize*)
    {
        const Call c("CmdBindVertexBuffers");
        std::for_each_n(buffers, count, use);
    }
    static void VKAPI_CALL CmdBindPipeline(VkCommandBuffer, VkPipelineBindPoint,
                                           VkPipeline pipeline)
    {
        const Call c("CmdBindPipeline");
        if (!mock->alive.contains(toNumber(pipeline)))
            misuse("a pipeline that is not alive");
        mock->recorded.used.insert(toNumber(pipeline));
    }
    static void VKAPI_CALL CmdBindDescriptorSets(VkCommandBuffer, VkPipelineBindPoint,
                                                 VkPipelineLayout, uint32_t, uint32_t count,
                                                 const VkDescriptorSet* sets, uint32_t,
                                                 const uint32_t*)
    {
        const Call c("CmdBindDescriptorSets");
        for (const VkDescriptorSet set : std::span(sets, count)) {
            const MockVulkan::DescriptorSet& s = mock->sets[set];
            if (!mock->alive.contains(toNumber(s.pool)))
                misuse("a descriptor set whose pool is not alive");
            mock->recorded.used.insert({toNumber(set), toNumber(s.pool)});
            for (const auto& [binding, resource] : s.resources) {
                if (!mock->alive.contains(resource))
                    misuse("a descriptor of what is not alive, binding " + std::to_string(binding));
                mock->recorded.used.insert(resource);
            }
        }
    }
    static void VKAPI_CALL UpdateDescriptorSets(VkDevice, uint32_t count,
                                                const VkWriteDescriptorSet* writes, uint32_t,
                                                const VkCopyDescriptorSet*)
    {
        const Call c("UpdateDescriptorSets");
        for (uint32_t i = 0; i < count; ++i) {
            const VkWriteDescriptorSet& w = writes[i];
            expectIdle("UpdateDescriptorSets", toNumber(w.dstSet));
            const bool texels = w.descriptorType == VK_DESCRIPTOR_TYPE_UNIFORM_TEXEL_BUFFER;
            const bool buffer = w.descriptorType == VK_DESCRIPTOR_TYPE_STORAGE_BUFFER ||
                                w.descriptorType == VK_DESCRIPTOR_TYPE_UNIFORM_BUFFER;
            const bool ofHost = buffer && w.pBufferInfo->buffer == MockVulkan::hostBuffer();
            // The mock does not track what is the host's, such as all images.
            if (ofHost)
                mock->sets[w.dstSet].resources.erase(w.dstBinding);
            else if (texels || buffer)
                mock->sets[w.dstSet].resources[w.dstBinding] =
                    texels ? toNumber(*w.pTexelBufferView) : toNumber(w.pBufferInfo->buffer);
        }
    }
    static VkResult VKAPI_CALL AllocateDescriptorSets(VkDevice,
                                                      const VkDescriptorSetAllocateInfo* info,
                                                      VkDescriptorSet* sets)
    {
        const Call c("AllocateDescriptorSets", true);
        if (c.fails())
            return mock->error;
        for (uint32_t i = 0; i < info->descriptorSetCount; ++i)
            mock->sets[sets[i] = toHandle<VkDescriptorSet>(nextHandle())].pool =
                info->descriptorPool;
        return VK_SUCCESS;
    }
    static VkResult VKAPI_CALL BindBufferMemory(VkDevice, VkBuffer buffer, VkDeviceMemory memory,
                                                VkDeviceSize offset)
    {
        const Call c("BindBufferMemory", true);
        if (c.fails())
            return mock->error;
        MockVulkan::Buffer& b = mock->buffers[buffer];
        b.memory = memory;
        b.offset = offset;
        if (offset + b.size > mock->memories[memory].size)
            misuse("a buffer beyond the end of its memory");
        return VK_SUCCESS;
    }
    static VkResult VKAPI_CALL BindImageMemory(VkDevice, VkImage, VkDeviceMemory, VkDeviceSize)
    {
        return Call("BindImageMemory", true).fails() ? mock->error : VK_SUCCESS;
    }
    static VkResult VKAPI_CALL MapMemory(VkDevice, VkDeviceMemory memory, VkDeviceSize,
                                         VkDeviceSize, VkMemoryMapFlags, void** data)
    {
        const Call c("MapMemory", true);
        if (c.fails())
            return mock->error;
        MockVulkan::Memory& m = mock->memories[memory];
        m.bytes = std::make_unique<std::byte[]>(m.size);
        *data = m.bytes.get();
        return VK_SUCCESS;
    }
    static VkResult VKAPI_CALL GetQueryPoolResults(VkDevice, VkQueryPool, uint32_t, uint32_t,
                                                   size_t size, void* data, VkDeviceSize,
                                                   VkQueryResultFlags)
    {
        const Call c("GetQueryPoolResults", true);
        if (c.fails())
            return mock->error;
        std::memset(data, 0, size);
        return VK_SUCCESS;
    }
    static void VKAPI_CALL GetBufferMemoryRequirements(VkDevice, VkBuffer buffer,
                                                       VkMemoryRequirements* needs)
    {
        const Call c("GetBufferMemoryRequirements");
        *needs = {mock->buffers[buffer].size, 16, 1};
    }
    static void VKAPI_CALL GetImageMemoryRequirements(VkDevice, VkImage,
                                                      VkMemoryRequirements* needs)
    {
        const Call c("GetImageMemoryRequirements");
        *needs = {1024, 16, 1};
    }
};

PFN_vkVoidFunction VKAPI_CALL getDeviceProcAddr(VkDevice, const char* wanted)
{
    const HostAllocations::Pause pause;
    const std::string name(wanted + std::strlen("vk"));
    mock->lookedUp.insert(name);
    if (name == mock->absent)
        return nullptr;
#define X(f)                                                                                       \
    if (name == #f)                                                                                \
        return reinterpret_cast<PFN_vkVoidFunction>(static_cast<PFN_vk##f>(Override::f));
    X(CmdFillBuffer)
    X(CmdCopyBuffer)
    X(CmdDispatchIndirect)
    X(CmdDrawIndirect)
    X(CmdDrawIndexedIndirect)
    X(CmdBindVertexBuffers)
    X(CmdBindPipeline)
    X(CmdBindDescriptorSets)
    X(UpdateDescriptorSets)
    X(AllocateDescriptorSets)
    X(BindBufferMemory)
    X(BindImageMemory)
    X(MapMemory)
    X(GetQueryPoolResults)
    X(GetBufferMemoryRequirements)
    X(GetImageMemoryRequirements)
#undef X
#define X(f)                                                                                       \
    if (name == #f)                                                                                \
        return reinterpret_cast<PFN_vkVoidFunction>(PFN_vk##f(Mock<#f, PFN_vk##f>::call));
    CND_DEVICE_FUNCTIONS(X)
    CND_RASTER_FUNCTIONS(X)
#undef X
    return nullptr;
}

PFN_vkVoidFunction VKAPI_CALL getInstanceProcAddr(VkInstance, const char* wanted)
{
    const HostAllocations::Pause pause;
    const std::string name(wanted + std::strlen("vk"));
    if (name == "GetDeviceProcAddr")
        return reinterpret_cast<PFN_vkVoidFunction>(getDeviceProcAddr);
    return physicalDeviceFunction(name);
}

} // namespace

MockVulkan::MockVulkan()
    : limits{.maxImageDimension2D = 16384,
             .maxTexelBufferElements = 1u << 27,
             .maxStorageBufferRange = 1u << 27,
             .maxPerStageDescriptorStorageBuffers = 64,
             .maxComputeWorkGroupCount = {65535, 65535, 65535},
             .maxComputeWorkGroupInvocations = 1024,
             .maxComputeWorkGroupSize = {1024, 1024, 64},
             .maxDrawIndirectCount = 1u << 20,
             .minStorageBufferOffsetAlignment = 16,
             .timestampComputeAndGraphics = VK_TRUE,
             .timestampPeriod = 1}
{
    mock = this;
}

MockVulkan::~MockVulkan()
{
    mock = nullptr;
}

const MockVulkan& MockVulkan::current()
{
    return *mock;
}

uint64_t MockVulkan::submit()
{
    static uint64_t last = 0;
    inFlight[++last] = std::exchange(recorded, {});
    return last;
}

void MockVulkan::finish(uint64_t submission)
{
    const Commands commands = std::move(inFlight.at(submission));
    inFlight.erase(submission);
    for (const Commands::Read& read : commands.reads) {
        const std::byte* now = bytesOf(read.buffer);
        if (!now || std::memcmp(now + read.offset, read.bytes.data(), read.bytes.size()))
            misuse.push_back("the host changed what submission " + std::to_string(submission) +
                             " reads");
    }
    for (const Commands::Fill& fill : commands.fills)
        if (std::byte* bytes = bytesOf(fill.buffer); bytes && fill.size != VK_WHOLE_SIZE)
            for (VkDeviceSize i = 0; i < fill.size; i += sizeof fill.data)
                std::memcpy(bytes + fill.offset + i, &fill.data, sizeof fill.data);
}

CndDeviceDesc MockVulkan::desc() const
{
    return {.structSize = sizeof(CndDeviceDesc),
            .instance = toHandle<VkInstance>(1),
            .physicalDevice = toHandle<VkPhysicalDevice>(2),
            .device = toHandle<VkDevice>(3),
            .getInstanceProcAddr = getInstanceProcAddr,
            .allocationCallbacks = &callbacks};
}

VkCommandBuffer MockVulkan::commandBuffer()
{
    return toHandle<VkCommandBuffer>(4);
}

CndCamera MockVulkan::camera()
{
    return {.viewFromWorld = {1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1},
            .clipFromView = {1, 0, 0, 0, 0, -1, 0, 0, 0, 0, 0, -1, 0, 0, 0.1f, 0}};
}

VkImageView MockVulkan::imageView()
{
    return toHandle<VkImageView>(5);
}

VkBuffer MockVulkan::hostBuffer()
{
    return toHandle<VkBuffer>(6);
}

} // namespace candelabra::test
