// SPDX-License-Identifier: Apache-2.0
// Viewer: a window in which the user flies through a scene and edits its lights.
#pragma once

#include <array>
#include <functional>
#include <memory>
#include <optional>
#include <set>
#include <string>

#include "generate/ray_caster.h"
#include "render/renderer.h"
#include "scene/scene_options.h"
#include "viewer/fly_camera.h"
#include "viewer/keys.h"
#include "viewer/light_shape.h"
#include "viewer/panel.h"
#include "viewer/scene_loader.h"
#include "viewer/screen.h"

namespace candelabra::app
{

struct ViewerOptions {
    CndGBufferLayout gbufferLayout = CND_GBUFFER_FULL;
    FrameOptions frame;
    std::optional<bool> lightsVisible; // empty: as the scene says
    bool overlay = true;               // the panel is visible at first
    // Number of frames after which the viewer stops. Their scene times are 1/60 s apart, whatever
    // the clock says. 0: it runs until the window is closed.
    uint32_t frames = 0;
    std::string screenshot; // file for a PNG of the window's last frame; needs `frames`
};

// How the renderers of the viewer are made, apart from their size.
RendererOptions rendererOptions(const ViewerOptions& options);

class Viewer
{
public:
    // `screen` and `loader` must outlive the viewer. The loader has nothing to do. `first` is the
    // scene that is shown at first. Throws RunError.
    Viewer(const ViewerOptions& options, Screen& screen, SceneLoader& loader,
           std::unique_ptr<LoadedScene> first);
    void run();

private:
    // Input, defined in viewer_input.cpp.
    void moveCamera(double seconds); // also handles what the user has done since the last call
    bool handle(const InputEvent& event);
    bool onKeyEvent(const InputEvent& event);
    bool onKeyPressed(const InputEvent& event);
    bool onButton(const InputEvent& event);
    bool onMove(double x, double y);
    bool isHeld(KeyAction action) const;
    void onAction(KeyAction action);
    bool onFrameAction(KeyAction action);
    bool onLightAction(KeyAction action);
    void escape();
    void say(const std::string& note);
    void sayLight(const char* what);
    void toggleOrbit();
    void frameSelection();
    void frameScene();
    Projection projection() const;
    std::optional<CndLight> selectedNow() const;
    std::optional<RayHit> surfaceAt(glm::dvec2 place);
    std::optional<uint32_t> lightUnder(glm::dvec2 place, const std::optional<RayHit>& surface,
                                       const std::optional<SelectedObject>& object) const;
    void selectAt(glm::dvec2 place);
    void addLightInView();
    void onDrop(const std::string& path);
    std::string freeName(const char* extension);
    void save(const char* extension, const std::function<void(const std::string&)>& write);
    void saveImage(const char* extension);
    void saveScene();
    glm::dvec2 mouseInPicture() const; // pixels, of which a window unit may have several
    std::optional<PixelPosition> pixelUnderMouse() const;
    void pick(PixelPosition pixel);
    void drawOverlay(); // the panel, and the outline of what is selected

    // Begins to load another scene, or the same with other options. The present scene stays until
    // the other one is there, and if loading fails. `moveCamera`: the user sees it from its own
    // camera.
    void open(const std::string& scene, const SceneOptions& options, bool moveCamera);
    // Shows what has been loaded since the last frame.
    void takeLoaded();
    void show(std::unique_ptr<LoadedScene> loaded);
    void takeScene();
    void rebuild(uint32_t wanted);
    void makeRenderer();
    RendererOptions rendererOptionsAt(PixelSize size) const;
    // Forgets what was measured of the frames of the renderer before.
    void forgetFrames();
    void applyMaterials();
    void applyEdits();
    void fitWipe();
    void fitToWindow();
    void collectStats(const FrameRing::Frame& frame);
    // Returns how the pixels of column `x` are shaded: left of the wipe's line with the user's
    // settings; from the line on with the wipe's specular method, culling and error budget instead,
    // and without a heat map.
    FrameOptions optionsAt(int32_t x) const;
    // The first column right of the wipe's line; the image's width if there is no wipe.
    int32_t wipeColumn() const;
    void drawFrame(double seconds, bool screenshot);
    void doRequests();
    void recordWindow(VkCommandBuffer cmd, const Swapchain::Target& target);
    gpu::Buffer recordScreenshot(VkCommandBuffer cmd, VkImage image) const;
    void saveScreenshot(const gpu::Buffer& pixels) const;

    ViewerOptions options_;
    Screen& screen_;
    Window& window_;
    const VulkanContext& context_;
    Swapchain& swapchain_;
    Overlay& overlay_;
    FrameRing& ring_;
    SceneLoader& loader_;
    std::string sceneName_;     // as loadScene takes it
    SceneOptions sceneOptions_; // with which the scene was loaded
    Scene scene_;
    SceneSource source_;              // where the scene's surfaces come from
    std::vector<Material> materials_; // the scene's materials before any override
    size_t ownLights_ = 0;            // number of lights in the scene's file, without added ones
    // Both refer to the scene.
    std::unique_ptr<Renderer> renderer_;
    std::unique_ptr<Renderer> other_; // draws right of the wipe's line; null without a wipe

    FlyCamera camera_;
    PanelState panel_;
    PanelFigures figures_;
    // Slots in which the present renderer has recorded a frame at its present size: their
    // statistics can be read.
    std::array<bool, Screen::slotCount> recorded_{};
    // PanelState::wantedLights when the scene was asked for that is loaded now.
    uint32_t loadingLights_ = 0;
    bool resetExposure_ = true;      // the next frame jumps to the converged exposure
    double time_ = 0;                // seconds, for moving lights
    double mouseX_ = 0, mouseY_ = 0; // window coordinates
    std::set<int> heldKeys_;         // keys of the scene, not of a field of the panel
    std::set<int> freshKeys_;        // those that were pressed since the last frame
    // A drag that began on the scene goes on: the button, how far the mouse went in all, and since
    // the last frame, in window coordinates.
    std::optional<int> dragButton_;
    double dragged_ = 0;
    glm::dvec2 look_{0};
    bool moved_ = false;            // the camera moved in the last frame
    std::optional<RayCaster> rays_; // for the present scene; made when first needed
    bool knownExposure_ = false; // the exposure is Scene::knownEv100, which the user has not chosen
    std::string dropped_;        // path of a dropped file, to be opened before the next frame
    uint32_t savedFiles_ = 0;
    // Requests that doRequests() fulfils after this frame: the extension of an image to save,
    // saving the scene, the pixel whose lights are to be listed.
    const char* saveAs_ = nullptr;
    bool saveScene_ = false;
    std::optional<PixelPosition> pick_;
};

} // namespace candelabra::app
