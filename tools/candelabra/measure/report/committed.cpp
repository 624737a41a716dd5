// SPDX-License-Identifier: Apache-2.0
#include "measure/report/committed.h"

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <limits>
#include <set>
#include <stdexcept>

#include <fmt/format.h>

#include "io/error.h"
#include "io/parse.h"
#include "scene/light_types.h"

namespace candelabra::app
{
namespace
{

// The mean of the groups with an interval of 95% from their scatter.
MedianInterval meanOfGroups(const std::vector<double>& means)
{
    double mean = 0, squares = 0;
    const double n = double(means.size());
    for (const double x : means)
        mean += x / n;
    for (const double x : means)
        squares += (x - mean) * (x - mean);
    if (means.size() < 2)
        return {mean, 0, std::numeric_limits<double>::infinity()};
    const double margin = 1.96 * std::sqrt(squares / (n * (n - 1)));
    return {mean, std::max(mean - margin, 0.0), mean + margin};
}

std::string cullingConditions(uint32_t width, uint32_t height)
{
    return fmt::format("{}x{}", width, height);
}

// Says which figures are not compared because all committed ones of the same name are of pictures
// of other conditions.
std::string omissionText(size_t count, const std::set<std::string>& here,
                         const std::set<std::string>& there)
{
    if (!count)
        return {};
    return fmt::format("{} of this run {} not compared, because the pictures of the committed "
                       "results have another size or other lights: {} there, {} here.",
                       counted(count, "figure"), count == 1 ? "is" : "are", fmt::join(there, "; "),
                       fmt::join(here, "; "));
}

std::string number(double x)
{
    return x != 0 && std::abs(x) < 1e-3 ? fmt::format("{:.1e}", x) : threeDigits(x);
}

} // namespace

std::vector<ReportedFigure> figuresOf(const std::vector<CullingPoint>& points)
{
    std::vector<ReportedFigure> out;
    for (const CullingPoint& p : points) {
        const PairedRatio r = p.toEngine(p.bestBaseline().name);
        const MedianInterval inverse{1 / r.median, 1 / r.high, 1 / r.low};
        out.push_back({.key = cullingKey(p.scene, p.lights, p.overlaps),
                       .value = inverse,
                       .conditions = cullingConditions(p.size.width, p.size.height)});
    }
    return out;
}

std::vector<ReportedFigure> figuresOf(const KernelLevel& level)
{
    std::vector<ReportedFigure> out;
    for (const KernelPoint& p : level.points) {
        const std::string light = lightTypeName(p.lightType), method = methodName(p.method);
        if (!p.error.groupMeans.empty())
            out.push_back({kernelErrorKey(light, method), meanOfGroups(p.error.groupMeans), 0});
        if (const KernelPoint::Case* time = mainCase(p); time && time->both.ratio > 0)
            out.push_back({kernelTimeKey(light, method),
                           {time->both.ratio, time->both.ratioLow, time->both.ratioHigh}});
    }
    return out;
}

void addFigures(const std::string& table, const CsvFile& file, CommittedFigures& figures)
{
    for (const auto& row : file.rows) {
        const auto numberAt = [&](const char* column) {
            if (const auto value = parseNumber(row.at(column)))
                return *value;
            throw RunError(fmt::format("\"{}\" is no number", row.at(column)));
        };
        if (table == "culling") {
            const auto count = [&](const char* column) { return uint32_t(numberAt(column)); };
            figures[cullingKey(row.at("scene"), count("lights"), count("overlaps"))]
                   [cullingConditions(count("widthPixels"), count("heightPixels"))] =
                       numberAt("ratioToBestBaseline");
        } else if (table == "accuracy") {
            figures[kernelErrorKey(row.at("light"), row.at("method"))][{}] =
                numberAt("fresnel1.all.meanPercent") / 100;
        } else if (table == "price") {
            const char* column = row.at("above").empty() ? "general" : "above";
            figures[kernelTimeKey(row.at("light"), row.at("method"))][{}] = numberAt(column);
        }
    }
}

std::optional<CommittedResults> readCommitted(const std::string& directory,
                                              const DeviceInfo& device)
{
    std::error_code error;
    if (!std::filesystem::is_directory(directory, error))
        return std::nullopt;
    CommittedResults out{.directory = directory, .files = {}, .figures = {}};
    std::vector<std::filesystem::path> paths;
    for (const auto& entry : std::filesystem::directory_iterator(directory, error))
        if (entry.path().extension() == ".csv")
            paths.push_back(entry.path());
    std::sort(paths.begin(), paths.end());
    for (const std::filesystem::path& path : paths) {
        CommittedFigures figures;
        try {
            const CsvFile file = readCsv(path);
            if (file.head.at("device") != device.name || file.head.at("driver") != device.driver)
                continue;
            const std::string name = path.filename().string();
            addFigures(name.substr(0, name.find('-')), file, figures);
        } catch (const RunError&) {
            continue; // another format
        } catch (const std::out_of_range&) {
            continue; // the same: it lacks a column or a line of the head
        }
        if (figures.empty())
            continue;
        out.files.push_back(path.filename().string());
        for (auto& [key, values] : figures) // of several files, the figure of the first counts
            out.figures[key].merge(values);
    }
    return out;
}

bool contradicts(const ReportedFigure& figure, double committed)
{
    const double below = figure.value.low - committed, above = committed - figure.value.high;
    const double distance = std::max(below, above);
    return figure.value.isKnown() &&
           distance > std::max(contradictionShare * committed, figure.allowance);
}

Comparison compareWithCommitted(const std::vector<ReportedFigure>& figures,
                                const CommittedResults& committed)
{
    Comparison out{
        .table =
            Table({{"figure", "",
                    "The ratio or the error, named as in its table. Culling is the engine's time "
                    "divided by that of the fastest other way, and an evaluation its time divided "
                    "by that of karis."},
                   {"this run", "", "The median or mean of this run."},
                   {"interval", "95%", "The interval of the figure of this run."},
                   {"committed", "", "The figure of the committed results."}},
                  "Figures that the committed results have too"),
        .contradictions = {},
        .omission = {}};
    size_t omitted = 0;
    std::set<std::string> here, there;
    for (const ReportedFigure& figure : figures) {
        const auto sameKey = committed.figures.find(figure.key);
        if (sameKey == committed.figures.end())
            continue;
        const auto found = sameKey->second.find(figure.conditions);
        if (found == sameKey->second.end()) {
            ++omitted;
            here.insert(figure.conditions);
            for (const auto& other : sameKey->second)
                there.insert(other.first);
            continue;
        }
        ++out.compared;
        const MedianInterval& v = figure.value;
        out.table.add({figure.key, number(v.median),
                       v.isKnown() ? fmt::format("[{}, {}]", number(v.low), number(v.high)) : "-",
                       number(found->second)},
                      {.key = figure.key});
        if (contradicts(figure, found->second))
            out.contradictions.push_back(figure.key);
    }
    out.table.note(fmt::format(
        "A figure is said to contradict the committed one if the committed one lies outside the "
        "interval by more than {:.0f}% of the committed one (and, for ratios, by more than {}). "
        "Intervals of mean errors assume that means are normally distributed. A contradiction is "
        "a reason to look, and no proof of a fault.",
        100 * contradictionShare, contradictionDifference));
    out.table.markContradictions(out.contradictions);
    out.omission = omissionText(omitted, here, there);
    return out;
}

} // namespace candelabra::app
