// SPDX-License-Identifier: Apache-2.0
#include "measure/stress/stress_point.h"

#include <cctype>
#include <cstring>
#include <filesystem>

#include <fmt/format.h>

#include "io/table.h"
#include "load/load.h"
#include "render/camera.h"
#include "render/readback.h"

namespace candelabra::app
{
namespace
{

// Measured on two cores at 1280x720; the bar needs no more than the order of magnitude.
constexpr double secondsPerFrame = 0.3;
constexpr double secondsPerPair = 1 / 250e6;
constexpr double secondsToBuild = 1;

double pairs(const std::vector<VkRect2D>& rects, uint32_t lights)
{
    double pixels = 0;
    for (const VkRect2D& r : rects)
        pixels += double(r.extent.width) * r.extent.height;
    return pixels * lights;
}

// A scene may be called anything.
std::string fileName(const std::string& sceneName)
{
    std::string out;
    for (const char c : sceneName)
        out += std::isalnum(static_cast<unsigned char>(c)) || c == '-' ? c : '_';
    return out.empty() ? "scene" : out.substr(0, 64);
}

struct Pictures {
    Image radiance;
    std::vector<uint8_t> display;
};

Pictures renderOnce(const VulkanContext& context, Renderer& renderer, const FrameOptions& frame)
{
    context.submitAndWait([&](VkCommandBuffer cmd) { renderer.record(cmd, 0, frame); });
    return {readRadiance(context, renderer), readDisplay(context, renderer)};
}

// Bits, not values: NaN equals itself here and 0 differs from -0.
bool sameBits(const Pictures& a, const Pictures& b)
{
    const auto equal = [](const auto& x, const auto& y) {
        return x.size() == y.size() && std::memcmp(x.data(), y.data(), x.size() * sizeof x[0]) == 0;
    };
    return equal(a.radiance.pixels, b.radiance.pixels) && equal(a.display, b.display);
}

} // namespace

double estimatedSeconds(const StressSettings& s, uint32_t lights)
{
    return 2 * secondsToBuild + secondsPerFrame * (s.counts.warmUp + s.counts.measured) +
           secondsPerPair * pairs(checkRects(s.size, lights, s.check), lights);
}

StressPoint measureStressPoint(const VulkanContext& context, const StressSettings& settings,
                               uint32_t lights, Progress& progress)
{
    const std::string label = counted(lights, "light");
    progress.doing(label + ": building");
    SceneOptions sceneOptions = settings.sceneOptions;
    sceneOptions.lights = lights;
    const Scene scene = loadScene(settings.scene, sceneOptions);
    FrameOptions frame = settings.frame;
    frame.camera = selectCamera(scene, settings.camera);
    frame.lightsVisible = settings.lightsVisible.value_or(scene.lightsVisible);
    const RendererOptions rendererOptions{.size = settings.size,
                                          .gbufferLayout = settings.gbufferLayout,
                                          .specularMethods = 1u << settings.frame.specular};
    Renderer renderer(context, scene, rendererOptions);
    progress.advance(secondsToBuild);

    StressPoint out{.lights = uint32_t(scene.lights.size()), .scene = sceneJson(scene, renderer)};
    progress.doing(label + ": timing");
    const MeasuredFrames frames =
        renderFrames(context, renderer, frame, settings.counts, !scene.lightMotions.empty(),
                     [&] { progress.advance(secondsPerFrame); });
    out.times = frames.times;
    out.exposure = frames.last.exposure;
    out.stats = countPairs(context, renderer, frame);

    progress.doing(label + ": two runs");
    const Pictures first = renderOnce(context, renderer, frame);
    out.image = (std::filesystem::path(settings.directory) /
                 fmt::format("{}_{}.png", fileName(scene.name), out.lights))
                    .string();
    savePng(out.image, settings.size.width, settings.size.height, first.display);
    Renderer second(context, scene, rendererOptions);
    out.identical = sameBits(first, renderOnce(context, second, frame));
    progress.advance(secondsToBuild);

    progress.doing(label + ": brute force");
    // Without the emitters themselves, whose luminance would make any difference look small.
    frame.lightsVisible = false;
    const Pictures unlit = renderOnce(context, renderer, frame);
    out.check =
        compareWithBruteForce(context, renderer, frame, unlit.radiance,
                              checkRects(settings.size, out.lights, settings.check), out.lights,
                              [&](double n) { progress.advance(n * secondsPerPair); });
    return out;
}

} // namespace candelabra::app
