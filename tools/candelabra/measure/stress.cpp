// SPDX-License-Identifier: Apache-2.0
#include "measure/stress.h"

#include <algorithm>
#include <cctype>
#include <cstring>
#include <filesystem>
#include <map>

#include <fmt/format.h>

#include "io/statistics.h"
#include "io/svg_plot.h"
#include "io/table.h"
#include "load/load.h"
#include "render/camera.h"
#include "render/readback.h"

namespace candelabra::app
{

namespace
{

// These were measured on two cores at 1280x720. The progress bar needs their order of magnitude
// only.
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

// Makes a file name of a scene's name, which may hold any characters.
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

// Compares bits, not values: NaN equals itself, and 0 differs from -0.
bool sameBits(const Pictures& a, const Pictures& b)
{
    const auto equal = [](const auto& x, const auto& y) {
        return x.size() == y.size() && std::memcmp(x.data(), y.data(), x.size() * sizeof x[0]) == 0;
    };
    return equal(a.radiance.pixels, b.radiance.pixels) && equal(a.display, b.display);
}

// The fewest frames that are measured in a search, and the ratio of times from which they suffice.
constexpr uint32_t fewestFrames = 5;
constexpr double farRatio = 1.5;

// Renders the frames to measure.
MeasuredFrames timeFrames(const VulkanContext& context, Renderer& renderer,
                          const FrameOptions& frame, const StressSettings& settings, bool moving,
                          Progress& progress)
{
    const auto onFrame = [&] { progress.advance(secondsPerFrame); };
    FrameCounts counts = settings.counts;
    if (settings.frameMs && counts.measured > fewestFrames) {
        counts.measured = fewestFrames;
        MeasuredFrames few = renderFrames(context, renderer, frame, counts, moving, onFrame);
        const double ratio = few.times.total().medianMs / *settings.frameMs;
        if (ratio > farRatio || ratio < 1 / farRatio)
            return few;
        counts = settings.counts;
        counts.warmUpSeconds = 0; // they were drawn
    }
    return renderFrames(context, renderer, frame, counts, moving, onFrame);
}

} // namespace

FrameCost StressPoint::cost() const
{
    return {.lights = asked,
            .ms = times.total().medianMs,
            .lightingMs = times.medianMs(FramePart::Lighting),
            .rasterMs = times.medianMs(FramePart::Raster),
            .lightsPerPixel = double(stats.contributingPairs) / size.width / size.height};
}

double estimatedSeconds(const StressSettings& s, uint32_t lights)
{
    if (s.frameMs)
        return 2 * secondsToBuild + s.counts.warmUpSeconds +
               1e-3 * *s.frameMs * (s.counts.warmUp + s.counts.measured);
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
                                          .specularMethods = 1u << settings.frame.specular,
                                          .shadows = settings.frame.shadows};
    Renderer renderer(context, scene, rendererOptions);
    progress.advance(secondsToBuild);

    StressPoint out{.lights = uint32_t(scene.lights.size()),
                    .asked = lights,
                    .size = settings.size,
                    .scene = sceneJson(scene, renderer)};
    progress.doing(label + ": timing");
    const MeasuredFrames frames =
        timeFrames(context, renderer, frame, settings, !scene.lightMotions.empty(), progress);
    out.times = frames.times;
    out.exposure = frames.last.exposure;
    out.stats = countPairs(context, renderer, frame);
    if (settings.frameMs) {
        progress.advance(secondsToBuild);
        return out;
    }

    progress.doing(label + ": picture");
    const Pictures first = renderOnce(context, renderer, frame);
    out.image = (std::filesystem::path(settings.directory) /
                 fmt::format("{}_{}.png", fileName(scene.name), out.lights))
                    .string();
    savePng(out.image, settings.size.width, settings.size.height, first.display);
    if (settings.check == CheckExtent::None) {
        progress.advance(secondsToBuild);
        return out;
    }
    progress.doing(label + ": second run");
    Renderer second(context, scene, rendererOptions);
    out.identical = sameBits(first, renderOnce(context, second, frame));
    progress.advance(secondsToBuild);

    progress.doing(label + ": brute force");
    // The emitters are not drawn, because their luminance would make any difference look small.
    frame.lightsVisible = false;
    const Pictures unlit = renderOnce(context, renderer, frame);
    out.check =
        compareWithBruteForce(context, renderer, frame, unlit.radiance,
                              checkRects(settings.size, out.lights, settings.check), out.lights,
                              [&](double n) { progress.advance(n * secondsPerPair); });
    return out;
}

namespace
{

double entriesPerTile(const CndLightingStats& stats)
{
    return double(stats.listEntries) / std::max(stats.tileCount, 1u);
}

std::string millions(uint64_t count)
{
    return threeDigits(double(count) * 1e-6) + " M";
}

std::string checkText(const BruteCheck& check)
{
    return check.pixels ? fmt::format("{:.1e}", check.relative()) : "not checked";
}

const char* identityText(const std::optional<bool>& identical)
{
    return !identical ? "not compared" : *identical ? "identical" : "DIFFERENT";
}

std::string pixelsText(const BruteCheck& check)
{
    if (!check.pixels || check.allPixels)
        return check.pixels ? "all" : "none";
    return grouped(check.pixels) + " in " + counted(check.rects, "tile");
}

std::string listTable(const std::vector<StressPoint>& points)
{
    Table table({"lights", "tiles", "entries per tile", "longest list", "pairs listed",
                 "in influence", "contributing", "without list"});
    for (const StressPoint& p : points)
        table.add({grouped(p.lights), grouped(p.stats.tileCount),
                   threeDigits(entriesPerTile(p.stats)), grouped(p.stats.maxListLength),
                   millions(p.stats.listedPairs), millions(p.stats.insidePairs),
                   millions(p.stats.contributingPairs), grouped(p.stats.unlistedClusters)});
    return table.text() +
           "Entries per tile add up the lists of a tile: one for every type of light and, in deep "
           "tiles, every slice of depth.\nClusters without a list walk the light tree instead.\n";
}

std::string shadowLines(const std::vector<StressPoint>& points)
{
    std::string out;
    for (const StressPoint& p : points)
        if (const std::string line = shadowText(p.stats, p.size); !line.empty())
            out += counted(p.lights, "light") + ": " + line;
    return out;
}

std::string checkTable(const std::vector<StressPoint>& points)
{
    Table table({"lights", "GPU ms per frame", "brute force ms", "pixels compared",
                 "max difference / max radiance", "two runs"});
    for (const StressPoint& p : points)
        table.add({grouped(p.lights), threeDigits(p.times.total().medianMs),
                   p.check.allPixels ? threeDigits(p.check.bruteMs) : "-", pixelsText(p.check),
                   checkText(p.check), identityText(p.identical)});
    const bool all = std::ranges::all_of(
        points, [](const StressPoint& p) { return p.check.allPixels || !p.check.pixels; });
    return table.text() + (all ? "" : "Tiles are a sample: --check full compares every pixel.\n");
}

// A pass gets a line of its own in the plot if it takes at least this share of the total at some
// point.
constexpr double visibleShare = 0.02;

// A line at the time of a frame: the one that is searched for, or else that of 60 frames/s if the
// total time crosses it.
std::optional<PlotSeries> frameLine(const StressSettings& settings, const PlotSeries& total)
{
    const auto [least, most] =
        std::ranges::minmax_element(total.points, {}, &std::pair<double, double>::second);
    const double ms = settings.frameMs.value_or(1000.0 / 60);
    if (!settings.frameMs && (ms < least->second || ms > most->second))
        return {};
    const auto [fewest, greatest] = std::ranges::minmax_element(total.points);
    return PlotSeries{.name = fmt::format("{:g} frames/s", 1000 / ms),
                      .points = {{fewest->first, ms}, {greatest->first, ms}},
                      .marked = false};
}

std::vector<PlotSeries> plotSeries(const StressSettings& settings,
                                   const std::vector<StressPoint>& points)
{
    std::vector<std::string> order;
    std::map<std::string, PlotSeries> byName;
    std::map<std::string, double> share;
    PlotSeries total{.name = "total", .points = {}, .emphasised = true};
    PlotSeries brute{.name = "brute-force shading", .points = {}};
    for (const StressPoint& p : points) {
        const double sum = p.times.total().medianMs;
        total.points.emplace_back(p.lights, sum);
        if (p.check.allPixels)
            brute.points.emplace_back(p.lights, p.check.bruteMs);
        for (const PassSummary& pass : p.times.summary()) {
            if (!byName.count(pass.name))
                order.push_back(pass.name);
            byName[pass.name].name = pass.name;
            byName[pass.name].points.emplace_back(p.lights, pass.medianMs);
            share[pass.name] = std::max(share[pass.name], sum > 0 ? pass.medianMs / sum : 0);
        }
    }
    std::vector<PlotSeries> out{total};
    if (brute.points.size() > 1) // one point is no line
        out.push_back(brute);
    PlotSeries others{.name = "all other passes", .points = {}};
    for (const std::string& name : order) {
        if (share[name] >= visibleShare) {
            out.push_back(byName[name]);
            continue;
        }
        for (const auto& [lights, ms] : byName[name].points) {
            const auto at = std::ranges::find_if(
                others.points, [x = lights](const auto& q) { return q.first == x; });
            if (at == others.points.end())
                others.points.emplace_back(lights, ms);
            else
                at->second += ms;
        }
    }
    out.push_back(others);
    if (const auto line = frameLine(settings, total))
        out.push_back(*line);
    return out;
}

} // namespace

std::string searchTable(const std::vector<StressPoint>& points)
{
    Table table(
        {"lights", "frames", "GPU ms per frame", "lighting ms", "raster pass ms", "rest ms"});
    for (const StressPoint& p : points) {
        const FrameCost c = p.cost();
        table.add({grouped(c.lights), grouped(p.times.frames()), threeDigits(c.ms),
                   threeDigits(c.lightingMs), threeDigits(c.rasterMs), threeDigits(c.restMs())},
                  {.noisy = isNoisy(p.times.totals())});
    }
    return table.text();
}

std::string stressTables(const std::vector<StressPoint>& points)
{
    std::string out;
    for (const StressPoint& p : points)
        out += fmt::format("{}, GPU time per pass over {}\n{}\n", counted(p.lights, "light"),
                           counted(p.times.frames(), "frame"), passTable(p.times));
    return out + "Lists and (pixel, light) pairs\n" + listTable(points) + shadowLines(points) +
           "\nAgainst brute force, and between two runs\n" + checkTable(points);
}

Json stressJson(const StressSettings& settings, const std::vector<StressPoint>& points)
{
    Json list = Json::array();
    for (const StressPoint& p : points)
        list.push_back({{"lights", p.lights},
                        {"scene", p.scene},
                        {"gpuTime", toJson(p.times)},
                        {"lightingMs", p.times.medianMs(FramePart::Lighting)},
                        {"rasterMs", p.times.medianMs(FramePart::Raster)},
                        {"lighting", toJson(p.stats)},
                        {"exposure", toJson(p.exposure)},
                        {"bruteForce",
                         {{"pixelsCompared", p.check.pixels},
                          {"allPixels", p.check.allPixels},
                          {"tilesSampled", p.check.allPixels ? 0 : p.check.rects},
                          {"maxDifferenceOverMaxRadiance", p.check.relative()},
                          {"bound", BruteCheck::bound},
                          {"shadingMs", p.check.bruteMs}}},
                        {"twoRunsIdentical", p.identical ? Json(*p.identical) : Json()},
                        {"image", p.image.empty() ? Json() : Json(p.image)}});
    Json frame = toJson(settings.frame, settings.gbufferLayout);
    frame.erase("camera"); // it belongs to the scene, not to the settings
    return {{"scene", settings.scene},
            {"seed", settings.sceneOptions.seed},
            {"widthPixels", settings.size.width},
            {"heightPixels", settings.size.height},
            {"warmUpFrames", settings.counts.warmUp},
            {"warmUpSeconds", settings.counts.warmUpSeconds},
            {"settings", frame},
            {"points", list}};
}

std::string stressPlot(const StressSettings& settings, const DeviceInfo& device,
                       const std::vector<StressPoint>& points)
{
    const auto [least, most] = std::ranges::minmax_element(
        points, {}, [](const StressPoint& p) { return p.times.frames(); });
    const std::string frames = least->times.frames() == most->times.frames()
                                   ? counted(most->times.frames(), "frame")
                                   : fmt::format("{} to {}", least->times.frames(),
                                                 counted(most->times.frames(), "frame"));
    return logLogPlot(
        {.title = fmt::format("GPU time per frame against lights: {}, {}x{}", settings.scene,
                              settings.size.width, settings.size.height),
         .subtitle = fmt::format("{}; median of {}", device.name, frames),
         .xAxis = "sphere lights",
         .yAxis = "GPU time (ms)"},
        plotSeries(settings, points));
}

std::vector<std::string> failedChecks(const std::vector<StressPoint>& points)
{
    std::vector<std::string> out;
    for (const StressPoint& p : points) {
        if (!p.check.passed())
            out.push_back(fmt::format("{}: clustered and brute-force radiance differ by "
                                      "{:.2e} of the maximum, the bound is {:.0e}",
                                      counted(p.lights, "light"), p.check.relative(),
                                      BruteCheck::bound));
        if (p.identical == false)
            out.push_back(counted(p.lights, "light") + ": two runs gave different images");
    }
    return out;
}

} // namespace candelabra::app
