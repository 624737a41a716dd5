// SPDX-License-Identifier: Apache-2.0
// Viewer: a window in which the user flies through a scene and edits its lights.
#pragma once

#include <array>
#include <chrono>
#include <functional>
#include <memory>
#include <optional>
#include <set>
#include <string>

#include <spdlog/common.h>

#include "generate/ray_caster.h"
#include "render/renderer.h"
#include "scene/scene_options.h"
#include "viewer/fly_camera.h"
#include "viewer/keys.h"
#include "viewer/light_handles.h"
#include "viewer/moving_size.h"
#include "viewer/panel.h"
#include "viewer/scene_loader.h"
#include "viewer/screen.h"
#include "viewer/still_picture.h"

namespace candelabra::app
{

struct ViewerOptions {
    CndGBufferLayout gbufferLayout = CND_GBUFFER_FULL;
    FrameOptions frame;
    bool choosesShadows = false;       // as SceneRequest has it
    std::optional<bool> lightsVisible; // empty: as the scene says
    bool overlay = true;               // the panel is visible at first
    // Number of frames after which the viewer stops. Their scene times are 1/60 s apart, whatever
    // the clock says. 0: it runs until the window is closed.
    uint32_t frames = 0;
    WhileMoving whileMoving = WhileMoving::Auto;
    std::string screenshot; // file for a PNG of the window's last frame; needs `frames`
};

// Returns the options of renderers of the viewer that first draw frames like `frame`, except for
// their size.
RendererOptions rendererOptions(const ViewerOptions& options, const FrameOptions& frame);

// The settings of a frame that decide which pipelines it needs.
struct Shading {
    CndSpecularMethod specular = CND_SPECULAR_CONIC;
    CndCulling culling = CND_CULLING_CLUSTERED;
    HeatMap heatMap = HeatMap::None;

    static Shading of(const FrameOptions& frame);
    FrameOptions in(FrameOptions frame) const; // `frame`, shaded like this
    bool operator==(const Shading&) const = default;
};

class Viewer
{
public:
    // `screen` and `loader` must outlive the viewer. The loader has nothing to do. `first` is the
    // scene that is shown at first. Throws RunError.
    Viewer(const ViewerOptions& options, Screen& screen, SceneLoader& loader,
           std::unique_ptr<LoadedScene> first);
    ~Viewer();
    Viewer(const Viewer&) = delete;
    Viewer& operator=(const Viewer&) = delete;
    void run();

private:
    // After an event, so many frames are drawn, because the panel shows some effects of it only in
    // later frames.
    static constexpr uint32_t panelSettles = 3;

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
    void ask();
    void close();
    bool hasUnsavedEdits() const;
    void showNote(const std::string& note, spdlog::level::level_enum level = spdlog::level::debug);
    void showLightNote(const char* what);
    void toggleOrbit();
    void frameSelection();
    void frameScene();
    void goTo(const Camera& camera);
    void printCamera() const;
    std::optional<LightHandles> handles() const;
    double clickSlack() const; // pixels by which a click may miss
    void dragHandle();
    Camera cameraOfWindow() const;
    Projection projection() const;
    std::optional<CndLight> selectedNow() const;
    RayCaster& rays();
    std::optional<RayHit> surfaceAt(glm::dvec2 place);
    std::optional<uint32_t> lightUnder(glm::dvec2 place, const std::optional<RayHit>& surface,
                                       const std::optional<SelectedObject>& object) const;
    void selectAt(glm::dvec2 place);
    void addLightInView();
    float influenceRadiusFor(float power) const;
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
    // the other one is there, and if loading fails.
    void open(const std::string& scene, const SceneOptions& options, Kept kept);
    // Shows what has been loaded since the last frame.
    void takeLoaded();
    void show(std::unique_ptr<LoadedScene> loaded);
    void takeScene(Kept kept);
    void rebuild(uint32_t wanted);
    // Forgets what was measured of the frames of the renderer before.
    void forgetFrames();
    void dropPicture();
    // Tells whether the scene is being built with another number of lights. Its lights cannot be
    // edited meanwhile, because the edits would be lost.
    bool rebuilds() const;
    void noteEdits();
    void fitToWindow();
    // The size of the renderers: that of the window, or half of it while the user moves.
    PixelSize drawnSize() const;
    void collectStats(const FrameRing::Frame& frame);

    // Work of another thread, defined in viewer_work.cpp.
    enum class Side { Left, Right };
    void prepare();
    void await(const std::function<bool()>& ended);
    void useWhatIsThere();
    void startWork();
    void prepareLights(Renderer& renderer);
    void makeRenderer(Side side);
    void takeWork();
    void useMade();
    void takeBackLights();
    bool canLight() const;
    // Returns how the user wants the pixels right of the wipe's line to be shaded: with the wipe's
    // specular method and culling, and without a heat map.
    Shading wantedRight() const;
    // Returns how the pixels of column `x` are shaded.
    FrameOptions optionsAt(int32_t x) const;

    // The renderer that draws right of the wipe's line, or null if there is no wipe now.
    Renderer* right() const { return panel_.wipe.on ? other_.get() : nullptr; }
    // The first column right of the wipe's line; the image's width if there is no wipe.
    int32_t wipeColumn() const;
    // Returns the content of the next frame, for StillPicture.
    PictureSettings pictureSettings() const;
    // Waits for events if there is nothing to draw. Returns whether it has waited.
    bool awaitEvents();
    // Brings everything up to date with what the user has done, before a frame. `wall`: seconds
    // since the last call.
    void advance(double seconds, double wall);
    void drawFrame(double seconds, bool screenshot);
    void recordNext(const FrameRing::Frame& frame);
    void beginPicture(FrameSample sample);
    void recordPicture(const FrameRing::Frame& frame);
    bool recordPiece(const FrameRing::Frame& frame);
    void endPicture(const FrameRing::Frame& frame);
    bool drawsInPieces(const FrameSample& sample) const;
    void waitForGpu();
    bool ends();
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
    // The last request to load a scene that has not failed, on which the next one is based.
    std::string wantedScene_;
    SceneOptions wantedOptions_;
    Scene scene_;
    SceneSource source_;              // where the scene's surfaces come from
    std::vector<Material> materials_; // the scene's materials before any override
    size_t ownLights_ = 0;            // number of lights in the scene's file, without added ones
    // Both refer to the scene.
    std::unique_ptr<Renderer> renderer_;
    // Draws right of the wipe's line. Null without a wipe, and after new materials until it has
    // been made for them. It stays for a while after the wipe has been switched off.
    std::unique_ptr<Renderer> other_;

    FlyCamera camera_;
    PanelState panel_;
    PanelFigures figures_;
    StillPicture still_{Screen::slotCount};
    MovingSize movingSize_;
    // The picture that is being drawn. On slow devices it is drawn in pieces, a submission each, so
    // that input is answered meanwhile: first the surfaces, then the light of some rows at a time.
    struct Picture {
        FrameSample sample;
        FrameOptions left;
        std::optional<FrameOptions> right;
        uint64_t version = 0;          // StillPicture::version() when it began
        std::optional<uint32_t> row{}; // the first row without light; empty: no surfaces yet
    };
    std::optional<Picture> picture_;
    PieceRows pieceRows_;
    std::chrono::steady_clock::time_point submitted_; // when the last frame was submitted
    bool hasPicture_ = false; // the display images of the renderers have a picture
    bool handled_ = false;    // an event was handled since the last frame
    bool answered_ = false;   // the last frame drew the panel alone to answer an event
    double pictureTime_ = 0;  // s of the scene since the last picture began
    double pictureWall_ = 0;  // s of the clock that the picture has taken so far
    bool moves_ = false;      // camera or lights have moved in this time
    Camera home_;             // where the scene was shown from at first
    Camera seenFrom_;         // the camera of the frame before
    bool edited_ = false;     // lights were edited before that frame
    bool complete_ = false;   // the picture was complete
    // The number of frames that are still drawn before the viewer waits for events. An event may
    // change the panel, or through it the scene, only one or two frames after the frame that
    // handled it.
    uint32_t settling_ = 0;
    uint64_t panelOnly_ = 0; // number of frames that drew the panel alone
    // Slots in which the present renderer has recorded a picture at its present size, or the last
    // piece of one, of which only the exposure can be read.
    enum class Recorded { Nothing, Picture, LastPiece };
    std::array<Recorded, Screen::slotCount> recorded_{};
    // About the scene that is being loaded: PanelState::wantedLights if it is the present scene
    // with another number of lights (Kept::Camera), what stays of the present scene, and how the
    // new renderer can shade.
    uint32_t loadingLights_ = 0;
    Kept loadingKept_ = Kept::Nothing;
    Shading loadingShading_;
    // The present shading of the two sides. While pipelines for the user's choice are being made,
    // this differs from that choice.
    Shading shownLeft_, shownRight_;
    bool lightsEdited_ = false; // the renderers do not know yet how the user has edited the lights
    // Everything that the user asked for has been made, so the frame shows it.
    bool prepared_ = false;
    bool resetExposure_ = true; // the next frame jumps to the converged exposure
    double time_ = 0;           // seconds, for moving lights
    double mouseX_ = Overlay::nowhere, mouseY_ = Overlay::nowhere; // window coordinates
    std::set<int> heldKeys_;  // keys of the scene, not of a field of the panel
    std::set<int> freshKeys_; // those that were pressed since the last frame
    // A drag that began on the scene and has not ended: the button, and how far the mouse has moved
    // in all and since the last frame, in window coordinates.
    std::optional<int> dragButton_;
    double dragged_ = 0;
    glm::dvec2 look_{0};
    // A drag of a handle. The last three members are as they were when the drag began.
    struct HandleDrag {
        uint32_t index = 0;   // the index of the light; selecting another light ends the drag
        uint32_t handle = 0;  // the one that is dragged
        LightHandles handles; // of the light
        glm::dvec3 from;      // the point of the handle that was under the mouse
        glm::dvec3 light;     // the position of the light
    };
    std::optional<HandleDrag> handleDrag_;
    bool asks_ = false;             // whether to close the window although edits are not saved
    uint64_t savedState_ = 0;       // LightHistory::state() when the scene was loaded or saved
    bool moved_ = false;            // the camera moved in the last frame
    std::optional<RayCaster> rays_; // for the present scene; made when first needed
    bool knownExposure_ = false; // the exposure is Scene::knownEv100, which the user has not chosen
    std::string dropped_;        // path of a dropped file, to be opened before the next frame
    // The path of a dropped scene that would have replaced unsaved edits, and their state.
    std::pair<std::string, uint64_t> refusedDrop_;
    uint32_t savedFiles_ = 0;
    // Requests that doRequests() fulfils after this frame, or after the first one that is as the
    // user wants it: the extension of an image to save, saving the scene, the pixel whose lights
    // are to be listed.
    const char* saveAs_ = nullptr;
    bool saveScene_ = false;
    std::optional<PixelPosition> pick_;

    // A renderer that the other thread makes, for which side (empty: it makes none), and how it can
    // shade.
    std::unique_ptr<Renderer> made_;
    std::optional<Side> madeSide_;
    Shading madeShading_;
    std::vector<Material> newMaterials_; // with the override that the renderer is made for
    MaterialOverride newOverride_, shownOverride_; // that one, and the one that is shown
    // Takes back what the user has asked for and the work is to make, so that work which fails does
    // not begin again in every frame.
    std::function<void()> takeBack_;
    Background work_; // ends before the members that it uses
};

} // namespace candelabra::app
