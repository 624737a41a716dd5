// SPDX-License-Identifier: Apache-2.0
// Tests the tables of the benchmarks on made-up results.

#include <gtest/gtest.h>

#include "io/statistics.h"
#include "measure/accuracy/kernel_level.h"
#include "measure/culling/culling.h"

using namespace candelabra;
using namespace candelabra::app;

namespace
{

Contender contender(const char* name, const std::vector<double>& frames)
{
    Contender out{.name = name};
    for (const double ms : frames) {
        const PassTime pass{"shade_tiles", ms};
        out.times.add({&pass, 1});
    }
    return out;
}

// Candelabra takes about 10 ms, froxels twice as long.
CullingPoint point()
{
    std::vector<double> engine, froxels;
    for (int i = 0; i < 7; ++i) {
        engine.push_back(10 + 0.01 * i);
        froxels.push_back(2 * (10 + 0.02 * i));
    }
    CullingPoint out{
        .scene = "hall", .size = {480, 270}, .lights = 4000, .overlaps = 8, .contenders = {}};
    out.contenders = {contender(engineName, engine), contender(tilesName, {40, 40, 40}),
                      contender(froxelsName, froxels), contender(bruteName, {200, 200, 200}),
                      contender(floorName, engine)};
    return out;
}

bool has(const std::string& text, const std::string& part)
{
    return text.find(part) != std::string::npos;
}

} // namespace

TEST(ResultTable, HasUnitsRulesAndMarks)
{
    Table table({"way", {"time", "ms"}, Column::words("which")}, "A < B");
    table.add({"quiet", "1.5", "x"});
    table.rule();
    table.add({"loud", "12.25", "longer"}, {.noisy = true});
    EXPECT_EQ(table.text(), "A < B\n"
                            "way     time ms  which\n"
                            "------  -------  ------\n"
                            "quiet       1.5  x\n"
                            "------  -------  ------\n"
                            "loud ~    12.25  longer\n" +
                                noisyLegend() + "\n");
}

TEST(ResultTable, NoisyMeansASpreadOfTheMiddleHalf)
{
    EXPECT_FALSE(isNoisy({100, 101, 102, 103, 104}));
    EXPECT_TRUE(isNoisy({100, 101, 110, 120, 121}));
    EXPECT_FALSE(isNoisy({100, 100, 100, 100, 500})); // one outlier is no noise of most
    EXPECT_FALSE(isNoisy({7}));
}

// The ratio and its interval are of the same quotient.
TEST(ResultTable, CullingHasTheRatioWithinItsInterval)
{
    const std::string text = textOf(cullingTables({point()}));
    EXPECT_TRUE(has(text, "95% interval")) << text;
    EXPECT_TRUE(has(text, " 0.50  0.50 .. 0.50 ")) << text;
    const Json json = cullingJson({}, {point()});
    EXPECT_NEAR(json["points"][0]["ratioToBestBaselineLow"], 0.5, 0.01);
    EXPECT_NEAR(json["points"][0]["ratioToBestBaselineHigh"], 0.5, 0.01);
    CullingPoint few = point();
    for (Contender& c : few.contenders)
        c = contender(c.name.c_str(),
                      c.name == froxelsName ? std::vector{20.0} : std::vector{10.0});
    EXPECT_FALSE(has(textOf(cullingTables({few})), ".."));
    EXPECT_TRUE(cullingJson({}, {few})["points"][0]["ratioToBestBaselineLow"].is_null());
}

TEST(ResultTable, WhatWasDrawnOnceHasNoInterval)
{
    CullingPoint once = point();
    once.contenders[3] = contender(bruteName, {200});
    const PairedRatio r = once.toEngine(bruteName);
    EXPECT_NEAR(r.median, 200 / 10.03, 1e-9);
    EXPECT_FALSE(r.isKnown());
    EXPECT_TRUE(once.toEngine(froxelsName).isKnown());
}

TEST(ResultTable, TimesThatNoiseHidesHaveNoNumber)
{
    KernelPoint hidden{.lightType = CND_LIGHT_SPHERE, .method = CND_SPECULAR_CONIC};
    hidden.cases.push_back({.evaluationCase = EvaluationCase::Above,
                            .both = {.medianNs = -24.2, .roundsNs = {-24.2, -30, 5}},
                            .specularNs = {}});
    KernelLevel level;
    level.points.push_back(hidden);
    const std::string text = kernelTables(level)[1].text();
    EXPECT_TRUE(has(text, "below noise")) << text;
    EXPECT_FALSE(has(text, "-24.2")) << text;
}
