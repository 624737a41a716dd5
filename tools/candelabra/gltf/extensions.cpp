// SPDX-License-Identifier: Apache-2.0
#include "gltf/document.h"

#include <algorithm>
#include <array>
#include <set>
#include <string_view>

#include "scene/json_value.h"
#include "scene/scene_file.h"

namespace candelabra::app
{

namespace
{

// The extensions that the loader reads wholly.
constexpr std::array<std::string_view, 16> wholeExtensions = {
    "EXT_mesh_gpu_instancing", "EXT_meshopt_compression", "EXT_texture_webp",
    "KHR_draco_mesh_compression", "KHR_lights_area", "KHR_lights_punctual",
    "KHR_materials_emissive_strength", "KHR_materials_ior", "KHR_materials_pbrSpecularGlossiness",
    "KHR_materials_specular", "KHR_materials_unlit", "KHR_mesh_quantization",
    "KHR_meshopt_compression", "KHR_texture_transform",
    // These only name things or say where they come from.
    "KHR_xmp", "KHR_xmp_json_ld"};

// The effects that a picture lacks because the loader does not read an extension, or not all of it.
struct Gap {
    std::string_view extension;
    std::string_view consequence; // what the picture lacks, and what helps
    bool isReadInPart = false;
};

constexpr Gap gaps[] = {
    {"EXT_lights_ies", "lights shine as if they had no profile"},
    {"EXT_lights_image_based", "its environment is left out; --environment FILE adds one"},
    {"EXT_mesh_features", "the features that it numbers are not needed for a picture"},
    {"EXT_structural_metadata", "its tables of data are not needed for a picture"},
    {"EXT_texture_avif", "AVIF textures are left out; export with PNG, JPEG or WebP textures"},
    {"KHR_animation_pointer", "nothing moves"},
    {"KHR_gaussian_splatting", "clouds of splats are left out"},
    {"KHR_materials_anisotropy", "highlights are drawn round"},
    {"KHR_materials_clearcoat", "coats are left out"},
    {"KHR_materials_diffuse_transmission", "surfaces let no light through"},
    {"KHR_materials_dispersion", "glass does not split light into colours"},
    {"KHR_materials_iridescence", "thin films are left out"},
    {"KHR_materials_sheen", "sheen is left out"},
    {"KHR_materials_transmission",
     "by its factor, glass is drawn as a thin veil, which neither bends nor colours what is behind "
     "it; materials with a texture of their "
     "transmission are drawn opaque",
     true},
    {"KHR_materials_variants", "the default variant of each material is drawn"},
    {"KHR_materials_volume",
     "glass with a thickness is drawn opaque; what bodies of glass bend and absorb is left out",
     true},
    {"KHR_node_visibility", "hidden nodes are drawn too"},
    {"KHR_technique_webgl",
     "materials with shaders of their own are drawn as plain metal; export them as "
     "metallic-roughness"},
    {"KHR_texture_basisu", "KTX2 textures are left out; export with PNG, JPEG or WebP textures"},
    {"MSFT_lod", "the finest level of detail is drawn"},
    {"MSFT_texture_dds", "DDS textures are left out; export with PNG, JPEG or WebP textures"}};

bool isReadWhole(const std::string& extension)
{
    return std::ranges::find(wholeExtensions, extension) != wholeExtensions.end();
}

std::string quoted(const std::string& extension)
{
    return "\"" + printable(extension, 60) + "\"";
}

// Returns the extensions in the list `key` of the document of which the loader reads nothing or
// only a part.
std::set<std::string> namesWithGaps(const JsonValue& document, const char* key)
{
    std::set<std::string> names;
    const auto list = document.find(key);
    if (!list)
        return names;
    for (size_t i = 0; i < list->size(); ++i)
        if (const std::string& name = list->item(i).string(); !isReadWhole(name))
            names.insert(name);
    return names;
}

// Returns the gap that an extension leaves which is not one of wholeExtensions.
Gap gapOf(const std::string& name)
{
    const auto known = std::ranges::find(gaps, name, &Gap::extension);
    return known == std::end(gaps) ? Gap{name, "what it adds is left out"} : *known;
}

} // namespace

std::string checkGltfExtensions(const std::string& file, const nlohmann::json& json,
                                LoadWarnings& warnings)
{
    const JsonValue document(file, json);
    document.requireObject();
    std::set<std::string> used = namesWithGaps(document, "extensionsUsed");
    const std::set<std::string> required = namesWithGaps(document, "extensionsRequired");
    used.insert(required.begin(), required.end());
    for (const std::string& name : used) {
        const Gap gap = gapOf(name);
        warnings.add("", "extension " + quoted(name) +
                             (gap.isReadInPart ? " is read in part: " : " is not supported: ") +
                             std::string(gap.consequence));
    }
    std::string phrase;
    for (const std::string& name : required)
        if (!gapOf(name).isReadInPart)
            phrase += (phrase.empty() ? "" : ", ") + quoted(name);
    return phrase;
}

} // namespace candelabra::app
