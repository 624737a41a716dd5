// SPDX-License-Identifier: Apache-2.0
// Candelabra from plain C: a wall in the sun, with manual exposure. Prints what the pixel in the
// middle should be and exits with 1 if it is something else.
#include <math.h>
#include <stdio.h>
#include <stdlib.h>

#include "host.h"

#define ILLUMINANCE 50000.0f // lx, on a surface that faces the sun
#define PI 3.14159265f

// Every descriptor states its size.
#define SIZED(Type) .structSize = sizeof(Type)

static void check(CndResult result, const CndError* error)
{
    if (result == CND_SUCCESS)
        return;
    fprintf(stderr, "%s\n", error->message);
    exit(2);
}

static CndExposureSettings settings(void)
{
    CndExposureSettings result;
    cndDefaultExposureSettings(&result);
    result.manual = VK_TRUE;
    result.manualEv100 = cndEv100FromCamera(16, 1.0f / 100, 100);
    result.toneMap = CND_TONEMAP_NONE;
    result.dither = VK_FALSE;
    return result;
}

static void recordFrame(Host* host, CndLightingView view, CndExposure exposure)
{
    CndError error;
    const VkCommandBuffer cmd = beginFrame(host);
    drawWall(host);
    const CndLightingFrame frame = {SIZED(CndLightingFrame),
                                    .width = host->width,
                                    .height = host->height,
                                    .camera = host->camera,
                                    .clearDepth = 0,
                                    .normalRoughness = host->normalRoughness.view,
                                    .albedo = host->albedo.view,
                                    .specular = host->specular.view,
                                    .depth = host->depth.view,
                                    .radiance = host->radiance.view,
                                    .specularMethod = CND_SPECULAR_CONIC};
    check(cndRecordLighting(view, cmd, &frame, &error), &error);
    const ImageUse written = {VK_IMAGE_LAYOUT_GENERAL, VK_PIPELINE_STAGE_2_COMPUTE_SHADER_BIT,
                              VK_ACCESS_2_SHADER_STORAGE_WRITE_BIT};
    const ImageUse read = {VK_IMAGE_LAYOUT_SHADER_READ_ONLY_OPTIMAL,
                           VK_PIPELINE_STAGE_2_COMPUTE_SHADER_BIT,
                           VK_ACCESS_2_SHADER_SAMPLED_READ_BIT};
    imageBarrier(cmd, &host->radiance, written, read);
    const CndExposureFrame display = {
        SIZED(CndExposureFrame),         .width = host->width,          .height = host->height,
        .radiance = host->radiance.view, .display = host->display.view, .settings = settings()};
    check(cndRecordExposure(exposure, cmd, &display, &error), &error);
    endFrame(host);
}

static void draw(Host* host)
{
    CndError error;
    const CndDeviceDesc device = {SIZED(CndDeviceDesc), .instance = host->instance,
                                  .physicalDevice = host->physicalDevice, .device = host->device,
                                  .getInstanceProcAddr = vkGetInstanceProcAddr};
    const CndLightingDesc lightingDesc = {SIZED(CndLightingDesc), .framesInFlight = 1};
    CndLighting lighting;
    check(cndCreateLighting(&device, &lightingDesc, &lighting, &error), &error);
    const CndLightingViewDesc viewDesc = {SIZED(CndLightingViewDesc), .maxWidth = host->width,
                                          .maxHeight = host->height};
    CndLightingView view;
    check(cndCreateLightingView(lighting, &viewDesc, &view, &error), &error);
    const CndExposureDesc exposureDesc = {SIZED(CndExposureDesc), .framesInFlight = 1};
    CndExposure exposure;
    check(cndCreateExposure(&device, &exposureDesc, &exposure, &error), &error);

    const CndLight sun = {.type = CND_LIGHT_DIRECTIONAL,
                          .direction = {0, 0, -1},
                          .emission = {ILLUMINANCE, ILLUMINANCE, ILLUMINANCE}};
    const CndLightSet set = {SIZED(CndLightSet), .count = 1, .lights = &sun};
    check(cndSetLights(lighting, &set, &error), &error);
    recordFrame(host, view, exposure);

    cndDestroyExposure(exposure);
    cndDestroyLightingView(view); // the view must be destroyed before its lighting
    cndDestroyLighting(lighting);
}

static float srgb(float linear)
{
    return linear < 0.0031308f ? 12.92f * linear : 1.055f * powf(linear, 1 / 2.4f) - 0.055f;
}

int main(void)
{
    if (cndGetVersion() >> 12 != CND_VERSION >> 12) {
        fprintf(stderr, "compiled for another version of Candelabra\n");
        return 2;
    }
    Host host = createHost(64, 64);
    draw(&host);
    float radiance[4];
    unsigned char display[4];
    readCentre(&host, &host.radiance, VK_IMAGE_LAYOUT_SHADER_READ_ONLY_OPTIMAL, radiance,
               sizeof radiance);
    readCentre(&host, &host.display, VK_IMAGE_LAYOUT_GENERAL, display, sizeof display);
    destroyHost(&host);

    // The luminance of a Lambertian surface is albedo / pi times its illuminance.
    const float expected = WALL_ALBEDO / PI * ILLUMINANCE;
    const CndExposureSettings used = settings();
    const float exposed = expected * cndExposureFromEv100(used.manualEv100, used.middleGrey);
    const float expectedDisplay = 255 * srgb(exposed);
    printf("%.3f cd/m^2 (expected %.3f), on the display %d (%.1f)\n", radiance[0], expected,
           display[0], expectedDisplay);
    const int right = fabsf(radiance[0] - expected) < 1e-5f * expected &&
                      fabsf((float)display[0] - expectedDisplay) <= 0.51f;
    puts(right ? "right" : "WRONG");
    return right ? 0 : 1;
}
