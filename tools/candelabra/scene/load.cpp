// SPDX-License-Identifier: Apache-2.0
#include "scene/load.h"

#include <algorithm>
#include <cctype>
#include <filesystem>

#include <nlohmann/json.hpp>

#include "scene/scene_file.h"

namespace candelabra::app
{

namespace
{

enum class SceneFormat { Gltf, SceneJson };

std::string lowerExtension(const std::string& path)
{
    std::string extension = std::filesystem::path(path).extension().string();
    std::transform(extension.begin(), extension.end(), extension.begin(),
                   [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
    return extension;
}

// A file whose name says nothing: binary glTF by its magic, else JSON with or without the "asset"
// object that every glTF file has.
SceneFormat formatFromContent(const std::string& path)
{
    const std::vector<uint8_t> bytes = readSceneFile(path);
    const std::string_view text(reinterpret_cast<const char*>(bytes.data()), bytes.size());
    if (text.substr(0, 4) == "glTF")
        return SceneFormat::Gltf;
    const size_t start = text.find_first_not_of(" \t\r\n");
    if (start == std::string_view::npos || text[start] != '{')
        failScene(path, "", "is neither glTF (.gltf, .glb) nor a scene description (.json)");
    return parseSceneJson(path, text).contains("asset") ? SceneFormat::Gltf
                                                        : SceneFormat::SceneJson;
}

// Empty: the name does not say, and there is no such file.
std::optional<SceneFormat> fileFormat(const std::string& path)
{
    const std::string extension = lowerExtension(path);
    if (extension == ".gltf" || extension == ".glb")
        return SceneFormat::Gltf;
    if (extension == ".json")
        return SceneFormat::SceneJson;
    std::error_code ignored;
    if (path.find('\0') != std::string::npos || !std::filesystem::exists(path, ignored))
        return std::nullopt;
    return formatFromContent(path);
}

} // namespace

namespace
{

Scene loadWithoutEnvironment(const std::string& scene, const SceneOptions& options)
{
    if (scene == "hall")
        return generateHall(options);
    if (scene == "field")
        return generateField(options);
    if (scene == "fence")
        return generateFence(options);
    if (scene == "showcase")
        return generateShowcase(options);
    const auto format = fileFormat(scene);
    if (!format)
        throw SceneError(
            "unknown scene \"" + printable(scene, 4096) +
            "\": use hall, field, fence, showcase, or the path of a .gltf, .glb or .json file");
    Scene loaded = format == SceneFormat::Gltf ? loadGltf(scene, options) : loadSceneJson(scene);
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

bool isGenerated(const std::string& scene)
{
    return scene == "hall" || scene == "field" || scene == "fence";
}

bool isBuiltIn(const std::string& scene)
{
    return isGenerated(scene) || scene == "showcase";
}

bool isGltf(const std::string& scene)
{
    return !isBuiltIn(scene) && fileFormat(scene) == SceneFormat::Gltf;
}

Scene loadScene(const std::string& scene, const SceneOptions& options)
{
    // The small file first: a typing error in its name should not cost the making of a scene.
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
