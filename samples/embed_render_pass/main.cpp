// SPDX-License-Identifier: Apache-2.0
// Candelabra in a renderer that draws its G-buffer in a VkRenderPass: depth with stencil,
// world-space normals, no roughness, and radiance in half floats, which the pass clears and draws
// emission into. No barrier is recorded for the G-buffer: the dependencies of the render pass
// (pass.cpp) are enough. The program computes by hand what the pixel in the middle should be,
// prints both values, and ends with exit code 1 when they differ.
#include <cmath>
#include <cstdio>

#include "pass.h"

constexpr ImageUse exposed{VK_IMAGE_LAYOUT_GENERAL, VK_PIPELINE_STAGE_2_COMPUTE_SHADER_BIT,
                           VK_ACCESS_2_SHADER_SAMPLED_READ_BIT};

constexpr CndLight lamp{.type = CND_LIGHT_SPHERE,
                        .position = {0, 0, -1},
                        .radius = 0.1f,
                        .emission = {8000, 7000, 5000}, // luminance, cd/m^2
                        .influenceRadius = 10};
constexpr float wallDistance = 2, wallAlbedo = 0.6f, wallEmission[3] = {0.25f, 0, 0}; // wall.frag

constexpr CndGBufferDesc description{.normalEncoding = CND_NORMAL_SNORM,
                                     .normalSpace = CND_NORMALS_WORLD,
                                     .constantRoughness = 0.8f, // there is no such channel
                                     .normalRoughnessFormat = VK_FORMAT_R16G16B16A16_SFLOAT,
                                     .albedoFormat = VK_FORMAT_R8G8B8A8_UNORM,
                                     .depthFormat = VK_FORMAT_D32_SFLOAT_S8_UINT};

static CndCamera cameraOf(const Host& host)
{
    CndCamera camera{.viewFromWorld = {1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1}};
    camera.clipFromView[0] = 2 * float(host.height) / float(host.width);
    camera.clipFromView[5] = -2;
    camera.clipFromView[11] = -1;
    camera.clipFromView[14] = 0.1f; // near plane, as in wall.vert
    return camera;
}

// Draws some frames, which reuse the same images.
static void drawFrames(Host& host, const GBuffer& gbuffer)
{
    const CndDeviceDesc device = deviceOf(host);
    auto lighting = *candelabra::Lighting::create(
        device,
        {.framesInFlight = 1,
         .gbufferLayout = CND_GBUFFER_HOST,
         .specularMethods = 1u << CND_SPECULAR_NONE, // the sum by hand is without highlights
         .gbuffer = description,
         .radianceFormat = gbuffer.radiance.format});
    auto view = *lighting.createView({.maxWidth = host.width, .maxHeight = host.height});
    auto exposure = *candelabra::Exposure::create(device, {.framesInFlight = 1});
    lighting.setLights({&lamp, 1}, {0, 0, 0}).value();
    const GBufferPass pass = createPass(host, gbuffer);
    for (int frame = 0; frame < 3; ++frame) {
        const VkCommandBuffer cmd = beginFrame(&host);
        drawPass(host, pass);
        view.record(cmd, {.width = host.width,
                          .height = host.height,
                          .camera = cameraOf(host),
                          .clearDepth = 0,
                          .normalRoughness = gbuffer.normal.view,
                          .albedo = gbuffer.albedo.view,
                          .depth = gbuffer.depth.view,
                          .depthImageLayout = VK_IMAGE_LAYOUT_DEPTH_STENCIL_READ_ONLY_OPTIMAL,
                          .radiance = gbuffer.radiance.view,
                          .specularMethod = CND_SPECULAR_NONE,
                          .lobes = CND_LOBES_SUM})
            .value();
        imageBarrier(cmd, &gbuffer.radiance, storageWrite, exposed);
        imageBarrier(cmd, &host.display, overwritten, storageWrite);
        exposure
            .record(cmd, {.width = host.width,
                          .height = host.height,
                          .radiance = gbuffer.radiance.view,
                          .radianceImageLayout = VK_IMAGE_LAYOUT_GENERAL,
                          .display = host.display.view,
                          .deltaTime = 1.0f / 60,
                          .reset = frame == 0,
                          .settings = candelabra::defaultExposureSettings()})
            .value();
        endFrame(&host);
    }
    destroyPass(host, pass);
}

// Returns the value of a positive half float that is no denormal.
static float fromHalf(uint16_t half)
{
    return half ? std::ldexp(float(0x400 | (half & 0x3FF)), (half >> 10) - 25) : 0.0f;
}

int main()
{
    Host host{.width = 65, .height = 65}; // odd, so that one pixel is the middle
    createHostDevice(&host, 0, nullptr, 0, nullptr);
    host.display = createHostImage(&host, VK_FORMAT_R8G8B8A8_UNORM, host.width, host.height,
                                   VK_IMAGE_USAGE_STORAGE_BIT);
    const GBuffer gbuffer = createGBuffer(host);
    drawFrames(host, gbuffer);
    uint16_t radiance[4];
    readCentre(&host, &gbuffer.radiance, VK_IMAGE_LAYOUT_GENERAL, radiance, sizeof radiance);
    destroyGBuffer(host, gbuffer);
    destroyHostImage(&host, host.display);
    destroyHostDevice(&host);

    bool right = true;
    for (int i = 0; i < 3; ++i) {
        const float distance = wallDistance + lamp.position[2], s = lamp.radius / distance;
        const float window = 1 - std::pow(distance / lamp.influenceRadius, 4.0f);
        const float expected =
            wallEmission[i] + wallAlbedo * lamp.emission[i] * s * s * window * window;
        std::printf("channel %d: %.3f cd/m^2 (expected %.3f)\n", i, fromHalf(radiance[i]),
                    expected);
        // A half float has 11 bits, and the emission was rounded before the light.
        right = right && std::abs(fromHalf(radiance[i]) - expected) < std::ldexp(expected, -9);
    }
    std::puts(right ? "right" : "WRONG");
    return right ? 0 : 1;
}
