// SPDX-License-Identifier: Apache-2.0
// Options that several commands share. They are described and checked here once.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include <CLI/CLI.hpp>

#include "candelabra/candelabra.h"
#include "io/choice.h"
#include "io/parse.h"
#include "render/renderer.h"
#include "render/vulkan_context.h"
#include "scene/scene_options.h"

namespace candelabra::app
{

// The arguments that main gives every command.
struct ProgramContext {
    std::string commandLine;
    bool quiet = false;
};

// A part of work that several calls share: every count-th piece, starting with piece `index`, from
// 1 on.
struct ShardNumber {
    uint32_t index = 1, count = 1;
};

// Returns the value of --shard, or all the work if it is empty. Throws UsageError.
ShardNumber shardNumber(const std::string& text);

struct DeviceArguments {
    std::string device;
    bool validate = false;

    void addTo(CLI::App& command);
    ContextOptions contextOptions(Presentation presentation = Presentation::Headless) const;
    // Throws UsageError if the device has no room for so many lights. Call it before a scene with
    // them is made, which takes long.
    void requireRoomFor(uint32_t lights) const;
};

// SCENE and the options that shape it. The number of lights is not among them, because `render`
// takes one number and `stress` a list.
struct SceneArguments {
    std::string scene, lightsOption;
    std::string seed, overlaps, punctualRadius, sunRadius;
    std::string environment, environmentRotation, environmentScale, environmentIlluminance;
    std::string defaultLight; // empty: off, for commands without the option
    std::string lobes, energyCompensation;
    bool moving = false, emissiveLights = false;

    // With a `fallback`, which is the default scene, SCENE may be left out, or be named with
    // --scene.
    void addTo(CLI::App& command, const std::string& fallback = "");
    // Adds only the options.
    void addOptionsTo(CLI::App& command);
    // For commands that draw one number of lights.
    void addLightsTo(CLI::App& command);
    // For commands that make pictures to look at.
    void addDefaultLightTo(CLI::App& command);
    // The value of --lights, or nothing if it is not given. Throws UsageError.
    std::optional<uint32_t> lightCount() const;
    // Throws UsageError.
    SceneOptions options(std::optional<uint32_t> lights) const;
    // Warns on stderr about given options that have no effect on this scene.
    void warnOfIdleOptions(std::optional<uint32_t> lights) const;
};

// The options of a frame.
struct FrameArguments {
    std::string size, camera, fit;
    std::string gbuffer = "full", specular, culling = "clustered", shadows = "off";
    bool choosesShadows = false; // --shadows may be auto, which is the default
    std::string sampleCount = "64";
    std::string influence = "given", influenceError;
    std::string lightsVisible, reuse = "none", heatMap = "none", lod = "on", cullTriangles = "on";
    std::string exposure = "auto", compensation = "0", metering = "centre", toneMap = "neutral";
    std::string middleGrey = "0.18";

    void addTo(CLI::App& command);
    // Adds only the options of the place: size and camera.
    void addPlaceTo(CLI::App& command);
    // Adds only the options of what is seen: size, camera and visible lights.
    void addViewTo(CLI::App& command);
    // Adds all options but those of a single command. --shadows may be auto, and is by default.
    void addAllTo(CLI::App& command, Reuse fallback);
    void addFitTo(CLI::App& command);
    void addCullingTo(CLI::App& command);
    void addReuseTo(CLI::App& command, Reuse fallback);
    void addDebugTo(CLI::App& command);
    void addInfluenceTo(CLI::App& command);

    // The parts of addTo() after what is seen.
    void addDisplayTo(CLI::App& command);
    void addShadingTo(CLI::App& command);
    void addDrawingTo(CLI::App& command);

    // All of these throw UsageError for a value that they cannot read.
    PixelSize pixelSize(const Scene& scene, const Camera& camera) const;
    PixelSize givenSize() const; // --size, else 1280x720
    double imageAspect() const;  // width / height of --size, else of the usual size
    // Returns the camera that --camera and --fit choose.
    Camera chosenCamera(const Scene& scene) const;
    CndGBufferLayout gbufferLayout() const;
    CndSpecularMethod specularMethod() const;
    CndCulling cullingMode() const;
    CndInfluence influenceRule() const; // its exposure is set by the renderer
    // Empty: they are to be found unless they take too long (generate/shadow_cost.h).
    std::optional<uint32_t> shadowPoints() const;
    HeatMap heatMapMode() const; // throws if culling is not clustered
    std::optional<bool> lightsVisibleOverride() const;
    CndExposureSettings exposureSettings() const;
    // All of the above that a frame has, without its camera. No shadows if that is not decided.
    FrameOptions frameOptions() const;
};

// Adds an option whose value is kept as text, which --help shows as the default.
CLI::Option* addOption(CLI::App& command, const std::string& names, std::string& text,
                       const char* type, const std::string& what);
// Adds an option with a choice of names. The names are appended to the description.
template <typename T, size_t N>
void addChoice(CLI::App& command, const std::string& option, std::string& text,
               const Choice<T> (&choices)[N], const std::string& what)
{
    addOption(command, option, text, "NAME",
              what + ": " + names<T>(std::span<const Choice<T>>(choices)));
}

// Read the value or the list of values in `text`. Throw a UsageError that names the option, its
// text and the range if it is something else.
uint32_t unsignedOption(const std::string& option, const std::string& text, uint32_t min,
                        uint32_t max);
double numberOption(const std::string& option, const std::string& text, double min, double max);
std::vector<uint32_t> unsignedListOption(const std::string& option, const std::string& text,
                                         uint32_t min, uint32_t max);
PixelSize sizeOption(const std::string& option, const std::string& text); // up to maxSide
std::vector<uint32_t> lightTypesOption(const std::string& option, const std::string& text);

// Adds the option --warm-up, whose value is a number of seconds from 0 to maxWarmUpSeconds.
void addWarmUpTo(CLI::App& command, std::string& seconds);
constexpr double maxWarmUpSeconds = 60;

// The largest width and height of an image in pixels. It is the limit of the engine's modules.
constexpr uint32_t maxSide = 16384;

// Says what is wrong with arguments that `app` could not parse, in place of the messages of CLI11.
std::string parserSentence(const CLI::App& app, const CLI::ParseError& error);

} // namespace candelabra::app
