// SPDX-License-Identifier: Apache-2.0
#include "load/load.h"

#include <filesystem>

#include "generate/generators.h"
#include "generate/lights.h"
#include "gltf/gltf.h"
#include "io/suggestion.h"
#include "scene/file_kind.h"
#include "scene/scene_error.h"
#include "scene/scene_file.h"
#include "json/scene_json.h"

namespace candelabra::app
{

namespace
{

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
        "\": use hall, field, fence, showcase, or the path of a .gltf, .glb or .json file" +
        didYouMean(scene, {"hall", "field", "fence", "showcase"}));
}

Scene loadWithoutEnvironment(const std::string& scene, const SceneOptions& options)
{
    if (isBuiltIn(scene))
        return generateScene(scene, options);
    Scene loaded = loadFile(scene, options);
    if (options.lights)
        addRandomLights(loaded, options);
    return loaded;
}

SceneEnvironment loadEnvironment(const SceneOptions& options)
{
    try {
        return {.file = options.environment,
                .radiance = loadImageByExtension(options.environment),
                .rotation = options.environmentRotation,
                .scale = options.environmentScale};
    } catch (const ImageError& error) {
        throw SceneError(std::string("--environment: ") + error.what());
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
    Scene out = loadWithoutEnvironment(scene, options);
    out.environment = std::move(environment);
    out.lobes = options.lobes.value_or(out.lobes);
    out.energyCompensation = options.energyCompensation;
    return out;
}

} // namespace candelabra::app
