// SPDX-License-Identifier: Apache-2.0
// Tests that each fitted constant of the closed form is near its optimum, and that the parts of the
// fit compute what they should.
#include <cmath>

#include <gtest/gtest.h>

#include "fit/conic_objective.h"
#include "fit/polynomials.h"

namespace candelabra::test
{
namespace
{

const fit::ConicObjective& checkObjective()
{
    static const fit::ConicObjective objective(fit::drawCheckSamples());
    return objective;
}

} // namespace

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
    // With seed 13 the `others` are drawn with seed 14: they are the groups of checkObjective.
    const fit::ConicObjective hard(
        fit::drawTrainingSamples({.groups = 1, .others = 60, .hard = 1, .seed = 13}));
    EXPECT_EQ(hard.set().groups, 2u);
    EXPECT_GE(hard.residuals({}).conic.mirror.all.largest,
              checkObjective().residuals({}).conic.mirror.all.largest * (1 - 1e-9));
}

// The best straight line for x^2 on [0, 1] is x - 1 / 8. Its error is 1 / 8 at both ends and in the
// middle.
TEST(ConicFit, MinimaxFindsTheBestLine)
{
    const fit::Minimax line = fit::minimax(
        {[](double) { return 1.0; }, [](double x) { return x; }}, [](double x) { return x * x; }, 0,
        1);
    EXPECT_NEAR(line.largestError, 0.125, 1e-6);
    EXPECT_NEAR(line.coefficients.at(0), -0.125, 1e-6);
    EXPECT_NEAR(line.coefficients.at(1), 1, 1e-6);
}

// The errors are those that shaders/shared/conic_constants.h states.
TEST(ConicFit, PolynomialsErrByWhatTheShadersSay)
{
    const fit::PolynomialFit arcTangent = fit::fitArcTangent(), segment = fit::fitCircleSegment();
    EXPECT_LE(arcTangent.committedError, 5.5e-8);
    EXPECT_NEAR(arcTangent.best.largestError, 4.92e-8, 1e-10);
    EXPECT_NEAR(arcTangent.best.coefficients.at(0), -double(gpu::CONIC_ATAN_T3), 2e-8);
    EXPECT_NEAR(segment.committedError, 0.0147, 5e-5);
    EXPECT_NEAR(segment.best.largestError, 0.0080, 5e-5);
}

} // namespace candelabra::test
