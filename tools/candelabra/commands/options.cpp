// SPDX-License-Identifier: Apache-2.0
#include "commands/options.h"
#include "scene/scene_options.h"

#include <algorithm>
#include <numbers>

#include <fmt/format.h>
#include <spdlog/spdlog.h>

#include "commands/choice_option.h"
#include "generate/generators.h"
#include "io/table.h"
#include "render/setting_names.h"

namespace candelabra::app
{
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
    const bool file = !isBuiltIn(scene);
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

} // namespace candelabra::app
