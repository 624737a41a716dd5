// SPDX-License-Identifier: Apache-2.0
// A split screen: two cameras share the images, the lights and one exposure. Each half of the
// images is a frame of its own, a rectangle at CndLightingFrame::x and y. The program computes by
// hand what the pixels in the middle of both halves should be, prints all values, and ends with
// exit code 1 when they differ.
#include <cmath>
#include <cstdio>
#include <vector>

#include "host.hpp"

constexpr CndLight lamp{.type = CND_LIGHT_SPHERE,
                        .position = {0, 0, -1},
                        .radius = 0.1f,
                        .emission = {8000, 7000, 5000}, // cd/m^2
                        .influenceRadius = 10};
constexpr float eyes[] = {0, 0.75f}; // x of the two cameras, metres
constexpr uint32_t halfWidth = 33, height = 33;

static CndExposureStats drawFrame(Host& host)
{
    auto lighting = *candelabra::Lighting::create(deviceOf(host), {.framesInFlight = 1});
    // One view per camera, as large as its part of the images.
    const CndLightingViewDesc half{.maxWidth = halfWidth, .maxHeight = height};
    candelabra::LightingView views[] = {*lighting.createView(half), *lighting.createView(half)};
    auto exposure = *candelabra::Exposure::create(deviceOf(host), {.framesInFlight = 1});
    lighting.setLights({&lamp, 1}, {0, 0, 0}).value();

    const VkCommandBuffer cmd = beginFrame(&host);
    drawWall(&host); // your G-buffer pass, once per half with a viewport and scissor of its own
    for (uint32_t i = 0; i < 2; ++i) {
        CndLightingFrame frame = wallFrame(host);
        frame.x = i * halfWidth;
        frame.width = halfWidth;
        frame.camera.clipFromView[0] *= float(host.width) / halfWidth; // the projection of the half
        frame.camera.viewFromWorld[12] = -double(eyes[i]);
        views[i].record(cmd, frame).value();
    }
    imageBarrier(cmd, &host.radiance, storageWrite, sampledRead);
    // One frame over the whole image meters both halves and displays both with one exposure.
    const CndExposureFrame both{.width = host.width,
                                .height = host.height,
                                .radiance = host.radiance.view,
                                .display = host.display.view,
                                .reset = true,
                                .settings = candelabra::defaultExposureSettings()};
    exposure.record(cmd, both).value();
    endFrame(&host);
    return *exposure.stats(0).value();
}

// Luminance of the Lambertian wall straight ahead of a camera: albedo times luminance times
// (radius / d)^2 times the cosine, times the window that ends the lamp's influence.
static float wallLuminance(float eye, int channel)
{
    const float ahead = WALL_DISTANCE + lamp.position[2];
    const float d = std::hypot(ahead, eye - lamp.position[0]), s = lamp.radius / d;
    const float window = 1 - std::pow(d / lamp.influenceRadius, 4.0f);
    return WALL_ALBEDO * lamp.emission[channel] * s * s * ahead / d * window * window;
}

int main()
{
    Host host = createHost(2 * halfWidth, height);
    const CndExposureStats stats = drawFrame(host);
    std::vector<float> radiance(size_t(host.width) * host.height * 4);
    readPixels(&host, &host.radiance, sampledRead, radiance.data(),
               radiance.size() * sizeof(float));
    destroyHost(&host);

    bool right = true;
    for (uint32_t i = 0; i < 2; ++i) {
        const float* const middle =
            &radiance[4 * (size_t(height / 2) * host.width + i * halfWidth + halfWidth / 2)];
        for (int c = 0; c < 3; ++c) {
            const float expected = wallLuminance(eyes[i], c);
            std::printf("half %u, channel %d: %.5f cd/m^2 (expected %.5f), exposed %.3f\n", i, c,
                        middle[c], expected, stats.exposure * middle[c]);
            right = right && std::abs(middle[c] - expected) < 1e-4f * expected;
        }
    }
    std::puts(right ? "right" : "WRONG");
    return right ? 0 : 1;
}
