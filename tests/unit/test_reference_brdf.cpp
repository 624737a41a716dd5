// SPDX-License-Identifier: Apache-2.0
#include <cmath>
#include <stdexcept>

#include <gtest/gtest.h>

#include "harness/constants.h"
#include "reference/brdf.h"
#include "test_reference_support.h"

namespace candelabra::test
{

using namespace candelabra::reference;

namespace
{

constexpr double alphas[] = {0.002, 0.01, 0.05, 0.2, 0.5, 1.0};

} // namespace

TEST(ReferenceBrdf, distributionIsNormalised)
{
    WorstCase worst;
    for (const double alpha : alphas) {
        const double sum =
            integrate(0, 1, [=](double NoH) { return 2 * pi * ggxD(NoH, alpha) * NoH; });
        worst.add(std::abs(sum - 1), "alpha", alpha);
    }
    EXPECT_TRUE(worst.within(1e-9));
}

// Projected-area normalisation of masking (Heitz 2014): the microfacets that the eye sees cover
// exactly the projected area of the surface. This ties Lambda to D.
TEST(ReferenceBrdf, visibleNormalsCoverTheProjectedSurface)
{
    WorstCase worst;
    for (const double alpha : {0.05, 0.2, 0.5, 1.0}) {
        for (const double NoV : {0.05, 0.3, 0.7, 0.99}) {
            const double sinV = std::sqrt(1 - NoV * NoV);
            const auto ring = [=](double NoH) {
                const double sinH = std::sqrt(1 - NoH * NoH);
                return ggxD(NoH, alpha) * integratePositivePart(NoV * NoH, sinV * sinH);
            };
            // Half vectors with NoH below sinV partly face away from the eye, which makes a kink in
            // the integrand.
            const double seen = integrate(0, sinV, ring) + integrate(sinV, 1, ring);
            const double masked = seen / (1 + smithLambda(NoV, alpha));
            worst.add(std::abs(masked / NoV - 1), "alpha", alpha, "NoV", NoV);
        }
    }
    EXPECT_TRUE(worst.within(1e-9));
}

TEST(ReferenceBrdf, isReciprocal)
{
    WorstCase worst;
    const glm::dvec3 n(0, 0, 1);
    const glm::dvec3 v = glm::normalize(glm::dvec3(0.3, -0.2, 0.9));
    for (const glm::dvec3 raw :
         {glm::dvec3(1, 0, 0.1), glm::dvec3(-1, 1, 2), glm::dvec3(0, 3, 1)}) {
        const glm::dvec3 l = glm::normalize(raw);
        for (const double alpha : alphas) {
            const SpecularBrdf forth = ggxBrdf(n, v, l, alpha);
            const SpecularBrdf back = ggxBrdf(n, l, v, alpha);
            worst.add(std::abs(forth.value / back.value - 1), "alpha", alpha);
            worst.add(std::abs(forth.schlickWeight - back.schlickWeight), "alpha", alpha);
        }
    }
    EXPECT_TRUE(worst.within(1e-9));
}

// At normal incidence D = 1 / (pi alpha^2) and there is no shadowing, so D V = 1 / (4 pi alpha^2).
TEST(ReferenceBrdf, normalIncidenceIsTheClosedForm)
{
    const glm::dvec3 n(0, 1, 0);
    for (const double alpha : alphas) {
        const SpecularBrdf brdf = ggxBrdf(n, n, n, alpha);
        EXPECT_NEAR(brdf.value * 4 * pi * alpha * alpha, 1, 1e-12) << alpha;
        EXPECT_EQ(brdf.schlickWeight, 0) << alpha;
    }
    EXPECT_DOUBLE_EQ(schlickWeight(0), 1);
    EXPECT_DOUBLE_EQ(schlickWeight(0.5), 1.0 / 32);
    EXPECT_EQ(ggxBrdf(n, n, glm::dvec3(1, 0, 0), 0.1).value, 0);
}

TEST(ReferenceBrdf, eyeBelowTheHorizonIsClampedToMinNoV)
{
    const glm::dvec3 n(0, 0, 1), l = glm::normalize(glm::dvec3(-1, 0, 1));
    const glm::dvec3 below = glm::normalize(glm::dvec3(1, 0, -0.2));
    const SpecularBrdf brdf = ggxBrdf(n, below, l, 0.5);
    const double NoH = glm::dot(n, glm::normalize(below + l));
    EXPECT_DOUBLE_EQ(brdf.value, ggxD(NoH, 0.5) * smithVisibility(glm::dot(n, l), minNoV, 0.5));
    EXPECT_GT(brdf.value, 0);
}

TEST(ReferenceBrdf, valuesOutsideTheDomainAreRefused)
{
    EXPECT_THROW(ggxD(0.5, 0), std::domain_error);
    EXPECT_THROW(ggxD(0.5, NAN), std::domain_error);
    EXPECT_THROW(ggxD(1.1, 0.5), std::domain_error);
    EXPECT_THROW(ggxD(NAN, 0.5), std::domain_error);
    EXPECT_THROW(smithLambda(0, 0.5), std::domain_error);
    EXPECT_THROW(smithVisibility(-0.1, 0.5, 0.5), std::domain_error);
    EXPECT_THROW(schlickWeight(1.5), std::domain_error);
}

} // namespace candelabra::test
