// SPDX-License-Identifier: Apache-2.0
#include "measure/accuracy/image_error.h"

#include <algorithm>
#include <cmath>
#include <numeric>

#include "candelabra/candelabra.hpp"
#include "reference/eye_adaptation.h"
#include "reference/tone_map.h"

namespace candelabra::app
{
namespace
{

constexpr double litShare = 1e-3; // channels above this share of the largest value are lit
constexpr size_t worstPixels = 8;

std::vector<WorstPixel> worstOf(const Image& value, const Image& truth)
{
    std::vector<std::pair<double, size_t>> bySize; // the worst channel of each pixel
    for (size_t pixel = 0; pixel < truth.pixels.size() / 3; ++pixel) {
        std::pair<double, size_t> worst{-1, 0};
        for (size_t i = 3 * pixel; i < 3 * pixel + 3; ++i)
            worst =
                std::max(worst, {std::abs(double(value.pixels[i]) - double(truth.pixels[i])), i});
        bySize.push_back(worst);
    }
    const size_t count = std::min(worstPixels, bySize.size());
    std::partial_sort(bySize.begin(), bySize.begin() + ptrdiff_t(count), bySize.end(),
                      std::greater<>());
    std::vector<WorstPixel> out;
    for (size_t k = 0; k < count; ++k) {
        const size_t i = bySize[k].second;
        out.push_back({uint32_t(i / 3 % truth.width), uint32_t(i / 3 / truth.width),
                       double(value.pixels[i]), double(truth.pixels[i])});
    }
    return out;
}

DisplayImage displayed(const Image& image, double exposure, CndToneMap curve)
{
    DisplayImage out{image.width, image.height, {}};
    for (size_t i = 0; i < image.pixels.size(); i += 3) {
        const glm::dvec3 exposed =
            exposure * glm::dvec3(image.pixels[i], image.pixels[i + 1], image.pixels[i + 2]);
        const glm::dvec3 mapped = reference::toneMap(curve, exposed);
        out.pixels.emplace_back(reference::srgbEncode(mapped.x), reference::srgbEncode(mapped.y),
                                reference::srgbEncode(mapped.z));
    }
    return out;
}

} // namespace

std::vector<double> relativeErrors(const Image& value, const Image& truth)
{
    double sum = 0;
    for (const float t : truth.pixels)
        sum += double(t);
    const double floor = 0.1 * sum / double(truth.pixels.size());
    std::vector<double> out;
    out.reserve(truth.pixels.size());
    for (size_t i = 0; i < truth.pixels.size(); ++i) {
        const double d = std::abs(double(value.pixels[i]) - double(truth.pixels[i]));
        out.push_back(d > 0 ? d / std::hypot(double(truth.pixels[i]), floor) : 0);
    }
    return out;
}

ImageDifference imageDifference(const Image& image, const Image& truth)
{
    ImageDifference out;
    Image value = image;
    for (float& x : value.pixels)
        if (!std::isfinite(x)) {
            ++out.invalid;
            x = 0;
        }
    const size_t n = truth.pixels.size();
    double sum = 0, valueSum = 0, peak = 0;
    for (const float t : truth.pixels) {
        sum += double(t);
        peak = std::max(peak, double(t));
    }
    for (const double e : relativeErrors(value, truth))
        out.relMse += e * e / double(n);
    std::vector<double> lit;
    double litSquares = 0;
    for (size_t i = 0; i < n; ++i) {
        const double t = double(truth.pixels[i]);
        const double v = double(value.pixels[i]);
        const double d = std::abs(v - t);
        valueSum += v;
        out.relL1 += d;
        out.maxOverPeak = std::max(out.maxOverPeak, d);
        if (t > litShare * peak) {
            lit.push_back(d / t);
            litSquares += d * d / (t * t);
        }
    }
    if (!(sum > 0))
        return out;
    out.relL1 /= sum;
    out.maxOverPeak /= peak;
    out.energy = valueSum / sum - 1;
    std::ranges::sort(lit);
    out.litRelMse = litSquares / double(lit.size());
    out.litMeanRel = std::accumulate(lit.begin(), lit.end(), 0.0) / double(lit.size());
    out.litP99Rel = lit[size_t(std::ceil(0.99 * double(lit.size()))) - 1];
    out.litMaxRel = lit.back();
    out.worst = worstOf(value, truth);
    return out;
}

Displayed displayBoth(const Image& truth, const Image& value)
{
    const CndExposureSettings settings = defaultExposureSettings();
    std::vector<float> rgba;
    for (size_t i = 0; i < truth.pixels.size(); i += 3)
        rgba.insert(rgba.end(), {truth.pixels[i], truth.pixels[i + 1], truth.pixels[i + 2], 1.0f});
    const reference::Histogram histogram =
        reference::buildHistogram(rgba, truth.width, truth.height, settings.metering);
    const double exposure = reference::adapt(histogram, settings, 0, 0, true).exposure;
    return {displayed(truth, exposure, settings.toneMap),
            displayed(value, exposure, settings.toneMap)};
}

Json toJson(const ImageDifference& e)
{
    Json worst = Json::array();
    for (const WorstPixel& p : e.worst)
        worst.push_back({{"x", p.x}, {"y", p.y}, {"value", p.value}, {"truth", p.truth}});
    return {{"relMse", e.relMse},
            {"relL1", e.relL1},
            {"maxOverPeak", e.maxOverPeak},
            {"energy", e.energy},
            {"lit",
             {{"relMse", e.litRelMse},
              {"meanRel", e.litMeanRel},
              {"p99Rel", e.litP99Rel},
              {"maxRel", e.litMaxRel}}},
            {"flip", e.flip},
            {"invalid", e.invalid},
            {"worstPixels", worst}};
}

} // namespace candelabra::app
