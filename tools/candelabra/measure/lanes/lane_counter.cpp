// SPDX-License-Identifier: Apache-2.0
#include "measure/lanes/lane_counter.h"

#include <algorithm>
#include <string_view>
#include <utility>
#include <vector>

#include <fmt/format.h>

#include "candelabra_bench_shaders.h"
#include "candelabra_shaders.h"
#include "gpu/kernel.h"
#include "io/error.h"
#include "io/table.h"
#include "shared/light_types.h"

namespace candelabra::app
{
namespace
{

// The kernels that count, by those that they replace.
const std::pair<const gpu::Spirv*, const gpu::Spirv*> counting[] = {
    {&spirv::cluster_lists_comp, &spirv::cluster_lists_comp_count_lanes},
    {spirv::shade_tiles_comp[gpu::FAMILY_CONIC], &spirv::shade_tiles_comp_count_lanes_conic}};

// Vulkan functions have no parameter for the host.
VkDescriptorSetLayout countsLayout = VK_NULL_HANDLE;
VkDescriptorSet countsSet = VK_NULL_HANDLE;

constexpr VkDeviceSize mostBytes = VkDeviceSize(1) << 30;

} // namespace

// What the engine calls instead of the driver. Each function does what the driver's does until
// there is a LaneCounter.
struct LaneCounter::Functions {
    static void VKAPI_CALL properties(VkPhysicalDevice device, VkPhysicalDeviceProperties2* out)
    {
        vkGetPhysicalDeviceProperties2(device, out);
        out->properties.deviceType = VK_PHYSICAL_DEVICE_TYPE_OTHER;
    }
    static VkResult VKAPI_CALL createModule(VkDevice device, const VkShaderModuleCreateInfo* given,
                                            const VkAllocationCallbacks* callbacks,
                                            VkShaderModule* out)
    {
        VkShaderModuleCreateInfo info = *given;
        for (const auto& [replaced, counts] : counting)
            if (countsSet && given->pCode == replaced->words.data()) {
                info.pCode = counts->words.data();
                info.codeSize = counts->words.size_bytes();
            }
        return vkCreateShaderModule(device, &info, callbacks, out);
    }
    // Every pipeline gets the set, whether its kernel counts or not.
    static VkResult VKAPI_CALL createLayout(VkDevice device,
                                            const VkPipelineLayoutCreateInfo* given,
                                            const VkAllocationCallbacks* callbacks,
                                            VkPipelineLayout* out)
    {
        VkPipelineLayoutCreateInfo info = *given;
        std::vector<VkDescriptorSetLayout> sets(given->pSetLayouts,
                                                given->pSetLayouts + given->setLayoutCount);
        if (countsSet)
            sets.push_back(countsLayout);
        info.setLayoutCount = uint32_t(sets.size());
        info.pSetLayouts = sets.data();
        return vkCreatePipelineLayout(device, &info, callbacks, out);
    }
    static void VKAPI_CALL bindSets(VkCommandBuffer cmd, VkPipelineBindPoint point,
                                    VkPipelineLayout layout, uint32_t first, uint32_t count,
                                    const VkDescriptorSet* sets, uint32_t offsetCount,
                                    const uint32_t* offsets)
    {
        vkCmdBindDescriptorSets(cmd, point, layout, first, count, sets, offsetCount, offsets);
        if (countsSet && point == VK_PIPELINE_BIND_POINT_COMPUTE)
            vkCmdBindDescriptorSets(cmd, point, layout, first + count, 1, &countsSet, 0, nullptr);
    }
    static PFN_vkVoidFunction find(std::string_view name)
    {
        if (name == "vkGetPhysicalDeviceProperties2")
            return reinterpret_cast<PFN_vkVoidFunction>(properties);
        if (name == "vkGetDeviceProcAddr")
            return reinterpret_cast<PFN_vkVoidFunction>(deviceFunction);
        if (name == "vkCreateShaderModule")
            return reinterpret_cast<PFN_vkVoidFunction>(createModule);
        if (name == "vkCreatePipelineLayout")
            return reinterpret_cast<PFN_vkVoidFunction>(createLayout);
        if (name == "vkCmdBindDescriptorSets")
            return reinterpret_cast<PFN_vkVoidFunction>(bindSets);
        return nullptr;
    }
    static PFN_vkVoidFunction VKAPI_CALL deviceFunction(VkDevice device, const char* name)
    {
        const PFN_vkVoidFunction found = find(name);
        return found ? found : vkGetDeviceProcAddr(device, name);
    }
};

PFN_vkVoidFunction VKAPI_CALL LaneCounter::functions(VkInstance instance, const char* name)
{
    const PFN_vkVoidFunction found = Functions::find(name);
    return found ? found : vkGetInstanceProcAddr(instance, name);
}

LaneCounter::LaneCounter(const VulkanContext& context)
{
    const gpu::Device& device = context.device();
    const VkDeviceSize bytes =
        std::min<VkDeviceSize>(mostBytes, device.limits.maxStorageBufferRange);
    counts_ = gpu::createBuffer(device, "lane counts", bytes, VK_BUFFER_USAGE_STORAGE_BUFFER_BIT,
                                gpu::MemoryUse::Readback);
    const gpu::ReflectedBinding binding{gpu::LANE_COUNTS_BINDING, VK_DESCRIPTOR_TYPE_STORAGE_BUFFER,
                                        1};
    set_ = gpu::Bindings(device, "lane counts", {binding}, VK_SHADER_STAGE_COMPUTE_BIT, 1);
    set_.write(0, {gpu::Binding::of(gpu::LANE_COUNTS_BINDING, counts_)});
    countsLayout = set_.layout();
    countsSet = set_.set(0);
}

LaneCounter::~LaneCounter()
{
    countsLayout = VK_NULL_HANDLE;
    countsSet = VK_NULL_HANDLE;
}

void LaneCounter::count(const std::function<void()>& frame,
                        const std::function<void(std::span<gpu::LaneRound>)>& take)
{
    const VkDeviceSize bytes = counts_.size - sizeof(gpu::LaneRoundsHead);
    const uint32_t room = uint32_t(bytes / sizeof(gpu::LaneRound));
    gpu::LaneRoundsHead& head = counts_.as<gpu::LaneRoundsHead>()[0];
    auto* const rounds = reinterpret_cast<gpu::LaneRound*>(&head + 1);
    uint32_t parts = 1;
    for (uint32_t part = 0; part < parts; ++part) {
        head = {.written = 0, .room = room, .part = part, .parts = parts};
        frame();
        if (head.written <= room) {
            take({rounds, head.written});
            continue;
        }
        if (part != 0)
            throw RunError(
                fmt::format("counting lanes: {} of {} parts have {} rounds, there is room "
                            "for {} of each",
                            part, parts, grouped(head.written), grouped(room)));
        parts *= 2 * (head.written / room + 1); // twice, because parts differ
        part = UINT32_MAX;                      // begins again with the first part
    }
}

} // namespace candelabra::app
