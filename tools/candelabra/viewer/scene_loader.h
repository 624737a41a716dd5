// SPDX-License-Identifier: Apache-2.0
// SceneLoader: loads scenes and makes their renderers on another thread, so that the window reacts.
#pragma once

#include <functional>
#include <memory>
#include <optional>
#include <string>

#include "render/renderer.h"
#include "scene/scene_options.h"
#include "viewer/background.h"
#include "json/save.h"

namespace candelabra::app
{

// From where a scene is seen at first, and in what size.
struct SceneView {
    Camera camera;
    PixelSize size;
};

// The parts of the present view that stay when a scene has been loaded.
enum class Kept {
    Nothing,
    Camera,
    CameraAndLights, // with all edits
};

struct SceneRequest {
    std::string scene; // as loadScene takes it
    SceneOptions options;
    RendererOptions renderer; // its size is that of `view`
    // The scene has shadows unless they take too long on a CPU (generate/shadow_cost.h), whatever
    // `renderer` says.
    bool choosesShadows = false;
    bool uncut = false; // the lights reach everywhere
    // Called on the thread that loads. It may throw UsageError.
    std::function<SceneView(const Scene&)> view;
    Kept kept = Kept::Nothing;
};

struct LoadedScene {
    SceneRequest request;
    SceneView view;
    Scene scene;
    SceneSource source;                 // where the scene's surfaces come from
    uint32_t shadows = 0;               // RendererOptions::shadows
    double shadowSeconds = 0;           // s; what a frame would take longer with shadows
    std::unique_ptr<Renderer> renderer; // refers to `scene`
};

// Says why the scene has no shadows, if that was not the user's choice.
void logShadowsLeftOut(const LoadedScene& loaded);

// Both show their progress in `job`, from the part `from` (0..1) of its bar to its end.
//
// Calls `make`, which makes pipelines on this thread, and says in `job` how many have been made.
// The engine fails if the job is to stop.
void compileShaders(Job& job, double from, const std::function<void()>& make);
// Makes a renderer. Throws as Renderer does, or to end the work if the job is to stop.
std::unique_ptr<Renderer> makeRenderer(const VulkanContext& context, const Scene& scene,
                                       const RendererOptions& options, double from, Job& job);

class SceneLoader
{
public:
    // `context` must outlive the loader.
    explicit SceneLoader(const VulkanContext& context) : context_(context) {}
    SceneLoader(const SceneLoader&) = delete;
    SceneLoader& operator=(const SceneLoader&) = delete;

    // Begins to load. A request that is not finished is given up.
    void start(SceneRequest request);
    // True from start() until take() has returned the scene or thrown.
    bool busy() const { return work_.busy(); }
    // These may be called only while busy() is true. The step that the loading has reached:
    Job::State state() const { return work_.state(); }
    // Tells whether the work has ended, so that take() returns its scene, or begins with another
    // one.
    bool ended() const { return work_.ended(); }
    // Returns the scene, or null if it is not finished or if there is nothing to load. Throws what
    // loading has thrown.
    std::unique_ptr<LoadedScene> take();

private:
    void begin(SceneRequest request);

    const VulkanContext& context_;
    std::optional<SceneRequest> next_;    // to be begun when the given up work has ended
    std::unique_ptr<LoadedScene> loaded_; // what the work has made
    Background work_;                     // ends before the members that it uses
};

} // namespace candelabra::app
