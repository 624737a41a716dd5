// SPDX-License-Identifier: Apache-2.0
#include "measure/culling/culling.h"

#include <algorithm>
#include <cmath>
#include <functional>
#include <limits>

#include <fmt/format.h>
#include <spdlog/spdlog.h>

#include "candelabra/candelabra.hpp"
#include "io/progress.h"
#include "io/svg_plot.h"
#include "load/load.h"
#include "measure/culling/baselines.h"
#include "measure/frame/brute_check.h"
#include "measure/frame/frames.h"
#include "render/camera.h"
#include "render/readback.h"
#include "render/setting_names.h"
#include "scene/scene_error.h"
#include "scene/scene_options.h"

namespace candelabra::app
{

namespace
{

// The (pixel, light) pairs of the strip from which the time of brute force is estimated.
constexpr double stripPairs = 2e8;

bool isShadingPass(const std::string& pass)
{
    return pass.starts_with("shade_") || pass == "baseline_shade" || pass == "baseline_floor" ||
           pass == "pair_visibility";
}

// Returns the passes but for the kernel that fills a table which shading reads: it runs in the
// first frame only.
std::vector<PassTime> lightingPasses(const CndLightingStats& stats)
{
    std::vector<PassTime> out = passesOf({stats.kernelTimes, stats.kernelTimeCount});
    std::erase_if(out, [](const PassTime& pass) { return pass.name == "dfg_table"; });
    return out;
}

double largestDifference(const Image& image, const Image& reference)
{
    float largest = 0, difference = 0;
    for (size_t i = 0; i < reference.pixels.size(); ++i) {
        largest = std::max(largest, std::abs(reference.pixels[i]));
        const float d = std::abs(image.pixels[i] - reference.pixels[i]);
        if (!std::isfinite(d))
            return std::numeric_limits<double>::infinity();
        difference = std::max(difference, d);
    }
    return largest > 0 ? double(difference) / double(largest) : 0;
}

// One configuration of scene and image size, ready to be lit in any way.
class Frame
{
public:
    Frame(const VulkanContext& context, const Scene& scene, PixelSize size, uint32_t shadows)
        : context_(context),
          scene_(scene),
          options_({.camera = selectCamera(scene, ""),
                    .lightsVisible = false,
                    .exposure = defaultExposureSettings()}),
          shadowed_(options_),
          renderer_(
              context, scene,
              {.size = size, .specularMethods = 1u << CND_SPECULAR_CONIC, .shadows = shadows}),
          baselines_(context, renderer_, scene, options_)
    {
        shadowed_.shadows = shadows;
        drawEngine(); // compiles kernels, fills tables, uploads lights
        drawEngine();
        image_ = readRadiance(context_, renderer_);
    }
    std::vector<PassTime> drawEngine() { return draw(options_); }
    std::vector<PassTime> drawShadowed() { return draw(shadowed_); }
    std::vector<PassTime> drawBaseline(Baseline b) { return baselines_.draw(b); }
    // The difference of the last frame drawn to the engine's image.
    double difference() const
    {
        return largestDifference(readRadiance(context_, renderer_), image_);
    }
    BruteCheck drawBrute()
    {
        const uint64_t lights = scene_.lights.size();
        return compareWithBruteForce(context_, renderer_, options_, image_,
                                     checkRects(renderer_.size(), lights, CheckExtent::Full),
                                     lights, [](double) {});
    }
    // Estimates the time of brute force in ms from a strip across the middle of the image.
    double estimateBrute()
    {
        const auto [width, height] = renderer_.size();
        const uint32_t rows = std::min(height, 8u);
        const double affordable = stripPairs / double(scene_.lights.size()) / rows;
        const uint32_t columns = std::min(width, std::max(uint32_t(affordable) / 64 * 64, 64u));
        const VkRect2D strip{{int32_t((width - columns) / 2), int32_t((height - rows) / 2)},
                             {columns, rows}};
        const auto once = [&] {
            context_.submitAndWait([&](VkCommandBuffer cmd) {
                renderer_.recordUnlit(cmd, options_);
                renderer_.recordBruteRect(cmd, options_, strip);
                renderer_.recordBruteEnd(cmd);
            });
            double ms = 0;
            for (const PassTime& pass : lightingPasses(renderer_.lightingStats(0)))
                ms += pass.name == "shade_brute" ? pass.ms : 0;
            return ms;
        };
        once(); // compiles the kernel
        return once() * double(width) * height / (double(columns) * rows);
    }
    CndLightingStats countPairs() { return app::countPairs(context_, renderer_, options_); }
    CndLightingStats countShadowedPairs()
    {
        return app::countPairs(context_, renderer_, shadowed_);
    }
    CullingStats statsOf(Baseline b) const { return baselines_.stats(b); }

private:
    std::vector<PassTime> draw(const FrameOptions& options)
    {
        context_.submitAndWait([&](VkCommandBuffer cmd) { renderer_.record(cmd, 0, options); });
        return lightingPasses(renderer_.lightingStats(0));
    }

    const VulkanContext& context_;
    const Scene& scene_;
    FrameOptions options_, shadowed_;
    Renderer renderer_;
    Baselines baselines_;
    Image image_;
};

CullingStats engineStats(const CndLightingStats& s)
{
    return {.listEntries = s.listEntries,
            // Lists take whole pages of memory, but the statistics count entries only.
            .listBytes = uint64_t(s.listEntries) * sizeof(uint32_t),
            .listedPairs = s.listedPairs,
            .evaluatedPairs = s.evaluatedPairs,
            .insidePairs = s.insidePairs,
            .contributingPairs = s.contributingPairs};
}

CullingPoint measurePoint(const VulkanContext& context, const CullingSettings& settings,
                          const Scene& scene, CullingPoint point,
                          const std::function<void()>& onRound)
{
    Frame frame(context, scene, point.size, settings.shadows);
    const CndLightingStats stats = frame.countPairs();
    point.tiles = stats.tileCount;
    point.splitTiles = stats.splitTileCount;
    point.unlistedClusters = stats.unlistedClusters;
    Contender engine{.name = engineName, .stats = engineStats(stats), .difference = 0};
    Contender tiles{.name = tilesName, .stats = frame.statsOf(Baseline::Tiles)};
    Contender froxels{.name = froxelsName, .stats = frame.statsOf(Baseline::Froxels)};
    Contender brute{.name = bruteName}, floor{.name = floorName}, shadowed{.name = shadowedName};
    if (settings.shadows) // which compiles the kernels
        shadowed.stats = engineStats(frame.countShadowedPairs());
    floor.stats.contributingPairs = floor.stats.listedPairs = tiles.stats.contributingPairs;
    const double estimate = frame.estimateBrute();
    if (estimate > 1e3 * settings.bruteLimit)
        brute.skippedMs = estimate;
    frame.drawBaseline(Baseline::Tiles); // compiles the kernels
    tiles.difference = frame.difference();
    frame.drawBaseline(Baseline::Froxels);
    froxels.difference = frame.difference();
    frame.drawBaseline(Baseline::Floor);

    std::vector<std::function<void()>> turns{
        [&] { engine.times.add(frame.drawEngine()); },
        [&] { tiles.times.add(frame.drawBaseline(Baseline::Tiles)); },
        [&] { froxels.times.add(frame.drawBaseline(Baseline::Froxels)); },
        [&] { floor.times.add(frame.drawBaseline(Baseline::Floor)); }};
    if (settings.shadows)
        turns.push_back([&] { shadowed.times.add(frame.drawShadowed()); });
    const size_t count = turns.size();
    for (uint32_t round = 0; round < settings.rounds; ++round) {
        for (size_t i = 0; i < count; ++i)
            turns[(round + i) % count](); // the first place goes around
        if (!brute.skippedMs && (round == 0 || estimate < settings.brutePatience)) {
            const BruteCheck check = frame.drawBrute();
            const PassTime pass{"shade_brute", check.bruteMs};
            brute.times.add({&pass, 1});
            brute.difference = check.relative();
        }
        onRound();
    }
    point.contenders = {engine, tiles, froxels, brute, floor};
    if (settings.shadows)
        point.contenders.push_back(shadowed);
    return point;
}

double share(double a, double b)
{
    return b > 0 ? a / b : 0;
}

} // namespace

double Contender::totalMs() const
{
    return times.total().medianMs;
}

double Contender::shadingMs() const
{
    double ms = 0;
    for (const PassSummary& pass : times.summary())
        ms += isShadingPass(pass.name) ? pass.medianMs : 0;
    return std::min(ms, totalMs());
}

double Contender::contributingPerListed() const
{
    return share(double(stats.contributingPairs), double(stats.listedPairs));
}

double Contender::contributingPerEvaluated() const
{
    return share(double(stats.contributingPairs), double(stats.evaluatedPairs));
}

bool Contender::hasRightImage() const
{
    return !difference || *difference <= (name == bruteName ? BruteCheck::bound : reorderedBound);
}

const Contender& CullingPoint::of(const std::string& name) const
{
    return *std::ranges::find(contenders, name, &Contender::name);
}

const Contender& CullingPoint::bestBaseline() const
{
    const Contender* best = &of(tilesName);
    for (const char* name : {froxelsName, bruteName}) {
        const Contender& c = of(name);
        if (!c.skippedMs && c.hasRightImage() &&
            (!best->hasRightImage() || c.totalMs() < best->totalMs()))
            best = &c;
    }
    return *best;
}

PairedRatio CullingPoint::toEngine(const std::string& name) const
{
    const std::vector<double>& engine = of(engineName).times.totals();
    const std::vector<double>& other = of(name).times.totals();
    if (other.size() == engine.size())
        return pairedRatio(engine, other);
    // A frame that was drawn only once has a ratio, but no interval.
    const double ratio = other.empty() ? 1 : medianOf(other) / medianOf(engine);
    return {ratio, 0, std::numeric_limits<double>::infinity()};
}

std::vector<CullingPoint> measureCulling(const VulkanContext& context,
                                         const CullingSettings& settings, bool showProgress)
{
    Progress progress(double(settings.scenes.size() * settings.sizes.size() *
                             settings.lights.size() * settings.overlaps.size()) *
                          settings.rounds,
                      showProgress);
    std::vector<CullingPoint> out;
    for (const std::string& name : settings.scenes)
        for (const uint32_t overlaps : settings.overlaps)
            for (const uint32_t lights : settings.lights) {
                progress.doing(fmt::format("{}, {} lights, {} overlaps", name, lights, overlaps));
                SceneOptions options{.lights = lights, .seed = settings.seed};
                options.overlaps = overlaps;
                std::optional<Scene> scene;
                try {
                    scene = loadScene(name, options);
                } catch (const SceneError& error) {
                    spdlog::warn("warning: left out: {}", error.what());
                    progress.advance(double(settings.rounds * settings.sizes.size()));
                    continue;
                }
                for (const PixelSize size : settings.sizes)
                    out.push_back(measurePoint(
                        context, settings, *scene,
                        {.scene = name, .size = size, .lights = lights, .overlaps = overlaps},
                        [&] { progress.advance(1); }));
            }
    return out;
}

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

// Groups the points by scene, size and overlaps, in the order in which these first appear.
std::vector<std::vector<CullingPoint>> sweepsOf(const std::vector<CullingPoint>& points)
{
    std::vector<std::vector<CullingPoint>> out;
    for (const CullingPoint& p : points) {
        const auto at = std::ranges::find_if(
            out, [&](const auto& sweep) { return titleOf(sweep.front()) == titleOf(p); });
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
    const bool lists = c.stats.listBytes > 0;
    table.add({fmt::format("{} {}", grouped(p.lights), c.name),
               drawn ? threeDigits(c.totalMs())
                     : fmt::format("skipped (about {})", threeDigits(*c.skippedMs)),
               orDash(drawn, threeDigits(c.cullingMs())), orDash(drawn, threeDigits(c.shadingMs())),
               orDash(lists, grouped(c.stats.listEntries)),
               orDash(lists, threeDigits(double(c.stats.listBytes) * 1e-6)),
               orDash(lists, millions(c.stats.listedPairs)),
               orDash(lists, millions(c.stats.evaluatedPairs)),
               orDash(c.stats.contributingPairs > 0, millions(c.stats.contributingPairs)),
               c.difference ? threeDigits(*c.difference) : "-"},
              {.noisy = drawn && isNoisy(c.times.totals())});
}

Table timeTable(const std::vector<CullingPoint>& sweep)
{
    Table table({"lights, way of culling",
                 {"GPU time", "ms"},
                 {"culling", "ms"},
                 {"shading", "ms"},
                 "list entries",
                 {"lists", "MB"},
                 {"listed", "million pairs"},
                 {"evaluated", "million pairs"},
                 {"contributing", "million pairs"},
                 {"difference", "of largest"}},
                titleOf(sweep.front()) + "; medians");
    double longest = 0; // ms, of the frames that were skipped
    for (const CullingPoint& p : sweep) {
        if (&p != &sweep.front())
            table.rule();
        for (const Contender& c : p.contenders) {
            addRow(table, p, c);
            longest = std::max(longest, c.skippedMs.value_or(0));
        }
    }
    if (longest > 0)
        table.note(fmt::format("Brute force was skipped where a frame of it was estimated to take "
                               "longer than --brute-limit allows; --brute-limit {:.0f} draws all.",
                               std::ceil(1.2e-3 * longest)));
    return table;
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

// The interval of the engine's time divided by that of another way in the same round, if there were
// enough rounds for one. `r` is the inverse ratio.
std::string inverseInterval(const PairedRatio& r)
{
    return r.isKnown() ? fmt::format("{:.2f} .. {:.2f}", 1 / r.high, 1 / r.low) : "-";
}

Table ratioTable(const std::vector<CullingPoint>& points)
{
    Table table({"configuration",
                 "time / best other",
                 "95% interval",
                 Column::words("which other"),
                 "time / floor",
                 {"culling / shading", "%"},
                 "contributing / listed",
                 "of that of tiles",
                 "contributing / evaluated"},
                "Candelabra against the others: quotients of the medians above");
    for (const CullingPoint& p : points) {
        const Ratios r = ratiosOf(p);
        table.add({p.title(), fmt::format("{:.2f}", r.toBest), inverseInterval(p.toEngine(r.best)),
                   r.best, fmt::format("{:.2f}", r.toFloor),
                   fmt::format("{:.1f}", 100 * r.cullingShare), fmt::format("{:.2f}", r.perListed),
                   fmt::format("{:.1f}", r.listedGain), fmt::format("{:.2f}", r.perEvaluated)},
                  {.noisy = isNoisy(p.of(engineName).times.totals()) ||
                            isNoisy(p.of(r.best).times.totals())});
    }
    return table;
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
                {"listEntries", c.stats.listEntries},
                {"listBytes", c.stats.listBytes},
                {"listedPairs", c.stats.listedPairs},
                {"evaluatedPairs", c.stats.evaluatedPairs},
                {"insidePairs", c.stats.insidePairs},
                {"contributingPairs", c.stats.contributingPairs}});
    if (c.difference)
        out["differenceOverLargest"] = *c.difference;
    return out;
}

} // namespace

std::string CullingPoint::title() const
{
    return fmt::format("{}, {}", titleOf(*this), counted(lights, "light"));
}

std::vector<Table> cullingTables(const std::vector<CullingPoint>& points)
{
    std::vector<Table> out;
    for (const auto& sweep : sweepsOf(points))
        out.push_back(timeTable(sweep));
    out.push_back(ratioTable(points));
    return out;
}

Json cullingJson(const CullingSettings& settings, const std::vector<CullingPoint>& points)
{
    Json list = Json::array();
    for (const CullingPoint& p : points) {
        Json contenders = Json::array();
        for (const Contender& c : p.contenders)
            contenders.push_back(contenderJson(c));
        const Ratios r = ratiosOf(p);
        const PairedRatio interval = p.toEngine(r.best);
        const Json unknown;
        list.push_back(
            {{"scene", p.scene},
             {"widthPixels", p.size.width},
             {"heightPixels", p.size.height},
             {"lights", p.lights},
             {"overlaps", p.overlaps},
             {"tiles", p.tiles},
             {"splitTiles", p.splitTiles},
             {"unlistedClusters", p.unlistedClusters},
             {"ratioToBestBaseline", r.toBest},
             {"ratioToBestBaselineLow", interval.isKnown() ? Json(1 / interval.high) : unknown},
             {"ratioToBestBaselineHigh", interval.isKnown() ? Json(1 / interval.low) : unknown},
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
            {"shadows", shadowsName(settings.shadows)},
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
