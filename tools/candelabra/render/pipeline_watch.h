// SPDX-License-Identifier: Apache-2.0
// PipelineWatch: tells a thread about the pipelines that the engine creates on it, which takes most
// of the time in which a scene is prepared, and lets it stop.
#pragma once

#include <functional>

#include <vulkan/vulkan.h>

namespace candelabra::app
{

// ContextOptions::engineFunctions with which the engine's pipelines can be watched.
PFN_vkVoidFunction VKAPI_CALL watchedFunctions(VkInstance instance, const char* name);

// At most one per thread at a time.
class PipelineWatch
{
public:
    // While this object exists, `before` is called before each pipeline that the engine creates on
    // this thread. `announced` is the number of pipelines that have been announced, or 0 if none
    // have. If `before` returns false, the pipeline is not created, and the engine fails.
    explicit PipelineWatch(std::function<bool(uint32_t announced)> before);
    ~PipelineWatch();
    PipelineWatch(const PipelineWatch&) = delete;
    PipelineWatch& operator=(const PipelineWatch&) = delete;

    // Tells whether there is an object of this class on this thread.
    static bool watches();
    // To be called before pipelines are created, if watches() is true.
    static void announce(uint32_t pipelines);
};

} // namespace candelabra::app
