// SPDX-License-Identifier: Apache-2.0
// The C ABI of the lighting module and the device contract.
#include <cstdio>
#include <deque>
#include <span>

#include "gpu/planning.h"
#include "lighting/lighting_module.h"
#include "lights/light_limits.h"

using namespace candelabra;

struct CndLightingView_T {
    CndLightingView_T(lighting::Lighting& of, const CndLightingViewDesc& desc)
        : lighting(of), impl(of.module(), desc)
    {
        lighting.add(&impl);
    }
    ~CndLightingView_T() { lighting.remove(&impl); }
    CndLightingView_T(const CndLightingView_T&) = delete;
    CndLightingView_T& operator=(const CndLightingView_T&) = delete;

    lighting::Lighting& lighting;
    lighting::View impl;
};

uint32_t cndGetVersion(void)
{
    return CND_VERSION;
}

CndResult cndCheckDevice(const CndDeviceDesc* device, uint32_t modules, CndError* error)
{
    return gpu::guard(error, [&] {
        gpu::requireNotNull("cndCheckDevice", {device});
        const gpu::Parts parts = gpu::modulesOf("cndCheckDevice", modules);
        gpu::requireNeeds(gpu::InstanceFunctions(*device), *device, parts);
    });
}

CndResult cndRequireFeatures(uint32_t modules, VkPhysicalDeviceFeatures2* features, CndError* error)
{
    return gpu::guard(error, [&] {
        gpu::requireNotNull("cndRequireFeatures", {features});
        gpu::requireFeatures(*features, gpu::modulesOf("cndRequireFeatures", modules));
    });
}

uint32_t cndMaxLightCount(const VkPhysicalDeviceLimits* limits)
{
    return lighting::maxLights(*limits);
}

CndResult cndCreateLighting(const CndDeviceDesc* device, const CndLightingDesc* desc,
                            CndLighting* lighting, CndError* error)
{
    return gpu::guard(error, [&] {
        gpu::requireNotNull("cndCreateLighting", {device, desc, lighting});
        *lighting = new CndLighting_T{.impl = lighting::Lighting(*device, *desc)};
    });
}

CndResult cndPlanLighting(const CndDeviceDesc* device, const CndLightingDesc* desc,
                          uint32_t viewCount, const CndLightingViewDesc* views,
                          CndMemoryUsage* usage, CndError* error)
{
    return gpu::guard(error, [&] {
        gpu::requireNotNull("cndPlanLighting", {device, desc, usage});
        if (viewCount)
            gpu::requireNotNull("cndPlanLighting", {views});
        const gpu::Planning planning(*device);
        lighting::Lighting lighting(planning.desc(), *desc);
        std::deque<lighting::View> made; // a deque does not move its elements when it grows
        for (const CndLightingViewDesc& view : std::span(views, viewCount))
            made.emplace_back(lighting.module(), view);
        lighting.device().readUsage(*usage);
    });
}

CndResult cndGetLightingMemory(CndLighting lighting, CndMemoryUsage* usage, CndError* error)
{
    return gpu::guard(error, [&] {
        gpu::requireNotNull("cndGetLightingMemory", {lighting, usage});
        lighting->impl.device().readUsage(*usage);
    });
}

void cndDestroyLighting(CndLighting lighting)
{
    delete lighting;
}

CndResult cndAddLightingPipelines(CndLighting lighting, const CndLightingPipelines* pipelines,
                                  CndError* error)
{
    return gpu::guard(error, [&] {
        gpu::requireNotNull("cndAddLightingPipelines", {lighting, pipelines});
        lighting->impl.addPipelines(*pipelines);
    });
}

CndResult cndSetLights(CndLighting lighting, const CndLightSet* set, CndError* error)
{
    return gpu::guard(error, [&] {
        gpu::requireNotNull("cndSetLights", {lighting, set});
        lighting->impl.lights().set(*set);
    });
}

CndResult cndAddLights(CndLighting lighting, uint32_t count, const CndLight* lights,
                       CndLightId* ids, CndError* error)
{
    return gpu::guard(error, [&] {
        gpu::requireNotNull("cndAddLights", {lighting});
        if (count)
            gpu::requireNotNull("cndAddLights", {lights, ids});
        lighting->impl.lights().add({lights, count}, ids);
    });
}

CndResult cndUpdateLights(CndLighting lighting, uint32_t count, const CndLightId* ids,
                          const CndLight* lights, CndError* error)
{
    return gpu::guard(error, [&] {
        gpu::requireNotNull("cndUpdateLights", {lighting});
        if (count)
            gpu::requireNotNull("cndUpdateLights", {ids, lights});
        lighting->impl.lights().update({ids, count}, {lights, count});
    });
}

CndResult cndRemoveLights(CndLighting lighting, uint32_t count, const CndLightId* ids,
                          CndError* error)
{
    return gpu::guard(error, [&] {
        gpu::requireNotNull("cndRemoveLights", {lighting});
        if (count)
            gpu::requireNotNull("cndRemoveLights", {ids});
        lighting->impl.lights().remove({ids, count});
    });
}

CndResult cndAddOccluderMeshes(CndLighting lighting, uint32_t count, const CndOccluderMesh* meshes,
                               CndOccluderMeshId* ids, CndError* error)
{
    return gpu::guard(error, [&] {
        gpu::requireNotNull("cndAddOccluderMeshes", {lighting});
        if (count)
            gpu::requireNotNull("cndAddOccluderMeshes", {meshes, ids});
        lighting->impl.occluders("cndAddOccluderMeshes").addMeshes({meshes, count}, ids);
    });
}

CndResult cndReplaceOccluderPositions(CndLighting lighting, CndOccluderMeshId mesh,
                                      const float* positions, uint32_t stride, CndError* error)
{
    return gpu::guard(error, [&] {
        gpu::requireNotNull("cndReplaceOccluderPositions", {lighting});
        gpu::requireNotNull("cndReplaceOccluderPositions", {positions});
        lighting->impl.occluders("cndReplaceOccluderPositions")
            .replacePositions(mesh, positions, stride);
    });
}

CndResult cndReplaceOccluderPositionsOnDevice(CndLighting lighting, uint32_t count,
                                              const CndDevicePositions* positions, CndError* error)
{
    return gpu::guard(error, [&] {
        const char* const call = "cndReplaceOccluderPositionsOnDevice";
        gpu::requireNotNull(call, {lighting});
        if (count)
            gpu::requireNotNull(call, {positions});
        lighting->impl.occluders(call).replacePositionsOnDevice({positions, count});
    });
}

CndResult cndRemoveOccluderMeshes(CndLighting lighting, uint32_t count,
                                  const CndOccluderMeshId* ids, CndError* error)
{
    return gpu::guard(error, [&] {
        gpu::requireNotNull("cndRemoveOccluderMeshes", {lighting});
        if (count)
            gpu::requireNotNull("cndRemoveOccluderMeshes", {ids});
        lighting->impl.occluders("cndRemoveOccluderMeshes").removeMeshes({ids, count});
    });
}

CndResult cndAddOccluders(CndLighting lighting, uint32_t count,
                          const CndOccluderInstance* instances, CndOccluderId* ids, CndError* error)
{
    return gpu::guard(error, [&] {
        gpu::requireNotNull("cndAddOccluders", {lighting});
        if (count)
            gpu::requireNotNull("cndAddOccluders", {instances, ids});
        lighting->impl.occluders("cndAddOccluders").add({instances, count}, ids);
    });
}

CndResult cndUpdateOccluders(CndLighting lighting, uint32_t count, const CndOccluderId* ids,
                             const CndOccluderInstance* instances, CndError* error)
{
    return gpu::guard(error, [&] {
        gpu::requireNotNull("cndUpdateOccluders", {lighting});
        if (count)
            gpu::requireNotNull("cndUpdateOccluders", {ids, instances});
        lighting->impl.occluders("cndUpdateOccluders").update({ids, count}, {instances, count});
    });
}

CndResult cndRemoveOccluders(CndLighting lighting, uint32_t count, const CndOccluderId* ids,
                             CndError* error)
{
    return gpu::guard(error, [&] {
        gpu::requireNotNull("cndRemoveOccluders", {lighting});
        if (count)
            gpu::requireNotNull("cndRemoveOccluders", {ids});
        lighting->impl.occluders("cndRemoveOccluders").remove({ids, count});
    });
}

CndResult cndCreateLightingView(CndLighting lighting, const CndLightingViewDesc* desc,
                                CndLightingView* view, CndError* error)
{
    return gpu::guard(error, [&] {
        gpu::requireNotNull("cndCreateLightingView", {lighting, desc, view});
        *view = new CndLightingView_T(lighting->impl, *desc);
    });
}

void cndDestroyLightingView(CndLightingView view)
{
    delete view;
}

CndResult cndRecordLighting(CndLightingView view, VkCommandBuffer cmd,
                            const CndLightingFrame* frame, CndError* error)
{
    return gpu::guard(error, [&] {
        gpu::requireNotNull("cndRecordLighting", {view, cmd, frame});
        view->impl.record(cmd, *frame);
    });
}

CndResult cndRecordSurfaceOverlay(CndLightingView view, VkCommandBuffer cmd,
                                  const CndLightingFrame* frame, const CndSurfaceOverlay* overlay,
                                  CndError* error)
{
    return gpu::guard(error, [&] {
        gpu::requireNotNull("cndRecordSurfaceOverlay", {view, cmd, frame, overlay});
        view->impl.recordOverlay(cmd, *frame, *overlay);
    });
}

CndResult cndGetForwardSetLayout(CndLighting lighting, VkDescriptorSetLayout* layout,
                                 CndError* error)
{
    return gpu::guard(error, [&] {
        gpu::requireNotNull("cndGetForwardSetLayout", {lighting, layout});
        *layout = lighting->impl.forwardLayout();
    });
}

CndResult cndGetForwardSet(CndLightingView view, uint32_t frameSlot, VkDescriptorSet* set,
                           CndError* error)
{
    return gpu::guard(error, [&] {
        gpu::requireNotNull("cndGetForwardSet", {view, set});
        *set = view->impl.forwardSet(frameSlot);
    });
}

CndResult cndGetLightingStats(CndLightingView view, uint32_t frameSlot, CndLightingStats* stats)
{
    if (!view || !stats)
        return CND_ERROR_INVALID_ARGUMENT;
    const CndResult result = view->impl.stats(frameSlot, *stats);
    if (result == CND_SUCCESS)
        view->impl.reportProblems(*stats);
    return result;
}
