// SPDX-License-Identifier: Apache-2.0
// The part of Viewer that handles keys, mouse and dropped files.
#include <algorithm>
#include <cmath>
#include <filesystem>
#include <numbers>

#define GLFW_INCLUDE_NONE
#include <GLFW/glfw3.h>
#include <fmt/format.h>
#include <spdlog/spdlog.h>

#include "io/report.h"
#include "io/table.h"
#include "measure/frame/pick.h"
#include "measure/frame/surfaces.h"
#include "render/camera.h"
#include "render/readback.h"
#include "render/setting_names.h"
#include "scene/fit_camera.h"
#include "scene/scene_options.h"
#include "viewer/viewer.h"
#include "json/save.h"

namespace candelabra::app
{
namespace
{

constexpr float lightStep = 0.1f;  // metres by which a key moves a light
constexpr float radiusStep = 1.1f; // factor by which a key changes a light's radius

} // namespace

void Viewer::connectInput()
{
    window_.onKey = [this](int key) {
        if (!overlay_.takesKeyboard() && !onLightKey(key))
            onKey(key);
    };
    window_.onWheel = [this](double notches) {
        if (!overlay_.takesMouse())
            camera_.wheel(notches);
    };
    window_.onDrop = [this](const std::string& path) { dropped_ = path; };
}

void Viewer::onKey(int key)
{
    const uint32_t lights = uint32_t(scene_.lights.size());
    FrameOptions& frame = panel_.frame;
    switch (key) {
    case GLFW_KEY_ESCAPE:
        window_.close();
        break;
    case GLFW_KEY_F1:
        panel_.visible = !panel_.visible;
        break;
    case GLFW_KEY_F2:
        panel_.help = !panel_.help;
        break;
    case GLFW_KEY_O:
        toggleOrbit();
        break;
    case GLFW_KEY_F:
        fitScene();
        break;
    case GLFW_KEY_M:
        frame.specular = nextSpecular(frame.specular);
        break;
    case GLFW_KEY_C:
        frame.culling =
            frame.culling == CND_CULLING_CLUSTERED ? CND_CULLING_BRUTE : CND_CULLING_CLUSTERED;
        if (frame.culling == CND_CULLING_BRUTE)
            frame.heatMap = HeatMap::None;
        break;
    case GLFW_KEY_H:
        if (frame.culling == CND_CULLING_CLUSTERED)
            frame.heatMap = HeatMap((uint32_t(frame.heatMap) + 1) % heatMapCount);
        break;
    case GLFW_KEY_B:
        panel_.wipe.on = !panel_.wipe.on;
        break;
    case GLFW_KEY_K:
        pick_ = pixelUnderMouse();
        break;
    case GLFW_KEY_F5:
        saveScene_ = true;
        break;
    case GLFW_KEY_P:
        saveAs_ = ".png";
        break;
    case GLFW_KEY_X:
        saveAs_ = ".exr";
        break;
    case GLFW_KEY_LEFT_BRACKET:
        panel_.wantedLights = std::max(lights / 2, 1u);
        break;
    case GLFW_KEY_RIGHT_BRACKET:
        panel_.wantedLights = std::min(std::max(lights, 1u) * 2, maxLights);
        break;
    case GLFW_KEY_MINUS:
        frame.exposure.compensation -= 0.5f;
        break;
    case GLFW_KEY_EQUAL:
        frame.exposure.compensation += 0.5f;
        break;
    default:
        break;
    }
}

// Handles the keys that edit lights; returns true if `key` is one of them. Lights move along the
// world's axes: the arrow keys use the horizontal axes nearest to the camera's forward and right.
bool Viewer::onLightKey(int key)
{
    LightEditor& editor = panel_.editor;
    const Camera camera = camera_.camera();
    const glm::vec3 f = camera.forward;
    const bool alongX = std::abs(f.x) > std::abs(f.z);
    const glm::vec3 ahead =
        alongX ? glm::vec3(f.x < 0 ? -1 : 1, 0, 0) : glm::vec3(0, 0, f.z < 0 ? -1 : 1);
    const glm::vec3 right{-ahead.z, 0, ahead.x};
    switch (key) {
    case GLFW_KEY_N:
        addLightInView();
        return true;
    case GLFW_KEY_TAB:
        selectLight(scene_, editor, window_.shiftPressed() ? -1 : 1);
        return true;
    case GLFW_KEY_DELETE:
        removeLight(scene_, editor);
        return true;
    case GLFW_KEY_COMMA:
        scaleLightRadius(scene_, editor, 1 / radiusStep);
        return true;
    case GLFW_KEY_PERIOD:
        scaleLightRadius(scene_, editor, radiusStep);
        return true;
    case GLFW_KEY_UP:
        moveLight(scene_, editor, lightStep * ahead);
        return true;
    case GLFW_KEY_DOWN:
        moveLight(scene_, editor, -lightStep * ahead);
        return true;
    case GLFW_KEY_RIGHT:
        moveLight(scene_, editor, lightStep * right);
        return true;
    case GLFW_KEY_LEFT:
        moveLight(scene_, editor, -lightStep * right);
        return true;
    case GLFW_KEY_PAGE_UP:
        moveLight(scene_, editor, {0, lightStep, 0});
        return true;
    case GLFW_KEY_PAGE_DOWN:
        moveLight(scene_, editor, {0, -lightStep, 0});
        return true;
    default:
        return false;
    }
}

void Viewer::toggleOrbit()
{
    if (camera_.orbits())
        return camera_.fly();
    // The pivot is as far ahead as the middle of the scene. If the middle lies behind the camera,
    // it is a third of the scene's diagonal ahead, at least 1 m.
    const Bounds bounds = sceneBounds(scene_);
    const Camera camera = camera_.camera();
    const double middle =
        glm::dot(0.5 * (bounds.min + bounds.max) - camera.position, camera.forward);
    const double third = glm::length(bounds.max - bounds.min) / 3;
    camera_.orbit(middle > 0 ? middle : std::max(third, 1.0));
}

// Moves the camera back until it sees all of the scene; inside a room, to where it saw most of it.
void Viewer::fitScene()
{
    if (scene_.interior) {
        camera_ = FlyCamera(selectCamera(scene_, "inside"), camera_.speed());
        return;
    }
    const PixelSize size = renderer_->size();
    const Camera fitted = fitCamera(scene_, {0, scene_.instances.size()}, camera_.camera(),
                                    double(size.width) / size.height);
    camera_ = FlyCamera(fitted, camera_.speed());
}

// Adds a light where it lights what is in the middle of the view without hiding it: nearer to the
// camera, and higher. Its size goes with the distance. What it lights gets about the illuminance
// with which a grey card would have the luminance that the exposure is for now.
void Viewer::addLightInView()
{
    const Camera camera = camera_.camera();
    const PixelSize size = renderer_->size();
    std::optional<double> seen;
    if (recorded_ != decltype(recorded_){}) {
        ring_.wait();
        const Surfaces surfaces(context_, *renderer_, panel_.frame);
        if (const auto point = surfaces.pointAt(size.width / 2, size.height / 2))
            seen = glm::length(point->position - camera.position);
    }
    const Bounds bounds = sceneBounds(scene_);
    const double diagonal = glm::length(bounds.max - bounds.min);
    const double distance = seen.value_or(std::max(diagonal / 3, 1.0));
    const double higher = 0.6 * std::tan(0.5 * camera.verticalFov) * 0.7 * distance;
    const glm::dvec3 position =
        camera.position + 0.7 * distance * camera.forward + glm::dvec3(0, higher, 0);
    const double fromLight = glm::length(glm::dvec2(0.3 * distance, higher));
    const double luminance = std::exp2(double(figures_.exposure.adaptedEv100)) / 8; // cd/m^2
    const double illuminance = luminance * std::numbers::pi / 0.18;
    addLight(scene_, panel_.editor, position,
             {.radius = float(0.02 * distance),
              .power = float(4 * std::numbers::pi * illuminance * fromLight * fromLight),
              .influenceRadius = float(8 * fromLight)});
}

void Viewer::onDrop(const std::string& path)
{
    SceneOptions options = options_.sceneOptions;
    const auto ends = [&](const char* extension) { return path.ends_with(extension); };
    if (ends(".hdr") || ends(".exr") || ends(".pfm")) {
        options.environment = path;
        open(options_.scene, options);
        return;
    }
    options.lights.reset();
    if (!open(path, options))
        return;
    const Camera camera = selectCamera(scene_, "");
    camera_ = FlyCamera(camera, cruisingSpeed(scene_));
    spdlog::info("{}: {}", scene_.name, counted(scene_.lights.size(), "light"));
}

// Returns a file name that is not taken in the current folder.
std::string Viewer::freeName(const char* extension)
{
    std::string path;
    do
        path = fmt::format("candelabra-{:03}{}", ++savedFiles_, extension);
    while (std::filesystem::exists(path));
    return path;
}

// Calls `write` with a free name and shows the result in the panel. `write` may throw a
// std::runtime_error, whose message is shown instead.
void Viewer::save(const char* extension, const std::function<void(const std::string&)>& write)
{
    const std::string path = freeName(extension);
    ring_.wait();
    try {
        write(path);
        figures_.note = "wrote " + path;
        spdlog::info("{}", figures_.note);
    } catch (const std::runtime_error& error) {
        figures_.note = error.what();
        spdlog::error("candelabra: {}", error.what());
    }
}

void Viewer::saveImage(const char* extension)
{
    save(extension, [this](const std::string& path) { saveFrame(context_, *renderer_, path); });
}

void Viewer::saveScene()
{
    save(".json", [this](const std::string& path) {
        SceneSource source = source_;
        if (panel_.materials.on)
            source.materials = panel_.materials;
        writeText(path, sceneDescription(scene_, source, camera_.camera(), time_, path));
    });
}

std::optional<PixelPosition> Viewer::pixelUnderMouse() const
{
    double x = 0, y = 0;
    int width = 0, height = 0;
    glfwGetCursorPos(window_.get(), &x, &y);
    glfwGetWindowSize(window_.get(), &width, &height);
    const PixelSize size = renderer_->size(); // pixels, of which a window unit may have several
    if (overlay_.takesMouse() || x < 0 || y < 0 || x >= width || y >= height)
        return std::nullopt;
    return PixelPosition{uint32_t(x * size.width / width), uint32_t(y * size.height / height)};
}

void Viewer::pick(PixelPosition pixel)
{
    const PixelSize size = renderer_->size();
    FrameOptions frame = optionsAt(int32_t(pixel.x));
    if (const std::string refusal = pickRefusal(frame.specular, frame.influence.rule);
        !refusal.empty()) {
        figures_.note = "no pixel picked: " + refusal;
        return;
    }
    if (pixel.x >= size.width || pixel.y >= size.height) // the window has become smaller
        return;
    frame.deltaTime = 0; // the exposure does not adapt
    ring_.wait();
    figures_.picked = pickPixel(context_, *renderer_, scene_, frame, pixel);
    renderer_->lightsChanged(); // pickPixel has drawn the lights one at a time
    recorded_ = {};
    spdlog::info("{}", pickText(*figures_.picked, scene_));
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
        input.fast = window_.shiftPressed();
    }
    double x = 0, y = 0;
    glfwGetCursorPos(w, &x, &y);
    const bool pressed = glfwGetMouseButton(w, GLFW_MOUSE_BUTTON_LEFT) == GLFW_PRESS ||
                         glfwGetMouseButton(w, GLFW_MOUSE_BUTTON_RIGHT) == GLFW_PRESS;
    // A drag that began on the scene keeps turning the camera, even over a widget.
    if (pressed && looking_)
        input.look = {x - lastX_, y - lastY_};
    looking_ = pressed && (looking_ || !overlay_.takesMouse());
    lastX_ = x;
    lastY_ = y;
    camera_.update(input, seconds);
}

} // namespace candelabra::app
