// SPDX-License-Identifier: Apache-2.0
// The README's embedding listing, compiled. tests/structure compares the text between the marks.
// [readme]
#include <candelabra/candelabra.hpp>

struct MyLighting { // one per view; everything Vulkan is yours
    candelabra::Lighting lighting;
    candelabra::LightingView view;
    candelabra::Exposure exposure;
};

// `device` holds your VkInstance, VkPhysicalDevice, VkDevice and vkGetInstanceProcAddr.
bool create(MyLighting& my, const CndDeviceDesc& device, uint32_t width, uint32_t height)
{
    auto lighting = candelabra::Lighting::create(device, {.framesInFlight = 2});
    auto exposure = candelabra::Exposure::create(device, {.framesInFlight = 2});
    if (!lighting || !exposure)
        return false; // lighting.error().message says what is missing
    auto view = lighting.value().createView({.maxWidth = width, .maxHeight = height});
    if (!view)
        return false;
    my.view = std::move(view.value()); // an old view goes before its lighting
    my.lighting = std::move(lighting.value());
    my.exposure = std::move(exposure.value());

    const CndLight lamp{.type = CND_LIGHT_SPHERE,
                        .position = {0, 2, 0}, // metres, relative to `origin`
                        .radius = 0.1f,
                        .emission = {8000, 7000, 5000}, // cd/m^2
                        .influenceRadius = 10};
    const double origin[3] = {0, 0, 0};
    return bool(my.lighting.setLights({&lamp, 1}, origin));
}

// After your G-buffer pass; layouts and barriers stand at CndLightingFrame and CndExposureFrame.
bool record(const MyLighting& my, VkCommandBuffer cmd, const CndLightingFrame& gbuffer,
            const CndExposureFrame& display, VkImageMemoryBarrier2 radianceToShaderRead,
            PFN_vkCmdPipelineBarrier2 barrier)
{
    if (!my.view.record(cmd, gbuffer)) // culls, shades, adds to gbuffer.radiance
        return false;
    const VkDependencyInfo readable{.sType = VK_STRUCTURE_TYPE_DEPENDENCY_INFO,
                                    .imageMemoryBarrierCount = 1,
                                    .pImageMemoryBarriers = &radianceToShaderRead};
    barrier(cmd, &readable);
    return bool(my.exposure.record(cmd, display)); // adapts the eye, tone maps to 8 bits
}
// [readme]
