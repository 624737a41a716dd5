// SPDX-License-Identifier: Apache-2.0
// candelabra bench pipelines: prints what the driver's compiler says about the engine's pipelines.

#include <fmt/format.h>

#include "commands/commands.h"
#include "io/error.h"
#include "measure/pipelines/pipelines.h"
#include "render/provenance.h"
#include "render/setting_names.h"

namespace candelabra::app
{
namespace
{

struct PipelineArguments {
    std::string device, kernels, types, methods, shadows = "off", json;
    bool noClasses = false, others = false;
};

uint32_t methodsOf(const std::string& text)
{
    uint32_t mask = 0;
    for (const std::string& name : splitAtCommas(text))
        mask |= 1u << chooseSpecular("--methods", name);
    return mask;
}

int pipelines(const ProgramContext& program, const PipelineArguments& a)
{
    PipelineSettings settings{.device = a.device,
                              .diffuseOnlyTiles = !a.noClasses,
                              .shadows = choose("--shadows", a.shadows, shadowChoices)};
    if (!a.kernels.empty())
        settings.kernels = splitAtCommas(a.kernels);
    if (!a.types.empty()) {
        settings.lightTypes = 0;
        for (const uint32_t type : lightTypesOption("--types", a.types))
            settings.lightTypes |= 1u << type;
    }
    if (!a.methods.empty())
        settings.methods = methodsOf(a.methods);
    if (!a.json.empty())
        requireWritable("--json", a.json);
    DeviceInfo device;
    const std::vector<PipelineCost> costs = measurePipelines(settings, device);
    if (!a.json.empty())
        writeJson(a.json, {{"schema", "candelabra bench pipelines 1"},
                           {"provenance", provenance(device, program.commandLine)},
                           {"shadows", shadowsName(settings.shadows)},
                           {"pipelines", pipelineJson(costs, a.others)}});
    if (a.json != "-")
        writeText("-", fmt::format("{}, {}\n{}", device.name, device.driver, pipelineTable(costs)));
    return exitOk;
}

} // namespace

void addBenchPipelines(CLI::App& bench, Run& run)
{
    CLI::App* command = bench.add_subcommand(
        "pipelines",
        "List the registers, spills and size of every pipeline, as the driver reports them");
    const auto a = argumentsOf(*command, run, pipelines);
    addOption(*command, "--kernels", a->kernels, "NAME,...",
              "compile these kernels only, such as shade_tiles,cluster_lists");
    addOption(*command, "--types", a->types, "NAME,...",
              "compile shading kernels for these light types only");
    addOption(*command, "--methods", a->methods, "NAME,...",
              "compile shading kernels for these methods only");
    addChoice(
        *command, "--shadows", a->shadows, shadowChoices,
        "compile the kernels of a module whose lights cast shadows, found for 32 or 64 points "
        "of each light");
    command->add_flag("--no-classes", a->noClasses,
                      "skip the kernels for tiles without a specular lobe");
    addOption(*command, "--device", a->device, "INDEX|NAME",
              "Vulkan device, by its index or part of its name; it need not be able to draw");
    addOption(*command, "--json", a->json, "FILE",
              "JSON file with all figures; - is standard output");
    command->add_flag("--all-statistics", a->others,
                      "write everything that the driver reports to the JSON file");
    command->footer(
        "The device needs the extension VK_KHR_pipeline_executable_properties. Nothing is\n"
        "drawn, so a driver without its GPU is enough. You can start Mesa's driver for AMD\n"
        "GPUs like this:\n"
        "  VK_ICD_FILENAMES=/usr/share/vulkan/icd.d/radeon_icd.x86_64.json RADV_DEBUG=nocache \\\n"
        "  RADV_FORCE_FAMILY=NAVI21 RADV_PERFTEST=cswave32 candelabra bench pipelines\n"
        "tools/gpu_stats in the source tree does this for several GPUs and compares the\n"
        "results with the record.\n\n"
        "Examples:\n"
        "  candelabra bench pipelines\n"
        "  candelabra bench pipelines --kernels shade_tiles --types sphere --methods conic");
}

} // namespace candelabra::app
