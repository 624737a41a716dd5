// SPDX-License-Identifier: Apache-2.0
// Tests image files: what is written is read back, nothing half-written remains, errors are one
// sentence.
#include <algorithm>
#include <bit>
#include <cmath>
#include <csignal>
#include <filesystem>
#include <limits>
#include <map>
#include <memory>

#include <OpenEXR/ImfChannelList.h>
#include <OpenEXR/ImfDeepScanLineOutputFile.h>
#include <OpenEXR/ImfFrameBuffer.h>
#include <OpenEXR/ImfHeader.h>
#include <OpenEXR/ImfInputFile.h>
#include <OpenEXR/ImfMultiPartOutputFile.h>
#include <OpenEXR/ImfOutputFile.h>
#include <OpenEXR/ImfPartType.h>
#include <OpenEXR/ImfStandardAttributes.h>
#include <OpenEXR/ImfTileDescription.h>
#include <OpenEXR/ImfTiledOutputFile.h>
#include <gtest/gtest.h>
#include <half.h>
#include <stb/stb_image.h>
#include <stb/stb_image_write.h>
#include <sys/resource.h>

#include "harness/constants.h"
#include "io/image.h"
#include "io/image_file.h"
#include "unit/gltf_builder.h"

namespace candelabra::test
{

namespace
{

using namespace candelabra::app;

// Returns an image in which all values differ; magnitudes go from 2^-20 to 2^20.
Image testImage(uint32_t width, uint32_t height, uint32_t channels)
{
    Image image{width, height, channels, {}};
    for (size_t i = 0; i < size_t{width} * height * channels; ++i)
        image.pixels.push_back(
            std::ldexp(1 + static_cast<float>(i % 1000) / 1000, static_cast<int>(i % 41) - 20));
    return image;
}

// Compares bit by bit, so that NaN equals itself and -0 differs from 0.
void expectSame(const Image& a, const Image& b)
{
    ASSERT_EQ(a.width, b.width);
    ASSERT_EQ(a.height, b.height);
    ASSERT_EQ(a.channels, b.channels);
    ASSERT_EQ(a.pixels.size(), b.pixels.size());
    for (size_t i = 0; i < a.pixels.size(); ++i)
        ASSERT_EQ(std::bit_cast<uint32_t>(a.pixels[i]), std::bit_cast<uint32_t>(b.pixels[i])) << i;
}

template <typename F>
std::string errorOf(F&& action)
{
    try {
        action();
    } catch (const ImageError& e) {
        return e.what();
    }
    return "no error";
}

constexpr uint32_t sizes[][2] = {{1, 1}, {17, 3}, {8, 1}, {3, 33}, {200, 100}};

TEST(ImageFiles, PfmAndExrKeepEveryBit)
{
    const TemporaryFolder folder;
    for (const auto& [width, height] : sizes)
        for (const uint32_t channels : {1u, 3u}) {
            SCOPED_TRACE(std::to_string(width) + " x " + std::to_string(height));
            Image image = testImage(width, height, channels);
            image.pixels[0] = nan;
            image.pixels.back() = -infinity;
            image.pixels[image.pixels.size() / 2] = -0.0f;
            for (const char* name : {"image.pfm", "image.exr", "UPPER.EXR"})
                saveImageByExtension(folder.path(name), image);
            expectSame(loadPfm(folder.path("image.pfm")), image);
            expectSame(loadExr(folder.path("image.exr")), image);
            expectSame(loadExr(folder.path("UPPER.EXR")), image);
        }
}

TEST(ImageFiles, PfmIsLittleEndianFromTheBottom)
{
    const TemporaryFolder folder;
    const Image image{1, 2, 1, {1, 2}};
    savePfm(folder.path("image.pfm"), image);
    const std::string header = "Pf\n1 2\n-1.0\n";
    Bytes expected(header.begin(), header.end());
    const uint8_t littleEndian[] = {0, 0, 0, 0x40, 0, 0, 0x80, 0x3f}; // 2, then 1
    expected.insert(expected.end(), std::begin(littleEndian), std::end(littleEndian));
    EXPECT_EQ(readBytes(folder.path("image.pfm")), expected);
    // The same image written by a big-endian machine.
    const std::string bigHeader = "Pf\n1 2\n1.0\n";
    Bytes big(bigHeader.begin(), bigHeader.end());
    const uint8_t bigEndian[] = {0x40, 0, 0, 0, 0x3f, 0x80, 0, 0};
    big.insert(big.end(), std::begin(bigEndian), std::end(bigEndian));
    expectSame(loadPfm(folder.write("big.pfm", big)), image);
}

// Our files are read by the C++ classes of OpenEXR, of which our code uses nothing.
TEST(ImageFiles, ExrIsReadByOthers)
{
    const TemporaryFolder folder;
    const std::string path = folder.path("image.exr");
    for (const auto& [width, height] : sizes)
        for (const uint32_t channels : {1u, 3u}) {
            const Image image = testImage(width, height, channels);
            saveExr(path, image);
            Imf::InputFile file(path.c_str(), 0);
            const Imf::Header& header = file.header();
            EXPECT_EQ(header.compression(), Imf::ZIP_COMPRESSION);
            EXPECT_EQ(header.lineOrder(), Imf::INCREASING_Y);
            EXPECT_EQ(header.dataWindow(), header.displayWindow());
            const Imath::Box2i window({0, 0}, {int(width) - 1, int(height) - 1});
            ASSERT_EQ(header.dataWindow(), window);
            Image back{width, height, channels, std::vector<float>(image.pixels.size())};
            Imf::FrameBuffer slices;
            const std::string names = channels == 3 ? "RGB" : "Y";
            size_t found = 0;
            for (auto c = header.channels().begin(); c != header.channels().end(); ++c, ++found) {
                ASSERT_NE(names.find(c.name()), std::string::npos) << c.name();
                EXPECT_EQ(c.channel().type, Imf::FLOAT);
                const size_t pixel = channels * sizeof(float);
                slices.insert(c.name(), Imf::Slice(Imf::FLOAT,
                                                   reinterpret_cast<char*>(
                                                       &back.pixels[names.find(c.name())]),
                                                   pixel, pixel * width));
            }
            EXPECT_EQ(found, channels);
            file.setFrameBuffer(slices);
            file.readPixels(0, int(height) - 1);
            expectSame(back, image);
        }
}

// An EXR file as other programs write it, with channels that need not be ours.
struct ForeignExr {
    std::string channels = "BGR"; // names of one letter
    Imf::PixelType type = Imf::FLOAT;
    std::map<char, Imf::PixelType> otherTypes = {}; // of channels that do not have `type`
    Imf::Compression compression = Imf::ZIP_COMPRESSION;
    Imf::LineOrder order = Imf::INCREASING_Y;
    int width = 37, height = 70, left = 0, top = 0;
    int sampling = 1; // of the first channel

    // Returns a value that half, float and int can hold.
    float value(size_t channel, int x, int y) const
    {
        return float((x * 7 + y * 31 + int(channel) * 113) % 1021);
    }
    Imf::PixelType typeOf(size_t channel) const
    {
        const auto other = otherTypes.find(channels[channel]);
        return other == otherTypes.end() ? type : other->second;
    }
    Imf::Header header() const
    {
        const Imath::Box2i window({left, top}, {left + width - 1, top + height - 1});
        Imf::Header out(window, window, 1, {0, 0}, 1, order, compression);
        for (size_t c = 0; c < channels.size(); ++c)
            out.channels().insert(
                channels.substr(c, 1),
                Imf::Channel(typeOf(c), c == 0 ? sampling : 1, c == 0 ? sampling : 1));
        return out;
    }
    template <typename T>
    std::vector<char> plane(size_t channel, int n) const // every n-th pixel and row
    {
        std::vector<T> values;
        for (int y = 0; y < height / n; ++y)
            for (int x = 0; x < width / n; ++x)
                values.push_back(T(value(channel, x, y)));
        const auto* bytes = reinterpret_cast<const char*>(values.data());
        return {bytes, bytes + values.size() * sizeof(T)};
    }
    void write(const std::string& path) const
    {
        std::vector<std::vector<char>> planes(channels.size());
        Imf::FrameBuffer slices;
        for (size_t c = 0; c < channels.size(); ++c) {
            const int n = c == 0 ? sampling : 1;
            planes[c] = typeOf(c) == Imf::HALF    ? plane<half>(c, n)
                        : typeOf(c) == Imf::FLOAT ? plane<float>(c, n)
                                                  : plane<unsigned>(c, n);
            const size_t size = typeOf(c) == Imf::HALF ? 2 : 4, row = size_t(width / n) * size;
            char* origin =
                planes[c].data() - ptrdiff_t(size) * (left / n) - ptrdiff_t(row) * (top / n);
            slices.insert(channels.substr(c, 1), Imf::Slice(typeOf(c), origin, size, row, n, n));
        }
        Imf::OutputFile file(path.c_str(), header(), 0);
        file.setFrameBuffer(slices);
        file.writePixels(height);
    }
    // Returns the image that reading the file must give. `wanted` names its channels in the order
    // of our pixels.
    Image expected(const std::string& wanted) const
    {
        Image out{uint32_t(width), uint32_t(height), uint32_t(wanted.size()), {}};
        for (int y = 0; y < height; ++y)
            for (int x = 0; x < width; ++x)
                for (const char name : wanted)
                    out.pixels.push_back(value(channels.find(name), x, y));
        return out;
    }
};

TEST(ImageFiles, ExrOfOthersIsRead)
{
    const TemporaryFolder folder;
    const std::string path = folder.path("foreign.exr");
    for (const Imf::Compression compression :
         {Imf::NO_COMPRESSION, Imf::RLE_COMPRESSION, Imf::ZIPS_COMPRESSION, Imf::ZIP_COMPRESSION,
          Imf::PIZ_COMPRESSION}) {
        for (const Imf::PixelType type : {Imf::HALF, Imf::FLOAT})
            for (const auto& [channels, wanted] : {std::pair{"Y", "Y"},
                                                   {"BGR", "RGB"},
                                                   {"ABGR", "RGB"},
                                                   {"ABGRZ", "RGB"},
                                                   {"AGR", "A"},
                                                   {"ABGZ", "A"},
                                                   {"XY", "X"}}) {
                SCOPED_TRACE(channels + std::string(" ") + std::to_string(int(compression)) +
                             (type == Imf::HALF ? " half" : " float"));
                ForeignExr foreign{.channels = channels, .type = type, .compression = compression};
                foreign.write(path);
                expectSame(loadExr(path), foreign.expected(wanted));
            }
        // Channels of other types, of other sizes in bytes, before, between and after those that
        // are read. Integers are no fault in a channel that is not read.
        for (const auto& [channels, otherTypes] :
             {std::pair{"BGIR", std::map<char, Imf::PixelType>{{'I', Imf::UINT}}},
              {"BGRZ", {{'Z', Imf::FLOAT}}},
              {"ABGIRZ", {{'A', Imf::FLOAT}, {'I', Imf::UINT}, {'Z', Imf::FLOAT}}},
              {"BGR", {{'G', Imf::FLOAT}}}}) {
            SCOPED_TRACE(channels + std::string(" ") + std::to_string(int(compression)));
            const ForeignExr foreign{.channels = channels,
                                     .type = Imf::HALF,
                                     .otherTypes = otherTypes,
                                     .compression = compression};
            foreign.write(path);
            expectSame(loadExr(path), foreign.expected("RGB"));
        }
    }
    ForeignExr foreign{.order = Imf::DECREASING_Y, .left = -3, .top = 11};
    foreign.write(path);
    expectSame(loadExr(path), foreign.expected("RGB"));
}

TEST(ImageFiles, ExrsOfOtherKindsAreRefused)
{
    const TemporaryFolder folder;
    const std::string path = folder.path("foreign.exr");
    const auto expectRefused = [&](const std::string& reason) {
        EXPECT_EQ(errorOf([&] { loadExr(path); }), "cannot read " + path + ": " + reason);
    };
    ForeignExr{.type = Imf::UINT}.write(path);
    expectRefused("channel B has integers");
    ForeignExr{.width = 36, .sampling = 2}.write(path);
    expectRefused("channel B is subsampled, which is not supported");
    for (const Imf::Compression compression :
         {Imf::PXR24_COMPRESSION, Imf::B44_COMPRESSION, Imf::B44A_COMPRESSION,
          Imf::DWAA_COMPRESSION, Imf::DWAB_COMPRESSION}) {
        ForeignExr{.type = Imf::HALF, .compression = compression}.write(path);
        expectRefused("has lossy compression (PXR24, B44 or DWA), which is not supported");
    }

    // For the rest the header is enough.
    Imf::Header header = ForeignExr().header();
    header.setTileDescription({16, 16, Imf::ONE_LEVEL});
    Imf::TiledOutputFile(path.c_str(), header, 0);
    expectRefused("is tiled, which is not supported");

    header = ForeignExr().header();
    header.setType(Imf::SCANLINEIMAGE);
    header.setName("left");
    Imf::Header second = header;
    second.setName("right");
    const Imf::Header parts[] = {header, second};
    Imf::MultiPartOutputFile(path.c_str(), parts, 2, false, 0);
    expectRefused("is a multi-part or deep EXR file");

    header = ForeignExr{.compression = Imf::ZIPS_COMPRESSION}.header();
    header.setType(Imf::DEEPSCANLINE);
    Imf::DeepScanLineOutputFile(path.c_str(), header, 0);
    expectRefused("is a multi-part or deep EXR file");
}

TEST(ImageFiles, HdrKeepsEightBits)
{
    const TemporaryFolder folder;
    for (const auto& [width, height] : sizes)
        for (const uint32_t channels : {1u, 3u}) {
            const Image image = testImage(width, height, channels);
            saveImageByExtension(folder.path("image.hdr"), image);
            int w = 0, h = 0, n = 0;
            const std::unique_ptr<float, void (*)(void*)> pixels(
                stbi_loadf(folder.path("image.hdr").c_str(), &w, &h, &n, 3), stbi_image_free);
            ASSERT_TRUE(pixels);
            ASSERT_EQ(w, static_cast<int>(width));
            ASSERT_EQ(h, static_cast<int>(height));
            for (size_t p = 0; p < size_t{width} * height; ++p) {
                const auto in = [&](size_t c) {
                    return image.pixels[p * channels + (channels == 3 ? c : 0)];
                };
                // Values are truncated to 8 bits relative to the largest channel, whose mantissa
                // has its top bit set.
                const float step = std::max({in(0), in(1), in(2)}) / 128;
                for (size_t c = 0; c < 3; ++c)
                    ASSERT_NEAR(pixels.get()[3 * p + c], in(c), step) << p;
            }
        }
}

TEST(ImageFiles, ReadersAreChosenByExtension)
{
    const TemporaryFolder folder;
    const Image image = testImage(16, 8, 3);
    for (const char* name : {"a.EXR", "a.pfm", "a.hdr"}) {
        saveImageByExtension(folder.path(name), image);
        const Image back = loadImageByExtension(folder.path(name));
        ASSERT_EQ(back.pixels.size(), image.pixels.size()) << name;
        EXPECT_EQ(back.width, 16u);
        EXPECT_EQ(back.channels, 3u);
        for (size_t i = 0; i < image.pixels.size(); i += 3) {
            const float largest =
                std::max({image.pixels[i], image.pixels[i + 1], image.pixels[i + 2]});
            for (size_t c = i; c < i + 3; ++c) // RGBE keeps 8 bits relative to the largest channel
                ASSERT_NEAR(back.pixels[c], image.pixels[c], largest / 128) << name;
        }
    }
    EXPECT_NE(errorOf([&] { loadImageByExtension(folder.path("a.png")); }).find(".hdr"),
              std::string::npos);
    savePfm(folder.path("pfm.hdr"), image);
    EXPECT_NE(errorOf([&] { loadHdr(folder.path("pfm.hdr")); }).find("not a Radiance HDR"),
              std::string::npos);
}

// Our reader is as exact as that of stb.
TEST(ImageFiles, HdrIsReadAsStbReadsIt)
{
    const TemporaryFolder folder;
    const std::string path = folder.path("image.hdr");
    for (const auto& [width, height] : sizes) {
        Image image = testImage(width, height, 3);
        if (width == 200) // with long runs
            std::fill_n(image.pixels.begin(), 3 * 1000, 7.0f);
        saveHdr(path, image);
        const Image back = loadHdr(path);
        int w = 0, h = 0, n = 0;
        const std::unique_ptr<float, void (*)(void*)> pixels(
            stbi_loadf(path.c_str(), &w, &h, &n, 3), stbi_image_free);
        ASSERT_TRUE(pixels);
        ASSERT_EQ(back.pixels.size(), image.pixels.size());
        for (size_t i = 0; i < back.pixels.size(); ++i)
            ASSERT_EQ(back.pixels[i], pixels.get()[i]) << i;
    }
}

// A file that is cut off must be an error at every length. An earlier reader waited forever, or
// returned pixels that were not in the file.
TEST(ImageFiles, DamagedHdrIsOneSentence)
{
    const TemporaryFolder folder;
    for (const uint32_t width : {3u, 40u}) { // stored flat, and in runs
        saveHdr(folder.path("good.hdr"), testImage(width, 5, 3));
        const Bytes good = readBytes(folder.path("good.hdr"));
        for (size_t length = 0; length < good.size(); ++length) {
            const std::string path =
                folder.write("cut.hdr", Bytes(good.begin(), good.begin() + long(length)));
            const std::string message = errorOf([&] { loadHdr(path); });
            EXPECT_EQ(message.find("cannot read " + path + ": "), 0u) << length << " " << message;
        }
    }
    const auto error = [&](const std::string& text) {
        const std::string path = folder.write("bad.hdr", text);
        return errorOf([&] { loadHdr(path); });
    };
    const std::string head = "#?RADIANCE\nFORMAT=32-bit_rle_rgbe\n\n";
    using namespace std::string_literals;
    EXPECT_NE(error(head + "-Y 1 +X 8\n\2\2\0\10"s + std::string(40, '\0')).find("a run of pixels"),
              std::string::npos);
    EXPECT_NE(error(head + "-Y 1 +X 8\n\2\2\0\11"s + std::string(40, '\0')).find("as wide"),
              std::string::npos);
    EXPECT_NE(error(head + "-Y 1 +X 8\n\2\2\0\10\211"s + std::string(40, '\0')).find("a run of"),
              std::string::npos);
    EXPECT_NE(error(head + "-Y 16384 +X 16384\nxx").find("cut short"), std::string::npos);
    EXPECT_NE(error(head + "-Y 99999 +X 1\n").find("16384"), std::string::npos);
    EXPECT_NE(error(head + "+Y 1 +X 1\nabcd").find("rows from the top"), std::string::npos);
    EXPECT_NE(error("#?RADIANCE\n\n-Y 1 +X 1\nabcd").find("FORMAT"), std::string::npos);
}

// Adds attributes to the header of an EXR file of one colour, and returns what is read.
template <typename AddTo>
Image readExrOfOneColour(const std::string& path, const glm::vec3& colour, const AddTo& addTo)
{
    ForeignExr exr{.width = 4, .height = 2};
    Imf::Header header = exr.header();
    addTo(header);
    std::vector<glm::vec3> pixels(size_t(exr.width) * size_t(exr.height), colour);
    Imf::FrameBuffer slices;
    for (int c = 0; c < 3; ++c)
        slices.insert(std::string(1, "RGB"[c]),
                      Imf::Slice(Imf::FLOAT, reinterpret_cast<char*>(&pixels[0][c]),
                                 sizeof(glm::vec3), sizeof(glm::vec3) * size_t(exr.width)));
    {
        Imf::OutputFile file(path.c_str(), header, 0);
        file.setFrameBuffer(slices);
        file.writePixels(exr.height);
    }
    return loadExr(path);
}

void expectColour(const Image& image, const glm::vec3& colour)
{
    for (size_t i = 0; i < image.pixels.size(); ++i)
        EXPECT_NEAR(image.pixels[i], colour[int(i % 3)], 2e-4f) << i;
}

TEST(ImageFiles, ExrColoursOfOtherPrimariesAreConverted)
{
    const TemporaryFolder folder;
    const std::string path = folder.path("image.exr");
    const auto read = [&](const glm::vec3& colour, const Imf::Chromaticities& c) {
        return readExrOfOneColour(path, colour,
                                  [&](Imf::Header& h) { Imf::addChromaticities(h, c); });
    };
    const float third = 1.0f / 3;
    const Imf::Chromaticities xyz({1, 0}, {0, 1}, {0, 0}, {third, third});
    // The red primary of Rec. 709 (IEC 61966-2-1, rounded to four digits there).
    const Image red = read(3.5f * glm::vec3(0.412391f, 0.212639f, 0.019331f), xyz);
    expectColour(red, {3.5f, 0, 0});
    EXPECT_TRUE(red.warnings.empty());
    EXPECT_EQ(*std::min_element(red.pixels.begin(), red.pixels.end()), 0); // not a little less
    // White stays white, whatever the white is.
    const Imf::Chromaticities ap0({0.7347f, 0.2653f}, {0, 1}, {0.0001f, -0.077f},
                                  {0.32168f, 0.33767f});
    expectColour(read({2, 2, 2}, ap0), {2, 2, 2});
    // Green of AP0 is no colour of Rec. 709. ACES publishes this column of its matrix (Bradford).
    const Image green = read({0, 1, 0}, ap0);
    EXPECT_NEAR(green.pixels[0], -1.1343f, 2e-3f);
    EXPECT_NEAR(green.pixels[1], 1.3727f, 2e-3f);
    EXPECT_NEAR(green.pixels[2], -0.1530f, 2e-3f);
    // The default of the class is Rec. 709: bits stay as they are.
    EXPECT_EQ(read({0.1f, 7, 1e-9f}, Imf::Chromaticities()).pixels[2], 1e-9f);
    const Image degenerate = read({1, 2, 3}, Imf::Chromaticities({0, 0}, {0, 0}, {0, 0}, {0, 0}));
    expectColour(degenerate, {1, 2, 3});
    ASSERT_EQ(degenerate.warnings.size(), 1u);
    EXPECT_NE(degenerate.warnings[0].find("chromaticities"), std::string::npos);
    const Image white =
        readExrOfOneColour(path, {1, 2, 3}, [](Imf::Header& h) { Imf::addWhiteLuminance(h, 100); });
    expectColour(white, {1, 2, 3});
    ASSERT_EQ(white.warnings.size(), 1u);
    EXPECT_NE(white.warnings[0].find("whiteLuminance"), std::string::npos);
}

TEST(ImageFiles, HdrHeadersAreApplied)
{
    const TemporaryFolder folder;
    // One pixel of (2, 1, 0.5): mantissas 128, 64 and 32 with the exponent 2.
    const auto read = [&](const std::string& lines) {
        return loadHdr(folder.write("image.hdr", "#?RADIANCE\n" + lines +
                                                     "FORMAT=32-bit_rle_rgbe\n\n-Y 1 +X 1\n" +
                                                     std::string("\x80\x40\x20\x82")));
    };
    expectColour(read(""), {2, 1, 0.5f});
    expectColour(read("EXPOSURE=2\nVIEW= -vtv\nEXPOSURE= 4.0 \r\n"), {0.25f, 0.125f, 0.0625f});
    expectColour(read("COLORCORR= 2 1 0.5\n"), {1, 1, 1});
    expectColour(read("PRIMARIES= 0.64 0.33 0.3 0.6 0.15 0.06 0.3127 0.329\n"), {2, 1, 0.5f});
    // Radiance's own primaries: white stays white.
    const Image white =
        read("COLORCORR= 2 1 0.5\nPRIMARIES= .64 .33 .29 .6 .15 .06 .333333 .333333\n");
    expectColour(white, {1, 1, 1});
    EXPECT_TRUE(white.warnings.empty());
    EXPECT_NE(read("PRIMARIES= .64 .33 .29 .6 .15 .06 .333333 .333333\n").pixels[0], 2);
    for (const std::string line :
         {"EXPOSURE=0", "EXPOSURE=", "EXPOSURE=nan", "EXPOSURE=1 2", "EXPOSURE=-1",
          "EXPOSURE=1e999", "COLORCORR=1 2", "COLORCORR=1 0 1", "PRIMARIES=1 2 3",
          "PRIMARIES=0 0 0 0 0 0 0 0"}) {
        const Image image = read(line + "\n");
        expectColour(image, {2, 1, 0.5f});
        ASSERT_EQ(image.warnings.size(), 1u) << line;
        EXPECT_NE(image.warnings[0].find(line.substr(0, line.find('='))), std::string::npos);
    }
}

TEST(ImageFiles, PfmScalesAreNamed)
{
    const TemporaryFolder folder;
    const std::string pixel("\0\0\x80?", 4); // 1, little-endian
    EXPECT_TRUE(loadPfm(folder.write("a.pfm", "Pf\n1 1\n-1\n" + pixel)).warnings.empty());
    const Image scaled = loadPfm(folder.write("a.pfm", "Pf\n1 1\n-2.5\n" + pixel));
    EXPECT_EQ(scaled.pixels[0], 1);
    ASSERT_EQ(scaled.warnings.size(), 1u);
    EXPECT_NE(scaled.warnings[0].find("scale 2.5"), std::string::npos) << scaled.warnings[0];
}

TEST(ImageFiles, PointersOfGitLfsAreNamed)
{
    const TemporaryFolder folder;
    const std::string pointer = "version https://git-lfs.github.com/spec/v1\noid sha256:0\n";
    for (const char* name : {"sky.hdr", "sky.exr", "sky.pfm"}) {
        const std::string path = folder.write(name, pointer);
        EXPECT_EQ(errorOf([&] { loadImageByExtension(path); }),
                  "cannot read " + path +
                      ": is a pointer of Git LFS, not the file itself; \"git "
                      "lfs pull\" fetches it");
    }
}

TEST(ImageFiles, HdrRefusesWhatItCannotHold)
{
    const TemporaryFolder folder;
    const std::string path = folder.path("image.hdr");
    for (const float x : {nan, infinity, -1.0f, 0x1p127f}) {
        Image image = testImage(5, 4, 3);
        image.pixels[3 * (2 * 5 + 1) + 2] = x;
        const std::string message = errorOf([&] { saveHdr(path, image); });
        EXPECT_EQ(message.find("cannot write " + path + ": pixel (1, 2) is "), 0u) << message;
    }
    EXPECT_FALSE(std::filesystem::exists(path));
}

TEST(ImageFiles, PngKeepsEveryByte)
{
    const TemporaryFolder folder;
    std::vector<uint8_t> rgb(97 * 31 * 3);
    for (size_t i = 0; i < rgb.size(); ++i)
        rgb[i] = static_cast<uint8_t>(i * 7 % 251);
    savePng(folder.path("image.png"), 97, 31, rgb);
    int w = 0, h = 0, n = 0;
    const std::unique_ptr<stbi_uc, void (*)(void*)> pixels(
        stbi_load(folder.path("image.png").c_str(), &w, &h, &n, 0), stbi_image_free);
    ASSERT_TRUE(pixels);
    ASSERT_EQ(w, 97);
    ASSERT_EQ(h, 31);
    ASSERT_EQ(n, 3);
    EXPECT_EQ(std::vector<uint8_t>(pixels.get(), pixels.get() + rgb.size()), rgb);
}

TEST(ImageFiles, PngIsReadAsItWasWritten)
{
    const TemporaryFolder folder;
    const std::vector<uint8_t> rgb{0, 1, 127, 128, 254, 255};
    const std::string path = folder.path("image.PNG");
    savePng(path, 1, 2, rgb);
    const DisplayImage image = loadPng(path);
    ASSERT_EQ(image.width, 1u);
    ASSERT_EQ(image.height, 2u);
    for (size_t i = 0; i < rgb.size(); ++i)
        EXPECT_EQ(image.pixels[i / 3][int(i % 3)], rgb[i] / 255.0f) << i;

    std::vector<uint8_t> bytes = readImageFile(path);
    bytes.resize(bytes.size() - 20);
    folder.write("short.png", bytes);
    bytes.resize(20);
    folder.write("header.png", bytes);
    folder.write("text.png", "text");
    const uint8_t half[]{255, 255, 255, 255, 9, 9, 9, 128};
    stbi_write_png(folder.path("clear.png").c_str(), 2, 1, 4, half, 8);
    const auto refusal = [&](const char* name) {
        return errorOf([&] { loadPng(folder.path(name)); });
    };
    EXPECT_NE(refusal("short.png").find("short.png: is damaged, cut short"), std::string::npos);
    EXPECT_NE(refusal("header.png").find("broken PNG header"), std::string::npos);
    EXPECT_NE(refusal("text.png").find("is not a PNG file"), std::string::npos);
    EXPECT_NE(refusal("clear.png").find("pixel (1, 0) is transparent"), std::string::npos);
    EXPECT_NE(refusal("none.png").find("No such file"), std::string::npos);
}

TEST(ImageFiles, ErrorsNameTheFile)
{
    const TemporaryFolder folder;
    const Image image = testImage(4, 4, 3);
    for (const char* name : {"none/x.exr", "none/x.hdr", "none/x.pfm"}) {
        const std::string path = folder.path(name);
        EXPECT_EQ(errorOf([&] { saveImageByExtension(path, image); }),
                  "cannot write " + path + ": No such file or directory");
    }
    EXPECT_EQ(errorOf([&] { saveImageByExtension("x.jpg", image); }),
              "cannot write x.jpg: the extension must be .exr, .hdr or .pfm for linear images");
    std::filesystem::create_directory(folder.path("folder.pfm"));
    EXPECT_EQ(errorOf([&] { savePfm(folder.path("folder.pfm"), image); }),
              "cannot write " + folder.path("folder.pfm") + ": is a directory");
    EXPECT_EQ(errorOf([&] { savePfm("/dev/full", image); }),
              "cannot write /dev/full: is not a regular file");
    EXPECT_EQ(errorOf([&] { savePng("x.png", 2, 2, {}); }),
              "cannot write x.png: the image cannot have 2 x 2 pixels in 0 bytes");
    Image broken = image;
    broken.pixels.pop_back();
    EXPECT_EQ(errorOf([&] { saveExr("x.exr", broken); }),
              "cannot write x.exr: the image cannot have 4 x 4 pixels of 3 channels in 47 values");
}

TEST(ImageFiles, AFullDiskLeavesTheOldFile)
{
    const TemporaryFolder folder;
    const std::string path = folder.path("image.pfm");
    const Image before = testImage(2, 2, 3);
    savePfm(path, before);

    rlimit old = {};
    ASSERT_EQ(getrlimit(RLIMIT_FSIZE, &old), 0);
    const auto handler = std::signal(SIGXFSZ, SIG_IGN); // fail as on a full disk instead of being
                                                        // killed
    const rlimit small = {1000, old.rlim_max};
    ASSERT_EQ(setrlimit(RLIMIT_FSIZE, &small), 0);
    const std::string message = errorOf([&] { savePfm(path, testImage(100, 100, 3)); });
    setrlimit(RLIMIT_FSIZE, &old);
    std::signal(SIGXFSZ, handler);

    EXPECT_EQ(message, "cannot write " + path + ": File too large");
    expectSame(loadPfm(path), before);
    size_t files = 0;
    for (const auto& entry : std::filesystem::directory_iterator(folder.path("")))
        files += entry.is_regular_file();
    EXPECT_EQ(files, 1u); // no temporary file is left
}

// The most memory that this process had so far, in MiB.
long peakMemory()
{
    rusage usage = {};
    getrusage(RUSAGE_SELF, &usage);
    return usage.ru_maxrss / 1024;
}

// Overwrites 32-bit values of an attribute. `type` is the name of its type.
Bytes edited(Bytes bytes, const std::string& attribute, const std::string& type,
             std::initializer_list<int32_t> values)
{
    const std::string key = attribute + '\0' + type + '\0';
    const auto at = std::search(bytes.begin(), bytes.end(), key.begin(), key.end());
    if (at == bytes.end())
        throw std::runtime_error("no attribute " + attribute);
    auto byte = at + long(key.size()) + 4; // after the size of the value
    for (const int32_t value : values)
        for (int i = 0; i < 4; ++i)
            *byte++ = static_cast<uint8_t>(static_cast<uint32_t>(value) >> (8 * i));
    return bytes;
}

// libFuzzer once found an EXR file that asked for 2^63 bytes.
TEST(ImageFiles, ExrsOfAbsurdSizesAreRefused)
{
    const TemporaryFolder folder;
    saveExr(folder.path("image.exr"), testImage(8, 8, 3));
    const Bytes whole = readBytes(folder.path("image.exr"));
    const long before = peakMemory();
    const auto errorOfBytes = [&](const Bytes& bytes) {
        const std::string path = folder.write("absurd.exr", bytes);
        const std::string message = errorOf([&] { loadExr(path); }),
                          start = "cannot read " + path + ": ";
        EXPECT_EQ(message.find(start), 0u) << message;
        return message.substr(std::min(start.size(), message.size()));
    };
    const auto errorOfWindow = [&](int32_t left, int32_t top, int32_t right, int32_t bottom) {
        return errorOfBytes(edited(whole, "dataWindow", "box2i", {left, top, right, bottom}));
    };
    EXPECT_EQ(errorOfWindow(0, std::numeric_limits<int32_t>::min(), 7, 7).find("Invalid data"), 0u);
    EXPECT_EQ(errorOfWindow(0, 8, 7, 7).find("Invalid data window"), 0u);
    EXPECT_EQ(errorOfWindow(0, -20'000, 7, 7),
              "its data window has 8 x 20008 pixels; 1 to 16384 a side can be read");
    EXPECT_EQ(errorOfWindow(-1000, 0, 1'000'000'000, 7),
              "its data window has 1000001001 x 8 pixels; 1 to 16384 a side can be read");
    // A size that can be read, but its 3 GiB of pixels are not in the file.
    EXPECT_NE(errorOfWindow(0, 0, 16383, 16383), "");

    // An attribute that claims 2^31 - 1 bytes, in place of one of 4 bytes.
    Bytes bytes = whole;
    const std::string from = std::string("pixelAspectRatio") + '\0' + "float" + '\0',
                      to = std::string("comment") + '\0' + "string" + '\0' + "\xff\xff\xff\x7f";
    const auto at = std::search(bytes.begin(), bytes.end(), from.begin(), from.end());
    ASSERT_NE(at, bytes.end());
    std::copy(to.begin(), to.end(), at);
    EXPECT_NE(errorOfBytes(bytes), "");

    // A block of rows that would take 400 MiB: 200 channels whose rows are 16384 pixels long.
    Imf::Header header =
        ForeignExr{.channels = "", .compression = Imf::PIZ_COMPRESSION, .width = 16, .height = 32}
            .header();
    float zeros[16] = {};
    Imf::FrameBuffer slices;
    for (int c = 0; c < 200; ++c) {
        header.channels().insert("c" + std::to_string(c), Imf::Channel(Imf::FLOAT));
        slices.insert("c" + std::to_string(c),
                      Imf::Slice(Imf::FLOAT, reinterpret_cast<char*>(zeros), sizeof(float), 0));
    }
    {
        Imf::OutputFile file(folder.path("wide.exr").c_str(), header, 0);
        file.setFrameBuffer(slices);
        file.writePixels(32);
    }
    EXPECT_EQ(errorOfBytes(edited(readBytes(folder.path("wide.exr")), "dataWindow", "box2i",
                                  {0, 0, 16383, 31})),
              "Unable to allocate 419430400 bytes");
    EXPECT_LT(peakMemory() - before, 64) << "MiB";
}

// A file that is cut off must be an error at every length, and so must blocks that are shorter than
// their rows.
TEST(ImageFiles, DamagedExrIsOneSentence)
{
    const TemporaryFolder folder;
    const std::string path = folder.path("image.exr");
    for (const Imf::Compression compression : {Imf::NO_COMPRESSION, Imf::ZIP_COMPRESSION}) {
        const ForeignExr foreign{.compression = compression, .width = 5, .height = 3};
        foreign.write(path);
        const Bytes good = readBytes(path);
        // The headers are the same.
        size_t length = compression == Imf::NO_COMPRESSION ? 0 : good.size() - 100;
        for (; length < good.size(); ++length) {
            const std::string cut =
                folder.write("cut.exr", Bytes(good.begin(), good.begin() + long(length)));
            const std::string message = errorOf([&] { loadExr(cut); });
            EXPECT_EQ(message.find("cannot read " + cut + ": "), 0u) << length << " " << message;
        }
    }
    // Without compression a block holds one row: its number and size in bytes, then the pixels.
    ForeignExr{.compression = Imf::NO_COMPRESSION, .width = 5, .height = 1}.write(path);
    Bytes bytes = readBytes(path);
    constexpr size_t pixels = 5 * 3 * sizeof(float);
    bytes[bytes.size() - pixels - 4] = pixels - 4;
    const std::string shorter = folder.write("short.exr", bytes);
    EXPECT_EQ(errorOf([&] { loadExr(shorter); }),
              "cannot read " + shorter +
                  ": is damaged: a block of rows has 56 bytes instead of 60");
}

TEST(ImageFiles, BrokenFilesAreRefused)
{
    const TemporaryFolder folder;
    EXPECT_EQ(errorOf([&] { loadPfm(folder.path("none.pfm")); }),
              "cannot read " + folder.path("none.pfm") + ": No such file or directory");
    for (const char* text : {"", "P6\n1 1\n-1\n", "PF\n", "PF\n1\n-1\n", "PF\n0 1\n-1\n",
                             "PF\n99999999 99999999\n-1\n", "PF\n-1 1\n-1\n", "PF\n1 1\nx\n",
                             "PF\n1 1\n0\n", "PF\n1 1\n-1\nshort"}) {
        const std::string path = folder.write("broken.pfm", std::string(text));
        const std::string message = errorOf([&] { loadPfm(path); });
        EXPECT_EQ(message.find("cannot read " + path + ": "), 0u) << text << ": " << message;
    }
    saveExr(folder.path("image.exr"), testImage(40, 40, 3));
    const Bytes whole = readBytes(folder.path("image.exr"));
    for (const size_t size : {size_t{0}, size_t{4}, size_t{100}, whole.size() / 2}) {
        const std::string path = folder.write(
            "cut.exr", Bytes(whole.begin(), whole.begin() + static_cast<ptrdiff_t>(size)));
        const std::string message = errorOf([&] { loadExr(path); });
        EXPECT_EQ(message.find("cannot read " + path + ": "), 0u) << size << ": " << message;
    }
}

} // namespace

} // namespace candelabra::test
