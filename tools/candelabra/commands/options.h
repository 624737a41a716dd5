// SPDX-License-Identifier: Apache-2.0
// Options that several commands share, described and checked once.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include <CLI/CLI.hpp>

#include "candelabra/candelabra.h"
#include "io/parse.h"
#include "render/renderer.h"
#include "render/vulkan_context.h"
#include "scene/scene_options.h"

namespace candelabra::app
{

// What every command gets from main.
struct ProgramContext {
    std::string commandLine;
    bool quiet = false;
};

struct DeviceArguments {
    std::string device;
    bool validate = false;

    void addTo(CLI::App& command);
    ContextOptions contextOptions(Presentation presentation = Presentation::Headless) const;
    // Throws UsageError when the device has no room for as many lights: before a scene with them
    // is made, which takes long.
    void requireRoomFor(uint32_t lights) const;
};

// How the lobes of materials share the light.
struct LobeArguments {
    std::string lobes;
    bool energyCompensation = false;

    void addTo(CLI::App& command);
    void applyTo(SceneOptions& options) const; // throws UsageError
};

// SCENE and what shapes it. The number of lights is the command's: one for `render`, a list for
// `stress`.
struct SceneArguments {
    std::string scene, lightsOption;
    std::string seed, overlaps, punctualRadius, sunRadius;
    std::string environment, environmentRotation, environmentScale;
    LobeArguments lobes;
    bool moving = false;

    // With a `fallback` the scene may be left out and named with --scene as well.
    void addTo(CLI::App& command, const std::string& fallback = "");
    // For commands that draw one number of lights.
    void addLightsTo(CLI::App& command);
    std::optional<uint32_t> lightCount() const; // empty: not given. Throws UsageError
    // Throws UsageError.
    SceneOptions options(std::optional<uint32_t> lights) const;
    // Warns on stderr of options given that change nothing about this scene.
    void warnOfIdleOptions(std::optional<uint32_t> lights) const;
};

// How a frame is made.
struct FrameArguments {
    std::string size, camera;
    std::string gbuffer = "full", specular, culling = "clustered";
    std::string sampleCount = "64", errorBudget = "0";
    std::string influence = "given", influenceError;
    std::string lightsVisible, reuse, heatMap = "none";
    std::string exposure = "auto", compensation = "0", metering = "centre", toneMap = "neutral";

    void addTo(CLI::App& command);
    // Of those only what is seen: size, camera and visible lights.
    void addViewTo(CLI::App& command);
    void addCullingTo(CLI::App& command);
    void addReuseTo(CLI::App& command, Reuse fallback);
    void addDebugTo(CLI::App& command);
    void addInfluenceTo(CLI::App& command);

    // All throw UsageError for what they cannot read.
    PixelSize pixelSize(const Scene& scene, const Camera& camera) const;
    CndGBufferLayout gbufferLayout() const;
    CndSpecularMethod specularMethod() const;
    uint32_t samples() const; // per light, of the specular method "sampled"
    float budget() const;     // CndLightingFrame::errorBudget
    CndCulling cullingMode() const;
    CndInfluence influenceRule() const; // without the exposure, which the renderer knows
    Reuse reuseMode() const;
    HeatMap heatMapMode() const; // with clustered culling only
    std::optional<bool> lightsVisibleOverride() const;
    CndExposureSettings exposureSettings() const;
};

// Numbers of options: a sentence that names the option, its text and the range otherwise.
uint32_t unsignedOption(const std::string& option, const std::string& text, uint32_t min,
                        uint32_t max);
double numberOption(const std::string& option, const std::string& text, double min, double max);
std::vector<uint32_t> unsignedListOption(const std::string& option, const std::string& text,
                                         uint32_t min, uint32_t max);

constexpr uint32_t maxSide = 16384; // pixels of an image: the modules' limit

} // namespace candelabra::app
