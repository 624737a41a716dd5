// SPDX-License-Identifier: Apache-2.0
// The search for the number of lights of a frame rate, with computed times in place of measured
// ones, and its sentences.
#include <cmath>
#include <functional>
#include <optional>
#include <random>
#include <set>

#include <gtest/gtest.h>

#include "measure/frame_rate.h"
#include "measure/light_search.h"

namespace candelabra::app
{
namespace
{

using TimeOf = std::function<double(double lights)>;

struct Searched {
    LightSearch result;
    uint32_t measured = 0;
};

// Searches with times that other programs disturb: a random share up to `noise` is added, and to
// every measurement in `late` (counted from 0) another half.
Searched searched(const TimeOf& timeOf, double ms, uint32_t most = 1 << 20, double noise = 0,
                  unsigned seed = 1, const std::set<uint32_t>& late = {})
{
    std::mt19937 random(seed);
    Searched out;
    out.result = searchLights({.ms = ms, .start = 1000, .most = most}, [&](uint32_t lights) {
        const double more = noise * (double(random()) / double(random.max()));
        const double held = late.contains(out.measured++) ? 1.5 : 1;
        return std::optional(timeOf(lights) * (1 + more) * held);
    });
    return out;
}

// Shapes of time against lights: as with a fixed number of lights per pixel, with lists, with
// lights that all reach every pixel, and with lists that no longer fit.
const TimeOf shapes[] = {
    [](double n) { return 60 + 8 * std::log2(n); },
    [](double n) { return 60 + 5 * std::log2(n) + 3e-4 * n; },
    [](double n) { return 20 + 0.05 * n; },
    [](double n) { return 90 + 1e-4 * n + (n > 300'000 ? 5000 : 0); },
};

TEST(LightSearch, FindsTheNumberThatFillsTheFrame)
{
    for (const TimeOf& timeOf : shapes)
        for (const double lights : {40.0, 1500.0, 20'000.0, 200'000.0}) {
            const double ms = timeOf(lights);
            const auto [result, measured] = searched(timeOf, ms);
            ASSERT_TRUE(result.lights) << lights;
            EXPECT_LE(timeOf(*result.lights), ms) << lights;
            EXPECT_GE(timeOf(*result.lights), 0.95 * ms) << lights;
            EXPECT_LE(measured, maxSearched);
            EXPECT_FALSE(result.isMost);
        }
}

TEST(LightSearch, FindsTheEndBeforeAJump)
{
    for (const double ms : {122.0, 130.0, 1000.0, 2000.0}) {
        const auto [result, measured] = searched(shapes[3], ms);
        EXPECT_LE(result.lights.value(), 300'000u) << ms;
        EXPECT_GE(*result.lights, 260'000u) << ms;
    }
}

TEST(LightSearch, NoiseMovesItLittle)
{
    int good = 0, all = 0;
    for (const TimeOf& timeOf : shapes)
        for (unsigned seed = 1; seed <= 50; ++seed, ++all) {
            const double ms = timeOf(50'000);
            const auto [result, measured] = searched(timeOf, ms, 1 << 20, 0.03, seed);
            EXPECT_LE(measured, maxSearched);
            ASSERT_TRUE(result.lights);
            EXPECT_LE(timeOf(*result.lights), ms);
            good += timeOf(*result.lights) > 0.95 * ms;
        }
    EXPECT_GE(good, all * 98 / 100);
}

TEST(LightSearch, OneLateMeasurementDoesNotDecide)
{
    for (const TimeOf& timeOf : shapes)
        for (const double lights : {1500.0, 9000.0, 50'000.0, 150'000.0})
            for (uint32_t late = 0; late < maxSearched - 2; ++late) {
                const double ms = timeOf(lights);
                const auto [result, measured] = searched(timeOf, ms, 1 << 20, 0, 1, {late});
                ASSERT_TRUE(result.lights);
                EXPECT_LE(timeOf(*result.lights), ms);
                EXPECT_GE(timeOf(*result.lights), 0.96 * ms) << lights << ", " << late;
                // Two in a row cost measurements, but do not end the search early.
                const auto two = searched(timeOf, ms, 1 << 20, 0, 1, {late, late + 1}).result;
                EXPECT_GE(timeOf(two.lights.value()), 0.9 * ms) << lights << ", " << late;
            }
}

TEST(LightSearch, SaysIfNotEvenOneLightIsFastEnough)
{
    const auto [result, measured] = searched([](double n) { return 21 + 1e-4 * n; }, 16.7);
    EXPECT_FALSE(result.lights);
    EXPECT_EQ(result.tried.front().lights, 1u);
    EXPECT_LE(measured, 4u);
    // A single light is measured again before it is given up.
    EXPECT_EQ(searched([](double n) { return 10 + n; }, 12, 1 << 20, 0, 1, {2}).result.lights, 2u);
}

TEST(LightSearch, StopsAtTheMostLights)
{
    const auto [result, measured] = searched(shapes[0], 1e4, 70'000);
    EXPECT_EQ(result.lights, 70'000u);
    EXPECT_TRUE(result.isMost);
    EXPECT_EQ(result.tried.back().lights, 70'000u);
    EXPECT_LE(measured, 5u);
    EXPECT_FALSE(lightsWithin(result.tried, 1e4));
}

TEST(LightSearch, FindsTheFewestLightsOfAScene)
{
    const auto search = [](double ms) {
        return searchLights({.ms = ms, .start = 1000, .most = 1 << 20},
                            [&](uint32_t lights) -> std::optional<double> {
                                if (lights < 60)
                                    return {};
                                return 10 + 0.1 * lights;
                            });
    };
    EXPECT_NEAR(search(30).lights.value(), 200, 10); // 1000 lights are too slow, 31 impossible
    EXPECT_FALSE(search(12).lights);
    EXPECT_LT(search(12).tried.front().lights, 100u);
}

TEST(LightSearch, InterpolatesBetweenWhatItTried)
{
    const LightTime tried[] = {{100, 10}, {1000, 20}, {1500, 19}, {4000, 40}};
    EXPECT_NEAR(lightsWithin(tried, 38).value(), 3738, 1);
    EXPECT_FALSE(lightsWithin(tried, 50));
    EXPECT_FALSE(lightsWithin(tried, 9));
    EXPECT_EQ(roundedDown(53'999, 2), 53'000u);
    EXPECT_EQ(roundedDown(53'000, 2), 53'000u);
    EXPECT_EQ(roundedDown(7.9, 2), 7u);
    EXPECT_EQ(roundedDown(0.5, 2), 0u);
}

const FrameCondition hall{.scene = "hall", .device = "a GPU", .size = {1920, 1080}};
const LightSearch found{.tried = {{1, 8}, {53'000, 16.5}, {200'000, 30}}, .lights = 53'000};

TEST(FrameRate, SentenceOfASearch)
{
    const FrameCost cost{53'000, 16.5, 9.1, 7.25, 8.04};
    EXPECT_EQ(searchSentence(60, found, cost, hall, ""),
              "53,000 sphere lights at 60 frames/s (hall, 1920x1080, 8 lights per pixel, no "
              "shadows, on a GPU): lighting 9.10 of 16.7 ms, raster pass 7.25 ms, the rest 0.150 "
              "ms; lighting is the limit; a tenth more time would carry about 66,000");
    FrameCondition room{.scene = "rooms", .device = "D", .size = {64, 36}, .shadows = 64};
    room.addedLights = true;
    EXPECT_EQ(searchSentence(0.5, {.tried = {{9, 2}}, .lights = 9, .isMost = true},
                             {9, 1000, 100, 850, 2}, room, ""),
              "9 added sphere lights, as many as there can be on this device, at 1 frames/s, more "
              "than 0.5 (rooms, 64x36, 2 lights per pixel, shadows 64, on D): lighting 100 of 2000 "
              "ms, raster pass 850 ms, the rest 50.0 ms; the raster pass is the limit");
}

TEST(FrameRate, SentenceOfASearchThatFoundNone)
{
    const LightSearch none{.tried = {{1, 22}}};
    EXPECT_EQ(searchSentence(60, none, {1, 22, 0.5, 21, 0.5}, hall, ""),
              "not even one light at 60 frames/s (hall, 1920x1080, 0.5 lights per pixel, no "
              "shadows, on a GPU): the raster pass alone takes 21.0 ms of 16.7");
    const std::string sentence =
        searchSentence(60, none, {62, 22, 15, 6, 30}, hall, "30 cannot be reached");
    EXPECT_TRUE(sentence.starts_with("not even 62 sphere lights at 60 frames/s")) << sentence;
    EXPECT_TRUE(sentence.ends_with("lighting is the limit; fewer were not tried: 30 cannot be "
                                   "reached"))
        << sentence;
}

TEST(FrameRate, SentenceOfACount)
{
    EXPECT_EQ(costSentence({16'000, 325, 210, 90, 8}, hall),
              "at 16,000 sphere lights: 3.08 frames/s (hall, 1920x1080, 8 lights per pixel, no "
              "shadows, on a GPU); lighting 210 of 325 ms, raster pass 90.0 ms, the rest 25.0 ms; "
              "lighting is the limit");
    EXPECT_EQ(costSentence({1, 0, 0, 0, 1}, hall),
              "at 1 sphere light: the frame rate is unknown, because a GPU has no timestamps");
}

} // namespace
} // namespace candelabra::app
