// SPDX-License-Identifier: Apache-2.0
// candelabra bench stability: tries the shader functions on random and adversarial inputs.

#include <spdlog/spdlog.h>

#include "commands/commands.h"
#include "commands/messages.h"
#include "io/error.h"
#include "io/parse.h"
#include "measure/stability/stability.h"
#include "render/provenance.h"
#include "render/setting_names.h"

namespace candelabra::app
{
namespace
{

struct StabilityArguments {
    DeviceArguments device;
    std::string configurations = "20000000", quadrature = "100000", sweeps = "200", seed = "1";
    std::string lights, specular;
    bool inexactDivision = false;
    std::string directory = "out", json;
};

int stability(const ProgramContext& program, const StabilityArguments& a)
{
    StabilitySettings settings;
    settings.configurations = uint64_t(numberOption("--configs", a.configurations, 1, 1e12));
    settings.quadratureSamples = unsignedOption("--quadrature", a.quadrature, 1, 100'000'000);
    settings.sweeps = unsignedOption("--sweeps", a.sweeps, 1, 100'000);
    settings.seed = unsignedOption("--seed", a.seed, 0, UINT32_MAX);
    settings.inexactDivision = a.inexactDivision;
    if (!a.lights.empty())
        settings.lightTypes = lightTypesOption("--light-types", a.lights);
    if (!a.specular.empty())
        for (const std::string& name : splitAtCommas(a.specular))
            settings.methods.push_back(chooseSpecular("--specular", name));
    const std::string json = benchOutput(a.directory, "--json", a.json, "bench_stability.json");
    const VulkanContext context(a.device.contextOptions());
    announceBench("stability", context);
    const Stability result = measureStability(context, settings, !program.quiet);
    Json document{{"schema", "candelabra bench stability 1"},
                  {"provenance", provenance(context.info(), program.commandLine)}};
    document.update(stabilityJson(settings, result));
    writeJson(json, document);
    if (json != "-")
        writeText("-", textOf(stabilityTables(result)));
    if (result.invalid())
        spdlog::error("candelabra: {} of {} responses are NaN, infinite, negative or too bright",
                      result.invalid(), result.tried());
    if (result.overBar())
        spdlog::error("candelabra: a closed form is farther from quadrature than its bar");
    return printValidationMessages(context) || result.invalid() || result.overBar() ? exitFailed
                                                                                    : exitOk;
}

} // namespace

void addBenchStability(CLI::App& bench, Run& run)
{
    CLI::App* command = bench.add_subcommand(
        "stability",
        "Try random and adversarial inputs, count invalid responses, and measure errors and jumps");
    const auto a = argumentsOf(*command, run, stability);
    addOption(*command, "--configs", a->configurations, "N",
              "total number of configurations; 1e8 take minutes on two CPU cores");
    addOption(*command, "--quadrature", a->quadrature, "N",
              "total number of configurations to compare with quadrature");
    addOption(*command, "--sweeps", a->sweeps, "N", "number of sweeps per continuity check");
    addOption(*command, "--seed", a->seed, "N", "seed of all random inputs");
    addOption(*command, "--light-types", a->lights, "TYPE,...", "light types to try; default: all");
    addOption(*command, "--specular", a->specular, "METHOD,...",
              "specular methods to try; default: all");
    command->add_flag("--inexact-division", a->inexactDivision,
                      "make every quotient and root as inaccurate as Vulkan allows, so that any "
                      "device shows the effect of rounding on GPUs; skips the continuity checks");
    addBenchOutput(*command, a->directory, a->json, "bench_stability.json");
    a->device.addTo(*command);
    command->footer(
        "The exit code is 1 if any response is NaN, infinite or negative. It is also 1 if a\n"
        "closed form is brighter than a light of that size and place can be, or farther from\n"
        "quadrature than its bound.\n\n"
        "Examples:\n"
        "  candelabra bench stability\n"
        "  candelabra bench stability --configs 1e10 --quadrature 1000000\n"
        "  candelabra bench stability --light-types tube,rectangle --specular conic\n"
        "  candelabra bench stability --inexact-division --seed 2");
}

} // namespace candelabra::app
