// SPDX-License-Identifier: Apache-2.0
// Shows that the comparison with brute force can fail: one light is taken out of one tile's list,
// between culling and shading, and the difference must be noticed. The list lives inside the
// module, so the test interposes functions of the host's Vulkan to find and change it.
#include "gpu/lighting_harness.h"

#include <limits>

#include "shared/clusters.h"

namespace candelabra::test
{
namespace
{

// State of the one interposed device; Vulkan's function pointers carry no context.
struct Interposer {
    PFN_vkGetInstanceProcAddr getInstanceProcAddr = nullptr;
    PFN_vkGetDeviceProcAddr getDeviceProcAddr = nullptr;
    PFN_vkCreateBuffer createBuffer = nullptr;
    PFN_vkSetDebugUtilsObjectNameEXT setName = nullptr;
    PFN_vkCmdBeginDebugUtilsLabelEXT beginLabel = nullptr;
    VkBuffer entries = VK_NULL_HANDLE;
    uint32_t entry = 0;       // index in the list buffer ...
    uint32_t replacement = 0; // ... and the light written there
    bool armed = false;
    int written = 0;
} interposer;

VkResult VKAPI_CALL createBuffer(VkDevice device, const VkBufferCreateInfo* info,
                                 const VkAllocationCallbacks* callbacks, VkBuffer* buffer)
{
    VkBufferCreateInfo writable = *info;
    writable.usage |= VK_BUFFER_USAGE_TRANSFER_DST_BIT;
    return interposer.createBuffer(device, &writable, callbacks, buffer);
}

VkResult VKAPI_CALL setName(VkDevice device, const VkDebugUtilsObjectNameInfoEXT* info)
{
    if (std::string(info->pObjectName) == "list entries" &&
        info->objectType == VK_OBJECT_TYPE_BUFFER)
        interposer.entries = reinterpret_cast<VkBuffer>(info->objectHandle);
    return interposer.setName(device, info);
}

void VKAPI_CALL beginLabel(VkCommandBuffer cmd, const VkDebugUtilsLabelEXT* label)
{
    if (interposer.armed && std::string(label->pLabelName) == "shade_tiles") {
        fullBarrier(cmd);
        vkCmdFillBuffer(cmd, interposer.entries, interposer.entry * sizeof(uint32_t),
                        sizeof(uint32_t), interposer.replacement);
        fullBarrier(cmd);
        ++interposer.written;
    }
    interposer.beginLabel(cmd, label);
}

PFN_vkVoidFunction VKAPI_CALL getDeviceProcAddr(VkDevice device, const char* name)
{
    if (std::string(name) == "vkCreateBuffer")
        return reinterpret_cast<PFN_vkVoidFunction>(createBuffer);
    return interposer.getDeviceProcAddr(device, name);
}

PFN_vkVoidFunction VKAPI_CALL getInstanceProcAddr(VkInstance instance, const char* name)
{
    const std::string function = name;
    if (function == "vkGetDeviceProcAddr")
        return reinterpret_cast<PFN_vkVoidFunction>(getDeviceProcAddr);
    if (function == "vkSetDebugUtilsObjectNameEXT")
        return reinterpret_cast<PFN_vkVoidFunction>(setName);
    if (function == "vkCmdBeginDebugUtilsLabelEXT")
        return reinterpret_cast<PFN_vkVoidFunction>(beginLabel);
    return interposer.getInstanceProcAddr(instance, name);
}

CndDeviceDesc interpose(const CndDeviceDesc& host)
{
    const auto find = [&](const char* name) {
        return host.getInstanceProcAddr(host.instance, name);
    };
    interposer.getInstanceProcAddr = host.getInstanceProcAddr;
    interposer.getDeviceProcAddr =
        reinterpret_cast<PFN_vkGetDeviceProcAddr>(find("vkGetDeviceProcAddr"));
    interposer.createBuffer = reinterpret_cast<PFN_vkCreateBuffer>(
        interposer.getDeviceProcAddr(host.device, "vkCreateBuffer"));
    interposer.setName =
        reinterpret_cast<PFN_vkSetDebugUtilsObjectNameEXT>(find("vkSetDebugUtilsObjectNameEXT"));
    interposer.beginLabel =
        reinterpret_cast<PFN_vkCmdBeginDebugUtilsLabelEXT>(find("vkCmdBeginDebugUtilsLabelEXT"));
    CndDeviceDesc desc = host;
    desc.getInstanceProcAddr = getInstanceProcAddr;
    return desc;
}

} // namespace

TEST_F(LightingTest, DeletingOneLightFromOneTileIsNoticed)
{
    if (!deviceDesc().debugUtilsEnabled)
        FAIL() << "VK_EXT_debug_utils is needed to find the list buffer by its name";
    const CpuGBuffer g = randomGBuffer(64, 64, 5);
    std::vector<CndLight> lights = randomSpheres(g, 50, 5);
    for (CndLight& light : lights) {
        light.influenceRadius = 40; // every tile lists every light ...
        light.position[2] = -1.5f;  // ... and faces it: the nearest wall is 3 m away
    }
    CndLight dark = lights[0];
    dark.emission[0] = dark.emission[1] = dark.emission[2] = 0;
    // Largest influence and farthest along every axis: the last in the order of the lights.
    dark.influenceRadius = std::numeric_limits<float>::infinity();
    dark.position[0] = dark.position[1] = dark.position[2] = 1e6f;
    lights.push_back(dark);

    const CndDeviceDesc host = interpose(deviceDesc());
    const LightingResult brute = run(g, lights, {.culling = CND_CULLING_BRUTE});
    interposer.armed = false;
    const LightingResult intact = run(g, lights, {.host = &host});
    EXPECT_LE(maxRelativeDifference(intact.radiance, brute.radiance), 1e-6);

    // Lists are made block by block, then tile by tile, a page each. Of blocks there are at most 4
    // of 32x32 and one of 128x128 pixels with 8 slices each; so this page is a tile's.
    constexpr uint32_t tilePage = 5 * 8 + 3;
    interposer.armed = true;
    interposer.replacement = uint32_t(lights.size()) - 1;
    uint32_t noticed = 0;
    for (uint32_t entry = 0; entry < 50; entry += 7) {
        interposer.entry = tilePage * gpu::PAGE_WORDS + 1 + entry;
        const LightingResult broken = run(g, lights, {.host = &host});
        noticed += maxRelativeDifference(broken.radiance, brute.radiance) > 1e-6;
    }
    EXPECT_EQ(interposer.written, 8);
    EXPECT_EQ(noticed, 8u);
}

} // namespace candelabra::test
