// SPDX-License-Identifier: Apache-2.0
// Candelabra in a Vulkan program: one frame of a lamp in front of a wall, without a window. The
// program computes by hand what the pixel in the middle should be, prints both values, and ends
// with exit code 1 when they differ.
#include <algorithm>
#include <cmath>
#include <cstdio>

#include "host.hpp"

constexpr CndLight lamp{.type = CND_LIGHT_SPHERE,
                        .position = {0, 0, -1}, // metres, relative to the origin of the set
                        .radius = 0.1f,
                        .emission = {8000, 7000, 5000}, // luminance, cd/m^2
                        .influenceRadius = 10};

CndExposureStats drawFrame(Host& host)
{
    const CndDeviceDesc device{.instance = host.instance, // borrowed, like everything you pass
                               .physicalDevice = host.physicalDevice,
                               .device = host.device,
                               .getInstanceProcAddr = vkGetInstanceProcAddr};
    auto lighting = *candelabra::Lighting::create(device, {.framesInFlight = 1});
    auto view = *lighting.createView({.maxWidth = host.width, .maxHeight = host.height});
    auto exposure = *candelabra::Exposure::create(device, {.framesInFlight = 1});
    // [readme]
    lighting.setLights({&lamp, 1}, {0, 0, 0}).value();

    VkCommandBuffer cmd = beginFrame(&host);
    drawWall(&host); // your G-buffer pass; it clears the radiance image or draws emission into it
    const CndLightingFrame frame{.width = host.width,
                                 .height = host.height,
                                 .camera = host.camera,
                                 .clearDepth = 0, // depth without a surface (reversed depth)
                                 .normalRoughness = host.normalRoughness.view,
                                 .albedo = host.albedo.view,
                                 .specular = host.specular.view,
                                 .depth = host.depth.view,
                                 .radiance = host.radiance.view,
                                 .specularMethod = CND_SPECULAR_CONIC};
    view.record(cmd, frame).value(); // value() prints what failed, and ends the program
    // [readme]
    imageBarrier(cmd, &host.radiance, storageWrite, sampledRead);
    const CndExposureFrame display{.width = host.width,
                                   .height = host.height,
                                   .radiance = host.radiance.view,
                                   .display = host.display.view,
                                   .reset = true, // first frame: no earlier one to adapt from
                                   .settings = candelabra::defaultExposureSettings()};
    exposure.record(cmd, display).value();
    endFrame(&host);
    return *exposure.stats(0).value(); // does not wait: endFrame() has waited for this frame
}

// Luminance of a Lambertian wall that faces a sphere light at distance d: albedo times luminance
// times (radius / d)^2, times the window that ends the lamp's influence.
static float wallLuminance(int channel)
{
    const float distance = WALL_DISTANCE + lamp.position[2];
    const float s = lamp.radius / distance;
    const float window = 1 - std::pow(distance / lamp.influenceRadius, 4.0f);
    return WALL_ALBEDO * lamp.emission[channel] * s * s * window * window;
}

// The display value of a channel: the PBR Neutral tone map (Khronos 2024), below the point where it
// starts to compress highlights, then the sRGB curve. The exposed values have been multiplied by
// TONE_MAP_SCALE, with which this tone map shows 0.18 as 0.18.
constexpr float TONE_MAP_SCALE = 0.22f / 0.18f;
static float displayed(float exposed, float darkest)
{
    const float offset = darkest < 0.08f ? darkest - 6.25f * darkest * darkest : 0.04f;
    const float linear = exposed - offset;
    return 255 *
           (linear < 0.0031308f ? 12.92f * linear : 1.055f * std::pow(linear, 1 / 2.4f) - 0.055f);
}

int main()
{
    Host host = createHost(65, 65); // odd, so that one pixel is the middle
    const float exposure = TONE_MAP_SCALE * drawFrame(host).exposure;
    float radiance[4];
    unsigned char display[4];
    readCentre(&host, &host.radiance, VK_IMAGE_LAYOUT_SHADER_READ_ONLY_OPTIMAL, radiance,
               sizeof radiance);
    readCentre(&host, &host.display, VK_IMAGE_LAYOUT_GENERAL, display, sizeof display);
    destroyHost(&host);

    bool right = true;
    const float darkest =
        exposure * std::min({wallLuminance(0), wallLuminance(1), wallLuminance(2)});
    for (int i = 0; i < 3; ++i) {
        const float expected = wallLuminance(i);
        const float expectedDisplay = displayed(exposure * expected, darkest);
        std::printf("channel %d: %.5f cd/m^2 (expected %.5f), on the display %d (%.1f)\n", i,
                    radiance[i], expected, display[i], expectedDisplay);
        right = right && std::abs(radiance[i] - expected) < 1e-5f * expected &&
                std::abs(float(display[i]) - expectedDisplay) < 2; // rounded and dithered
    }
    std::puts(right ? "right" : "WRONG");
    return right ? 0 : 1;
}
