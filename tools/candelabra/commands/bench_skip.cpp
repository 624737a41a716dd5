// SPDX-License-Identifier: Apache-2.0
// candelabra bench skip: measures what a frame saves by skipping what its content does not need.
#include <memory>

#include <fmt/format.h>
#include <spdlog/spdlog.h>

#include "commands/bench_commands.h"
#include "commands/messages.h"
#include "commands/options.h"
#include "generate/generators.h"
#include "io/error.h"
#include "measure/skip.h"
#include "render/provenance.h"

namespace candelabra::app
{
namespace
{

struct SkipArguments {
    DeviceArguments device;
    std::string scene = "hall", lights = "4000", size = "1280x720";
    std::string rounds = "7", pointRounds = "50", seed = "1";
    std::string directory = "out", json;
};

SkipSettings settingsOf(const SkipArguments& a)
{
    if (!isGenerated(a.scene))
        throw UsageError(fmt::format("--scene \"{}\": choose one of hall, field, fence", a.scene));
    const auto size = parseSize(a.size);
    if (!size || size->width > maxSide || size->height > maxSide)
        throw UsageError(fmt::format("--size \"{}\": expected WIDTHxHEIGHT up to {} pixels a side",
                                     a.size, maxSide));
    const SkipSettings s{.scene = a.scene,
                         .size = *size,
                         .lights = unsignedOption("--lights", a.lights, 1, 1'000'000),
                         .rounds = unsignedOption("--rounds", a.rounds, 1, 10'000),
                         .pointRounds = unsignedOption("--point-rounds", a.pointRounds, 1, 10'000),
                         .seed = unsignedOption("--seed", a.seed, 0, UINT32_MAX)};
    a.device.requireRoomFor(s.lights);
    return s;
}

int skip(const ProgramContext& program, const SkipArguments& a)
{
    const SkipSettings settings = settingsOf(a);
    const std::string json = benchOutput(a.directory, "--json", a.json, "bench_skip.json");
    const VulkanContext context(a.device.contextOptions());
    spdlog::info("skips on {}", context.info().name);
    std::vector<SkipRow> rows;
    {
        Progress progress(skipSteps(settings), !program.quiet);
        rows = measureSkips(context, settings, progress);
    }
    Json document{{"schema", "candelabra bench skip 1"},
                  {"provenance", provenance(context.info(), program.commandLine)}};
    document.update(skipJson(settings, rows));
    writeJson(json, document);
    if (json != "-")
        writeText("-", fmt::format("{}, {}, {}x{}; medians\n{}\nAll figures: {}\n", settings.scene,
                                   settings.lights, settings.size.width, settings.size.height,
                                   skipTable(rows).text(), json));
    const std::vector<std::string> failures = skipFailures(rows);
    for (const std::string& failure : failures)
        spdlog::error("candelabra: {}", failure);
    return printValidationMessages(context) || !failures.empty() ? exitFailed : exitOk;
}

} // namespace

void addBenchSkip(CLI::App& bench, Run& run)
{
    CLI::App* command = bench.add_subcommand(
        "skip", "Measure what a frame saves by skipping what its content does not need");
    const auto a = std::make_shared<SkipArguments>();
    const auto add = [&](const char* name, std::string& value, const char* what, const char* type) {
        command->add_option(name, value, what)->type_name(type)->capture_default_str();
    };
    add("--scene", a->scene, "generated scene to draw", "NAME");
    add("--lights", a->lights, "number of sphere lights, up to 1,000,000", "N");
    add("--size", a->size, "image size", "WxH");
    add("--rounds", a->rounds, "rounds; each draws both frames of a row once", "N");
    add("--point-rounds", a->pointRounds,
        "rounds of the row that compares point lights with point lights", "N");
    add("--seed", a->seed, "seed of the scene and lights", "N");
    addBenchOutput(*command, a->directory, a->json, "bench_skip.json");
    a->device.addTo(*command);
    command->footer(
        "Each row is one skip. It holds the GPU time of the passes concerned with the skip and\n"
        "without it, from interleaved rounds; what looking for the skip costs in frames that\n"
        "cannot use it (\"nothing\" if that is known before recording, or if the GPU finds it\n"
        "anyway); and how much the two images differ.\n"
        "The exit code is 1 if they differ by more than the row allows: by anything at all; where\n"
        "sums may change their order, by 1e-6 of the largest radiance; for lights too dim to be\n"
        "seen, by the display error that they were cut with.\n\n"
        "Examples:\n"
        "  candelabra bench skip\n"
        "  candelabra bench skip --scene field --lights 16000 --rounds 15");
    command->callback(
        [&run, a] { run = [a](const ProgramContext& program) { return skip(program, *a); }; });
}

} // namespace candelabra::app
