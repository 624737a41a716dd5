// SPDX-License-Identifier: Apache-2.0
// Fuzzes the loaders of floating-point images; the first byte chooses the format.
#include <OpenEXR/ImfChannelList.h>
#include <OpenEXR/ImfFrameBuffer.h>
#include <OpenEXR/ImfHeader.h>
#include <OpenEXR/ImfOutputFile.h>
#include <half.h>

#include "fuzz/fuzz_target.h"
#include "io/image.h"

namespace
{

constexpr const char* extensions[] = {".hdr", ".exr", ".pfm"};

// Writes an EXR file as others do: with channels of halves, one of which is not read.
void writeHalves(const std::string& path, Imf::Compression compression)
{
    constexpr int width = 19, height = 5;
    half plane[width * height];
    for (int i = 0; i < width * height; ++i)
        plane[i] = float(i / 4) * 0.25f;
    Imf::Header header(width, height);
    header.compression() = compression;
    Imf::FrameBuffer slices;
    for (const char* name : {"A", "B", "G", "R"}) {
        header.channels().insert(name, Imf::Channel(Imf::HALF));
        slices.insert(name, Imf::Slice(Imf::HALF, reinterpret_cast<char*>(plane), sizeof(half),
                                       sizeof(half) * width));
    }
    Imf::OutputFile file(path.c_str(), header, 0);
    file.setFrameBuffer(slices);
    file.writePixels(height);
}

} // namespace

namespace candelabra::test
{

Seeds fuzzSeeds()
{
    Seeds out;
    for (const uint32_t width : {1u, 9u, 33u})
        for (const uint32_t channels : {1u, 3u}) {
            app::Image image{.width = width, .height = 3, .channels = channels};
            for (uint32_t i = 0; i < width * 3 * channels; ++i)
                image.pixels.push_back(float(i / 4) * 0.25f); // contains runs of equal values
            for (size_t format = 0; format < std::size(extensions); ++format) {
                const std::string path = fuzzFile(nullptr, 0, extensions[format]);
                app::saveImageByExtension(path, image);
                out.push_back(char('0' + format) + fileText(path));
            }
        }
    for (const Imf::Compression compression :
         {Imf::NO_COMPRESSION, Imf::RLE_COMPRESSION, Imf::ZIPS_COMPRESSION, Imf::PIZ_COMPRESSION}) {
        const std::string path = fuzzFile(nullptr, 0, ".exr");
        writeHalves(path, compression);
        out.push_back('1' + fileText(path));
    }
    return out;
}

} // namespace candelabra::test

extern "C" int LLVMFuzzerTestOneInput(const uint8_t* data, size_t size)
{
    using namespace candelabra;
    if (!size)
        return 0;
    const char* extension = extensions[data[0] % std::size(extensions)];
    try {
        const app::Image image =
            app::loadImageByExtension(test::fuzzFile(data + 1, size - 1, extension));
        test::require(image.channels == 1 || image.channels == 3, "channels");
        test::require(image.pixels.size() == size_t(image.width) * image.height * image.channels,
                      "number of pixels");
    } catch (const app::ImageError&) {
    }
    return 0;
}
