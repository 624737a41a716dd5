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

// A picture of a FLIP map. The colours cover 0 to 0.5, because greater values are rare.
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

std::string sceneSection(const ImageScene& scene, size_t index)
{
    std::string figures;
    std::vector<WipeChoice> choices;
    for (const ImagePoint& p : scene.points) {
        const Displayed displayed = displayBoth(scene.truth, p.radiance);
        const std::string name = methodName(p.method);
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
                          fmt::format("{}: {} ms by brute force, relMSE {:.1e}, lit mean {:.1e}, "
                                      "FLIP {:.4f}",
                                      name, threeDigits(p.time.bruteForceMs), p.error.relMse,
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
        out += fmt::format("{} {}: {}% at {}\n", lightTypeName(p.lightType), methodName(p.method),
                           threeDigits(100 * p.error.mirror.all.max), p.worst);
    return out;
}

} // namespace

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
