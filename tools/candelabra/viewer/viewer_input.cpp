// SPDX-License-Identifier: Apache-2.0
// The part of Viewer that handles keys, mouse and dropped files.
#include <algorithm>
#include <cmath>
#include <filesystem>
#include <limits>
#include <numbers>

#define GLFW_INCLUDE_NONE
#include <GLFW/glfw3.h>
#include <fmt/format.h>
#include <spdlog/spdlog.h>

#include "io/report.h"
#include "io/table.h"
#include "measure/frame/pick.h"
#include "render/camera.h"
#include "render/readback.h"
#include "render/setting_names.h"
#include "scene/fit_camera.h"
#include "scene/light_types.h"
#include "scene/mesh_bounds.h"
#include "scene/scene_options.h"
#include "viewer/selection.h"
#include "viewer/viewer.h"
#include "json/save.h"

namespace candelabra::app
{
namespace
{

constexpr float lightStep = 0.1f;  // metres by which a key moves a light
constexpr float radiusStep = 1.1f; // factor by which a key changes a light's radius
// Lengths in window units.
constexpr double clickLength = 4;   // A click moves the mouse by less than this.
constexpr double clickMiss = 6;     // A click selects a light that is at most so far away.
constexpr double handleLength = 70; // The lines by which the mouse moves a light are so long.

// The bulb that N adds: about the light of an incandescent lamp of 60 W.
constexpr float bulbPower = 800, bulbRadius = 0.03f; // lm, metres

constexpr const char* unsaved = "edits of lights are not saved";

bool contains(const Bounds& bounds, const glm::dvec3& point)
{
    return glm::all(glm::lessThanEqual(bounds.min, point)) &&
           glm::all(glm::lessThanEqual(point, bounds.max));
}

// Returns the object that a ray hit, with all that belongs to the same node of a glTF file: to the
// smallest one that has a name.
std::optional<SelectedObject> objectOf(const Scene& scene, const RayHit& hit)
{
    if (hit.analytic) {
        const AnalyticObject& object = scene.analyticObjects[hit.object];
        if (object.type == AnalyticObject::Type::Plane) // has no end
            return {};
        return SelectedObject{fmt::format("ball {}", hit.object),
                              {object.point - object.radius, object.point + object.radius},
                              hit.material};
    }
    InstanceRange range{hit.object, 1};
    std::string name = fmt::format("object {}", hit.object);
    size_t smallest = scene.instances.size() + 1;
    for (const SceneNode& node : scene.nodes) {
        const InstanceRange& r = node.instances;
        if (hit.object < r.first || hit.object >= r.first + r.count || node.name.empty() ||
            r.count >= smallest)
            continue;
        smallest = r.count;
        range = r;
        name = node.name;
    }
    Bounds bounds{glm::dvec3(std::numeric_limits<double>::infinity()),
                  glm::dvec3(-std::numeric_limits<double>::infinity())};
    for (size_t i = range.first; i < range.first + range.count; ++i) {
        const Instance& instance = scene.instances[i];
        const Bounds part =
            transformBounds(meshBounds(scene.meshes[instance.mesh]), instance.worldFromObject);
        bounds.min = glm::min(bounds.min, part.min);
        bounds.max = glm::max(bounds.max, part.max);
    }
    return SelectedObject{name, bounds, hit.material};
}

double diagonalOf(const Scene& scene)
{
    const Bounds bounds = sceneBounds(scene);
    return glm::length(bounds.max - bounds.min);
}

} // namespace

// Handles an event, or returns false if that has to wait for the next frame.
bool Viewer::handle(const InputEvent& event)
{
    using Kind = InputEvent::Kind;
    switch (event.kind) {
    case Kind::Key:
        return onKeyEvent(event);
    case Kind::Character:
        return !overlay_.edits() || overlay_.pressKey(event);
    case Kind::Button:
        return onButton(event);
    case Kind::Move:
        return onMove(event.x, event.y);
    case Kind::Leave:
        return dragButton_ || onMove(Overlay::nowhere, Overlay::nowhere);
    case Kind::Wheel: {
        const std::optional<bool> taken = overlay_.takesMouse();
        if (!taken)
            return false;
        if (*taken)
            return overlay_.turnWheel(event.y);
        camera_.wheel(event.y);
        if (!camera_.orbits())
            showNote(fmt::format("camera speed {} m/s", threeDigits(camera_.speed())));
        return true;
    }
    case Kind::LoseFocus: // what is released from here on is released unseen
        if (!freshKeys_.empty())
            return false;
        heldKeys_.clear();
        dragButton_.reset();
        handleDrag_.reset();
        overlay_.releaseAll();
        return true;
    case Kind::Drop:
        dropped_ = event.text;
        return true;
    }
    return true;
}

bool Viewer::onKeyEvent(const InputEvent& event)
{
    if (event.down)
        return onKeyPressed(event);
    // A key that is pressed for less than a frame counts in one.
    if (freshKeys_.contains(event.code) || !overlay_.releaseKey(event))
        return false;
    heldKeys_.erase(event.code);
    return true;
}

bool Viewer::onKeyPressed(const InputEvent& event)
{
    const int key = event.code;
    const bool function = key >= GLFW_KEY_F1 && key <= GLFW_KEY_F25;
    const bool modifier = key >= GLFW_KEY_LEFT_SHIFT && key <= GLFW_KEY_RIGHT_SUPER;
    if (modifier) {
        heldKeys_.insert(key);
        return overlay_.pressKey(event);
    }
    // The next frame tells whether a field was clicked, or left.
    if (!function && (overlay_.awaitsFrame() ||
                      (key == GLFW_KEY_TAB && overlay_.edits() && !overlay_.endEditing())))
        return false;
    if (overlay_.edits() && !function) {
        heldKeys_.clear();
        return overlay_.pressKey(event);
    }
    const KeyBinding* binding = findBinding(key, event.modifiers);
    if (asks_ && binding && binding->action == KeyAction::Quit && !event.repeat) {
        close();
        return true;
    }
    asks_ &= event.repeat;
    if (!binding || (event.repeat && !binding->repeats))
        return true;
    if (!event.repeat) {
        if (!handleDrag_)
            panel_.editor.history.beginStep();
        if (findBinding(key, 0) == binding) // Ctrl+D does not fly to the right, as D does
            heldKeys_.insert(key);
        freshKeys_.insert(key);
    }
    onAction(binding->action);
    return true;
}

bool Viewer::onButton(const InputEvent& event)
{
    const glm::dvec2 place = mouseInPicture();
    if (!event.down && dragButton_ == event.code) {
        dragButton_.reset();
        if (const auto drag = std::exchange(handleDrag_, std::nullopt)) {
            if (panel_.editor.selected == drag->index)
                showLightNote("moved");
            return overlay_.moveMouse(mouseX_, mouseY_);
        }
        const bool click = dragged_ < clickLength * double(window_.contentScale());
        if (click && event.code == GLFW_MOUSE_BUTTON_LEFT)
            selectAt(place);
        return overlay_.moveMouse(mouseX_, mouseY_);
    }
    if (!event.down)
        return overlay_.releaseButton(event.code);
    if (dragButton_)
        return true;
    const std::optional<bool> taken = overlay_.takesMouse();
    if (!taken)
        return false;
    asks_ = false;
    if (*taken) {
        panel_.editor.history.beginStep(); // what the user drags until the release is one step
        return overlay_.pressButton(event.code);
    }
    if (overlay_.edits() && !overlay_.endEditing())
        return false;
    if (event.code == GLFW_MOUSE_BUTTON_LEFT || event.code == GLFW_MOUSE_BUTTON_RIGHT) {
        dragButton_ = event.code;
        dragged_ = 0;
    }
    const auto shown = handles();
    const auto handle = shown ? shown->at(projection(), place, clickSlack()) : std::nullopt;
    if (handle && event.code == GLFW_MOUSE_BUTTON_LEFT) {
        panel_.editor.history.beginStep();
        const uint32_t index = *panel_.editor.selected;
        const float(&at)[3] = scene_.lights[index].position;
        handleDrag_ = HandleDrag{.index = index,
                                 .handle = *handle,
                                 .handles = *shown,
                                 .from = *shown->pointOn(*handle, projection(), place),
                                 .light = {at[0], at[1], at[2]}};
    }
    return true;
}

bool Viewer::onMove(double x, double y)
{
    // A drag that began on the scene keeps turning the camera, even over a widget, which does not
    // see the mouse then.
    if (!dragButton_ && !overlay_.moveMouse(x, y))
        return false;
    const glm::dvec2 way{x - mouseX_, y - mouseY_};
    mouseX_ = x;
    mouseY_ = y;
    if (handleDrag_) {
        dragHandle();
    } else if (dragButton_) {
        look_ += way;
        dragged_ += std::abs(way.x) + std::abs(way.y);
    }
    return true;
}

// Returns the handles of the selected light if it can be dragged now.
std::optional<LightHandles> Viewer::handles() const
{
    const std::optional<CndLight> light = selectedNow();
    if (!light || cndIsDistant(light->type) || rebuilds())
        return {};
    const Projection view = projection();
    const glm::dvec3 centre =
        scene_.lightOrigin + glm::dvec3(light->position[0], light->position[1], light->position[2]);
    const double pixel = view.metresPerPixel(std::max(view.depthOf(centre), 0.0));
    return LightHandles{centre, handleLength * double(window_.contentScale()) * pixel};
}

double Viewer::clickSlack() const
{
    return clickMiss * double(window_.contentScale());
}

// Moves the light so that the point of the handle stays under the mouse.
void Viewer::dragHandle()
{
    const HandleDrag& drag = *handleDrag_;
    const auto to = drag.handles.pointOn(drag.handle, projection(), mouseInPicture());
    if (panel_.editor.selected != drag.index)
        return handleDrag_.reset();
    if (!to || rebuilds())
        return;
    const float(&at)[3] = scene_.lights[drag.index].position;
    moveLight(scene_, panel_.editor,
              drag.light + (*to - drag.from) - glm::dvec3(at[0], at[1], at[2]));
}

bool Viewer::isHeld(KeyAction action) const
{
    for (const int key : heldKeys_) {
        const KeyBinding* binding = findBinding(key, 0);
        if (binding && binding->action == action)
            return true;
    }
    return false;
}

// Shows in a corner what was done, and prints it, by default only with --verbose.
void Viewer::showNote(const std::string& note, spdlog::level::level_enum level)
{
    figures_.note = note;
    panel_.shownNote.clear(); // so that the same note is shown again
    settling_ = panelSettles;
    spdlog::log(level, "{}{}", level == spdlog::level::err ? "candelabra: " : "", note);
}

void Viewer::onAction(KeyAction action)
{
    if (onFrameAction(action) || onLightAction(action))
        return;
    switch (action) {
    case KeyAction::Orbit:
        toggleOrbit();
        break;
    case KeyAction::Frame:
        frameSelection();
        break;
    case KeyAction::FrameScene:
        frameScene();
        break;
    case KeyAction::Home:
        spdlog::debug("the camera is back where it began");
        goTo(home_);
        break;
    case KeyAction::ListLights:
        pick_ = pixelUnderMouse();
        if (!pick_)
            showNote("no pixel picked: the mouse is not over the picture");
        break;
    case KeyAction::SaveScene:
        saveScene_ = true;
        break;
    case KeyAction::SaveImage:
        saveAs_ = ".png";
        break;
    case KeyAction::SaveRadiance:
        saveAs_ = ".exr";
        break;
    case KeyAction::Panel:
        panel_.visible = !panel_.visible;
        spdlog::debug("the panel is {}", panel_.visible ? "shown" : "hidden");
        break;
    case KeyAction::Help:
        panel_.help = !panel_.help;
        spdlog::debug("the help is {}", panel_.help ? "shown" : "hidden");
        break;
    case KeyAction::FullScreen:
        window_.toggleFullScreen();
        spdlog::debug(glfwGetWindowMonitor(window_.get()) ? "full screen" : "a window again");
        break;
    case KeyAction::Quit:
        escape();
        break;
    default: // keys that are held: moveCamera()
        break;
    }
}

void Viewer::close()
{
    spdlog::debug("the viewer is closed");
    window_.close();
}

bool Viewer::hasUnsavedEdits() const
{
    return panel_.editor.history.state() != savedState_;
}

void Viewer::ask()
{
    overlay_.endEditing(); // so that the answer does not go to a field
    asks_ = true;
    spdlog::debug("{}", unsaved);
}

void Viewer::escape()
{
    if (overlay_.listOpen()) {
        overlay_.endEditing();
    } else if (panel_.help) {
        panel_.help = false;
    } else if (hasUnsavedEdits()) {
        ask();
    } else {
        close();
    }
}

// Handles the keys that change how frames are drawn; returns true if `action` is one of them.
bool Viewer::onFrameAction(KeyAction action)
{
    const uint32_t lights = uint32_t(scene_.lights.size());
    FrameOptions& frame = panel_.frame;
    noteEdits(); // what is wanted from now on is another number of lights than there are now
    switch (action) {
    case KeyAction::NextSpecular:
        frame.specular = nextSpecular(frame.specular);
        showNote(fmt::format("specular highlights: {}", specularName(frame.specular)));
        return true;
    case KeyAction::Culling:
        frame.culling =
            frame.culling == CND_CULLING_CLUSTERED ? CND_CULLING_BRUTE : CND_CULLING_CLUSTERED;
        if (frame.culling == CND_CULLING_BRUTE)
            frame.heatMap = HeatMap::None;
        showNote(fmt::format("light culling: {}", cullingName(frame.culling)));
        return true;
    case KeyAction::HeatMap:
        if (frame.culling == CND_CULLING_CLUSTERED)
            frame.heatMap = HeatMap((uint32_t(frame.heatMap) + 1) % heatMapCount);
        if (frame.heatMap == HeatMap::Shadow && !frame.shadows)
            frame.heatMap = HeatMap::None;
        if (frame.culling == CND_CULLING_CLUSTERED)
            spdlog::debug("heat map: {}", nameOf(frame.heatMap, heatMapChoices));
        else
            showNote("heat maps need clustered culling (C)");
        return true;
    case KeyAction::Compare:
        panel_.wipe.on = !panel_.wipe.on;
        spdlog::debug(panel_.wipe.on ? "two ways of shading are compared"
                                     : "one way of shading is shown");
        return true;
    case KeyAction::FewerLights:
        panel_.wantedLights = std::max(lights / 2, 1u);
        return true;
    case KeyAction::MoreLights:
        panel_.wantedLights = std::min(std::max(lights, 1u) * 2, maxLights);
        return true;
    case KeyAction::Darker:
    case KeyAction::Brighter:
        frame.exposure.compensation += action == KeyAction::Darker ? -0.5f : 0.5f;
        showNote(fmt::format("exposure compensation {:+.1f} EV", frame.exposure.compensation));
        return true;
    default:
        return false;
    }
}

// Prints with --verbose what was done with the selected light. If none is selected, a note in the
// window says how to select one.
void Viewer::showLightNote(const char* what)
{
    if (!panel_.editor.selected)
        return showNote("no light is selected: click one, or Tab");
    const CndLight& light = scene_.lights[*panel_.editor.selected];
    std::string text = lightTypeLabel(light.type);
    if (cndIsDistant(light.type))
        text += " infinitely far away";
    else
        text += fmt::format(" at {:.2f}, {:.2f}, {:.2f} m",
                            scene_.lightOrigin.x + double(light.position[0]),
                            scene_.lightOrigin.y + double(light.position[1]),
                            scene_.lightOrigin.z + double(light.position[2]));
    if (cndLightFields(light.type) & CND_LIGHT_FIELD_RADIUS_BIT)
        text += fmt::format(", radius {:.4g}", light.radius);
    if (!cndIsDistant(light.type))
        text += fmt::format(", influence radius {:.3g} m", light.influenceRadius);
    spdlog::debug("light {} {}: {}", *panel_.editor.selected, what, text);
}

// Handles the keys of lights; returns true if `action` is one of them. Lights move along the
// world's axes: the arrow keys use the horizontal axes nearest to the camera's forward and right.
bool Viewer::onLightAction(KeyAction action)
{
    LightEditor& editor = panel_.editor;
    if (rebuilds() && action >= KeyAction::AddLight && action <= KeyAction::Redo) {
        showNote(editorLocked);
        return true;
    }
    const glm::vec3 f = camera_.camera().forward;
    const bool alongX = std::abs(f.x) > std::abs(f.z);
    const glm::vec3 ahead =
        alongX ? glm::vec3(f.x < 0 ? -1 : 1, 0, 0) : glm::vec3(0, 0, f.z < 0 ? -1 : 1);
    const glm::vec3 right{-ahead.z, 0, ahead.x};
    const auto move = [&](const glm::vec3& direction) {
        if (moveLight(scene_, editor, lightStep * direction) || !editor.selected)
            showLightNote("moved");
        else
            showNote(fmt::format("light {} has no position", *editor.selected));
        return true;
    };
    switch (action) {
    case KeyAction::AddLight:
        addLightInView();
        showLightNote("added");
        return true;
    case KeyAction::DuplicateLight:
        duplicateLight(scene_, editor);
        showLightNote("added");
        return true;
    case KeyAction::NextLight:
    case KeyAction::PreviousLight:
        selectLight(scene_, editor, action == KeyAction::NextLight ? 1 : -1);
        panel_.object.reset();
        showLightNote("selected");
        return true;
    case KeyAction::RemoveLight:
        showLightNote("removed");
        removeLight(scene_, editor);
        return true;
    case KeyAction::ShrinkLight:
    case KeyAction::GrowLight:
        if (scaleLightRadius(scene_, editor,
                             action == KeyAction::GrowLight ? radiusStep : 1 / radiusStep) ||
            !editor.selected)
            showLightNote("resized");
        else
            showNote(fmt::format("light {} has no radius", *editor.selected));
        return true;
    case KeyAction::Undo:
        showNote(undoEdit(scene_, editor));
        return true;
    case KeyAction::Redo:
        showNote(redoEdit(scene_, editor));
        return true;
    case KeyAction::LightAhead:
        return move(ahead);
    case KeyAction::LightBack:
        return move(-ahead);
    case KeyAction::LightRight:
        return move(right);
    case KeyAction::LightLeft:
        return move(-right);
    case KeyAction::LightUp:
        return move({0, 1, 0});
    case KeyAction::LightDown:
        return move({0, -1, 0});
    default:
        return false;
    }
}

void Viewer::toggleOrbit()
{
    if (camera_.orbits()) {
        camera_.fly();
        return showNote("the camera flies");
    }
    // The pivot is as far ahead as the middle of the scene. If the middle lies behind the camera,
    // it is a third of the scene's diagonal ahead, at least 1 m.
    const Bounds bounds = sceneBounds(scene_);
    const Camera camera = camera_.camera();
    const double middle =
        glm::dot(0.5 * (bounds.min + bounds.max) - camera.position, camera.forward);
    const double third = glm::length(bounds.max - bounds.min) / 3;
    camera_.orbit(middle > 0 ? middle : std::max(third, 1.0));
    showNote("the camera orbits the point ahead");
}

// Turns the camera to what is selected and moves it to where that fills the picture, or else to
// where it sees the whole scene. It stops before what would hide the selected light or object.
void Viewer::frameSelection()
{
    // Half of the size of what is selected, and of what is to be in the picture.
    glm::dvec3 middle(0), half(0), shown(0);
    std::string what;
    if (const auto light = selectedNow(); light && !cndIsDistant(light->type)) {
        // A light is seen together with what it lights best.
        middle = scene_.lightOrigin +
                 glm::dvec3(light->position[0], light->position[1], light->position[2]);
        const double near =
            std::isfinite(light->influenceRadius) ? 0.1 * light->influenceRadius : 0;
        const double radius = cndEmitterBoundingRadius(&*light);
        half = glm::dvec3(std::max(radius, 0.01));
        shown = glm::dvec3(std::max({3 * radius, near, 0.25}));
        what = fmt::format("light {}", *panel_.editor.selected);
    } else if (panel_.object) {
        const Bounds& b = panel_.object->bounds;
        middle = 0.5 * (b.min + b.max);
        half = shown = 0.5 * (b.max - b.min);
        what = panel_.object->name;
    } else {
        return frameScene();
    }
    Camera camera = camera_.camera();
    camera.nearPlane = home_.nearPlane; // Framing lowers it where that is needed.
    if (const glm::dvec3 way = middle - camera.position; glm::length(way) > 1e-3)
        camera.forward = glm::normalize(way);
    camera = FlyCamera(camera, camera_.speed()).camera(); // A FlyCamera never looks straight down.
    const PixelSize size = swapchain_.size();
    const Camera fitted = fitCamera(cornersOf({middle - shown, middle + shown}), camera,
                                    double(size.width) / size.height);
    const double depth = glm::dot(half, glm::abs(camera.forward));
    spdlog::debug("{} is framed", what);
    goTo(beforeOccluders(fitted, middle - depth * camera.forward, rays()));
}

void Viewer::goTo(const Camera& camera)
{
    camera_ = FlyCamera(camera, camera_.speed());
    printCamera();
}

void Viewer::printCamera() const
{
    const Camera camera = cameraOfWindow();
    const glm::dvec3 p = camera.position, to = p + camera.forward;
    spdlog::debug("--camera {:.4f},{:.4f},{:.4f},{:.4f},{:.4f},{:.4f},{:.4g}", p.x, p.y, p.z, to.x,
                  to.y, to.z, glm::degrees(camera.verticalFov));
}

RayCaster& Viewer::rays()
{
    if (!rays_)
        rays_.emplace(scene_);
    return *rays_;
}

// Moves the camera back until it sees all of the scene; into a room, to its camera inside.
void Viewer::frameScene()
{
    if (scene_.interior) {
        spdlog::debug("the camera is inside the scene");
        const auto inside =
            std::find_if(scene_.cameras.begin(), scene_.cameras.end(),
                         [](const Camera& camera) { return camera.name == "inside"; });
        return goTo(inside == scene_.cameras.end() ? scene_.cameras.front() : *inside);
    }
    spdlog::debug("the whole scene is in view");
    const PixelSize size = swapchain_.size();
    Camera camera = camera_.camera();
    camera.nearPlane = home_.nearPlane; // Framing lowers it where that is needed.
    goTo(fitCamera(scene_, {0, scene_.instances.size()}, camera, double(size.width) / size.height));
}

// Returns the camera as a picture of the window's size shows it.
Camera Viewer::cameraOfWindow() const
{
    const PixelSize size = swapchain_.size();
    return cameraOfPicture(camera_.camera(), double(size.width) / size.height);
}

Projection Viewer::projection() const
{
    return {camera_.camera(), swapchain_.size()};
}

// Returns the selected light where it is now, if it moves.
std::optional<CndLight> Viewer::selectedNow() const
{
    if (!panel_.editor.selected || *panel_.editor.selected >= scene_.lights.size())
        return {};
    return lightAtTime(scene_, *panel_.editor.selected, time_);
}

// Returns the surface that is visible at a place of the picture. Masks count as surfaces.
std::optional<RayHit> Viewer::surfaceAt(glm::dvec2 place)
{
    const Projection::Line line = projection().lineAt(place);
    return rays().cast({line.origin, line.direction});
}

// Returns the light at a place of the picture: one that no surface hides, or the only light inside
// of the object there, such as the bulb of a lamp.
std::optional<uint32_t> Viewer::lightUnder(glm::dvec2 place, const std::optional<RayHit>& surface,
                                           const std::optional<SelectedObject>& object) const
{
    std::vector<CndLight> lights;
    lightsAtTime(scene_, time_, lights);
    const auto nearest = [&](double farthest) {
        return lightAt(lights, scene_.lightOrigin, projection(), place, clickSlack(), farthest);
    };
    constexpr double unlimited = std::numeric_limits<double>::infinity();
    const std::optional<uint32_t> visible = nearest(surface ? surface->distance : unlimited);
    // The walls of a room are around the camera as well.
    if (visible || !object || contains(object->bounds, camera_.camera().position))
        return visible;
    std::vector<uint32_t> inside;
    for (uint32_t i = 0; i < lights.size(); ++i)
        if (contains(object->bounds,
                     scene_.lightOrigin + glm::dvec3(lights[i].position[0], lights[i].position[1],
                                                     lights[i].position[2]))) {
            lights[inside.size()] = lights[i];
            inside.push_back(i);
        }
    if (inside.size() != 1) // a house, not a lamp
        return std::nullopt;
    lights.resize(1);
    return nearest(unlimited) ? std::optional(inside[0]) : std::nullopt;
}

// Selects the light at a place of the picture, else the object there, else nothing.
void Viewer::selectAt(glm::dvec2 place)
{
    const std::optional<RayHit> surface = surfaceAt(place);
    panel_.object = surface ? objectOf(scene_, *surface) : std::nullopt;
    panel_.editor.selected = lightUnder(place, surface, panel_.object);
    if (panel_.editor.selected) {
        panel_.object.reset();
        return showLightNote("selected");
    }
    if (panel_.object)
        spdlog::debug("{} selected, of material {}", panel_.object->name,
                      scene_.materials[panel_.object->material].name);
    else
        spdlog::debug("nothing is selected");
}

// Adds a bulb that nearly touches the surface under the mouse, or in the middle of the view if the
// mouse is not over the picture. Where there is no surface, it is a third of the scene away.
void Viewer::addLightInView()
{
    const PixelSize size = swapchain_.size();
    const glm::dvec2 place =
        pixelUnderMouse() ? mouseInPicture() : 0.5 * glm::dvec2(size.width, size.height);
    const Projection::Line line = projection().lineAt(place);
    const auto seen = surfaceAt(place);
    const glm::dvec3 position =
        seen ? seen->position + 2.0 * bulbRadius * seen->normal
             : line.origin + std::max(diagonalOf(scene_) / 3, 1.0) * line.direction;
    addLight(scene_, panel_.editor, position,
             {.radius = bulbRadius,
              .power = bulbPower,
              .influenceRadius = influenceRadiusFor(bulbPower)});
}

// Returns the distance at which a bulb gives a hundredth of the illuminance with which a grey card
// would have the luminance that the current exposure shows as middle grey. The result is between
// 1 m and the diagonal of the scene, or 1 m if the diagonal is shorter.
float Viewer::influenceRadiusFor(float power) const
{
    const double luminance = std::exp2(double(figures_.exposure.adaptedEv100)) / 8; // cd/m^2
    const double least = 0.01 * luminance * std::numbers::pi / 0.18;                // lx
    const double radius = std::sqrt(double(power) / (4 * std::numbers::pi * least));
    return float(std::clamp(radius, 1.0, std::max(diagonalOf(scene_), 1.0)));
}

void Viewer::onDrop(const std::string& path)
{
    SceneOptions options = wantedOptions_;
    const auto ends = [&](const char* extension) { return path.ends_with(extension); };
    if (ends(".hdr") || ends(".exr") || ends(".pfm")) {
        options.environment = path;
        // If a scene is being loaded, it gets the environment, and loading starts again.
        return open(wantedScene_, options, loader_.busy() ? loadingKept_ : Kept::CameraAndLights);
    }
    const std::pair<std::string, uint64_t> refused{path, panel_.editor.history.state()};
    if (hasUnsavedEdits() && std::exchange(refusedDrop_, refused) != refused)
        return showNote(fmt::format("{}; drop {} again to open it without them", unsaved, path));
    options.lights.reset();
    open(path, options, Kept::Nothing);
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

// Calls `write` with a free name and shows the result. `write` may throw a
// std::runtime_error, whose message is shown instead.
void Viewer::save(const char* extension, const std::function<void(const std::string&)>& write)
{
    const std::string path = freeName(extension);
    ring_.wait();
    try {
        write(path);
        showNote("wrote " + path, spdlog::level::info);
    } catch (const std::runtime_error& error) {
        showNote(error.what(), spdlog::level::err);
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
        savedState_ = panel_.editor.history.state();
    });
}

glm::dvec2 Viewer::mouseInPicture() const
{
    int width = 0, height = 0;
    glfwGetWindowSize(window_.get(), &width, &height);
    const PixelSize size = swapchain_.size();
    return {mouseX_ * size.width / std::max(width, 1), mouseY_ * size.height / std::max(height, 1)};
}

std::optional<PixelPosition> Viewer::pixelUnderMouse() const
{
    const PixelSize size = swapchain_.size();
    const glm::dvec2 at = mouseInPicture();
    if (overlay_.takesMouse().value_or(false) || at.x < 0 || at.y < 0 || at.x >= size.width ||
        at.y >= size.height)
        return std::nullopt;
    return PixelPosition{uint32_t(at.x), uint32_t(at.y)};
}

void Viewer::pick(PixelPosition pixel)
{
    const PixelSize size = swapchain_.size();
    FrameOptions frame = optionsAt(int32_t(pixel.x));
    if (const std::string refusal = pickRefusal(frame); !refusal.empty()) {
        showNote("no pixel picked: " + refusal);
        return;
    }
    if (pixel.x >= size.width || pixel.y >= size.height) // the window has become smaller
        return;
    frame.deltaTime = 0; // the exposure does not adapt
    ring_.wait();
    figures_.picked = pickPixel(context_, *renderer_, scene_, frame, pixel);
    renderer_->lightsChanged(); // pickPixel has drawn the lights one at a time
    recorded_ = {};
    dropPicture();
    spdlog::info("{}", pickText(*figures_.picked, scene_));
}

void Viewer::moveCamera(double seconds)
{
    freshKeys_.clear();
    while (!window_.events.empty() && handle(window_.events.front())) {
        window_.events.pop_front();
        settling_ = panelSettles;
        handled_ = true;
    }
    if (std::exchange(panel_.editor.wantsNew, false))
        onAction(KeyAction::AddLight);
    if (const auto camera = std::exchange(panel_.wantedCamera, std::nullopt))
        goTo(scene_.cameras[*camera]);
    const auto axis = [&](KeyAction plus, KeyAction minus) {
        return double(isHeld(plus)) - double(isHeld(minus));
    };
    const FlyInput input{.move = {axis(KeyAction::Right, KeyAction::Left),
                                  axis(KeyAction::Up, KeyAction::Down),
                                  axis(KeyAction::Forward, KeyAction::Back)},
                         .look = std::exchange(look_, glm::dvec2(0)),
                         .fast = heldKeys_.contains(GLFW_KEY_LEFT_SHIFT) ||
                                 heldKeys_.contains(GLFW_KEY_RIGHT_SHIFT)};
    camera_.update(input, seconds);
    const bool moves = input.move != glm::dvec3(0) || input.look != glm::dvec2(0);
    if (std::exchange(moved_, moves) && !moves)
        printCamera();
}

void Viewer::drawOverlay()
{
    if (panel_.editor.selected) // by a key or by the panel
        panel_.object.reset();
    panel_.editor.locked = rebuilds();
    const auto shown = handles();
    drawSelection(panel_, projection(), selectedNow(), scene_.lightOrigin, shown);
    if (shown)
        drawHandles(*shown, projection(),
                    handleDrag_   ? handleDrag_->handle
                    : dragButton_ ? std::nullopt
                                  : shown->at(projection(), mouseInPicture(), clickSlack()));
    if (asks_)
        drawMessage(std::string("The ") + unsaved + ".",
                    "F5 saves them. Esc closes the window without saving. Any other key returns to "
                    "the scene.");
    drawPanel(panel_, figures_, scene_);
    constexpr double unseen = 0.1; // s; what takes less time is not worth a bar
    if (!loader_.busy() && work_.busy() && work_.seconds() > unseen)
        drawProgress(work_.state(), true);
}

} // namespace candelabra::app
