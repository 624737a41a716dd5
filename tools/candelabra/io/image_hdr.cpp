// SPDX-License-Identifier: Apache-2.0
// Reads Radiance HDR files (Ward 1991, "Real pixels"). stb_image is not used because it reads zeros
// beyond the end of a truncated file. It then returns pixels that are not in the file, and loops
// for ever if the file ends inside a run.
#include <algorithm>
#include <charconv>
#include <cmath>
#include <cstring>
#include <optional>
#include <string_view>

#include "io/chromaticities.h"
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
    void readVariable(std::string_view text);
    void applyHeader();
    void readRow(float* row);
    void readRuns(float* row);
    std::span<const uint8_t> take(size_t count);
    // The least number of bytes that a row of pixels can take in the file.
    size_t smallestRow() const;
    // The format has run-length encoding only for rows of 8 to 32767 pixels.
    bool mayHaveRuns() const { return image_.width >= 8 && image_.width < 32768; }

    void warn(const std::string& text) { image_.warnings.push_back(path_ + ": " + text); }

    const std::string& path_;
    std::span<const uint8_t> rest_;
    Image image_{.channels = 3};
    glm::dvec3 applied_{1}; // factors that were applied to the values
    std::optional<Chromaticities> primaries_;
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

// Reads `count` numbers between white space. Returns nothing if there are others.
std::vector<double> numbersIn(std::string_view text, size_t count)
{
    std::vector<double> out;
    for (;;) {
        text.remove_prefix(std::min(text.find_first_not_of(" \t\r"), text.size()));
        double value = 0;
        const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
        if (text.empty())
            return out.size() == count ? out : std::vector<double>();
        if (error != std::errc() || !std::isfinite(value))
            return {};
        out.push_back(value);
        text.remove_prefix(size_t(end - text.data()));
    }
}

// Reads a line of the header that says what the values are. Settings of EXPOSURE and COLORCORR
// multiply (Ward, "The Radiance picture file format").
void HdrReader::readVariable(std::string_view text)
{
    const std::string_view name = text.substr(0, text.find('='));
    const std::string_view value = text.substr(std::min(name.size() + 1, text.size()));
    const bool isColour = name == "COLORCORR", isPrimaries = name == "PRIMARIES";
    if (name != "EXPOSURE" && !isColour && !isPrimaries)
        return;
    const std::vector<double> v = numbersIn(value, isPrimaries ? 8 : isColour ? 3 : 1);
    const auto isFactor = [](double x) { return x > 1e-30 && x < 1e30; };
    if (isPrimaries && !v.empty())
        primaries_ = {{v[0], v[1]}, {v[2], v[3]}, {v[4], v[5]}, {v[6], v[7]}};
    else if (!isPrimaries && !v.empty() && std::ranges::all_of(v, isFactor))
        applied_ *= isColour ? glm::dvec3(v[0], v[1], v[2]) : glm::dvec3(v[0]);
    else
        warn(std::string(name) + " of its header has no meaning and is ignored");
}

void HdrReader::applyHeader()
{
    if (applied_ != glm::dvec3(1))
        for (size_t i = 0; i < image_.pixels.size(); ++i)
            image_.pixels[i] = float(image_.pixels[i] / applied_[int(i % 3)]);
    if (primaries_ && !convertToRec709(image_, *primaries_))
        warn("PRIMARIES of its header span no colours; its values are taken for Rec. 709");
}

void HdrReader::readHeader()
{
    const auto* begin = reinterpret_cast<const char*>(rest_.data());
    const std::string_view start(begin, std::min<size_t>(rest_.size(), 11));
    if (!start.starts_with("#?RADIANCE\n") && !start.starts_with("#?RGBE\n"))
        failRead(path_, "is not a Radiance HDR file");
    bool rgbe = false;
    for (std::string_view text = line(); !text.empty(); text = line()) {
        rgbe |= text == "FORMAT=32-bit_rle_rgbe";
        readVariable(text);
    }
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
    applyHeader();
    return std::move(image_);
}

} // namespace

Image loadHdr(const std::string& path)
{
    return HdrReader(path, readImageFile(path)).read();
}

} // namespace candelabra::app
