// SPDX-License-Identifier: Apache-2.0
// candelabra stress: a sweep over light counts, timed and checked.
#include <algorithm>
#include <memory>

#include <fmt/format.h>
#include <spdlog/spdlog.h>

#include "commands/bench_commands.h"
#include "commands/messages.h"
#include "io/error.h"
#include "measure/stress.h"
#include "render/provenance.h"
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
    std::string directory = "out", json;
};

constexpr Choice<CheckExtent> checkChoices[] = {{"auto", CheckExtent::Auto},
                                                {"sampled", CheckExtent::Sampled},
                                                {"full", CheckExtent::Full},
                                                {"none", CheckExtent::None}};

StressSettings settingsOf(const StressArguments& a)
{
    return {.scene = a.scene.scene,
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
}

std::vector<uint32_t> lightCounts(const StressArguments& a)
{
    std::vector<uint32_t> counts = unsignedListOption("--lights", a.lights, 0, maxLights);
    for (size_t i = 1; i < counts.size(); ++i) {
        const auto end = counts.begin() + std::ptrdiff_t(i);
        if (std::find(counts.begin(), end, counts[i]) != end)
            throw UsageError(fmt::format("--lights {}: {} is listed twice", a.lights, counts[i]));
    }
    a.device.requireRoomFor(*std::max_element(counts.begin(), counts.end()));
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

int stress(const ProgramContext& program, const StressArguments& a)
{
    StressSettings settings = settingsOf(a);
    const std::vector<uint32_t> counts = lightCounts(a);
    a.scene.warnOfIdleOptions(counts.front());
    const std::string json = benchOutput(a.directory, "--json", a.json, "stress.json");
    const std::string svg = benchOutput(a.directory, "--out", "", "stress.svg");
    const VulkanContext context(a.device.contextOptions());
    spdlog::info("{} at {}x{} on {}", settings.scene, settings.size.width, settings.size.height,
                 context.info().name);

    double seconds = 0;
    for (const uint32_t count : counts)
        seconds += estimatedSeconds(settings, count);
    std::vector<StressPoint> points;
    {
        Progress progress(seconds, !program.quiet);
        for (const uint32_t count : counts)
            points.push_back(measureStressPoint(context, settings, count, progress));
    }
    writeText(svg, stressPlot(settings, context.info(), points));
    Json document{{"schema", "candelabra stress 1"},
                  {"provenance", provenance(context.info(), program.commandLine)}};
    document.update(stressJson(settings, points));
    writeJson(json, document);
    if (json != "-")
        writeText("-", stressTables(points) + advice(a, points, svg, json));

    const std::vector<std::string> failures = failedChecks(points);
    for (const std::string& failure : failures)
        spdlog::error("candelabra: {}", failure);
    return printValidationMessages(context) || !failures.empty() ? exitFailed : exitOk;
}

} // namespace

void addStressCommand(CLI::App& app, Run& run)
{
    CLI::App* command =
        app.add_subcommand("stress", "Time and check frames with growing numbers of lights; write "
                                     "pictures, a plot and all figures");
    const auto a = std::make_shared<StressArguments>();
    a->scene.addTo(*command, "hall");
    addOption(*command, "--lights", a->lights, "N,N,...", "light counts to measure");
    addOption(*command, "--frames", a->frames, "N",
              "frames to measure per count, after 2 warm-up frames");
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
        "  candelabra stress field --lights 1000,10000,100000 --overlaps 12\n"
        "  candelabra stress --size 1920x1080 --frames 100 --check none --json t.json");
    command->callback(
        [&run, a] { run = [a](const ProgramContext& program) { return stress(program, *a); }; });
}

} // namespace candelabra::app
