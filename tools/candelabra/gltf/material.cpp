// SPDX-License-Identifier: Apache-2.0
#include "gltf/material.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <set>
#include <tuple>

#include <glm/gtc/type_ptr.hpp>

#include "scene/scene_error.h"
#include "scene/scene_file.h"

namespace candelabra::app
{

namespace
{

// Finds the index in scene.textures for a glTF texture and a colour space. Each image is decoded
// once per colour space and sampler.
class GltfTextures
{
public:
    GltfTextures(const GltfDocument& document, Scene& scene) : document_(document), scene_(scene) {}

    // Returns -1 if the texture has no image that can be read. A warning says so, which is that of
    // warnOfImages() if the texture has an image.
    int32_t find(int gltfTexture, bool srgb);
    glm::vec3 meanColor(int32_t texture) const
    {
        return meanOfSrgb(scene_.textures[size_t(texture)]);
    }
    // Adds a texture whose green is the roughness of a texture that has the glossiness, divided by
    // `factor`, in its alpha. Returns its index.
    int32_t roughnessOfGlossiness(int32_t texture, float factor);
    // Returns a texture with the colours of another one and an alpha of 1. Materials share it.
    int32_t withoutAlpha(int32_t texture);
    // Warns of all images together that could not be read.
    void warnOfImages() const;

private:
    int32_t addCopy(Texture copy);
    // Throws SceneError that names the image.
    Texture decode(size_t image);
    // Decodes the image as scene_.textures.back(). Returns its index, or -1 if it cannot be read.
    // An image that could not be read is not tried again.
    int32_t add(int gltfImage, int gltfSampler, bool srgb);

    const GltfDocument& document_;
    Scene& scene_;
    std::map<std::tuple<int, int, bool>, int32_t> known_; // (image, sampler, srgb) -> texture
    std::map<int32_t, int32_t> withoutAlpha_;             // texture -> its copy without alpha
    uint64_t texels_ = 0;                                 // decoded so far
    std::set<int> unreadImages_;
    std::string firstFault_; // what is wrong with the first of them
};

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
    const auto index = size_t(gltfTexture);
    const tinygltf::Texture& source = document_.model.textures[index];
    const auto* webp =
        GltfDocument::extension(document_.json["textures"][index], "EXT_texture_webp");
    const int image = webp ? (*webp)["source"].get<int>() : source.source;
    if (image < 0) {
        document_.warn(gltfElement("textures", index),
                       "has no PNG, JPEG or WebP image and is left out");
        return -1;
    }
    const auto key = std::make_tuple(image, source.sampler, srgb);
    if (const auto found = known_.find(key); found != known_.end())
        return found->second;
    const int32_t result = add(image, source.sampler, srgb);
    known_.emplace(key, result);
    return result;
}

int32_t GltfTextures::add(int gltfImage, int gltfSampler, bool srgb)
{
    if (unreadImages_.contains(gltfImage))
        return -1;
    try {
        scene_.textures.push_back(decode(size_t(gltfImage)));
    } catch (const SceneError& error) {
        // The scene is worth seeing without the texture.
        if (unreadImages_.empty())
            firstFault_ = document_.withoutFile(error.what());
        unreadImages_.insert(gltfImage);
        return -1;
    }
    Texture& texture = scene_.textures.back();
    texture.srgb = srgb;
    if (gltfSampler >= 0)
        applySampler(document_.model.samplers[size_t(gltfSampler)], texture);
    return int32_t(scene_.textures.size() - 1);
}

void GltfTextures::warnOfImages() const
{
    if (unreadImages_.empty())
        return;
    const size_t others = unreadImages_.size() - 1;
    std::string sentence = firstFault_ + "; the texture is left out";
    if (others > 0)
        sentence += ", and so are those of " + std::to_string(others) + " other image" +
                    (others == 1 ? "" : "s") + " that cannot be read";
    document_.warn("", sentence);
}

int32_t GltfTextures::roughnessOfGlossiness(int32_t texture, float factor)
{
    Texture roughness = scene_.textures[size_t(texture)];
    for (size_t i = 0; i < roughness.rgba.size(); i += 4) {
        const float glossiness = factor * float(roughness.rgba[i + 3]);
        roughness.rgba[i + 1] = uint8_t(255.5f - glossiness);
    }
    return addCopy(std::move(roughness));
}

int32_t GltfTextures::withoutAlpha(int32_t texture)
{
    if (const auto found = withoutAlpha_.find(texture); found != withoutAlpha_.end())
        return found->second;
    Texture copy = scene_.textures[size_t(texture)];
    for (size_t i = 3; i < copy.rgba.size(); i += 4)
        copy.rgba[i] = 255;
    return withoutAlpha_[texture] = addCopy(std::move(copy));
}

int32_t GltfTextures::addCopy(Texture copy)
{
    texels_ += copy.rgba.size() / 4;
    if (texels_ > maxGltfTexels)
        document_.fail("", "has more than the 2 GiB of pixels that a scene's textures may have");
    scene_.textures.push_back(std::move(copy));
    return int32_t(scene_.textures.size() - 1);
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
    Texture texture = decodeGltfImage(document_, element, bytes, maxGltfTexels - texels_);
    texels_ += uint64_t(texture.width) * texture.height;
    return texture;
}

// Clamps a factor to [0, 1]. Rounding by exporters may have moved it out by up to 1e-4; larger
// errors were refused when the file was opened.
float unit(double x)
{
    return float(glm::clamp(x, 0.0, 1.0));
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

AlphaMode alphaModeOf(const tinygltf::Material& source)
{
    if (source.alphaMode == "MASK")
        return AlphaMode::Mask;
    return source.alphaMode == "BLEND" ? AlphaMode::Blend : AlphaMode::Opaque;
}

class MaterialReader
{
public:
    MaterialReader(const GltfDocument& document, Scene& scene)
        : document_(document), textures_(document, scene)
    {
    }

    Material read(size_t index);
    // Warns of what concerns several materials, after the last of them.
    void finish() const { textures_.warnOfImages(); }

private:
    // Reads owner[slot], a textureInfo. Without it the reference is empty.
    TextureRef textureRef(const nlohmann::json& owner, const char* slot, bool srgb);
    void readSurface(const tinygltf::Material& source, const nlohmann::json& json,
                     Material& material);
    void readEmission(const tinygltf::Material& source, const nlohmann::json& json,
                      Material& material);
    void readDielectric(const nlohmann::json& json, Material& material);
    void readTransmission(const nlohmann::json& json, Material& material);
    void readSpecularGlossiness(const nlohmann::json& extension, Material& material);

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
    ref.uvSet = uint32_t(uvSet);
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
        // The texture says which parts are metal. Without it, all would be.
        if (found->contains("metallicRoughnessTexture") &&
            material.metallicRoughnessTexture.texture < 0)
            material.metalness = 0;
    }
    material.normalTexture = textureRef(json, "normalTexture", false);
    material.normalScale = float(source.normalTexture.scale);
    material.doubleSided = source.doubleSided;
    material.alphaCutoff = float(source.alphaCutoff);
    material.alphaMode = alphaModeOf(source);
}

void MaterialReader::readEmission(const tinygltf::Material& source, const nlohmann::json& json,
                                  Material& material)
{
    const auto* extension = GltfDocument::extension(json, "KHR_materials_emissive_strength");
    const double strength = extension ? numberOr(*extension, "emissiveStrength", 1) : 1;
    // The unit is cd/m^2 (glTF 2.0, section 3.9.4).
    const glm::dvec3 factor =
        glm::max(glm::dvec3(glm::make_vec3(source.emissiveFactor.data())), 0.0);
    if (glm::any(glm::greaterThan(factor, glm::dvec3(1.0001))))
        document_.warn(element_, "has an emissiveFactor above 1, which is used as it is");
    material.emission = glm::vec3(factor * strength);
    material.emissiveTexture = textureRef(json, "emissiveTexture", true);
    // The texture says where the surface glows. Without it, all of it would.
    if (json.contains("emissiveTexture") && material.emissiveTexture.texture < 0)
        material.emission = glm::vec3(0);
}

// Reads F0 and F90 of the dielectric part. KHR_materials_ior: F0 = ((n-1)/(n+1))^2, where n = 0
// stands for total reflection. KHR_materials_specular: F0 = min(F0 * colour, 1) * factor and F90 =
// factor.
void MaterialReader::readDielectric(const nlohmann::json& json, Material& material)
{
    double f0 = 0.04;
    if (const auto* extension = GltfDocument::extension(json, "KHR_materials_ior")) {
        double n = numberOr(*extension, "ior", 1.5);
        if (n != 0 && n < 1) {
            document_.warn(element_ + ".extensions.KHR_materials_ior.ior",
                           "must be 0 or >= 1, is " + std::to_string(n) + "; 1.5 is used");
            n = 1.5;
        }
        f0 = n == 0 ? 1 : std::pow((n - 1) / (n + 1), 2);
    }
    material.dielectricF0 = glm::vec3(float(f0));
    const auto* specular = GltfDocument::extension(json, "KHR_materials_specular");
    if (!specular)
        return;
    const float factor = unit(numberOr(*specular, "specularFactor", 1));
    glm::dvec3 color{1};
    if (const auto found = specular->find("specularColorFactor"); found != specular->end())
        for (int i = 0; i < 3; ++i)
            color[i] = (*found)[size_t(i)].get<double>();
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

// Reads KHR_materials_transmission as coverage: a surface that lets all light through is drawn at
// 25% of its pixels, so that it can still be seen. Bodies of glass (KHR_materials_volume) stay
// opaque, because the program does not compute how a body bends the light of what is behind it.
void MaterialReader::readTransmission(const nlohmann::json& json, Material& material)
{
    constexpr float veil = 0.25f;
    const auto* extension = GltfDocument::extension(json, "KHR_materials_transmission");
    const double factor = extension ? numberOr(*extension, "transmissionFactor", 0) : 0;
    const auto* volume = GltfDocument::extension(json, "KHR_materials_volume");
    const bool isBody = volume && numberOr(*volume, "thicknessFactor", 0) > 0;
    // With a texture of metalness, the factor alone (1 by default) does not say what is metal.
    const float metal = material.metallicRoughnessTexture.texture < 0 ? material.metalness : 0;
    const float lost = (1 - veil) * unit(factor) * (1 - metal); // the share of the coverage
    if (lost <= 0 || isBody)
        return;
    if (material.alphaMode == AlphaMode::Mask) {
        document_.warn(element_, "has alphaMode MASK, so its transmission is left out");
        return;
    }
    if (extension->contains("transmissionTexture")) {
        document_.warn(element_, "has a texture of its transmission, and lets no light through");
        return;
    }
    const bool isOpaque = material.alphaMode == AlphaMode::Opaque;
    material.alpha = (isOpaque ? 1 : material.alpha) * (1 - lost);
    material.alphaMode = AlphaMode::Blend;
    // AlphaMode::Blend uses the alpha of the texture, which has no meaning if the file says that
    // the material is opaque.
    if (int32_t& texture = material.baseColorTexture.texture; isOpaque && texture >= 0)
        texture = textures_.withoutAlpha(texture);
}

// Reads KHR_materials_pbrSpecularGlossiness, whose diffuse colour, F0 and glossiness replace those
// of the metallic-roughness model. F0 has no texture here: its mean stands for that.
void MaterialReader::readSpecularGlossiness(const nlohmann::json& extension, Material& material)
{
    const auto factor = [&](const char* key, size_t i) {
        const auto found = extension.find(key);
        return found == extension.end() ? 1.0f : unit((*found)[i].get<double>());
    };
    glm::vec3 F0;
    for (size_t i = 0; i < 3; ++i) {
        material.baseColor[int(i)] = factor("diffuseFactor", i);
        F0[int(i)] = factor("specularFactor", i);
    }
    material.alpha = factor("diffuseFactor", 3);
    material.metalness = 0;
    const float glossiness = unit(numberOr(extension, "glossinessFactor", 1));
    material.perceptualRoughness = 1 - glossiness;
    material.baseColorTexture = textureRef(extension, "diffuseTexture", true);
    material.metallicRoughnessTexture = textureRef(extension, "specularGlossinessTexture", false);
    if (int32_t& texture = material.metallicRoughnessTexture.texture; texture >= 0) {
        document_.warn(element_, "has a specular texture; its mean colour is used everywhere");
        F0 *= textures_.meanColor(texture);
        texture = textures_.roughnessOfGlossiness(texture, glossiness);
        material.perceptualRoughness = 1;
    } else if (extension.contains("specularGlossinessTexture")) {
        // Without its texture the surface would be a mirror. It gets the F0 of common dielectrics.
        F0 = glm::vec3(0.04f);
        material.perceptualRoughness = 1;
    }
    material.dielectricF0 = F0;
    material.diffuseWeight = 1 - std::max({F0.x, F0.y, F0.z});
}

// Fails if an emission of the material `index` of the document is not finite.
void requireFiniteEmission(const GltfDocument& document, size_t index, const Material& material)
{
    for (int i = 0; i < 3; ++i)
        if (!std::isfinite(material.emission[i]))
            document.fail(gltfElement("materials", index),
                          "emits more than single precision holds");
}

// Turns the surface into one that emits light of a colour, where 1 is white, and that lights add
// nothing to. Its texture of the base colour remains.
void makeUnlit(Material& material, const glm::vec3& color)
{
    material.unlit = true;
    material.emission = color * unlitLuminance;
    material.baseColor = glm::vec3(0);
    material.dielectricF0 = glm::vec3(0);
    material.specularWeight = 0;
    material.metalness = 0;
    material.metallicRoughnessTexture = TextureRef{};
    material.normalTexture = TextureRef{};
    material.emissiveTexture = TextureRef{};
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
    if (const auto* extension =
            GltfDocument::extension(json, "KHR_materials_pbrSpecularGlossiness"))
        readSpecularGlossiness(*extension, material);
    else
        readDielectric(json, material);
    readTransmission(json, material);
    if (GltfDocument::extension(json, "KHR_materials_unlit"))
        makeUnlit(material, material.baseColor);
    requireFiniteEmission(document_, index, material);
    return material;
}

} // namespace

bool isGltfAlphaUsed(const GltfDocument& document, int material)
{
    return material >= 0 &&
           alphaModeOf(document.model.materials[size_t(material)]) != AlphaMode::Opaque;
}

uint32_t readGltfMaterials(const GltfDocument& document, Scene& scene)
{
    MaterialReader reader(document, scene);
    for (size_t i = 0; i < document.model.materials.size(); ++i)
        scene.materials.push_back(reader.read(i));
    reader.finish();
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
    return uint32_t(scene.materials.size() - 1);
}

} // namespace candelabra::app
