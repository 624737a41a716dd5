// SPDX-License-Identifier: Apache-2.0
#include "gltf/image.h"

#include <cstring>
#include <limits>
#include <memory>

#include <stb/stb_image.h>

#include "scene/scene_file.h"

namespace candelabra::app
{

namespace
{

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

} // namespace

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

} // namespace candelabra::app
