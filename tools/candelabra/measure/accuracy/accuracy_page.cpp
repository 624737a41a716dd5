// SPDX-License-Identifier: Apache-2.0
#include "measure/accuracy/accuracy_page.h"

#include <algorithm>
#include <array>

#include <fmt/format.h>

#include "io/html_page.h"
#include "io/markup.h"
#include "io/table.h"
#include "scene/light_types.h"

namespace candelabra::app
{
namespace
{

// The colour map "magma" (van der Walt and Smith 2015) in six steps from black over purple, red and
// orange to pale yellow.
glm::vec3 magma(float x)
{
    static const std::array<glm::vec3, 6> steps = {
        glm::vec3(0.001f, 0.000f, 0.014f), glm::vec3(0.232f, 0.060f, 0.438f),
        glm::vec3(0.550f, 0.161f, 0.506f), glm::vec3(0.868f, 0.288f, 0.409f),
        glm::vec3(0.995f, 0.624f, 0.427f), glm::vec3(0.987f, 0.991f, 0.750f)};
    const float at = std::clamp(x, 0.0f, 1.0f) * float(steps.size() - 1);
    const size_t i = std::min(size_t(at), steps.size() - 2);
    return glm::mix(steps[i], steps[i + 1], at - float(i));
}

// A picture of a FLIP map. The colours cover 0 to 0.5, because greater values are rare.
DisplayImage heatMap(const std::vector<float>& map, uint32_t width, uint32_t height)
{
    DisplayImage out{width, height, {}};
    for (const float x : map)
        out.pixels.push_back(magma(2 * x));
    return out;
}

Table worstPixelTable(const ImageScene& scene)
{
    Table table({{"method, pixel", "", "The method, and the column and row of the pixel."},
                 {"value", "cd/m^2", "What the method gives, in the channel that differs most."},
                 {"truth", "cd/m^2", "What the truth is in that channel."},
                 {"value / truth", "", "Their ratio."}},
                scene.name + ", the worst pixels of each method");
    for (const ImagePoint& p : scene.points)
        for (size_t k = 0; k < std::min<size_t>(p.error.worst.size(), 3); ++k) {
            const WorstPixel& w = p.error.worst[k];
            table.add({fmt::format("{} ({}, {})", methodName(p.method), w.x, w.y),
                       threeDigits(w.value), threeDigits(w.truth),
                       w.truth > 0 ? threeDigits(w.value / w.truth) : "-"});
        }
    return table;
}

std::string scenePictures(const ImageScene& scene, size_t index)
{
    std::vector<WipeChoice> choices;
    size_t karis = 0; // whose differences show: conic looks like the truth
    const auto add = [&](const std::string& what, const std::string& name,
                         const DisplayImage& image, const std::string& caption) {
        const std::string id = fmt::format("scene{}-{}", index, what);
        choices.push_back({id, name, figure(image, caption, id)});
    };
    for (const ImagePoint& p : scene.points) {
        const Displayed displayed = displayBoth(scene.truth, p.radiance);
        const std::string name = methodName(p.method);
        if (choices.empty())
            add("truth", "truth", displayed.truth, "truth: double-precision quadrature");
        if (p.method == CND_SPECULAR_KARIS)
            karis = choices.size();
        add(name, name, displayed.value,
            fmt::format("{}: {} ms by brute force, relMSE {}, lit mean {}, FLIP {:.4f}", name,
                        threeDigits(p.time.bruteForceMs), threeDigits(p.error.relMse),
                        threeDigits(p.error.litMeanRel), p.error.flip));
        add(name + "-flip", name + ": difference",
            heatMap(flipMap(displayed.truth, displayed.value), displayed.truth.width,
                    displayed.truth.height),
            name + ": FLIP, 0 black to 0.5 yellow");
    }
    return "<h3>" + escaped(scene.name) + "</h3>\n" +
           wipe(choices, 0, karis ? karis : choices.size() - 1);
}

Table worstSampleTable(const KernelLevel& kernels)
{
    Table table({{"light, method", "", "The type of the light, and the method that evaluates it."},
                 {"error", "%", "The largest error, in percent of the highest true response."},
                 Column::words("where", "The surface and the light that gave it.")},
                "Worst samples, F = 1");
    for (const KernelPoint& p : kernels.points)
        table.add({fmt::format("{} {}", lightTypeName(p.lightType), methodName(p.method)),
                   threeDigits(100 * p.error.mirror.all.max), p.worst});
    return table;
}

} // namespace

std::string accuracyPictures(const std::vector<ImageScene>& scenes)
{
    std::string out;
    for (size_t i = scenes.size(); i-- > 0;) // the last scene, the showcase, has every light type
        out += scenePictures(scenes[i], i);
    return out;
}

std::string accuracyPlots(const KernelLevel& kernels, const std::vector<ImageScene>& scenes,
                          const DeviceInfo& device)
{
    return plotBox(kernelPlot(kernels, device), "error against time of one light at one pixel") +
           plotBox(imagePlot(scenes, device), "error against time of whole images");
}

std::vector<Table> accuracyTables(const KernelLevel& kernels, const std::vector<ImageScene>& scenes)
{
    std::vector<Table> out = kernelTables(kernels);
    for (Table& table : imageTables(scenes))
        out.push_back(std::move(table));
    return out;
}

std::vector<Table> accuracyDetails(const KernelLevel& kernels,
                                   const std::vector<ImageScene>& scenes)
{
    std::vector<Table> out{worstSampleTable(kernels)};
    for (const ImageScene& scene : scenes)
        out.push_back(worstPixelTable(scene));
    return out;
}

} // namespace candelabra::app
