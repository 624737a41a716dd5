// SPDX-License-Identifier: Apache-2.0
// PipelineStore: pipelines and shaders that all tests of a process share. Most of the time of tests
// would be spent on creating equal ones, and on validating them. Each one is still created and
// validated once. A test that needs more, such as a device of its own, gets Vulkan's functions.
#pragma once

#include <vulkan/vulkan.h>

namespace candelabra::test
{

class PipelineStore
{
public:
    // ContextOptions::engineFunctions with which the pipelines of `device` are shared. What has the
    // same description gets the same handle. What has allocation callbacks, or a description with
    // parts that are not compared, is not shared.
    static PFN_vkVoidFunction VKAPI_CALL functions(VkInstance instance, const char* name);

    explicit PipelineStore(VkDevice device);
    // Destroys what has no users. The rest is destroyed with its last user, or reported as a leak.
    ~PipelineStore();
    PipelineStore(const PipelineStore&) = delete;
    PipelineStore& operator=(const PipelineStore&) = delete;
};

} // namespace candelabra::test
