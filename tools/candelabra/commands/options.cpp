// SPDX-License-Identifier: Apache-2.0
#include "commands/options.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <string_view>

#include <fmt/format.h>
#include <spdlog/spdlog.h>

#include "candelabra/candelabra.hpp"
#include "commands/help.h"
#include "generate/generators.h"
#include "io/table.h"
#include "render/camera.h"
#include "render/setting_names.h"
#include "scene/fit_camera.h"
#include "scene/light_types.h"

namespace candelabra::app
{

namespace
{

constexpr Choice<bool> onOffChoices[] = {{"on", true}, {"off", false}};
constexpr PixelSize usualSize{1280, 720};
constexpr Choice<std::optional<uint32_t>> defaultShadowChoices[] = {
    {"auto", std::nullopt}, {"off", 0}, {"32", 32}, {"64", 64}};

} // namespace

uint32_t unsignedOption(const std::string& option, const std::string& text, uint32_t min,
                        uint32_t max)
{
    const auto value = parseUnsigned(text);
    if (!value || *value < min || *value > max)
        throw UsageError(
            fmt::format("{} \"{}\": must be a whole number from {} to {}", option, text, min, max));
    return *value;
}

double numberOption(const std::string& option, const std::string& text, double min, double max)
{
    const auto value = parseNumber(text);
    if (!value || *value < min || *value > max)
        throw UsageError(
            fmt::format("{} \"{}\": must be a number from {:g} to {:g}", option, text, min, max));
    return *value;
}

std::vector<uint32_t> unsignedListOption(const std::string& option, const std::string& text,
                                         uint32_t min, uint32_t max)
{
    std::vector<uint32_t> out;
    for (const std::string& part : splitAtCommas(text))
        out.push_back(unsignedOption(option, part, min, max));
    return out;
}

ShardNumber shardNumber(const std::string& text)
{
    if (text.empty())
        return {};
    const size_t slash = text.find('/');
    const auto index = parseUnsigned(text.substr(0, slash));
    const auto count =
        slash == std::string::npos ? std::nullopt : parseUnsigned(text.substr(slash + 1));
    if (!index || !count || *index < 1 || *count < *index || *count > maxSide)
        throw UsageError("--shard \"" + text + "\": expected i/n with 1 <= i <= n, such as 2/8");
    return {*index, *count};
}

PixelSize sizeOption(const std::string& option, const std::string& text)
{
    const auto size = parseSize(text);
    if (!size || size->width > maxSide || size->height > maxSide)
        throw UsageError(fmt::format("{} \"{}\": expected WIDTHxHEIGHT up to {} pixels a side",
                                     option, text, maxSide));
    return *size;
}

std::vector<uint32_t> lightTypesOption(const std::string& option, const std::string& text)
{
    std::vector<uint32_t> out;
    for (const std::string& name : splitAtCommas(text)) {
        uint32_t type = 0;
        std::string all;
        for (; type < CND_LIGHT_TYPE_COUNT && name != lightTypeName(type); ++type)
            all += (type > 0 ? ", " : "") + std::string(lightTypeName(type));
        if (type == CND_LIGHT_TYPE_COUNT)
            throw UsageError(fmt::format("{} \"{}\": choose from {}", option, text, all));
        out.push_back(type);
    }
    return out;
}

CLI::Option* addOption(CLI::App& command, const std::string& names, std::string& text,
                       const char* type, const std::string& what)
{
    return command.add_option(names, text, what)->type_name(type)->capture_default_str();
}

void addWarmUpTo(CLI::App& command, std::string& seconds)
{
    addOption(command, "--warm-up", seconds, "SECONDS",
              "draw warm-up frames for at least this long, because the clock of an idle GPU rises "
              "slowly");
}

void DeviceArguments::addTo(CLI::App& command)
{
    const OptionGroup group(command, deviceGroup);
    addOption(command, "--device", device, "INDEX|NAME",
              "Vulkan device, by its index or part of its name as `candelabra devices` lists them; "
              "default: a discrete GPU, else an integrated one, else a CPU");
    command.add_flag("--validate", validate,
                     "run with the Vulkan validation layers; messages go to stderr, and any "
                     "message sets the exit code to 1");
}

ContextOptions DeviceArguments::contextOptions(Presentation presentation) const
{
    return {.device = device,
            .validation = validate ? Validation::On : Validation::Off,
            .presentation = presentation};
}

void DeviceArguments::requireRoomFor(uint32_t lights) const
{
    // Vulkan guarantees storage buffers of 2^27 bytes, and a light takes less than 64 bytes.
    constexpr uint32_t everyDevice = (1u << 27) / 64;
    if (lights <= everyDevice)
        return;
    const VulkanInstance instance(Validation::Off, Presentation::Headless);
    const DeviceInfo chosen = chooseDevice(instance.devices(), device);
    if (const uint64_t most = maxLightsOf(chosen); lights > most)
        throw UsageError(fmt::format("--lights {}: {} has room for at most {} lights", lights,
                                     chosen.name, grouped(most)));
}

void SceneArguments::addTo(CLI::App& command, const std::string& fallback)
{
    scene = fallback;
    CLI::Option* option = addOption(
        command, fallback.empty() ? "scene" : "scene,--scene", scene, "SCENE",
        "hall, field, fence, rooms, showcase, or the path of a .gltf, .glb or scene .json "
        "file");
    if (fallback.empty())
        option->required();
    addOptionsTo(command);
}

void SceneArguments::addOptionsTo(CLI::App& command)
{
    const OptionGroup group(command, sceneGroup);
    addOption(command, "--seed", seed, "S", "seed of all random numbers in the scene (1)");
    addOption(command, "--overlaps", overlaps, "K",
              "mean number of generated lights that contribute to a pixel; sets their radius of "
              "influence (8)");
    command.add_flag("--moving", moving,
                     "let the lights move; lights that a file has stay where they are");
    addOption(command, "--punctual-radius", punctualRadius, "METRES",
              "glTF files: point lights without a radius become spheres of this radius (m)");
    addOption(command, "--sun-radius", sunRadius, "SINE",
              "glTF files: directional lights become distant spheres whose angular radius has this "
              "sine (the Sun: 0.00465)");
    command.add_flag("--emissive-lights", emissiveLights,
                     "glTF files: flat rectangles whose material emits become area lights");
    addOption(command, "--environment", environment, "FILE",
              "light the scene from all directions with an equirectangular image in cd/m^2 (.hdr, "
              ".exr or .pfm) whose top is up; it is also visible as the background");
    addOption(
        command, "--environment-rotation", environmentRotation, "DEGREES",
        "rotate the environment about the vertical, counter-clockwise when seen from above (0)");
    addOption(command, "--environment-scale", environmentScale, "FACTOR",
              "factor for the environment's luminance (1)");
    addOption(command, "--environment-illuminance", environmentIlluminance, "LX",
              "scale the environment to give level ground this illuminance; a clear sky without "
              "the sun gives about 15,000 lx, a full moon 0.2 lx");
    const OptionGroup lighting(command, lightingGroup);
    addChoice(command, "--lobes", lobes, lobeChoices,
              "how the diffuse and specular lobes of a material share the light (default: sum for "
              "scene .json files without a source, else conserving)");
    addChoice(command, "--energy-compensation", energyCompensation, onOffChoices,
              "add the light that bounces between microfacets and that the specular lobe loses, "
              "without which rough metal looks dark (default: on for glTF files and for scene "
              ".json files whose source is a glTF file, else off)");
}

void SceneArguments::addDefaultLightTo(CLI::App& command)
{
    const OptionGroup group(command, sceneGroup);
    defaultLight = "on";
    addChoice(command, "--default-light", defaultLight, onOffChoices,
              "light a scene that has no lights with a studio, a soft grey sky with a key light; "
              "scene descriptions (.json) never get one");
}

void SceneArguments::addLightsTo(CLI::App& command)
{
    const OptionGroup group(command, sceneGroup);
    addOption(
        command, "--lights", lightsOption, "N",
        "number of sphere lights in hall, field, fence and rooms (4000); a file gets this many "
        "random lights in addition to its own");
}

std::optional<uint32_t> SceneArguments::lightCount() const
{
    if (lightsOption.empty())
        return {};
    return unsignedOption("--lights", lightsOption, 0, maxLights);
}

SceneOptions SceneArguments::options(std::optional<uint32_t> lights) const
{
    SceneOptions out;
    out.lights = lights;
    if (!seed.empty())
        out.seed = unsignedOption("--seed", seed, 0, UINT32_MAX);
    if (!overlaps.empty())
        out.overlaps = numberOption("--overlaps", overlaps, 1e-3, 1e6);
    out.moving = moving;
    if (!punctualRadius.empty())
        out.punctualRadius = numberOption("--punctual-radius", punctualRadius, 1e-6, 1e6);
    if (!sunRadius.empty())
        out.sunRadius = numberOption("--sun-radius", sunRadius, 1e-6, 1);
    out.emissiveLights = emissiveLights;
    out.environment = environment;
    if (!lobes.empty())
        out.lobes = choose("--lobes", lobes, lobeChoices);
    if (!energyCompensation.empty())
        out.energyCompensation = choose("--energy-compensation", energyCompensation, onOffChoices);
    if (!environmentRotation.empty())
        out.environmentRotation =
            numberOption("--environment-rotation", environmentRotation, -360, 360) *
            std::numbers::pi / 180;
    if (!environmentScale.empty())
        out.environmentScale = numberOption("--environment-scale", environmentScale, 0, 1e9);
    if (!environmentIlluminance.empty()) {
        if (!environmentScale.empty())
            throw UsageError("--environment-illuminance: cannot be combined with "
                             "--environment-scale, because it chooses the factor itself");
        out.environmentIlluminance =
            numberOption("--environment-illuminance", environmentIlluminance, 1e-6, 1e9);
    }
    if (!defaultLight.empty())
        out.defaultLight = choose("--default-light", defaultLight, onOffChoices);
    return out;
}

void SceneArguments::warnOfIdleOptions(std::optional<uint32_t> lights) const
{
    const bool generated = isGenerated(scene);
    const bool file = !isBuiltIn(scene);
    const auto warn = [](const char* option, const std::string& reason) {
        spdlog::warn("warning: {} has no effect: {}", option, reason);
    };
    if (!punctualRadius.empty() && (!file || scene.ends_with(".json")))
        warn("--punctual-radius", "it is for point lights of glTF files");
    if (!sunRadius.empty() && (!file || scene.ends_with(".json")))
        warn("--sun-radius", "it is for directional lights of glTF files");
    if (emissiveLights && (!file || scene.ends_with(".json")))
        warn("--emissive-lights", "it is for emissive materials of glTF files");
    if (environment.empty() && !environmentRotation.empty())
        warn("--environment-rotation", "there is no --environment");
    if (environment.empty() && !environmentScale.empty())
        warn("--environment-scale", "there is no --environment");
    if (environment.empty() && !environmentIlluminance.empty())
        warn("--environment-illuminance", "there is no --environment");
    if (generated || lights.value_or(0))
        return;
    const std::string reason =
        file ? "it is for generated lights, which " + scene + " gets with --lights N only"
             : scene + " has one light of every type";
    if (!overlaps.empty())
        warn("--overlaps", reason);
    if (moving && file)
        warn("--moving", reason);
    if (!seed.empty())
        warn("--seed", reason);
}

void FrameArguments::addPlaceTo(CLI::App& command)
{
    const OptionGroup group(command, pictureGroup);
    addOption(command, "--size", size, "WxH",
              "image size in pixels; default: the scene's size, else 1280x720");
    addOption(command, "--camera", camera, "NAME|INDEX|px,py,pz,tx,ty,tz[,fov]",
              "camera of the scene by name (hall: nave, gallery; field: terrace, overview; fence: "
              "path, above; rooms: salon, enfilade; showcase: front, above; glTF files: their own, "
              "then three-quarter, front, right, back, left and above, and inside and inside-2 for "
              "the inside of a building) or by index, or a new camera: position and target in "
              "metres, and vertical field of view in "
              "degrees; default: the scene's first, or the first automatic one if the file's own "
              "cameras show the scene less than half as wide and as high as the picture");
}

void FrameArguments::addViewTo(CLI::App& command)
{
    addPlaceTo(command);
    const OptionGroup group(command, pictureGroup);
    addChoice(command, "--lights-visible", lightsVisible, onOffChoices,
              "draw area lights as visible emitters (default: as the scene says)");
}

void FrameArguments::addAllTo(CLI::App& command, Reuse fallback)
{
    choosesShadows = true;
    shadows = "auto";
    addTo(command);
    addFitTo(command);
    addCullingTo(command);
    addInfluenceTo(command);
    addDebugTo(command);
    addReuseTo(command, fallback);
}

void FrameArguments::addTo(CLI::App& command)
{
    addViewTo(command);
    addDisplayTo(command);
    addShadingTo(command);
    addDrawingTo(command);
}

void FrameArguments::addDisplayTo(CLI::App& command)
{
    const OptionGroup group(command, pictureGroup);
    addOption(command, "--exposure", exposure, "auto|EV",
              "automatic, or a fixed EV100; with the studio of --default-light, auto uses the "
              "EV100 of its light");
    addOption(command, "--compensation", compensation, "EV",
              "make the picture brighter by this many EV; the night scenes hall, field, fence, "
              "rooms and showcase add -1 EV");
    addOption(command, "--middle-grey", middleGrey, "SHARE",
              "exposure calibration: the exposed value of a surface with the metered luminance; "
              "every tone map displays 0.18 as middle grey, 118 of 255");
    addChoice(command, "--metering", metering, meteringChoices,
              "how automatic exposure weights the pixels");
    addChoice(command, "--tonemap", toneMap, toneMapChoices, "tone map of the display image");
}

void FrameArguments::addShadingTo(CLI::App& command)
{
    const OptionGroup group(command, lightingGroup);
    specular = specularName(CND_SPECULAR_CONIC);
    addChoice(command, "--specular", specular, specularChoices,
              "method for the specular lobe; conic is the closed form, karis the representative "
              "point of Karis 2013, and sampled takes random samples; point, kx and conic-full "
              "differ from karis and conic for spheres only");
    addOption(command, "--samples", sampleCount, "N",
              "samples per light and pixel of --specular sampled (1..4096)");
    const std::string what = "soft shadows of everything opaque, found for this many points of "
                             "each light; 64 takes little longer than 32";
    if (choosesShadows)
        addChoice(command, "--shadows", shadows, defaultShadowChoices,
                  what + "; auto is 64, but off on a CPU where a picture would take more than 2 s "
                         "longer, by an estimate that is the same in every run");
    else
        addChoice(command, "--shadows", shadows, shadowChoices, what);
}

void FrameArguments::addDrawingTo(CLI::App& command)
{
    const OptionGroup group(command, drawingGroup);
    addChoice(command, "--gbuffer", gbuffer, gbufferChoices, "layout of the G-buffer");
    addChoice(command, "--lod", lod, onOffChoices,
              "draw coarser levels of detail of meshes where that moves their surface by at most a "
              "quarter of a pixel; with shadows, full meshes are drawn, because these cast them");
    addChoice(command, "--cull-triangles", cullTriangles, onOffChoices,
              "on llvmpipe, drop triangles and visible lights that cover no pixel centre before "
              "they are rasterised; the picture stays the same");
}

void FrameArguments::addFitTo(CLI::App& command)
{
    const OptionGroup group(command, pictureGroup);
    addOption(command, "--fit", fit, "NODE|INDEX",
              "move the camera, without turning it, until this node of a glTF file and everything "
              "below it fill 85% of the picture; give the node's name or its number in the file");
}

void FrameArguments::addCullingTo(CLI::App& command)
{
    const OptionGroup group(command, lightingGroup);
    addChoice(command, "--culling", culling, cullingChoices,
              "find the lights of a pixel by clusters, or by trying every light");
}

void FrameArguments::addReuseTo(CLI::App& command, Reuse fallback)
{
    const OptionGroup group(command, lightingGroup);
    reuse = nameOf(fallback, reuseChoices);
    addChoice(command, "--reuse", reuse, reuseChoices,
              "what a frame reuses from the previous frame if nothing has changed; the image stays "
              "the same");
}

void FrameArguments::addDebugTo(CLI::App& command)
{
    const OptionGroup group(command, pictureGroup);
    addChoice(
        command, "--debug", heatMap, heatMapChoices,
        "show in false colours what the lights cost each pixel, instead of the picture; "
        "lights-per-pixel counts the lights in its list; evaluated counts those that it evaluates, "
        "or waits for while its neighbours do; efficiency is the share of the listed lights that "
        "contribute; "
        "class shows whether a pixel uses the light list of its tile, that of a depth slice "
        "of its tile, or none and walks the light tree; shadow shows how much a pixel sees of "
        "its lights, and needs shadows");
}

void FrameArguments::addInfluenceTo(CLI::App& command)
{
    const OptionGroup group(command, lightingGroup);
    addChoice(command, "--influence", influence, influenceChoices,
              "let lights reach as far as the influence radii of the scene, or everywhere");
    addOption(command, "--influence-error", influenceError, "E, such as 0.5/255 or 0.002",
              "let lights reach as far as the display can show: all the light that is cut off "
              "changes no channel by more than this share of its range in total, at the exposure "
              "of the previous frame");
}

PixelSize FrameArguments::givenSize() const
{
    if (size.empty())
        return usualSize;
    const auto parsed = parseSize(size);
    if (!parsed)
        throw UsageError("--size \"" + size + "\": expected WIDTHxHEIGHT such as 1280x720");
    return *parsed;
}

double FrameArguments::imageAspect() const
{
    const PixelSize given = givenSize();
    return double(given.width) / given.height;
}

Camera FrameArguments::chosenCamera(const Scene& scene) const
{
    const Camera chosen = selectCamera(scene, camera);
    return fit.empty() ? chosen : fitCamera(scene, selectNode(scene, fit), chosen, imageAspect());
}

PixelSize FrameArguments::pixelSize(const Scene& scene, const Camera& chosen) const
{
    PixelSize out = givenSize();
    if (size.empty() && scene.resolution) {
        out = {scene.resolution->x, scene.resolution->y};
    } else if (size.empty() && chosen.aspect) {
        // The default height, and the width that gives square pixels.
        const double width = std::round(out.height * *chosen.aspect);
        out.width = uint32_t(std::clamp(width, 1.0, double(maxSide)));
    }
    if (out.width > maxSide || out.height > maxSide)
        throw UsageError(fmt::format("image size {}x{}: at most {} pixels per side", out.width,
                                     out.height, maxSide));
    return out;
}

CndGBufferLayout FrameArguments::gbufferLayout() const
{
    return choose("--gbuffer", gbuffer, gbufferChoices);
}

CndSpecularMethod FrameArguments::specularMethod() const
{
    return chooseSpecular("--specular", specular);
}

CndCulling FrameArguments::cullingMode() const
{
    return choose("--culling", culling, cullingChoices);
}

CndInfluence FrameArguments::influenceRule() const
{
    const CndInfluenceRule rule = choose("--influence", influence, influenceChoices);
    if (influenceError.empty())
        return {.rule = rule};
    const size_t slash = influenceError.find('/');
    const auto above = parseNumber(influenceError.substr(0, slash));
    const auto below = slash == std::string::npos ? std::optional(1.0)
                                                  : parseNumber(influenceError.substr(slash + 1));
    const double error = above && below ? *above / *below : 0;
    if (!(error > 0 && error <= 1) || !(float(error) > 0))
        throw UsageError("--influence-error \"" + influenceError +
                         "\": must be above 0 and at most 1, such as 0.5/255 or 0.002");
    if (rule != CND_INFLUENCE_GIVEN)
        throw UsageError("--influence-error: cannot be combined with --influence uncut");
    if (cullingMode() == CND_CULLING_BRUTE)
        throw UsageError("--influence-error: --culling brute cuts no light");
    return {.rule = CND_INFLUENCE_BY_ERROR, .maxError = float(error)};
}

std::optional<uint32_t> FrameArguments::shadowPoints() const
{
    if (!choosesShadows)
        return choose("--shadows", shadows, shadowChoices);
    const auto given = choose("--shadows", shadows, defaultShadowChoices);
    const bool shown = choose("--debug", heatMap, heatMapChoices) == HeatMap::Shadow;
    return given || !shown ? given : usualShadowPoints;
}

HeatMap FrameArguments::heatMapMode() const
{
    const HeatMap out = choose("--debug", heatMap, heatMapChoices);
    if (out != HeatMap::None && cullingMode() != CND_CULLING_CLUSTERED)
        throw UsageError("--debug: shows the cost of lists, which needs --culling clustered");
    if (out == HeatMap::Shadow && shadowPoints() == 0u)
        throw UsageError("--debug shadow: there are no shadows; add --shadows 64");
    return out;
}

std::optional<bool> FrameArguments::lightsVisibleOverride() const
{
    if (lightsVisible.empty())
        return std::nullopt;
    return choose("--lights-visible", lightsVisible, onOffChoices);
}

CndExposureSettings FrameArguments::exposureSettings() const
{
    CndExposureSettings out = defaultExposureSettings();
    if (exposure != "auto") {
        const auto ev = parseNumber(exposure);
        if (!ev || std::abs(*ev) > 40)
            throw UsageError("--exposure \"" + exposure +
                             "\": must be auto or an EV100 from -40 to 40");
        out.manual = VK_TRUE;
        out.manualEv100 = float(*ev);
    }
    out.compensation = float(numberOption("--compensation", compensation, -20, 20));
    out.middleGrey = float(numberOption("--middle-grey", middleGrey, 0.001, 1));
    out.metering = choose("--metering", metering, meteringChoices);
    out.toneMap = choose("--tonemap", toneMap, toneMapChoices);
    return out;
}

FrameOptions FrameArguments::frameOptions() const
{
    return {.levels = choose("--lod", lod, onOffChoices),
            .cullTriangles = choose("--cull-triangles", cullTriangles, onOffChoices),
            .specular = specularMethod(),
            .sampleCount = unsignedOption("--samples", sampleCount, 1, 4096),
            .culling = cullingMode(),
            .shadows = shadowPoints().value_or(0),
            .influence = influenceRule(),
            .reuse = choose("--reuse", reuse, reuseChoices),
            .heatMap = heatMapMode(),
            .exposure = exposureSettings()};
}

namespace
{

// Returns text between the end of `start` and `end`, or an empty text if `said` has not this form.
std::string between(const std::string& said, const std::string& start, std::string_view end)
{
    if (!said.starts_with(start) || !said.ends_with(end) || said.size() < start.size() + end.size())
        return "";
    return said.substr(start.size(), said.size() - start.size() - end.size());
}

// Names the arguments that nothing takes: "4" and "5" are not expected here.
std::string extrasSentence(const CLI::App& app)
{
    std::vector<std::string> extras = app.remaining(true);
    for (std::string& extra : extras)
        extra = '"' + extra + '"';
    return listed(extras) + (extras.size() == 1 ? " is" : " are") + " not expected here";
}

} // namespace

std::string parserSentence(const CLI::App& app, const CLI::ParseError& error)
{
    const std::string said = error.what();
    if (dynamic_cast<const CLI::ExtrasError*>(&error))
        return extrasSentence(app);
    if (const std::string positional = between(said, "", " is required"); !positional.empty())
        return "no " + positional + " is given";
    if (const std::string flag = between(said, "Could not convert: ", ""); !flag.empty())
        return flag.substr(0, flag.find(' ')) + ": takes no value";
    const std::string option = said.substr(0, said.find(':'));
    if (const auto count = between(said, option + ": At Most 1 required but received ", "");
        !count.empty())
        return fmt::format("{}: is given {} times, but may be given once", option, count);
    if (const std::string count = between(said, option + ": ", " missing"); !count.empty()) {
        const std::string values = count.substr(0, count.find(' '));
        return option +
               (values == "1" ? ": its value is missing" : ": needs " + values + " values");
    }
    return said;
}

} // namespace candelabra::app
