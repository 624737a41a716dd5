// SPDX-License-Identifier: Apache-2.0
#include "measure/skip.h"

#include <algorithm>
#include <cmath>
#include <functional>
#include <limits>
#include <memory>
#include <numeric>
#include <optional>
#include <vector>

#include <fmt/format.h>

#include "io/table.h"
#include "load/load.h"
#include "measure/frame/brute_check.h"
#include "reference/tone_map.h"
#include "render/camera.h"
#include "render/check.h"
#include "render/readback.h"
#include "render/renderer.h"
#include "scene/polygons.h"
#include "scene/scene_options.h"

namespace candelabra::app
{

namespace
{

// A frame that can be drawn again and again.
struct Drawing {
    std::function<std::vector<PassTime>()> draw; // returns the times of the passes to compare
    // Returns what was drawn last: the radiance, and for whole frames the display image (0..255)
    // too.
    std::function<std::vector<float>()> image;
};

// How a lighting module is used.
struct LightingWay {
    std::function<void(FrameOptions&)> edit = [](FrameOptions&) {};
    bool surfacesUnchanged = false; // CndLightingFrame::surfacesUnchanged from the second frame on
    std::vector<CndLight> before{}; // a light set that it is given first
    bool diffuseOnlyTiles = false;  // CndLightingDesc::diffuseOnlyTiles
    CndInfluence influence{};
};

constexpr uint32_t skipMethods = 1u << CND_SPECULAR_CONIC; // the methods that all frames draw with

// Frames of one scene: different ways to draw it that share a G-buffer.
class SkipStage
{
public:
    // `context` and `scene` must outlive the stage and its drawings.
    SkipStage(const VulkanContext& context, const Scene& scene, PixelSize size);

    using Lights = std::vector<CndLight>;
    const Lights& lights() const { return scene_.lights; }
    const VulkanContext& context() const { return context_; }

    // Draws the lighting alone, by a lighting module of its own that has these lights.
    Drawing lighting(const Lights& lights, const LightingWay& way = {});

    // Changes the options of a frame; `drawn` is how often it has been drawn before.
    using Edit = std::function<void(FrameOptions&, uint32_t drawn)>;
    // Draws whole frames and times the passes for which `counts` returns true.
    Drawing frames(const Edit& edit, const std::function<bool(const std::string& pass)>& counts);
    CndExposureStats exposureStats() const { return renderer_.stats(0).exposure; }

private:
    const VulkanContext& context_;
    const Scene& scene_;
    FrameOptions options_;
    Renderer renderer_;
};

SkipStage::SkipStage(const VulkanContext& context, const Scene& scene, PixelSize size)
    : context_(context),
      scene_(scene),
      options_{.camera = selectCamera(scene, ""), .lightsVisible = false},
      renderer_(context, scene, {.size = size, .specularMethods = skipMethods})
{
    cndDefaultExposureSettings(&options_.exposure);
}

Drawing SkipStage::lighting(const Lights& lights, const LightingWay& way)
{
    struct Own {
        Lighting lighting; // must outlive its view
        LightingView view;
        bool drawn = false;
    };
    FrameOptions options = options_;
    way.edit(options);
    const auto own = std::make_shared<Own>();
    own->lighting = take(Lighting::create(
        context_.desc(), {.framesInFlight = 1,
                          .timestamps = VK_TRUE,
                          .specularMethods = skipMethods,
                          .shading = shadingOf(options),
                          .diffuseOnlyTiles = way.diffuseOnlyTiles,
                          .influenceByError = way.influence.rule == CND_INFLUENCE_BY_ERROR}));
    const auto [width, height] = renderer_.size();
    own->view = take(own->lighting.createView({.maxWidth = width, .maxHeight = height}));
    const glm::dvec3& o = scene_.lightOrigin;
    for (const Lights* set : {&way.before, &lights})
        take(own->lighting.setLights(*set, {o.x, o.y, o.z}));
    const auto draw = [this, own, options, influence = way.influence,
                       promise = way.surfacesUnchanged] {
        CndLightingFrame frame = renderer_.lightingFrame(0, options);
        frame.influence = influence;
        frame.surfacesUnchanged = promise && std::exchange(own->drawn, true);
        context_.submitAndWait([&](VkCommandBuffer cmd) {
            renderer_.recordUnlit(cmd, options);
            take(own->view.record(cmd, frame));
            renderer_.recordBruteEnd(cmd);
        });
        const std::optional<CndLightingStats> stats = take(own->view.stats(0));
        std::vector<PassTime> out;
        for (uint32_t i = 0; stats && i < stats->kernelTimeCount; ++i)
            out.push_back({passName(stats->kernelTimes[i].name), stats->kernelTimes[i].ms});
        return out;
    };
    return {.draw = draw, .image = [this] { return readRadiance(context_, renderer_).pixels; }};
}

Drawing SkipStage::frames(const Edit& edit,
                          const std::function<bool(const std::string& pass)>& counts)
{
    const auto drawn = std::make_shared<uint32_t>(0);
    const auto draw = [this, edit, counts, drawn] {
        FrameOptions options = options_;
        edit(options, (*drawn)++);
        context_.submitAndWait([&](VkCommandBuffer cmd) { renderer_.record(cmd, 0, options); });
        std::vector<PassTime> out;
        for (const PassTime& pass : renderer_.stats(0).passes)
            if (counts(pass.name))
                out.push_back(pass);
        return out;
    };
    const auto image = [this] {
        std::vector<float> out = readRadiance(context_, renderer_).pixels;
        const std::vector<uint8_t> display = readDisplay(context_, renderer_);
        out.insert(out.end(), display.begin(), display.end());
        return out;
    };
    return {.draw = draw, .image = image};
}

using Lights = SkipStage::Lights;

// The greatest ratios of the times with and without a skip.
constexpr double lightingBar = 0.05, pointBar = 1.03;

struct Pair {
    Drawing with, without;
};

struct Skip {
    SkipRow row;
    Pair pair;
    Drawing unskipped; // must give the same image as pair.with
    std::optional<Pair> idle{};
};

Lights dark(Lights lights)
{
    for (CndLight& light : lights)
        std::fill_n(light.emission, 3, 0.0f);
    return lights;
}

Lights raised(Lights lights, float metres)
{
    for (CndLight& light : lights)
        light.position[1] += metres;
    return lights;
}

// Returns point lights in place of the sphere lights, with the same intensity.
Lights points(Lights lights)
{
    for (CndLight& light : lights) {
        const CndLight sphere = light;
        light = take(pointFromSphere(sphere));
    }
    return lights;
}

// Adds one dark light of every type other than point, or as many dark point lights.
Lights withOthers(Lights lights, bool ofOtherTypes)
{
    const CndLight first = lights.front();
    for (uint32_t type = 0; type < CND_LIGHT_TYPE_COUNT; ++type)
        if (type != CND_LIGHT_POINT)
            lights.push_back({.type = ofOtherTypes ? type : uint32_t(CND_LIGHT_POINT),
                              .position = {first.position[0], first.position[1], first.position[2]},
                              .radius = 0.01f,
                              .direction = {0, -1, 0},
                              .influenceRadius = first.influenceRadius,
                              .innerConeAngle = 0.2f,
                              .outerConeAngle = 0.4f,
                              .axisU = {0.02f, 0, 0},
                              .axisV = {0, 0, 0.02f},
                              .polygon = regularPolygon(3)});
    return lights;
}

constexpr float skyHeight = 1e4f; // m; no scene reaches up there

void lookAtSky(FrameOptions& options)
{
    options.camera.position = {0, skyHeight, 0};
    options.camera.forward = {0, 1, 0};
    options.camera.up = {0, 0, 1};
}

bool isExposure(const std::string& pass)
{
    return pass == "luminance_histogram" || pass == "adapt_exposure" || pass == "tone_map";
}

bool isRaster(const std::string& pass)
{
    return pass == "cull_instances" || pass == "compact_instances" || pass == "cull_emitters" ||
           pass == "cull_triangles" || pass == "gbuffer_raster";
}

Skip noLights(SkipStage& stage)
{
    const Drawing darkLights = stage.lighting(dark(stage.lights()));
    return {{.name = "no lights",
             .against = "as many lights, dark",
             .passes = "lighting",
             .bar = lightingBar},
            {stage.lighting({}), darkLights},
            darkLights};
}

// The lights are raised with the camera. Otherwise this would measure that no light is in view.
Skip noSurface(SkipStage& stage)
{
    return {{.name = "no surface in view",
             .against = "the scene in view",
             .passes = "lighting",
             .bar = lightingBar},
            {stage.lighting(raised(stage.lights(), skyHeight), {.edit = lookAtSky}),
             stage.lighting(stage.lights())},
            stage.lighting({}, {.edit = lookAtSky})};
}

Skip lightsOutOfView(SkipStage& stage)
{
    return {
        {.name = "all lights out of view",
         .against = "in view",
         .passes = "lighting",
         .bar = lightingBar},
        {stage.lighting(raised(stage.lights(), 10 * skyHeight)), stage.lighting(stage.lights())},
        stage.lighting(dark(stage.lights()))};
}

Skip otherTypesAbsent(SkipStage& stage)
{
    const Lights lights = points(stage.lights());
    const Drawing others = stage.lighting(withOthers(lights, true));
    return {{.name = "other light types absent",
             .against = "points and one dark light of each",
             .passes = "lighting",
             .bound = BruteCheck::bound},
            {stage.lighting(withOthers(lights, false)), others},
            others};
}

Skip otherTypesNeverMet(SkipStage& stage)
{
    const Lights lights = points(stage.lights());
    const Drawing metBefore = stage.lighting(lights, {.before = withOthers(lights, true)});
    return {{.name = "other light types never met",
             .against = "points, all types met before",
             .passes = "lighting",
             .bar = pointBar},
            {stage.lighting(lights), metBefore},
            metBefore};
}

Skip unchangedLists(SkipStage& stage)
{
    const Drawing again = stage.lighting(stage.lights());
    return {{.name = "lights and surfaces unchanged",
             .against = "lists made again",
             .passes = "lighting"},
            {stage.lighting(stage.lights(), {.surfacesUnchanged = true}), again},
            again};
}

Skip unchangedFrame(SkipStage& still, SkipStage& other)
{
    const auto any = [](const std::string& pass) { return !isExposure(pass); };
    const auto keeping = [](Reuse reuse, bool moving) {
        return [=](FrameOptions& options, uint32_t drawn) {
            options.reuse = reuse;
            options.camera.position.y += moving && drawn % 2 ? 0.001 : 0; // m
        };
    };
    const Drawing again = other.frames(keeping(Reuse::None, false), any);
    return {{.name = "nothing changed", .against = "drawn again", .passes = "raster and lighting"},
            {still.frames(keeping(Reuse::Lighting, false), any), again},
            again,
            Pair{still.frames(keeping(Reuse::Lighting, true), any),
                 other.frames(keeping(Reuse::None, true), any)}};
}

Skip manualExposure(SkipStage& stage)
{
    const Drawing automatic = stage.frames([](FrameOptions&, uint32_t) {}, isExposure);
    automatic.draw();
    const float ev = stage.exposureStats().adaptedEv100;
    const auto fixed = [ev](FrameOptions& options, uint32_t) {
        options.exposure.manual = VK_TRUE;
        options.exposure.manualEv100 = ev;
    };
    return {{.name = "manual exposure", .against = "automatic, the same EV", .passes = "exposure"},
            {stage.frames(fixed, isExposure), automatic},
            automatic};
}

// The skip is looked for without success in the scene as it is, whose surfaces have both lobes.
Skip withoutSpecular(SkipStage& lacking, SkipStage& stage)
{
    const LightingWay apart{.diffuseOnlyTiles = true};
    const Drawing alike = lacking.lighting(lacking.lights());
    return {{.name = "no specular materials",
             .against = "both lobes evaluated",
             .passes = "lighting",
             .bound = BruteCheck::bound},
            {lacking.lighting(lacking.lights(), apart), alike},
            alike,
            Pair{stage.lighting(stage.lights(), apart), stage.lighting(stage.lights())}};
}

Skip noEnvironment(SkipStage& without, SkipStage& black)
{
    const auto lighting = [](const std::string& pass) {
        return !isExposure(pass) && !isRaster(pass);
    };
    const auto as = [](FrameOptions&, uint32_t) {};
    const Drawing shaded = black.frames(as, lighting);
    return {
        {.name = "no environment", .against = "a black one", .passes = "environment and lighting"},
        {without.frames(as, lighting), shaded},
        shaded};
}

std::vector<float> imageOf(const Drawing& drawing)
{
    drawing.draw(); // compiles kernels and uploads lights
    drawing.draw();
    return drawing.image();
}

constexpr double middleGrey = 0.18;

double meanOf(const std::vector<float>& image)
{
    return std::accumulate(image.begin(), image.end(), 0.0) / double(image.size());
}

// Converts radiance to display values of 0..1 (sRGB) without a tone curve.
Drawing shown(Drawing drawing, float exposure)
{
    drawing.image = [image = drawing.image, exposure] {
        std::vector<float> out = image();
        for (float& x : out)
            x = float(reference::srgbEncode(std::min(double(x * exposure), 1.0)));
        out.push_back(1); // differences are relative to the largest value: the range of the display
        return out;
    };
    return drawing;
}

// One light in ten is as it is; the others are so dim that no display shows them, not even as
// highlights of smooth surfaces, on which a millionth is still visible. There are few lights,
// because evaluating all of them at every pixel would take long. What looking for dim lights costs
// is measured with the same lights at full brightness.
Skip dimLights(SkipStage& stage)
{
    constexpr float starlight = 1e-9f, error = 0.5f / 255;
    Lights few = stage.lights();
    few.resize(std::min(few.size(), std::max<size_t>(few.size() / 16, 40)));
    Lights dim = few;
    for (size_t i = 0; i < dim.size(); ++i)
        for (float& e : dim[i].emission)
            e *= i % 10 ? starlight : 1;
    const CndInfluence uncut{.rule = CND_INFLUENCE_UNCUT};
    const Drawing uncutDrawing = stage.lighting(dim, {.influence = uncut});
    const double mean = meanOf(imageOf(uncutDrawing));
    const CndInfluence byError{
        .rule = CND_INFLUENCE_BY_ERROR, .maxError = error, .exposure = float(middleGrey / mean)};
    return {{.name = "lights too dim to see",
             .against = "all of them, everywhere",
             .passes = "lighting",
             .bound = double(error)},
            {shown(stage.lighting(dim, {.influence = byError}), byError.exposure), uncutDrawing},
            shown(uncutDrawing, byError.exposure),
            Pair{stage.lighting(few, {.influence = byError}),
                 stage.lighting(few, {.influence = uncut})}};
}

double largestDifference(const std::vector<float>& image, const std::vector<float>& reference)
{
    float largest = 0, difference = 0;
    for (size_t i = 0; i < reference.size(); ++i) {
        const float d = std::abs(image[i] - reference[i]);
        if (!std::isfinite(d))
            return std::numeric_limits<double>::infinity();
        largest = std::max(largest, std::abs(reference[i]));
        difference = std::max(difference, d);
    }
    return largest > 0 ? double(difference) / double(largest) : double(difference);
}

void interleave(const Pair& pair, uint32_t rounds, PassTimes& with, PassTimes& without,
                const std::function<void()>& onRound)
{
    imageOf(pair.without); // warms up, as the caller has done with the other drawing
    for (uint32_t round = 0; round < rounds; ++round) {
        const bool first = round % 2 == 0; // the two take turns at being drawn first
        if (first)
            with.add(pair.with.draw());
        without.add(pair.without.draw());
        if (!first)
            with.add(pair.with.draw());
        onRound();
    }
}

SkipRow measure(Skip skip, uint32_t rounds, const std::function<void()>& onRound)
{
    SkipRow& row = skip.row;
    const std::vector<float> image = imageOf(skip.pair.with);
    row.difference = largestDifference(image, imageOf(skip.unskipped));
    interleave(skip.pair, rounds, row.with, row.without, onRound);
    if (skip.idle) {
        imageOf(skip.idle->with);
        interleave(*skip.idle, rounds, row.idleWith, row.idleWithout, onRound);
    }
    return row;
}

// Removes the specular lobe of all surfaces.
Scene withoutSpecularLobes(Scene scene)
{
    for (Material& m : scene.materials) {
        m.metalness = 0;
        m.metallicRoughnessTexture = {};
        m.dielectricF0 = {};
        m.specularWeight = 0;
    }
    return scene;
}

Scene withBlackEnvironment(Scene scene)
{
    SceneEnvironment environment;
    environment.radiance.width = 4;
    environment.radiance.height = 2;
    environment.radiance.channels = 3;
    environment.radiance.pixels.assign(4 * 2 * 3, 0);
    scene.environment = environment;
    return scene;
}

} // namespace

PairedRatio SkipRow::interval() const
{
    return pairedRatio(without.totals(), with.totals());
}

bool SkipRow::isOverBar() const
{
    const PairedRatio r = interval();
    return bar > 0 && r.isKnown() && r.low > bar;
}

double SkipRow::shareInVain() const
{
    const double least = idleWithout.frames() ? idleWithout.total().medianMs : 0;
    return least > 0 ? idleWith.total().medianMs / least - 1 : 0;
}

std::string skipKey(const std::string& name, const std::string& against)
{
    return fmt::format("skip: {}, against {}", name, against);
}

std::string SkipRow::key() const
{
    return skipKey(name, against);
}

double SkipRow::ratio() const
{
    const double other = without.total().medianMs;
    return other > 0 ? with.total().medianMs / other : 0;
}

// Every row has one pair of drawings and some a second pair; one row has its own number of rounds.
double skipSteps(const SkipSettings& s)
{
    return 13.0 * s.rounds + s.pointRounds;
}

std::vector<SkipRow> measureSkips(const VulkanContext& context, const SkipSettings& settings,
                                  Progress& progress)
{
    SceneOptions options{.lights = settings.lights, .seed = settings.seed};
    Scene scene = loadScene(settings.scene, options);
    scene.background = {}; // black, like the environment that it is compared with
    const Scene black = withBlackEnvironment(scene);
    std::vector<SkipRow> rows;
    const auto add = [&](Skip skip, uint32_t rounds) {
        progress.doing(skip.row.name);
        rows.push_back(measure(std::move(skip), rounds, [&] { progress.advance(1); }));
    };
    SkipStage stage(context, scene, settings.size);
    const auto ofStage = {noLights,         noSurface,      lightsOutOfView,
                          otherTypesAbsent, unchangedLists, manualExposure};
    for (Skip (*make)(SkipStage&) : ofStage)
        add(make(stage), settings.rounds);
    add(otherTypesNeverMet(stage), settings.pointRounds);
    add(dimLights(stage), settings.rounds);
    {
        SkipStage other(context, scene, settings.size);
        add(unchangedFrame(stage, other), settings.rounds);
    }
    {
        const Scene diffuse = withoutSpecularLobes(scene);
        SkipStage lacking(context, diffuse, settings.size);
        add(withoutSpecular(lacking, stage), settings.rounds);
    }
    SkipStage shaded(context, black, settings.size);
    add(noEnvironment(stage, shaded), settings.rounds);
    return rows;
}

namespace
{

double medianMs(const PassTimes& times)
{
    return times.total().medianMs;
}

Json timesJson(const PassTimes& times)
{
    Json passes = Json::array();
    for (const PassSummary& pass : times.summary())
        passes.push_back({{"name", pass.name}, {"minMs", pass.minMs}, {"medianMs", pass.medianMs}});
    return {{"frames", times.frames()},
            {"medianMs", medianMs(times)},
            {"minMs", times.total().minMs},
            {"passes", passes}};
}

// Describes what looking for the skip costs if it is not found.
std::string costOf(const SkipRow& row)
{
    if (!row.idleWith.frames())
        return "nothing";
    const std::vector<double> costs = differences(row.idleWith.totals(), row.idleWithout.totals());
    return fmt::format("{} of {} ms", threeDigits(medianAboveNoise(costs)),
                       threeDigits(medianMs(row.idleWithout)));
}

std::string limitOf(const SkipRow& row)
{
    if (row.bar <= 0)
        return "-";
    const bool above =
        row.interval().isKnown() ? row.interval().high > row.bar : row.ratio() > row.bar;
    return fmt::format("{:.2f}{}", row.bar, row.isOverBar() ? " missed" : above ? " open" : "");
}

} // namespace

Table skipTable(const std::vector<SkipRow>& rows)
{
    Table table(
        {{"what is left out", "", "What the frame does not need, so that its work is skipped."},
         Column::words("against", "The frame that it is compared with, which does that work."),
         Column::words("passes", "The passes of the frame that are timed."),
         {"with", "ms", "The median time of these passes with the skip."},
         {"without", "ms", "Their median time without the skip."},
         {"median of paired ratios", "[95%]",
          "The time with the skip divided by the time without in the same round, the median of the "
          "rounds, and an interval that holds the true median with 95% confidence. Below 1 the "
          "skip saves time."},
         {"limit", "",
          "The largest ratio that the project allows itself, where it has set one. It is missed "
          "if the whole interval is above it, and open if only a part of it is."},
         {"in vain", "",
          "How much longer a frame takes that does not have what is looked for, because of the "
          "search, and how long it takes without."},
         {"difference", "of largest",
          "The largest difference of the two images, as a share of the largest value."}},
        "What skipping unneeded work saves");
    for (const SkipRow& row : rows)
        table.add({row.name, row.against, row.passes, threeDigits(medianMs(row.with)),
                   threeDigits(medianMs(row.without)),
                   row.interval().isKnown()
                       ? fmt::format("{:.3f} [{:.3f}, {:.3f}]", row.interval().median,
                                     row.interval().low, row.interval().high)
                       : fmt::format("{:.3f}", row.interval().median),
                   limitOf(row), costOf(row), threeDigits(row.difference)},
                  {.noisy = isNoisy(row.with.totals()) || isNoisy(row.without.totals()),
                   .key = row.key()});
    return table;
}

Json skipJson(const SkipSettings& settings, const std::vector<SkipRow>& rows)
{
    Json list = Json::array();
    for (const SkipRow& row : rows) {
        Json out{{"name", row.name},
                 {"against", row.against},
                 {"passes", row.passes},
                 {"ratio", row.ratio()},
                 {"bar", row.bar > 0 ? Json(row.bar) : Json()},
                 {"differenceOverLargest", row.difference},
                 {"bound", row.bound},
                 {"with", timesJson(row.with)},
                 {"without", timesJson(row.without)}};
        if (row.idleWith.frames()) {
            out["inVain"] = timesJson(row.idleWith);
            out["notLookedFor"] = timesJson(row.idleWithout);
        }
        list.push_back(out);
    }
    return {{"scene", settings.scene},
            {"widthPixels", settings.size.width},
            {"heightPixels", settings.size.height},
            {"lights", settings.lights},
            {"rounds", settings.rounds},
            {"pointRounds", settings.pointRounds},
            {"seed", settings.seed},
            {"specular", "conic"},
            {"skips", list}};
}

std::vector<std::string> skipFailures(const std::vector<SkipRow>& rows)
{
    std::vector<std::string> out;
    for (const SkipRow& row : rows)
        if (!(row.difference <= row.bound))
            out.push_back(fmt::format("{}: the image differs by {:.1e} of the largest radiance",
                                      row.name, row.difference));
    return out;
}

} // namespace candelabra::app
