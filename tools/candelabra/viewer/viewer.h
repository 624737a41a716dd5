// SPDX-License-Identifier: Apache-2.0
// Viewer: a window that flies through a scene.
#pragma once

#include <array>
#include <functional>
#include <memory>
#include <optional>
#include <string>

#include "render/frame_ring.h"
#include "render/renderer.h"
#include "scene/scene_options.h"
#include "viewer/fly_camera.h"
#include "viewer/overlay.h"
#include "viewer/panel.h"
#include "viewer/swapchain.h"
#include "viewer/window.h"

namespace candelabra::app
{

struct ViewerOptions {
    std::string scene; // as for loadScene
    SceneOptions sceneOptions;
    std::string camera; // as for selectCamera
    PixelSize size;
    CndGBufferLayout gbufferLayout = CND_GBUFFER_FULL;
    FrameOptions frame;
    std::optional<bool> lightsVisible;
    bool overlay = true;
    // Stop after as many frames, 1/60 s apart whatever the clock says; 0: until closed.
    uint32_t frames = 0;
    std::string screenshot; // PNG of the window's last frame; needs `frames`
};

class Viewer
{
public:
    // `scene` is what `options` describe, loaded already.
    Viewer(const ViewerOptions& options, const ContextOptions& contextOptions,
           const WindowSystem& system, Scene scene);
    void run();
    const VulkanContext& context() const { return context_; }

private:
    static constexpr uint32_t slotCount = 2;

    // viewer_input.cpp
    void connectInput();
    void moveCamera(double seconds);
    void onKey(int key);
    bool onLightKey(int key);
    void toggleOrbit();
    void onDrop(const std::string& path);
    std::string freeName(const char* extension);
    void save(const char* extension, const std::function<void(const std::string&)>& write);
    void saveImage(const char* extension);
    void saveScene();
    std::optional<PixelPosition> pixelUnderMouse() const;
    void pick(PixelPosition pixel);

    // Takes another scene, or the same with other options. Keeps the one there is where that fails.
    bool open(const std::string& scene, const SceneOptions& options);
    void takeScene();
    void rebuild(uint32_t wanted);
    void makeRenderer();
    void applyMaterials();
    void applyEdits();
    void fitWipe();
    void fitToWindow();
    void collectStats(const FrameRing::Frame& frame);
    Swapchain::Target acquire(uint32_t slot);
    // Of what is seen left of column `x`, or right of it.
    FrameOptions optionsAt(int32_t x) const;
    int32_t wipeColumn() const;
    void drawFrame(double seconds, bool screenshot);
    void doRequests();
    void recordWindow(VkCommandBuffer cmd, const Swapchain::Target& target);
    gpu::Buffer recordScreenshot(VkCommandBuffer cmd, VkImage image) const;
    void saveScreenshot(const gpu::Buffer& pixels) const;

    ViewerOptions options_;
    // Destroyed in reverse order: everything that uses the device before the context.
    Window window_;
    VulkanContext context_;
    Scene scene_;
    SceneSource source_;              // of its surfaces
    std::vector<Material> materials_; // as the scene has them
    size_t ownLights_ = 0;            // of a file, without those added
    std::unique_ptr<Renderer> renderer_;
    std::unique_ptr<Renderer> other_; // right of the wipe, while there is one
    Swapchain swapchain_;
    Overlay overlay_;
    FrameRing ring_;

    FlyCamera camera_;
    PanelState panel_;
    PanelFigures figures_;
    std::array<bool, slotCount> recorded_{}; // by the renderer there is now
    bool staleWindow_ = false;
    bool resetExposure_ = true;
    double time_ = 0;
    double lastX_ = 0, lastY_ = 0;
    bool looking_ = false;
    std::string dropped_; // waits for the frame to end
    uint32_t savedFiles_ = 0;
    const char* saveAs_ = nullptr;      // extension of the image to be saved after this frame
    bool saveScene_ = false;            // after this frame, too
    std::optional<PixelPosition> pick_; // likewise
};

} // namespace candelabra::app
