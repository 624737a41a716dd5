// SPDX-License-Identifier: Apache-2.0
// candelabra bench lanes: measures how well the lanes of subgroups are used.
#include <algorithm>
#include <memory>

#include <fmt/format.h>
#include <spdlog/spdlog.h>

#include "commands/bench_commands.h"
#include "commands/messages.h"
#include "commands/options.h"
#include "generate/generators.h"
#include "io/error.h"
#include "measure/lanes/lane_counter.h"
#include "measure/lanes/lanes.h"
#include "render/provenance.h"

namespace candelabra::app
{
namespace
{

struct LaneArguments {
    DeviceArguments device;
    std::string scenes = "hall,field,fence", lights = "1000,10000,100000,1000000";
    std::string overlaps = "8", size = "1920x1080", seed = "1", json;
};

LaneSettings settingsOf(const LaneArguments& a)
{
    LaneSettings s;
    s.scenes = splitAtCommas(a.scenes);
    for (const std::string& scene : s.scenes)
        if (!isGenerated(scene))
            throw UsageError(
                fmt::format("--scenes \"{}\": choose among hall, field, fence", a.scenes));
    const auto size = parseSize(a.size);
    if (!size || size->width > maxSide || size->height > maxSide)
        throw UsageError(fmt::format("--size \"{}\": expected WIDTHxHEIGHT up to {} pixels a side",
                                     a.size, maxSide));
    s.size = *size;
    s.lights = unsignedListOption("--lights", a.lights, 1, 1'000'000);
    s.overlaps = unsignedOption("--overlaps", a.overlaps, 1, 10'000);
    s.seed = unsignedOption("--seed", a.seed, 0, UINT32_MAX);
    a.device.requireRoomFor(*std::max_element(s.lights.begin(), s.lights.end()));
    return s;
}

int lanes(const ProgramContext& program, const LaneArguments& a)
{
    const LaneSettings settings = settingsOf(a);
    if (!a.json.empty())
        requireWritable("--json", a.json);
    ContextOptions options = a.device.contextOptions();
    options.engineFunctions = LaneCounter::functions;
    const VulkanContext context(options);
    spdlog::info("lanes, counted on {}", context.info().name);
    std::vector<LanePoint> points;
    {
        Progress progress(double(laneSteps(settings)), !program.quiet);
        points = measureLanes(context, settings, progress);
    }
    if (!a.json.empty()) {
        Json document{{"schema", "candelabra bench lanes 1"},
                      {"provenance", provenance(context.info(), program.commandLine)}};
        document.update(laneJson(settings, points));
        writeJson(a.json, document);
    }
    if (a.json != "-")
        writeText("-", laneTable(points));
    return printValidationMessages(context) ? exitFailed : exitOk;
}

} // namespace

void addBenchLanes(CLI::App& bench, Run& run)
{
    CLI::App* command = bench.add_subcommand(
        "lanes",
        "Count how many lanes of subgroups do useful work, and the longest chains of steps");
    const auto a = std::make_shared<LaneArguments>();
    const auto add = [&](const char* name, std::string& value, const char* what, const char* type) {
        command->add_option(name, value, what)->type_name(type)->capture_default_str();
    };
    add("--scenes", a->scenes, "generated scenes to draw", "NAME,...");
    add("--lights", a->lights, "numbers of lights, up to 1,000,000", "N,N,...");
    add("--overlaps", a->overlaps, "mean number of lights that contribute to a pixel", "K");
    add("--size", a->size, "image size", "WxH");
    add("--seed", a->seed, "seed of the scenes and lights", "N");
    command->add_option("--json", a->json, "JSON file with all figures; - is standard output")
        ->type_name("FILE");
    a->device.addTo(*command);
    command->footer(
        "A turn is one pass of one lane through a loop: the test of a light or of a node of the\n"
        "light tree, or the evaluation of a light. The lanes of a subgroup run a loop until the\n"
        "last of them is done with it; the others wait. Efficiency is turns over turns and waits.\n"
        "The longest lane has the most turns one after another, which wait for each other.\n"
        "The figures are those of kernels as they run on GPUs, whatever device counts them.\n"
        "tools/gpu_model predicts times from them.\n\n"
        "Examples:\n"
        "  candelabra bench lanes --scenes hall --lights 10000\n"
        "  candelabra bench lanes --json lanes.json");
    command->callback(
        [&run, a] { run = [a](const ProgramContext& program) { return lanes(program, *a); }; });
}

} // namespace candelabra::app
