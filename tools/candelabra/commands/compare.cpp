// SPDX-License-Identifier: Apache-2.0
// candelabra compare: tests whether two sets of runs of `candelabra profile`, such as before and
// after a change, differ significantly.
#include <algorithm>
#include <cmath>
#include <memory>

#include <fmt/format.h>
#include <spdlog/spdlog.h>

#include "commands/commands.h"
#include "io/error.h"
#include "io/image.h"
#include "io/table.h"
#include "measure/profile/run_comparison.h"
#include "measure/profile/run_file.h"

namespace candelabra::app
{
namespace
{

struct CompareArguments {
    std::string fileA, fileB;
    std::vector<std::string> a, b;
    std::string tolerance = "0", json;
    bool paired = false, force = false;
};

struct ComparedRow {
    std::string name;
    bool inA = false, inB = false; // whether all runs of that side have it
    RunQuantity times;
    RunRatio ratio;
    std::string verdict;
};

std::vector<ProfiledRun> runsOf(const std::vector<std::string>& files)
{
    std::vector<ProfiledRun> out;
    for (const std::string& file : files)
        for (ProfiledRun& run : readRuns(file))
            out.push_back(std::move(run));
    return out;
}

using Facts = std::vector<std::pair<std::string, std::string>>;

// Adds a sentence for each fact in which `other` differs from `first`.
void findDifferences(const ProfiledRun& first, const ProfiledRun& other, const Facts& of,
                     const Facts& ofOther, std::vector<std::string>& out)
{
    for (size_t i = 0; i < of.size(); ++i)
        if (of[i] != ofOther[i])
            out.push_back(fmt::format("{} has {} {}, {} {}", first.where, of[i].first, of[i].second,
                                      other.where, ofOther[i].second));
}

// Returns the reasons why these runs should not be compared.
std::vector<std::string> objections(const std::vector<ProfiledRun>& a,
                                    const std::vector<ProfiledRun>& b)
{
    std::vector<std::string> out;
    for (const auto* side : {&a, &b})
        for (const ProfiledRun& run : *side) {
            findDifferences(a[0], run, a[0].conditions, run.conditions, out);
            findDifferences((*side)[0], run, (*side)[0].version, run.version, out);
        }
    return out;
}

// The time of a run's frames that is compared. Frames that draw the same differ by noise alone,
// which mostly makes them longer, so that the shortest time varies least from run to run (DECISIONS
// 36). If frames differ in their work, the shortest time would be that of the cheapest frame, and
// the median is taken.
struct Statistic {
    const char* name; // its name in results
    double ProfiledTime::*ms;
};

Statistic statisticOf(const std::vector<ProfiledRun>& a, const std::vector<ProfiledRun>& b)
{
    const auto still = [](const ProfiledRun& run) { return run.still; };
    return std::all_of(a.begin(), a.end(), still) && std::all_of(b.begin(), b.end(), still)
               ? Statistic{"min", &ProfiledTime::minMs}
               : Statistic{"median", &ProfiledTime::medianMs};
}

bool inAll(const std::vector<ProfiledRun>& runs, const std::string& name)
{
    return std::all_of(runs.begin(), runs.end(), [&](const ProfiledRun& run) {
        return std::any_of(run.times.begin(), run.times.end(),
                           [&](const ProfiledTime& t) { return t.name == name; });
    });
}

// Returns the time of `name` in every run, or 0 for a run that does not have it.
std::vector<double> timesOf(const std::vector<ProfiledRun>& runs, const std::string& name,
                            const Statistic& statistic)
{
    std::vector<double> out;
    for (const ProfiledRun& run : runs) {
        const auto row = std::find_if(run.times.begin(), run.times.end(),
                                      [&](const ProfiledTime& t) { return t.name == name; });
        out.push_back(row == run.times.end() ? 0 : (*row).*statistic.ms);
    }
    return out;
}

bool allPositive(const std::vector<double>& values)
{
    return std::all_of(values.begin(), values.end(), [](double v) { return v > 0; });
}

// Returns the value that tables show for the times of one side: their geometric mean.
// RunRatio::ratio is the quotient of these means.
double meanMs(const std::vector<double>& times)
{
    double logarithms = 0;
    for (const double ms : times)
        logarithms += std::log(ms);
    return std::exp(logarithms / double(times.size())); // 0 if any time is 0
}

// Returns false for a pass that is missing in some run, or that was too short there to be timed.
bool hasRatio(const ComparedRow& row)
{
    return allPositive(row.times.a) && allPositive(row.times.b);
}

std::vector<ComparedRow> rowsOf(const std::vector<ProfiledRun>& a,
                                const std::vector<ProfiledRun>& b, const Statistic& statistic,
                                bool paired)
{
    std::vector<ComparedRow> rows;
    for (const auto* side : {&a, &b})
        for (const ProfiledRun& run : *side)
            for (const ProfiledTime& time : run.times)
                if (std::none_of(rows.begin(), rows.end(),
                                 [&](const ComparedRow& r) { return r.name == time.name; }))
                    rows.push_back({.name = time.name,
                                    .inA = inAll(a, time.name),
                                    .inB = inAll(b, time.name),
                                    .times = {timesOf(a, time.name, statistic),
                                              timesOf(b, time.name, statistic)},
                                    .ratio = {},
                                    .verdict = ""});
    std::vector<RunQuantity> comparable;
    for (const ComparedRow& row : rows)
        if (hasRatio(row))
            comparable.push_back(row.times);
    const std::vector<RunRatio> ratios = compareRuns(comparable, paired);
    auto next = ratios.begin();
    for (ComparedRow& row : rows) {
        const bool timed = hasRatio(row);
        if (timed)
            row.ratio = *next++;
        row.verdict = !row.inA && !row.inB   ? "not in all runs"
                      : !row.inA             ? "not in all of A"
                      : !row.inB             ? "not in all of B"
                      : !timed               ? "too short to time"
                      : row.ratio.isFaster() ? "faster"
                      : row.ratio.isSlower() ? "slower"
                                             : "cannot tell";
    }
    return rows;
}

std::string comparedTable(const std::vector<ComparedRow>& rows, const Statistic& statistic)
{
    Table table({fmt::format("{} of", statistic.name).c_str(), "A ms", "B ms", "B / A",
                 "95% interval", "p", "B is"});
    for (const ComparedRow& row : rows) {
        const bool both = hasRatio(row);
        table.add({row.name, threeDigits(meanMs(row.times.a)), threeDigits(meanMs(row.times.b)),
                   both ? fmt::format("{:.3f}", row.ratio.ratio) : "-",
                   both ? fmt::format("{:.3f} .. {:.3f}", row.ratio.low, row.ratio.high) : "-",
                   both ? fmt::format("{:.3f}", row.ratio.p) : "-", row.verdict});
    }
    return table.text();
}

Json sideJson(const std::vector<std::string>& files, const std::vector<ProfiledRun>& runs)
{
    Json out{{"files", files}, {"runs", runs.size()}};
    for (const auto& [name, value] : runs[0].version)
        out[name] = name == "settings" ? Json::parse(value) : Json(value);
    return out;
}

Json comparedJson(const std::vector<ComparedRow>& rows)
{
    Json out = Json::array();
    for (const ComparedRow& row : rows) {
        Json one{{"name", row.name}, {"aMs", meanMs(row.times.a)}, {"bMs", meanMs(row.times.b)}};
        if (hasRatio(row))
            one.update(Json{{"ratio", row.ratio.ratio},
                            {"low", row.ratio.low},
                            {"high", row.ratio.high},
                            {"p", row.ratio.p}});
        one["verdict"] = row.verdict;
        out.push_back(one);
    }
    return out;
}

int compare(const ProgramContext& program, const CompareArguments& given)
{
    CompareArguments args = given;
    if (!args.json.empty())
        requireWritable("--json", args.json);
    const double tolerance = numberOption("--tolerance", args.tolerance, 0, 1000) / 100;
    if (!args.fileA.empty() && (!args.a.empty() || !args.b.empty()))
        throw UsageError("compare: give two files, or lists of them with --a and --b, not both");
    if (!args.fileA.empty())
        args.a = {args.fileA};
    if (!args.fileB.empty())
        args.b = {args.fileB};
    if (args.a.empty() || args.b.empty())
        throw UsageError("compare: give results of candelabra profile --json for both A and B");
    for (const auto* side : {&args.a, &args.b})
        for (const std::string& file : *side)
            if (isPictureName(file))
                throw UsageError("compare: " + file +
                                 " is a picture; candelabra diff compares pictures");
    const std::vector<ProfiledRun> a = runsOf(args.a), b = runsOf(args.b);
    if (args.paired && a.size() != b.size())
        throw UsageError(fmt::format("--paired: A has {} and B {}, but both need the same number",
                                     counted(a.size(), "run"), counted(b.size(), "run")));
    const std::vector<std::string> differences = objections(a, b);
    if (!differences.empty() && !args.force)
        throw UsageError(differences[0] + "; --force compares them nevertheless");
    for (const std::string& difference : differences)
        spdlog::warn("warning: {}", difference);

    const Statistic statistic = statisticOf(a, b);
    const std::vector<ComparedRow> rows = rowsOf(a, b, statistic, args.paired);
    const bool slower = std::any_of(rows.begin(), rows.end(), [&](const ComparedRow& row) {
        return row.ratio.low > 1 + tolerance;
    });
    const size_t needed = args.paired ? minPairedRuns : minRuns;
    const bool tooFew = std::min(a.size(), b.size()) < needed;
    if (args.json != "-") {
        std::string text =
            fmt::format("A: {}, B: {}{}\n{}", counted(a.size(), "run"), counted(b.size(), "run"),
                        args.paired ? ", in pairs" : "", comparedTable(rows, statistic));
        text += "A ms and B ms are geometric means over the runs, and B / A is their quotient.\n";
        if (tooFew)
            text += fmt::format("There is no interval with fewer than {} runs of each.\n", needed);
        else
            text +=
                "All intervals hold together with 95% confidence: of twenty such comparisons of "
                "equal programs, one finds a difference by chance.\n";
        writeText("-", text);
    }
    if (!args.json.empty())
        writeJson(args.json, {{"schema", "candelabra compare 2"},
                              {"commandLine", program.commandLine},
                              {"a", sideJson(args.a, a)},
                              {"b", sideJson(args.b, b)},
                              {"paired", args.paired},
                              {"forcedOver", differences},
                              {"statistic", statistic.name},
                              {"confidence", 0.95},
                              {"tolerance", tolerance},
                              {"rows", comparedJson(rows)},
                              {"slower", slower}});
    return slower ? exitBeyond : exitOk;
}

} // namespace

void addCompareCommand(CLI::App& app, Run& run)
{
    CLI::App* command =
        app.add_subcommand("compare", "Test whether two sets of profile runs differ significantly");
    const auto a = std::make_shared<CompareArguments>();
    command->add_option("A", a->fileA,
                        "runs before a change, in a file written by profile --json --append");
    command->add_option("B", a->fileB, "runs after the change, in such a file")->needs("A");
    command->add_option("--a", a->a, "several files with runs of A, instead of two files")
        ->type_name("FILE...");
    command->add_option("--b", a->b, "several files with runs of B")->type_name("FILE...");
    command->add_flag(
        "--paired", a->paired,
        "compare the n-th run of A with the n-th run of B, which was made next to it; this removes "
        "slow drifts of the machine and needs at least 6 runs of each");
    addOption(*command, "--tolerance", a->tolerance, "PERCENT",
              "set the exit code to 3 only if something is slower by more than this");
    command->add_flag("--force", a->force,
                      "compare runs even if their devices, scenes, sizes, paths, numbers of frames "
                      "or of frames in "
                      "flight differ");
    addOption(*command, "--json", a->json, "FILE",
              "JSON file with all figures; - is standard output");
    command->footer(
        "A run is one call of profile. The comparison uses the shortest time of each pass\n"
        "over the frames of a run, because a busy machine affects it least. With a camera\n"
        "path or moving lights it uses the median. The table shows the geometric means of\n"
        "these times over the runs, and their ratio B / A. Compare at least 4 runs with 4, or\n"
        "better 5 with 5 or more. Each run should have 40 frames or more, and all runs\n"
        "equally many. Alternate the runs of A and B, so that a machine that slows down\n"
        "affects both.\n"
        "\"cannot tell\" means that the interval is wider than the change. \"too short to time\"\n"
        "means that in some run the pass took no longer than the timestamp that is\n"
        "subtracted.\n"
        "The exit code is 3 if something is slower. It is 0 if nothing is slower or if the\n"
        "difference may be chance.\n\n"
        "Examples:\n"
        "  for i in 1 2 3 4 5; do\n"
        "    old/candelabra profile hall --json a.json --append -q\n"
        "    new/candelabra profile hall --json b.json --append -q\n"
        "  done\n"
        "  candelabra compare a.json b.json --tolerance 2\n"
        "  candelabra compare --a before*.json --b after*.json --json -");
    command->callback(
        [&run, a] { run = [a](const ProgramContext& program) { return compare(program, *a); }; });
}

} // namespace candelabra::app
