// SPDX-License-Identifier: Apache-2.0
// Shows that the comparison with brute force is able to fail: one light is removed from the list of
// one tile, between culling and shading, and the difference must be noticed. The list is inside the
// module, so the test interposes the host's Vulkan functions to find and change it.
#include "gpu/lighting_harness.h"

#include <limits>

#include "shared/clusters.h"

namespace candelabra::test
{
namespace
{

// State of the interposed device, global because Vulkan's function pointers carry no context.
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

PFN_vkVoidFunction VKAPI_CALL spyDeviceProcAddr(VkDevice device, const char* name)
{
    if (std::string(name) == "vkCreateBuffer")
        return reinterpret_cast<PFN_vkVoidFunction>(createBuffer);
    return interposer.getDeviceProcAddr(device, name);
}

PFN_vkVoidFunction VKAPI_CALL spyInstanceProcAddr(VkInstance instance, const char* name)
{
    const std::string function = name;
    if (function == "vkGetDeviceProcAddr")
        return reinterpret_cast<PFN_vkVoidFunction>(spyDeviceProcAddr);
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
    desc.getInstanceProcAddr = spyInstanceProcAddr;
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
        light.position[2] = -1.5f;  // ... and faces them: the nearest wall is 3 m away
    }
    CndLight dark = lights[0];
    dark.emission[0] = dark.emission[1] = dark.emission[2] = 0;
    // With the largest influence and the largest coordinates, this light is the last in the order
    // of lights.
    dark.influenceRadius = std::numeric_limits<float>::infinity();
    dark.position[0] = dark.position[1] = dark.position[2] = 1e6f;
    lights.push_back(dark);

    const CndDeviceDesc host = interpose(deviceDesc());
    const LightingResult brute = run(g, lights, {.culling = CND_CULLING_BRUTE});
    interposer.armed = false;
    const LightingResult intact = run(g, lights, {.host = &host});
    EXPECT_LE(maxRelativeDifference(intact.radiance, brute.radiance), 1e-6);

    // Lists are made block by block, then tile by tile, one page each. There are at most 4 blocks
    // of 32x32 pixels and one of 128x128 pixels, with 8 slices each, so this page belongs to a
    // tile.
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
