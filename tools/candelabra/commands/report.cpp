// SPDX-License-Identifier: Apache-2.0
// candelabra report: makes the main measurements in a short form. A script (tools/report) makes one
// page of their results.
#include <spawn.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <chrono>
#include <cmath>
#include <cstring>
#include <filesystem>
#include <memory>
#include <span>

#include <fmt/format.h>
#include <spdlog/spdlog.h>

#include "candelabra/candelabra.hpp"
#include "commands/commands.h"
#include "commands/messages.h"
#include "io/error.h"
#include "io/image.h"
#include "io/report.h"
#include "io/statistics.h"
#include "load/load.h"
#include "measure/accuracy/image_level.h"
#include "measure/accuracy/kernel_level.h"
#include "measure/culling/culling.h"
#include "measure/frame/frames.h"
#include "measure/frame/light_costs.h"
#include "measure/profile/profile_frames.h"
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
    std::string committed;
};

struct ReportPlan {
    uint32_t lights, frames;
    PixelSize size;
    std::filesystem::path directory;

    std::string sizeText() const { return fmt::format("{}x{}", size.width, size.height); }
};

// One part while it is measured.
struct Part {
    const VulkanContext& context;
    const ReportPlan& plan;
    bool quiet;
    Json& document; // the part adds its results, "pictures" and "charts"
};

constexpr const char* reportScene = "hall";
constexpr uint32_t reportRounds = uint32_t(minPairs); // the fewest that give an interval
constexpr size_t costlyLights = 20;

// Saves a picture beside the page. chapter: the name of a part; title: what it shows.
void addPicture(const Part& part, const char* chapter, const std::string& title, PixelSize size,
                std::span<const uint8_t> rgb)
{
    Json& pictures = part.document["pictures"];
    const std::string file = fmt::format("picture{}.png", pictures.size());
    savePng((part.plan.directory / file).string(), size.width, size.height, rgb);
    pictures.push_back({{"chapter", chapter}, {"title", title}, {"file", file}});
}

void addChart(const Part& part, const char* chapter, const std::string& svg)
{
    Json& charts = part.document["charts"];
    const std::string file = fmt::format("chart{}.svg", charts.size());
    writeText((part.plan.directory / file).string(), svg);
    charts.push_back({{"chapter", chapter}, {"file", file}});
}

// The picture of the frame and its heat maps.
void addFramePictures(const Part& part, Renderer& renderer, const FrameOptions& frame)
{
    const std::pair<HeatMap, const char*> maps[] = {
        {HeatMap::None, "Candelabra"},
        {HeatMap::LightsPerPixel, "how many lights the list of a pixel has"},
        {HeatMap::Efficiency, "which share of them adds light"},
        {HeatMap::PixelClass, "how a pixel finds its list"},
        {HeatMap::Evaluated, "how many lights are evaluated"}};
    for (const auto& [map, title] : maps) {
        FrameOptions options = frame;
        options.heatMap = map;
        part.context.submitAndWait([&](VkCommandBuffer cmd) { renderer.record(cmd, 0, options); });
        addPicture(part, "profile", title, renderer.size(), readDisplay(part.context, renderer));
    }
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
    addFramePictures(part, renderer, frame);
    part.document["profile"] = {
        {"command",
         fmt::format("candelabra profile {} --lights {} --size {} --frames {} "
                     "--light-costs {}",
                     reportScene, plan.lights, plan.sizeText(), plan.frames, costlyLights)},
        {"scene", sceneJson(scene, renderer)},
        {"image", {{"widthPixels", plan.size.width}, {"heightPixels", plan.size.height}}},
        {"settled", profile.settled},
        {"time", toJson(series)},
        {"overhead", overheadJson(series, profile.stampMs)},
        {"lightCosts", lightCostJson(costs, scene, costlyLights, medianOf(series.shadingMs()))}};
}

// Saves pictures of the scenes by Candelabra, of the truth and by the method of games.
void addScenePictures(const Part& part, const std::vector<ImageScene>& scenes)
{
    const auto add = [&](const std::string& title, const DisplayImage& image) {
        std::vector<uint8_t> rgb;
        for (const glm::vec3& p : image.pixels)
            for (int channel = 0; channel < 3; ++channel)
                rgb.push_back(uint8_t(std::lround(std::clamp(p[channel], 0.0f, 1.0f) * 255)));
        addPicture(part, "accuracy", title, {image.width, image.height}, rgb);
    };
    for (const ImageScene& scene : scenes)
        for (const MeasuredMethod& method :
             {MeasuredMethod(CND_SPECULAR_CONIC), MeasuredMethod(CND_SPECULAR_KARIS)})
            for (const ImagePoint& p : scene.points) {
                if (p.method != method)
                    continue;
                const Displayed displayed = displayBoth(scene.truth, p.radiance);
                const bool own = method == MeasuredMethod(CND_SPECULAR_CONIC);
                add(fmt::format("{}: {}", scene.name, own ? "Candelabra" : methodName(method)),
                    displayed.value);
                if (own)
                    add(scene.name + ": truth", displayed.truth);
            }
}

void accuracyPart(const Part& part)
{
    // Polygons and distant spheres are left out: they have the code of rectangles and of spheres.
    KernelLevelSettings kernels{
        .lightTypes = {CND_LIGHT_SPHERE, CND_LIGHT_TUBE, CND_LIGHT_RECTANGLE, CND_LIGHT_DISC},
        .groups = 60};
    kernels.timing.lanes = 1u << 13;
    kernels.timing.rounds = reportRounds;
    const ImageLevelSettings images{
        .methods = {CND_SPECULAR_KARIS, CND_SPECULAR_CONIC, CND_SPECULAR_CONIC_FULL,
                    CND_SPECULAR_SAMPLED, Rival::Ltc},
        .scenes = {"glossy floor cut by a light", "large light at grazing angles",
                   "a row of metal under five spheres", "showcase"},
        .size = {144, 108},
        .rounds = 3};
    KernelLevel level;
    {
        Progress progress(kernelLevelSteps(kernels), !part.quiet);
        level = measureKernelLevel(part.context, kernels, progress);
    }
    Progress progress(imageLevelSteps(images), !part.quiet);
    const std::vector<ImageScene> scenes = measureImages(part.context, images, progress);
    addScenePictures(part, scenes);
    addChart(part, "accuracy", imagePlot(scenes, part.context.info()));
    part.document["accuracy"] = {{"command", "candelabra report --parts accuracy"},
                                 {"kernels", kernelJson(kernels, level)},
                                 {"images", imageJson(images, scenes)}};
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
    const std::vector<CullingPoint> points = measureCulling(part.context, settings, !part.quiet);
    for (const CullingPlot& plot : cullingPlots(points, part.context.info()))
        addChart(part, "culling", plot.svg);
    part.document["culling"] = cullingJson(settings, points);
    part.document["culling"]["command"] = "candelabra report --parts culling";
    part.document["culling"]["failures"] = cullingFailures(points);
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
    part.document["stability"] =
        stabilityJson(settings, measureStability(part.context, settings, !part.quiet));
    part.document["stability"]["command"] =
        "candelabra bench stability --configs 1000000 --quadrature 2500 --sweeps 10 --light-types "
        "point,sphere,spot,directional,tube,rectangle,disc";
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

// Measures one part, the `index`th of `count`, and says on stderr how far the report is. Returns
// whether the validation layer found a fault.
bool measurePart(const DeviceArguments& device, const PartChoice& choice, size_t index,
                 size_t count, const ReportPlan& plan, bool quiet, Json& document)
{
    spdlog::info("part {} of {}, {}: {}", index + 1, count, choice.name, choice.what);
    const auto start = std::chrono::steady_clock::now();
    // Each part has a device of its own, as each command has. On a device that has rasterised,
    // llvmpipe takes timestamps late and all at once unless something else makes it finish: a
    // single kernel took 0 ms.
    const VulkanContext context(device.contextOptions());
    choice.measure({context, plan, quiet, document});
    const std::chrono::duration<double> wall = std::chrono::steady_clock::now() - start;
    document[choice.name]["seconds"] = wall.count();
    spdlog::info("part {} of {}, {}: done after {:.0f} s", index + 1, count, choice.name,
                 wall.count());
    return printValidationMessages(context) > 0;
}

// Returns the script that makes the page: it is installed beside the program, and lies at the same
// place beside a program that is not installed.
std::filesystem::path pageScript()
{
    std::error_code error;
    const std::filesystem::path program = std::filesystem::read_symlink("/proc/self/exe", error);
    return program.parent_path().parent_path() / "share/candelabra/report/report.py";
}

// Runs python3 and waits for it. Returns whether it succeeded. Throws RunError if there is none.
bool runPython(std::vector<std::string> words)
{
    words.insert(words.begin(), {"python3", "-B"}); // -B: it writes no cache
    std::vector<char*> arguments;
    for (std::string& word : words)
        arguments.push_back(word.data());
    arguments.push_back(nullptr);
    pid_t child = 0;
    const int error = posix_spawnp(&child, "python3", nullptr, nullptr, arguments.data(), environ);
    if (error != 0)
        throw RunError(
            fmt::format("python3: {}; it makes the page (Debian: apt-get install python3)",
                        std::strerror(error)));
    int status = -1;
    while (waitpid(child, &status, 0) < 0 && errno == EINTR)
        continue;
    return status == 0;
}

// Warns before the measurement if there will be no page.
void warnOfMissingPage()
{
    const std::filesystem::path script = pageScript();
    try {
        if (!std::filesystem::exists(script))
            throw RunError(script.string() + ": is missing");
        runPython({"-c", ""});
    } catch (const RunError& error) {
        spdlog::warn("warning: {}; there will be figures and no page", error.what());
    }
}

void makePage(const ReportPlan& plan, const std::string& committed)
{
    const std::string script = pageScript().string(), folder = plan.directory.string();
    std::vector<std::string> words{script, folder};
    if (!committed.empty())
        words.push_back(committed);
    if (!runPython(words))
        throw RunError(fmt::format("{} made no page; the figures are in {}", script,
                                   (plan.directory / "report.json").string()));
}

std::vector<PartChoice> chosenParts(const std::string& parts)
{
    std::vector<PartChoice> out;
    for (const std::string& name : splitAtCommas(parts)) {
        const auto* found = std::ranges::find(partChoices, name, &PartChoice::name);
        if (found == std::end(partChoices))
            throw UsageError(
                fmt::format("--parts \"{}\": choose from {}", parts, ReportArguments().parts));
        if (std::ranges::count(out, name, &PartChoice::name))
            throw UsageError(fmt::format("--parts \"{}\": {} is there twice", parts, name));
        out.push_back(*found);
    }
    return out;
}

int report(const ProgramContext& program, const ReportArguments& a)
{
    const ReportPlan plan{.lights = unsignedOption("--lights", a.lights, 1, maxLights),
                          .frames = unsignedOption("--frames", a.frames, 1, 100'000),
                          .size = sizeOption("--size", a.size),
                          .directory = a.directory};
    const std::vector<PartChoice> wanted = chosenParts(a.parts);
    if (!a.committed.empty() && !std::filesystem::is_directory(a.committed))
        throw UsageError(fmt::format("--committed \"{}\": there is no such folder", a.committed));
    const std::string html = benchOutput(a.directory, "--out", "", "index.html"),
                      json = benchOutput(a.directory, "--out", "", "report.json");
    const auto device = std::make_unique<VulkanContext>(a.device.contextOptions())->info();
    spdlog::info("report on {}; all parts take 3 minutes on two CPU cores", device.name);
    warnOfMissingPage();
    bool faults = false;
    Json document{{"schema", "candelabra report 2"},
                  {"provenance", provenance(device, program.commandLine)},
                  {"pictures", Json::array()},
                  {"charts", Json::array()}};
    for (size_t i = 0; i < wanted.size(); ++i)
        faults |= measurePart(a.device, wanted[i], i, wanted.size(), plan, program.quiet, document);
    writeJson(json, document);
    makePage(plan, a.committed);
    writeText("-", fmt::format("See {}; its figures are in {}\n", html, json));
    return faults ? exitFailed : exitOk;
}

} // namespace

void addReportCommand(CLI::App& app, Run& run)
{
    CLI::App* command = app.add_subcommand(
        "report",
        "Run short forms of the main measurements, and write one HTML page of the results");
    const auto a = argumentsOf(*command, run, report);
    addOption(*command, "--out", a->directory, "DIR", "directory for index.html and report.json");
    addOption(*command, "--parts", a->parts, "NAME,...", "parts to measure, in this order");
    addOption(*command, "--lights", a->lights, "N", "number of lights in the profiled frame");
    addOption(*command, "--size", a->size, "WxH", "image size of that frame");
    addOption(*command, "--frames", a->frames, "N", "number of times to draw that frame");
    addOption(*command, "--committed", a->committed, "DIR",
              "folder with CSV files from tools/update_results to compare with; default: those "
              "that are installed with the program");
    a->device.addTo(*command);
    command->footer(
        "The page begins with questions and their answers. Under every part is the command that\n"
        "repeats it. All parts take 3 minutes on two CPU cores. python3 makes the page.\n\n"
        "Examples:\n"
        "  candelabra report\n"
        "  candelabra report --parts profile,culling --lights 16000 --out out/culling");
}

} // namespace candelabra::app
