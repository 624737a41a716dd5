// SPDX-License-Identifier: Apache-2.0
// Reads Radiance HDR files (Ward 1991, "Real pixels"). stb_image is not used because it reads zeros
// beyond the end of a file that is cut short: it gives pixels that nobody wrote, and loops for ever
// if the file ends inside a run.
#include <algorithm>
#include <charconv>
#include <cmath>
#include <cstring>
#include <string_view>

#include "io/image.h"
#include "io/image_file.h"

namespace candelabra::app
{
namespace
{

class HdrReader
{
public:
    HdrReader(const std::string& path, std::span<const uint8_t> bytes) : path_(path), rest_(bytes)
    {
    }
    Image read();

private:
    // Takes the next line of the header and returns it without its newline. Fails if there is none.
    std::string_view line();
    void readHeader();
    void readRow(float* row);
    void readRuns(float* row);
    std::span<const uint8_t> take(size_t count);
    // The least number of bytes that a row of pixels can take in the file.
    size_t smallestRow() const;
    // The format has run-length encoding only for rows of 8 to 32767 pixels.
    bool mayHaveRuns() const { return image_.width >= 8 && image_.width < 32768; }

    const std::string& path_;
    std::span<const uint8_t> rest_;
    Image image_{.channels = 3};
    std::vector<uint8_t> row_; // 4 * width: all red, all green, all blue, all exponents
};

void decode(uint8_t r, uint8_t g, uint8_t b, uint8_t exponent, float* out)
{
    // A mantissa m stands for m / 256 and an exponent e for 2^(e - 128); an exponent of 0 is black.
    const float scale = exponent ? std::ldexp(1.0f, int(exponent) - (128 + 8)) : 0.0f;
    out[0] = r * scale;
    out[1] = g * scale;
    out[2] = b * scale;
}

std::span<const uint8_t> HdrReader::take(size_t count)
{
    if (rest_.size() < count)
        failRead(path_, "is cut short: pixels are missing");
    const auto out = rest_.first(count);
    rest_ = rest_.subspan(count);
    return out;
}

std::string_view HdrReader::line()
{
    const auto* begin = reinterpret_cast<const char*>(rest_.data());
    const auto* end = begin + rest_.size();
    const auto* newline = std::find(begin, end, '\n');
    if (newline == end)
        failRead(path_, "has a broken Radiance HDR header");
    rest_ = rest_.subspan(size_t(newline - begin) + 1);
    return {begin, newline};
}

void HdrReader::readHeader()
{
    const auto* begin = reinterpret_cast<const char*>(rest_.data());
    const std::string_view start(begin, std::min<size_t>(rest_.size(), 11));
    if (!start.starts_with("#?RADIANCE\n") && !start.starts_with("#?RGBE\n"))
        failRead(path_, "is not a Radiance HDR file");
    bool rgbe = false;
    for (std::string_view text = line(); !text.empty(); text = line())
        rgbe |= text == "FORMAT=32-bit_rle_rgbe";
    if (!rgbe)
        failRead(path_, "does not declare FORMAT=32-bit_rle_rgbe");
    const std::string_view size = line(); // "-Y 512 +X 1024"
    const auto number = [&](std::string_view key, const char* from, uint32_t& value) {
        if (!std::string_view(from, size.end()).starts_with(key))
            failRead(path_, "does not store its rows from the top, or has a broken size");
        const auto [end, error] = std::from_chars(from + key.size(), size.end(), value);
        if (error == std::errc::invalid_argument || value < 1)
            failRead(path_, "has a broken Radiance HDR header");
        if (error != std::errc() || value > maxImageSize)
            failRead(path_, "is larger than " + std::to_string(maxImageSize) + " pixels a side");
        return end;
    };
    const char* end = number("-Y ", size.begin(), image_.height);
    end = number(" +X ", end, image_.width);
    if (end != size.end())
        failRead(path_, "has a broken Radiance HDR header");
}

size_t HdrReader::smallestRow() const
{
    const size_t flat = size_t{4} * image_.width;
    const size_t runs = 4 + 4 * 2 * ((image_.width + 126) / 127); // a run has at most 127 pixels
    return mayHaveRuns() ? std::min(flat, runs) : flat;
}

// Reads a run-length encoded row, one channel after the other. A code above 128 repeats the next
// byte code - 128 times, 1 to 127; a code of 1 to 128 is the number of bytes that follow as they
// are.
void HdrReader::readRuns(float* row)
{
    const size_t width = image_.width;
    row_.resize(4 * width);
    for (size_t channel = 0; channel < 4; ++channel)
        for (size_t x = 0; x < width;) {
            const size_t code = take(1)[0];
            const size_t count = code > 128 ? code - 128 : code;
            if (count < 1 || count > width - x)
                failRead(path_, "is damaged: a run of pixels has " + std::to_string(count) +
                                    " where 1 to " + std::to_string(width - x) + " fit");
            uint8_t* out = &row_[channel * width + x];
            if (code > 128)
                std::memset(out, take(1)[0], count);
            else
                std::memcpy(out, take(count).data(), count);
            x += count;
        }
    for (size_t x = 0; x < width; ++x)
        decode(row_[x], row_[width + x], row_[2 * width + x], row_[3 * width + x], row + 3 * x);
}

void HdrReader::readRow(float* row)
{
    // A run-length encoded row begins with the bytes 2, 2 and its width in two bytes, the first
    // below 128. No pixel can begin like that, because one of its three mantissas has the top bit
    // set.
    const bool runs =
        mayHaveRuns() && rest_.size() >= 4 && rest_[0] == 2 && rest_[1] == 2 && rest_[2] < 128;
    if (!runs) {
        const auto pixels = take(size_t{4} * image_.width);
        for (size_t x = 0; x < image_.width; ++x)
            decode(pixels[4 * x], pixels[4 * x + 1], pixels[4 * x + 2], pixels[4 * x + 3],
                   row + 3 * x);
        return;
    }
    const auto start = take(4);
    if (size_t(start[2]) << 8 != (image_.width & ~255u) || start[3] != (image_.width & 255))
        failRead(path_, "is damaged: a row is not as wide as the image");
    readRuns(row);
}

Image HdrReader::read()
{
    readHeader();
    // Checked before memory is allocated, because a short file may claim to be a large image.
    if (rest_.size() / image_.height < smallestRow())
        failRead(path_, "is cut short: pixels are missing");
    image_.pixels.resize(size_t{3} * image_.width * image_.height);
    for (size_t y = 0; y < image_.height; ++y)
        readRow(&image_.pixels[3 * image_.width * y]);
    return std::move(image_);
}

} // namespace

Image loadHdr(const std::string& path)
{
    return HdrReader(path, readImageFile(path)).read();
}

} // namespace candelabra::app
