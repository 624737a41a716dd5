// SPDX-License-Identifier: Apache-2.0
// Candelabra in a small renderer with a window: a G-buffer layout of its own, moving lights,
// resizing, two frames in flight, a panel, and the overlay that shows what Candelabra reads from
// the G-buffer.
#include <algorithm>
#include <chrono>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <numbers>
#include <string>
#include <utility>
#include <vector>

#include <GLFW/glfw3.h>
#include <glm/ext/matrix_clip_space.hpp>
#include <glm/ext/matrix_transform.hpp>

#include "boxes.h"
#include "panel.h"

namespace
{

struct Options {
    uint64_t frames = UINT64_MAX;
    uint32_t width = 1280, height = 720;
    std::string screenshot; // file for the last frame
    bool resize = false;    // resize the window to three quarters, half way through
    Settings settings;
};

constexpr char usage[] =
    "usage: embed_window [--frames N] [--size WxH] [--lights N] [--overlay 0..6] [--resize]\n"
    "                    [--screenshot FILE.ppm]\n"
    "--overlay shows what Candelabra reads (CndSurfaceQuantity), --resize changes the window's\n"
    "size half way, --screenshot needs --frames. With --frames, each frame lasts 1/60 s.\n";

Options parse(int count, char** words)
{
    Options o;
    bool right = true;
    for (int i = 1; i < count && right; ++i) {
        const std::string word = words[i];
        const char* value = i + 1 < count ? words[i + 1] : "";
        int end = 0;
        right = false;
        if (word == "--resize") {
            o.resize = right = true;
            continue;
        }
        if (word == "--frames")
            right = std::sscanf(value, "%lu%n", &o.frames, &end) == 1 && !value[end];
        else if (word == "--size")
            right = std::sscanf(value, "%ux%u%n", &o.width, &o.height, &end) == 2 && !value[end];
        else if (word == "--lights")
            right = std::sscanf(value, "%d%n", &o.settings.lightCount, &end) == 1 && !value[end];
        else if (word == "--overlay")
            right = std::sscanf(value, "%d%n", &o.settings.overlay, &end) == 1 && !value[end];
        else if (word == "--screenshot")
            right = !(o.screenshot = value).empty();
        ++i;
    }
    right = right && o.frames && o.width && o.height && o.settings.lightCount >= 0 &&
            o.settings.overlay < 7 && (o.screenshot.empty() || o.frames != UINT64_MAX);
    if (!right) {
        std::fputs(usage, stderr);
        std::exit(2);
    }
    return o;
}

struct Camera {
    glm::dmat4 viewFromWorld;
    glm::mat4 clipFromView;

    CndCamera forCandelabra() const
    {
        CndCamera out;
        std::memcpy(out.viewFromWorld, &viewFromWorld, sizeof out.viewFromWorld);
        std::memcpy(out.clipFromView, &clipFromView, sizeof out.clipFromView);
        return out;
    }
};

// The camera circles the boxes. Depth is 0 at the near plane and 1 at the far plane.
Camera cameraAt(double seconds, VkExtent2D size)
{
    const double angle = 0.2 * seconds + 0.6;
    const glm::dvec3 eye(9 * std::cos(angle), 4.5, 9 * std::sin(angle));
    Camera c{.viewFromWorld = glm::lookAt(eye, glm::dvec3(0, 0.3, 0), glm::dvec3(0, 1, 0)),
             .clipFromView =
                 glm::perspectiveRH_ZO(0.9f, float(size.width) / float(size.height), 0.1f, 100.0f)};
    c.clipFromView[1][1] *= -1; // Vulkan's y points down
    return c;
}

// Lamps that circle above the floor, some of them higher than the boxes.
void lightsAt(double seconds, int count, std::vector<CndLight>& lights)
{
    lights.clear();
    for (int i = 0; i < count; ++i) {
        const double turn = i * (3 - std::sqrt(5)) * std::numbers::pi; // the golden angle
        const double distance = 7.5 * std::sqrt((i + 0.5) / count);
        const double angle = turn + seconds * (i % 2 ? 0.5 : -0.35);
        CndLight light{.type = CND_LIGHT_SPHERE,
                       .position = {float(distance * std::cos(angle)), 0.4f + 0.4f * float(i % 8),
                                    float(distance * std::sin(angle))},
                       .radius = 0.08f,
                       .influenceRadius = 4};
        for (int k = 0; k < 3; ++k)
            light.emission[k] = float(6000 * (1 + 0.6 * std::sin(turn * 5 + k * 2.1)));
        lights.push_back(light);
    }
}

// Everything that depends on the window's size.
struct Targets {
    GBuffer gbuffer;
    candelabra::LightingView view;
    VkExtent2D size{}; // 0: not created yet
};

void resize(Targets& t, const Host& host, candelabra::Lighting& lighting, VkExtent2D size)
{
    vkDeviceWaitIdle(host.device);
    if (t.size.width)
        t.gbuffer.destroy(host);
    t.gbuffer.create(host, size);
    // A view serves every frame size up to its own.
    t.view = *lighting.createView({.maxWidth = size.width, .maxHeight = size.height});
    t.size = size;
}

void showDisplay(const Window::Frame& frame, const HostImage& display, VkExtent2D size)
{
    imageBarrier(frame.cmd, &display, storageInCompute, blitSource);
    // The wait stage makes this barrier wait for the semaphore that acquired the image.
    imageBarrier(frame.cmd, &frame.target,
                 {VK_IMAGE_LAYOUT_UNDEFINED, VK_PIPELINE_STAGE_2_ALL_TRANSFER_BIT, 0}, blitTarget);
    const VkOffset3D end{int32_t(size.width), int32_t(size.height), 1};
    const VkImageBlit blit{.srcSubresource = {VK_IMAGE_ASPECT_COLOR_BIT, 0, 0, 1},
                           .srcOffsets = {{}, end},
                           .dstSubresource = {VK_IMAGE_ASPECT_COLOR_BIT, 0, 0, 1},
                           .dstOffsets = {{}, end}};
    vkCmdBlitImage(frame.cmd, display.image, blitSource.layout, frame.target.image,
                   blitTarget.layout, 1, &blit, VK_FILTER_NEAREST);
    imageBarrier(frame.cmd, &frame.target, blitTarget, colourAttachment);
}

void clearRadiance(VkCommandBuffer cmd, const HostImage& radiance)
{
    const ImageUse cleared{VK_IMAGE_LAYOUT_GENERAL, VK_PIPELINE_STAGE_2_CLEAR_BIT,
                           VK_ACCESS_2_TRANSFER_WRITE_BIT};
    const VkClearColorValue black{};
    const VkImageSubresourceRange all{VK_IMAGE_ASPECT_COLOR_BIT, 0, 1, 0, 1};
    imageBarrier(cmd, &radiance, overwritten, cleared);
    vkCmdClearColorImage(cmd, radiance.image, cleared.layout, &black, 1, &all);
    imageBarrier(cmd, &radiance, cleared, storageInCompute);
}

struct ExposureStep {
    float deltaTime = 0; // s since the frame before
    bool reset = false;  // the first frame has none before it
};

// Records the lighting and the display image of a frame, or the overlay that was chosen instead.
void light(const Window::Frame& frame, Targets& targets, candelabra::Exposure& exposure,
           const Settings& settings, const Camera& camera, const ExposureStep& step)
{
    const GBuffer& g = targets.gbuffer;
    const CndLightingFrame surfaces{.frameSlot = frame.slot,
                                    .width = targets.size.width,
                                    .height = targets.size.height,
                                    .camera = camera.forCandelabra(),
                                    .clearDepth = 1,
                                    .normalRoughness = g.normal.view,
                                    .albedo = g.baseColour.view,
                                    .specular = g.roughnessMetalness.view,
                                    .depth = g.depth.view,
                                    .radiance = g.radiance.view,
                                    .specularMethod = CND_SPECULAR_CONIC};
    if (settings.overlay >= 0) {
        targets.view
            .recordOverlay(
                frame.cmd, surfaces,
                {.quantity = CndSurfaceQuantity(settings.overlay), .image = g.display.view})
            .value();
        return;
    }
    targets.view.record(frame.cmd, surfaces).value();
    imageBarrier(frame.cmd, &g.radiance, storageInCompute, sampledRead);
    exposure
        .record(frame.cmd, {.frameSlot = frame.slot,
                            .width = targets.size.width,
                            .height = targets.size.height,
                            .radiance = g.radiance.view,
                            .display = g.display.view,
                            .deltaTime = step.deltaTime,
                            .reset = step.reset,
                            .settings = candelabra::defaultExposureSettings()})
        .value();
}

} // namespace

int main(int argc, char** argv)
{
    const Options options = parse(argc, argv);
    Settings settings = options.settings;
    Window window("embed_window", options.width, options.height);
    const Host& host = window.host();
    Boxes boxes(host);
    Panel panel(window);

    const CndDeviceDesc device = deviceOf(host);
    auto lighting = *candelabra::Lighting::create(device, {.framesInFlight = framesInFlight,
                                                           .gbufferLayout = CND_GBUFFER_HOST,
                                                           .gbuffer = gbufferDesc});
    auto exposure = *candelabra::Exposure::create(device, {.framesInFlight = framesInFlight});
    Targets targets;
    std::vector<CndLight> lights;
    double seconds = 0;
    uint32_t longestList = 0;
    auto last = std::chrono::steady_clock::now();

    for (uint64_t n = 0; n < options.frames && !glfwWindowShouldClose(window.get());) {
        const auto frame = window.begin();
        if (!frame)
            continue;
        const VkExtent2D size = window.size();
        if (size.width != targets.size.width || size.height != targets.size.height)
            resize(targets, host, lighting, size);
        const auto now = std::chrono::steady_clock::now();
        const double elapsed =
            std::chrono::duration<double>(now - std::exchange(last, now)).count();
        const double step = options.frames == UINT64_MAX ? std::min(elapsed, 0.1) : 1.0 / 60;
        seconds += settings.moving ? step : 0;
        // The statistics are those of the slot's previous frame, if this view recorded one.
        if (auto stats = targets.view.stats(frame->slot); stats && stats.value())
            longestList = stats.value()->maxListLength;

        // The G-buffer.
        const Camera camera = cameraAt(seconds, size);
        const GBuffer& g = targets.gbuffer;
        boxes.record(frame->cmd, g, size, camera.clipFromView * glm::mat4(camera.viewFromWorld));
        clearRadiance(frame->cmd, g.radiance);
        imageBarrier(frame->cmd, &g.display,
                     {VK_IMAGE_LAYOUT_UNDEFINED, VK_PIPELINE_STAGE_2_BLIT_BIT, 0},
                     storageInCompute);

        // Light.
        lightsAt(seconds, settings.lightCount, lights);
        lighting.setLights(lights, {0, 0, 0}).value();
        light(*frame, targets, exposure, settings, camera,
              {.deltaTime = float(step), .reset = n == 0});

        // The window.
        showDisplay(*frame, g.display, size);
        panel.record(*frame, size, settings, longestList);
        if (++n == options.frames && !options.screenshot.empty()) {
            imageBarrier(frame->cmd, &frame->target, colourAttachment, copySource);
            window.copyTo(*frame, options.screenshot);
            imageBarrier(frame->cmd, &frame->target, copySource, presented);
        } else {
            imageBarrier(frame->cmd, &frame->target, colourAttachment, presented);
        }
        window.end(*frame);
        if (options.resize && n == options.frames / 2)
            glfwSetWindowSize(window.get(), int(options.width * 3 / 4),
                              int(options.height * 3 / 4));
    }
    vkDeviceWaitIdle(host.device);
    targets.view = {};
    targets.gbuffer.destroy(host);
    return 0;
}
