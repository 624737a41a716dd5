// SPDX-License-Identifier: Apache-2.0
#include <random>

#include <gtest/gtest.h>

#include "io/statistics.h"

using namespace candelabra::app;

TEST(Statistics, SpreadOfKnownValues)
{
    std::vector<double> values;
    for (int i = 100; i >= 1; --i)
        values.push_back(i);
    const Spread s = spreadOf(values);
    EXPECT_EQ(s.min, 1);
    EXPECT_EQ(s.median, 50.5);
    EXPECT_EQ(s.p95, 95);
    EXPECT_EQ(s.p99, 99);
    EXPECT_NEAR(s.cv, 29.011492 / 50.5, 1e-6);
    const Spread one = spreadOf({3});
    EXPECT_EQ(one.min, 3);
    EXPECT_EQ(one.p99, 3);
    EXPECT_EQ(one.cv, 0);
}

TEST(Statistics, ADifferenceIsAboveNoiseIfThreeQuartersArePositive)
{
    EXPECT_EQ(medianAboveNoise(differences(std::vector{5.0, 6.0, 7.0}, std::vector{4.0, 4.0, 4.0})),
              2);
    EXPECT_EQ(medianAboveNoise({-1, 2, 3, 4, 5}), 3);
    EXPECT_FALSE(medianAboveNoise({-2, -1, 3, 4, 5}));
    EXPECT_FALSE(medianAboveNoise({0}));
}

// The ranks of the interval are those in published tables: six pairs are the least that give an
// interval.
TEST(Statistics, IntervalOfTheMedianHasTheTabulatedRanks)
{
    const auto interval = [](size_t n) {
        std::vector<double> a(n, 1.0), b(n);
        for (size_t i = 0; i < n; ++i)
            b[i] = double(i + 1);
        return pairedRatio(a, b);
    };
    EXPECT_EQ(interval(5).low, 0);
    EXPECT_EQ(interval(6).low, 1);
    EXPECT_EQ(interval(6).high, 6);
    EXPECT_EQ(interval(10).low, 2);
    EXPECT_EQ(interval(10).high, 9);
    EXPECT_EQ(interval(20).low, 6);
    EXPECT_EQ(interval(20).high, 15);
    EXPECT_EQ(interval(100).low, 40);
    EXPECT_EQ(interval(100).high, 61);
    EXPECT_NEAR(interval(2000).low, 956, 1);
}

TEST(Statistics, NoiseIsCalledADifferenceInAtMostOneTrialOfTwenty)
{
    std::mt19937 random(1);
    std::lognormal_distribution<double> noise(0, 0.2); // noise of a busy machine: skewed
    int alarms = 0, found = 0;
    constexpr int trials = 400;
    for (int trial = 0; trial < trials; ++trial) {
        std::vector<double> a(40), b(40), slower(40);
        for (size_t i = 0; i < a.size(); ++i) {
            a[i] = noise(random);
            b[i] = noise(random);
            slower[i] = 1.2 * noise(random);
        }
        const PairedRatio same = pairedRatio(a, b);
        alarms += same.isFaster() || same.isSlower();
        found += pairedRatio(a, slower).isSlower();
    }
    EXPECT_LE(alarms, trials / 20);
    EXPECT_GE(found, trials / 2);
}

TEST(Statistics, PairsWithoutATimeSayNothing)
{
    const std::vector<double> a{0, 1, 1, 1, 1, 1, 1, 0}, b{5, 2, 2, 2, 2, 2, 2, 0};
    const PairedRatio r = pairedRatio(a, b);
    EXPECT_EQ(r.median, 2);
    EXPECT_EQ(r.low, 2);
    EXPECT_EQ(r.high, 2);
    EXPECT_TRUE(r.isSlower());
    const PairedRatio none = pairedRatio(std::vector<double>{0}, std::vector<double>{0});
    EXPECT_FALSE(none.isFaster() || none.isSlower());
}
