// SPDX-License-Identifier: Apache-2.0
#include "commands/options.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <span>

#include <fmt/format.h>
#include <spdlog/spdlog.h>

#include "candelabra/candelabra.hpp"
#include "io/table.h"
#include "render/error.h"
#include "render/renderer.h"
#include "shared/specular_methods.h"

namespace candelabra::app
{
namespace
{

template <typename T>
struct Choice {
    const char* name;
    T value;
};

constexpr Choice<CndSpecularMethod> specularChoices[] = {
#define X(id, NAME, name) {name, CND_SPECULAR_##NAME},
    CND_SPECULAR_METHODS(X)
#undef X
};
constexpr Choice<CndCulling> cullingChoices[] = {{"clustered", CND_CULLING_CLUSTERED},
                                                 {"brute", CND_CULLING_BRUTE}};
constexpr Choice<Reuse> reuseChoices[] = {
    {"none", Reuse::None}, {"lists", Reuse::Lists}, {"lighting", Reuse::Lighting}};
constexpr Choice<HeatMap> heatMapChoices[] = {{"none", HeatMap::None},
                                              {"lights-per-pixel", HeatMap::LightsPerPixel},
                                              {"evaluated", HeatMap::Evaluated},
                                              {"efficiency", HeatMap::Efficiency},
                                              {"class", HeatMap::Class}};
constexpr Choice<CndGBufferLayout> gbufferChoices[] = {{"full", CND_GBUFFER_FULL},
                                                       {"compact", CND_GBUFFER_COMPACT}};
constexpr Choice<CndToneMap> toneMapChoices[] = {{"none", CND_TONEMAP_NONE},
                                                 {"reinhard", CND_TONEMAP_REINHARD},
                                                 {"aces", CND_TONEMAP_ACES},
                                                 {"neutral", CND_TONEMAP_PBR_NEUTRAL},
                                                 {"agx", CND_TONEMAP_AGX}};
constexpr Choice<CndMetering> meteringChoices[] = {{"average", CND_METERING_AVERAGE},
                                                   {"centre", CND_METERING_CENTRE_WEIGHTED}};
constexpr Choice<CndLobeJoining> lobeChoices[] = {{"conserving", CND_LOBES_CONSERVING},
                                                  {"sum", CND_LOBES_SUM}};
constexpr Choice<bool> onOffChoices[] = {{"on", true}, {"off", false}};

template <typename T>
std::string names(std::span<const Choice<T>> choices)
{
    std::string out;
    for (const Choice<T>& choice : choices)
        out += (out.empty() ? "" : ", ") + std::string(choice.name);
    return out;
}

template <typename T, size_t N>
T choose(const std::string& option, const std::string& text, const Choice<T> (&choices)[N])
{
    for (const Choice<T>& choice : choices)
        if (text == choice.name)
            return choice.value;
    throw UsageError(fmt::format("{} \"{}\": choose one of {}", option, text,
                                 names<T>(std::span<const Choice<T>>(choices))));
}

template <typename T, size_t N>
const char* nameOf(T value, const Choice<T> (&choices)[N])
{
    for (const Choice<T>& choice : choices)
        if (choice.value == value)
            return choice.name;
    return "unknown";
}

template <typename T, size_t N>
void addChoice(CLI::App& command, const std::string& option, std::string& text,
               const Choice<T> (&choices)[N], const std::string& what)
{
    command.add_option(option, text, what + ": " + names<T>(std::span<const Choice<T>>(choices)))
        ->type_name("NAME")
        ->capture_default_str();
}

} // namespace

const char* specularName(CndSpecularMethod method)
{
    return nameOf(method, specularChoices);
}
const char* cullingName(CndCulling culling)
{
    return nameOf(culling, cullingChoices);
}
const char* reuseName(Reuse reuse)
{
    return nameOf(reuse, reuseChoices);
}
const char* heatMapName(HeatMap heatMap)
{
    return nameOf(heatMap, heatMapChoices);
}
const char* toneMapName(CndToneMap toneMap)
{
    return nameOf(toneMap, toneMapChoices);
}
const char* gbufferName(CndGBufferLayout layout)
{
    return nameOf(layout, gbufferChoices);
}

const char* lobesName(CndLobeJoining lobes)
{
    return nameOf(lobes, lobeChoices);
}

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
    for (size_t start = 0; start <= text.size();) {
        const size_t end = std::min(text.find(',', start), text.size());
        out.push_back(unsignedOption(option, text.substr(start, end - start), min, max));
        start = end + 1;
    }
    return out;
}

void DeviceArguments::addTo(CLI::App& command)
{
    command
        .add_option("--device", device,
                    "Vulkan device: an index or a part of the name (candelabra devices lists "
                    "them); default: discrete, then integrated, then CPU")
        ->type_name("INDEX|NAME");
    command.add_flag("--validate", validate,
                     "run with the Vulkan validation layers; any message goes to stderr and makes "
                     "the exit code 1");
}

ContextOptions DeviceArguments::contextOptions(Presentation presentation) const
{
    return {.device = device,
            .validation = validate ? Validation::On : Validation::Off,
            .presentation = presentation};
}

void DeviceArguments::requireRoomFor(uint32_t lights) const
{
    // Vulkan guarantees storage buffers of 2^27 bytes; a light takes less than 64.
    constexpr uint32_t everyDevice = (1u << 27) / 64;
    if (lights <= everyDevice)
        return;
    const VulkanInstance instance(Validation::Off, Presentation::Headless);
    const DeviceInfo chosen = chooseDevice(instance.devices(), device);
    if (const uint64_t most = maxLightsOf(chosen); lights > most)
        throw UsageError(fmt::format("--lights {}: {} has room for at most {} lights", lights,
                                     chosen.name, grouped(most)));
}

void LobeArguments::addTo(CLI::App& command)
{
    addChoice(command, "--lobes", lobes, lobeChoices,
              "how diffuse and specular lobes share the light (default: scene .json sum, else "
              "conserving)");
    command.add_flag("--energy-compensation", energyCompensation,
                     "give back what the specular lobe loses between its microfacets");
}

void LobeArguments::applyTo(SceneOptions& options) const
{
    if (!lobes.empty())
        options.lobes = choose("--lobes", lobes, lobeChoices);
    options.energyCompensation = energyCompensation;
}

void SceneArguments::addTo(CLI::App& command, const std::string& fallback)
{
    scene = fallback;
    CLI::Option* option = command
                              .add_option(fallback.empty() ? "scene" : "scene,--scene", scene,
                                          "hall, field, fence, showcase, or a .gltf, .glb or scene "
                                          ".json file")
                              ->type_name("SCENE");
    if (fallback.empty())
        option->required();
    else
        option->capture_default_str();
    command.add_option("--seed", seed, "seed of everything random in the scene (1)")
        ->type_name("S");
    command
        .add_option("--overlaps", overlaps,
                    "mean number of lights whose influence covers a pixel (hall, field, fence: 8)")
        ->type_name("K");
    command.add_flag("--moving", moving, "lights move");
    command
        .add_option("--punctual-radius", punctualRadius,
                    "files: point lights without a radius become spheres of this radius (m)")
        ->type_name("METRES");
    command
        .add_option("--sun-radius", sunRadius,
                    "glTF files: directional lights become distant spheres whose angular radius "
                    "has this sine (the Sun: 0.00465)")
        ->type_name("SINE");
    command
        .add_option("--environment", environment,
                    "light from all around: an equirectangular image, .hdr, .exr or .pfm, in "
                    "cd/m^2, up at the top, seen where no surface is")
        ->type_name("FILE");
    command
        .add_option("--environment-rotation", environmentRotation,
                    "turns the environment about the vertical, counter-clockwise from above (0)")
        ->type_name("DEGREES");
    command
        .add_option("--environment-scale", environmentScale,
                    "factor on the environment's luminance (1)")
        ->type_name("FACTOR");
    lobes.addTo(command);
}

void SceneArguments::addLightsTo(CLI::App& command)
{
    command
        .add_option("--lights", lightsOption,
                    "hall, field, fence: number of sphere lights (4000); files: extra random ones")
        ->type_name("N");
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
    out.environment = environment;
    lobes.applyTo(out);
    if (!environmentRotation.empty())
        out.environmentRotation =
            numberOption("--environment-rotation", environmentRotation, -360, 360) *
            std::numbers::pi / 180;
    if (!environmentScale.empty())
        out.environmentScale = numberOption("--environment-scale", environmentScale, 0, 1e9);
    return out;
}

void SceneArguments::warnOfIdleOptions(std::optional<uint32_t> lights) const
{
    const bool generated = isGenerated(scene);
    const bool file = !generated && scene != "showcase";
    const auto warn = [](const char* option, const std::string& reason) {
        spdlog::warn("warning: {} has no effect: {}", option, reason);
    };
    if (!punctualRadius.empty() && (!file || scene.ends_with(".json")))
        warn("--punctual-radius", "it is about point lights of glTF files");
    if (!sunRadius.empty() && (!file || scene.ends_with(".json")))
        warn("--sun-radius", "it is about directional lights of glTF files");
    if (environment.empty() && !environmentRotation.empty())
        warn("--environment-rotation", "there is no --environment");
    if (environment.empty() && !environmentScale.empty())
        warn("--environment-scale", "there is no --environment");
    if (generated || lights.value_or(0))
        return;
    const std::string reason =
        file ? "it is about generated lights, which " + scene + " gets with --lights N only"
             : scene + " has one light of every type";
    if (!overlaps.empty())
        warn("--overlaps", reason);
    if (moving && file)
        warn("--moving", reason);
    if (!seed.empty())
        warn("--seed", reason);
}

void FrameArguments::addViewTo(CLI::App& command)
{
    command.add_option("--size", size, "image size in pixels; default: the scene's, else 1280x720")
        ->type_name("WxH");
    command
        .add_option(
            "--camera", camera,
            "camera of the scene by name (hall: nave, gallery; field: terrace, overview; fence: "
            "path, above; showcase: "
            "front, above) or index, or position and target in metres and vertical field of view "
            "in degrees; default: the first")
        ->type_name("NAME|INDEX|px,py,pz,tx,ty,tz[,fov]");
    addChoice(command, "--lights-visible", lightsVisible, onOffChoices,
              "draw area lights as emitters (default: as the scene says)");
}

void FrameArguments::addTo(CLI::App& command)
{
    specular = specularName(CND_SPECULAR_CONIC);
    addViewTo(command);
    command.add_option("--exposure", exposure, "auto, or a fixed EV100")
        ->type_name("auto|EV")
        ->capture_default_str();
    command.add_option("--compensation", compensation, "brighter by this many EV")
        ->type_name("EV")
        ->capture_default_str();
    addChoice(command, "--metering", metering, meteringChoices, "weights of automatic exposure");
    addChoice(command, "--tonemap", toneMap, toneMapChoices, "tone map of display images");
    addChoice(command, "--specular", specular, specularChoices, "specular method");
    command
        .add_option("--samples", sampleCount,
                    "samples per light and pixel of --specular sampled (1..4096)")
        ->type_name("N")
        ->capture_default_str();
    command
        .add_option("--error-budget", errorBudget,
                    "evaluate lights as cheaply as a bound of the error allows, as a share of the "
                    "highest response (0.01: 1%); 0: every light in full")
        ->type_name("E")
        ->capture_default_str();
    addChoice(command, "--gbuffer", gbuffer, gbufferChoices, "G-buffer layout");
}

void FrameArguments::addCullingTo(CLI::App& command)
{
    addChoice(command, "--culling", culling, cullingChoices, "which lights a pixel looks at");
}

void FrameArguments::addReuseTo(CLI::App& command, Reuse fallback)
{
    reuse = reuseName(fallback);
    addChoice(command, "--reuse", reuse, reuseChoices,
              "what a frame keeps of the one before where nothing has changed; the image is the "
              "same");
}

void FrameArguments::addDebugTo(CLI::App& command)
{
    addChoice(command, "--debug", heatMap, heatMapChoices,
              "instead of the display image, what the lights cost each pixel, with a legend");
}

PixelSize FrameArguments::pixelSize(const Scene& scene, const Camera& chosen) const
{
    PixelSize out{1280, 720};
    if (!size.empty()) {
        const auto parsed = parseSize(size);
        if (!parsed)
            throw UsageError("--size \"" + size + "\": expected WIDTHxHEIGHT such as 1280x720");
        out = *parsed;
    } else if (scene.resolution) {
        out = {scene.resolution->x, scene.resolution->y};
    } else if (chosen.aspect) {
        // Square pixels at the default height.
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
    return choose("--specular", specular, specularChoices);
}

uint32_t FrameArguments::samples() const
{
    return unsignedOption("--samples", sampleCount, 1, 4096);
}

float FrameArguments::budget() const
{
    return float(numberOption("--error-budget", errorBudget, 0, 1));
}

CndCulling FrameArguments::cullingMode() const
{
    return choose("--culling", culling, cullingChoices);
}

Reuse FrameArguments::reuseMode() const
{
    return choose("--reuse", reuse, reuseChoices);
}

HeatMap FrameArguments::heatMapMode() const
{
    const HeatMap out = choose("--debug", heatMap, heatMapChoices);
    if (out != HeatMap::None && cullingMode() != CND_CULLING_CLUSTERED)
        throw UsageError("--debug is about lists: it needs --culling clustered");
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
    out.metering = choose("--metering", metering, meteringChoices);
    out.toneMap = choose("--tonemap", toneMap, toneMapChoices);
    return out;
}

} // namespace candelabra::app
