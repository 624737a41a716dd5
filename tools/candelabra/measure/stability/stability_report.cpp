// SPDX-License-Identifier: Apache-2.0
// What stability.h measured, for people and programs.
#include <algorithm>
#include <map>

#include <fmt/format.h>

#include "io/table.h"
#include "measure/stability/stability.h"
#include "render/setting_names.h"
#include "scene/light_types.h"

namespace candelabra::app
{
namespace
{

std::string nameOf(const Evaluation& e)
{
    return fmt::format("{} {}{}", lightTypeName(e.lightType), specularName(e.method),
                       e.errorBudget > 0 ? fmt::format(" budget {}", e.errorBudget) : "");
}

std::string countTable(const Stability& stability)
{
    Table table({"inputs", "tried", "NaN", "infinite", "negative"});
    for (uint32_t slice = 0; slice < sweepSliceCount; ++slice) {
        SweepCount sum;
        for (const SweptSlice& s : stability.slices)
            if (s.slice == slice) {
                sum.tried += s.count.tried;
                sum.nan += s.count.nan;
                sum.infinite += s.count.infinite;
                sum.negative += s.count.negative;
            }
        table.add({sliceText(slice), grouped(sum.tried), grouped(sum.nan), grouped(sum.infinite),
                   grouped(sum.negative)});
    }
    return table.text();
}

std::string quadratureTable(const Stability& stability)
{
    Table table({"light, method", "samples", "mean %", "p99 %", "max %", "bar %", "diffuse max"});
    for (const QuadratureCheck& q : stability.quadrature)
        table.add({nameOf(q.evaluation), grouped(q.samples), threeDigits(100 * q.mean),
                   threeDigits(100 * q.p99), threeDigits(100 * q.max),
                   q.bar > 0 ? threeDigits(100 * q.bar) : "-",
                   fmt::format("{:.1e}", q.diffuseMax)});
    return table.text();
}

std::string continuityTable(const Stability& stability)
{
    Table table({"light, method", "through", "largest jump / peak"});
    for (const ContinuityCheck& c : stability.continuity)
        table.add({nameOf(c.evaluation), c.through, fmt::format("{:.1e}", c.jump)});
    return table.text();
}

std::string badList(const Stability& stability)
{
    std::string out;
    for (const SweptSlice& s : stability.slices)
        if (s.count.invalid())
            out += fmt::format("{}, {}: {} NaN, {} infinite, {} negative of {}\n  {}\n",
                               nameOf(s.evaluation), sliceText(s.slice), s.count.nan,
                               s.count.infinite, s.count.negative, s.count.tried,
                               s.count.bad.empty() ? "" : describeRecord(s.count.bad[0]));
    return out.empty() ? "" : "\nInvalid responses\n" + out;
}

std::string overBarList(const Stability& stability)
{
    std::string out;
    for (const QuadratureCheck& q : stability.quadrature)
        if (q.overBar())
            out += fmt::format("{}: {}% at {}\n", nameOf(q.evaluation), threeDigits(100 * q.max),
                               q.worst);
    return out.empty() ? "" : "\nOver the bar\n" + out;
}

} // namespace

std::string stabilityTables(const Stability& stability)
{
    return fmt::format("{} configurations, {} invalid responses\n", grouped(stability.tried()),
                       grouped(stability.invalid())) +
           countTable(stability) +
           "\nFormula against quadrature on such inputs, F = 1, relative to the response on the "
           "mirror axis\n" +
           quadratureTable(stability) + "\nContinuity\n" + continuityTable(stability) +
           badList(stability) + overBarList(stability);
}

Json stabilityJson(const StabilitySettings& settings, const Stability& stability)
{
    Json slices = Json::array(), quadrature = Json::array(), continuity = Json::array();
    for (const SweptSlice& s : stability.slices) {
        Json bad = Json::array();
        for (const gpu::SweepRecord& r : s.count.bad)
            bad.push_back(describeRecord(r));
        slices.push_back({{"evaluation", nameOf(s.evaluation)},
                          {"inputs", sliceText(s.slice)},
                          {"tried", s.count.tried},
                          {"nan", s.count.nan},
                          {"infinite", s.count.infinite},
                          {"negative", s.count.negative},
                          {"bad", bad}});
    }
    for (const QuadratureCheck& q : stability.quadrature)
        quadrature.push_back({{"evaluation", nameOf(q.evaluation)},
                              {"samples", q.samples},
                              {"meanPercent", 100 * q.mean},
                              {"p99Percent", 100 * q.p99},
                              {"maxPercent", 100 * q.max},
                              {"barPercent", 100 * q.bar},
                              {"diffuseMax", q.diffuseMax},
                              {"worst", q.worst}});
    for (const ContinuityCheck& c : stability.continuity)
        continuity.push_back({{"evaluation", nameOf(c.evaluation)},
                              {"through", c.through},
                              {"jumpOverPeak", c.jump},
                              {"worst", c.worst}});
    return {{"seed", settings.seed},
            {"configurations", stability.tried()},
            {"invalid", stability.invalid()},
            {"slices", slices},
            {"formulaAgainstQuadrature", quadrature},
            {"continuity", continuity}};
}

} // namespace candelabra::app
