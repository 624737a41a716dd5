// SPDX-License-Identifier: Apache-2.0
// candelabra profile: measures the time of every pass of a frame, and whether one way of drawing it
// is faster than another.
#include <algorithm>
#include <numeric>
#include <optional>

#include <fmt/format.h>
#include <spdlog/spdlog.h>

#include "commands/commands.h"
#include "commands/messages.h"
#include "io/error.h"
#include "io/progress.h"
#include "io/statistics.h"
#include "io/table.h"
#include "load/load.h"
#include "measure/frame/frames.h"
#include "measure/frame/light_costs.h"
#include "measure/profile/profile_frames.h"
#include "measure/profile/run_file.h"
#include "measure/profile/what_if.h"
#include "render/camera.h"
#include "render/provenance.h"

namespace candelabra::app
{
namespace
{

struct ProfileArguments {
    DeviceArguments device;
    SceneArguments scene;
    FrameArguments frame;
    std::string frames = "60", warmUp = "0", framesInFlight = "1", path = "still";
    std::string json, csv, lightCosts, whatIf;
    std::vector<std::string> ab;
    bool append = false;
};

// Returns the frame's options after those in `text` have replaced options of the command line.
FrameOptions variantOptions(const FrameArguments& base, const std::string& text)
{
    FrameArguments frame = base;
    CLI::App app;
    frame.addTo(app);
    frame.addCullingTo(app);
    frame.addInfluenceTo(app);
    frame.specular = base.specular;
    const auto refuse = [&](const std::string& why) {
        throw UsageError(fmt::format("--ab \"{}\": {}", text, why));
    };
    try {
        app.parse(text, false);
    } catch (const CLI::ParseError& error) {
        refuse(parserSentence(app, error));
    }
    if (frame.size != base.size || frame.camera != base.camera || frame.gbuffer != base.gbuffer ||
        frame.lightsVisible != base.lightsVisible)
        refuse("size, camera, G-buffer layout and visible lights must be the same for both");
    try {
        return frame.frameOptions();
    } catch (const UsageError& error) {
        refuse(error.what());
        throw;
    }
}

struct ProfilePlan {
    SceneOptions scene;
    std::vector<std::string> names;
    CndGBufferLayout gbufferLayout;
    ProfileSettings settings;
    uint32_t shadows = 0; // of all variants that have shadows
    std::optional<uint32_t> lightCosts;
    std::optional<WhatIf> whatIf; // the second variant
};

void requireCountablePairs(const std::string& option, const ProfileArguments& a)
{
    if (!a.ab.empty() || a.frame.cullingMode() != CND_CULLING_CLUSTERED)
        throw UsageError(option + ": cannot be combined with --ab, which compares variants of its "
                                  "own, or with --culling brute, which has no lists");
    if (a.frame.influenceRule().rule != CND_INFLUENCE_GIVEN)
        throw UsageError(option +
                         ": needs the given influence radii, so it cannot be combined with "
                         "--influence uncut or --influence-error");
}

// Adds the variants that are compared with each other.
void addVariants(const ProfileArguments& a, ProfilePlan& p)
{
    const FrameOptions frame = a.frame.frameOptions();
    p.names = {"A", "B"};
    if (p.whatIf) {
        p.settings.variants = {frame, frame};
        if (!p.whatIf->changesLights())
            p.settings.variants[1].specular = p.whatIf->method;
    }
    for (const std::string& text : a.ab)
        p.settings.variants.push_back(variantOptions(a.frame, text));
    const uint32_t first = p.settings.variants[0].shadows, second = p.settings.variants[1].shadows;
    if (first && second && first != second)
        throw UsageError("--ab: both have shadows, which must be found for as many points");
    p.shadows = std::max(first, second);
}

ProfilePlan planProfile(const ProfileArguments& a)
{
    for (const auto& [option, file] : {std::pair{"--csv", &a.csv}, {"--json", &a.json}})
        if (!file->empty())
            requireWritable(option, *file);
    if (!a.csv.empty() && a.csv == a.json)
        throw UsageError(fmt::format("--json {}: --csv writes there", a.json));
    if (a.append) {
        if (a.json.empty() || a.json == "-")
            throw UsageError("--append: needs --json with a file");
        if (!a.ab.empty() || !a.whatIf.empty())
            throw UsageError(
                fmt::format("--append: {} compares by itself, and its results are not collected",
                            a.ab.empty() ? "--what-if" : "--ab"));
        withRun(a.json, {}); // throws if the file holds something else than runs
    }
    const uint32_t rounds = unsignedOption("--frames", a.frames, 1, 1'000'000);
    const uint32_t inFlight =
        unsignedOption("--frames-in-flight", a.framesInFlight, 1, maxFramesInFlight);
    ProfilePlan p{
        .scene = a.scene.options(a.scene.lightCount()),
        .gbufferLayout = a.frame.gbufferLayout(),
        .settings = {.path = choose("--path", a.path, cameraPathChoices),
                     .rounds = rounds,
                     .warmUpSeconds = numberOption("--warm-up", a.warmUp, 0, maxWarmUpSeconds),
                     .framesInFlight = inFlight}};
    if (!a.lightCosts.empty()) {
        p.lightCosts = unsignedOption("--light-costs", a.lightCosts, 1, 1'000'000);
        requireCountablePairs("--light-costs", a);
    }
    if (!a.whatIf.empty()) {
        p.whatIf = parseWhatIf(a.whatIf);
        requireCountablePairs("--what-if", a);
    }
    if (a.ab.empty() && !p.whatIf) {
        p.names = {"frame"};
        p.settings.variants = {a.frame.frameOptions()};
        p.shadows = p.settings.variants[0].shadows;
        return p;
    }
    if (p.settings.rounds < minPairs)
        throw UsageError(fmt::format("--frames {}: {} needs at least {}, because fewer pairs have "
                                     "no interval of 95%",
                                     a.frames, p.whatIf ? "--what-if" : "--ab", minPairs));
    addVariants(a, p);
    return p;
}

// What a profile has found, for text and JSON.
struct ProfileResult {
    Profile profile;
    std::optional<LightCosts> costs;
    std::optional<WhatIfPairs> whatIf;
};

Json profileJson(const ProgramContext& program, const ProfileArguments& a, const ProfilePlan& p,
                 const VulkanContext& context, const Scene& scene, const Renderer& renderer,
                 const ProfileResult& found)
{
    const Profile& profile = found.profile;
    Json variants = Json::array();
    for (size_t v = 0; v < p.names.size(); ++v) {
        Json one{{"name", p.names[v]}};
        if (!a.ab.empty())
            one["options"] = a.ab[v];
        one["settings"] = toJson(p.settings.variants[v], p.gbufferLayout);
        one["time"] = toJson(profile.series[v]);
        one["overhead"] = overheadJson(profile.series[v], profile.stampMs);
        one["lighting"] = toJson(profile.last[v].lighting);
        one["drawnTriangles"] = profile.drawnTriangles[v];
        variants.push_back(one);
    }
    Json out{{"schema", profileSchema},
             {"provenance", provenance(context.info(), program.commandLine)},
             {"scene", sceneJson(scene, renderer)},
             {"image",
              {{"widthPixels", renderer.size().width}, {"heightPixels", renderer.size().height}}},
             {"path", a.path},
             {"framesInFlight", p.settings.framesInFlight},
             {"warmUp",
              {{"rounds", profile.warmUpRounds},
               {"secondsAtLeast", p.settings.warmUpSeconds},
               {"settled", profile.settled}}},
             {"variants", variants}};
    if (p.names.size() == 2)
        out["comparison"] = comparisonJson(profile.series[0], profile.series[1]);
    if (found.costs)
        out["lightCosts"] = lightCostJson(*found.costs, scene, *p.lightCosts,
                                          medianOf(profile.series[0].shadingMs()));
    if (found.whatIf)
        out["whatIf"] = whatIfJson(*p.whatIf, *found.whatIf, profile);
    return out;
}

// The times of the passes. `all` is the number of triangles of all instances.
std::string timesText(const ProfileArguments& a, const Profile& profile, uint64_t all)
{
    const std::vector<uint64_t>& counts = profile.drawnTriangles; // one per variant
    std::string drawn = fmt::format("The first frame draws {}", grouped(counts.front()));
    if (counts.back() != counts.front())
        drawn += fmt::format(" (A) and {} (B)", grouped(counts.back()));
    drawn += fmt::format(" of {} triangles.\n", grouped(all));
    if (profile.series.size() == 1)
        return seriesTable(profile.series[0]).text() +
               overheadText(profile.series[0], profile.stampMs) + drawn;
    const auto shown = [](const std::string& options) {
        return options.empty() ? std::string("the options of the command line") : options;
    };
    return fmt::format("A: {}\nB: {}\n", shown(a.ab.empty() ? "" : a.ab[0]),
                       a.ab.empty() ? "--what-if " + a.whatIf : shown(a.ab[1])) +
           comparisonTable(profile.series[0], profile.series[1]) +
           "A pair is a frame of A and the frame of B drawn next to it. Each row has its own 95% "
           "interval: of twenty rows without a difference, one is called faster or slower by "
           "chance.\n" +
           drawn;
}

std::string profileText(const ProfileArguments& a, const ProfilePlan& p, const Scene& scene,
                        const ProfileResult& found, uint64_t triangles)
{
    const Profile& profile = found.profile;
    std::string out = timesText(a, profile, triangles);
    if (found.costs)
        out += "\n" + lightCostTable(*found.costs, scene, *p.lightCosts,
                                     medianOf(profile.series[0].shadingMs()))
                          .text();
    if (found.whatIf)
        out += "\n" + whatIfText(*p.whatIf, *found.whatIf, profile);
    return out;
}

// Returns the lights that --what-if changes: those that --light-costs lists, or all.
std::vector<uint32_t> lightsToChange(const ProfilePlan& p, const std::optional<LightCosts>& costs,
                                     const Scene& scene)
{
    std::vector<uint32_t> out;
    if (!costs) {
        out.resize(scene.lights.size());
        std::iota(out.begin(), out.end(), 0);
        return out;
    }
    for (const LightCost& light : costs->lights)
        if (out.size() < *p.lightCosts)
            out.push_back(light.light);
    return out;
}

// Draws the frames of all variants. With --what-if, the second one is drawn by a renderer of its
// own, for the scene with the change.
ProfileResult measureProfile(const VulkanContext& context, Renderer& renderer, const Scene& scene,
                             const RendererOptions& options, const ProfilePlan& p, bool quiet)
{
    ProfileResult out;
    ProfileSettings settings = p.settings;
    const std::vector<FrameOptions>& variants = settings.variants;
    if (p.lightCosts)
        out.costs = lightCosts(context, renderer, scene, variants[0]);
    ChangedScene changed;
    std::optional<Renderer> other;
    if (p.whatIf && p.whatIf->changesLights()) {
        changed = changedScene(scene, lightsToChange(p, out.costs, scene), *p.whatIf);
        settings.other = &other.emplace(context, changed.scene, options);
    }
    {
        Progress progress(p.settings.rounds + maxWarmUp, !quiet);
        progress.doing("profiling");
        out.profile = profileFrames(context, renderer, settings, [&] { progress.advance(1); });
    }
    if (!out.profile.settled)
        spdlog::warn("warning: times were not stable after {} of warming up; the machine is busy",
                     counted(out.profile.warmUpRounds, "frame"));
    if (p.whatIf)
        out.whatIf = {.lights = scene.lights.size(),
                      .changed = std::move(changed.changed),
                      .kept = std::move(changed.kept),
                      .a = evaluatedPairs(context, renderer, variants[0]),
                      .b = evaluatedPairs(context, other ? *other : renderer, variants[1])};
    return out;
}

int profile(const ProgramContext& program, const ProfileArguments& a)
{
    ProfilePlan p = planProfile(a);
    a.scene.warnOfIdleOptions(p.scene.lights);
    a.device.requireRoomFor(p.scene.lights.value_or(0));
    const Scene scene = loadScene(a.scene.scene, p.scene);
    logWarnings(scene);
    if (p.shadows)
        warnOfShadows(scene);
    requireSomethingToDraw(scene, a.scene.scene);
    const Camera camera = selectCamera(scene, a.frame.camera);
    const PixelSize size = a.frame.pixelSize(scene, camera);
    makeCamera(camera, double(size.width) / size.height); // throws before a device is created
    uint32_t methods = 0;
    bool byError = false;
    for (FrameOptions& options : p.settings.variants) {
        options.camera = camera;
        options.lightsVisible = a.frame.lightsVisibleOverride().value_or(scene.lightsVisible);
        methods |= 1u << options.specular;
        byError |= options.influence.rule == CND_INFLUENCE_BY_ERROR;
    }
    p.settings.moving = !scene.lightMotions.empty();

    const VulkanContext context(a.device.contextOptions());
    spdlog::info("{}: {}, {}, {}x{}, {}, on {}", scene.name, counted(scene.lights.size(), "light"),
                 p.shadows ? "with shadows" : "no shadows", size.width, size.height,
                 counted(p.settings.rounds, "frame"), context.info().name);
    const RendererOptions options{.size = size,
                                  .gbufferLayout = p.gbufferLayout,
                                  .framesInFlight = p.settings.framesInFlight,
                                  .specularMethods = methods,
                                  .shadows = p.shadows,
                                  .influenceByError = byError,
                                  .stamps = true};
    Renderer renderer(context, scene, options);
    const ProfileResult found = measureProfile(context, renderer, scene, options, p, program.quiet);
    if (a.json != "-" && a.csv != "-")
        writeText("-", profileText(a, p, scene, found, renderer.triangleCount()));
    if (!a.csv.empty())
        writeText(a.csv, toCsv(p.names, found.profile.series));
    if (!a.json.empty()) {
        const Json run = profileJson(program, a, p, context, scene, renderer, found);
        writeJson(a.json, a.append ? withRun(a.json, run) : run);
    }
    return printValidationMessages(context) ? exitFailed : exitOk;
}

} // namespace

void addProfileCommand(CLI::App& app, Run& run)
{
    CLI::App* command =
        app.add_subcommand("profile", "Time every pass of a frame, or compare two ways to draw it");
    const auto a = argumentsOf(*command, run, profile);
    a->scene.addTo(*command);
    a->scene.addLightsTo(*command);
    addOption(*command, "--frames", a->frames, "N",
              "number of frames to measure; warm-up frames come first, until the times are stable "
              "(at most 24, or as --warm-up says)");
    addWarmUpTo(*command, a->warmUp);
    addOption(*command, "--frames-in-flight", a->framesInFlight, "N",
              "number of frames that the CPU records before it waits for the oldest; with 1 the "
              "GPU is idle between frames, and some GPUs lower their clock");
    addChoice(*command, "--path", a->path, cameraPathChoices,
              "path of the camera over all frames; turn turns once around the vertical");
    command
        ->add_option("--ab", a->ab,
                     "compare two variants of the frame, each given as one string of options; "
                     "their frames alternate, and each pass gets a ratio with a 95% interval")
        ->type_name("OPTIONS OPTIONS")
        ->type_size(2); // so that texts may begin with dashes
    addOption(*command, "--csv", a->csv, "FILE",
              "CSV file with all times, one line per frame; - is standard output");
    addOption(*command, "--light-costs", a->lightCosts, "N",
              "list the N lights that take the most shading time, with the pixels that they cover "
              "and the pairs of light and pixel that are evaluated for them");
    addOption(*command, "--what-if", a->whatIf, "CHANGE",
              "predict what a change of lights would do: count the pairs of the first frame, and "
              "time frames with and without it alternately; CHANGE is influence=FACTOR (influence "
              "radii), radius=FACTOR (sizes), off, or method=NAME (--specular of all lights); "
              "influence, radius and off change the lights that --light-costs lists, or all lights "
              "without it");
    addOption(*command, "--json", a->json, "FILE",
              "JSON file with a summary of all times and their provenance; - is standard output");
    command->add_flag("--append", a->append,
                      "add this run to the runs in the --json file, for candelabra compare");
    a->frame.addTo(*command);
    a->frame.addCullingTo(*command);
    a->frame.addInfluenceTo(*command);
    a->device.addTo(*command);
    command->footer(
        "By default, frames are drawn one at a time: each one ends before the next begins.\n"
        "Times of passes are GPU times.\n\n"
        "Examples:\n"
        "  candelabra profile hall --lights 16000\n"
        "  candelabra profile hall --path turn --frames 120 --csv frames.csv\n"
        "  candelabra profile hall --warm-up 2 --frames-in-flight 2 --frames 200\n"
        "  candelabra profile hall --light-costs 20\n"
        "  candelabra profile hall --light-costs 20 --what-if influence=0.5\n"
        "  candelabra profile hall --ab '--specular karis' '--specular conic'\n"
        "  candelabra profile rooms --ab '--shadows off' '--shadows 64'");
}

} // namespace candelabra::app
