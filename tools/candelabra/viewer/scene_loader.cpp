// SPDX-License-Identifier: Apache-2.0
#include "viewer/scene_loader.h"

#include <filesystem>
#include <utility>

#include <fmt/format.h>

#include "generate/generators.h"
#include "io/table.h"
#include "load/load.h"
#include "render/check.h"
#include "render/pipeline_watch.h"

namespace candelabra::app
{
namespace
{

struct Stopped {
};

void begins(Job& job, const std::string& what, double done)
{
    if (!job.doing(what, done))
        throw Stopped();
}

// The parts of the bar at which the stages begin.
constexpr double uploadAt = 0.3, pipelinesAt = 0.5, pictureAt = 1;

std::string shortName(const std::string& scene)
{
    return isGenerated(scene) ? scene : std::filesystem::path(scene).filename().string();
}

std::unique_ptr<LoadedScene> load(const VulkanContext& context, const SceneRequest& request,
                                  Job& job)
{
    const std::string name = shortName(request.scene);
    begins(job, fmt::format("{} {} ...", isGenerated(request.scene) ? "Building" : "Loading", name),
           0);
    auto out = std::make_unique<LoadedScene>();
    out->request = request;
    out->scene = loadScene(request.scene, request.options);
    requireSomethingToDraw(out->scene, request.scene);
    out->source = sceneSource(request.scene, request.options.seed);
    out->view = request.view(out->scene);
    begins(job, fmt::format("Uploading {} ...", counted(out->scene.instances.size(), "object")),
           uploadAt);
    // The number of pipelines is not known before they are made: it depends on the types of the
    // lights and on the materials. Each takes the same part of what is left of the bar.
    uint32_t pipelines = 0;
    double done = pipelinesAt;
    const PipelineWatch watch([&] {
        const bool goOn = job.doing(fmt::format("Compiling shaders: {} ...", ++pipelines), done);
        done += (pictureAt - done) / 64;
        return goOn;
    });
    RendererOptions options = request.renderer;
    options.size = out->view.size;
    out->renderer = std::make_unique<Renderer>(context, out->scene, options);
    begins(job, "Drawing the first picture ...", pictureAt);
    return out;
}

} // namespace

std::string messageOf(const std::exception_ptr& failure)
{
    try {
        std::rethrow_exception(failure);
    } catch (const gpu::Failure& error) {
        return error.message;
    } catch (const std::bad_alloc&) {
        return "out of memory";
    } catch (const std::exception& error) {
        return error.what();
    }
}

SceneLoader::~SceneLoader()
{
    if (!work_)
        return;
    work_->job.stop();
    work_->thread.join();
}

void SceneLoader::start(SceneRequest request)
{
    if (!work_)
        return begin(std::move(request));
    work_->job.stop();
    next_ = std::move(request);
}

void SceneLoader::begin(SceneRequest request)
{
    work_ = std::make_unique<Work>();
    work_->request = std::move(request);
    work_->thread = std::thread([&work = *work_, &context = context_] {
        try {
            work.loaded = load(context, work.request, work.job);
        } catch (...) {
            work.failure = std::current_exception();
        }
        work.ended = true;
    });
}

Job::State SceneLoader::state() const
{
    return work_->job.state();
}

std::unique_ptr<LoadedScene> SceneLoader::take()
{
    if (!work_ || !work_->ended)
        return nullptr;
    const std::unique_ptr<Work> work = std::move(work_);
    work->thread.join();
    if (work->job.stopped()) { // whatever became of it, it is not wanted any more
        begin(*std::exchange(next_, std::nullopt));
        return nullptr;
    }
    if (work->failure)
        std::rethrow_exception(work->failure);
    return std::move(work->loaded);
}

} // namespace candelabra::app
