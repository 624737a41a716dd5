// SPDX-License-Identifier: Apache-2.0
// What kernel_level.h measured, for people, programs and eyes.
#include <fmt/format.h>

#include "io/svg_plot.h"
#include "io/table.h"
#include "measure/accuracy/kernel_level.h"
#include "render/setting_names.h"
#include "scene/light_types.h"

namespace candelabra::app
{
namespace
{

std::string percent(double share)
{
    return threeDigits(100 * share);
}

std::string meanP99Max(const ErrorStatistics& s)
{
    return s.count ? fmt::format("{} / {} / {}", percent(s.mean), percent(s.p99), percent(s.max))
                   : "-";
}

const KernelPoint::Class* classOf(const KernelPoint& p, EvaluationClass c)
{
    for (const KernelPoint::Class& entry : p.classes)
        if (entry.evaluationClass == c)
            return &entry;
    return nullptr;
}

// Where the cost of a light well above the horizon is found.
const KernelPoint::Class* mainClass(const KernelPoint& p)
{
    const KernelPoint::Class* above = classOf(p, EvaluationClass::Above);
    return above ? above : classOf(p, EvaluationClass::General);
}

std::string errorTable(const KernelLevel& level)
{
    Table table({"light, method", "all: mean / p99 / max", "above", "crossing", "F0 0.04: all",
                 "scan L1", "diffuse max", "leak", "invalid"});
    uint32_t type = CND_LIGHT_TYPE_COUNT;
    for (const KernelPoint& p : level.points) {
        if (type != CND_LIGHT_TYPE_COUNT && type != p.lightType)
            table.rule();
        type = p.lightType;
        table.add({fmt::format("{} {}", lightTypeName(p.lightType), specularName(p.method)),
                   meanP99Max(p.error.mirror.all), meanP99Max(p.error.mirror.above),
                   meanP99Max(p.error.mirror.crossing), meanP99Max(p.error.dielectric.all),
                   percent(p.error.scanL1), fmt::format("{:.1e}", 100 * p.error.diffuse.all.max),
                   percent(p.error.leak), grouped(p.error.invalid)});
    }
    return table.text();
}

std::string timeTable(const KernelLevel& level)
{
    Table table({"light, method", "above ns", "specular", "/ karis", "near ns", "/ karis",
                 "general ns", "specular", "/ karis"});
    uint32_t type = CND_LIGHT_TYPE_COUNT;
    for (const KernelPoint& p : level.points) {
        if (p.classes.empty())
            return "This device has no timestamps: nothing was timed.\n";
        if (type != CND_LIGHT_TYPE_COUNT && type != p.lightType)
            table.rule();
        type = p.lightType;
        std::vector<std::string> row{
            fmt::format("{} {}", lightTypeName(p.lightType), specularName(p.method))};
        for (const auto c :
             {EvaluationClass::Above, EvaluationClass::Near, EvaluationClass::General}) {
            const KernelPoint::Class* entry = classOf(p, c);
            row.push_back(entry ? threeDigits(entry->both.medianNs) : "-");
            if (c != EvaluationClass::Near)
                row.push_back(entry ? threeDigits(entry->specularNs) : "-");
            row.push_back(entry ? fmt::format("{:.2f}", entry->both.ratio) : "-");
        }
        table.add(row);
    }
    return table.text() +
           fmt::format(
               "form factor of a sphere across the horizon: {} ns; with acos and atan: {} ns\n"
               "form factor above the horizon: none; with acos and atan: {} ns\n"
               "sphere as a point within an error budget: {} ns\n",
               threeDigits(level.formFactor.robustNs), threeDigits(level.formFactor.naiveNs),
               threeDigits(level.formFactor.naiveAboveNs), threeDigits(level.pointBudgetNs));
}

Json toJson(const VariantTime& t)
{
    return {{"medianNs", t.medianNs}, {"minNs", t.minNs}, {"ratioToKaris", t.ratio}};
}

} // namespace

std::string kernelTables(const KernelLevel& level)
{
    return "Errors in percent of the highest true response over light directions\n" +
           errorTable(level) +
           fmt::format("{} samples; quadrature missed its tolerance in {}\n\n",
                       grouped(level.samples), grouped(level.unconvergedTruths)) +
           "Time per (pixel, light), diffuse and specular, on the whole device\n" +
           timeTable(level);
}

Json kernelJson(const KernelLevelSettings& s, const KernelLevel& level)
{
    Json points = Json::array();
    for (const KernelPoint& p : level.points) {
        Json times = Json::object();
        for (const KernelPoint::Class& c : p.classes) {
            Json time = toJson(c.both);
            time["specularAloneNs"] = c.specularNs;
            times[className(c.evaluationClass)] = time;
        }
        points.push_back({{"light", lightTypeName(p.lightType)},
                          {"method", specularName(p.method)},
                          {"error", toJson(p.error)},
                          {"worst", p.worst},
                          {"time", times}});
    }
    return {{"groups", s.groups},
            {"seed", s.seed},
            {"samples", level.samples},
            {"truthTolerance", s.truthTolerance},
            {"unconvergedTruths", level.unconvergedTruths},
            {"samplesPerLightOfSampled", s.sampleCount},
            {"timing",
             {{"lanes", s.timing.lanes},
              {"fewLights", s.timing.fewLights},
              {"manyLights", s.timing.manyLights},
              {"rounds", s.timing.rounds}}},
            {"formFactorNs",
             {{"robust", level.formFactor.robustNs},
              {"naive", level.formFactor.naiveNs},
              {"naiveAbove", level.formFactor.naiveAboveNs}}},
            {"asPointNs", level.pointBudgetNs},
            {"points", points}};
}

std::string kernelPlot(const KernelLevel& level, const DeviceInfo& device)
{
    std::vector<PlotSeries> series;
    for (const KernelPoint& p : level.points) {
        const KernelPoint::Class* time = mainClass(p);
        if (!time || p.lightType == CND_LIGHT_DISTANT_SPHERE) // the same code as spheres
            continue;
        series.push_back(
            {.name = fmt::format("{} {}", lightTypeName(p.lightType), specularName(p.method)),
             .points = {{time->both.medianNs, 100 * p.error.mirror.all.mean}},
             .emphasised = p.lightType == CND_LIGHT_SPHERE});
    }
    return logLogPlot({.title = "Error against time of one light at one pixel",
                       .subtitle = device.name,
                       .xAxis = "ns per (pixel, light), diffuse and specular",
                       .yAxis = "mean error, % of the highest response"},
                      series);
}

} // namespace candelabra::app
