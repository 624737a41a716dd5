// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cmath>

#include "candelabra/candelabra.hpp"
#include "commands/choice_option.h"
#include "commands/options.h"
#include "render/setting_names.h"

namespace candelabra::app
{
namespace
{

constexpr Choice<bool> onOffChoices[] = {{"on", true}, {"off", false}};

} // namespace

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

void FrameArguments::addInfluenceTo(CLI::App& command)
{
    addChoice(command, "--influence", influence, influenceChoices,
              "how far lights reach: as the scene says, or everywhere");
    command
        .add_option("--influence-error", influenceError,
                    "lights reach as far as the display can tell: all that is cut changes no "
                    "channel by more than this share of its range, under the exposure of the "
                    "frame before")
        ->type_name("E, such as 0.5/255 or 0.002");
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
        throw UsageError("--influence-error: --influence says how far lights reach");
    if (cullingMode() == CND_CULLING_BRUTE)
        throw UsageError("--influence-error: --culling brute cuts no light");
    return {.rule = CND_INFLUENCE_BY_ERROR, .maxError = float(error)};
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
