// SPDX-License-Identifier: Apache-2.0
#include "measure/skip/skip.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>
#include <optional>

#include "load/load.h"
#include "measure/frame/brute_check.h"
#include "measure/skip/skip_stage.h"
#include "reference/tone_map.h"
#include "render/check.h"
#include "scene/scene_options.h"

namespace candelabra::app
{
namespace
{

using Lights = SkipStage::Lights;

constexpr double lightingBar = 0.05, pointBar = 1.03; // issue 4, acceptance 7

struct Pair {
    Drawing with, without;
};

struct Skip {
    SkipRow row;
    Pair pair;
    Drawing unskipped; // its image is that of pair.with
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

// The same lights without a size.
Lights points(Lights lights)
{
    for (CndLight& light : lights) {
        const CndLight sphere = light;
        light = take(pointFromSphere(sphere));
    }
    return lights;
}

// With one dark light of every type but points, or as many dark points.
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
                              .axisV = {0, 0, 0.02f}});
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
    return pass == "cull_instances" || pass == "compact_instances" || pass == "gbuffer_raster";
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

// The lights come along, or that none is in view would be what is measured.
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

// In vain: the scene as it is, whose surfaces have both lobes.
Skip withoutLobe(SkipStage& lacking, SkipStage& stage, CndMaterialClass materials, const char* name)
{
    const LightingWay apart{.materialClasses = uint32_t(materials)};
    const Drawing alike = lacking.lighting(lacking.lights());
    return {{.name = name,
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
    drawing.draw(); // compiles, uploads
    drawing.draw();
    return drawing.image();
}

constexpr double middleGrey = 0.18;

double meanOf(const std::vector<float>& image)
{
    return std::accumulate(image.begin(), image.end(), 0.0) / double(image.size());
}

// Radiance as a display shows it, 0..1, without a tone curve.
Drawing shown(Drawing drawing, float exposure)
{
    drawing.image = [image = drawing.image, exposure] {
        std::vector<float> out = image();
        for (float& x : out)
            x = float(reference::srgbEncode(std::min(double(x * exposure), 1.0)));
        out.push_back(1); // of which differences are shares
        return out;
    };
    return drawing;
}

// Few lights, or all of them everywhere would take long: one in ten as it is, the others so dim
// that no display shows them, not even as highlights of smooth surfaces, where a millionth is still
// seen. What looking for them costs shows where all are as they are.
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
    const Drawing everywhere = stage.lighting(dim, {.influence = uncut});
    const double mean = meanOf(imageOf(everywhere));
    const CndInfluence byError{
        .rule = CND_INFLUENCE_BY_ERROR, .maxError = error, .exposure = float(middleGrey / mean)};
    return {{.name = "lights too dim to see",
             .against = "all of them, everywhere",
             .passes = "lighting",
             .bound = double(error)},
            {shown(stage.lighting(dim, {.influence = byError}), byError.exposure), everywhere},
            shown(everywhere, byError.exposure),
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
    imageOf(pair.without); // warm, as the other is
    for (uint32_t round = 0; round < rounds; ++round) {
        const bool first = round % 2 == 0; // neither always comes first
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

// All surfaces of metal, or all without a specular lobe.
Scene withMaterials(Scene scene, bool metal)
{
    for (Material& m : scene.materials) {
        m.metalness = metal;
        m.metallicRoughnessTexture = {};
        if (!metal) {
            m.dielectricF0 = {};
            m.specularWeight = 0;
        }
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

double SkipRow::ratio() const
{
    const double other = without.total().medianMs;
    return other > 0 ? with.total().medianMs / other : 0;
}

// Rows, four of them with two pairs; and that of points.
double skipSteps(const SkipSettings& s)
{
    return 15.0 * s.rounds + s.pointRounds;
}

std::vector<SkipRow> measureSkips(const VulkanContext& context, const SkipSettings& settings,
                                  Progress& progress)
{
    SceneOptions options{.lights = settings.lights, .seed = settings.seed};
    Scene scene = loadScene(settings.scene, options);
    scene.background = {}; // an environment would stand in its place
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
    for (const bool metal : {false, true}) {
        const Scene changed = withMaterials(scene, metal);
        SkipStage lacking(context, changed, settings.size);
        add(metal ? withoutLobe(lacking, stage, CND_MATERIAL_SPECULAR_ONLY, "metals alone")
                  : withoutLobe(lacking, stage, CND_MATERIAL_DIFFUSE_ONLY, "no specular materials"),
            settings.rounds);
    }
    SkipStage shaded(context, black, settings.size);
    add(noEnvironment(stage, shaded), settings.rounds);
    return rows;
}

} // namespace candelabra::app
