// SPDX-License-Identifier: Apache-2.0
#include "bench/page.h"

#include <algorithm>
#include <array>
#include <cmath>

#include <fmt/format.h>

#include "io/markup.h"
#include "io/table.h"

namespace candelabra::app
{
namespace
{

constexpr const char* head = R"(<!DOCTYPE html>
<html lang="en"><head><meta charset="utf-8"/><title>Candelabra: error against time</title>
<style>
body { font: 15px/1.5 "DejaVu Sans", Helvetica, Arial, sans-serif; color: #202020; margin: 2em auto;
       max-width: 1200px; padding: 0 1em; }
pre { font: 12.5px/1.45 "DejaVu Sans Mono", Menlo, Consolas, monospace; background: #f6f6f4;
      padding: 1em; overflow-x: auto; }
figure { display: inline-block; margin: 0 10px 14px 0; vertical-align: top; width: 264px; }
figure img { width: 100%; image-rendering: pixelated; display: block; background: #000; }
figcaption { font-size: 12.5px; color: #505050; }
svg { max-width: 100%; height: auto; }
h2 { margin-top: 2em; border-bottom: 1px solid #d0d0d0; }
</style></head><body>
)";

// RFC 4648.
std::string base64(const std::vector<uint8_t>& bytes)
{
    constexpr const char* digits =
        "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
    std::string out;
    for (size_t i = 0; i < bytes.size(); i += 3) {
        const size_t left = bytes.size() - i;
        const uint32_t word = uint32_t(bytes[i]) << 16 |
                              uint32_t(left > 1 ? bytes[i + 1] : 0) << 8 |
                              uint32_t(left > 2 ? bytes[i + 2] : 0);
        out += digits[word >> 18];
        out += digits[word >> 12 & 63];
        out += left > 1 ? digits[word >> 6 & 63] : '=';
        out += left > 2 ? digits[word & 63] : '=';
    }
    return out;
}

uint8_t byteOf(float x)
{
    return uint8_t(std::lround(std::clamp(x, 0.0f, 1.0f) * 255));
}

std::string figure(const DisplayImage& image, const std::string& caption)
{
    std::vector<uint8_t> rgb;
    for (const glm::vec3& p : image.pixels)
        rgb.insert(rgb.end(), {byteOf(p.x), byteOf(p.y), byteOf(p.z)});
    return fmt::format("<figure><img alt=\"\" src=\"data:image/png;base64,{}\"/><figcaption>{}"
                       "</figcaption></figure>\n",
                       base64(encodePng("page", image.width, image.height, rgb)), escaped(caption));
}

// Black, purple, red, orange, pale yellow: steps of "magma" (van der Walt and Smith 2015).
glm::vec3 heat(float x)
{
    static const std::array<glm::vec3, 6> steps = {
        glm::vec3(0.001f, 0.000f, 0.014f), glm::vec3(0.232f, 0.060f, 0.438f),
        glm::vec3(0.550f, 0.161f, 0.506f), glm::vec3(0.868f, 0.288f, 0.409f),
        glm::vec3(0.995f, 0.624f, 0.427f), glm::vec3(0.987f, 0.991f, 0.750f)};
    const float at = std::clamp(x, 0.0f, 1.0f) * float(steps.size() - 1);
    const size_t i = std::min(size_t(at), steps.size() - 2);
    return glm::mix(steps[i], steps[i + 1], at - float(i));
}

// A map of 0 .. 1 where the eye can tell: FLIP beyond 0.5 is rare.
DisplayImage heatMap(const std::vector<float>& map, uint32_t width, uint32_t height)
{
    DisplayImage out{width, height, {}};
    for (const float x : map)
        out.pixels.push_back(heat(2 * x));
    return out;
}

std::string worstPixelTable(const ImageScene& scene)
{
    Table table({"method, pixel", "value cd/m^2", "truth cd/m^2", "ratio"});
    for (const ImagePoint& p : scene.points)
        for (size_t k = 0; k < std::min<size_t>(p.error.worst.size(), 3); ++k) {
            const WorstPixel& w = p.error.worst[k];
            table.add({fmt::format("{} ({}, {})", methodName(p.method), w.x, w.y),
                       threeDigits(w.value), threeDigits(w.truth),
                       w.truth > 0 ? threeDigits(w.value / w.truth) : "-"});
        }
    return table.text();
}

std::string sceneSection(const ImageScene& scene)
{
    std::string out = "<h2>" + escaped(scene.name) + "</h2>\n";
    for (const ImagePoint& p : scene.points) {
        const Displayed displayed = displayBoth(scene.truth, p.radiance);
        if (&p == &scene.points.front())
            out += figure(displayed.truth, "truth: double-precision quadrature") + "<br/>\n";
        const std::string figures = fmt::format(
            "{}: {} ms, relMSE {:.1e}, lit mean {:.1e}, FLIP {:.4f}", methodName(p.method),
            threeDigits(p.time.lightingMs), p.error.relMse, p.error.litMeanRel, p.error.flip);
        out += figure(displayed.value, figures);
        out += figure(heatMap(flipMap(displayed.truth, displayed.value), displayed.truth.width,
                              displayed.truth.height),
                      std::string(methodName(p.method)) + ": FLIP, 0 black to 0.5 yellow");
    }
    return out + "<h3>Worst pixels</h3><pre>" + escaped(worstPixelTable(scene)) + "</pre>\n";
}

std::string worstSamples(const KernelLevel& kernels)
{
    std::string out;
    for (const KernelPoint& p : kernels.points)
        out += fmt::format("{} {}: {}% at {}\n", lightTypeName(p.lightType), methodName(p.method),
                           threeDigits(100 * p.error.mirror.all.max), p.worst);
    return out;
}

} // namespace

std::string accuracyPage(const Json& provenance, const KernelLevel& kernels,
                         const std::vector<ImageScene>& scenes, const BudgetSweep& budgets,
                         const DeviceInfo& device)
{
    std::string out = head;
    out += "<h1>Error against time</h1>\n<pre>" + escaped(provenance.dump(2)) + "</pre>\n";
    out += "<h2>One light at one pixel</h2>\n" + kernelPlot(kernels, device) + "<pre>" +
           escaped(kernelTables(kernels)) + "</pre>\n<h3>Worst samples, F = 1</h3><pre>" +
           escaped(worstSamples(kernels)) + "</pre>\n";
    out += "<h2>Whole frames</h2>\n" + imagePlot(scenes, device) + "<pre>" +
           escaped(imageTables(scenes, budgets)) + "</pre>\n";
    for (const ImageScene& scene : scenes)
        out += sceneSection(scene);
    return out + "</body></html>\n";
}

} // namespace candelabra::app
