// SPDX-License-Identifier: Apache-2.0
#include "io/image.h"

#include <cstdlib>
#include <memory>

#include <tinyexr.h>

#include "io/image_file.h"

namespace candelabra::app
{

namespace
{

// tinyexr's message, freed.
std::string takeMessage(const char* message)
{
    std::string text = message ? message : "unknown reason";
    if (message)
        FreeEXRErrorMessage(message);
    return text.substr(0, text.find('\n'));
}

struct ExrHeader {
    EXRHeader value;
    ExrHeader() { InitEXRHeader(&value); }
    ~ExrHeader() { FreeEXRHeader(&value); }
    ExrHeader(const ExrHeader&) = delete;
    ExrHeader& operator=(const ExrHeader&) = delete;
};

struct ExrImage {
    EXRImage value;
    ExrImage() { InitEXRImage(&value); }
    ~ExrImage() { FreeEXRImage(&value); }
    ExrImage(const ExrImage&) = delete;
    ExrImage& operator=(const ExrImage&) = delete;
};

// Channel names, alphabetical as the format wants them, and where each is in a pixel of ours.
struct ChannelOrder {
    int count;
    char names[3];
    int offsets[3];
};
constexpr ChannelOrder greyOrder{1, {'Y'}, {0}};
constexpr ChannelOrder rgbOrder{3, {'B', 'G', 'R'}, {2, 1, 0}};

// Before tinyexr allocates what a broken file asks for; in 64 bits, corners may be any 32.
void requireSize(const std::string& path, const EXRBox2i& window)
{
    const int64_t width = int64_t{window.max_x} - window.min_x + 1;
    const int64_t height = int64_t{window.max_y} - window.min_y + 1;
    if (width < 1 || width > maxImageSize || height < 1 || height > maxImageSize)
        failRead(path, "its data window has " + std::to_string(width) + " x " +
                           std::to_string(height) + " pixels; 1 to " +
                           std::to_string(maxImageSize) + " a side can be read");
}

std::vector<float> plane(const Image& image, int offset)
{
    std::vector<float> out(size_t{image.width} * image.height);
    for (size_t i = 0; i < out.size(); ++i)
        out[i] = image.pixels[i * image.channels + static_cast<size_t>(offset)];
    return out;
}

} // namespace

void saveExr(const std::string& path, const Image& image)
{
    requireImage(path, image);
    const ChannelOrder& order = image.channels == 3 ? rgbOrder : greyOrder;
    std::vector<float> planes[3];
    unsigned char* pointers[3] = {};
    EXRChannelInfo channels[3] = {};
    int types[3] = {TINYEXR_PIXELTYPE_FLOAT, TINYEXR_PIXELTYPE_FLOAT, TINYEXR_PIXELTYPE_FLOAT};
    for (int c = 0; c < order.count; ++c) {
        planes[c] = plane(image, order.offsets[c]);
        pointers[c] = reinterpret_cast<unsigned char*>(planes[c].data());
        channels[c].name[0] = order.names[c];
    }
    EXRImage exr; // borrows everything: not freed by tinyexr
    InitEXRImage(&exr);
    exr.num_channels = order.count;
    exr.images = pointers;
    exr.width = static_cast<int>(image.width);
    exr.height = static_cast<int>(image.height);
    EXRHeader header;
    InitEXRHeader(&header);
    header.num_channels = order.count;
    header.channels = channels;
    header.pixel_types = types;
    header.requested_pixel_types = types;
    header.compression_type = TINYEXR_COMPRESSIONTYPE_ZIP;

    unsigned char* memory = nullptr;
    const char* message = nullptr;
    const size_t size = SaveEXRImageToMemory(&exr, &header, &memory, &message);
    const std::unique_ptr<unsigned char, void (*)(void*)> owner(memory, std::free);
    if (size == 0)
        failWrite(path, "the EXR encoder failed: " + takeMessage(message));
    writeFileAtomically(path, std::span(memory, size));
}

Image loadExr(const std::string& path)
{
    const std::vector<uint8_t> bytes = readImageFile(path);
    EXRVersion version;
    if (ParseEXRVersionFromMemory(&version, bytes.data(), bytes.size()) != TINYEXR_SUCCESS)
        failRead(path, "is not an EXR file");
    if (version.multipart || version.non_image)
        failRead(path, "is a multi-part or deep EXR file");
    ExrHeader header;
    const char* message = nullptr;
    if (ParseEXRHeaderFromMemory(&header.value, &version, bytes.data(), bytes.size(), &message) !=
        TINYEXR_SUCCESS)
        failRead(path, takeMessage(message));
    requireSize(path, header.value.data_window);
    int red = -1, green = -1, blue = -1;
    for (int c = 0; c < header.value.num_channels; ++c) {
        header.value.requested_pixel_types[c] = TINYEXR_PIXELTYPE_FLOAT; // halves are widened
        const std::string name = header.value.channels[c].name;
        if (name == "R")
            red = c;
        else if (name == "G")
            green = c;
        else if (name == "B")
            blue = c;
        if (header.value.pixel_types[c] == TINYEXR_PIXELTYPE_UINT)
            failRead(path, "channel " + name + " has integers");
    }
    const bool isColor = red >= 0 && green >= 0 && blue >= 0;
    ExrImage exr;
    // When it fails tinyexr 1.0.1 frees as many channels as are counted here, and leaves the
    // pointers.
    exr.value.num_channels = header.value.num_channels;
    if (LoadEXRImageFromMemory(&exr.value, &header.value, bytes.data(), bytes.size(), &message) !=
        TINYEXR_SUCCESS) {
        InitEXRImage(&exr.value);
        failRead(path, takeMessage(message));
    }
    if (!exr.value.images || exr.value.width < 1 || exr.value.height < 1)
        failRead(path, "is tiled, which is not supported");
    Image image;
    image.width = static_cast<uint32_t>(exr.value.width);
    image.height = static_cast<uint32_t>(exr.value.height);
    image.channels = isColor ? 3 : 1;
    image.pixels.resize(size_t{image.width} * image.height * image.channels);
    const int sources[3] = {isColor ? red : 0, green, blue};
    for (uint32_t c = 0; c < image.channels; ++c) {
        const auto* source = reinterpret_cast<const float*>(exr.value.images[sources[c]]);
        for (size_t i = 0; i < size_t{image.width} * image.height; ++i)
            image.pixels[i * image.channels + c] = source[i];
    }
    return image;
}

} // namespace candelabra::app
