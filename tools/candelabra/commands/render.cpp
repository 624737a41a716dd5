// SPDX-License-Identifier: Apache-2.0
// candelabra render: renders a scene into image files.
#include <algorithm>
#include <filesystem>
#include <memory>
#include <numeric>
#include <optional>
#include <set>

#include <fmt/format.h>
#include <spdlog/spdlog.h>

#include "commands/commands.h"
#include "commands/messages.h"
#include "generate/shadow_cost.h"
#include "io/error.h"
#include "io/numbered_name.h"
#include "io/progress.h"
#include "io/statistics.h"
#include "io/table.h"
#include "load/load.h"
#include "measure/frame/frames.h"
#include "measure/frame/influence_check.h"
#include "measure/frame/pick.h"
#include "render/camera.h"
#include "render/camera_path.h"
#include "render/provenance.h"
#include "render/readback.h"
#include "render/setting_names.h"

namespace candelabra::app
{
namespace
{

struct RenderArguments {
    DeviceArguments device;
    SceneArguments scene;
    FrameArguments frame;
    std::string samples = "auto", bloom = "0", frames, time = "0", fps = "60", path = "still";
    std::string json, pick, shard;
    bool explain = false, edgeFilter = false;
    std::vector<std::string> outputs;
};

// The settings that the arguments give. They are checked before anything is loaded.
struct RenderPlan {
    SceneOptions scene;
    FrameOptions frame;
    bool choosesShadows = false; // the device decides whether the frame has shadows
    CndGBufferLayout gbufferLayout;
    FrameCounts counts;
    std::optional<uint32_t> samples; // of each frame; empty: the device decides
    bool sequence = false;           // every frame is written, to numbered files
    CameraPath path = CameraPath::Still;
    double interval = frameTime; // seconds from frame to frame, if anything moves
    std::optional<PixelPosition> pick;
};

// Returns the same path for the same file, however its path is spelled.
std::filesystem::path canonicalPath(const std::string& path)
{
    std::error_code unknown;
    const std::filesystem::path out = weakly_canonical(std::filesystem::absolute(path), unknown);
    return unknown ? std::filesystem::path(path) : out;
}

// Returns true if the outputs are numbered. Checks that either all or none of them are.
bool isSequence(const RenderArguments& a)
{
    const auto numbered = [](const std::string& output) { return isNumbered(output); };
    if (std::none_of(a.outputs.begin(), a.outputs.end(), numbered))
        return false;
    for (const std::string& output : a.outputs)
        numberedName("-o", output, 0); // throws if there is no place for a number, or two
    if (a.frames.empty())
        throw UsageError("-o " + a.outputs[0] + ": give --frames N, the number of pictures");
    return true;
}

void requireOutputs(const RenderArguments& a)
{
    std::set<std::filesystem::path> files;
    for (const std::string& output : a.outputs) {
        requireImageExtension("-o", output);
        requireWritable("-o", isNumbered(output) ? numberedName("-o", output, 0) : output);
        if (!files.insert(canonicalPath(output)).second)
            throw UsageError("-o " + output + ": this file is written twice");
    }
    if (a.json.empty())
        return;
    requireWritable("--json", a.json);
    if (a.json != "-" && files.count(canonicalPath(a.json)))
        throw UsageError("--json " + a.json + ": -o writes this file");
}

std::optional<PixelPosition> pickedPixel(const RenderArguments& a, const FrameOptions& frame)
{
    if (a.pick.empty())
        return std::nullopt;
    const size_t comma = a.pick.find(',');
    const auto x = parseUnsigned(a.pick.substr(0, comma));
    const auto y =
        comma == std::string::npos ? std::nullopt : parseUnsigned(a.pick.substr(comma + 1));
    if (!x || !y || *x >= maxSide || *y >= maxSide)
        throw UsageError("--pick \"" + a.pick + "\": expected X,Y in pixels such as 640,360");
    const std::string refusal = pickRefusal(frame);
    if (!refusal.empty())
        throw UsageError("--pick: " + refusal);
    return PixelPosition{uint32_t(*x), uint32_t(*y)};
}

// Returns how many samples --aa asks for, or nothing if the device decides.
std::optional<uint32_t> frameSamples(const RenderArguments& a, bool sequence)
{
    const bool heatMap = a.frame.heatMapMode() != HeatMap::None;
    const bool byError = a.frame.influenceRule().rule == CND_INFLUENCE_BY_ERROR;
    if (a.edgeFilter && heatMap)
        throw UsageError("--edge-filter: cannot be combined with --debug, which shows single "
                         "pixels");
    if (a.samples == "auto") {
        const bool timed = !a.frames.empty() && a.frames != "1" && !sequence;
        const bool still = !a.outputs.empty() && !timed;
        return still && !heatMap && !byError && !a.edgeFilter ? std::nullopt : std::optional(1u);
    }
    const uint32_t samples = unsignedOption("--aa", a.samples, 1, maxFrameSamples);
    if (samples > 1 && heatMap)
        throw UsageError("--aa: cannot be combined with --debug, which shows single pixels");
    if (samples > 1 && a.edgeFilter)
        throw UsageError("--aa: cannot be combined with --edge-filter, which smooths the edges of "
                         "frames of one sample");
    if (samples > 1 && byError)
        throw UsageError("--aa: cannot be combined with --influence-error, which follows the "
                         "exposure of the frame before");
    return samples;
}

// Returns the share of the light that --bloom spreads.
float bloomOf(const RenderArguments& a)
{
    const double share = numberOption("--bloom", a.bloom, 0, 1);
    if (share > 0 && a.frame.heatMapMode() != HeatMap::None)
        throw UsageError("--bloom: cannot be combined with --debug, which shows single pixels");
    if (share > 0 && a.frame.influenceRule().rule == CND_INFLUENCE_BY_ERROR)
        throw UsageError("--bloom: cannot be combined with --influence-error, which bounds the "
                         "error of pixels that keep their light");
    return float(share);
}

// Returns how many frames are drawn: all that --frames asks for, or those of the shard.
FrameCounts frameCounts(const RenderArguments& a, bool sequence, bool byError)
{
    // After three frames both slots have an exposure, and the frame before has cut lights.
    FrameCounts out{.warmUp = byError ? 3u : 1u};
    if (!a.frames.empty())
        out.measured = unsignedOption("--frames", a.frames, 1, 1'000'000);
    if (a.shard.empty())
        return out;
    if (!sequence)
        throw UsageError("--shard: give -o a name with a place for the number of each frame, such "
                         "as f.%04d.png");
    if (byError)
        throw UsageError("--shard: cannot be combined with --influence-error, which follows the "
                         "exposure of the frame before");
    const ShardNumber shard = shardNumber(a.shard);
    if (shard.count > out.measured)
        throw UsageError(fmt::format("--shard {}: --frames asks for only {}, fewer than the shards",
                                     a.shard, counted(out.measured, "frame")));
    out.first = shard.index - 1;
    out.step = shard.count;
    return out;
}

bool writesPictures(const RenderArguments& a)
{
    return std::ranges::any_of(a.outputs, isDisplayName);
}

// Throws UsageError if a shard would need the frames of other shards.
void requireKnownExposure(const RenderArguments& a, const CndExposureSettings& exposure)
{
    if (!a.shard.empty() && !exposure.manual && writesPictures(a))
        throw UsageError(
            "--shard: the automatic exposure of a frame follows from the frames before "
            "it; give --exposure EV");
}

RenderPlan planRender(const RenderArguments& a)
{
    if (a.outputs.empty() && a.json.empty() && a.pick.empty() && !a.explain)
        throw UsageError("render: there is nothing to write; give -o FILE (.png, .exr, .hdr, "
                         ".pfm), --json FILE, --pick X,Y or --explain");
    requireOutputs(a);
    const bool sequence = isSequence(a);
    FrameOptions frame = a.frame.frameOptions();
    frame.time = numberOption("--time", a.time, -1e9, 1e9);
    frame.bloom = bloomOf(a);
    frame.edgeFilter = a.edgeFilter;
    const bool byError = frame.influence.rule == CND_INFLUENCE_BY_ERROR;
    if (byError && frame.specular == CND_SPECULAR_SAMPLED)
        throw UsageError("--influence-error: cannot be combined with --specular sampled, whose "
                         "noise hides the error");
    SceneOptions scene = a.scene.options(a.scene.lightCount());
    scene.imageAspect = a.frame.imageAspect();
    return {.scene = scene,
            .frame = frame,
            .choosesShadows = !a.frame.shadowPoints(),
            .gbufferLayout = a.frame.gbufferLayout(),
            .counts = frameCounts(a, sequence, byError),
            .samples = frameSamples(a, sequence),
            .sequence = sequence,
            .path = choose("--path", a.path, cameraPathChoices),
            .interval = 1 / numberOption("--fps", a.fps, 0.01, 1000),
            .pick = pickedPixel(a, frame)};
}

// The statistics of the last frame, with its pairs counted if it has lists.
CndLightingStats countedStats(const RenderPlan& p, const VulkanContext& context, Renderer& renderer,
                              const MeasuredFrames& frames)
{
    if (p.frame.culling != CND_CULLING_CLUSTERED)
        return frames.last.lighting;
    FrameOptions again = p.frame;
    again.exposure.manual = VK_TRUE; // so that counting does not change the adapted exposure
    again.exposure.manualEv100 = frames.last.exposure.adaptedEv100;
    return countPairs(context, renderer, again);
}

Json renderJson(const ProgramContext& program, const RenderArguments& a, const RenderPlan& p,
                const VulkanContext& context, const Scene& scene, Renderer& renderer,
                const MeasuredFrames& frames, const std::optional<Pick>& picked,
                const std::optional<InfluenceCheck>& cut)
{
    const PixelSize size = renderer.size();
    const CndLightingStats lighting = countedStats(p, context, renderer, frames);
    Json out{{"schema", "candelabra render 1"},
             {"provenance", provenance(context.info(), program.commandLine)},
             {"scene", sceneJson(scene, renderer)},
             {"image", {{"widthPixels", size.width}, {"heightPixels", size.height}}},
             {"settings", toJson(p.frame, p.gbufferLayout)},
             {"warmUpFrames", p.counts.warmUp},
             {"samplesPerFrame", p.counts.samples},
             {"gpuTime", toJson(frames.times)},
             {"plan", toJson(frames.last.plan)},
             {"lighting", toJson(lighting)},
             {"exposure", toJson(frames.last.exposure)},
             {"outputs", a.outputs}};
    if (picked)
        out["pick"] = toJson(*picked, scene);
    if (cut)
        out["influence"] = toJson(*cut);
    return out;
}

// Says how many lights the pixels with a surface have, if the heat map shows that.
std::string heatMapText(HeatMap which, const std::vector<glm::vec4>& pairs, PixelSize size)
{
    const bool listed = which == HeatMap::LightsPerPixel;
    if (!listed && which != HeatMap::Evaluated)
        return "";
    std::vector<double> counts;
    size_t most = 0; // the index of the pixel with the most lights
    const auto countOf = [&](const glm::vec4& p) { return double(listed ? p.x : p.y); };
    for (size_t i = 0; i < pairs.size(); ++i) {
        if (pairs[i].w == 0) // The pixel has no surface.
            continue;
        counts.push_back(countOf(pairs[i]));
        if (counts.size() == 1 || countOf(pairs[i]) > countOf(pairs[most]))
            most = i;
    }
    if (counts.empty())
        return "No pixel has a surface.\n";
    const double mean = std::accumulate(counts.begin(), counts.end(), 0.0) / double(counts.size());
    return fmt::format("A pixel with a surface {} {} lights on average; 99% of them have at most "
                       "{}; the most are {}, at {},{}.\n",
                       listed ? "lists" : "evaluates or waits for", threeDigits(mean),
                       spreadOf(counts).p99, countOf(pairs[most]), most % size.width,
                       most / size.width);
}

// Prints and writes what is asked about the last frame, whose options are those of the plan.
int reportLastFrame(const ProgramContext& program, const RenderArguments& a, const RenderPlan& p,
                    const VulkanContext& context, const Scene& scene, Renderer& renderer,
                    const MeasuredFrames& frames)
{
    if (p.frame.heatMap != HeatMap::None && a.json != "-")
        writeText("-", heatMapText(p.frame.heatMap, readPairs(context, renderer), renderer.size()));
    std::optional<Pick> picked;
    if (p.pick) {
        picked = pickPixel(context, renderer, scene, p.frame, *p.pick);
        if (a.json != "-")
            writeText("-", pickText(*picked, scene));
    }
    std::optional<InfluenceCheck> cut;
    if (p.frame.influence.rule == CND_INFLUENCE_BY_ERROR) {
        cut = checkInfluence(context, renderer, p.frame, frames.last, scene.lights.size());
        if (a.json != "-")
            writeText("-", influenceText(*cut));
    }
    if (a.explain && a.json != "-") {
        writeText("-", planText(frames.last));
        if (p.frame.shadows)
            writeText("-", shadowText(countedStats(p, context, renderer, frames), renderer.size()));
    }
    if (a.json != "-" && !program.quiet && frames.times.frames())
        writeText("-", passTable(frames.times));
    if (!a.json.empty())
        writeJson(a.json, renderJson(program, a, p, context, scene, renderer, frames, picked, cut));
    return printValidationMessages(context) ? exitFailed : exitOk;
}

// Gives the frame shadows unless they take too long on a CPU, and says so then. A picture takes the
// time of the warm-up frames too.
void chooseShadows(const Scene& scene, PixelSize size, const VulkanContext& context, RenderPlan& p)
{
    double seconds = 0;
    if (context.info().type == VK_PHYSICAL_DEVICE_TYPE_CPU)
        seconds = (p.counts.warmUp + p.counts.samples) *
                  secondsOnCores(shadowCpuSeconds(scene, p.frame.camera, size,
                                                  p.frame.influence.rule == CND_INFLUENCE_UNCUT));
    if (seconds <= mostShadowSeconds)
        p.frame.shadows = usualShadowPoints;
    else
        spdlog::info("{}", shadowsLeftOutText(seconds));
}

// Says what will be rendered. `filters`: the edges of pictures are filtered, because the device is
// a CPU and they have one sample.
void printScene(const Scene& scene, PixelSize size, const VulkanContext& context, uint32_t samples,
                bool filters)
{
    spdlog::info("{}: {}, {}, {}x{}, {}, on {}", scene.name, counted(scene.lights.size(), "light"),
                 counted(scene.instances.size() + scene.analyticObjects.size(), "object"),
                 size.width, size.height,
                 samples > 1 ? fmt::format("{} samples per pixel", samples) : "1 sample per pixel",
                 context.info().name);
    if (filters)
        spdlog::info("a filter smooths the edges of .png files, because the device is a CPU; --aa "
                     "{} is better and also smooths linear files, but takes {} times as long",
                     pictureSamples, pictureSamples);
}

// Draws all frames, and writes pictures of the last one or, of a sequence, of each.
MeasuredFrames drawFrames(const ProgramContext& program, const RenderArguments& a,
                          const RenderPlan& p, const Camera& first, bool moving,
                          const VulkanContext& context, Renderer& renderer)
{
    Progress progress(p.counts.warmUp + double(p.counts.drawn()) * p.counts.samples,
                      !program.quiet);
    progress.doing("rendering");
    FrameHooks hooks;
    hooks.prepare = [&](uint32_t frame, FrameOptions& options) {
        options.camera = cameraAt(first, p.path, frame, p.counts.measured);
    };
    if (p.sequence)
        hooks.finished = [&](uint32_t frame) {
            for (const std::string& output : a.outputs)
                saveFrame(context, renderer, numberedName("-o", output, frame));
        };
    return renderFrames(
        context, renderer, p.frame, p.counts, moving, [&] { progress.advance(1); }, hooks,
        p.interval);
}

// Writes pictures of the last frame, unless the frames of a sequence are written already.
void writePictures(const RenderArguments& a, const RenderPlan& p, const VulkanContext& context,
                   const Renderer& renderer)
{
    if (p.sequence)
        spdlog::info("wrote {}", counted(p.counts.drawn(), "frame"));
    else
        for (const std::string& output : a.outputs) {
            saveFrame(context, renderer, output);
            spdlog::info("wrote {}{}", output,
                         p.frame.heatMap != HeatMap::None && !isDisplayName(output)
                             ? "; it has the radiance, because --debug changes only .png files"
                             : "");
        }
}

int render(const ProgramContext& program, const RenderArguments& a)
{
    RenderPlan p = planRender(a);
    a.scene.warnOfIdleOptions(p.scene.lights);
    a.device.requireRoomFor(p.scene.lights.value_or(0));
    const Scene scene = loadScene(a.scene.scene, p.scene);
    logWarnings(scene);
    requireSomethingToDraw(scene, a.scene.scene);
    const Camera first = a.frame.chosenCamera(scene);
    p.frame.camera = first;
    const bool evIsGiven = p.frame.exposure.manual;
    useKnownExposure(scene, p.frame.exposure);
    requireKnownExposure(a, p.frame.exposure);
    p.frame.lightsVisible = a.frame.lightsVisibleOverride().value_or(scene.lightsVisible);
    const PixelSize size = a.frame.pixelSize(scene, p.frame.camera);
    makeCamera(p.frame.camera,
               double(size.width) / size.height); // throws before a device is created
    if (p.pick && (p.pick->x >= size.width || p.pick->y >= size.height))
        throw UsageError(
            fmt::format("--pick {}: the image has {}x{} pixels", a.pick, size.width, size.height));

    const VulkanContext context(a.device.contextOptions());
    const bool isGpu = context.info().type != VK_PHYSICAL_DEVICE_TYPE_CPU;
    p.counts.samples = p.samples.value_or(isGpu ? pictureSamples : 1);
    const bool filters = !p.samples && !isGpu && writesPictures(a);
    p.frame.edgeFilter |= filters;
    printScene(scene, size, context, p.counts.samples, filters);
    if (p.choosesShadows)
        chooseShadows(scene, size, context, p);
    if (p.frame.shadows)
        warnOfShadows(scene);
    Renderer renderer(context, scene,
                      {.size = size,
                       .gbufferLayout = p.gbufferLayout,
                       .specularMethods = 1u << p.frame.specular,
                       .shading = shadingOf(p.frame),
                       .shadows = p.frame.shadows,
                       .influenceByError = p.frame.influence.rule == CND_INFLUENCE_BY_ERROR});
    const bool moving = !scene.lightMotions.empty() || p.path != CameraPath::Still;
    const MeasuredFrames frames = drawFrames(program, a, p, first, moving, context, renderer);
    if (!p.sequence)
        spdlog::info("{}", exposureText(p.frame.exposure, scene, evIsGiven, frames.last.exposure));
    writePictures(a, p, context, renderer);
    // What follows looks at the last frame.
    const uint32_t last = p.counts.first + (p.counts.drawn() - 1) * p.counts.step;
    p.frame.camera = cameraAt(first, p.path, last, p.counts.measured);
    p.frame.time += moving ? p.interval * last : 0;
    return reportLastFrame(program, a, p, context, scene, renderer, frames);
}

// Adds the options of how pictures are made of frames.
void addPictureOptions(CLI::App& command, RenderArguments& a)
{
    addOption(command, "--aa", a.samples, "N|auto",
              "anti-aliasing: a frame is the mean of N samples, each shifted by part of a pixel "
              "and lit again; linear files get the mean radiance, pictures the mean light of the "
              "display; auto is 16 for pictures on a GPU; on a CPU it is 1, with --edge-filter; it "
              "is also 1 for several --frames that are only timed, and with --edge-filter, --debug "
              "or --influence-error");
    addOption(command, "--bloom", a.bloom, "SHARE",
              "share of the light, 0 to 1, that is spread over the picture as an eye scatters it, "
              "to make lamps look bright; 0.04 to 0.2 look natural; linear files and the metering "
              "of exposure leave it out");
    command.add_flag("--edge-filter", a.edgeFilter,
                     "smooth the edges of .png files with one sample per pixel, in a fraction of "
                     "the time of --aa; linear files keep their edges");
}

} // namespace

void addRenderCommand(CLI::App& app, Run& run)
{
    CLI::App* command = app.add_subcommand("render", "Render a scene into image files");
    const auto a = std::make_shared<RenderArguments>();
    a->scene.addTo(*command);
    a->scene.addLightsTo(*command);
    a->scene.addDefaultLightTo(*command);
    command
        ->add_option("-o,--output", a->outputs,
                     "image file: .png for the display image, .exr, .hdr or .pfm for linear scene "
                     "radiance (cd/m^2) before exposure; may be given several times")
        ->type_name("FILE");
    addOption(*command, "--frames", a->frames, "N",
              "number of frames to render and time, after a warm-up frame like the first (1); -o "
              "writes all of them if its name has a place for their number, such as f.%04d.png, "
              "and otherwise only the last");
    addPictureOptions(*command, *a);
    addChoice(*command, "--path", a->path, cameraPathChoices,
              "path of the camera over all frames; turn turns once around the vertical");
    addOption(*command, "--fps", a->fps, "N",
              "frames per second, for moving lights and for the adaptation of the eye");
    addOption(*command, "--time", a->time, "SECONDS",
              "scene time of the first frame in seconds, for --moving");
    addOption(*command, "--shard", a->shard, "i/n",
              "draw only every n-th frame, starting with frame i, so that n machines can share a "
              "sequence");
    addOption(*command, "--json", a->json, "FILE",
              "JSON file with times, statistics and their provenance; - is standard output");
    addOption(*command, "--pick", a->pick, "X,Y",
              "list the lights of the pixel X,Y, counted from the left and the top, with the "
              "contribution of each and its error against the reference in double precision; with "
              "shadows, also which share of it is visible there, and what hides it");
    command->add_flag(
        "--explain", a->explain,
        "list the passes that the last frame ran, and explain why the others had nothing to do");
    a->frame.addAllTo(*command, Reuse::None);
    a->device.addTo(*command);
    command->footer("Examples:\n"
                    "  candelabra render hall --lights 16000 -o hall.png\n"
                    "  candelabra render field --moving --frames 60 -o last.png --json times.json\n"
                    "  candelabra render model.glb --lights 500 --camera 0 -o m.png -o m.exr\n"
                    "  candelabra render hall --camera 0,2,10,0,1,0,60 --exposure 8 -o e.png\n"
                    "  candelabra render hall --pick 640,360\n"
                    "  candelabra render hall --size 320x180 --influence-error 0.5/255 -o cut.png\n"
                    "  candelabra render hall --debug efficiency --explain -o heat.png\n"
                    "  candelabra render rooms --debug shadow -o seen.png\n"
                    "  candelabra render hall --aa 64 --size 1920x1080 -o smooth.png\n"
                    "  candelabra render hall --path turn --frames 240 -o f.%04d.png\n"
                    "  ffmpeg -framerate 60 -i f.%04d.png -pix_fmt yuv420p turn.mp4");
    command->callback(
        [&run, a] { run = [a](const ProgramContext& program) { return render(program, *a); }; });
}

} // namespace candelabra::app
