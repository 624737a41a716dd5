// SPDX-License-Identifier: Apache-2.0
// CompileOnlyDevice: a Vulkan device on which the engine's modules can be created, but which runs
// nothing. Their pipelines are compiled by the driver. Buffers, images and descriptors are not made
// at all, so a driver without a GPU suffices: RADV's null device has no memory.
#pragma once

#include <functional>
#include <map>
#include <string>
#include <vector>

#include "candelabra/candelabra.h"
#include "render/vulkan_instance.h"

namespace candelabra::app
{

// One pipeline as the engine asked for it.
struct PipelineRequest {
    std::string kernel; // debug name of its pipeline layout
    // Its specialisation constants, by the names that they have in the shaders.
    std::map<std::string, uint32_t> constants;
};

// One number that the driver tells about compiled code.
struct PipelineStatistic {
    std::string name;
    double value = 0;
};

// The machine code of one shader stage. Some drivers compile a stage more than once.
struct PipelineExecutable {
    PipelineRequest request;
    std::string name; // as the driver calls it
    VkShaderStageFlags stages = 0;
    uint32_t subgroupSize = 0;
    std::vector<PipelineStatistic> statistics;
};

class CompileOnlyDevice
{
public:
    // Pipelines for which `wanted` returns false are not compiled. Only one object may exist at a
    // time. Throws UsageError, RunError or gpu::Failure, as VulkanContext does.
    CompileOnlyDevice(const std::string& device,
                      std::function<bool(const PipelineRequest&)> wanted);
    ~CompileOnlyDevice();
    CompileOnlyDevice(const CompileOnlyDevice&) = delete;
    CompileOnlyDevice& operator=(const CompileOnlyDevice&) = delete;

    const DeviceInfo& info() const { return info_; }
    // The description from which modules are created.
    const CndDeviceDesc& desc() const { return desc_; }
    // The driver's reports on the pipelines so far, in the order of their creation.
    const std::vector<PipelineExecutable>& executables() const { return executables_; }

private:
    struct Functions; // what the engine calls instead of the driver

    void createDevice();
    void record(const PipelineRequest& request, VkPipeline pipeline);

    VulkanInstance instance_;
    DeviceInfo info_;
    std::function<bool(const PipelineRequest&)> wanted_;
    VkDevice device_ = VK_NULL_HANDLE;
    CndDeviceDesc desc_{};
    std::map<VkShaderModule, std::map<uint32_t, std::string>> constantNames_;
    std::map<VkPipelineLayout, std::string> layoutNames_;
    std::vector<PipelineExecutable> executables_;
};

} // namespace candelabra::app
