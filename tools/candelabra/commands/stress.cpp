// SPDX-License-Identifier: Apache-2.0
// candelabra stress: a sweep over light counts, timed and checked, or a search for the largest
// count that makes a frame rate.
#include <algorithm>
#include <cmath>
#include <map>
#include <memory>
#include <set>

#include <fmt/format.h>
#include <spdlog/spdlog.h>

#include "commands/commands.h"
#include "commands/messages.h"
#include "generate/generators.h"
#include "io/error.h"
#include "io/statistics.h"
#include "load/load.h"
#include "measure/stress.h"
#include "render/provenance.h"
#include "scene/scene_error.h"
#include "scene/scene_options.h"

namespace candelabra::app
{
namespace
{

struct StressArguments {
    DeviceArguments device;
    SceneArguments scene;
    FrameArguments frame;
    std::string lights = "1000,4000,16000", frames = "10", warmUp = "0", check = "auto";
    std::string fps, directory = "out", json;
    std::set<std::string> given; // the options of the command line
};

constexpr Choice<CheckExtent> checkChoices[] = {{"auto", CheckExtent::Auto},
                                                {"sampled", CheckExtent::Sampled},
                                                {"full", CheckExtent::Full},
                                                {"none", CheckExtent::None}};

// A search draws frames for so long, per number of lights, unless --frames is given.
constexpr double searchSeconds = 3;

StressSettings settingsOf(const StressArguments& a)
{
    StressSettings out{
        .scene = a.scene.scene,
        .sceneOptions = a.scene.options(std::nullopt),
        .camera = a.frame.camera,
        .size = sizeOption("--size", a.frame.size),
        .gbufferLayout = a.frame.gbufferLayout(),
        .frame = a.frame.frameOptions(),
        .lightsVisible = a.frame.lightsVisibleOverride(),
        .counts = {.warmUp = 2,
                   .measured = unsignedOption("--frames", a.frames, 1, 1'000'000),
                   .warmUpSeconds = numberOption("--warm-up", a.warmUp, 0, maxWarmUpSeconds)},
        .check = choose("--check", a.check, checkChoices),
        .directory = a.directory};
    if (a.given.contains("--fps")) {
        const double fps = numberOption("--fps", a.fps, 0.01, 100'000);
        for (const char* option : {"--lights", "--check"})
            if (a.given.contains(option))
                throw UsageError(fmt::format(
                    "--fps: cannot be combined with {}, because it chooses the numbers of lights, "
                    "and only times them",
                    option));
        out.frameMs = 1000 / fps;
        if (!a.given.contains("--frames"))
            out.counts.measured =
                std::max(out.counts.measured, uint32_t(std::ceil(searchSeconds * fps)));
    }
    return out;
}

std::vector<uint32_t> lightCounts(const StressArguments& a)
{
    std::vector<uint32_t> counts = unsignedListOption("--lights", a.lights, 0, maxLights);
    for (size_t i = 1; i < counts.size(); ++i) {
        const auto end = counts.begin() + std::ptrdiff_t(i);
        if (std::find(counts.begin(), end, counts[i]) != end)
            throw UsageError(fmt::format("--lights {}: {} is listed twice", a.lights, counts[i]));
    }
    a.device.requireRoomFor(*std::ranges::max_element(counts));
    return counts;
}

std::string advice(const StressArguments& a, const std::vector<StressPoint>& points,
                   const std::string& svg, const std::string& json)
{
    std::string images;
    for (const StressPoint& p : points)
        images += "  " + p.image + "\n";
    return fmt::format(
        "\nLook at\n{}  {}  (GPU time against lights)\n  {}  (all figures)\n"
        "Try next\n"
        "  candelabra view {} --lights {}         (fly through it; needs a display)\n"
        "  candelabra render {} --lights 2000 --overlaps 30 -o dense.png\n"
        "  candelabra stress field --lights 1000,10000,100000 --out {}/field\n",
        images, svg, json, a.scene.scene, points.front().lights, a.scene.scene, a.directory);
}

// Says how long the command takes, if that is long.
void announce(double seconds)
{
    if (seconds > 10)
        spdlog::info("takes about {:.0f} s, more or less by the speed of the device", seconds);
}

FrameCondition conditionOf(const StressArguments& a, const StressSettings& settings,
                           const VulkanContext& context)
{
    return {.scene = settings.scene,
            .device = context.info().name,
            .size = settings.size,
            .shadows = settings.frame.shadows,
            .addedLights = !isGenerated(a.scene.scene)};
}

// What the command found, and what it writes at its end.
struct StressResult {
    std::vector<StressPoint> points; // ascending in a search
    std::string sentence;
    Json search; // null: there was none
};

StressResult sweep(const ProgramContext& program, const StressArguments& a,
                   const StressSettings& settings, const VulkanContext& context,
                   const std::vector<uint32_t>& counts)
{
    StressResult out;
    double seconds = 0;
    for (const uint32_t count : counts)
        seconds += estimatedSeconds(settings, count);
    announce(seconds);
    {
        Progress progress(seconds, !program.quiet);
        for (const uint32_t count : counts)
            out.points.push_back(measureStressPoint(context, settings, count, progress));
    }
    const auto most = std::ranges::max_element(out.points, {}, &StressPoint::lights);
    out.sentence = costSentence(most->cost(), conditionOf(a, settings, context));
    return out;
}

StressResult search(const ProgramContext& program, const StressArguments& a,
                    const StressSettings& settings, const VulkanContext& context)
{
    if (!context.timestampValidBits())
        throw RunError(
            fmt::format("--fps: {} has no timestamps, which measure frames", context.info().name));
    const double overlaps = settings.sceneOptions.overlaps.value_or(0), ms = *settings.frameMs;
    // Lights are added to those that a file has.
    const uint32_t own =
        isGenerated(a.scene.scene)
            ? 0
            : uint32_t(loadScene(a.scene.scene, settings.sceneOptions).lights.size());
    const uint32_t room = std::min(maxLights, maxLightsOf(context.info()));
    const uint32_t most = room > own ? room - own : 1;
    const LightSearchRange range{
        .ms = ms,
        // Few lights cannot reach all pixels often.
        .start = uint32_t(std::min(std::max(1000.0, 4 * overlaps), double(most))),
        .most = most};
    const double seconds = maxSearched * estimatedSeconds(settings, range.start);
    announce(seconds);
    std::map<uint32_t, StressPoint> points;
    std::string fewest;
    LightSearch found;
    {
        Progress progress(seconds, !program.quiet);
        const auto msOf = [&](uint32_t lights) -> std::optional<double> {
            try {
                StressPoint p = measureStressPoint(context, settings, lights, progress);
                const double took = p.cost().ms;
                const auto [at, isNew] = points.try_emplace(lights, p);
                if (!isNew && took < at->second.cost().ms)
                    at->second = std::move(p);
                return took;
            } catch (const SceneError& error) {
                if (points.empty())
                    throw;
                fewest = error.what();
                return {};
            }
        };
        found = searchLights(range, msOf);
    }
    StressResult out;
    for (auto& [lights, point] : points)
        out.points.push_back(std::move(point));
    const auto at = std::ranges::find_if(out.points, [&](const StressPoint& p) {
        return p.asked == found.lights.value_or(found.tried.front().lights);
    });
    if (isNoisy(at->times.totals()))
        spdlog::warn(
            "warning: the times of {} differ by more than {:.0f}%, so another run may find "
            "another number; other programs may keep the device busy",
            counted(at->lights, "light"), 100 * noisyShare);
    out.sentence =
        searchSentence(1000 / ms, found, at->cost(), conditionOf(a, settings, context), fewest);
    out.search = {{"framesPerSecond", 1000 / ms},
                  {"frameMs", ms},
                  {"lights", found.lights ? Json(*found.lights) : Json()},
                  {"lightsInScene", found.lights ? Json(at->lights) : Json()},
                  {"isMost", found.isMost}};
    return out;
}

std::string outputText(const StressArguments& a, const StressResult& r, const std::string& svg,
                       const std::string& json)
{
    const std::string found =
        r.search.is_null()
            ? stressTables(r.points) + advice(a, r.points, svg, json)
            : searchTable(r.points) + fmt::format("\nSee {} (GPU time against lights) and {} (all "
                                                  "figures)\n",
                                                  svg, json);
    return found + "\n" + r.sentence + "\n";
}

int stress(const ProgramContext& program, const StressArguments& a)
{
    const StressSettings settings = settingsOf(a);
    const std::vector<uint32_t> counts = lightCounts(a);
    a.scene.warnOfIdleOptions(counts.front());
    const std::string json = benchOutput(a.directory, "--json", a.json, "stress.json");
    const std::string svg = benchOutput(a.directory, "--out", "", "stress.svg");
    const VulkanContext context(a.device.contextOptions());
    spdlog::info("{} at {}x{} on {}", settings.scene, settings.size.width, settings.size.height,
                 context.info().name);

    const StressResult result = settings.frameMs ? search(program, a, settings, context)
                                                 : sweep(program, a, settings, context, counts);
    writeText(svg, stressPlot(settings, context.info(), result.points));
    Json document{{"schema", "candelabra stress 1"},
                  {"provenance", provenance(context.info(), program.commandLine)},
                  {"search", result.search},
                  {"sentence", result.sentence}};
    document.update(stressJson(settings, result.points));
    writeJson(json, document);
    if (json != "-")
        writeText("-", outputText(a, result, svg, json));

    const std::vector<std::string> failures = failedChecks(result.points);
    for (const std::string& failure : failures)
        spdlog::error("candelabra: {}", failure);
    return printValidationMessages(context) || !failures.empty() ? exitFailed : exitOk;
}

} // namespace

void addStressCommand(CLI::App& app, Run& run)
{
    CLI::App* command = app.add_subcommand(
        "stress", "Time and check frames with growing numbers of lights, or find "
                  "how many make a frame rate; write a plot and all figures");
    const auto a = std::make_shared<StressArguments>();
    a->scene.addTo(*command, "hall");
    addOption(*command, "--lights", a->lights, "N,N,...", "light counts to measure");
    addOption(*command, "--fps", a->fps, "F",
              "find the largest number of lights whose frames take 1/F s of GPU time, instead of "
              "measuring --lights; there are at most 12 measurements, and no pictures or checks");
    addOption(*command, "--frames", a->frames, "N",
              "frames to measure per count, after 2 warm-up frames; with --fps, the default is 3 F "
              "if that is more, and 5 suffice if their time is far from 1/F s");
    addWarmUpTo(*command, a->warmUp);
    addOption(*command, "--check", a->check, "NAME",
              "pixels to compare with brute force: auto (all pixels up to 16384 lights, and "
              "sampled tiles above), sampled (fewer tiles, for a quick look), full, or none, which "
              "also skips the second run");
    addBenchOutput(*command, a->directory, a->json, "stress.json");
    a->frame.size = "1280x720";
    a->frame.addTo(*command);
    command->get_option("--size")->description("image size in pixels")->capture_default_str();
    a->frame.addReuseTo(*command, Reuse::None);
    a->device.addTo(*command);
    command->footer(
        "The exit code is 1 if clustered lighting differs from brute force by more than 1e-6\n"
        "of the largest radiance, or if two runs differ in any bit.\n\n"
        "Examples:\n"
        "  candelabra stress\n"
        "  candelabra stress hall --fps 60 --size 1920x1080\n"
        "  candelabra stress field --lights 1000,10000,100000 --overlaps 12\n"
        "  candelabra stress --size 1920x1080 --frames 100 --check none --json t.json");
    command->callback([&run, a, command] {
        for (const CLI::Option* option : command->get_options())
            if (option->count())
                a->given.insert(option->get_name());
        run = [a](const ProgramContext& program) { return stress(program, *a); };
    });
}

} // namespace candelabra::app
