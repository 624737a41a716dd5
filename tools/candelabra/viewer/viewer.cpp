// SPDX-License-Identifier: Apache-2.0
#include "viewer/viewer.h"

#include <algorithm>
#include <chrono>

#define GLFW_INCLUDE_NONE
#include <GLFW/glfw3.h>
#include <fmt/format.h>
#include <spdlog/spdlog.h>

#include "commands/options.h"
#include "io/image.h"
#include "io/table.h"
#include "render/camera.h"
#include "render/error.h"
#include "render/image_barrier.h"
#include "render/readback.h"

namespace candelabra::app
{
namespace
{

constexpr double fixedFrameTime = 1.0 / 60; // s, with a frame limit
// A stall (building a scene, a dragged window) must not become a leap.
constexpr double longestStep = 0.25; // s

// Crossing the scene takes about fifteen seconds.
double cruisingSpeed(const Scene& scene)
{
    const Bounds bounds = sceneBounds(scene);
    const double diagonal = glm::length(bounds.max - bounds.min);
    return std::clamp(diagonal / 15, 0.2, 200.0);
}

Swapchain::Target checked(const std::optional<Swapchain::Target>& target)
{
    if (!target)
        throw RunError("the window changes faster than images for it can be made");
    return *target;
}

constexpr ImageAccess attachment{VK_PIPELINE_STAGE_2_COLOR_ATTACHMENT_OUTPUT_BIT,
                                 VK_ACCESS_2_COLOR_ATTACHMENT_READ_BIT |
                                     VK_ACCESS_2_COLOR_ATTACHMENT_WRITE_BIT,
                                 VK_IMAGE_LAYOUT_COLOR_ATTACHMENT_OPTIMAL};
constexpr ImageAccess shown{VK_PIPELINE_STAGE_2_ALL_TRANSFER_BIT, 0,
                            VK_IMAGE_LAYOUT_PRESENT_SRC_KHR};

} // namespace

Viewer::Viewer(const ViewerOptions& options, const ContextOptions& contextOptions,
               const WindowSystem& system, Scene scene)
    : options_(options),
      window_(system, "candelabra", options.size),
      context_(contextOptions),
      scene_(std::move(scene)),
      renderer_(std::make_unique<Renderer>(
          context_, scene_, RendererOptions{options.size, options.gbufferLayout, slotCount})),
      swapchain_(context_, window_, slotCount),
      overlay_(context_, window_, swapchain_),
      ring_(context_, slotCount),
      camera_(selectCamera(scene_, options.camera), cruisingSpeed(scene_)),
      panel_{.frame = options.frame, .visible = options.overlay}
{
    panel_.frame.lightsVisible = options.lightsVisible.value_or(scene_.lightsVisible);
    panel_.wantedLights = uint32_t(scene_.lights.size());
    figures_.device = context_.info().name;
    time_ = options.frame.time;
    window_.onKey = [this](int key) { onKey(key); };
    window_.onWheel = [this](double notches) {
        if (!overlay_.takesMouse())
            camera_.scaleSpeed(notches);
    };
    if (!options.screenshot.empty() && !swapchain_.readable())
        throw RunError("--screenshot: images of this window cannot be read back");
}

void Viewer::onKey(int key)
{
    if (overlay_.takesKeyboard())
        return;
    const uint32_t lights = uint32_t(scene_.lights.size());
    switch (key) {
    case GLFW_KEY_ESCAPE:
        window_.close();
        break;
    case GLFW_KEY_F1:
        panel_.visible = !panel_.visible;
        break;
    case GLFW_KEY_H:
        if (panel_.frame.culling == CND_CULLING_CLUSTERED)
            panel_.frame.heatMap = HeatMap((uint32_t(panel_.frame.heatMap) + 1) % heatMapCount);
        break;
    case GLFW_KEY_LEFT_BRACKET:
        panel_.wantedLights = std::max(lights / 2, 1u);
        break;
    case GLFW_KEY_RIGHT_BRACKET:
        panel_.wantedLights = std::min(std::max(lights, 1u) * 2, maxLights);
        break;
    case GLFW_KEY_MINUS:
        panel_.frame.exposure.compensation -= 0.5f;
        break;
    case GLFW_KEY_EQUAL:
        panel_.frame.exposure.compensation += 0.5f;
        break;
    default:
        break;
    }
}

void Viewer::rebuild(uint32_t wanted)
{
    const uint32_t lights = uint32_t(std::min<uint64_t>(wanted, maxLightsOf(context_.info())));
    spdlog::info("building {} with {}", options_.scene, counted(lights, "light"));
    SceneOptions sceneOptions = options_.sceneOptions;
    // Files bring lights of their own; the option says how many to add to them.
    const uint32_t own = uint32_t(scene_.lights.size()) - options_.sceneOptions.lights.value_or(0);
    const bool generated = isGenerated(options_.scene);
    sceneOptions.lights = generated ? lights : lights > own ? lights - own : 0;
    try {
        Scene scene = loadScene(options_.scene, sceneOptions);
        ring_.wait();
        renderer_.reset(); // refers to the scene
        scene_ = std::move(scene);
        options_.sceneOptions = sceneOptions;
    } catch (const SceneError& error) {
        spdlog::error("candelabra: {}", error.what());
        panel_.wantedLights = uint32_t(scene_.lights.size());
        return;
    }
    renderer_ = std::make_unique<Renderer>(
        context_, scene_, RendererOptions{swapchain_.size(), options_.gbufferLayout, slotCount});
    panel_.wantedLights = uint32_t(scene_.lights.size());
    figures_.passes.clear();
    recorded_ = {};
    resetExposure_ = true;
}

// Makes window images and renderer as large as the window is.
void Viewer::fitToWindow()
{
    const PixelSize window = window_.framebufferSize();
    const PixelSize now = swapchain_.size();
    if (staleWindow_ || window.width != now.width || window.height != now.height) {
        swapchain_.recreate();
        staleWindow_ = false;
    }
    const PixelSize wanted = swapchain_.size(), drawn = renderer_->size();
    if (wanted.width != drawn.width || wanted.height != drawn.height) {
        ring_.wait();
        renderer_->resize(wanted);
        recorded_ = {};
    }
}

void Viewer::collectStats(const FrameRing::Frame& frame)
{
    if (!frame.reused || !recorded_[frame.slot])
        return;
    FrameStats stats = renderer_->stats(frame.slot);
    figures_.passes.push_back(std::move(stats.passes));
    while (figures_.passes.size() > panelFrames)
        figures_.passes.pop_front();
    if (stats.lit)
        figures_.lighting = stats.lighting;
    figures_.exposure = stats.exposure;
}

void Viewer::moveCamera(double seconds)
{
    GLFWwindow* w = window_.get();
    FlyInput input;
    if (!overlay_.takesKeyboard()) {
        const auto axis = [&](int plus, int minus) {
            return double(glfwGetKey(w, plus) == GLFW_PRESS) -
                   double(glfwGetKey(w, minus) == GLFW_PRESS);
        };
        input.move = {axis(GLFW_KEY_D, GLFW_KEY_A), axis(GLFW_KEY_E, GLFW_KEY_Q),
                      axis(GLFW_KEY_W, GLFW_KEY_S)};
        input.fast = glfwGetKey(w, GLFW_KEY_LEFT_SHIFT) == GLFW_PRESS ||
                     glfwGetKey(w, GLFW_KEY_RIGHT_SHIFT) == GLFW_PRESS;
    }
    double x = 0, y = 0;
    glfwGetCursorPos(w, &x, &y);
    const bool pressed = glfwGetMouseButton(w, GLFW_MOUSE_BUTTON_LEFT) == GLFW_PRESS ||
                         glfwGetMouseButton(w, GLFW_MOUSE_BUTTON_RIGHT) == GLFW_PRESS;
    // A drag that began on the scene stays a look, wherever it goes.
    if (pressed && looking_)
        input.look = {x - lastX_, y - lastY_};
    looking_ = pressed && (looking_ || !overlay_.takesMouse());
    lastX_ = x;
    lastY_ = y;
    camera_.update(input, seconds);
}

Swapchain::Target Viewer::acquire(uint32_t slot)
{
    if (const auto target = swapchain_.acquire(slot))
        return *target;
    staleWindow_ = true;
    fitToWindow();
    return checked(swapchain_.acquire(slot));
}

void Viewer::recordWindow(VkCommandBuffer cmd, const Swapchain::Target& target)
{
    // Chained to the wait for the image (FrameRing::submit).
    transition(cmd, target.image, discarded, transferWrite);
    const PixelSize from = renderer_->size(), to = swapchain_.size();
    const VkImageSubresourceLayers layers{VK_IMAGE_ASPECT_COLOR_BIT, 0, 0, 1};
    const VkImageBlit region{
        .srcSubresource = layers,
        .srcOffsets = {{0, 0, 0}, {int32_t(from.width), int32_t(from.height), 1}},
        .dstSubresource = layers,
        .dstOffsets = {{0, 0, 0}, {int32_t(to.width), int32_t(to.height), 1}}};
    // A blit and not a copy: the window may order its channels differently.
    vkCmdBlitImage(cmd, renderer_->display().image.get(), VK_IMAGE_LAYOUT_TRANSFER_SRC_OPTIMAL,
                   target.image, VK_IMAGE_LAYOUT_TRANSFER_DST_OPTIMAL, 1, &region,
                   VK_FILTER_NEAREST);
    transition(cmd, target.image, transferWrite, attachment);
    overlay_.record(cmd, swapchain_, target);
}

gpu::Buffer Viewer::recordScreenshot(VkCommandBuffer cmd, VkImage image) const
{
    transition(cmd, image, shown, transferRead);
    gpu::Buffer pixels = recordReadback(context_.device(), cmd, image, swapchain_.size(), 4);
    transition(cmd, image, transferRead, shown);
    return pixels;
}

void Viewer::saveScreenshot(const gpu::Buffer& pixels) const
{
    const PixelSize size = swapchain_.size();
    const bool blueFirst = swapchain_.format() == VK_FORMAT_B8G8R8A8_UNORM;
    const auto texels = pixels.as<const uint8_t>();
    std::vector<uint8_t> rgb(size_t(size.width) * size.height * 3);
    for (size_t i = 0; i < rgb.size() / 3; ++i)
        for (size_t c = 0; c < 3; ++c)
            rgb[i * 3 + c] = texels[i * 4 + (blueFirst ? 2 - c : c)];
    savePng(options_.screenshot, size.width, size.height, rgb);
    spdlog::info("wrote {}", options_.screenshot);
}

void Viewer::drawFrame(double seconds, bool screenshot)
{
    const FrameRing::Frame frame = ring_.begin();
    collectStats(frame);
    const Swapchain::Target target = acquire(frame.slot);

    FrameOptions& options = panel_.frame;
    options.camera = camera_.camera();
    options.time = time_;
    options.deltaTime = float(seconds);
    options.resetExposure = std::exchange(resetExposure_, false);
    ++options.ditherSeed; // noise that moves is seen less
    overlay_.begin();
    drawPanel(panel_, figures_);
    renderer_->record(frame.cmd, frame.slot, options);
    recorded_[frame.slot] = true;
    recordWindow(frame.cmd, target);
    gpu::Buffer pixels;
    if (screenshot)
        pixels = recordScreenshot(frame.cmd, target.image);
    ring_.submit(target.acquired, target.presented);
    if (!swapchain_.present(target))
        staleWindow_ = true;
    if (screenshot) {
        ring_.wait();
        saveScreenshot(pixels);
    }
}

void Viewer::run()
{
    using Clock = std::chrono::steady_clock;
    Clock::time_point last = Clock::now();
    for (uint32_t i = 0; !window_.wantsToClose() && (!options_.frames || i < options_.frames);
         ++i) {
        window_.poll();
        const PixelSize size = window_.framebufferSize();
        if (!size.width || !size.height) { // minimised
            window_.wait();
            --i;
            continue;
        }
        const Clock::time_point now = Clock::now();
        const double wall = std::chrono::duration<double>(now - last).count();
        last = now;
        const double seconds = options_.frames ? fixedFrameTime : std::min(wall, longestStep);
        moveCamera(seconds);
        if (panel_.animate)
            time_ += seconds;
        if (panel_.wantedLights != scene_.lights.size())
            rebuild(panel_.wantedLights);
        fitToWindow();
        figures_.scene = scene_.name;
        figures_.lights = uint32_t(scene_.lights.size());
        figures_.moving = !scene_.lightMotions.empty();
        figures_.wallMs = wall * 1e3;
        figures_.speed = camera_.speed();
        figures_.size = renderer_->size();
        drawFrame(seconds, !options_.screenshot.empty() && i + 1 == options_.frames);
    }
    ring_.wait();
}

} // namespace candelabra::app
