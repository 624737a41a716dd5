// SPDX-License-Identifier: Apache-2.0
// The C ABI of the environment module.
#include "environment/environment_module.h"
#include "gpu/planning.h"

using namespace candelabra;

struct CndEnvironment_T {
    environment::Environment impl;
};

CndResult cndCreateEnvironment(const CndDeviceDesc* device, const CndEnvironmentDesc* desc,
                               CndEnvironment* environment, CndError* error)
{
    return gpu::guard(error, [&] {
        gpu::requireNotNull("cndCreateEnvironment", {device, desc, environment});
        *environment = new CndEnvironment_T{.impl = environment::Environment(*device, *desc)};
    });
}

CndResult cndPlanEnvironment(const CndDeviceDesc* device, const CndEnvironmentDesc* desc,
                             CndMemoryUsage* usage, CndError* error)
{
    return gpu::guard(error, [&] {
        gpu::requireNotNull("cndPlanEnvironment", {device, desc, usage});
        const gpu::Planning planning(*device);
        environment::Environment(planning.desc(), *desc).device().readUsage(*usage);
    });
}

CndResult cndGetEnvironmentMemory(CndEnvironment environment, CndMemoryUsage* usage,
                                  CndError* error)
{
    return gpu::guard(error, [&] {
        gpu::requireNotNull("cndGetEnvironmentMemory", {environment, usage});
        environment->impl.device().readUsage(*usage);
    });
}

void cndDestroyEnvironment(CndEnvironment environment)
{
    delete environment;
}

CndResult cndRecordEnvironmentMap(CndEnvironment environment, VkCommandBuffer cmd,
                                  const CndEnvironmentMap* map, CndError* error)
{
    return gpu::guard(error, [&] {
        gpu::requireNotNull("cndRecordEnvironmentMap", {environment, cmd, map});
        environment->impl.recordMap(cmd, *map);
    });
}

CndResult cndRecordEnvironment(CndEnvironment environment, VkCommandBuffer cmd,
                               const CndEnvironmentFrame* frame, CndError* error)
{
    return gpu::guard(error, [&] {
        gpu::requireNotNull("cndRecordEnvironment", {environment, cmd, frame});
        environment->impl.record(cmd, *frame);
    });
}

CndResult cndGetEnvironmentStats(CndEnvironment environment, uint32_t frameSlot,
                                 CndEnvironmentStats* stats)
{
    return environment && stats ? environment->impl.stats(frameSlot, *stats)
                                : CND_ERROR_INVALID_ARGUMENT;
}
