// SPDX-License-Identifier: Apache-2.0
// Simulated runs: how often noise is reported as a difference, and how often a difference is found.
#include <cmath>
#include <random>

#include <gtest/gtest.h>

#include "measure/profile/run_comparison.h"

using namespace candelabra::app;

namespace
{

constexpr size_t passes = 14; // passes of a frame of the program, and its three sums

// Simulates a machine whose overall speed varies between runs, and each pass on top; skewed, as
// times are.
class Machine
{
public:
    Machine(double ofRun, double ofPass) : run_(0, ofRun), pass_(0, ofPass) {}

    // `change`: time of pass 3 on side B relative to side A. `together`: runs of A and B that are
    // paired share the speed of the machine.
    std::vector<RunQuantity> measure(size_t runs, double change, bool together = false)
    {
        std::vector<RunQuantity> out(passes);
        for (size_t run = 0; run < runs; ++run) {
            const double speedA = run_(random_), speedB = together ? speedA : run_(random_);
            for (size_t i = 0; i < passes; ++i) {
                out[i].a.push_back(double(i + 1) * speedA * pass_(random_));
                out[i].b.push_back((i == 3 ? change : 1) * double(i + 1) * speedB * pass_(random_));
            }
        }
        return out;
    }

private:
    std::mt19937 random_{7};
    std::lognormal_distribution<double> run_, pass_;
};

bool finds(const std::vector<RunRatio>& rows)
{
    for (const RunRatio& row : rows)
        if (row.isFaster() || row.isSlower())
            return true;
    return false;
}

} // namespace

TEST(RunComparison, OneComparisonOfTwentyRaisesAFalseAlarm)
{
    constexpr int trials = 400;
    Machine machine(0.05, 0.02);
    int unpaired = 0, paired = 0;
    for (int trial = 0; trial < trials; ++trial) {
        unpaired += finds(compareRuns(machine.measure(5, 1), false));
        paired += finds(compareRuns(machine.measure(6, 1, true), true));
    }
    // 20 are expected; 33 or more have a probability of 1 in 300.
    EXPECT_LT(unpaired, 33);
    EXPECT_LT(paired, 33);
}

TEST(RunComparison, FivePercentAreFoundInFiveRuns)
{
    constexpr int trials = 200;
    Machine calm(0.003, 0.006), drifting(0.1, 0.004);
    int found = 0, foundPaired = 0;
    for (int trial = 0; trial < trials; ++trial) {
        const RunRatio row = compareRuns(calm.measure(5, 1.05), false)[3];
        found += row.isSlower();
        EXPECT_EQ(row.isSlower() || row.isFaster(), row.p <= 0.05);
        foundPaired += compareRuns(drifting.measure(8, 1.05, true), true)[3].isSlower();
    }
    EXPECT_GE(found, trials * 19 / 20);
    EXPECT_GE(foundPaired, trials * 19 / 20);
}

TEST(RunComparison, NoiseWiderThanTheChangeIsNotCalledOne)
{
    Machine loud(0.05, 0.3);
    const RunRatio row = compareRuns(loud.measure(5, 1.05), false)[3];
    EXPECT_FALSE(row.isFaster() || row.isSlower());
    EXPECT_GT(row.high - row.low, 0.05);
    EXPECT_GT(row.p, 0.05);
}

// If there are too many runs for all permutations, random ones are drawn, the same every time.
TEST(RunComparison, ManyRunsNarrowTheIntervalAndRepeat)
{
    Machine machine(0.01, 0.02);
    const auto few = compareRuns(machine.measure(5, 1.1), false);
    const std::vector<RunQuantity> runs = machine.measure(30, 1.1);
    const auto many = compareRuns(runs, false), again = compareRuns(runs, false);
    EXPECT_LT(many[3].high - many[3].low, few[3].high - few[3].low);
    EXPECT_LT(many[3].low, 1.1);
    EXPECT_GT(many[3].high, 1.1);
    EXPECT_EQ(many[3].low, again[3].low);
    EXPECT_TRUE(compareRuns(runs, true)[3].isSlower());
}

TEST(RunComparison, TooFewRunsAndEqualOnesTellNothing)
{
    const std::vector<RunQuantity> three{{{1, 1.01, 1.02}, {2, 2.01, 2.02}}};
    const RunRatio few = compareRuns(three, false)[0];
    EXPECT_NEAR(few.ratio, 1.99, 0.01);
    EXPECT_EQ(few.low, 0);
    EXPECT_EQ(few.p, 1);
    const std::vector<RunQuantity> equal{{{1, 1, 1, 1, 1, 1}, {1, 1, 1, 1, 1, 1}}};
    for (const bool paired : {false, true}) {
        const RunRatio same = compareRuns(equal, paired)[0];
        EXPECT_EQ(same.ratio, 1);
        EXPECT_FALSE(same.isFaster() || same.isSlower());
    }
    EXPECT_TRUE(compareRuns({}, false).empty());
}

// This test simulates runs whose true ratio is the limit. Of 400 decisions about one row, 10 (2.5%)
// are expected to be "slower", and 10 "not slower". Either is 20 or more with a probability of 1 in
// 300.
TEST(RunDecisions, AtTheLimitOneOfFortyIsWrongOnEitherSide)
{
    constexpr int trials = 400;
    Machine machine(0.003, 0.02);
    for (const bool paired : {false, true})
        for (const double bound : {0.0, 0.05}) {
            int slower = 0, notSlower = 0;
            for (int trial = 0; trial < trials; ++trial) {
                const auto runs = machine.measure(6, 1 + bound);
                const RunDecision d = decideRuns(runs[3], paired, bound);
                slower += d.slower == Slower::Yes;
                notSlower += d.slower == Slower::No;
                EXPECT_LE(d.ratio.low, d.ratio.ratio);
                EXPECT_GE(d.ratio.high, d.ratio.ratio);
            }
            EXPECT_LT(slower, 20) << paired << bound;
            EXPECT_LT(notSlower, 20) << paired << bound;
            EXPECT_GT(slower + notSlower, 5) << paired << bound; // not needlessly cautious
        }
}

TEST(RunDecisions, FarFromTheLimitTheyAreRight)
{
    constexpr int trials = 100;
    Machine machine(0.003, 0.006);
    int slower = 0, notSlower = 0;
    for (int trial = 0; trial < trials; ++trial) {
        slower += decideRuns(machine.measure(6, 1.1)[3], false, 0.05).slower == Slower::Yes;
        notSlower += decideRuns(machine.measure(6, 1.0)[3], false, 0.05).slower == Slower::No;
    }
    EXPECT_GE(slower, 95);
    EXPECT_GE(notSlower, 95);
}

// A measured change decides from `smallestSeen` on.
TEST(RunDecisions, TheSmallestSlowdownSeenIsWhereTheyTurn)
{
    const RunQuantity runs{{1, 1.01, 1.02, 0.99, 0.98, 1}, {1.02, 0.99, 1, 1.01, 0.99, 1}};
    for (const bool paired : {false, true}) {
        const RunDecision level = decideRuns(runs, paired, 0.01);
        EXPECT_EQ(level.slower, Slower::CannotTell);
        ASSERT_GT(level.smallestSeen, 1.01);
        for (const double factor : {0.999, 1.001}) {
            RunQuantity changed = runs;
            for (double& b : changed.b)
                b *= factor * level.smallestSeen / level.ratio.ratio;
            EXPECT_EQ(decideRuns(changed, paired, 0.01).slower,
                      factor > 1 ? Slower::Yes : Slower::CannotTell)
                << factor;
        }
    }
}

TEST(RunDecisions, TooFewRunsCannotTellAndEqualOnesAreNotSlower)
{
    const RunDecision few = decideRuns({{1, 1, 1}, {9, 9, 9}}, false, 0);
    EXPECT_EQ(few.slower, Slower::CannotTell);
    EXPECT_FALSE(std::isfinite(few.smallestSeen));
    for (const double bound : {0.0, 0.05})
        EXPECT_EQ(decideRuns({{1, 1, 1, 1}, {1, 1, 1, 1}}, false, bound).slower, Slower::No);
}
