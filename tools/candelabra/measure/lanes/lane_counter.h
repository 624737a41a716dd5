// SPDX-License-Identifier: Apache-2.0
// LaneCounter: lets the engine run kernels that count what each lane does, in place of its own, and
// takes a device on which lanes are a CPU's vector for a GPU, so that the engine does what it would
// do on a GPU.
#pragma once

#include <functional>
#include <span>

#include "gpu/kernel.h"
#include "render/vulkan_context.h"
#include "shared/lane_counts.h"

namespace candelabra::app
{

class LaneCounter
{
public:
    // Through this function a context must find Vulkan's functions (ContextOptions) whose modules
    // count lanes.
    static PFN_vkVoidFunction VKAPI_CALL functions(VkInstance instance, const char* name);

    // Modules that are created on the context while this object exists count lanes. Only one object
    // may exist at a time.
    explicit LaneCounter(const VulkanContext& context);
    ~LaneCounter();
    LaneCounter(const LaneCounter&) = delete;
    LaneCounter& operator=(const LaneCounter&) = delete;

    // Runs `frame`, which waits for the device, and gives `take` what it counted. If a frame has
    // more rounds than there is room for, it is run several times, and each time a part of its work
    // groups is counted.
    void count(const std::function<void()>& frame,
               const std::function<void(std::span<gpu::LaneRound>)>& take);

private:
    struct Functions;

    gpu::Buffer counts_;
    gpu::Bindings set_;
};

} // namespace candelabra::app
