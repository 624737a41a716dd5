// SPDX-License-Identifier: Apache-2.0
// The C ABI of the exposure module.

#include "exposure/exposure_module.h"
#include "gpu/planning.h"

using namespace candelabra;

struct CndExposure_T {
    exposure::Exposure impl;
};

CndResult cndCreateExposure(const CndDeviceDesc* device, const CndExposureDesc* desc,
                            CndExposure* exposure, CndError* error)
{
    return gpu::guard(error, [&] {
        gpu::requireNotNull("cndCreateExposure", {device, desc, exposure});
        *exposure = new CndExposure_T{.impl = exposure::Exposure(*device, *desc)};
    });
}

CndResult cndPlanExposure(const CndDeviceDesc* device, const CndExposureDesc* desc,
                          CndMemoryUsage* usage, CndError* error)
{
    return gpu::guard(error, [&] {
        gpu::requireNotNull("cndPlanExposure", {device, desc, usage});
        const gpu::Planning planning(*device);
        exposure::Exposure(planning.desc(), *desc).device().readUsage(*usage);
    });
}

CndResult cndGetExposureMemory(CndExposure exposure, CndMemoryUsage* usage, CndError* error)
{
    return gpu::guard(error, [&] {
        gpu::requireNotNull("cndGetExposureMemory", {exposure, usage});
        exposure->impl.device().readUsage(*usage);
    });
}

void cndDestroyExposure(CndExposure exposure)
{
    delete exposure;
}

CndResult cndSetExposureMask(CndExposure exposure, const uint8_t* weights, uint32_t width,
                             uint32_t height, CndError* error)
{
    return gpu::guard(error, [&] {
        gpu::requireNotNull("cndSetExposureMask", {exposure, weights});
        exposure->impl.setMask(weights, width, height);
    });
}

CndResult cndRecordExposure(CndExposure exposure, VkCommandBuffer cmd,
                            const CndExposureFrame* frame, CndError* error)
{
    return gpu::guard(error, [&] {
        gpu::requireNotNull("cndRecordExposure", {exposure, cmd, frame});
        exposure->impl.record(cmd, *frame);
    });
}

CndResult cndGetExposureStats(CndExposure exposure, uint32_t frameSlot, CndExposureStats* stats)
{
    return exposure && stats ? exposure->impl.stats(frameSlot, *stats) : CND_ERROR_INVALID_ARGUMENT;
}
