// SPDX-License-Identifier: Apache-2.0
#include "measure/frame/influence_check.h"

#include <algorithm>

#include <fmt/format.h>

#include "measure/frame/brute_check.h"
#include "reference/tone_map.h"
#include "render/readback.h"

namespace candelabra::app
{

InfluenceCheck checkInfluence(const VulkanContext& context, Renderer& renderer,
                              const FrameOptions& options, const FrameStats& last, uint64_t lights)
{
    InfluenceCheck out{.bound = options.influence.maxError, .cutBelow = last.lighting.cutBelow};
    const Image cut = readRadiance(context, renderer);
    out.bruteMs = compareWithBruteForce(context, renderer, options, cut,
                                        checkRects(renderer.size(), lights, CheckExtent::Full),
                                        lights, [](double) {})
                      .bruteMs;
    if (!lights)
        return out;
    const Image uncut = readRadiance(context, renderer);
    const auto shown = [&](const Image& image, size_t at, double(&encoded)[3]) {
        const glm::dvec3 exposed =
            double(last.exposure.exposure) *
            glm::dvec3(image.pixels[at], image.pixels[at + 1], image.pixels[at + 2]);
        const glm::dvec3 linear = reference::toneMap(options.exposure.toneMap, exposed);
        for (int c = 0; c < 3; ++c)
            encoded[c] = reference::srgbEncode(linear[c]);
    };
    double sum = 0;
    for (size_t at = 0; at < cut.pixels.size(); at += 3) {
        double a[3], b[3], error = 0;
        shown(cut, at, a);
        shown(uncut, at, b);
        for (int c = 0; c < 3; ++c)
            error = std::max(error, std::abs(a[c] - b[c]));
        out.largest = std::max(out.largest, error);
        sum += error;
    }
    out.mean = sum / double(std::max<size_t>(cut.pixels.size() / 3, 1));
    return out;
}

std::string influenceText(const InfluenceCheck& c)
{
    const std::string cut = c.cutBelow > 0
                                ? fmt::format("lights are cut below {:.3g} lx", c.cutBelow)
                                : "no light is cut";
    return fmt::format("{}; display error against all light: largest {:.3f}/255, mean {:.3f}/255 "
                       "(at most {:.3f}/255 asked for)\n",
                       cut, 255 * c.largest, 255 * c.mean, 255 * c.bound);
}

Json toJson(const InfluenceCheck& c)
{
    return {{"maxError", c.bound},
            {"largestError", c.largest},
            {"meanError", c.mean},
            {"cutBelowLux", c.cutBelow},
            {"bruteForceMs", c.bruteMs}};
}

} // namespace candelabra::app
