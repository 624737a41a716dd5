// SPDX-License-Identifier: Apache-2.0
// candelabra bench visibility: measures what soft shadows cost and how exact they are.
#include <algorithm>

#include <spdlog/spdlog.h>

#include "commands/commands.h"
#include "commands/messages.h"
#include "io/error.h"
#include "io/image.h"
#include "load/load.h"
#include "measure/visibility/visibility.h"
#include "render/camera.h"
#include "render/provenance.h"
#include "render/setting_names.h"
#include "truth/reference_scene.h"

namespace candelabra::app
{
namespace
{

struct VisibilityArguments {
    DeviceArguments device;
    SceneArguments scene;
    FrameArguments frame; // only size and camera are options of this command
    std::string shadows = "64", pixels = "100", rounds = "7";
    std::string directory = "out", json;
    bool pictures = false;
};

int visibility(const ProgramContext& program, const VisibilityArguments& a)
{
    const uint32_t points = choose("--shadows", a.shadows, shadowChoices);
    if (!points)
        throw UsageError("--shadows off: there is nothing to measure; choose 32 or 64");
    const uint32_t pixels = unsignedOption("--pixels", a.pixels, 1, 1'000'000);
    const uint32_t rounds = unsignedOption("--rounds", a.rounds, 1, 10'000);
    SceneOptions options = a.scene.options(a.scene.lightCount());
    options.imageAspect = a.frame.imageAspect();
    a.scene.warnOfIdleOptions(options.lights);
    a.device.requireRoomFor(options.lights.value_or(0));
    const std::string json = benchOutput(a.directory, "--json", a.json, "bench_visibility.json");
    Scene scene = loadScene(a.scene.scene, options);
    logWarnings(scene);
    warnOfShadows(scene);
    for (const std::string& text : leftOutByReference(scene))
        spdlog::warn("warning: {}: {}", scene.name, text);
    requireSomethingToDraw(scene, a.scene.scene);
    lightsAtTime(scene, 0, scene.lights);
    const Camera camera = selectCamera(scene, a.frame.camera);
    const PixelSize size = a.frame.pixelSize(scene, camera);
    const VulkanContext context(a.device.contextOptions());
    const reference::Scene model =
        toReference(scene, camera, double(size.width) / size.height, false);
    spdlog::info("{}: {}, {}, {}x{}, {} points per light, on {}", scene.name,
                 counted(scene.lights.size(), "light"), counted(model.triangles.size(), "triangle"),
                 size.width, size.height, points, context.info().name);
    // Levels of detail would be other surfaces than those of the truth.
    const VisibilitySettings settings{.frame = {.camera = camera,
                                                .lightsVisible = false,
                                                .levels = false,
                                                .shadows = points,
                                                .exposure = defaultExposureSettings()},
                                      .rounds = rounds,
                                      .pixels = pixels,
                                      .pictures = a.pictures};
    const RendererOptions drawn{
        .size = size, .framesInFlight = 1, .shadows = points, .stamps = true};
    Renderer renderer(context, scene, drawn);
    VisibilityCost cost;
    VisibilityErrors errors;
    {
        Progress progress(visibilitySteps(settings), !program.quiet);
        cost = measureVisibilityCost(context, renderer, settings, progress);
        Renderer pointLights(context, withPointLights(scene), drawn);
        cost.rayMs = measureRayMs(context, pointLights, settings, progress);
        errors = measureVisibilityErrors(context, renderer, model, settings, progress);
    }
    Json document{{"schema", "candelabra bench visibility 1"},
                  {"provenance", provenance(context.info(), program.commandLine)},
                  {"scene", scene.name},
                  {"widthPixels", size.width},
                  {"heightPixels", size.height},
                  {"lights", scene.lights.size()},
                  {"points", points},
                  {"rounds", rounds}};
    document.update(visibilityJson(cost, errors));
    writeJson(json, document);
    for (auto [name, picture] : errors.pictures) {
        std::ranges::replace(name, ' ', '-');
        saveImageByExtension(a.directory + "/" + name + ".pfm", picture);
    }
    if (json != "-")
        writeText("-", visibilityText(cost, errors, size) + "All figures: " + json + "\n");
    return printValidationMessages(context) ? exitFailed : exitOk;
}

} // namespace

void addBenchVisibility(CLI::App& bench, Run& run)
{
    CLI::App* command = bench.add_subcommand(
        "visibility", "Measure what soft shadows cost, and their error beside that of rays");
    const auto a = argumentsOf(*command, run, visibility);
    a->scene.addTo(*command);
    a->scene.addLightsTo(*command);
    addChoice(*command, "--shadows", a->shadows, shadowChoices,
              "how many points of each light shadows are found for");
    addOption(*command, "--pixels", a->pixels, "N",
              "number of random pixels that are compared with the truth");
    addOption(*command, "--rounds", a->rounds, "N",
              "rounds; each round draws the frame with and without shadows, and with point lights");
    command->add_flag(
        "--pictures", a->pictures,
        "write the frame, the truth and what the other rows draw at the pixels that are "
        "compared as .pfm files into the folder of --out");
    a->frame.addPlaceTo(*command);
    addBenchOutput(*command, a->directory, a->json, "bench_visibility.json");
    a->device.addTo(*command);
    command->footer(
        "Pairs are of a pixel and a light of its lists that reaches it. The CPU time per pair is\n"
        "what a frame takes more with shadows, over all threads; only a CPU device draws with it.\n"
        "The truth is that of candelabra truth. The other rows multiply the truth of\n"
        "each light without shadows by the share of rays that reach it, in double precision, so\n"
        "their errors are those of the rays and of this product. A ray's time is that of\n"
        "pair_visibility, per pair that asks, if a point light or a directional light replaces\n"
        "each light. All rays of a tile then go to one place, and other pairs ask.\n"
        "Emitters are not drawn.\n\n"
        "Example:\n"
        "  candelabra bench visibility rooms --size 320x180 --pixels 200");
}

} // namespace candelabra::app
