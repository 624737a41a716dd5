// SPDX-License-Identifier: Apache-2.0
// What culling.h measured, for people, programs and eyes.
#include <algorithm>

#include <fmt/format.h>

#include "io/svg_plot.h"
#include "io/table.h"
#include "measure/culling/culling.h"

namespace candelabra::app
{
namespace
{

std::string millions(uint64_t count)
{
    return threeDigits(double(count) * 1e-6);
}

std::string orDash(bool known, const std::string& text)
{
    return known ? text : "-";
}

std::string titleOf(const CullingPoint& p)
{
    return fmt::format("{}, {}x{}, {} overlaps", p.scene, p.size.width, p.size.height, p.overlaps);
}

bool sameSweep(const CullingPoint& a, const CullingPoint& b)
{
    return titleOf(a) == titleOf(b);
}

// Points of one scene, size and overlaps together, in order of first appearance.
std::vector<std::vector<CullingPoint>> sweepsOf(const std::vector<CullingPoint>& points)
{
    std::vector<std::vector<CullingPoint>> out;
    for (const CullingPoint& p : points) {
        const auto at = std::find_if(
            out.begin(), out.end(), [&](const auto& sweep) { return sameSweep(sweep.front(), p); });
        if (at == out.end())
            out.push_back({p});
        else
            at->push_back(p);
    }
    return out;
}

void addRow(Table& table, const CullingPoint& p, const Contender& c)
{
    const bool drawn = !c.skippedMs;
    const bool lists = c.listBytes > 0;
    table.add({fmt::format("{} {}", grouped(p.lights), c.name),
               drawn ? threeDigits(c.totalMs())
                     : fmt::format("skipped (about {})", threeDigits(*c.skippedMs)),
               orDash(drawn, threeDigits(c.cullingMs())), orDash(drawn, threeDigits(c.shadingMs())),
               orDash(lists, grouped(c.listEntries)),
               orDash(lists, threeDigits(double(c.listBytes) * 1e-6)),
               orDash(lists, millions(c.listedPairs)), orDash(lists, millions(c.evaluatedPairs)),
               orDash(c.contributingPairs > 0, millions(c.contributingPairs)),
               c.difference ? fmt::format("{:.0e}", *c.difference) : "-"});
}

std::string timeTable(const std::vector<CullingPoint>& sweep)
{
    Table table({"lights", "GPU ms", "culling", "shading", "list entries", "MB", "M pairs listed",
                 "evaluated", "contributing", "difference"});
    for (const CullingPoint& p : sweep) {
        if (&p != &sweep.front())
            table.rule();
        for (const Contender& c : p.contenders)
            addRow(table, p, c);
    }
    return table.text();
}

double share(double a, double b)
{
    return b > 0 ? a / b : 0;
}

struct Ratios {
    double toBest, toFloor, cullingShare, perListed, perEvaluated, listedGain;
    std::string best;
};

Ratios ratiosOf(const CullingPoint& p)
{
    const Contender& engine = p.of(engineName);
    const Contender& best = p.bestBaseline();
    return {.toBest = share(engine.totalMs(), best.totalMs()),
            .toFloor = share(engine.totalMs(), p.of(floorName).totalMs()),
            .cullingShare = share(engine.cullingMs(), engine.shadingMs()),
            .perListed = engine.contributingPerListed(),
            .perEvaluated = engine.contributingPerEvaluated(),
            .listedGain =
                share(engine.contributingPerListed(), p.of(tilesName).contributingPerListed()),
            .best = best.name};
}

std::string ratioTable(const std::vector<CullingPoint>& points)
{
    Table table({"candelabra", "/ best other", "which", "/ floor", "culling / shading",
                 "contributing / listed", "of that of tiles", "contributing / evaluated"});
    for (const CullingPoint& p : points) {
        const Ratios r = ratiosOf(p);
        table.add({fmt::format("{}, {}", titleOf(p), counted(p.lights, "light")),
                   fmt::format("{:.2f}", r.toBest), r.best, fmt::format("{:.2f}", r.toFloor),
                   fmt::format("{:.1f}%", 100 * r.cullingShare), fmt::format("{:.2f}", r.perListed),
                   fmt::format("{:.1f}", r.listedGain), fmt::format("{:.2f}", r.perEvaluated)});
    }
    return table.text();
}

Json passesJson(const PassTimes& times)
{
    Json out = Json::array();
    for (const PassSummary& pass : times.summary())
        out.push_back({{"name", pass.name}, {"minMs", pass.minMs}, {"medianMs", pass.medianMs}});
    return out;
}

Json contenderJson(const Contender& c)
{
    Json out{{"name", c.name}};
    if (c.skippedMs) {
        out["skipped"] = true;
        out["estimatedMs"] = *c.skippedMs;
        return out;
    }
    out.update({{"frames", c.times.frames()},
                {"medianMs", c.totalMs()},
                {"minMs", c.times.total().minMs},
                {"cullingMs", c.cullingMs()},
                {"shadingMs", c.shadingMs()},
                {"passes", passesJson(c.times)},
                {"listEntries", c.listEntries},
                {"listBytes", c.listBytes},
                {"listedPairs", c.listedPairs},
                {"evaluatedPairs", c.evaluatedPairs},
                {"insidePairs", c.insidePairs},
                {"contributingPairs", c.contributingPairs}});
    if (c.difference)
        out["differenceOverLargest"] = *c.difference;
    return out;
}

} // namespace

std::string cullingTables(const std::vector<CullingPoint>& points)
{
    std::string out;
    for (const auto& sweep : sweepsOf(points))
        out += titleOf(sweep.front()) + "; medians\n" + timeTable(sweep) + "\n";
    return out + "Candelabra against the others\n" + ratioTable(points);
}

Json cullingJson(const CullingSettings& settings, const std::vector<CullingPoint>& points)
{
    Json list = Json::array();
    for (const CullingPoint& p : points) {
        Json contenders = Json::array();
        for (const Contender& c : p.contenders)
            contenders.push_back(contenderJson(c));
        const Ratios r = ratiosOf(p);
        list.push_back({{"scene", p.scene},
                        {"widthPixels", p.size.width},
                        {"heightPixels", p.size.height},
                        {"lights", p.lights},
                        {"overlaps", p.overlaps},
                        {"tiles", p.tiles},
                        {"splitTiles", p.splitTiles},
                        {"unlistedClusters", p.unlistedClusters},
                        {"ratioToBestBaseline", r.toBest},
                        {"bestBaseline", r.best},
                        {"ratioToFloor", r.toFloor},
                        {"cullingOverShading", r.cullingShare},
                        {"contributingOverListed", r.perListed},
                        {"contributingOverEvaluated", r.perEvaluated},
                        {"contributingOverListedToTiles", r.listedGain},
                        {"contenders", contenders}});
    }
    return {{"rounds", settings.rounds},
            {"seed", settings.seed},
            {"specular", "conic"},
            {"bruteLimitSeconds", settings.bruteLimit},
            {"bound", Contender::reorderedBound},
            {"points", list}};
}

std::vector<CullingPlot> cullingPlots(const std::vector<CullingPoint>& points,
                                      const DeviceInfo& device)
{
    std::vector<CullingPlot> out;
    for (const auto& sweep : sweepsOf(points)) {
        std::vector<PlotSeries> series;
        for (const char* name : {engineName, tilesName, froxelsName, bruteName, floorName}) {
            PlotSeries line{.name = name, .points = {}, .emphasised = name == engineName};
            for (const CullingPoint& p : sweep)
                if (!p.of(name).skippedMs)
                    line.points.emplace_back(p.lights, p.of(name).totalMs());
            series.push_back(line);
        }
        PlotSeries culling{.name = "candelabra, culling alone", .points = {}};
        for (const CullingPoint& p : sweep)
            culling.points.emplace_back(p.lights, p.of(engineName).cullingMs());
        series.push_back(culling);
        const CullingPoint& p = sweep.front();
        out.push_back({fmt::format("bench_culling_{}_{}x{}_{}", p.scene, p.size.width,
                                   p.size.height, p.overlaps),
                       logLogPlot({.title = "Lighting time against lights: " + titleOf(p),
                                   .subtitle = device.name,
                                   .xAxis = "sphere lights",
                                   .yAxis = "GPU time (ms)"},
                                  series)});
    }
    return out;
}

std::vector<std::string> cullingFailures(const std::vector<CullingPoint>& points)
{
    std::vector<std::string> out;
    for (const CullingPoint& p : points)
        for (const Contender& c : p.contenders)
            if (!c.hasRightImage())
                out.push_back(fmt::format(
                    "{}, {}: {} and candelabra differ by {:.1e} of the largest radiance",
                    titleOf(p), counted(p.lights, "light"), c.name, *c.difference));
    return out;
}

} // namespace candelabra::app
