// SPDX-License-Identifier: Apache-2.0
// Tests candelabra compare on files as candelabra profile writes them. Nothing here uses Vulkan.
#include <algorithm>
#include <cmath>
#include <random>

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include "harness/json_keys.h"
#include "harness/run_program.h"
#include "harness/temporary_folder.h"
#include "io/error.h"

using namespace candelabra::app;
using candelabra::test::ProgramOutcome;
using candelabra::test::runWith;
using nlohmann::json;

namespace
{

class CompareCommand : public testing::Test, protected candelabra::test::TemporaryFolder
{
protected:
    std::string write(const std::string& name, const json& content) const
    {
        return TemporaryFolder::write(name, content.dump());
    }
    json run(double shadingMs)
    {
        const auto noisy = [&](double ms) {
            return json{{"minMs", ms * noise_(random_)}, {"medianMs", ms * loud_(random_)}};
        };
        const auto pass = [&](const char* name, double ms) {
            json out = noisy(ms);
            out["name"] = name;
            return out;
        };
        const json time{{"frames", 60},
                        {"passes", {pass("cull", 10), pass("shade", shadingMs)}},
                        {"gpu", noisy(10 + shadingMs)},
                        {"record", noisy(1)},
                        {"frame", noisy(15 + shadingMs)}};
        return {{"schema", "candelabra profile 1"},
                {"provenance", {{"device", "d"}, {"driver", "1"}, {"commit", "c"}}},
                {"scene", {{"name", "hall"}}},
                {"image", {{"widthPixels", 1}}},
                {"path", "still"},
                {"variants", {{{"name", "frame"}, {"settings", json::object()}, {"time", time}}}}};
    }
    json runs(int count, double shadingMs)
    {
        json out = json::array();
        for (int i = 0; i < count; ++i)
            out.push_back(run(shadingMs));
        return out;
    }
    ProgramOutcome compare(std::vector<std::string> arguments)
    {
        std::vector<const char*> pointers{"compare"};
        for (const std::string& argument : arguments)
            pointers.push_back(argument.c_str());
        return runWith(pointers);
    }

    std::mt19937 random_{3};
    std::lognormal_distribution<double> noise_{0, 0.005}, loud_{0, 0.5};
};

} // namespace

TEST_F(CompareCommand, OneRowDecidesAndTheAnswerComesFirst)
{
    const std::string a = write("a.json", runs(5, 50)), b = write("b.json", runs(5, 52.5));
    const ProgramOutcome outcome = compare({a, b, "--pass", "shade", "--json", "-"});
    EXPECT_EQ(outcome.exitCode, exitBeyond) << outcome.err;
    const json out = json::parse(outcome.out);
    EXPECT_EQ(candelabra::test::keyFaults(out, "compare"), "");
    EXPECT_EQ(out["decision"]["name"], "shade");
    EXPECT_EQ(out["decision"]["verdict"], "slower");
    EXPECT_EQ(out["statistic"], "min");
    EXPECT_EQ(out["a"]["runs"], 5);
    ASSERT_EQ(out["rows"].size(), 5u);
    EXPECT_EQ(out["rows"][0]["name"], "shade"); // the row that decides comes first
    EXPECT_EQ(out["rows"][0]["verdict"], "slower");
    EXPECT_NEAR(out["rows"][0]["ratio"], 1.05, 0.02);
    EXPECT_LE(out["rows"][0]["low"], out["rows"][0]["ratio"]);
    EXPECT_EQ(out["rows"][1]["name"], "cull");
    EXPECT_EQ(out["rows"][1]["verdict"], "cannot tell");
    for (const json& row : out["rows"]) // the ratio is the quotient of the times beside it
        EXPECT_NEAR(row["ratio"], row["bMs"].get<double>() / row["aMs"].get<double>(), 1e-9);

    const auto answer = [&](std::vector<std::string> arguments, int exitCode) {
        const ProgramOutcome found = compare(std::move(arguments));
        EXPECT_EQ(found.exitCode, exitCode) << found.out << found.err;
        return found.out.substr(0, found.out.find('\n'));
    };
    // The frame takes 65 and 67.5 ms: 3.8% more.
    EXPECT_TRUE(answer({a, b}, exitBeyond).starts_with("Slower: frame changed by +"));
    EXPECT_TRUE(answer({b, a}, exitOk).starts_with("Not slower: frame changed by -"));
    EXPECT_TRUE(answer({a, b, "--fail-above", "2"}, exitBeyond)
                    .starts_with("Slower by more than 2%: frame changed by +"));
    EXPECT_TRUE(answer({a, b, "--fail-above", "10"}, exitOk)
                    .starts_with("Not slower by more than 10%: frame changed by +"));
    // Another row that is slower does not decide.
    const std::string culled = answer({a, b, "--pass", "cull"}, exitCannotTell);
    EXPECT_TRUE(culled.starts_with("Cannot tell whether B is slower: cull changed by "));
    EXPECT_NE(culled.find("the smallest change that these runs could have shown"),
              std::string::npos)
        << culled;
    EXPECT_NE(compare({a, b, "--pass", "cull"}).out.find(" slower\n"), std::string::npos);
}

// The same runs decide otherwise for another limit: what is near it cannot be told.
TEST_F(CompareCommand, NearTheLimitItCannotBeTold)
{
    const std::string a = write("a.json", runs(5, 50)), b = write("b.json", runs(5, 52.5));
    const double ratio =
        json::parse(compare({a, b, "--json", "-"}).out)["rows"][0]["ratio"].get<double>();
    const std::string near = std::to_string(100 * (ratio - 1));
    EXPECT_EQ(compare({a, b, "--fail-above", near}).exitCode, exitCannotTell);
}

// The shortest time along a path is that of its cheapest frame, so medians are compared.
TEST_F(CompareCommand, MediansAreComparedWhereFramesDiffer)
{
    json moving = run(50);
    moving["variants"][0]["time"]["upload"] = {{"minMs", 0.1}, {"medianMs", 0.2}};
    const std::string moved = write("moved.json", moving);
    EXPECT_NE(compare({moved, moved}).out.find("median of"), std::string::npos);

    json a = runs(5, 50), b = runs(5, 52.5);
    for (json* side : {&a, &b})
        for (json& one : *side)
            one["path"] = "turn";
    const std::string fileA = write("a.json", a), fileB = write("b.json", b);
    const ProgramOutcome outcome = compare({fileA, fileB, "--json", "-"});
    EXPECT_EQ(outcome.exitCode, exitCannotTell) << outcome.err;
    const json out = json::parse(outcome.out);
    EXPECT_EQ(out["statistic"], "median");
    double product = 1;
    for (const json& one : a)
        product *= one["variants"][0]["time"]["passes"][1]["medianMs"].get<double>();
    EXPECT_EQ(out["rows"][2]["name"], "shade");
    EXPECT_NEAR(out["rows"][2]["aMs"], std::pow(product, 0.2), 1e-9);

    const std::string still = write("c.json", runs(5, 50));
    EXPECT_NE(compare({fileA, still, "--force"}).out.find("median of"), std::string::npos);
}

TEST_F(CompareCommand, RunsMayLieInManyFilesAndInPairs)
{
    std::vector<std::string> arguments{"--paired"};
    for (const char* side : {"--a", "--b"}) {
        arguments.push_back(side);
        for (int i = 0; i < 6; ++i)
            arguments.push_back(write(side + std::to_string(i) + ".json", run(50)));
    }
    arguments.insert(arguments.end(), {"--fail-above", "5"});
    const ProgramOutcome outcome = compare(arguments);
    EXPECT_EQ(outcome.exitCode, exitOk) << outcome.err;
    EXPECT_NE(outcome.out.find("A: 6 runs, B: 6 runs, in pairs"), std::string::npos) << outcome.out;
    EXPECT_EQ(outcome.out.find(" slower\n"), outcome.out.find("not slower\n") + 3) << outcome.out;
}

TEST_F(CompareCommand, PassesOfOneSideAreNamed)
{
    json b = runs(5, 50);
    for (json& one : b)
        one["variants"][0]["time"]["passes"].push_back(
            {{"name", "extra"}, {"minMs", 1}, {"medianMs", 2}});
    const std::string fileA = write("a.json", runs(5, 50)), fileB = write("b.json", b);
    const ProgramOutcome outcome = compare({fileA, fileB, "--fail-above", "5"});
    EXPECT_EQ(outcome.exitCode, exitOk) << outcome.err;
    EXPECT_NE(outcome.out.find("not in all of A"), std::string::npos) << outcome.out;
    const ProgramOutcome decisive = compare({fileA, fileB, "--pass", "extra"});
    EXPECT_EQ(decisive.exitCode, exitCannotTell);
    EXPECT_NE(decisive.out.find("Cannot tell whether B is slower: extra is not in all of A."),
              std::string::npos)
        << decisive.out;
    const ProgramOutcome unknown = compare({fileA, fileB, "--pass", "shad"});
    EXPECT_EQ(unknown.exitCode, exitUsage);
    EXPECT_NE(unknown.err.find("--pass shad: no run has this row; did you mean shade?"),
              std::string::npos)
        << unknown.err;
}

// A short pass may take less time than the timestamp overhead that is subtracted.
TEST_F(CompareCommand, PassesTooShortToTimeAreNotCompared)
{
    json b = runs(5, 50);
    b[3]["variants"][0]["time"]["passes"][0]["minMs"] = 0;
    const ProgramOutcome outcome = compare(
        {write("a.json", runs(5, 50)), write("b.json", b), "--pass", "cull", "--json", "-"});
    EXPECT_EQ(outcome.exitCode, exitCannotTell) << outcome.err;
    const json out = json::parse(outcome.out), row = out["rows"][0];
    EXPECT_TRUE(out["decision"]["smallestSeenPercent"].is_null());
    EXPECT_EQ(row["verdict"], "too short to time");
    EXPECT_FALSE(row.contains("ratio"));
}

TEST_F(CompareCommand, RefusesWhatIsNotComparable)
{
    const std::string a = write("a.json", runs(5, 50));
    const auto refused = [&](const json& b, const std::string& sentence, bool forcible = false) {
        const std::string file = write("b.json", b);
        const ProgramOutcome outcome = compare({a, file});
        EXPECT_EQ(outcome.exitCode, exitUsage) << sentence;
        EXPECT_NE(outcome.err.find(sentence), std::string::npos) << outcome.err;
        EXPECT_EQ(std::count(outcome.err.begin(), outcome.err.end(), '\n'), 1) << outcome.err;
        EXPECT_EQ(compare({a, file, "--force", "--fail-above", "5"}).exitCode,
                  forcible ? exitOk : exitUsage);
    };
    json other = runs(5, 50);
    other[2]["provenance"]["device"] = "e";
    refused(other, "b.json: [2] e; --force", true);
    other = runs(5, 50);
    for (json& one : other)
        one["scene"]["name"] = "field";
    refused(other, "\"field\"", true);
    other = runs(5, 50);
    for (json& one : other)
        one["variants"][0]["time"]["frames"] = 20;
    refused(other, "has frames 60,", true);
    other = runs(5, 50);
    other[4]["provenance"]["commit"] = "later"; // runs of one side differ
    refused(other, "has commit c,", true);
    other = run(50);
    other["schema"] = "candelabra profile 99";
    refused(other, "b.json: schema: must be \"candelabra profile 1\"");
    other = run(50);
    other["variants"].push_back(other["variants"][0]);
    refused(other, "a run with --ab");
    other = run(50);
    other["variants"][0]["time"]["passes"][1]["medianMs"] = "fast";
    refused(other, "medianMs: must be a number");
    refused(json::array(), "holds no run");
    refused(1, "must be an object");

    EXPECT_EQ(compare({a}).exitCode, exitUsage);
    EXPECT_EQ(compare({a, "no-such.json"}).exitCode, exitUsage);
    EXPECT_EQ(compare({a, a, "--a", a}).exitCode, exitUsage);
    EXPECT_EQ(compare({a, a, "--fail-above", "-1"}).exitCode, exitUsage);
    EXPECT_EQ(compare({a, write("b.json", runs(2, 50)), "--paired"}).exitCode, exitUsage);
}
