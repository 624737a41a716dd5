// SPDX-License-Identifier: Apache-2.0
#include "measure/accuracy/page.h"

#include <algorithm>
#include <array>
#include <cmath>

#include <fmt/format.h>

#include "io/markup.h"
#include "io/table.h"
#include "render/setting_names.h"
#include "scene/light_types.h"

namespace candelabra::app
{
namespace
{

// Plots are drawn dark on white: inverted, with their hues turned back, they suit a dark page.
constexpr const char* style = R"(
:root { color-scheme: light dark; --text: #202020; --back: #ffffff; --soft: #f4f4f1;
        --line: #d0d0d0; --dim: #505050; --bar: #0072b2; }
@media (prefers-color-scheme: dark) {
  :root { --text: #e4e4e0; --back: #141414; --soft: #202124; --line: #44474d; --dim: #a8abb2;
          --bar: #56b4e9; }
  svg { filter: invert(0.92) hue-rotate(180deg); }
}
body { font: 15px/1.5 "DejaVu Sans", Helvetica, Arial, sans-serif; color: var(--text);
       background: var(--back); margin: 2em auto; max-width: 1200px; padding: 0 1em; }
pre { font: 12.5px/1.45 "DejaVu Sans Mono", Menlo, Consolas, monospace; background: var(--soft);
      padding: 1em; overflow-x: auto; }
figure { display: inline-block; margin: 0 10px 14px 0; vertical-align: top; width: 264px; }
figure img { width: 100%; image-rendering: pixelated; display: block; background: #000; }
figcaption, .made { font-size: 12.5px; color: var(--dim); }
code { font: 12.5px "DejaVu Sans Mono", Menlo, Consolas, monospace; }
svg { max-width: 100%; height: auto; }
h2 { margin-top: 2em; border-bottom: 1px solid var(--line); }
table { border-collapse: collapse; }
th, td { text-align: right; padding: 1px 12px 1px 0; }
th:first-child, td:first-child, td.bars { text-align: left; }
td.bars { width: 320px; }
.bar { background: var(--bar); height: 11px; }
.wipe { max-width: 960px; margin-bottom: 14px; }
.wipe .pictures { position: relative; }
.wipe img { width: 100%; display: block; image-rendering: pixelated; }
.wipe img.over { position: absolute; left: 0; top: 0; }
.wipe input { width: 100%; margin: 4px 0; }
)";

// Neither < nor ampersand: the page is XML as well.
constexpr const char* script = R"(
for (const w of document.querySelectorAll('.wipe')) {
  const [left, right] = w.querySelectorAll('select');
  const slider = w.querySelector('input');
  const show = () => {
    w.querySelector('.over').src = document.querySelector('#' + left.value + ' img').src;
    w.querySelector('.under').src = document.querySelector('#' + right.value + ' img').src;
    w.querySelector('.over').style.clipPath = 'inset(0 ' + (100 - slider.value) + '% 0 0)';
  };
  for (const input of [left, right, slider])
    input.addEventListener('input', show);
  w.hidden = false;
  show();
}
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
            table.add({fmt::format("{} ({}, {})", specularName(p.method), w.x, w.y),
                       threeDigits(w.value), threeDigits(w.truth),
                       w.truth > 0 ? threeDigits(w.value / w.truth) : "-"});
        }
    return table.text();
}

std::string sceneSection(const ImageScene& scene, size_t index)
{
    std::string figures;
    std::vector<WipeChoice> choices;
    for (const ImagePoint& p : scene.points) {
        const Displayed displayed = displayBoth(scene.truth, p.radiance);
        const std::string name = specularName(p.method);
        const auto idOf = [&](const std::string& what) {
            return fmt::format("scene{}-{}", index, what);
        };
        if (choices.empty()) {
            choices.push_back({idOf("truth"), "truth"});
            figures +=
                figure(displayed.truth, "truth: double-precision quadrature", choices.back().id) +
                "<br/>\n";
        }
        choices.push_back({idOf(name), name});
        figures += figure(displayed.value,
                          fmt::format("{}: {} ms, relMSE {:.1e}, lit mean {:.1e}, FLIP {:.4f}",
                                      name, threeDigits(p.time.lightingMs), p.error.relMse,
                                      p.error.litMeanRel, p.error.flip),
                          choices.back().id);
        choices.push_back({idOf(name + "-flip"), name + ": difference"});
        figures += figure(heatMap(flipMap(displayed.truth, displayed.value), displayed.truth.width,
                                  displayed.truth.height),
                          name + ": FLIP, 0 black to 0.5 yellow", choices.back().id);
    }
    return "<h3>" + escaped(scene.name) + "</h3>\n" + wipe(choices) + figures +
           "<h4>Worst pixels</h4>" + preformatted(worstPixelTable(scene));
}

std::string worstSamples(const KernelLevel& kernels)
{
    std::string out;
    for (const KernelPoint& p : kernels.points)
        out += fmt::format("{} {}: {}% at {}\n", lightTypeName(p.lightType), specularName(p.method),
                           threeDigits(100 * p.error.mirror.all.max), p.worst);
    return out;
}

} // namespace

std::string pageHead(const std::string& title)
{
    return fmt::format("<!DOCTYPE html>\n<html lang=\"en\"><head><meta charset=\"utf-8\"/>"
                       "<meta name=\"viewport\" content=\"width=device-width\"/>"
                       "<link rel=\"icon\" href=\"data:,\"/><title>{0}</title>"
                       "<style>{1}</style></head><body>\n<h1>{0}</h1>\n",
                       escaped(title), style);
}

std::string pageEnd()
{
    return fmt::format("<script>{}</script></body></html>\n", script);
}

std::string preformatted(const std::string& text)
{
    return "<pre>" + escaped(text) + "</pre>\n";
}

std::string madeBy(const std::string& command)
{
    return "<p class=\"made\">made by <code>" + escaped(command) + "</code></p>\n";
}

std::string figure(const DisplayImage& image, const std::string& caption, const std::string& id)
{
    std::vector<uint8_t> rgb;
    for (const glm::vec3& p : image.pixels)
        rgb.insert(rgb.end(), {byteOf(p.x), byteOf(p.y), byteOf(p.z)});
    const std::string named = id.empty() ? "" : fmt::format(" id=\"{}\"", escaped(id));
    return fmt::format("<figure{}><img alt=\"{}\" src=\"data:image/png;base64,{}\"/><figcaption>{}"
                       "</figcaption></figure>\n",
                       named, escaped(caption),
                       base64(encodePng("page", image.width, image.height, rgb)), escaped(caption));
}

std::string wipe(const std::vector<WipeChoice>& choices)
{
    const auto list = [&](size_t chosen, const char* side) {
        std::string out = fmt::format("<select aria-label=\"{}\">", side);
        for (size_t i = 0; i < choices.size(); ++i)
            out +=
                fmt::format("<option value=\"{}\"{}>{}</option>", escaped(choices[i].id),
                            i == chosen ? " selected=\"selected\"" : "", escaped(choices[i].name));
        return out + "</select>";
    };
    // Hidden until the script has filled it in.
    return "<div class=\"wipe\" hidden=\"hidden\"><div class=\"pictures\">"
           "<img class=\"under\" alt=\"right\"/><img class=\"over\" alt=\"left\"/></div>"
           "<input type=\"range\" min=\"0\" max=\"100\" value=\"50\" aria-label=\"slider\"/>" +
           list(0, "left") + " | " + list(choices.size() - 1, "right") + "</div>\n";
}

std::string accuracySections(const KernelLevel& kernels, const std::vector<ImageScene>& scenes,
                             const BudgetSweep& budgets, const DeviceInfo& device)
{
    std::string out = "<h2>Accuracy: one light at one pixel</h2>\n" + kernelPlot(kernels, device) +
                      preformatted(kernelTables(kernels)) + "<h3>Worst samples, F = 1</h3>" +
                      preformatted(worstSamples(kernels)) + "<h2>Accuracy: whole frames</h2>\n" +
                      imagePlot(scenes, device) + preformatted(imageTables(scenes, budgets));
    for (size_t i = 0; i < scenes.size(); ++i)
        out += sceneSection(scenes[i], i);
    return out;
}

std::string accuracyPage(const Json& provenance, const KernelLevel& kernels,
                         const std::vector<ImageScene>& scenes, const BudgetSweep& budgets,
                         const DeviceInfo& device)
{
    return pageHead("Candelabra: error against time") + preformatted(provenance.dump(2)) +
           accuracySections(kernels, scenes, budgets, device) + pageEnd();
}

} // namespace candelabra::app
