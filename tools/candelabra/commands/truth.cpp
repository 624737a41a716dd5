// SPDX-License-Identifier: Apache-2.0
// candelabra truth: computes in double precision on the CPU the image that approximations are
// compared with, in one call or in shards that another call merges.
#include <algorithm>
#include <cmath>
#include <memory>
#include <numeric>
#include <utility>

#include <fmt/format.h>
#include <spdlog/spdlog.h>

#include "commands/commands.h"
#include "commands/messages.h"
#include "generate/random.h"
#include "io/error.h"
#include "io/hash.h"
#include "io/progress.h"
#include "io/report.h"
#include "io/table.h"
#include "load/load.h"
#include "reference/render.h"
#include "render/camera.h"
#include "render/readback.h"
#include "render/setting_names.h"
#include "truth/reference_scene.h"
#include "truth/truth_file.h"

namespace candelabra::app
{
namespace
{

struct TruthArguments {
    std::string output, tolerance = "1e-4", threads, shard;
    std::string shadows = "64", shadowSeed = "0", pixels;
    std::vector<std::string> merge;
    std::vector<std::string> notForMerging; // options given that --merge does not use
    SceneArguments scene;
    FrameArguments frame; // only size, camera and visible lights are options of this command
};

// Throws UsageError for display images: they have an exposure and eight bits, so they are not for
// measuring. `whole`: no pixel is missing.
void requireLinearImage(const std::string& path, bool whole)
{
    requireImageExtension("-o", path);
    if (isDisplayName(path))
        throw UsageError("-o " + path + ": a truth is linear radiance; choose .exr, .hdr or .pfm");
    if (lowerExtension(path) == ".hdr" && !whole)
        throw UsageError("-o " + path +
                         ": this format has no NaN for missing pixels; choose .exr or .pfm");
}

void warnOfUnconverged(uint64_t count)
{
    if (count)
        spdlog::warn("warning: {} missed the tolerance", counted(count, "contribution"));
}

int merge(const TruthArguments& a)
{
    if (!a.scene.scene.empty())
        throw UsageError("truth: SCENE and --merge cannot be combined");
    if (!a.notForMerging.empty())
        throw UsageError("truth: " + a.notForMerging[0] +
                         " and --merge cannot be combined: shards are merged as they are");
    requireLinearImage(a.output, true);
    requireWritable("-o", a.output);
    for (const std::string& path : a.merge)
        requireOther("-o", a.output, path);
    std::vector<TruthShard> shards;
    uint64_t unconverged = 0;
    Image image;
    try {
        for (const std::string& path : a.merge) {
            shards.push_back(loadTruthShard(path));
            unconverged += shards.back().unconverged;
        }
        image = mergeTruthShards(a.merge, shards);
    } catch (const ImageError& error) {
        throw UsageError(error.what());
    }
    requireLinearImage(a.output,
                       std::ranges::none_of(image.pixels, [](float x) { return std::isnan(x); }));
    saveImageByExtension(a.output, image);
    spdlog::info("wrote {} from {}", a.output, counted(shards.size(), "shard"));
    warnOfUnconverged(unconverged);
    return exitOk;
}

// Computes the pixels of `shard`. Its other members say what to compute.
void compute(const ProgramContext& program, const reference::Scene& scene,
             reference::TruthOptions options, TruthShard& shard)
{
    const std::vector<uint32_t> rows = shard.rows();
    Progress progress(double(rows.size()), !program.quiet);
    progress.doing("integrating");
    options.onRow = [&] { progress.advance(1); };
    const reference::TruthRows truth =
        reference::renderTruth(scene, shard.width, shard.height, rows, options);
    shard.unconverged = truth.unconverged;
    shard.pixels.reserve(3 * truth.pixels.size());
    for (const glm::dvec3& pixel : truth.pixels)
        for (int i = 0; i < 3; ++i)
            shard.pixels.push_back(float(pixel[i]));
}

// Chooses `count` pixels at random, or all of them. The choice depends on nothing but the size and
// the count, and a smaller one is part of a larger one.
std::vector<bool> chosenPixels(const PixelSize& size, uint32_t count)
{
    std::vector<uint32_t> order(size_t{size.width} * size.height);
    std::iota(order.begin(), order.end(), 0u);
    const auto pixels = uint32_t(order.size());
    std::vector<bool> chosen(pixels);
    Random random(1);
    for (uint32_t i = 0; i < std::min(count, pixels); ++i) {
        std::swap(order[i], order[i + random.below(pixels - i)]);
        chosen[order[i]] = true;
    }
    return chosen;
}

reference::TruthOptions truthOptions(const TruthArguments& a)
{
    return {.relative = numberOption("--tolerance", a.tolerance, 1e-9, 1e-2),
            .threads = a.threads.empty() ? 0 : unsignedOption("--threads", a.threads, 1, 1024),
            .shadows = choose("--shadows", a.shadows, shadowChoices) > 0,
            .seed = unsignedOption("--shadow-seed", a.shadowSeed, 0, UINT32_MAX)};
}

Scene sceneOf(const TruthArguments& a, bool shadows)
{
    SceneOptions options = a.scene.options(a.scene.lightCount());
    options.imageAspect = a.frame.imageAspect();
    a.scene.warnOfIdleOptions(options.lights);
    Scene scene = loadScene(a.scene.scene, options);
    logWarnings(scene);
    if (shadows)
        warnOfShadows(scene);
    for (const std::string& text : leftOutByReference(scene))
        spdlog::warn("warning: {}: {}", scene.name, text);
    lightsAtTime(scene, 0, scene.lights);
    return scene;
}

int truth(const ProgramContext& program, const TruthArguments& a)
{
    if (a.output.empty())
        throw UsageError("truth: there is nothing to write; give -o FILE");
    if (!a.merge.empty())
        return merge(a);
    if (a.scene.scene.empty())
        throw UsageError("truth: give a SCENE, or shards with --merge");
    const ShardNumber number = shardNumber(a.shard);
    if (a.shard.empty())
        requireLinearImage(a.output, a.pixels.empty());
    requireWritable("-o", a.output);
    requireOther("-o", a.output, a.scene.scene);
    reference::TruthOptions options = truthOptions(a);
    const uint32_t pixels =
        a.pixels.empty() ? 0 : unsignedOption("--pixels", a.pixels, 1, UINT32_MAX);
    const Scene scene = sceneOf(a, options.shadows);
    const Camera camera = selectCamera(scene, a.frame.camera);
    const PixelSize size = a.frame.pixelSize(scene, camera);
    const reference::Scene model =
        toReference(scene, camera, double(size.width) / size.height,
                    a.frame.lightsVisibleOverride().value_or(scene.lightsVisible));
    TruthShard shard{.width = size.width,
                     .height = size.height,
                     .tolerance = options.relative,
                     .index = number.index,
                     .count = number.count};
    Hash hash;
    hash.add(referenceHash(model, options));
    hash.add(pixels);
    shard.scene = hash.value();
    if (pixels)
        options.wanted = [chosen = chosenPixels(size, pixels), size](uint32_t x, uint32_t y) {
            return chosen[size_t{y} * size.width + x];
        };

    spdlog::info("{}: {}, {}, {}, shadows {}, {}x{}, relative tolerance {:g}", scene.name,
                 counted(scene.lights.size(), "light"),
                 counted(scene.analyticObjects.size(), "object"),
                 counted(model.triangles.size(), "triangle"), options.shadows ? "on" : "off",
                 size.width, size.height, shard.tolerance);
    compute(program, model, options, shard);
    if (a.shard.empty())
        saveImageByExtension(a.output, {shard.width, shard.height, 3, shard.pixels});
    else
        saveTruthShard(a.output, shard);
    spdlog::info("wrote {}", a.output);
    warnOfUnconverged(shard.unconverged);
    return exitOk;
}

} // namespace

void addTruthCommand(CLI::App& app, Run& run)
{
    CLI::App* command = app.add_subcommand(
        "truth", "Integrate the light of a scene in double precision on the CPU");
    const auto a = std::make_shared<TruthArguments>();
    a->scene.addTo(*command);
    command->get_option("scene")->required(false); // --merge has none
    a->scene.addLightsTo(*command);
    addOption(*command, "-o,--output", a->output, "FILE",
              "image file for linear scene radiance (cd/m^2): .exr, .hdr or .pfm; with --shard, a "
              "file with any name for --merge");
    addOption(*command, "--tolerance", a->tolerance, "T",
              "relative tolerance of every light's contribution, 1e-9 to 1e-2");
    addChoice(*command, "--shadows", a->shadows, shadowChoices,
              "whether surfaces stop light; 32 and 64 mean the same here: points are added until a "
              "pixel changes by less than 0.1%");
    addOption(*command, "--shadow-seed", a->shadowSeed, "S",
              "another set of the points of lights that shadows are integrated with");
    addOption(*command, "--pixels", a->pixels, "N",
              "compute only N pixels, chosen at random but always the same for one size; the "
              "others become NaN (.exr and .pfm)");
    a->frame.addViewTo(*command);
    addOption(*command, "--threads", a->threads, "N", "number of threads; default: one per core");
    addOption(
        *command, "--shard", a->shard, "i/n",
        "compute only every n-th row, starting with row i, so that n machines can share the work");
    command
        ->add_option("--merge", a->merge,
                     "merge the files of all shards, given in any order, into one image")
        ->type_name("FILE...");
    command->footer(
        "Every pixel is evaluated at its centre, as in `candelabra render`. Materials have\n"
        "no textures here, and environments add no light. Apart from that, differences between\n"
        "the two images are errors of the specular method and of shadows and, at meshes, of\n"
        "levels of detail. With conic they are largest where a light crosses the horizon of a\n"
        "surface that is seen at a grazing angle.\n\n"
        "Surfaces cast shadows as in `candelabra render`, from both of their sides; lights cast\n"
        "none. Where a light is hidden in part, 4,096 stratified points of its\n"
        "emitter decide, doubled until the pixel changes by less than 0.1%, up to 65,536.\n\n"
        "Examples:\n"
        "  candelabra truth scene.json -o truth.exr\n"
        "  candelabra truth rooms --pixels 500 -o truth.pfm\n"
        "  candelabra truth scene.json --shard 3/8 -o part3.truth\n"
        "  candelabra truth --merge part*.truth -o truth.exr");
    command->callback([&run, a, command] {
        for (const CLI::Option* option : command->get_options())
            if (const std::string name = option->get_name();
                option->count() && name != "--merge" && name != "--output" && name != "scene")
                a->notForMerging.push_back(name);
        run = [a](const ProgramContext& program) { return truth(program, *a); };
    });
}

} // namespace candelabra::app
