// SPDX-License-Identifier: Apache-2.0
// candelabra report: makes every measurement in a short form, and one page of the results that
// needs no other file.
#include <algorithm>
#include <filesystem>
#include <memory>

#include <fmt/format.h>
#include <spdlog/spdlog.h>

#include "candelabra/candelabra.hpp"
#include "commands/bench_commands.h"
#include "commands/messages.h"
#include "io/error.h"
#include "io/html_page.h"
#include "io/markup.h"
#include "io/statistics.h"
#include "io/table.h"
#include "load/load.h"
#include "measure/accuracy/accuracy_page.h"
#include "measure/culling/culling.h"
#include "measure/frame/frames.h"
#include "measure/frame/light_costs.h"
#include "measure/profile/profile_frames.h"
#include "measure/skip.h"
#include "measure/stability/stability.h"
#include "render/camera.h"
#include "render/provenance.h"
#include "render/readback.h"
#include "render/setting_names.h"
#include "scene/scene_options.h"

namespace candelabra::app
{
namespace
{

struct ReportArguments {
    DeviceArguments device;
    std::string directory = "out/report", parts = "profile,accuracy,culling,skip,stability";
    std::string lights = "4000", size = "1280x720", frames = "20";
};

// What one part of the report adds to the page, and its figures as JSON.
struct ReportPart {
    std::string html;
    Json json;
};

struct ReportPlan {
    uint32_t lights, frames;
    PixelSize size;

    std::string sizeText() const { return fmt::format("{}x{}", size.width, size.height); }
};

constexpr const char* reportScene = "hall";
constexpr size_t costlyLights = 20;

// Converts the display image to a picture of the page.
DisplayImage displayed(const VulkanContext& context, const Renderer& renderer)
{
    const std::vector<uint8_t> rgb = readDisplay(context, renderer);
    DisplayImage out{renderer.size().width, renderer.size().height, {}};
    for (size_t i = 0; i + 2 < rgb.size(); i += 3)
        out.pixels.emplace_back(rgb[i] / 255.0f, rgb[i + 1] / 255.0f, rgb[i + 2] / 255.0f);
    return out;
}

// The picture of the frame and its heat maps, with a slider between two of them.
std::string pictures(const VulkanContext& context, Renderer& renderer, const FrameOptions& frame)
{
    std::string figures;
    std::vector<WipeChoice> choices;
    for (const HeatMap map : {HeatMap::None, HeatMap::LightsPerPixel, HeatMap::Efficiency,
                              HeatMap::Class, HeatMap::Evaluated}) {
        FrameOptions options = frame;
        options.heatMap = map;
        context.submitAndWait([&](VkCommandBuffer cmd) { renderer.record(cmd, 0, options); });
        const std::string name = map == HeatMap::None ? "picture" : heatMapName(map);
        choices.push_back({"frame-" + name, name});
        figures += figure(displayed(context, renderer), name, choices.back().id);
    }
    return wipe(choices) + figures;
}

std::string passBars(const FrameSeries& series)
{
    double most = 0;
    for (const FrameSeries::Pass& pass : series.passes)
        most = std::max(most, medianOf(pass.ms));
    std::string out = "<table><tr><th>GPU pass</th><th>median ms</th><th></th></tr>\n";
    for (const FrameSeries::Pass& pass : series.passes) {
        const double ms = medianOf(pass.ms);
        out += fmt::format("<tr><td>{}</td><td>{}</td><td class=\"bars\"><div class=\"bar\" "
                           "style=\"width: {:.1f}%\"></div></td></tr>\n",
                           escaped(pass.name), threeDigits(ms), most > 0 ? 100 * ms / most : 0);
    }
    return out + "</table>\n";
}

ReportPart profilePart(const VulkanContext& context, const ReportPlan& plan, bool quiet)
{
    const Scene scene = loadScene(reportScene, {.lights = plan.lights});
    FrameOptions frame{.camera = selectCamera(scene, ""),
                       .lightsVisible = scene.lightsVisible,
                       .exposure = defaultExposureSettings()};
    Renderer renderer(context, scene,
                      {.size = plan.size, .specularMethods = 1u << frame.specular, .stamps = true});
    Profile profile;
    {
        Progress progress(plan.frames + maxWarmUp, !quiet);
        progress.doing("profiling");
        profile = profileFrames(context, renderer, {.variants = {frame}, .rounds = plan.frames},
                                nullptr, [&] { progress.advance(1); });
    }
    const FrameSeries& series = profile.series[0];
    const LightCosts costs = lightCosts(context, renderer, scene, frame);
    const std::string options =
        fmt::format("{} --lights {} --size {}", reportScene, plan.lights, plan.sizeText());
    return {
        .html = "<h2>Where the time of a frame goes</h2>\n" + pictures(context, renderer, frame) +
                madeBy(fmt::format("candelabra render {} --debug class -o class.png", options)) +
                passBars(series) +
                preformatted(seriesTable(series) + overheadText(series, profile.stampMs)) +
                "<h3>The costliest lights</h3>" +
                preformatted(lightCostTable(costs, scene, costlyLights, series.shadingMs())) +
                madeBy(fmt::format("candelabra profile {} --frames {} --light-costs {}", options,
                                   plan.frames, costlyLights)),
        .json = {{"scene", sceneJson(scene, renderer)},
                 {"settled", profile.settled},
                 {"time", toJson(series)},
                 {"overhead", overheadJson(series, profile.stampMs)},
                 {"lightCosts", lightCostJson(costs, scene, costlyLights, series.shadingMs())}}};
}

ReportPart accuracyPart(const VulkanContext& context, bool quiet)
{
    KernelLevelSettings kernels{.groups = 60};
    kernels.timing.rounds = 5;
    const ImageLevelSettings images{
        .size = {144, 108}, .rounds = 3, .budgetLights = 1000, .budgetSize = {320, 180}};
    Progress kernelProgress(kernelLevelSteps(kernels), !quiet);
    const KernelLevel level = measureKernelLevel(context, kernels, kernelProgress);
    Progress imageProgress(imageLevelSteps(images), !quiet);
    const std::vector<ImageScene> scenes = measureImages(context, images, imageProgress);
    const BudgetSweep budgets = measureBudgets(context, images, budgetScene(images), imageProgress);
    return {.html = accuracySections(level, scenes, budgets, context.info()) +
                    madeBy("candelabra bench accuracy --groups 60 --rounds 5 --size 144x108 "
                           "--frames 3 --lights 1000 --budget-size 320x180"),
            .json = {{"kernels", kernelJson(kernels, level)},
                     {"images", imageJson(images, scenes, budgets)}}};
}

ReportPart cullingPart(const VulkanContext& context, bool quiet)
{
    const CullingSettings settings{.scenes = {"hall", "fence"},
                                   .sizes = {{640, 360}},
                                   .lights = {1000, 4000, 16000},
                                   .overlaps = {8},
                                   .rounds = 3,
                                   .bruteLimit = 3};
    Progress progress(cullingSteps(settings), !quiet);
    const std::vector<CullingPoint> points = measureCulling(context, settings, progress);
    std::string plots;
    for (const CullingPlot& plot : cullingPlots(points, context.info()))
        plots += plot.svg;
    for (const std::string& failure : cullingFailures(points))
        plots += "<p>" + escaped(failure) + "</p>\n";
    return {.html = "<h2>Culling: time against lights</h2>\n" + plots +
                    preformatted(cullingTables(points)) +
                    madeBy("candelabra bench culling --scenes hall,fence --size 640x360 --lights "
                           "1000,4000,16000 --overlaps 8 --rounds 3 --brute-limit 3"),
            .json = cullingJson(settings, points)};
}

ReportPart skipPart(const VulkanContext& context, bool quiet)
{
    const SkipSettings settings{.size = {640, 360}, .lights = 1000, .rounds = 5, .pointRounds = 10};
    Progress progress(skipSteps(settings), !quiet);
    const std::vector<SkipRow> rows = measureSkips(context, settings, progress);
    return {.html = "<h2>What skipping unneeded work saves</h2>\n" + preformatted(skipTable(rows)) +
                    madeBy("candelabra bench skip --size 640x360 --lights 1000 --rounds 5 "
                           "--point-rounds 10"),
            .json = skipJson(settings, rows)};
}

ReportPart stabilityPart(const VulkanContext& context, bool quiet)
{
    const StabilitySettings settings{
        .configurations = 1'000'000, .quadratureSamples = 5'000, .sweeps = 20};
    Progress progress(stabilitySteps(settings), !quiet);
    const Stability result = measureStability(context, settings, progress);
    return {.html = "<h2>Numerical stability</h2>\n" + preformatted(stabilityTables(result)) +
                    madeBy("candelabra bench stability --configs 1000000 --quadrature 5000 "
                           "--sweeps 20"),
            .json = stabilityJson(settings, result)};
}

std::string provenanceTable(const Json& from)
{
    std::string out = "<table>\n";
    for (const auto& [name, value] : from.items())
        out += fmt::format("<tr><td>{}</td><td style=\"text-align: left\">{}</td></tr>\n",
                           escaped(name),
                           escaped(value.is_string() ? value.get<std::string>() : value.dump()));
    return out + "</table>\n";
}

int report(const ProgramContext& program, const ReportArguments& a)
{
    const auto size = parseSize(a.size);
    if (!size || size->width > maxSide || size->height > maxSide)
        throw UsageError("--size \"" + a.size + "\": expected WIDTHxHEIGHT such as 1280x720");
    const ReportPlan plan{.lights = unsignedOption("--lights", a.lights, 1, maxLights),
                          .frames = unsignedOption("--frames", a.frames, 1, 100'000),
                          .size = *size};
    std::vector<std::string> wanted = splitAtCommas(a.parts);
    for (const std::string& part : wanted)
        if (const auto all = splitAtCommas(ReportArguments().parts);
            std::find(all.begin(), all.end(), part) == all.end())
            throw UsageError(
                fmt::format("--parts \"{}\": choose from {}", a.parts, ReportArguments().parts));
    const std::string html = benchOutput(a.directory, "--out", "", "index.html"),
                      json = benchOutput(a.directory, "--out", "", "report.json");
    const auto device = std::make_unique<VulkanContext>(a.device.contextOptions())->info();
    spdlog::info("report on {}", device.name);
    const Json from = provenance(device, program.commandLine);
    bool faults = false;
    std::string page = pageHead("Candelabra: times and errors") + provenanceTable(from);
    Json document{{"schema", "candelabra report 1"}, {"provenance", from}};
    for (const std::string& part : wanted) {
        spdlog::info("{}", part);
        // Each part has a device of its own, as each command has. On a device that has rasterised,
        // llvmpipe takes timestamps late and all at once unless something else makes it finish: a
        // single kernel took 0 ms.
        const VulkanContext context(a.device.contextOptions());
        const ReportPart done = part == "profile"    ? profilePart(context, plan, program.quiet)
                                : part == "accuracy" ? accuracyPart(context, program.quiet)
                                : part == "culling"  ? cullingPart(context, program.quiet)
                                : part == "skip"     ? skipPart(context, program.quiet)
                                                     : stabilityPart(context, program.quiet);
        page += done.html;
        document[part] = done.json;
        faults |= printValidationMessages(context) > 0;
    }
    writeText(html, page + madeBy(program.commandLine) + pageEnd());
    writeJson(json, document);
    writeText("-", fmt::format("See {}; its figures are in {}\n", html, json));
    return faults ? exitFailed : exitOk;
}

} // namespace

void addReportCommand(CLI::App& app, Run& run)
{
    CLI::App* command = app.add_subcommand(
        "report", "Make every measurement in a short form, and one HTML page of the results");
    const auto a = std::make_shared<ReportArguments>();
    const auto add = [&](const char* name, std::string& value, const char* what, const char* type) {
        command->add_option(name, value, what)->type_name(type)->capture_default_str();
    };
    add("--out", a->directory, "directory for index.html and report.json", "DIR");
    add("--parts", a->parts, "parts to measure, in this order", "NAME,...");
    add("--lights", a->lights, "number of lights of the frame that is profiled", "N");
    add("--size", a->size, "image size of that frame", "WxH");
    add("--frames", a->frames, "number of times it is drawn", "N");
    a->device.addTo(*command);
    command->footer("Under every figure is the command with which it can be made again.\n\n"
                    "Examples:\n"
                    "  candelabra report\n"
                    "  candelabra report --parts profile,culling --lights 16000 --out out/culling");
    command->callback(
        [&run, a] { run = [a](const ProgramContext& program) { return report(program, *a); }; });
}

} // namespace candelabra::app
