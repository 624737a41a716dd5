// SPDX-License-Identifier: Apache-2.0
// What skip.h measured, for people and programs.
#include <fmt/format.h>

#include "io/table.h"
#include "measure/skip/skip.h"

namespace candelabra::app
{
namespace
{

double medianMs(const PassTimes& times)
{
    return times.total().medianMs;
}

Json timesJson(const PassTimes& times)
{
    Json passes = Json::array();
    for (const PassSummary& pass : times.summary())
        passes.push_back({{"name", pass.name}, {"minMs", pass.minMs}, {"medianMs", pass.medianMs}});
    return {{"frames", times.frames()},
            {"medianMs", medianMs(times)},
            {"minMs", times.total().minMs},
            {"passes", passes}};
}

// What looking for the skip takes where it is not found.
std::string costOf(const SkipRow& row)
{
    if (!row.idleWith.frames())
        return "nothing";
    return fmt::format("{:+.1f} of {} ms", medianMs(row.idleWith) - medianMs(row.idleWithout),
                       threeDigits(medianMs(row.idleWithout)));
}

} // namespace

std::string skipTable(const std::vector<SkipRow>& rows)
{
    Table table(
        {"skip", "against", "passes", "ms", "without", "ratio", "bar", "in vain", "difference"});
    for (const SkipRow& row : rows)
        table.add({row.name, row.against, row.passes, threeDigits(medianMs(row.with)),
                   threeDigits(medianMs(row.without)), fmt::format("{:.3f}", row.ratio()),
                   row.bar > 0 ? fmt::format("{:.2f}", row.bar) : "-", costOf(row),
                   fmt::format("{:.0e}", row.difference)});
    return table.text();
}

Json skipJson(const SkipSettings& settings, const std::vector<SkipRow>& rows)
{
    Json list = Json::array();
    for (const SkipRow& row : rows) {
        Json out{{"name", row.name},
                 {"against", row.against},
                 {"passes", row.passes},
                 {"ratio", row.ratio()},
                 {"bar", row.bar > 0 ? Json(row.bar) : Json()},
                 {"differenceOverLargest", row.difference},
                 {"bound", row.bound},
                 {"with", timesJson(row.with)},
                 {"without", timesJson(row.without)}};
        if (row.idleWith.frames()) {
            out["inVain"] = timesJson(row.idleWith);
            out["notLookedFor"] = timesJson(row.idleWithout);
        }
        list.push_back(out);
    }
    return {{"scene", settings.scene},
            {"widthPixels", settings.size.width},
            {"heightPixels", settings.size.height},
            {"lights", settings.lights},
            {"rounds", settings.rounds},
            {"pointRounds", settings.pointRounds},
            {"seed", settings.seed},
            {"specular", "conic"},
            {"skips", list}};
}

std::vector<std::string> skipFailures(const std::vector<SkipRow>& rows)
{
    std::vector<std::string> out;
    for (const SkipRow& row : rows)
        if (!(row.difference <= row.bound))
            out.push_back(fmt::format("{}: the image differs by {:.1e} of the largest radiance",
                                      row.name, row.difference));
    return out;
}

} // namespace candelabra::app
