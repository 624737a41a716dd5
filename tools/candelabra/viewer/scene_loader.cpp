// SPDX-License-Identifier: Apache-2.0
#include "viewer/scene_loader.h"

#include <filesystem>
#include <utility>

#include <fmt/format.h>
#include <spdlog/spdlog.h>

#include "generate/generators.h"
#include "generate/shadow_cost.h"
#include "io/table.h"
#include "load/load.h"
#include "render/check.h"
#include "render/pipeline_watch.h"
#include "render/setting_names.h"

namespace candelabra::app
{
namespace
{

// The parts of the bar at which the stages begin.
constexpr double uploadAt = 0.3, pictureAt = 1;

std::string shortName(const std::string& scene)
{
    return isGenerated(scene) ? scene : std::filesystem::path(scene).filename().string();
}

std::unique_ptr<LoadedScene> load(const VulkanContext& context, const SceneRequest& request,
                                  Job& job)
{
    const std::string name = shortName(request.scene);
    beginStep(job,
              fmt::format("{} {} ...", isGenerated(request.scene) ? "Building" : "Loading", name),
              0);
    auto out = std::make_unique<LoadedScene>();
    out->request = request;
    out->scene = loadScene(request.scene, request.options);
    requireSomethingToDraw(out->scene, request.scene);
    out->source = sceneSource(request.scene, request.options.seed);
    out->view = request.view(out->scene);
    RendererOptions options = request.renderer;
    options.size = out->view.size;
    if (request.choosesShadows) {
        if (context.info().type == VK_PHYSICAL_DEVICE_TYPE_CPU)
            out->shadowSeconds = secondsOnCores(
                shadowCpuSeconds(out->scene, out->view.camera, out->view.size, request.uncut));
        options.shadows = out->shadowSeconds <= mostShadowSeconds ? usualShadowPoints : 0;
    }
    out->shadows = options.shadows;
    out->renderer = makeRenderer(context, out->scene, options, uploadAt, job);
    beginStep(job, "Drawing the first picture ...", pictureAt);
    return out;
}

} // namespace

void logShadowsLeftOut(const LoadedScene& loaded)
{
    if (loaded.request.choosesShadows && !loaded.shadows)
        spdlog::info("{}", shadowsLeftOutText(loaded.shadowSeconds));
}

void compileShaders(Job& job, double from, const std::function<void()>& make)
{
    // The number of pipelines that are added to a renderer is not known: each of these takes the
    // same part of what is left of the bar.
    uint32_t pipelines = 0;
    double done = from;
    const PipelineWatch watch([&](uint32_t announced) {
        ++pipelines;
        const bool goOn = job.doing(
            announced ? fmt::format("Compiling shaders: {} of {} ...", pipelines, announced)
                      : fmt::format("Compiling shaders: {} ...", pipelines),
            done);
        done += announced ? (pictureAt - from) / announced : (pictureAt - done) / 64;
        return goOn;
    });
    make();
}

std::unique_ptr<Renderer> makeRenderer(const VulkanContext& context, const Scene& scene,
                                       const RendererOptions& options, double from, Job& job)
{
    beginStep(job, fmt::format("Uploading {} ...", counted(scene.instances.size(), "object")),
              from);
    std::unique_ptr<Renderer> out;
    compileShaders(job, from + 0.3 * (pictureAt - from),
                   [&] { out = std::make_unique<Renderer>(context, scene, options); });
    return out;
}

void SceneLoader::start(SceneRequest request)
{
    if (!work_.busy())
        return begin(std::move(request));
    work_.stop();
    next_ = std::move(request);
}

void SceneLoader::begin(SceneRequest request)
{
    work_.start(
        [this, request = std::move(request)](Job& job) { loaded_ = load(context_, request, job); });
}

std::unique_ptr<LoadedScene> SceneLoader::take()
{
    if (!work_.busy() || !work_.ended())
        return nullptr;
    const bool unwanted = work_.stopped(); // whatever became of it, it is not wanted any more
    work_.finish();
    std::unique_ptr<LoadedScene> loaded = std::move(loaded_);
    if (!unwanted)
        return loaded;
    begin(*std::exchange(next_, std::nullopt));
    return nullptr;
}

} // namespace candelabra::app
