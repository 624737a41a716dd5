// SPDX-License-Identifier: Apache-2.0
#include "render/pipeline_watch.h"

#include <cstring>
#include <utility>

namespace candelabra::app
{
namespace
{

thread_local std::function<bool(uint32_t)> beforePipeline; // empty: this thread watches nothing
thread_local uint32_t announced = 0;

bool isWanted()
{
    return !beforePipeline || beforePipeline(announced);
}

VkResult VKAPI_CALL createComputePipelines(VkDevice device, VkPipelineCache cache, uint32_t count,
                                           const VkComputePipelineCreateInfo* infos,
                                           const VkAllocationCallbacks* callbacks, VkPipeline* out)
{
    return isWanted() ? vkCreateComputePipelines(device, cache, count, infos, callbacks, out)
                      : VK_ERROR_UNKNOWN;
}

VkResult VKAPI_CALL createGraphicsPipelines(VkDevice device, VkPipelineCache cache, uint32_t count,
                                            const VkGraphicsPipelineCreateInfo* infos,
                                            const VkAllocationCallbacks* callbacks, VkPipeline* out)
{
    return isWanted() ? vkCreateGraphicsPipelines(device, cache, count, infos, callbacks, out)
                      : VK_ERROR_UNKNOWN;
}

PFN_vkVoidFunction VKAPI_CALL deviceFunctions(VkDevice device, const char* name)
{
    if (std::strcmp(name, "vkCreateComputePipelines") == 0)
        return reinterpret_cast<PFN_vkVoidFunction>(createComputePipelines);
    if (std::strcmp(name, "vkCreateGraphicsPipelines") == 0)
        return reinterpret_cast<PFN_vkVoidFunction>(createGraphicsPipelines);
    return vkGetDeviceProcAddr(device, name);
}

} // namespace

PFN_vkVoidFunction VKAPI_CALL watchedFunctions(VkInstance instance, const char* name)
{
    if (std::strcmp(name, "vkGetDeviceProcAddr") == 0)
        return reinterpret_cast<PFN_vkVoidFunction>(deviceFunctions);
    return vkGetInstanceProcAddr(instance, name);
}

PipelineWatch::PipelineWatch(std::function<bool(uint32_t)> before)
{
    beforePipeline = std::move(before);
    announced = 0;
}

PipelineWatch::~PipelineWatch()
{
    beforePipeline = nullptr;
}

bool PipelineWatch::watches()
{
    return bool(beforePipeline);
}

void PipelineWatch::announce(uint32_t pipelines)
{
    announced += pipelines;
}

} // namespace candelabra::app
