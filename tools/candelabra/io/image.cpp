// SPDX-License-Identifier: Apache-2.0
// Reads and writes PNG and PFM, writes Radiance HDR. Radiance HDR is read in image_hdr.cpp; OpenEXR
// is in image_exr.cpp.
#include "io/image.h"

#include <algorithm>
#include <bit>
#include <cctype>
#include <charconv>
#include <cmath>
#include <cstring>
#include <filesystem>
#include <limits>
#include <memory>

#include <fmt/format.h>
#include <stb/stb_image.h>
#include <stb/stb_image_write.h>

#include "io/image_file.h"

namespace candelabra::app
{

namespace
{

static_assert(std::endian::native == std::endian::little, "PFM rows are copied as they are");

void appendBytes(void* context, void* data, int size)
{
    auto& out = *static_cast<std::vector<uint8_t>*>(context);
    const auto* bytes = static_cast<const uint8_t*>(data);
    out.insert(out.end(), bytes, bytes + size);
}

// Takes the next token of a PFM header and the one byte of white space that ends it.
std::string_view headerToken(std::string_view& text)
{
    const size_t end = text.find_first_of(" \t\r\n");
    const std::string_view token = text.substr(0, end);
    text.remove_prefix(end == std::string_view::npos ? text.size() : end + 1);
    return token;
}

bool parseNumber(std::string_view token, auto& value)
{
    const auto [end, error] = std::from_chars(token.data(), token.data() + token.size(), value);
    return error == std::errc() && end == token.data() + token.size();
}

} // namespace

std::string lowerExtension(const std::string& path)
{
    std::string extension = std::filesystem::path(path).extension().string();
    std::ranges::transform(extension, extension.begin(),
                           [](unsigned char c) { return char(std::tolower(c)); });
    return extension;
}

bool isDisplayName(const std::string& path)
{
    return lowerExtension(path) == ".png";
}

bool isPictureName(const std::string& path)
{
    const std::string extension = lowerExtension(path);
    return extension == ".png" || extension == ".exr" || extension == ".hdr" || extension == ".pfm";
}

void savePng(const std::string& path, uint32_t width, uint32_t height, std::span<const uint8_t> rgb)
{
    if (width < 1 || height < 1 || width > maxImageSize || height > maxImageSize ||
        rgb.size() != size_t{width} * height * 3)
        failWrite(path, "the image cannot have " + std::to_string(width) + " x " +
                            std::to_string(height) + " pixels in " + std::to_string(rgb.size()) +
                            " bytes");
    std::vector<uint8_t> bytes;
    if (!stbi_write_png_to_func(appendBytes, &bytes, int(width), int(height), 3, rgb.data(),
                                int(width) * 3))
        failWrite(path, "the PNG encoder failed");
    writeFileAtomically(path, bytes);
}

void saveHdr(const std::string& path, const Image& image)
{
    requireImage(path, image);
    constexpr float largest = 0x1p127f; // the exponent of 2^127 does not fit into a byte
    for (size_t i = 0; i < image.pixels.size(); ++i) {
        const float x = image.pixels[i];
        if (x >= 0 && x < largest)
            continue;
        const size_t pixel = i / image.channels;
        failWrite(path, "pixel (" + std::to_string(pixel % image.width) + ", " +
                            std::to_string(pixel / image.width) + ") is " + std::to_string(x) +
                            ", which .hdr cannot hold; .exr and .pfm can");
    }
    // stb_image_write itself expands grey images to RGB.
    std::vector<uint8_t> bytes;
    if (!stbi_write_hdr_to_func(appendBytes, &bytes, int(image.width), int(image.height),
                                int(image.channels), image.pixels.data()))
        failWrite(path, "the HDR encoder failed");
    writeFileAtomically(path, bytes);
}

void savePfm(const std::string& path, const Image& image)
{
    requireImage(path, image);
    const std::string header = std::string(image.channels == 3 ? "PF" : "Pf") + "\n" +
                               std::to_string(image.width) + " " + std::to_string(image.height) +
                               "\n-1.0\n"; // negative: little-endian
    const size_t rowBytes = size_t{image.width} * image.channels * sizeof(float);
    std::vector<uint8_t> bytes(header.size() + rowBytes * image.height);
    std::memcpy(bytes.data(), header.data(), header.size());
    const auto* rows = reinterpret_cast<const uint8_t*>(image.pixels.data());
    for (size_t y = 0; y < image.height; ++y)
        std::memcpy(&bytes[header.size() + y * rowBytes], rows + (image.height - 1 - y) * rowBytes,
                    rowBytes);
    writeFileAtomically(path, bytes);
}

Image loadPfm(const std::string& path)
{
    const std::vector<uint8_t> bytes = readImageFile(path);
    std::string_view rest(reinterpret_cast<const char*>(bytes.data()), bytes.size());
    Image image;
    const std::string_view magic = headerToken(rest);
    if (magic != "PF" && magic != "Pf")
        failRead(path, "is not a PFM file");
    image.channels = magic == "PF" ? 3 : 1;
    float scale = 0;
    if (!parseNumber(headerToken(rest), image.width) ||
        !parseNumber(headerToken(rest), image.height) || !parseNumber(headerToken(rest), scale) ||
        image.width < 1 || image.height < 1 || image.width > maxImageSize ||
        image.height > maxImageSize || !std::isfinite(scale) || scale == 0)
        failRead(path, "has a broken PFM header");
    const size_t rowBytes = size_t{image.width} * image.channels * sizeof(float);
    if (rest.size() != rowBytes * image.height)
        failRead(path, "has " + std::to_string(rest.size()) + " bytes of pixels, needs " +
                           std::to_string(rowBytes * image.height));
    image.pixels.resize(size_t{image.width} * image.height * image.channels);
    auto* rows = reinterpret_cast<uint8_t*>(image.pixels.data());
    for (size_t y = 0; y < image.height; ++y)
        std::memcpy(rows + (image.height - 1 - y) * rowBytes, rest.data() + y * rowBytes, rowBytes);
    if (scale > 0) // big-endian
        for (float& x : image.pixels)
            x = std::bit_cast<float>(__builtin_bswap32(std::bit_cast<uint32_t>(x)));
    if (std::abs(scale) != 1)
        image.warnings.push_back(fmt::format("{}: its header has the scale {}, whose meaning "
                                             "programs do not agree on; the values are taken as "
                                             "they are",
                                             path, std::abs(scale)));
    return image;
}

DisplayImage loadPng(const std::string& path)
{
    const std::vector<uint8_t> bytes = readImageFile(path);
    constexpr std::string_view magic = "\x89PNG\r\n\x1a\n"; // stb reads other formats too
    if (bytes.size() < magic.size() || std::memcmp(bytes.data(), magic.data(), magic.size()) != 0)
        failRead(path, "is not a PNG file");
    if (bytes.size() > size_t(std::numeric_limits<int>::max()))
        failRead(path, "is larger than 2 GiB");
    const int size = int(bytes.size());
    int width = 0, height = 0, channels = 0;
    if (!stbi_info_from_memory(bytes.data(), size, &width, &height, &channels))
        failRead(path, "has a broken PNG header");
    if (width > int(maxImageSize) || height > int(maxImageSize))
        failRead(path, fmt::format("is larger than {} pixels a side", maxImageSize));
    // Values of 8 bits become values of 16 bits with the same share of the largest one.
    const std::unique_ptr<stbi_us, void (*)(void*)> rgba(
        stbi_load_16_from_memory(bytes.data(), size, &width, &height, &channels, 4),
        stbi_image_free);
    if (!rgba)
        failRead(path, "is damaged, cut short or a rare kind of PNG");
    DisplayImage out{uint32_t(width), uint32_t(height), {}};
    constexpr float most = 65535;
    out.pixels.reserve(size_t(width) * size_t(height));
    for (size_t i = 0; i < size_t(width) * size_t(height); ++i) {
        const stbi_us* p = &rgba.get()[4 * i];
        if (p[3] != most)
            failRead(path, fmt::format("pixel ({}, {}) is transparent, and has no single colour",
                                       i % size_t(width), i / size_t(width)));
        out.pixels.emplace_back(p[0] / most, p[1] / most, p[2] / most);
    }
    return out;
}

Image loadImageByExtension(const std::string& path)
{
    const std::string extension = lowerExtension(path);
    if (extension == ".exr")
        return loadExr(path);
    if (extension == ".hdr")
        return loadHdr(path);
    if (extension == ".pfm")
        return loadPfm(path);
    failRead(path, "the extension must be .exr, .hdr or .pfm for linear images");
}

void saveImageByExtension(const std::string& path, const Image& image)
{
    const std::string extension = lowerExtension(path);
    if (extension == ".exr")
        saveExr(path, image);
    else if (extension == ".hdr")
        saveHdr(path, image);
    else if (extension == ".pfm")
        savePfm(path, image);
    else
        failWrite(path, "the extension must be .exr, .hdr or .pfm for linear images");
}

} // namespace candelabra::app
