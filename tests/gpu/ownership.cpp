// SPDX-License-Identifier: Apache-2.0
#include "gpu/ownership.h"

#include <algorithm>
#include <cstring>

#include "gpu/functions.h"

namespace candelabra::test
{
namespace
{

Ownership* book = nullptr;
PFN_vkGetInstanceProcAddr hostInstanceProcAddr = nullptr;
PFN_vkGetDeviceProcAddr hostDeviceProcAddr = nullptr;

template <size_t n>
struct Name {
    char text[n]{};
    constexpr Name(const char (&from)[n]) { std::copy_n(from, n, text); } // NOLINT
};

// Wraps a device function: records the call, then passes it on.
template <Name N, typename F>
struct Booked;

template <Name N, typename R, typename... A>
struct Booked<N, R(VKAPI_PTR*)(A...)> {
    static inline R(VKAPI_PTR* host)(A...) = nullptr;
    static R VKAPI_CALL call(A... arguments)
    {
        book->onCall(N.text);
        return host(arguments...);
    }
};

#define HOST(f) Booked<#f, PFN_vk##f>::host

struct Override {
    static void VKAPI_CALL CmdPipelineBarrier(VkCommandBuffer cmd, VkPipelineStageFlags from,
                                              VkPipelineStageFlags to, VkDependencyFlags flags,
                                              uint32_t memoryCount, const VkMemoryBarrier* memory,
                                              uint32_t bufferCount,
                                              const VkBufferMemoryBarrier* buffers,
                                              uint32_t imageCount,
                                              const VkImageMemoryBarrier* images)
    {
        book->onCall("CmdPipelineBarrier");
        book->onModuleBarrier(from | to, {buffers, bufferCount}, {images, imageCount});
        HOST(CmdPipelineBarrier)
        (cmd, from, to, flags, memoryCount, memory, bufferCount, buffers, imageCount, images);
    }
    static void VKAPI_CALL UpdateDescriptorSets(VkDevice device, uint32_t count,
                                                const VkWriteDescriptorSet* writes,
                                                uint32_t copyCount,
                                                const VkCopyDescriptorSet* copies)
    {
        book->onCall("UpdateDescriptorSets");
        for (const VkWriteDescriptorSet& write : std::span(writes, count))
            book->onWrite(write);
        HOST(UpdateDescriptorSets)(device, count, writes, copyCount, copies);
    }
    static void VKAPI_CALL CmdBindDescriptorSets(VkCommandBuffer cmd, VkPipelineBindPoint point,
                                                 VkPipelineLayout layout, uint32_t first,
                                                 uint32_t count, const VkDescriptorSet* sets,
                                                 uint32_t offsetCount, const uint32_t* offsets)
    {
        book->onCall(point == VK_PIPELINE_BIND_POINT_COMPUTE ? "CmdBindDescriptorSets"
                                                             : "sets of another bind point");
        book->onBind(cmd, sets[0]);
        HOST(CmdBindDescriptorSets)
        (cmd, point, layout, first, count, sets, offsetCount, offsets);
    }
    static void VKAPI_CALL CmdDispatch(VkCommandBuffer cmd, uint32_t x, uint32_t y, uint32_t z)
    {
        book->onCall("CmdDispatch");
        book->onDispatch(cmd);
        HOST(CmdDispatch)(cmd, x, y, z);
    }
    static void VKAPI_CALL CmdDispatchIndirect(VkCommandBuffer cmd, VkBuffer buffer,
                                               VkDeviceSize offset)
    {
        book->onCall("CmdDispatchIndirect");
        book->onDispatch(cmd);
        HOST(CmdDispatchIndirect)(cmd, buffer, offset);
    }
};

PFN_vkVoidFunction VKAPI_CALL getDeviceProcAddr(VkDevice device, const char* name)
{
    const PFN_vkVoidFunction host = hostDeviceProcAddr(device, name);
#define X(f)                                                                                       \
    if (std::strcmp(name, "vk" #f) == 0)                                                           \
        HOST(f) = reinterpret_cast<PFN_vk##f>(host);
    CND_DEVICE_FUNCTIONS(X)
#undef X
#define X(f)                                                                                       \
    if (std::strcmp(name, "vk" #f) == 0)                                                           \
        return reinterpret_cast<PFN_vkVoidFunction>(PFN_vk##f(Override::f));
    X(CmdPipelineBarrier)
    X(UpdateDescriptorSets)
    X(CmdBindDescriptorSets)
    X(CmdDispatch)
    X(CmdDispatchIndirect)
#undef X
#define X(f)                                                                                       \
    if (std::strcmp(name, "vk" #f) == 0)                                                           \
        return reinterpret_cast<PFN_vkVoidFunction>(PFN_vk##f(Booked<#f, PFN_vk##f>::call));
    CND_DEVICE_FUNCTIONS(X)
#undef X
    return host;
}

PFN_vkVoidFunction VKAPI_CALL getInstanceProcAddr(VkInstance instance, const char* name)
{
    if (std::strcmp(name, "vkGetDeviceProcAddr") == 0)
        return reinterpret_cast<PFN_vkVoidFunction>(getDeviceProcAddr);
    return hostInstanceProcAddr(instance, name);
}

bool isTransfer(uint32_t from, uint32_t to)
{
    return from != to && from != VK_QUEUE_FAMILY_IGNORED && to != VK_QUEUE_FAMILY_IGNORED;
}

// The stages that a queue supports which computes but cannot draw.
constexpr VkPipelineStageFlags computeStages =
    VK_PIPELINE_STAGE_COMPUTE_SHADER_BIT | VK_PIPELINE_STAGE_DRAW_INDIRECT_BIT |
    VK_PIPELINE_STAGE_TRANSFER_BIT | VK_PIPELINE_STAGE_HOST_BIT |
    VK_PIPELINE_STAGE_ALL_COMMANDS_BIT;

} // namespace

Ownership::Ownership(const CndDeviceDesc& host, bool real) : desc_(host), real_(real)
{
    book = this;
    hostInstanceProcAddr = host.getInstanceProcAddr;
    hostDeviceProcAddr = reinterpret_cast<PFN_vkGetDeviceProcAddr>(
        host.getInstanceProcAddr(host.instance, "vkGetDeviceProcAddr"));
    desc_.getInstanceProcAddr = getInstanceProcAddr;
}

Ownership::~Ownership()
{
    book = nullptr;
}

bool Ownership::isOwner(VkImage image, uint32_t family) const
{
    const auto known = images_.find(image);
    return known != images_.end() && known->second.owner == family && !known->second.released;
}

void Ownership::onCall(const char* function)
{
    if (inModule_)
        called.insert(function);
}

void Ownership::onModuleBarrier(VkPipelineStageFlags stages,
                                std::span<const VkBufferMemoryBarrier> buffers,
                                std::span<const VkImageMemoryBarrier> images)
{
    if (stages & ~computeStages)
        fault("a barrier of a module has stages that compute queues lack");
    const auto checkOwned = [&](const auto& barrier) {
        if (isTransfer(barrier.srcQueueFamilyIndex, barrier.dstQueueFamilyIndex))
            fault("a module transfers ownership");
    };
    std::for_each(buffers.begin(), buffers.end(), checkOwned);
    for (const VkImageMemoryBarrier& b : images) {
        checkOwned(b);
        if (images_.contains(b.image))
            fault("a module has a barrier for an image of the host's");
    }
}

void Ownership::onWrite(const VkWriteDescriptorSet& write)
{
    const VkDescriptorType type = write.descriptorType;
    if (type == VK_DESCRIPTOR_TYPE_SAMPLED_IMAGE || type == VK_DESCRIPTOR_TYPE_STORAGE_IMAGE ||
        type == VK_DESCRIPTOR_TYPE_COMBINED_IMAGE_SAMPLER)
        sets_[write.dstSet][write.dstBinding] = {write.pImageInfo->imageView,
                                                 write.pImageInfo->imageLayout};
}

void Ownership::onDispatch(VkCommandBuffer cmd)
{
    const auto family = families_.find(cmd);
    if (family == families_.end())
        return fault("a dispatch in a command buffer of no family");
    for (const auto& [binding, use] : sets_[bound_[cmd]]) {
        const auto view = views_.find(use.view);
        if (view == views_.end())
            continue; // an image of the module itself
        touched.insert(view->second);
        if (!isOwner(view->second, family->second))
            fault("binding " + std::to_string(binding) + " is an image that family " +
                  std::to_string(family->second) + " has not acquired");
        else if (images_[view->second].layout != use.layout)
            fault("binding " + std::to_string(binding) + " is an image in another layout");
    }
}

void Ownership::apply(const VkImageMemoryBarrier2& b, uint32_t family)
{
    Image& image = images_[b.image];
    const bool transfer = isTransfer(b.srcQueueFamilyIndex, b.dstQueueFamilyIndex);
    if (!transfer && b.oldLayout == VK_IMAGE_LAYOUT_UNDEFINED) {
        image = {.owner = family, .layout = b.newLayout};
    } else if (!transfer || b.srcQueueFamilyIndex == family) {
        if (!isOwner(b.image, family))
            fault("a barrier for an image that the family does not own");
        if (image.layout != b.oldLayout)
            fault("a barrier from another layout than the image's");
        image.layout = b.newLayout;
        if (transfer) {
            image.released = true;
            image.release = b;
        }
    } else {
        const VkImageMemoryBarrier2& r = image.release;
        if (!image.released || b.dstQueueFamilyIndex != family ||
            r.srcQueueFamilyIndex != b.srcQueueFamilyIndex ||
            r.dstQueueFamilyIndex != b.dstQueueFamilyIndex || r.oldLayout != b.oldLayout ||
            r.newLayout != b.newLayout)
            fault("an image is acquired that was not released so");
        image = {.owner = family, .layout = b.newLayout};
    }
}

void Ownership::barrier(VkCommandBuffer cmd, std::span<const VkImageMemoryBarrier2> barriers)
{
    const uint32_t family = families_.at(cmd);
    std::vector<VkImageMemoryBarrier2> passed(barriers.begin(), barriers.end());
    for (VkImageMemoryBarrier2& b : passed) {
        apply(b, family);
        if (real_ || !isTransfer(b.srcQueueFamilyIndex, b.dstQueueFamilyIndex))
            continue;
        if (b.dstQueueFamilyIndex == family) // the release has changed the layout already
            b.oldLayout = b.newLayout;
        b.srcQueueFamilyIndex = b.dstQueueFamilyIndex = VK_QUEUE_FAMILY_IGNORED;
    }
    const VkDependencyInfo info{.sType = VK_STRUCTURE_TYPE_DEPENDENCY_INFO,
                                .imageMemoryBarrierCount = uint32_t(passed.size()),
                                .pImageMemoryBarriers = passed.data()};
    vkCmdPipelineBarrier2(cmd, &info);
}

} // namespace candelabra::test
