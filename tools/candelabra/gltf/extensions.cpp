// SPDX-License-Identifier: Apache-2.0
#include "gltf/extensions.h"

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

constexpr std::array<std::string_view, 16> supportedExtensions = {
    "EXT_mesh_gpu_instancing", "EXT_meshopt_compression", "EXT_texture_webp",
    "KHR_draco_mesh_compression", "KHR_lights_area", "KHR_lights_punctual",
    "KHR_materials_emissive_strength", "KHR_materials_ior", "KHR_materials_pbrSpecularGlossiness",
    "KHR_materials_specular", "KHR_materials_unlit", "KHR_mesh_quantization",
    "KHR_meshopt_compression", "KHR_texture_transform",
    // These only name things or say where they come from.
    "KHR_xmp", "KHR_xmp_json_ld"};

// An extension that is not read, or not all of it.
struct Unread {
    std::string_view extension;
    std::string_view consequence; // what the picture lacks, and what helps
    bool isReadInPart = false;
};

constexpr Unread unreadExtensions[] = {
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

bool isSupported(const std::string& extension)
{
    return std::find(supportedExtensions.begin(), supportedExtensions.end(), extension) !=
           supportedExtensions.end();
}

std::string quoted(const std::string& extension)
{
    return "\"" + printable(extension, 60) + "\"";
}

// Returns the names in the list `key` of the document that the loader does not support.
std::set<std::string> unsupportedNames(const JsonValue& document, const char* key)
{
    std::set<std::string> names;
    const auto list = document.find(key);
    if (!list)
        return names;
    list->requireArray();
    for (size_t i = 0; i < list->size(); ++i)
        if (const std::string& name = list->item(i).string(); !isSupported(name))
            names.insert(name);
    return names;
}

// Returns the entry of unreadExtensions for an extension that is not read, or not all of it; for
// one that has no entry, a general sentence.
Unread unreadExtension(const std::string& name)
{
    const auto known = std::find_if(std::begin(unreadExtensions), std::end(unreadExtensions),
                                    [&](const Unread& u) { return u.extension == name; });
    return known == std::end(unreadExtensions) ? Unread{name, "what it adds is left out"} : *known;
}

} // namespace

std::string checkGltfExtensions(const std::string& file, const nlohmann::json& json,
                                GltfWarnings& warnings)
{
    const JsonValue document(file, json);
    document.requireObject();
    std::set<std::string> unread = unsupportedNames(document, "extensionsUsed");
    const std::set<std::string> required = unsupportedNames(document, "extensionsRequired");
    unread.insert(required.begin(), required.end());
    for (const std::string& name : unread) {
        const Unread u = unreadExtension(name);
        warnings.add("", "extension " + quoted(name) +
                             (u.isReadInPart ? " is read in part: " : " is not supported: ") +
                             std::string(u.consequence));
    }
    std::string phrase;
    for (const std::string& name : required)
        if (!unreadExtension(name).isReadInPart)
            phrase += (phrase.empty() ? "" : ", ") + quoted(name);
    return phrase;
}

} // namespace candelabra::app
