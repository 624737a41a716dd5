// SPDX-License-Identifier: Apache-2.0
// Tests that the record of the fit (tools/bench/results/conic-*.csv) was made with the constants
// that the shaders have, that each constant is near its optimum, and that the parts of the fit
// compute what they should.
#include <algorithm>
#include <cmath>
#include <functional>
#include <map>
#include <numbers>

#include <gtest/gtest.h>

#include "fit/conic_objective.h"
#include "harness/csv.h"
#include "harness/paths.h"
#include "shared/conic_constants.h"

namespace candelabra::test
{
namespace
{

auto record(const char* table)
{
    return csvRows(sourcePath(std::string("tools/bench/results/") + table));
}

const fit::ConicObjective& checkObjective()
{
    static const fit::ConicObjective objective(fit::drawCheckSamples());
    return objective;
}

// Returns the largest error of one group (conic, F0 = 1), in percent.
double largestErrorOf(const app::SampleSet& set, uint32_t group)
{
    app::SampleSet alone{.lightType = set.lightType, .groups = 1};
    for (size_t i = 0; i < set.samples.size(); ++i)
        if (set.samples[i].group == group) {
            alone.receivers.push_back(set.receivers[i]);
            alone.lights.push_back(set.lights[i]);
            alone.samples.push_back(set.samples[i]);
            alone.samples.back().group = 0;
        }
    return fit::ConicObjective(std::move(alone)).residuals({}).conic.mirror.all.largest;
}

void expectRecorded(const std::map<std::string, std::string>& row, const char* column,
                    double figure)
{
    // The truth is integrated to a relative error of 1e-5.
    EXPECT_NEAR(figure, std::stod(row.at(column)), 1e-3 * figure) << column;
}

} // namespace

TEST(ConicFit, RecordHoldsTheCommittedConstants)
{
    std::map<std::string, float> recorded;
    for (const auto& row : record("conic-constants.csv"))
        recorded[row.at("constant")] = std::stof(row.at("shaders"));
    EXPECT_EQ(recorded.size(), fit::conicConstants().size());
    for (const fit::ConicConstant& c : fit::conicConstants()) {
        ASSERT_TRUE(recorded.contains(c.name)) << c.name;
        EXPECT_EQ(recorded[c.name], float(c.committed)) << c.name;
    }
}

TEST(ConicFit, RecordHoldsTheirResidualsOnAFewGroups)
{
    const fit::ConicResiduals residuals = checkObjective().residuals({});
    const double cost = checkObjective().cost({});
    int compared = 0;
    for (const auto& row : record("conic-fit.csv")) {
        if (row.at("groups") != "check")
            continue;
        const fit::MethodFigures& method =
            row.at("method") == "conic" ? residuals.conic : residuals.conicFull;
        const auto& fresnel = row.at("fresnel") == "fresnel1" ? method.mirror : method.dielectric;
        const fit::ErrorFigures& figures = row.at("where") == "all" ? fresnel.all : fresnel.above;
        expectRecorded(row, "meanPercent", figures.mean);
        expectRecorded(row, "rmsPercent", figures.rms);
        expectRecorded(row, "p99Percent", figures.p99);
        expectRecorded(row, "maxPercent", figures.largest);
        expectRecorded(row, "cost", cost);
        ++compared;
    }
    EXPECT_EQ(compared, 8);
}

// Half or twice the value of any constant, with the others unchanged, changes the cost and lowers
// it by less than 1%. (Some constants matter little: on these few groups, changing one of them
// lowers the cost by 0.4%.)
TEST(ConicFit, EveryConstantIsNearItsOptimum)
{
    const double cost = checkObjective().cost({});
    for (const fit::ConicConstant& c : fit::conicConstants())
        for (const double factor : {0.5, 2.0}) {
            fit::ConicConstants changed;
            changed.*c.value *= factor;
            const double changedCost = checkObjective().cost(changed);
            EXPECT_NE(changedCost, cost) << c.name << " times " << factor;
            EXPECT_GT(changedCost, 0.99 * cost) << c.name << " times " << factor;
        }
}

TEST(ConicFit, ConstantsThatTheFormulasDoNotAllowCostInfinitelyMuch)
{
    fit::ConicConstants pole;
    pole.CONIC_TAIL = 1;
    EXPECT_TRUE(std::isinf(checkObjective().cost(pole)));
}

TEST(ConicFit, HardGroupsAreThoseWithTheLargestErrors)
{
    const std::vector<uint32_t> groups = checkObjective().worstGroups({}, 3);
    ASSERT_EQ(groups.size(), 3u);
    const app::SampleSet& set = checkObjective().set();
    std::vector<double> errors;
    for (uint32_t group = 0; group < set.groups; ++group)
        errors.push_back(largestErrorOf(set, group));
    std::sort(errors.begin(), errors.end(), std::greater<>());
    EXPECT_GT(errors[0], errors[2]); // otherwise the order could not be wrong
    for (size_t i = 0; i < groups.size(); ++i)
        EXPECT_EQ(largestErrorOf(set, groups[i]), errors[i]) << i;
    // With seed 13 the `others` are drawn with seed 14: they are the groups of checkObjective.
    const fit::ConicObjective hard(
        fit::drawTrainingSamples({.groups = 1, .others = 60, .hard = 1, .seed = 13}));
    EXPECT_EQ(hard.set().groups, 2u);
    EXPECT_GE(hard.residuals({}).conic.mirror.all.largest,
              checkObjective().residuals({}).conic.mirror.all.largest * (1 - 1e-9));
}

// The largest error on [0, 1].
double largestError(const std::function<double(double)>& approximation,
                    const std::function<double(double)>& exact)
{
    double largest = 0;
    for (int i = 0; i <= 4000; ++i)
        largest = std::max(largest, std::abs(approximation(i / 4000.0) - exact(i / 4000.0)));
    return largest;
}

// The errors are those that shaders/shared/conic_constants.h states.
TEST(ConicFit, PolynomialsErrByWhatTheShadersSay)
{
    const auto arcTangent = [](double t) {
        double sum = 0;
        for (const double c :
             {-gpu::CONIC_ATAN_T15, gpu::CONIC_ATAN_T13, -gpu::CONIC_ATAN_T11, gpu::CONIC_ATAN_T9,
              -gpu::CONIC_ATAN_T7, gpu::CONIC_ATAN_T5, -gpu::CONIC_ATAN_T3})
            sum = (sum + c) * t * t;
        return t + t * sum;
    };
    EXPECT_LE(largestError(arcTangent, [](double t) { return std::atan(t); }), 5.5e-8);
    const auto segment = [](double u) {
        return u * std::sqrt(u) *
               (gpu::CONIC_SEGMENT - u * (gpu::CONIC_SEGMENT_U + gpu::CONIC_SEGMENT_U2 * u));
    };
    // The part of a circle of radius 1 below the chord at x = 2 u - 1, over the whole area.
    const auto area = [](double u) {
        const double x = 2 * u - 1;
        return (std::acos(-x) + x * std::sqrt(1 - x * x)) / std::numbers::pi;
    };
    EXPECT_NEAR(largestError(segment, area), 0.0147, 5e-5);
}

} // namespace candelabra::test
