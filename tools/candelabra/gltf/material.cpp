// SPDX-License-Identifier: Apache-2.0
#include "gltf/material.h"

#include <cmath>
#include <cstring>
#include <limits>
#include <map>
#include <memory>
#include <tuple>

#include <stb/stb_image.h>

#include "scene/scene_file.h"

namespace candelabra::app
{

namespace
{

// Finds the index in scene.textures for a glTF texture and a colour space. Each image is decoded
// once per colour space and sampler. Throws SceneError that names the image.
class GltfTextures
{
public:
    GltfTextures(const GltfDocument& document, Scene& scene) : document_(document), scene_(scene) {}

    // Returns -1, with a warning, if the texture has no PNG or JPEG image.
    int32_t find(int gltfTexture, bool srgb);

private:
    Texture decode(size_t image);

    const GltfDocument& document_;
    Scene& scene_;
    std::map<std::tuple<int, int, bool>, int32_t> known_; // (image, sampler, srgb) -> texture
    uint64_t texels_ = 0;                                 // decoded so far
};

constexpr int maxImageSide = 16384; // pixels; common Vulkan devices can sample that
// All textures of a scene together may have 2 GiB: a few kilobytes of PNG can unpack to a gigabyte.
constexpr uint64_t maxTexels = uint64_t{1} << 29;

// True for the two image formats of glTF 2.0. stb_image reads more formats, but its other decoders
// have a history of memory errors.
bool isPngOrJpeg(std::span<const uint8_t> bytes)
{
    constexpr uint8_t png[] = {0x89, 'P', 'N', 'G', '\r', '\n', 0x1a, '\n'};
    constexpr uint8_t jpeg[] = {0xff, 0xd8, 0xff};
    const auto startsWith = [&](std::span<const uint8_t> magic) {
        return bytes.size() > magic.size() &&
               std::memcmp(bytes.data(), magic.data(), magic.size()) == 0;
    };
    return startsWith(png) || startsWith(jpeg);
}

Texture decodeImage(const GltfDocument& document, const std::string& element,
                    std::span<const uint8_t> bytes, uint64_t texelsLeft)
{
    if (!isPngOrJpeg(bytes))
        document.fail(element, "is neither a PNG nor a JPEG image");
    if (bytes.size() > static_cast<size_t>(std::numeric_limits<int>::max()))
        document.fail(element, "is larger than 2 GiB");
    const auto* data = bytes.data();
    const int size = static_cast<int>(bytes.size());
    int width = 0, height = 0, channels = 0;
    const auto failDecode = [&] {
        const char* reason = stbi_failure_reason();
        document.fail(element,
                      "cannot be decoded: " + printable(reason ? reason : "unknown reason"));
    };
    if (!stbi_info_from_memory(data, size, &width, &height, &channels))
        failDecode();
    if (width < 1 || height < 1 || width > maxImageSide || height > maxImageSide)
        document.fail(element, "has " + std::to_string(width) + " x " + std::to_string(height) +
                                   " pixels; at most 16384 a side are allowed");
    if (static_cast<uint64_t>(width) * static_cast<uint64_t>(height) > texelsLeft)
        document.fail(element, "exceeds the 2 GiB of pixels that a scene's textures may have");
    const std::unique_ptr<stbi_uc, void (*)(void*)> pixels(
        stbi_load_from_memory(data, size, &width, &height, &channels, 4), stbi_image_free);
    if (!pixels)
        failDecode();
    Texture texture;
    texture.width = static_cast<uint32_t>(width);
    texture.height = static_cast<uint32_t>(height);
    const size_t count = static_cast<size_t>(width) * static_cast<size_t>(height) * 4;
    texture.rgba.assign(pixels.get(), pixels.get() + count);
    return texture;
}

// Sets wrapping and filtering. glTF uses the enumerants of OpenGL.
void applySampler(const tinygltf::Sampler& sampler, Texture& texture)
{
    texture.repeatU = sampler.wrapS != TINYGLTF_TEXTURE_WRAP_CLAMP_TO_EDGE;
    texture.repeatV = sampler.wrapT != TINYGLTF_TEXTURE_WRAP_CLAMP_TO_EDGE;
    texture.mirrorU = sampler.wrapS == TINYGLTF_TEXTURE_WRAP_MIRRORED_REPEAT;
    texture.mirrorV = sampler.wrapT == TINYGLTF_TEXTURE_WRAP_MIRRORED_REPEAT;
    texture.nearest = sampler.magFilter == TINYGLTF_TEXTURE_FILTER_NEAREST;
}

int32_t GltfTextures::find(int gltfTexture, bool srgb)
{
    const auto index = static_cast<size_t>(gltfTexture);
    const tinygltf::Texture& source = document_.model.textures[index];
    if (source.source < 0) {
        document_.warn(gltfElement("textures", index), "has no PNG or JPEG image and is left out");
        return -1;
    }
    const auto key = std::make_tuple(source.source, source.sampler, srgb);
    if (const auto found = known_.find(key); found != known_.end())
        return found->second;
    Texture texture = decode(static_cast<size_t>(source.source));
    texture.srgb = srgb;
    if (source.sampler >= 0)
        applySampler(document_.model.samplers[static_cast<size_t>(source.sampler)], texture);
    scene_.textures.push_back(std::move(texture));
    const auto result = static_cast<int32_t>(scene_.textures.size() - 1);
    known_.emplace(key, result);
    return result;
}

Texture GltfTextures::decode(size_t image)
{
    const nlohmann::json& json = document_.json["images"][image];
    std::string element = gltfElement("images", image);
    const bool hasUri = json.contains("uri"), hasView = json.contains("bufferView");
    if (hasUri == hasView)
        document_.fail(element, "must have either a uri or a bufferView");
    std::vector<uint8_t> file;
    std::span<const uint8_t> bytes;
    if (hasUri) {
        const std::string uri = json["uri"].get<std::string>();
        file = readGltfUri(document_, uri, element + ".uri");
        bytes = file;
        if (uri.substr(0, 5) != "data:")
            element += " (" + printable(uri, 80) + ")";
    } else {
        bytes = document_.bufferView(json["bufferView"].get<int>(), element);
    }
    Texture texture = decodeImage(document_, element, bytes, maxTexels - texels_);
    texels_ += static_cast<uint64_t>(texture.width) * texture.height;
    return texture;
}

// Clamps a factor to [0, 1]. Rounding by exporters may have moved it out by up to 1e-4; larger
// errors were refused when the file was opened.
float unit(double x)
{
    return static_cast<float>(glm::clamp(x, 0.0, 1.0));
}

glm::vec3 unitColor(const std::vector<double>& v)
{
    return {unit(v[0]), unit(v[1]), unit(v[2])};
}

double numberOr(const nlohmann::json& object, const char* key, double otherwise)
{
    const auto found = object.find(key);
    return found == object.end() ? otherwise : found->get<double>();
}

glm::dvec2 vector2Or(const nlohmann::json& object, const char* key, glm::dvec2 otherwise)
{
    const auto found = object.find(key);
    return found == object.end() ? otherwise
                                 : glm::dvec2((*found)[0].get<double>(), (*found)[1].get<double>());
}

class MaterialReader
{
public:
    MaterialReader(const GltfDocument& document, Scene& scene)
        : document_(document), textures_(document, scene)
    {
    }

    Material read(size_t index);

private:
    // Reads owner[slot], a textureInfo. Without it the reference is empty.
    TextureRef textureRef(const nlohmann::json& owner, const char* slot, bool srgb);
    void readSurface(const tinygltf::Material& source, const nlohmann::json& json,
                     Material& material);
    void readEmission(const tinygltf::Material& source, const nlohmann::json& json,
                      Material& material);
    void readDielectric(const nlohmann::json& json, Material& material);

    const GltfDocument& document_;
    GltfTextures textures_;
    std::string element_; // "materials[3]"
};

TextureRef MaterialReader::textureRef(const nlohmann::json& owner, const char* slot, bool srgb)
{
    TextureRef ref;
    const auto found = owner.find(slot);
    if (found == owner.end())
        return ref;
    const nlohmann::json& info = *found;
    int64_t uvSet = info.contains("texCoord") ? info["texCoord"].get<int64_t>() : 0;
    if (const auto* transform = GltfDocument::extension(info, "KHR_texture_transform")) {
        uvSet = transform->contains("texCoord") ? (*transform)["texCoord"].get<int64_t>() : uvSet;
        const glm::dvec2 offset = vector2Or(*transform, "offset", {0, 0});
        const glm::dvec2 scale = vector2Or(*transform, "scale", {1, 1});
        const double angle = numberOr(*transform, "rotation", 0);
        const double c = std::cos(angle), s = std::sin(angle);
        // The map is offset * rotation * scale. The rotation is counter-clockwise with v pointing
        // down; the code in the extension's text has the wrong sign of the sine (glTF issue 1563).
        ref.uRow = glm::vec3(c * scale.x, s * scale.y, offset.x);
        ref.vRow = glm::vec3(-s * scale.x, c * scale.y, offset.y);
    }
    if (uvSet > 1) {
        document_.warn(element_ + "." + slot, "uses TEXCOORD_" + std::to_string(uvSet) +
                                                  " and is left out; sets 0 and 1 are supported");
        return TextureRef{};
    }
    ref.uvSet = static_cast<uint32_t>(uvSet);
    ref.texture = textures_.find(info["index"].get<int>(), srgb);
    return ref;
}

void MaterialReader::readSurface(const tinygltf::Material& source, const nlohmann::json& json,
                                 Material& material)
{
    const tinygltf::PbrMetallicRoughness& pbr = source.pbrMetallicRoughness;
    material.baseColor = unitColor(pbr.baseColorFactor);
    material.alpha = unit(pbr.baseColorFactor[3]);
    material.metalness = unit(pbr.metallicFactor);
    material.perceptualRoughness = unit(pbr.roughnessFactor);
    if (const auto found = json.find("pbrMetallicRoughness"); found != json.end()) {
        material.baseColorTexture = textureRef(*found, "baseColorTexture", true);
        material.metallicRoughnessTexture = textureRef(*found, "metallicRoughnessTexture", false);
    }
    material.normalTexture = textureRef(json, "normalTexture", false);
    material.normalScale = static_cast<float>(source.normalTexture.scale);
    material.doubleSided = source.doubleSided;
    material.alphaCutoff = static_cast<float>(source.alphaCutoff);
    if (source.alphaMode == "MASK")
        material.alphaMode = AlphaMode::Mask;
    else if (source.alphaMode == "BLEND")
        document_.warn(element_, "is blended by alpha; it is drawn opaque");
}

void MaterialReader::readEmission(const tinygltf::Material& source, const nlohmann::json& json,
                                  Material& material)
{
    const auto* extension = GltfDocument::extension(json, "KHR_materials_emissive_strength");
    const double strength = extension ? numberOr(*extension, "emissiveStrength", 1) : 1;
    // The unit is cd/m^2 (glTF 2.0, section 3.9.4).
    material.emission = glm::vec3(glm::dvec3(unitColor(source.emissiveFactor)) * strength);
    material.emissiveTexture = textureRef(json, "emissiveTexture", true);
}

// Reads F0 and F90 of the dielectric part. KHR_materials_ior: F0 = ((n-1)/(n+1))^2, where n = 0
// stands for total reflection. KHR_materials_specular: F0 = min(F0 * colour, 1) * factor and F90 =
// factor.
void MaterialReader::readDielectric(const nlohmann::json& json, Material& material)
{
    double f0 = 0.04;
    if (const auto* extension = GltfDocument::extension(json, "KHR_materials_ior")) {
        const double n = numberOr(*extension, "ior", 1.5);
        if (n != 0 && n < 1)
            document_.fail(element_ + ".extensions.KHR_materials_ior.ior",
                           "must be 0 or >= 1, is " + std::to_string(n));
        f0 = n == 0 ? 1 : std::pow((n - 1) / (n + 1), 2);
    }
    material.dielectricF0 = glm::vec3(static_cast<float>(f0));
    const auto* specular = GltfDocument::extension(json, "KHR_materials_specular");
    if (!specular)
        return;
    const float factor = unit(numberOr(*specular, "specularFactor", 1));
    glm::dvec3 color{1};
    if (const auto found = specular->find("specularColorFactor"); found != specular->end())
        for (int i = 0; i < 3; ++i)
            color[i] = (*found)[static_cast<size_t>(i)].get<double>();
    material.dielectricF0 = glm::vec3(glm::min(f0 * color, glm::dvec3(1))) * factor;
    // A material has one F90: the factor applies to its dielectric part and 1 to its metallic part,
    // in the proportion of the metalness factor.
    material.specularWeight = glm::mix(factor, 1.0f, material.metalness);
    for (const char* slot : {"specularTexture", "specularColorTexture"})
        if (specular->contains(slot))
            document_.warn(element_, std::string(slot) + " is left out; only its factor is used");
    if (factor < 1 && material.metallicRoughnessTexture.texture >= 0)
        document_.warn(element_,
                       "specularFactor is weighted by metallicFactor alone, without its texture");
}

Material MaterialReader::read(size_t index)
{
    element_ = gltfElement("materials", index);
    const tinygltf::Material& source = document_.model.materials[index];
    const nlohmann::json& json = document_.json["materials"][index];
    Material material;
    material.name = source.name;
    readSurface(source, json, material);
    readEmission(source, json, material);
    readDielectric(json, material);
    if (GltfDocument::extension(json, "KHR_materials_unlit"))
        document_.warn(element_, "is unlit; it is lit like every other material here");
    const float largest = std::numeric_limits<float>::max();
    for (int i = 0; i < 3; ++i)
        if (!(material.emission[i] <= largest))
            document_.fail(element_, "emits more than single precision holds");
    return material;
}

} // namespace

uint32_t readGltfMaterials(const GltfDocument& document, Scene& scene)
{
    MaterialReader reader(document, scene);
    for (size_t i = 0; i < document.model.materials.size(); ++i)
        scene.materials.push_back(reader.read(i));
    bool isDefaultUsed = false;
    for (const tinygltf::Mesh& mesh : document.model.meshes)
        for (const tinygltf::Primitive& primitive : mesh.primitives)
            isDefaultUsed = isDefaultUsed || primitive.material < 0;
    if (!isDefaultUsed)
        return 0;
    // The default material is white, metallic and rough (glTF 2.0, section 3.7.2.1).
    Material material;
    material.name = "glTF default";
    material.metalness = 1;
    scene.materials.push_back(material);
    return static_cast<uint32_t>(scene.materials.size() - 1);
}

} // namespace candelabra::app
