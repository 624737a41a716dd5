// SPDX-License-Identifier: Apache-2.0
// candelabra bench skip: measures what a frame saves by leaving out what its content does not need.
// Pairs of frames are compared as candelabra profile --ab compares them.
#include <functional>

#include <fmt/format.h>
#include <spdlog/spdlog.h>

#include "candelabra/candelabra.hpp"
#include "commands/commands.h"
#include "commands/messages.h"
#include "io/error.h"
#include "io/progress.h"
#include "io/statistics.h"
#include "io/table.h"
#include "load/load.h"
#include "measure/profile/profile_frames.h"
#include "render/camera.h"
#include "render/provenance.h"
#include "render/readback.h"

namespace candelabra::app
{
namespace
{

struct SkipArguments {
    DeviceArguments device;
    std::string scene = "hall", lights = "4000", size = "1280x720", rounds = "31";
    std::string directory = "out", json;
};

bool isExposure(const std::string& pass)
{
    return pass == "luminance_histogram" || pass == "adapt_exposure" || pass == "tone_map";
}

bool isLighting(const std::string& pass)
{
    const bool isRaster =
        pass.starts_with("cull_") || pass == "compact_instances" || pass == "gbuffer_raster";
    return !isRaster && !isExposure(pass);
}

struct SkipPair {
    const char *name, *against, *passes;
    std::function<bool(const std::string& pass)> counts; // whether the pass is one of `passes`
    FrameOptions with;                                   // the other frame has the usual options
};

std::vector<SkipPair> pairsOf(const FrameOptions& usual, float ev100)
{
    FrameOptions lists = usual, image = usual, manual = usual;
    lists.reuse = Reuse::Lists;
    image.reuse = Reuse::Lighting;
    manual.exposure.manual = VK_TRUE;
    manual.exposure.manualEv100 = ev100;
    return {
        {"lights and surfaces unchanged", "lists made again", "lighting", isLighting, lists},
        {"nothing changed", "drawn again", "raster and lighting", std::not_fn(isExposure), image},
        {"manual exposure", "automatic, the same EV", "exposure", isExposure, manual}};
}

// The radiance and the display image of the second of two frames, which may reuse the first.
std::vector<float> imageOf(const VulkanContext& context, Renderer& renderer,
                           const FrameOptions& options)
{
    for (int frame = 0; frame < 2; ++frame)
        context.submitAndWait([&](VkCommandBuffer cmd) { renderer.record(cmd, 0, options); });
    std::vector<float> out = readRadiance(context, renderer).pixels;
    const std::vector<uint8_t> display = readDisplay(context, renderer);
    out.insert(out.end(), display.begin(), display.end());
    return out;
}

// The time of the counted passes in each frame.
std::vector<double> timesOf(const FrameSeries& series, const SkipPair& pair)
{
    std::vector<double> out(series.gpuMs.size());
    for (const FrameSeries::Pass& pass : series.passes)
        for (size_t i = 0; pair.counts(pass.name) && i < out.size(); ++i)
            out[i] += pass.ms[i];
    return out;
}

int skip(const ProgramContext& program, const SkipArguments& a)
{
    const PixelSize size = sizeOption("--size", a.size);
    const uint32_t lights = unsignedOption("--lights", a.lights, 1, 1'000'000);
    const uint32_t rounds = unsignedOption("--rounds", a.rounds, 1, 10'000);
    a.device.requireRoomFor(lights);
    const std::string json = benchOutput(a.directory, "--json", a.json, "bench_skip.json");
    const Scene scene = loadScene(a.scene, {.lights = lights});
    const FrameOptions usual{.camera = selectCamera(scene, ""),
                             .lightsVisible = false,
                             .exposure = defaultExposureSettings()};
    const VulkanContext context(a.device.contextOptions());
    announceBench("skips", context);
    Renderer renderer(context, scene, {.size = size, .framesInFlight = 1, .stamps = true});
    const std::vector<float> image = imageOf(context, renderer, usual);
    const std::vector<SkipPair> pairs = pairsOf(usual, renderer.stats(0).exposure.adaptedEv100);
    Table table({"what is left out", "against", "passes", "with ms", "without ms",
                 "median of paired ratios [95%]"});
    Json list = Json::array();
    bool differs = false;
    Progress progress(double(pairs.size()) * (rounds + maxWarmUp), !program.quiet);
    for (const SkipPair& pair : pairs) {
        progress.doing(pair.name);
        const bool isSame = imageOf(context, renderer, pair.with) == image;
        if (!isSame)
            spdlog::error("candelabra: {}: the image differs", pair.name);
        differs |= !isSame;
        const Profile profile =
            profileFrames(context, renderer, {.variants = {pair.with, usual}, .rounds = rounds},
                          [&] { progress.advance(1); });
        const std::vector<double> with = timesOf(profile.series[0], pair),
                                  without = timesOf(profile.series[1], pair);
        const PairedRatio r = pairedRatio(without, with);
        table.add({pair.name, pair.against, pair.passes, threeDigits(medianOf(with)),
                   threeDigits(medianOf(without)),
                   fmt::format("{:.3f} [{:.3f}, {:.3f}]", r.median, r.low, r.high)});
        list.push_back({{"name", pair.name},
                        {"against", pair.against},
                        {"passes", pair.passes},
                        {"ratio", r.median},
                        {"withMs", medianOf(with)},
                        {"withoutMs", medianOf(without)}});
    }
    writeJson(json, {{"schema", "candelabra bench skip 2"},
                     {"provenance", provenance(context.info(), program.commandLine)},
                     {"scene", a.scene},
                     {"widthPixels", size.width},
                     {"heightPixels", size.height},
                     {"lights", lights},
                     {"rounds", rounds},
                     {"skips", list}});
    if (json != "-")
        writeText("-", table.text() + "All figures: " + json + "\n");
    return printValidationMessages(context) || differs ? exitFailed : exitOk;
}

} // namespace

void addBenchSkip(CLI::App& bench, Run& run)
{
    CLI::App* command = bench.add_subcommand(
        "skip", "Measure what a frame saves by skipping what its content does not need");
    const auto a = argumentsOf(*command, run, skip);
    addOption(*command, "--scene", a->scene, "NAME", "scene to draw");
    addOption(*command, "--lights", a->lights, "N", "number of sphere lights, up to 1,000,000");
    addOption(*command, "--size", a->size, "WxH", "image size");
    addOption(*command, "--rounds", a->rounds, "N",
              "rounds; each round draws both frames of a pair once");
    addBenchOutput(*command, a->directory, a->json, "bench_skip.json");
    a->device.addTo(*command);
    command->footer(
        "Each row is one skip, with the GPU time of its passes with the skip and without it,\n"
        "as profile --ab measures them. The exit code is 1 if the images of the two frames\n"
        "differ.\n\n"
        "Example:\n"
        "  candelabra bench skip --scene field --lights 16000");
}

} // namespace candelabra::app
