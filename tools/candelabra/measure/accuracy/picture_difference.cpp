// SPDX-License-Identifier: Apache-2.0
#include "measure/accuracy/picture_difference.h"

#include <algorithm>
#include <cmath>
#include <cstring>
#include <limits>

#include "io/statistics.h"
#include "measure/accuracy/flip.h"
#include "measure/accuracy/image_error.h"

namespace candelabra::app
{
namespace
{

bool isFinite(const Image& image, size_t pixel)
{
    const float* p = &image.pixels[3 * pixel];
    return std::isfinite(p[0]) && std::isfinite(p[1]) && std::isfinite(p[2]);
}

bool isEqual(const Image& a, const Image& b, size_t pixel)
{
    for (size_t i = 3 * pixel; i < 3 * pixel + 3; ++i)
        if (a.pixels[i] != b.pixels[i] && !(std::isnan(a.pixels[i]) && std::isnan(b.pixels[i])))
            return false;
    return true;
}

// Measures the pixels `kept`, which are finite in both pictures.
void measure(const Image& a, const Image& b, const std::vector<size_t>& kept,
             PictureDifference& out)
{
    Image keptA{.channels = 3}, keptB{.channels = 3};
    double largest = -1;
    for (const size_t pixel : kept)
        for (uint32_t c = 0; c < 3; ++c) {
            const float x = a.pixels[3 * pixel + c], y = b.pixels[3 * pixel + c];
            keptA.pixels.push_back(x);
            keptB.pixels.push_back(y);
            if (const double d = std::abs(double(x) - double(y)); d > largest) {
                largest = d;
                out.largest = {uint32_t(pixel % a.width), uint32_t(pixel / a.width), c, double(x),
                               double(y)};
            }
        }
    std::vector<double> errors = relativeErrors(keptA, keptB);
    for (size_t i = 0; i < errors.size(); ++i) {
        out.meanRel += errors[i] / double(errors.size());
        out.relMse += errors[i] * errors[i] / double(errors.size());
        float& ofPixel = out.errors[kept[i / 3]];
        ofPixel = std::max(ofPixel, float(errors[i]));
    }
    if (!errors.empty())
        out.p99Rel = spreadOf(std::move(errors)).p99;
}

DisplayImage displayImage(const Image& image)
{
    DisplayImage out{image.width, image.height, {}};
    for (size_t i = 0; i < image.pixels.size(); i += 3)
        out.pixels.emplace_back(image.pixels[i], image.pixels[i + 1], image.pixels[i + 2]);
    return out;
}

constexpr float leastError = 1e-4f; // the relative error at the dark end of the map; 1 at the other

uint32_t errorColour(float error)
{
    if (std::isnan(error))
        return packed(glm::vec3(1));
    if (error == 0)
        return packed(glm::vec3(0));
    return packed(viridis(std::clamp(1 - std::log(error) / std::log(leastError), 0.0f, 1.0f)));
}

} // namespace

PictureDifference pictureDifference(const Image& a, const Image& b)
{
    PictureDifference out;
    out.sameBits =
        std::memcmp(a.pixels.data(), b.pixels.data(), a.pixels.size() * sizeof(float)) == 0;
    const size_t count = size_t{a.width} * a.height;
    out.errors.resize(count);
    std::vector<size_t> kept;
    for (size_t pixel = 0; pixel < count; ++pixel) {
        const bool finiteA = isFinite(a, pixel), finiteB = isFinite(b, pixel);
        const bool equal = isEqual(a, b, pixel);
        out.pixels += !equal;
        out.notFiniteA += !finiteA;
        out.notFiniteB += !finiteB;
        if (finiteA && finiteB) {
            kept.push_back(pixel);
        } else if (!equal) {
            ++out.notFinitePixels;
            out.errors[pixel] = std::numeric_limits<float>::quiet_NaN();
        }
    }
    measure(a, b, kept, out);
    return out;
}

double pictureFlip(Image a, Image b, bool linear)
{
    for (size_t pixel = 0; pixel < a.pixels.size() / 3; ++pixel)
        if (!isFinite(a, pixel) || !isFinite(b, pixel))
            for (Image* image : {&a, &b})
                std::fill_n(&image->pixels[3 * pixel], 3, 0.0f);
    const Displayed displayed =
        linear ? displayBoth(b, a) : Displayed{displayImage(b), displayImage(a)};
    return meanOf(flipMap(displayed.truth, displayed.value));
}

Legend errorMap(const std::vector<float>& errors, uint32_t width, uint32_t height)
{
    const Legend legend =
        barLegend("relative error, black none, white NaN",
                  {{0, "0.01%"}, {0.25f, "0.1%"}, {0.5f, "1%"}, {0.75f, "10%"}, {1, "100%"}},
                  std::max(1u, height / 360));
    Legend out{std::max(width, legend.width), height + legend.height, {}};
    out.pixels.assign(size_t{out.width} * out.height, packed(glm::vec3(0.08f)));
    for (size_t i = 0; i < errors.size(); ++i)
        out.pixels[i / width * out.width + i % width] = errorColour(errors[i]);
    for (uint32_t y = 0; y < legend.height; ++y)
        std::copy_n(&legend.pixels[size_t{y} * legend.width], legend.width,
                    &out.pixels[size_t{height + y} * out.width]);
    return out;
}

} // namespace candelabra::app
