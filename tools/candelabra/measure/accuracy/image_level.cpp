// SPDX-License-Identifier: Apache-2.0
#include "measure/accuracy/image_level.h"

#include <algorithm>
#include <functional>
#include <memory>
#include <numeric>

#include <fmt/format.h>

#include "candelabra/candelabra.hpp"
#include "io/statistics.h"
#include "io/svg_plot.h"
#include "measure/accuracy/ltc_frame.h"
#include "reference/render.h"
#include "render/camera.h"
#include "render/readback.h"
#include "render/setting_names.h"
#include "truth/reference_scene.h"

namespace candelabra::app
{

namespace
{

struct Variants {
    std::vector<FrameTime> times;
    std::vector<Image> images; // of the last timed frame
};

// The times of one frame.
struct DrawTimes {
    double lightingMs = 0, shadingMs = 0, bruteForceMs = 0;
};

// Draws a frame with the renderer of runVariants.
using Draw = std::function<DrawTimes()>;

DrawTimes drawOnce(const VulkanContext& context, Renderer& renderer, const FrameOptions& options)
{
    context.submitAndWait([&](VkCommandBuffer cmd) { renderer.record(cmd, 0, options); });
    const CndLightingStats stats = renderer.lightingStats(0);
    DrawTimes out;
    for (const PassTime& pass : passesOf({stats.kernelTimes, stats.kernelTimeCount})) {
        out.lightingMs += pass.ms;
        out.shadingMs += pass.name.starts_with("shade_") ? pass.ms : 0;
    }
    return out;
}

Draw drawByEngine(const VulkanContext& context, Renderer& renderer, const FrameOptions& options)
{
    return [&context, &renderer, options] {
        FrameOptions brute = options;
        brute.culling = CND_CULLING_BRUTE;
        const DrawTimes withoutLists = drawOnce(context, renderer, brute);
        DrawTimes out = drawOnce(context, renderer, options);
        out.bruteForceMs = withoutLists.shadingMs;
        return out;
    };
}

Draw drawByRival(const VulkanContext& context, Renderer& renderer, const Scene& scene,
                 const FrameOptions& options)
{
    const auto frame = std::make_shared<LtcFrame>(context, renderer, scene, options);
    return [frame] { return DrawTimes{.bruteForceMs = frame->draw()}; };
}

// Draws frames of all variants in turn.
Variants runVariants(const VulkanContext& context, Renderer& renderer,
                     const std::vector<Draw>& variants, uint32_t rounds,
                     const std::function<void()>& onRound)
{
    Variants out;
    const size_t n = variants.size();
    std::vector<std::vector<double>> lighting(n), shading(n), bruteForce(n);
    out.images.resize(n);
    for (uint32_t round = 0; round <= rounds; ++round) {
        for (size_t i = 0; i < n; ++i) {
            const DrawTimes times = variants[i]();
            if (round == 0) // the warm-up frame, in which pipelines are compiled
                continue;
            lighting[i].push_back(times.lightingMs);
            shading[i].push_back(times.shadingMs);
            bruteForce[i].push_back(times.bruteForceMs);
            if (round == rounds)
                out.images[i] = readRadiance(context, renderer);
        }
        onRound();
    }
    for (size_t i = 0; i < n; ++i) {
        std::vector<double> ratios;
        for (uint32_t round = 0; round < rounds; ++round)
            ratios.push_back(lighting[0][round] > 0 ? lighting[i][round] / lighting[0][round] : 0);
        out.times.push_back({medianOf(lighting[i]), medianOf(shading[i]), medianOf(ratios),
                             medianOf(bruteForce[i]), isNoisy(bruteForce[i])});
    }
    return out;
}

void integrate(const Scene& scene, const ImageLevelSettings& s, Progress& progress, ImageScene& out)
{
    const reference::Scene model =
        toReference(scene, selectCamera(scene, ""), double(s.size.width) / s.size.height, false);
    std::vector<uint32_t> rows(s.size.height);
    std::iota(rows.begin(), rows.end(), 0u);
    const reference::TruthRows truth = reference::renderTruth(
        model, s.size.width, s.size.height, rows,
        {.relative = s.truthTolerance, .onRow = [&] { progress.advance(1); }});
    out.unconverged = truth.unconverged;
    out.truth = {s.size.width, s.size.height, 3, {}};
    for (const glm::dvec3& pixel : truth.pixels)
        for (int i = 0; i < 3; ++i)
            out.truth.pixels.push_back(float(pixel[i]));
}

// In the progress bar a round of frames counts as many steps as so many rows of truth.
constexpr double stepsPerRound = 30;

} // namespace

std::vector<MeasuredMethod> imageMethods()
{
    std::vector<MeasuredMethod> out{CND_SPECULAR_KARIS};
    for (const CndSpecularMethod method : methodsOf(CND_LIGHT_SPHERE))
        if (method != CND_SPECULAR_KARIS)
            out.push_back(method);
    out.push_back(Rival::Ltc);
    return out;
}

namespace
{

// Returns those of the methods that know all area lights of the scene.
std::vector<MeasuredMethod> methodsFor(const Scene& scene,
                                       const std::vector<MeasuredMethod>& methods)
{
    const bool rival = std::ranges::all_of(scene.lights, [](const CndLight& light) {
        return cndIsPunctual(light.type) || rivalKnows(light.type);
    });
    std::vector<MeasuredMethod> out;
    for (const MeasuredMethod& method : methods)
        if (rival || method.rival == Rival::None)
            out.push_back(method);
    return out;
}

std::vector<Scene> scenesOf(const ImageLevelSettings& s)
{
    std::vector<Scene> out = benchScenes();
    if (!s.scenes.empty())
        std::erase_if(out, [&](const Scene& scene) {
            return std::ranges::find(s.scenes, scene.name) == s.scenes.end();
        });
    return out;
}

} // namespace

double imageLevelSteps(const ImageLevelSettings& s)
{
    return double(scenesOf(s).size()) * (s.size.height + stepsPerRound * (s.rounds + 1));
}

std::vector<ImageScene> measureImages(const VulkanContext& context, const ImageLevelSettings& s,
                                      Progress& progress)
{
    std::vector<ImageScene> out;
    for (const Scene& scene : scenesOf(s)) {
        ImageScene measured{.name = scene.name, .about = {}, .truth = {}, .points = {}};
        progress.doing("truth: " + scene.name);
        integrate(scene, s, progress, measured);
        progress.doing("frames: " + scene.name);
        const std::vector<MeasuredMethod> methods = methodsFor(scene, s.methods);
        uint32_t mask = 0;
        for (const MeasuredMethod& method : methods)
            mask |= 1u << method.specular;
        Renderer renderer(context, scene, {.size = s.size, .specularMethods = mask});
        std::vector<Draw> variants;
        for (const MeasuredMethod& method : methods) {
            const FrameOptions frame{.camera = selectCamera(scene, ""),
                                     .lightsVisible = false,
                                     .specular = method.specular,
                                     .sampleCount = s.sampleCount,
                                     .exposure = defaultExposureSettings()};
            variants.push_back(method.rival == Rival::None
                                   ? drawByEngine(context, renderer, frame)
                                   : drawByRival(context, renderer, scene, frame));
        }
        Variants run = runVariants(context, renderer, variants, s.rounds,
                                   [&] { progress.advance(stepsPerRound); });
        for (size_t i = 0; i < variants.size(); ++i) {
            ImagePoint point{.method = methods[i],
                             .time = run.times[i],
                             .error = imageDifference(run.images[i], measured.truth),
                             .radiance = std::move(run.images[i])};
            const Displayed displayed = displayBoth(measured.truth, point.radiance);
            point.error.flip = meanOf(flipMap(displayed.truth, displayed.value));
            measured.points.push_back(std::move(point));
        }
        out.push_back(std::move(measured));
    }
    return out;
}

namespace
{

Json toJson(const FrameTime& t)
{
    return {{"lightingMs", t.lightingMs}, {"shadingMs", t.shadingMs}, {"ratioToKaris", t.ratio}};
}

Json timeJson(const ImagePoint& p)
{
    Json out = p.method.rival == Rival::None ? toJson(p.time) : Json::object();
    out["bruteForceMs"] = p.time.bruteForceMs;
    return out;
}

} // namespace

std::vector<Table> imageTables(const std::vector<ImageScene>& scenes)
{
    std::vector<Table> out;
    for (const ImageScene& scene : scenes) {
        Table table({"method",
                     {"lighting", "ms"},
                     {"/ karis", "paired"},
                     {"brute force", "ms"},
                     "relMSE",
                     "lit relMSE",
                     "lit mean",
                     "max / peak",
                     "energy",
                     "FLIP"},
                    scene.name + ", error to truth");
        for (const ImagePoint& p : scene.points)
            table.add({methodName(p.method),
                       p.method.rival == Rival::None ? threeDigits(p.time.lightingMs) : "-",
                       p.method.rival == Rival::None ? fmt::format("{:.2f}", p.time.ratio) : "-",
                       threeDigits(p.time.bruteForceMs), threeDigits(p.error.relMse),
                       threeDigits(p.error.litRelMse), threeDigits(p.error.litMeanRel),
                       threeDigits(p.error.maxOverPeak),
                       (p.error.energy > 0 ? "+" : "") + threeDigits(p.error.energy),
                       fmt::format("{:.4f}", p.error.flip)},
                      {.noisy = p.time.noisy});
        out.push_back(std::move(table));
    }
    return out;
}

Json imageJson(const ImageLevelSettings& s, const std::vector<ImageScene>& scenes)
{
    Json list = Json::array();
    for (const ImageScene& scene : scenes) {
        Json points = Json::array();
        for (const ImagePoint& p : scene.points)
            points.push_back({{"method", methodName(p.method)},
                              {"time", timeJson(p)},
                              {"error", toJson(p.error)}});
        list.push_back(
            {{"name", scene.name}, {"unconvergedTruths", scene.unconverged}, {"points", points}});
    }
    return {{"widthPixels", s.size.width},
            {"heightPixels", s.size.height},
            {"rounds", s.rounds},
            {"truthTolerance", s.truthTolerance},
            {"scenes", list}};
}

std::string imagePlot(const std::vector<ImageScene>& scenes, const DeviceInfo& device)
{
    std::vector<PlotSeries> series;
    for (const ImageScene& scene : scenes)
        for (size_t i = 0; i < scene.points.size(); ++i) {
            if (series.size() <= i)
                series.push_back({.name = methodName(scene.points[i].method),
                                  .points = {},
                                  .emphasised = scene.points[i].method == CND_SPECULAR_CONIC,
                                  .connected = false});
            series[i].points.emplace_back(scene.points[i].time.bruteForceMs,
                                          scene.points[i].error.relMse);
        }
    return logLogPlot({.title = "Image error against time, one point per scene",
                       .subtitle = device.name,
                       .xAxis = "GPU time of every light at every pixel (ms)",
                       .yAxis = "relMSE to truth"},
                      series);
}

} // namespace candelabra::app
