// SPDX-License-Identifier: Apache-2.0
// candelabra bench host: measures what lights cost on the CPU.
#include <algorithm>
#include <memory>

#include <spdlog/spdlog.h>

#include "commands/bench_commands.h"
#include "commands/messages.h"
#include "io/error.h"
#include "measure/host/host.h"
#include "render/provenance.h"

namespace candelabra::app
{
namespace
{

struct HostArguments {
    DeviceArguments device;
    std::string lights = "1000,10000,100000,1000000", rounds = "9", seed = "1", json;
};

int host(const ProgramContext& program, const HostArguments& a)
{
    const HostSettings settings{.lights = unsignedListOption("--lights", a.lights, 1, 1'000'000),
                                .rounds = unsignedOption("--rounds", a.rounds, 1, 10'000),
                                .seed = unsignedOption("--seed", a.seed, 0, UINT32_MAX)};
    a.device.requireRoomFor(*std::max_element(settings.lights.begin(), settings.lights.end()));
    if (!a.json.empty())
        requireWritable("--json", a.json);
    const VulkanContext context(a.device.contextOptions());
    spdlog::info("calls for lights on {}", context.info().name);
    std::vector<HostPoint> points;
    {
        Progress progress(double(settings.lights.size()) * settings.rounds, !program.quiet);
        points = measureHost(context, settings, progress);
    }
    if (!a.json.empty()) {
        Json document{{"schema", "candelabra bench host 1"},
                      {"provenance", provenance(context.info(), program.commandLine)}};
        document.update(hostJson(settings, points));
        writeJson(a.json, document);
    }
    if (a.json != "-")
        writeText("-", hostTable(points));
    return printValidationMessages(context) ? exitFailed : exitOk;
}

} // namespace

void addBenchHost(CLI::App& bench, Run& run)
{
    CLI::App* command = bench.add_subcommand(
        "host", "Measure what moving, setting and updating lights costs on the CPU");
    const auto a = std::make_shared<HostArguments>();
    addOption(*command, "--lights", a->lights, "N,N,...",
              "numbers of sphere lights of the hall, up to 1,000,000");
    addOption(*command, "--rounds", a->rounds, "N", "rounds; each round makes every call once");
    addOption(*command, "--seed", a->seed, "N", "seed of the lights");
    addOption(*command, "--json", a->json, "FILE",
              "JSON file with all figures; - is standard output");
    a->device.addTo(*command);
    command->footer(
        "The calls:\n"
        "  move         the program computes where moving lights are, as profile --moving does\n"
        "  set all      cndSetLights with all lights\n"
        "  update all   cndUpdateLights with all lights, in the order of their ids\n"
        "  update half  cndUpdateLights with half of the lights, in random order\n"
        "All times are medians. The memcpy beside a call copies 80 bytes per light: it reads and\n"
        "writes as many bytes as reading a CndLight (96) and writing a light's record (64).\n"
        "Recording is cndRecordLighting of the frame that uploads the lights.\n\n"
        "Examples:\n"
        "  candelabra bench host\n"
        "  candelabra bench host --lights 100000 --rounds 31 --json host.json");
    command->callback(
        [&run, a] { run = [a](const ProgramContext& program) { return host(program, *a); }; });
}

} // namespace candelabra::app
