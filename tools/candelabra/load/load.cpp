// SPDX-License-Identifier: Apache-2.0
#include "load/load.h"

#include <algorithm>
#include <cfloat>
#include <cmath>
#include <filesystem>
#include <limits>
#include <span>

#include <fmt/format.h>

#include "candelabra/glm.hpp"
#include "generate/generators.h"
#include "generate/lights.h"
#include "gltf/gltf.h"
#include "io/suggestion.h"
#include "load/auto_cameras.h"
#include "load/brightness.h"
#include "load/studio.h"
#include "scene/file_kind.h"
#include "scene/scene_error.h"
#include "scene/scene_file.h"
#include "json/scene_json.h"

namespace candelabra::app
{

namespace
{

// Three digits, without an exponent where people do not expect one.
std::string rounded(double value)
{
    return value >= 1000 && value < 1e9 ? fmt::format("{:.0f}", value)
                                        : fmt::format("{:.3g}", value);
}

bool fileExists(const std::string& path)
{
    std::error_code ignored;
    return path.find('\0') == std::string::npos && std::filesystem::exists(path, ignored);
}

Scene loadFile(const std::string& scene, const SceneOptions& options)
{
    refuseOtherFiles(scene);
    if (isGltf(scene))
        return loadGltf(scene, options);
    if (hasExtension(scene, ".json") || fileExists(scene))
        return loadSceneJson(scene);
    throw SceneError(
        "unknown scene \"" + printable(scene, 4096) +
        "\": use hall, field, fence, rooms, showcase, or the path of a .gltf, .glb or .json file" +
        didYouMean(scene, {"hall", "field", "fence", "rooms", "showcase"}));
}

// Adds random lights that are together about as bright as what lights a glTF file already. Scene
// descriptions say what is measured, so there the brightness of added lights does not depend on
// others.
void addLights(Scene& scene, bool gltf, const SceneOptions& options)
{
    const bool matches = gltf && options.lights.value_or(0) && isLit(scene);
    const double present = matches ? typicalIlluminance(scene) : 0;
    if (!(present > 0))
        return addRandomLights(scene, options);
    // The mean illuminance within the reach of a light is 3 times that at its edge, and a surface
    // is within the reach of so many lights.
    const double lights =
        options.overlaps.value_or(std::min(defaultOverlaps, 0.5 * options.lights.value_or(0)));
    addRandomLights(scene, options, float(present / (3 * lights)));
}

Scene loadWithLights(const std::string& scene, std::optional<SceneEnvironment> environment,
                     const SceneOptions& options)
{
    if (isBuiltIn(scene)) {
        Scene made = generateScene(scene, options);
        if (environment)
            made.exposureCompensation = 0; // under a sky it is not night
        made.environment = std::move(environment);
        return made;
    }
    Scene loaded = loadFile(scene, options); // first, because it says what is wrong with the path
    const bool gltf = isGltf(scene);
    loaded.environment = std::move(environment);
    if (gltf) // scene descriptions have a camera of their own
        addAutomaticCameras(loaded, options.imageAspect);
    if (options.lights)
        addLights(loaded, gltf, options);
    return loaded;
}

// Replaces what is no luminance, in the channels that have it. Returns a sentence about that, or an
// empty text if there is nothing to replace.
std::string repairTexels(const std::string& file, Image& image)
{
    constexpr float most = CND_ENVIRONMENT_MAX_LUMINANCE;
    float greatest = 0; // that is finite
    for (const float x : image.pixels)
        if (std::isfinite(x))
            greatest = std::max(greatest, x);
    greatest = std::min(greatest, most);
    size_t nan = 0, infinite = 0, negative = 0, large = 0; // texels
    for (size_t i = 0; i < image.pixels.size(); i += image.channels) {
        const std::span<float> texel(&image.pixels[i], image.channels);
        const auto has = [&](auto is) { return std::ranges::any_of(texel, is); };
        nan += has([](float x) { return std::isnan(x); });
        infinite += has([](float x) { return x > FLT_MAX; });
        negative += has([](float x) { return x < 0; });
        large += has([](float x) { return x > most && x <= FLT_MAX; });
        for (float& x : texel)
            x = x > FLT_MAX ? greatest : x > 0 ? std::min(x, most) : 0;
    }
    std::vector<std::string> parts;
    const auto add = [&](size_t count, const std::string& what) {
        if (count > 0)
            parts.push_back(fmt::format("{} {}", count, what));
    };
    add(nan, "are NaN (0 is used)");
    add(negative, "negative (0 is used)");
    add(infinite, fmt::format("infinite ({:g} is used, the greatest of the others)", greatest));
    add(large, fmt::format("above {:g} cd/m^2 (which is used)", most));
    return parts.empty()
               ? ""
               : fmt::format("environment {}: of its {} texels {}", file,
                             image.pixels.size() / image.channels, fmt::join(parts, ", "));
}

SceneEnvironment loadEnvironment(const SceneOptions& options)
{
    SceneEnvironment out;
    out.file = options.environment;
    out.rotation = options.environmentRotation;
    try {
        out.radiance = loadImageByExtension(options.environment);
    } catch (const ImageError& error) {
        throw SceneError(std::string("--environment: ") + error.what());
    }
    if (const std::string text = repairTexels(out.file, out.radiance); !text.empty())
        out.radiance.warnings.push_back(text);
    if (!options.environmentIlluminance) {
        out.scale = options.environmentScale;
        return out;
    }
    const double illuminance = groundIlluminance(out);
    if (!(illuminance > 0))
        throw SceneError("--environment-illuminance: " + options.environment +
                         " gives level ground no light, so no factor makes it brighter");
    out.scale = *options.environmentIlluminance / illuminance;
    return out;
}

// Says how bright the environment is, and warns if it and the suns of the scene are so different
// that one of them cannot be seen.
void describeEnvironment(Scene& scene)
{
    constexpr double different = 100;
    const SceneEnvironment& environment = *scene.environment;
    for (const std::string& warning : environment.radiance.warnings)
        scene.warnings.push_back(warning);
    const double illuminance = groundIlluminance(environment);
    std::string note = fmt::format("environment {}: {} lx on level ground", environment.file,
                                   rounded(illuminance));
    if (environment.scale != 1)
        note += fmt::format(", its image times {}", rounded(environment.scale));
    scene.notes.push_back(note);
    const double sun = sunIlluminance(scene);
    if (sun > 0 && illuminance > 0 && std::max(sun / illuminance, illuminance / sun) > different)
        scene.warnings.push_back(fmt::format(
            "the environment gives level ground {} lx and the suns of the scene give {} lx, so {} "
            "will hardly be seen; --environment-illuminance LX scales the environment",
            rounded(illuminance), rounded(sun), sun > illuminance ? "the environment" : "they"));
}

// Tells whether a surface glows so brightly that it would be white with studioEv100(). Unlit
// surfaces do not glow: what they emit is their colour, and studioWhite() has weighed them.
bool outshinesStudio(const Scene& scene, float white)
{
    const float most = 4 * white; // cd/m^2
    return std::ranges::any_of(scene.instances, [&](const Instance& instance) {
        const Material& material = scene.materials[instance.material];
        const glm::vec3& e = material.emission;
        return !material.unlit && std::max({e.r, e.g, e.b}) > most;
    });
}

bool hasSomethingToDraw(const Scene& scene)
{
    return !scene.instances.empty() || !scene.analyticObjects.empty() ||
           std::ranges::any_of(scene.lights,
                               [](const CndLight& light) { return !cndIsPunctual(light.type); });
}

// Lights a scene without light by a studio.
void addStudio(Scene& scene)
{
    const float white = studioWhite(scene);
    scene.environment = studioEnvironment(scene.cameras[scene.defaultCamera], white);
    scene.exposureCompensation = 0;
    if (!outshinesStudio(scene, white))
        scene.knownEv100 = studioEv100(white);
    scene.notes.push_back(scene.name + " has no light, so a studio lights it (" +
                          rounded(groundIlluminance(*scene.environment)) +
                          " lx on level ground); --default-light off turns it off");
}

// Warns of highlights that are narrower than the engine draws them. Textures are left out of
// account: they may make surfaces smoother than their material says.
void warnOfNarrowLobes(const std::string& file, Scene& scene)
{
    std::vector<bool> used(scene.materials.size());
    for (const Instance& instance : scene.instances)
        used[instance.material] = true;
    for (const AnalyticObject& object : scene.analyticObjects)
        used[object.material] = true;
    const auto alphaOf = [](const Material& m) {
        return m.perceptualRoughness * m.perceptualRoughness;
    };
    std::optional<size_t> first;
    size_t others = 0;
    for (size_t i = 0; i < used.size(); ++i) {
        const Material& m = scene.materials[i];
        const bool hasLobe =
            m.specularWeight > 0 || m.metalness > 0 || m.dielectricF0 != glm::vec3(0);
        // The square of the root of 0.002 may be a little less.
        if (!used[i] || m.unlit || !hasLobe || alphaOf(m) >= CND_MIN_ALPHA * (1 - 1e-6f))
            continue;
        others += first.has_value();
        first = first.value_or(i);
    }
    if (!first)
        return;
    const Material& m = scene.materials[*first];
    scene.warnings.push_back(fmt::format(
        "{}: material {}{}: alpha, the square of its roughness, is {:.3g}; render uses {:g}, the "
        "width of its narrowest highlights, and truth at least 1e-4",
        printable(file, 4096),
        m.name.empty() ? std::to_string(*first) : '"' + printable(m.name, 60) + '"',
        others ? fmt::format(" (and {} {})", others, others == 1 ? "other" : "others") : "",
        alphaOf(m), CND_MIN_ALPHA));
}

// Adds the box around the emitter of a light, wherever its motion takes it.
void addEmitter(const Scene& scene, size_t index, Bounds& bounds)
{
    const CndLight& light = scene.lights[index];
    if (cndIsDistant(light.type) || cndIsPunctual(light.type))
        return;
    double reach = double{cndEmitterBoundingRadius(&light)};
    if (index < scene.lightMotions.size())
        reach += double{glm::length(scene.lightMotions[index].axisU)} +
                 double{glm::length(scene.lightMotions[index].axisV)};
    const glm::dvec3 centre = scene.lightOrigin + glm::dvec3(toGlm(light.position));
    bounds.min = glm::min(bounds.min, centre - reach);
    bounds.max = glm::max(bounds.max, centre + reach);
}

// Moves the near and far plane of every orthographic camera to the scene, with room on either side
// as wide as the scene for what a user moves. The planes only come closer together, so what a
// camera did not show stays out of the picture. Orthographic depth is linear, and float rounds it
// to 6e-8 of the range: files with a far plane at 1e6 m would have surfaces wrong by centimetres.
// Perspective cameras need no such thing: their depth is reversed, and its error is 6e-8 of the
// distance whatever the far plane.
void fitDepthRanges(Scene& scene)
{
    constexpr double infinity = std::numeric_limits<double>::infinity();
    Bounds bounds{glm::dvec3(infinity), glm::dvec3(-infinity)};
    if (!scene.instances.empty())
        bounds = sceneBounds(scene);
    for (size_t i = 0; i < scene.lights.size(); ++i)
        addEmitter(scene, i, bounds);
    if (!(bounds.min.x <= bounds.max.x))
        return;
    const glm::dvec3 middle = 0.5 * (bounds.min + bounds.max), half = bounds.max - middle;
    for (Camera& camera : scene.cameras) {
        if (!camera.orthographic)
            continue;
        const double depth = glm::dot(middle - camera.position, camera.forward);
        const double reach = 3 * glm::length(half);
        const double nearPlane = std::max(camera.nearPlane, depth - reach);
        const double farPlane = std::min(camera.farPlane, depth + reach);
        if (farPlane > nearPlane) { // else the camera shows nothing
            camera.nearPlane = nearPlane;
            camera.farPlane = farPlane;
        }
    }
}

} // namespace

Scene loadScene(const std::string& scene, const SceneOptions& options)
{
    // The environment is loaded before the scene, which may take long to make: a typing error in
    // the environment's name is found at once.
    std::optional<SceneEnvironment> environment;
    if (!options.environment.empty())
        environment = loadEnvironment(options);
    Scene out = loadWithLights(scene, std::move(environment), options);
    if (options.defaultLight && !isLit(out) && hasSomethingToDraw(out)) {
        // Scene descriptions mean what they say: without light, they are dark.
        if (isBuiltIn(scene) || isGltf(scene))
            addStudio(out);
        else if (out.background == glm::vec3(0))
            out.notes.push_back(out.name + " has no light, so it is dark; --environment FILE "
                                           "lights it");
    } else if (out.environment) {
        describeEnvironment(out);
    }
    fitDepthRanges(out);
    warnOfNarrowLobes(scene, out);
    out.lobes = options.lobes.value_or(out.lobes);
    out.energyCompensation = options.energyCompensation.value_or(out.energyCompensation);
    return out;
}

void requireSomethingToDraw(const Scene& scene, const std::string& name)
{
    if (!hasSomethingToDraw(scene))
        throw SceneError(name + ": nothing to draw: there is no surface in it that the program can "
                                "draw, and no light that can be seen");
}

} // namespace candelabra::app
