// SPDX-License-Identifier: Apache-2.0
// candelabra bench accuracy: measures the error and the time of every specular method.
#include <algorithm>

#include <fmt/format.h>
#include <spdlog/spdlog.h>

#include "commands/commands.h"
#include "commands/messages.h"
#include "io/error.h"
#include "measure/accuracy/image_level.h"
#include "measure/accuracy/kernel_level.h"
#include "measure/accuracy/thin_lights.h"
#include "render/provenance.h"
#include "scene/scene_options.h"

namespace candelabra::app
{
namespace
{

struct AccuracyArguments {
    DeviceArguments device;
    std::string groups = "300", rounds = "15", seed = "1", samples = "16";
    std::string size = "192x144", frames = "5";
    std::string directory = "out", json;
};

KernelLevelSettings kernelSettings(const AccuracyArguments& a)
{
    KernelLevelSettings s;
    s.groups = unsignedOption("--groups", a.groups, 10, 1'000'000);
    s.seed = unsignedOption("--seed", a.seed, 0, UINT32_MAX);
    s.sampleCount = unsignedOption("--samples", a.samples, 1, 4096);
    s.timing.rounds = unsignedOption("--rounds", a.rounds, 1, 10'000);
    s.timing.seed = s.seed;
    return s;
}

ImageLevelSettings imageSettings(const AccuracyArguments& a)
{
    ImageLevelSettings s;
    s.size = sizeOption("--size", a.size);
    s.rounds = unsignedOption("--frames", a.frames, 1, 10'000);
    s.sampleCount = unsignedOption("--samples", a.samples, 1, 4096);
    return s;
}

int accuracy(const ProgramContext& program, const AccuracyArguments& a)
{
    const KernelLevelSettings kernels = kernelSettings(a);
    const ImageLevelSettings images = imageSettings(a);
    const std::string json = benchOutput(a.directory, "--json", a.json, "bench_accuracy.json");
    const std::string kernelSvg = benchOutput(a.directory, "--out", "", "bench_kernels.svg");
    const std::string imageSvg = benchOutput(a.directory, "--out", "", "bench_images.svg");

    const VulkanContext context(a.device.contextOptions());
    announceBench("accuracy", context);
    const ThinLightSettings thin{.groups = std::clamp(kernels.groups / 6, 10u, 50u),
                                 .seed = kernels.seed};
    KernelLevel level;
    std::vector<ThinLightPoint> thinLights;
    std::vector<ImageScene> scenes;
    {
        Progress kernelProgress(kernelLevelSteps(kernels) + thinLightSteps(thin), !program.quiet);
        level = measureKernelLevel(context, kernels, kernelProgress);
        thinLights = measureThinLights(context, thin, kernelProgress);
        Progress imageProgress(imageLevelSteps(images), !program.quiet);
        scenes = measureImages(context, images, imageProgress);
    }
    writeText(kernelSvg, kernelPlot(level, context.info()));
    writeText(imageSvg, imagePlot(scenes, context.info()));
    writeJson(json, {{"schema", "candelabra bench accuracy 1"},
                     {"provenance", provenance(context.info(), program.commandLine)},
                     {"kernels", kernelJson(kernels, level)},
                     {"thinLights", thinLightJson(thin, thinLights)},
                     {"images", imageJson(images, scenes)}});
    if (json != "-")
        writeText("-", textOf(kernelTables(level)) + "\n" +
                           textOf(std::vector{thinLightTable(thinLights)}) + "\n" +
                           textOf(imageTables(scenes)) +
                           fmt::format("\nLook at {} and {}\n", kernelSvg, imageSvg));
    return printValidationMessages(context) ? exitFailed : exitOk;
}

void addOptions(CLI::App& command, AccuracyArguments& a)
{
    addOption(command, "--groups", a.groups, "N",
              "groups of 89 light directions for sphere lights; other shapes get a third as many");
    addOption(command, "--rounds", a.rounds, "N",
              "rounds of timed kernels; each round runs every variant once");
    addOption(command, "--samples", a.samples, "N", "samples per light of the method \"sampled\"");
    addOption(command, "--size", a.size, "WxH",
              "size of the images that are compared with the truth");
    addOption(command, "--frames", a.frames, "N",
              "timed frames of every method and scene, after one warm-up frame");
    addOption(command, "--seed", a.seed, "N", "seed of the random groups and lights");
    addBenchOutput(command, a.directory, a.json, "bench_accuracy.json");
    a.device.addTo(command);
}

} // namespace

void addBenchAccuracy(CLI::App& bench, Run& run)
{
    CLI::App* command = bench.add_subcommand(
        "accuracy", "Measure the error of every specular method against quadrature, and its time");
    const auto a = argumentsOf(*command, run, accuracy);
    addOptions(*command, *a);
    command->footer("Examples:\n"
                    "  candelabra bench accuracy\n"
                    "  candelabra bench accuracy --groups 1500 --rounds 51 --frames 15");
}

} // namespace candelabra::app
