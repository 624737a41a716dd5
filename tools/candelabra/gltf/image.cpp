// SPDX-License-Identifier: Apache-2.0
#include "gltf/material.h"

#include <cstring>
#include <limits>
#include <memory>

#include <stb/stb_image.h>
#include <webp/decode.h>

#include "scene/scene_file.h"

namespace candelabra::app
{

namespace
{

constexpr int maxImageSide = 16384; // pixels; common Vulkan devices can sample that

enum class Format { PngOrJpeg, WebP, Other };

// The formats of glTF 2.0 and of EXT_texture_webp. stb_image reads more formats than PNG and JPEG,
// but its other decoders have a history of memory errors.
Format formatOf(std::span<const uint8_t> bytes)
{
    const auto has = [&](size_t at, std::string_view magic) {
        return bytes.size() > at + magic.size() &&
               std::memcmp(bytes.data() + at, magic.data(), magic.size()) == 0;
    };
    if (has(0, "\x89PNG\r\n\x1a\n") || has(0, "\xff\xd8\xff"))
        return Format::PngOrJpeg;
    return has(0, "RIFF") && has(8, "WEBP") ? Format::WebP : Format::Other;
}

struct Size {
    int width = 0, height = 0;
};

// Returns the reason of the last failure of stb_image, which has a word or two for it.
std::string reasonOfStb()
{
    const char* given = stbi_failure_reason();
    const std::string said = given ? given : "";
    if (said == "outofdata")
        return "it is cut short";
    if (said == "outofmem")
        return "there is not enough memory";
    return "it is damaged or of a rare kind" +
           (said.empty() ? "" : " (the decoder says \"" + printable(said, 60) + "\")");
}

[[noreturn]] void failDecode(const GltfDocument& document, const std::string& element,
                             const std::string& reason)
{
    document.fail(element, std::string("cannot be decoded: ") + reason);
}

Size sizeOf(const GltfDocument& document, const std::string& element,
            std::span<const uint8_t> bytes, Format format)
{
    Size size;
    int channels = 0;
    if (format == Format::WebP) {
        if (!WebPGetInfo(bytes.data(), bytes.size(), &size.width, &size.height))
            failDecode(document, element, "its WebP header is damaged");
    } else if (!stbi_info_from_memory(bytes.data(), int(bytes.size()), &size.width, &size.height,
                                      &channels)) {
        failDecode(document, element, reasonOfStb());
    }
    return size;
}

// Returns the pixels as RGBA.
std::vector<uint8_t> pixelsOf(const GltfDocument& document, const std::string& element,
                              std::span<const uint8_t> bytes, Format format, Size size)
{
    const size_t count = size_t(size.width) * size_t(size.height) * 4;
    if (format == Format::WebP) {
        std::vector<uint8_t> out(count);
        if (!WebPDecodeRGBAInto(bytes.data(), bytes.size(), out.data(), count, 4 * size.width))
            failDecode(document, element, "its WebP data is damaged");
        return out;
    }
    int channels = 0;
    const std::unique_ptr<stbi_uc, void (*)(void*)> pixels(
        stbi_load_from_memory(bytes.data(), int(bytes.size()), &size.width, &size.height, &channels,
                              4),
        stbi_image_free);
    if (!pixels)
        failDecode(document, element, reasonOfStb());
    return {pixels.get(), pixels.get() + count};
}

} // namespace

Texture decodeGltfImage(const GltfDocument& document, const std::string& element,
                        std::span<const uint8_t> bytes, uint64_t texelsLeft)
{
    const Format format = formatOf(bytes);
    if (format == Format::Other)
        document.fail(element, "is neither a PNG, a JPEG nor a WebP image");
    if (bytes.size() > size_t(std::numeric_limits<int>::max()))
        document.fail(element, "is larger than 2 GiB");
    const Size size = sizeOf(document, element, bytes, format);
    if (size.width < 1 || size.height < 1 || size.width > maxImageSide ||
        size.height > maxImageSide)
        document.fail(element, "has " + std::to_string(size.width) + " x " +
                                   std::to_string(size.height) +
                                   " pixels; at most 16384 a side are allowed");
    if (uint64_t(size.width) * uint64_t(size.height) > texelsLeft)
        document.fail(element, "exceeds the 2 GiB of pixels that a scene's textures may have");
    Texture texture;
    texture.width = uint32_t(size.width);
    texture.height = uint32_t(size.height);
    texture.rgba = pixelsOf(document, element, bytes, format, size);
    return texture;
}

} // namespace candelabra::app
