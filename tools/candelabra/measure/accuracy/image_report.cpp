// SPDX-License-Identifier: Apache-2.0
// What image_level.h measured, for people, programs and eyes.
#include <fmt/format.h>

#include "io/svg_plot.h"
#include "io/table.h"
#include "measure/accuracy/image_level.h"
#include "measure/kernels/light_kernels.h"
#include "render/setting_names.h"

namespace candelabra::app
{
namespace
{

std::string budgetTable(const BudgetSweep& sweep)
{
    Table table({"method, budget", "lighting ms", "/ karis", "/ full", "shading ms",
                 "mean error to full", "p99", "max / peak"});
    for (const BudgetPoint& p : sweep.points)
        table.add({fmt::format("{} {:.2g}%", specularName(p.method), 100 * p.budget),
                   threeDigits(p.time.lightingMs), fmt::format("{:.2f}", p.time.ratio),
                   fmt::format("{:.2f}", p.ratioToFull), threeDigits(p.time.shadingMs),
                   fmt::format("{:.1e}", p.meanRel), fmt::format("{:.1e}", p.p99Rel),
                   fmt::format("{:.1e}", p.maxOverPeak)});
    return table.text();
}

Json toJson(const FrameTime& t)
{
    return {{"lightingMs", t.lightingMs}, {"shadingMs", t.shadingMs}, {"ratioToKaris", t.ratio}};
}

} // namespace

std::string imageTables(const std::vector<ImageScene>& scenes, const BudgetSweep& budgets)
{
    std::string out;
    for (const ImageScene& scene : scenes) {
        Table table({"method", "lighting ms", "/ karis", "relMSE", "lit relMSE", "lit mean",
                     "max / peak", "energy", "FLIP"});
        for (const ImagePoint& p : scene.points)
            table.add({specularName(p.method), threeDigits(p.time.lightingMs),
                       fmt::format("{:.2f}", p.time.ratio), fmt::format("{:.1e}", p.error.relMse),
                       fmt::format("{:.1e}", p.error.litRelMse),
                       fmt::format("{:.1e}", p.error.litMeanRel),
                       fmt::format("{:.1e}", p.error.maxOverPeak),
                       fmt::format("{:+.1e}", p.error.energy),
                       fmt::format("{:.4f}", p.error.flip)});
        out += scene.name + ", error to truth\n" + table.text() + "\n";
    }
    return out +
           fmt::format("Error budgets: {}, {}, {}x{}\n", budgets.scene,
                       counted(budgets.lights, "light"), budgets.size.width, budgets.size.height) +
           budgetTable(budgets);
}

Json imageJson(const ImageLevelSettings& s, const std::vector<ImageScene>& scenes,
               const BudgetSweep& budgets)
{
    Json list = Json::array();
    for (const ImageScene& scene : scenes) {
        Json points = Json::array();
        for (const ImagePoint& p : scene.points)
            points.push_back({{"method", specularName(p.method)},
                              {"time", toJson(p.time)},
                              {"error", toJson(p.error)}});
        list.push_back(
            {{"name", scene.name}, {"unconvergedTruths", scene.unconverged}, {"points", points}});
    }
    Json sweep = Json::array();
    for (const BudgetPoint& p : budgets.points)
        sweep.push_back({{"method", specularName(p.method)},
                         {"budget", p.budget},
                         {"time", toJson(p.time)},
                         {"ratioToFull", p.ratioToFull},
                         {"meanRel", p.meanRel},
                         {"p99Rel", p.p99Rel},
                         {"maxOverPeak", p.maxOverPeak}});
    return {{"widthPixels", s.size.width},
            {"heightPixels", s.size.height},
            {"rounds", s.rounds},
            {"truthTolerance", s.truthTolerance},
            {"scenes", list},
            {"errorBudget",
             {{"scene", budgets.scene},
              {"lights", budgets.lights},
              {"widthPixels", budgets.size.width},
              {"heightPixels", budgets.size.height},
              {"points", sweep}}}};
}

std::string imagePlot(const std::vector<ImageScene>& scenes, const DeviceInfo& device)
{
    std::vector<PlotSeries> series;
    for (const ImageScene& scene : scenes)
        for (size_t i = 0; i < scene.points.size(); ++i) {
            if (series.size() <= i)
                series.push_back({.name = specularName(scene.points[i].method),
                                  .points = {},
                                  .emphasised = scene.points[i].method == CND_SPECULAR_CONIC,
                                  .connected = false});
            series[i].points.emplace_back(scene.points[i].time.shadingMs,
                                          scene.points[i].error.relMse);
        }
    return logLogPlot({.title = "Image error against time, one point per scene",
                       .subtitle = device.name,
                       .xAxis = "GPU time of shading (ms)",
                       .yAxis = "relMSE to truth"},
                      series);
}

} // namespace candelabra::app
