// SPDX-License-Identifier: Apache-2.0
// candelabra report: makes the main measurements in a short form, and one page of the results that
// needs no other file.
#include <algorithm>
#include <chrono>
#include <memory>

#include <fmt/format.h>
#include <spdlog/spdlog.h>
#include <sys/resource.h>

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
#include "measure/report/committed.h"
#include "measure/report/report_page.h"
#include "measure/report/sentences.h"
#include "measure/report/weak_sides.h"
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
    std::string directory = "out/report", parts = "profile,accuracy,culling,stability";
    std::string lights = "4000", size = "640x360", frames = "20";
    std::string committed; // empty: committedDirectory, if it is there
};

constexpr const char* committedDirectory = "tools/bench/results"; // of the source tree

struct ReportPlan {
    uint32_t lights, frames;
    PixelSize size;

    std::string sizeText() const { return fmt::format("{}x{}", size.width, size.height); }
};

struct PartTime {
    std::string part;
    double wallSeconds = 0, processorSeconds = 0;
};

// The results of the parts, for sentences and comparisons, and their additions to the page.
struct Measured {
    std::string pictures; // of the section that comes first
    std::vector<ReportSection> sections;
    Json document;
    WeakSideFacts facts; // all results but those of stability
    Stability stability;
    std::vector<PartTime> times;
};

// One part while it is measured.
struct Part {
    const VulkanContext& context;
    const ReportPlan& plan;
    bool quiet;
    Measured& out;
};

constexpr const char* reportScene = "hall";
constexpr uint32_t reportRounds = uint32_t(minPairs); // the fewest that give an interval
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
    std::vector<WipeChoice> choices;
    for (const HeatMap map : {HeatMap::None, HeatMap::LightsPerPixel, HeatMap::Efficiency,
                              HeatMap::PixelClass, HeatMap::Evaluated}) {
        FrameOptions options = frame;
        options.heatMap = map;
        context.submitAndWait([&](VkCommandBuffer cmd) { renderer.record(cmd, 0, options); });
        const std::string name = map == HeatMap::None ? "picture" : heatMapName(map);
        const std::string id = "frame-" + name;
        choices.push_back({id, name, figure(displayed(context, renderer), name, id)});
    }
    return wipe(choices, 0, 1);
}

// A bar for every pass, as long as its share of the longest.
std::string passBars(const FrameSeries& series)
{
    double most = 0;
    for (const FrameSeries::Pass& pass : series.passes)
        most = std::max(most, medianOf(pass.ms));
    std::string out = "<div class=\"bars\">\n";
    for (const FrameSeries::Pass& pass : series.passes) {
        const double ms = medianOf(pass.ms);
        out += fmt::format("<div><span>{} {} ms</span><div class=\"bar\" style=\"width: {:.1f}%\">"
                           "</div></div>\n",
                           escaped(pass.name), threeDigits(ms), most > 0 ? 100 * ms / most : 0);
    }
    return out + "</div>\n";
}

void profilePart(const Part& part)
{
    const ReportPlan& plan = part.plan;
    const Scene scene = loadScene(reportScene, {.lights = plan.lights});
    FrameOptions frame{.camera = selectCamera(scene, ""),
                       .lightsVisible = scene.lightsVisible,
                       .exposure = defaultExposureSettings()};
    Renderer renderer(part.context, scene,
                      {.size = plan.size, .specularMethods = 1u << frame.specular, .stamps = true});
    Profile profile;
    {
        Progress progress(plan.frames + maxWarmUp, !part.quiet);
        progress.doing("profiling");
        profile =
            profileFrames(part.context, renderer, {.variants = {frame}, .rounds = plan.frames},
                          [&] { progress.advance(1); });
    }
    const FrameSeries& series = profile.series[0];
    const LightCosts costs = lightCosts(part.context, renderer, scene, frame);
    Table times = seriesTable(series);
    times.setTitle("The passes of a frame");
    times.note(overheadText(series, profile.stampMs));
    Table lights = lightCostTable(costs, scene, costlyLights, series.shadingMs());
    lights.setTitle("The costliest lights");
    part.out.sections.push_back(
        {.id = "profile",
         .title = "Where the time of a frame goes",
         .intro = fmt::format(
             "The generated scene \"{}\" with {} lights was drawn {} times at {}. The slider "
             "compares its picture with maps of the work per pixel: how many lights the pixel's "
             "list has, which share of them adds light, how the pixel finds its list, and how many "
             "lights are evaluated. The bars are the median times of the passes: gbuffer_raster "
             "draws the surfaces, cluster_lists finds the lights of groups of pixels (clusters), "
             "and shade_tiles evaluates them.",
             reportScene, grouped(plan.lights), plan.frames, plan.sizeText()),
         .html = pictures(part.context, renderer, frame) + passBars(series),
         .tables = {times},
         .command =
             fmt::format("candelabra profile {} --lights {} --size {} --frames {} "
                         "--light-costs {}",
                         reportScene, plan.lights, plan.sizeText(), plan.frames, costlyLights),
         .details = {lights}});
    part.out.document["profile"] = {
        {"scene", sceneJson(scene, renderer)},
        {"settled", profile.settled},
        {"time", toJson(series)},
        {"overhead", overheadJson(series, profile.stampMs)},
        {"lightCosts", lightCostJson(costs, scene, costlyLights, series.shadingMs())}};
}

void accuracyPart(const Part& part)
{
    // Polygons and distant spheres are left out: they have the code of rectangles and of spheres.
    KernelLevelSettings kernels{
        .lightTypes = {CND_LIGHT_SPHERE, CND_LIGHT_TUBE, CND_LIGHT_RECTANGLE, CND_LIGHT_DISC},
        .groups = 60};
    kernels.timing.lanes = 1u << 13;
    kernels.timing.rounds = reportRounds;
    const ImageLevelSettings images{.scenes = {"glossy floor cut by a light",
                                               "large light at grazing angles",
                                               "a row of metal under five spheres", "showcase"},
                                    .size = {144, 108},
                                    .rounds = 3};
    Measured& out = part.out;
    {
        Progress progress(kernelLevelSteps(kernels), !part.quiet);
        out.facts.kernels = measureKernelLevel(part.context, kernels, progress);
    }
    Progress progress(imageLevelSteps(images), !part.quiet);
    out.facts.scenes = measureImages(part.context, images, progress);
    out.pictures = accuracyPictures(out.facts.scenes);
    out.sections.push_back(
        {.id = "accuracy",
         .title = "Accuracy: how far the light is from the truth, and at what time",
         .intro = "Single lights at single pixels come first: surfaces of every roughness and "
                  "lights of every size, evaluated by each method and by quadrature in double "
                  "precision. Whole images of small scenes follow. An error of 1 percent means "
                  "that the light is wrong by 1 percent of the brightest reflection that such a "
                  "light has on such a surface.",
         .html = accuracyPlots(out.facts.kernels, out.facts.scenes, part.context.info()),
         .tables = accuracyTables(out.facts.kernels, out.facts.scenes),
         .command = "candelabra report --parts accuracy",
         .details = accuracyDetails(out.facts.kernels, out.facts.scenes)});
    out.document["accuracy"] = {{"kernels", kernelJson(kernels, out.facts.kernels)},
                                {"images", imageJson(images, out.facts.scenes)}};
}

void cullingPart(const Part& part)
{
    const CullingSettings settings{.scenes = {"hall", "fence"},
                                   .sizes = {{480, 270}},
                                   .lights = {1000, 4000, 16000},
                                   .overlaps = {8},
                                   .rounds = reportRounds,
                                   .brutePatience = 2500,
                                   .bruteLimit = 6};
    Measured& out = part.out;
    {
        Progress progress(cullingSteps(settings), !part.quiet);
        out.facts.culling = measureCulling(part.context, settings, progress);
    }
    ReportSection section{
        .id = "culling",
        .title = "Culling: time against the number of lights",
        .intro =
            "The same frame is lit in five ways, in turn: by Candelabra, with lists per tile "
            "of 16x16 pixels, with lists per froxel, by brute force, and with free culling "
            "(floor). A way of culling whose curve stays flat copes with many lights. The floor "
            "is the time of evaluating the lights alone, which no culling can save.",
        .html = {},
        .tables = cullingTables(out.facts.culling),
        .command = "candelabra report --parts culling"};
    for (const CullingPlot& plot : cullingPlots(out.facts.culling, part.context.info()))
        section.html += plotBox(plot.svg, "time of lighting against the number of lights");
    for (const std::string& failure : cullingFailures(out.facts.culling))
        section.html += "<p>" + escaped(failure) + "</p>\n";
    out.sections.push_back(std::move(section));
    out.document["culling"] = cullingJson(settings, out.facts.culling);
}

void stabilityPart(const Part& part)
{
    // The kernels of polygons and distant spheres, whose code is that of rectangles and spheres,
    // are not compiled: that takes longer than the measurement.
    const StabilitySettings settings{
        .configurations = 1'000'000,
        .quadratureSamples = 2'500,
        .sweeps = 10,
        .lightTypes = {CND_LIGHT_POINT, CND_LIGHT_SPHERE, CND_LIGHT_SPOT, CND_LIGHT_DIRECTIONAL,
                       CND_LIGHT_TUBE, CND_LIGHT_RECTANGLE, CND_LIGHT_DISC}};
    Measured& out = part.out;
    {
        Progress progress(stabilitySteps(settings), !part.quiet);
        out.stability = measureStability(part.context, settings, progress);
    }
    out.sections.push_back(
        {.id = "stability",
         .title = "Stability: inputs that are hard for formulas",
         .intro = "The engine's light formulas were fed with random inputs and with inputs that "
                  "are hard for floating-point numbers: contact, grazing views, extreme sizes. "
                  "Counted are responses that cannot be; then the formulas are compared with "
                  "quadrature, and jumps are looked for while an input changes continuously. "
                  "Polygons and distant spheres are left out here: they have the code of "
                  "rectangles and of spheres.",
         .html = {},
         .tables = stabilityTables(out.stability),
         .command = "candelabra bench stability --configs 1000000 --quadrature 2500 --sweeps 10 "
                    "--light-types point,sphere,spot,directional,tube,rectangle,disc",
         .details = stabilityDetails(out.stability)});
    out.document["stability"] = stabilityJson(settings, out.stability);
}

struct PartChoice {
    const char* name;
    const char* what; // for the progress
    void (*measure)(const Part&);
};
constexpr PartChoice partChoices[] = {{"profile", "the passes of a frame", profilePart},
                                      {"accuracy", "errors against the truth", accuracyPart},
                                      {"culling", "time against the number of lights", cullingPart},
                                      {"stability", "hard inputs", stabilityPart}};

double processorSeconds()
{
    rusage use{};
    getrusage(RUSAGE_SELF, &use);
    const auto seconds = [](const timeval& t) {
        return double(t.tv_sec) + 1e-6 * double(t.tv_usec);
    };
    return seconds(use.ru_utime) + seconds(use.ru_stime);
}

// Measures one part, the `index`th of `count`, and says on stderr how far the report is. Returns
// whether the validation layer found a fault.
bool measurePart(const DeviceArguments& device, const PartChoice& choice, size_t index,
                 size_t count, const ReportPlan& plan, bool quiet, Measured& out)
{
    spdlog::info("part {} of {}, {}: {}", index + 1, count, choice.name, choice.what);
    const auto start = std::chrono::steady_clock::now();
    const double processor = processorSeconds();
    // Each part has a device of its own, as each command has. On a device that has rasterised,
    // llvmpipe takes timestamps late and all at once unless something else makes it finish: a
    // single kernel took 0 ms.
    const VulkanContext context(device.contextOptions());
    choice.measure({context, plan, quiet, out});
    const std::chrono::duration<double> wall = std::chrono::steady_clock::now() - start;
    out.times.push_back({choice.name, wall.count(), processorSeconds() - processor});
    spdlog::info("part {} of {}, {}: done after {:.0f} s", index + 1, count, choice.name,
                 wall.count());
    return printValidationMessages(context) > 0;
}

Table timeTable(const std::vector<PartTime>& times)
{
    Table out({{"part", "", "The part of the report."},
               {"time", "s", "The time by the clock, which grows if other programs run."},
               {"processor time", "s",
                "The time of all processor cores together that the program used."}},
              "How long the parts took");
    for (const PartTime& t : times)
        out.add({t.part, fmt::format("{:.0f}", t.wallSeconds),
                 fmt::format("{:.0f}", t.processorSeconds)});
    return out;
}

// Compares with the committed results, if there are any, and marks what contradicts them.
void addComparison(const std::string& directory, const DeviceInfo& device, const Measured& measured,
                   ReportPage& page)
{
    const std::optional<CommittedResults> committed = readCommitted(directory, device);
    if (!committed || committed->figures.empty()) {
        page.notes.push_back(fmt::format(
            "The results of this run are not compared with earlier ones: the folder {} {}.",
            directory,
            committed ? "has none of this device and driver"
                      : "is not there. Results of the project's own machine are in that folder of "
                        "its source code, and --committed names another folder"));
        return;
    }
    std::vector<ReportedFigure> figures = figuresOf(measured.facts.culling);
    const std::vector<ReportedFigure> kernels = figuresOf(measured.facts.kernels);
    figures.insert(figures.end(), kernels.begin(), kernels.end());
    Comparison comparison = compareWithCommitted(figures, *committed);
    page.notes.push_back(fmt::format(
        "{} of this run can be compared with the committed results of this device and driver ({}); "
        "of these, {} contradict them.",
        counted(comparison.compared, "figure"), directory,
        comparison.contradictions.empty() ? "none" : grouped(comparison.contradictions.size())));
    if (!comparison.omission.empty())
        page.notes.push_back(comparison.omission);
    page.markContradictions(comparison.contradictions);
    if (!comparison.compared)
        return;
    page.sections.push_back(
        {.id = "committed",
         .title = "Compared with the committed results",
         .intro = "The project keeps the results of longer runs with its sources. Ratios and "
                  "errors of this run are compared with theirs; times in milliseconds are not, "
                  "because they depend on the machine and on what else it does.",
         .html = {},
         .tables = {comparison.table},
         .command = {}});
}

ReportPage pageOf(const Measured& measured, const DeviceInfo& device, const Json& from,
                  const std::string& committed, const std::string& commandLine)
{
    RunFacts facts{.device = device,
                   .version = from.at("candelabra"),
                   .commit = from.at("commit"),
                   .parts = measured.times.size()};
    for (const PartTime& t : measured.times) {
        facts.wallSeconds += t.wallSeconds;
        facts.processorSeconds += t.processorSeconds;
    }
    ReportPage page{
        .title = "Candelabra: how fast and how accurate",
        .about = "Candelabra is a library that lights scenes with many lights that have a size: "
                 "balls, tubes, rectangles, discs. It finds the few lights that matter to each "
                 "pixel (culling) and computes their light with a formula (conic) in place of "
                 "random samples. This page tells what a short measurement of it found.",
        .sentences = {runSentence(facts), speedSentence(measured.facts.culling),
                      accuracySentence(measured.facts.kernels, measured.facts.scenes),
                      weaknessSentence(measured.facts), stabilitySentence(measured.stability)},
        .notes = {},
        .sections = {}};
    if (!measured.pictures.empty())
        page.sections.push_back(
            {.id = "pictures",
             .title = "Pictures: the truth, Candelabra and what is common",
             .intro = "Drag the slider, or move it with the arrow keys. Left of it is the truth at "
                      "first, right of it the same picture by the approximation that is common in "
                      "games (karis). Choose conic on the right to see Candelabra, which is meant "
                      "to look like the truth. Both sides can also show the other methods, and "
                      "maps of their differences to the truth. The pictures are small, because "
                      "each pixel of the truth takes long.",
             .html = measured.pictures,
             .tables = {},
             .command = {}});
    page.sections.insert(page.sections.end(), measured.sections.begin(), measured.sections.end());
    addComparison(committed, device, measured, page);
    page.sections.push_back({.id = "provenance",
                             .title = "What was measured on what",
                             .intro = {},
                             .html = {},
                             .tables = {provenanceTable(from), timeTable(measured.times)},
                             .command = commandLine});
    return page;
}

std::vector<PartChoice> chosenParts(const std::string& parts)
{
    std::vector<PartChoice> out;
    for (const std::string& name : splitAtCommas(parts)) {
        const auto* found = std::find_if(std::begin(partChoices), std::end(partChoices),
                                         [&](const PartChoice& c) { return name == c.name; });
        if (found == std::end(partChoices))
            throw UsageError(
                fmt::format("--parts \"{}\": choose from {}", parts, ReportArguments().parts));
        if (std::any_of(out.begin(), out.end(),
                        [&](const PartChoice& c) { return name == c.name; }))
            throw UsageError(fmt::format("--parts \"{}\": {} is there twice", parts, name));
        out.push_back(*found);
    }
    return out;
}

int report(const ProgramContext& program, const ReportArguments& a)
{
    const ReportPlan plan{.lights = unsignedOption("--lights", a.lights, 1, maxLights),
                          .frames = unsignedOption("--frames", a.frames, 1, 100'000),
                          .size = sizeOption("--size", a.size)};
    const std::vector<PartChoice> wanted = chosenParts(a.parts);
    if (!a.committed.empty() && !std::filesystem::is_directory(a.committed))
        throw UsageError(fmt::format("--committed \"{}\": there is no such folder", a.committed));
    const std::string html = benchOutput(a.directory, "--out", "", "index.html"),
                      json = benchOutput(a.directory, "--out", "", "report.json");
    const auto device = std::make_unique<VulkanContext>(a.device.contextOptions())->info();
    spdlog::info("report on {}", device.name);
    const Json from = provenance(device, program.commandLine);
    bool faults = false;
    Measured measured;
    measured.document = {{"schema", "candelabra report 1"}, {"provenance", from}};
    for (size_t i = 0; i < wanted.size(); ++i)
        faults |= measurePart(a.device, wanted[i], i, wanted.size(), plan, program.quiet, measured);
    writeText(html, htmlOf(pageOf(measured, device, from,
                                  a.committed.empty() ? committedDirectory : a.committed,
                                  program.commandLine)));
    writeJson(json, measured.document);
    writeText("-", fmt::format("See {}; its figures are in {}\n", html, json));
    return faults ? exitFailed : exitOk;
}

} // namespace

void addReportCommand(CLI::App& app, Run& run)
{
    CLI::App* command = app.add_subcommand(
        "report",
        "Run short forms of the main measurements, and write one HTML page of the results");
    const auto a = std::make_shared<ReportArguments>();
    addOption(*command, "--out", a->directory, "DIR", "directory for index.html and report.json");
    addOption(*command, "--parts", a->parts, "NAME,...", "parts to measure, in this order");
    addOption(*command, "--lights", a->lights, "N", "number of lights in the profiled frame");
    addOption(*command, "--size", a->size, "WxH", "image size of that frame");
    addOption(*command, "--frames", a->frames, "N", "number of times to draw that frame");
    addOption(*command, "--committed", a->committed, "DIR",
              "folder with CSV files from tools/update_results, of the same device, to compare "
              "with; default: tools/bench/results, if it exists");
    a->device.addTo(*command);
    command->footer(
        "The page begins with five sentences that give the result. Under every part is the\n"
        "command that repeats it.\n\n"
        "Examples:\n"
        "  candelabra report\n"
        "  candelabra report --parts profile,culling --lights 16000 --out out/culling");
    command->callback(
        [&run, a] { run = [a](const ProgramContext& program) { return report(program, *a); }; });
}

} // namespace candelabra::app
