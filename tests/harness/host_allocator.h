// SPDX-License-Identifier: Apache-2.0
// A host's allocator (CndAllocator) for tests: places everything in large blocks, one object after
// the other, in memory that holds garbage. It calls the device only through the host's functions.
#pragma once

#include <algorithm>
#include <cstring>
#include <functional>
#include <map>
#include <string>
#include <utility>
#include <vector>

#include "candelabra/candelabra.h"

namespace candelabra::test
{

class HostAllocator
{
public:
    // Allocates as many blocks as needed, each of at least `blockBytes` bytes.
    HostAllocator(const CndDeviceDesc& host, VkDeviceSize blockBytes) : host_(host)
    {
        std::fill_n(blockBytes_, CND_MEMORY_KIND_COUNT, blockBytes);
        instanceFunction<PFN_vkGetPhysicalDeviceMemoryProperties>(
            "vkGetPhysicalDeviceMemoryProperties")(host.physicalDevice, &types_);
    }
    // Allocates one block of each kind, exactly as large as planned.
    HostAllocator(const CndDeviceDesc& host, const CndMemoryUsage& planned) : HostAllocator(host, 0)
    {
        for (int kind = 0; kind < CND_MEMORY_KIND_COUNT; ++kind) {
            blockBytes_[kind] =
                planned.bytes[kind] + planned.allocations[kind] * planned.alignment[kind];
            typeBits_[kind] = planned.memoryTypeBits[kind];
        }
        planned_ = true;
    }
    // Destroy it only when no allocation is in use.
    ~HostAllocator()
    {
        const auto free = deviceFunction<PFN_vkFreeMemory>("vkFreeMemory");
        for (const auto& [where, blocks] : blocks_)
            for (const Block& block : blocks)
                free(host_.device, block.memory, host_.allocationCallbacks);
    }
    HostAllocator(const HostAllocator&) = delete;
    HostAllocator& operator=(const HostAllocator&) = delete;

    // Returns the host's device with this allocator.
    CndDeviceDesc desc()
    {
        CndDeviceDesc out = host_;
        out.allocator = {
            .allocate =
                [](void* user, const CndMemoryRequest* request, CndMemory* memory) {
                    return static_cast<HostAllocator*>(user)->allocate(*request, *memory);
                },
            .free =
                [](void* user, void* allocation) {
                    static_cast<HostAllocator*>(user)->free(reinterpret_cast<uint64_t>(allocation));
                },
            .user = this};
        return out;
    }

    struct Placed {
        std::string name;
        CndMemoryKind kind;
        VkMemoryRequirements requirements;
        CndMemory at;
    };
    std::map<uint64_t, Placed> live; // by allocation number
    uint64_t allocations = 0;        // number of calls of allocate
    uint64_t unknownFrees = 0;
    // Returns the result that refuses a request, or VK_SUCCESS to serve it.
    std::function<VkResult(const CndMemoryRequest&)> refuse = [](const auto&) {
        return VK_SUCCESS;
    };
    // Modifies the answer of allocate, to test how faulty answers are handled.
    std::function<void(CndMemory&)> spoil = [](CndMemory&) {};

    // Fills all live objects of a kind that the CPU can access with `byte`.
    void fill(CndMemoryKind kind, int byte)
    {
        for (const auto& [number, placed] : live)
            if (placed.kind == kind && placed.at.mapped)
                std::memset(placed.at.mapped, byte, size_t(placed.requirements.size));
    }

private:
    struct Block {
        VkDeviceMemory memory;
        VkDeviceSize size, used;
        std::byte* mapped; // null: not accessible to the CPU
    };

    template <typename F>
    F instanceFunction(const char* name) const
    {
        return reinterpret_cast<F>(host_.getInstanceProcAddr(host_.instance, name));
    }
    template <typename F>
    F deviceFunction(const char* name) const
    {
        return reinterpret_cast<F>(
            instanceFunction<PFN_vkGetDeviceProcAddr>("vkGetDeviceProcAddr")(host_.device, name));
    }

    // Returns a memory type for the request, host-visible if possible; UINT32_MAX if none fits.
    uint32_t memoryType(const CndMemoryRequest& request) const
    {
        constexpr VkMemoryPropertyFlags visible =
            VK_MEMORY_PROPERTY_HOST_VISIBLE_BIT | VK_MEMORY_PROPERTY_HOST_COHERENT_BIT;
        for (const VkMemoryPropertyFlags wanted : {request.required | visible, request.required})
            for (uint32_t i = 0; i < types_.memoryTypeCount; ++i)
                if ((request.requirements.memoryTypeBits & typeBits_[request.kind]) >> i & 1 &&
                    (types_.memoryTypes[i].propertyFlags & wanted) == wanted)
                    return i;
        return UINT32_MAX;
    }

    VkResult newBlock(uint32_t type, VkDeviceSize size, Block& block)
    {
        const VkMemoryAllocateInfo info{.sType = VK_STRUCTURE_TYPE_MEMORY_ALLOCATE_INFO,
                                        .allocationSize = size,
                                        .memoryTypeIndex = type};
        block = {.size = info.allocationSize};
        const VkResult result = deviceFunction<PFN_vkAllocateMemory>("vkAllocateMemory")(
            host_.device, &info, host_.allocationCallbacks, &block.memory);
        if (result != VK_SUCCESS ||
            !(types_.memoryTypes[type].propertyFlags & VK_MEMORY_PROPERTY_HOST_VISIBLE_BIT))
            return result;
        void* mapped = nullptr;
        const VkResult mapping = deviceFunction<PFN_vkMapMemory>("vkMapMemory")(
            host_.device, block.memory, 0, VK_WHOLE_SIZE, 0, &mapped);
        block.mapped = static_cast<std::byte*>(mapped);
        return mapping;
    }

    VkResult allocate(const CndMemoryRequest& request, CndMemory& out)
    {
        ++allocations;
        if (const VkResult result = refuse(request); result != VK_SUCCESS)
            return result;
        const uint32_t type = memoryType(request);
        if (type == UINT32_MAX)
            return VK_ERROR_FEATURE_NOT_PRESENT;
        const VkMemoryRequirements& needs = request.requirements;
        const auto start = [&](const Block& b) {
            return (b.used + needs.alignment - 1) / needs.alignment * needs.alignment;
        };
        std::vector<Block>& blocks = blocks_[{type, request.kind}];
        if (blocks.empty() || start(blocks.back()) + needs.size > blocks.back().size) {
            Block block{};
            const VkDeviceSize bytes = blockBytes_[request.kind];
            if (planned_ && (!blocks.empty() || needs.size > bytes))
                return VK_ERROR_OUT_OF_DEVICE_MEMORY;
            if (const VkResult result = newBlock(type, std::max(needs.size, bytes), block);
                result != VK_SUCCESS)
                return result;
            blocks.push_back(block);
        }
        Block& block = blocks.back();
        const VkDeviceSize offset = start(block);
        block.used = offset + needs.size;
        out = {.memory = block.memory,
               .offset = offset,
               .mapped = block.mapped ? block.mapped + offset : nullptr,
               .allocation = reinterpret_cast<void*>(allocations)}; // NOLINT
        if (out.mapped)
            std::memset(out.mapped, 0xCD, size_t(needs.size));
        live[allocations] = {request.name, request.kind, needs, out};
        spoil(out);
        return VK_SUCCESS;
    }

    void free(uint64_t number) { unknownFrees += !live.erase(number); }

    CndDeviceDesc host_;
    VkDeviceSize blockBytes_[CND_MEMORY_KIND_COUNT] = {};
    uint32_t typeBits_[CND_MEMORY_KIND_COUNT] = {~0u, ~0u, ~0u, ~0u, ~0u};
    bool planned_ = false;
    VkPhysicalDeviceMemoryProperties types_{};
    // by memory type and kind
    std::map<std::pair<uint32_t, CndMemoryKind>, std::vector<Block>> blocks_;
};

} // namespace candelabra::test
