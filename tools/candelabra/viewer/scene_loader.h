// SPDX-License-Identifier: Apache-2.0
// SceneLoader: loads scenes and makes their renderers on another thread, so that the window reacts.
#pragma once

#include <atomic>
#include <exception>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <thread>

#include "io/job.h"
#include "render/renderer.h"
#include "scene/scene_options.h"
#include "json/save.h"

namespace candelabra::app
{

// From where a scene is seen at first, and in what size.
struct SceneView {
    Camera camera;
    PixelSize size;
};

struct SceneRequest {
    std::string scene; // as loadScene takes it
    SceneOptions options;
    RendererOptions renderer; // its size is that of `view`
    // Called on the thread that loads. It may throw UsageError.
    std::function<SceneView(const Scene&)> view;
    bool moveCamera = true; // the user is to see the scene from `view`, not from where they are
};

struct LoadedScene {
    SceneRequest request;
    SceneView view;
    Scene scene;
    SceneSource source;                 // where the scene's surfaces come from
    std::unique_ptr<Renderer> renderer; // refers to `scene`
};

// The sentence of an exception of the program or of the engine.
std::string messageOf(const std::exception_ptr& failure);

class SceneLoader
{
public:
    // `context` must outlive the loader.
    explicit SceneLoader(const VulkanContext& context) : context_(context) {}
    ~SceneLoader(); // stops the work and waits until it has ended
    SceneLoader(const SceneLoader&) = delete;
    SceneLoader& operator=(const SceneLoader&) = delete;

    // Begins to load. A request that is not finished is given up.
    void start(SceneRequest request);
    // True from start() until take() has returned the scene or thrown.
    bool busy() const { return work_ != nullptr; }
    // Returns the step that the loading has reached. May be called only while busy() is true.
    Job::State state() const;
    // Returns the scene, or null if it is not finished or if there is nothing to load. Throws what
    // loading has thrown.
    std::unique_ptr<LoadedScene> take();

private:
    struct Work {
        SceneRequest request;
        Job job;
        std::unique_ptr<LoadedScene> loaded; // these three are read after `ended` only
        std::exception_ptr failure;
        std::atomic<bool> ended{false};
        std::thread thread;
    };
    void begin(SceneRequest request);

    const VulkanContext& context_;
    std::unique_ptr<Work> work_;
    std::optional<SceneRequest> next_; // to be begun when the given up work has ended
};

} // namespace candelabra::app
