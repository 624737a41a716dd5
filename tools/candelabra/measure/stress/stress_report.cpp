// SPDX-License-Identifier: Apache-2.0
#include "measure/stress/stress_report.h"

#include <algorithm>
#include <map>

#include <fmt/format.h>

#include "io/svg_plot.h"
#include "io/table.h"

namespace candelabra::app
{
namespace
{

double meanListLength(const CndLightingStats& stats)
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

std::string pixelsText(const BruteCheck& check)
{
    if (!check.pixels || check.allPixels)
        return check.pixels ? "all" : "none";
    return grouped(check.pixels) + " in " + counted(check.rects, "tile");
}

std::string listTable(const std::vector<StressPoint>& points)
{
    Table table({"lights", "tiles", "lights per tile", "max", "pairs listed", "in influence",
                 "evaluated", "over budget"});
    for (const StressPoint& p : points)
        table.add({grouped(p.lights), grouped(p.stats.tileCount),
                   threeDigits(meanListLength(p.stats)), grouped(p.stats.maxListLength),
                   millions(p.stats.listedPairs), millions(p.stats.insidePairs),
                   millions(p.stats.contributingPairs), grouped(p.stats.unlistedClusters)});
    return table.text();
}

std::string checkTable(const std::vector<StressPoint>& points)
{
    Table table({"lights", "GPU ms per frame", "brute force ms", "pixels compared",
                 "max difference / max radiance", "two runs"});
    for (const StressPoint& p : points)
        table.add({grouped(p.lights), threeDigits(p.times.total().medianMs),
                   p.check.allPixels ? threeDigits(p.check.bruteMs) : "-", pixelsText(p.check),
                   checkText(p.check), p.identical ? "identical" : "DIFFERENT"});
    const bool all = std::all_of(points.begin(), points.end(), [](const StressPoint& p) {
        return p.check.allPixels || !p.check.pixels;
    });
    return table.text() + (all ? "" : "Tiles are a sample: --check full compares every pixel.\n");
}

// Passes that take at least this share of some total get a line of their own in the plot.
constexpr double visibleShare = 0.02;

std::vector<PlotSeries> plotSeries(const std::vector<StressPoint>& points)
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
    std::vector<PlotSeries> out{total, brute};
    PlotSeries others{.name = "all other passes", .points = {}};
    for (const std::string& name : order) {
        if (share[name] >= visibleShare) {
            out.push_back(byName[name]);
            continue;
        }
        for (const auto& [lights, ms] : byName[name].points) {
            const auto at = std::find_if(others.points.begin(), others.points.end(),
                                         [x = lights](const auto& q) { return q.first == x; });
            if (at == others.points.end())
                others.points.emplace_back(lights, ms);
            else
                at->second += ms;
        }
    }
    out.push_back(others);
    return out;
}

} // namespace

std::string stressTables(const std::vector<StressPoint>& points)
{
    std::string out;
    for (const StressPoint& p : points)
        out += fmt::format("{}, GPU time per pass over {}\n{}\n", counted(p.lights, "light"),
                           counted(p.times.frames(), "frame"), passTable(p.times));
    return out + "Lists and (pixel, light) pairs\n" + listTable(points) +
           "\nAgainst brute force, and between two runs\n" + checkTable(points);
}

Json stressJson(const StressSettings& settings, const std::vector<StressPoint>& points)
{
    Json list = Json::array();
    for (const StressPoint& p : points)
        list.push_back({{"lights", p.lights},
                        {"scene", p.scene},
                        {"gpuTime", toJson(p.times)},
                        {"lighting", toJson(p.stats)},
                        {"exposure", toJson(p.exposure)},
                        {"bruteForce",
                         {{"pixelsCompared", p.check.pixels},
                          {"allPixels", p.check.allPixels},
                          {"tilesSampled", p.check.allPixels ? 0 : p.check.rects},
                          {"maxDifferenceOverMaxRadiance", p.check.relative()},
                          {"bound", BruteCheck::bound},
                          {"shadingMs", p.check.bruteMs}}},
                        {"twoRunsIdentical", p.identical},
                        {"image", p.image}});
    Json frame = toJson(settings.frame, settings.gbufferLayout);
    frame.erase("camera"); // of the scene, not of the settings
    return {{"scene", settings.scene},
            {"seed", settings.sceneOptions.seed},
            {"widthPixels", settings.size.width},
            {"heightPixels", settings.size.height},
            {"warmUpFrames", settings.counts.warmUp},
            {"settings", frame},
            {"points", list}};
}

std::string stressPlot(const StressSettings& settings, const DeviceInfo& device,
                       const std::vector<StressPoint>& points)
{
    return logLogPlot(
        {.title = fmt::format("GPU time per frame against lights: {}, {}x{}", settings.scene,
                              settings.size.width, settings.size.height),
         .subtitle = fmt::format("{}; median of {}", device.name,
                                 counted(settings.counts.measured, "frame")),
         .xAxis = "sphere lights",
         .yAxis = "GPU time (ms)"},
        plotSeries(points));
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
        if (!p.identical)
            out.push_back(counted(p.lights, "light") + ": two runs gave different images");
    }
    return out;
}

} // namespace candelabra::app
