// SPDX-License-Identifier: Apache-2.0
// candelabra compare: tests whether the second of two sets of runs of `candelabra profile`, such as
// before and after a change, is slower.
#include <algorithm>
#include <cmath>

#include <fmt/format.h>
#include <spdlog/spdlog.h>

#include "commands/commands.h"
#include "io/error.h"
#include "io/image.h"
#include "io/suggestion.h"
#include "io/table.h"
#include "measure/profile/profile_frames.h"
#include "measure/profile/run_comparison.h"
#include "measure/profile/run_file.h"

namespace candelabra::app
{
namespace
{

struct CompareArguments {
    std::string fileA, fileB;
    std::vector<std::string> a, b;
    std::string pass = "frame", failAbove = "0", json;
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
    return std::ranges::all_of(a, &ProfiledRun::still) &&
                   std::ranges::all_of(b, &ProfiledRun::still)
               ? Statistic{"min", &ProfiledTime::minMs}
               : Statistic{"median", &ProfiledTime::medianMs};
}

bool inAll(const std::vector<ProfiledRun>& runs, const std::string& name)
{
    return std::ranges::all_of(runs, [&](const ProfiledRun& run) {
        return std::ranges::count(run.times, name, &ProfiledTime::name) > 0;
    });
}

// Returns the time of `name` in every run, or 0 for a run that does not have it.
std::vector<double> timesOf(const std::vector<ProfiledRun>& runs, const std::string& name,
                            const Statistic& statistic)
{
    std::vector<double> out;
    for (const ProfiledRun& run : runs) {
        const auto row = std::ranges::find(run.times, name, &ProfiledTime::name);
        out.push_back(row == run.times.end() ? 0 : (*row).*statistic.ms);
    }
    return out;
}

bool allPositive(const std::vector<double>& values)
{
    return std::ranges::all_of(values, [](double v) { return v > 0; });
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

// Returns the rows of all runs, without their ratios.
std::vector<ComparedRow> rowsOf(const std::vector<ProfiledRun>& a,
                                const std::vector<ProfiledRun>& b, const Statistic& statistic)
{
    std::vector<ComparedRow> rows;
    for (const auto* side : {&a, &b})
        for (const ProfiledRun& run : *side)
            for (const ProfiledTime& time : run.times)
                if (!std::ranges::count(rows, time.name, &ComparedRow::name))
                    rows.push_back({.name = time.name,
                                    .inA = inAll(a, time.name),
                                    .inB = inAll(b, time.name),
                                    .times = {timesOf(a, time.name, statistic),
                                              timesOf(b, time.name, statistic)},
                                    .ratio = {},
                                    .verdict = ""});
    return rows;
}

// Moves the row that --pass names to the front.
void putFirst(const std::string& pass, std::vector<ComparedRow>& rows)
{
    std::string name = pass;
    std::vector<std::string> known;
    for (const WholeTime& whole : wholeTimes) {
        known.push_back(whole.key);
        if (pass == whole.key)
            name = whole.name;
    }
    const auto row = std::ranges::find(rows, name, &ComparedRow::name);
    for (const ComparedRow& one : rows)
        known.push_back(one.name);
    if (row == rows.end())
        throw UsageError(
            fmt::format("--pass {}: no run has this row{}", pass, didYouMean(pass, known)));
    std::rotate(rows.begin(), row, row + 1);
}

// Returns why a row has no ratio, or an empty text if it has one.
std::string whyNoRatio(const ComparedRow& row)
{
    return !row.inA && !row.inB ? "not in all runs"
           : !row.inA           ? "not in all of A"
           : !row.inB           ? "not in all of B"
           : !hasRatio(row)     ? "too short to time"
                                : "";
}

constexpr const char* decisionNames[] = {"not slower", "slower", "cannot tell"}; // by Slower

// Compares the first row alone, and then all others together.
RunDecision compareRows(std::vector<ComparedRow>& rows, bool paired, double bound)
{
    RunDecision out;
    std::vector<RunQuantity> others;
    for (ComparedRow& row : rows) {
        row.verdict = whyNoRatio(row);
        if (&row != &rows[0] && hasRatio(row))
            others.push_back(row.times);
    }
    const std::vector<RunRatio> ratios = compareRuns(others, paired);
    auto next = ratios.begin();
    for (ComparedRow& row : rows) {
        if (!hasRatio(row))
            continue;
        if (&row == &rows[0]) {
            out = decideRuns(row.times, paired, bound);
            row.ratio = out.ratio;
            row.verdict = decisionNames[size_t(out.slower)];
            continue;
        }
        row.ratio = *next++;
        row.verdict = row.ratio.isFaster()   ? "faster"
                      : row.ratio.isSlower() ? "slower"
                                             : "cannot tell";
    }
    return out;
}

double percentOf(double ratio)
{
    return 100 * (ratio - 1);
}

// The answer as one sentence about the row that decides. `tooFew` says how many runs are missing,
// if they are.
std::string answer(const std::string& pass, const ComparedRow& row, const RunDecision& decision,
                   double failAbove, const std::string& tooFew)
{
    const std::string by = failAbove > 0 ? fmt::format(" by more than {:g}%", failAbove) : "";
    const std::string unknown = "Cannot tell whether B is slower" + by + ": ";
    if (!hasRatio(row))
        return unknown + pass + " is " + whyNoRatio(row) + ".";
    if (!tooFew.empty())
        return unknown + tooFew + ".";
    const RunRatio& r = decision.ratio;
    const std::string change =
        fmt::format("{} changed by {:+.2f}% from A to B (95% interval {:+.2f}% to {:+.2f}%)", pass,
                    percentOf(r.ratio), percentOf(r.low), percentOf(r.high));
    switch (decision.slower) {
    case Slower::Yes:
        return "Slower" + by + ": " + change + ".";
    case Slower::No:
        return "Not slower" + by + ": " + change + ".";
    default:
        return unknown + change +
               fmt::format("; the smallest change that these runs could have shown to be slower{} "
                           "is {:+.2f}%.",
                           by, percentOf(decision.smallestSeen));
    }
}

std::string comparedTable(const std::vector<ComparedRow>& rows, const Statistic& statistic)
{
    Table table({fmt::format("{} of", statistic.name).c_str(), "A ms", "B ms", "B / A",
                 "95% interval", "p", "B is"});
    for (const ComparedRow& row : rows) {
        const bool both = hasRatio(row);
        if (&row == rows.data() + 1)
            table.rule();
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

struct Compared {
    std::vector<ProfiledRun> a, b;
    std::vector<std::string> differences; // reasons not to compare them, which --force overrides
};

Compared readBoth(const CompareArguments& args)
{
    for (const auto* side : {&args.a, &args.b})
        for (const std::string& file : *side)
            if (isPictureName(file))
                throw UsageError("compare: " + file +
                                 " is a picture; candelabra diff compares pictures");
    Compared out{runsOf(args.a), runsOf(args.b), {}};
    if (args.paired && out.a.size() != out.b.size())
        throw UsageError(fmt::format("--paired: A has {} and B {}, but both need the same number",
                                     counted(out.a.size(), "run"), counted(out.b.size(), "run")));
    out.differences = objections(out.a, out.b);
    if (!out.differences.empty() && !args.force)
        throw UsageError(out.differences[0] + "; --force compares them nevertheless");
    for (const std::string& difference : out.differences)
        spdlog::warn("warning: {}", difference);
    return out;
}

CompareArguments withLists(CompareArguments args)
{
    if (!args.fileA.empty() && (!args.a.empty() || !args.b.empty()))
        throw UsageError("compare: give two files, or lists of them with --a and --b, not both");
    if (!args.fileA.empty())
        args.a = {args.fileA};
    if (!args.fileB.empty())
        args.b = {args.fileB};
    if (args.a.empty() || args.b.empty())
        throw UsageError("compare: give results of candelabra profile --json for both A and B");
    return args;
}

// Returns why there is no interval, or an empty text if there is one.
std::string tooFewRuns(const Compared& runs, bool paired)
{
    const size_t needed = paired ? minPairedRuns : minRuns;
    return std::min(runs.a.size(), runs.b.size()) >= needed
               ? ""
               : fmt::format("an interval needs {} runs of each, and A has {} and B {}", needed,
                             runs.a.size(), runs.b.size());
}

int compare(const ProgramContext& program, const CompareArguments& given)
{
    if (!given.json.empty())
        requireWritable("--json", given.json);
    const double failAbove = numberOption("--fail-above", given.failAbove, 0, 1000);
    const CompareArguments args = withLists(given);
    const Compared runs = readBoth(args);
    const Statistic statistic = statisticOf(runs.a, runs.b);
    std::vector<ComparedRow> rows = rowsOf(runs.a, runs.b, statistic);
    putFirst(args.pass, rows);
    const RunDecision decision = compareRows(rows, args.paired, failAbove / 100);
    if (args.json != "-")
        writeText("-",
                  answer(args.pass, rows[0], decision, failAbove, tooFewRuns(runs, args.paired)) +
                      fmt::format("\nA: {}, B: {}{}\n{}", counted(runs.a.size(), "run"),
                                  counted(runs.b.size(), "run"), args.paired ? ", in pairs" : "",
                                  comparedTable(rows, statistic)) +
                      "A ms and B ms are geometric means over the runs, and B / A is their "
                      "quotient. The first row decides: its interval holds with 95% confidence, "
                      "and its p is that of a ratio at the limit. The intervals of the other rows "
                      "hold together with 95% confidence, and decide nothing.\n");
    if (!args.json.empty())
        writeJson(args.json, {{"schema", "candelabra compare 3"},
                              {"commandLine", program.commandLine},
                              {"a", sideJson(args.a, runs.a)},
                              {"b", sideJson(args.b, runs.b)},
                              {"paired", args.paired},
                              {"forcedOver", runs.differences},
                              {"statistic", statistic.name},
                              {"confidence", 0.95},
                              {"decision",
                               {{"name", rows[0].name},
                                {"failAbovePercent", failAbove},
                                {"smallestSeenPercent", percentOf(decision.smallestSeen)},
                                {"verdict", decisionNames[size_t(decision.slower)]}}},
                              {"rows", comparedJson(rows)}});
    return decision.slower == Slower::Yes  ? exitBeyond
           : decision.slower == Slower::No ? exitOk
                                           : exitCannotTell;
}

} // namespace

void addCompareCommand(CLI::App& app, Run& run)
{
    CLI::App* command = app.add_subcommand(
        "compare", "Test whether the second of two sets of profile runs is slower");
    const auto a = argumentsOf(*command, run, compare);
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
    addOption(*command, "--pass", a->pass, "NAME",
              "the row that decides: a pass such as shade_tiles, or gpu (the sum of passes), "
              "gpuSpan, upload, record or frame");
    addOption(*command, "--fail-above", a->failAbove, "PERCENT",
              "the largest slow-down that is accepted");
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
        "The row of --pass decides. The exit code is 0 if it is not slower than --fail-above\n"
        "allows, 3 if it is, and 4 if that cannot be told, because the interval contains the\n"
        "limit. With a limit of 0, equal programs mostly give 4, so choose one that runs can\n"
        "resolve. The interval of the row is its own, with 95% confidence: a permutation test of\n"
        "the ratio B / A, exact at the limit. If B is slower by just the limit, 0 and 3 are each\n"
        "given in one comparison of forty. The other rows decide nothing. Their intervals hold\n"
        "together with 95% confidence.\n"
        "\"too short to time\" means that in some run the pass took no longer than the timestamp\n"
        "that is subtracted.\n\n"
        "Examples:\n"
        "  for i in 1 2 3 4 5; do\n"
        "    old/candelabra profile hall --json a.json --append -q\n"
        "    new/candelabra profile hall --json b.json --append -q\n"
        "  done\n"
        "  candelabra compare a.json b.json --fail-above 2\n"
        "  candelabra compare --a before*.json --b after*.json --json -");
}

} // namespace candelabra::app
