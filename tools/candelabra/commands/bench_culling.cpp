// SPDX-License-Identifier: Apache-2.0
// candelabra bench culling: measures what finding the lights of every pixel costs, with the engine
// and with other ways to cull.
#include <algorithm>
#include <filesystem>

#include <fmt/format.h>
#include <spdlog/spdlog.h>

#include "commands/commands.h"
#include "commands/messages.h"
#include "generate/generators.h"
#include "io/error.h"
#include "measure/culling/culling.h"
#include "render/provenance.h"
#include "render/renderer.h"
#include "render/setting_names.h"

namespace candelabra::app
{
namespace
{

struct CullingArguments {
    DeviceArguments device;
    std::string scenes = "hall,field,fence", lights = "1000,4000,16000,64000", overlaps = "8,30";
    std::string sizes = "1280x720", rounds = "6", seed = "1", bruteLimit = "60";
    std::string shadows = "off";
    std::string directory = "out", json;
};

CullingSettings settingsOf(const CullingArguments& a)
{
    CullingSettings s;
    s.scenes = splitAtCommas(a.scenes);
    for (const std::string& scene : s.scenes)
        if (!isGenerated(scene))
            throw UsageError(
                fmt::format("--scenes \"{}\": choose among hall, field, fence, rooms", a.scenes));
    s.sizes.clear();
    for (const std::string& text : splitAtCommas(a.sizes))
        s.sizes.push_back(sizeOption("--size", text));
    s.lights = unsignedListOption("--lights", a.lights, 1, 1'000'000);
    s.overlaps = unsignedListOption("--overlaps", a.overlaps, 1, 10'000);
    s.rounds = unsignedOption("--rounds", a.rounds, 1, 10'000);
    s.shadows = choose("--shadows", a.shadows, shadowChoices);
    s.seed = unsignedOption("--seed", a.seed, 0, UINT32_MAX);
    s.bruteLimit = numberOption("--brute-limit", a.bruteLimit, 0, 1e6);
    a.device.requireRoomFor(*std::ranges::max_element(s.lights));
    return s;
}

int culling(const ProgramContext& program, const CullingArguments& a)
{
    const CullingSettings settings = settingsOf(a);
    const std::string json = benchOutput(a.directory, "--json", a.json, "bench_culling.json");
    const VulkanContext context(a.device.contextOptions());
    announceBench("culling", context);
    const std::vector<CullingPoint> points = measureCulling(context, settings, !program.quiet);
    for (const CullingPlot& plot : cullingPlots(points, context.info()))
        writeText((std::filesystem::path(a.directory) / (plot.name + ".svg")).string(), plot.svg);
    Json document{{"schema", "candelabra bench culling 1"},
                  {"provenance", provenance(context.info(), program.commandLine)}};
    document.update(cullingJson(settings, points));
    writeJson(json, document);
    if (json != "-")
        writeText("-", textOf(cullingTables(points)) +
                           fmt::format("\nSee {}/bench_culling_*.svg (time against lights) and "
                                       "{} (all figures)\n",
                                       a.directory, json));
    const std::vector<std::string> failures = cullingFailures(points);
    for (const std::string& failure : failures)
        spdlog::error("candelabra: {}", failure);
    return printValidationMessages(context) || !failures.empty() ? exitFailed : exitOk;
}

} // namespace

void addBenchCulling(CLI::App& bench, Run& run)
{
    CLI::App* command =
        bench.add_subcommand("culling", "Compare the engine's times and light lists with 2D tiles, "
                                        "froxels, brute force and no culling");
    const auto a = argumentsOf(*command, run, culling);
    addOption(*command, "--scenes", a->scenes, "NAME,...", "generated scenes to draw");
    addOption(*command, "--lights", a->lights, "N,N,...", "numbers of lights, up to 1,000,000");
    addOption(*command, "--overlaps", a->overlaps, "K,K,...",
              "mean numbers of lights that contribute to a pixel");
    addOption(*command, "--size", a->sizes, "WxH,...", "image sizes");
    addOption(*command, "--rounds", a->rounds, "N",
              "rounds; each round draws the frame once in every way");
    addOption(*command, "--brute-limit", a->bruteLimit, "SECONDS",
              "skip brute force, and report an estimate, if a frame would take longer");
    addChoice(*command, "--shadows", a->shadows, shadowChoices,
              "draw the frame also with shadows, found for this many points of each light; the "
              "other ways draw none");
    addOption(*command, "--seed", a->seed, "N", "seed of the scenes and lights");
    addBenchOutput(*command, a->directory, a->json, "bench_culling.json");
    a->device.addTo(*command);
    command->footer(
        "Times are GPU times of lighting: preparing lights, culling and shading, without the\n"
        "raster pass. Emitters are not drawn. All ways shade with the engine's closed form:\n"
        "  16x16 tiles   tests every light against every tile's frustum and depth range\n"
        "  froxels       cells of 64x64 pixels in 32 slices, which grow exponentially between\n"
        "                the nearest and the farthest surface; spheres are tested against boxes\n"
        "  brute force   evaluates all lights at all pixels; once if it takes over a second\n"
        "  floor         does as many evaluations per pixel as lights contribute, without\n"
        "                searching for lights\n"
        "With 6 rounds or more, the ratio to the fastest other way gets an interval.\n"
        "The exit code is 1 if an image differs from the engine's by more than 4e-6 of the\n"
        "largest radiance, or if the image of brute force differs by more than 1e-6.\n\n"
        "Examples:\n"
        "  candelabra bench culling\n"
        "  candelabra bench culling --scenes hall --lights 4000 --overlaps 30 --rounds 15\n"
        "  candelabra bench culling --lights 256000,1000000 --overlaps 8 --size 1920x1080");
}

} // namespace candelabra::app
