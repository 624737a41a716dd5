// SPDX-License-Identifier: Apache-2.0
// Properties of the slope-conic formulas that need no truth: continuity and limits, in double
// precision (tools/formula). tests/gpu/test_conic.cpp tests that float32 gives the same.
#include <cmath>
#include <functional>
#include <iostream>
#include <numbers>
#include <random>

#include <gtest/gtest.h>

#include "formula/formula.h"

namespace candelabra::test
{
namespace
{

struct Configuration {
    double alpha, NoV, s, elevation, azimuth; // elevation and azimuth of the light's centre,
                                              // radians, elevation measured from the horizon
};

formula::Response respond(const Configuration& c, CndSpecularMethod method = CND_SPECULAR_CONIC)
{
    const glm::dvec3 l(std::cos(c.elevation) * std::cos(c.azimuth),
                       std::cos(c.elevation) * std::sin(c.azimuth), std::sin(c.elevation));
    return formula::respond({.method = method},
                            {.n = {0, 0, 1},
                             .v = {std::sqrt(1 - c.NoV * c.NoV), 0, c.NoV},
                             .perceptualRoughness = std::sqrt(c.alpha)},
                            {.centre = l, .boundingRadius = c.s});
}

double peakOf(Configuration c)
{
    c.azimuth = std::numbers::pi;
    c.elevation = std::asin(c.NoV);
    return respond(c).a;
}

class RandomConfigurations
{
public:
    double operator()(double low, double high)
    {
        return low + (high - low) * double(random_()) / 4294967296.0;
    }
    Configuration configuration()
    {
        const double roughness = (*this)(0.0448, 1);
        return {.alpha = roughness * roughness,
                .NoV = std::cos((*this)(0, 88 * std::numbers::pi / 180)),
                .s = std::sin(std::pow(10.0, (*this)(-1, 1.9)) * std::numbers::pi / 180),
                .elevation = 0,
                .azimuth = std::numbers::pi - 1.5 * std::pow((*this)(-1, 1), 3)};
    }

private:
    std::mt19937 random_{99};
};

// Returns the largest true jump of `at` over [0, 1]: the steepest of `steps` intervals is halved
// until the difference of a continuous function would have vanished.
double largestJump(const std::function<double(double)>& at, int steps)
{
    double low = 0, size = 0;
    for (int i = 0; i < steps; ++i) {
        const double difference = std::abs(at((i + 1.0) / steps) - at(double(i) / steps));
        if (difference > size) {
            size = difference;
            low = double(i) / steps;
        }
    }
    double high = low + 1.0 / steps;
    for (int i = 0; i < 24; ++i) {
        const double middle = (low + high) / 2;
        if (std::abs(at(middle) - at(low)) > std::abs(at(high) - at(middle)))
            high = middle;
        else
            low = middle;
    }
    return std::abs(at(high) - at(low));
}

} // namespace

// A light rises through the horizon. Its forms change where its lower edge, its centre, its upper
// edge and twice its radius pass the horizon; neighbouring forms must agree there.
TEST(ConicFormula, NoJumpWhereTheLightRises)
{
    RandomConfigurations random;
    double worst = 0, worstEdge = 0;
    for (int i = 0; i < 1000; ++i) {
        Configuration c = random.configuration();
        const double peak = peakOf(c), half = std::asin(c.s);
        const auto at = [&](double t) {
            c.elevation = half * (-1.05 + 3.3 * t);
            return respond(c).a / peak;
        };
        const double jump = largestJump(at, 64);
        if (jump > worst)
            worst = jump;
        for (const double edge : {-1.0, 0.0, 1.0, 2.0}) {
            if (edge * c.s >= 1)
                continue;
            const double elevation = std::asin(edge * c.s);
            c.elevation = elevation - 1e-10;
            const double before = respond(c).a;
            c.elevation = elevation + 1e-10;
            worstEdge = std::max(worstEdge, std::abs(respond(c).a - before) / peak);
        }
    }
    std::cout << "largest jump over the peak: " << worst << ", at the borders " << worstEdge
              << "\n";
    EXPECT_LE(worst, 1e-5);
    EXPECT_LE(worstEdge, 5e-4);
}

TEST(ConicFormula, NoJumpAlongAzimuthSizeViewAndRoughness)
{
    const std::pair<const char*, std::function<void(Configuration&, double)>> sweeps[] = {
        {"azimuth", [](Configuration& c, double t) { c.azimuth = std::numbers::pi * t; }},
        {"size", [](Configuration& c, double t) { c.s = std::pow(10.0, -4 * (1 - t)); }},
        {"view", [](Configuration& c, double t) { c.NoV = 0.02 + 0.98 * t; }},
        {"alpha", [](Configuration& c, double t) { c.alpha = 0.002 + 0.998 * t; }}};
    for (const auto& sweep : sweeps) {
        RandomConfigurations random;
        double worst = 0;
        for (int i = 0; i < 300; ++i) {
            Configuration c = random.configuration();
            c.elevation = std::asin(c.s * std::min(random(-1, 3), 0.99 / c.s));
            const double peak = peakOf(c);
            const auto at = [&](double t) {
                Configuration moved = c;
                sweep.second(moved, t);
                return respond(moved).a / std::max(peakOf(moved), peak);
            };
            worst = std::max(worst, largestJump(at, 64));
        }
        std::cout << sweep.first << ": largest jump over the peak " << worst << "\n";
        EXPECT_LE(worst, 2e-3) << sweep.first; // alpha: small caps are no longer clipped exactly
    }
}

// Below the horizon the response is exactly 0, and a small light becomes the point light: the error
// falls with s^2 down to the resolution of double.
TEST(ConicFormula, LimitsAreTheHorizonAndThePointLight)
{
    RandomConfigurations random;
    for (const double s : {1e-2, 1e-3, 1e-4, 1e-5, 1e-6, 1e-7, 1e-8}) {
        double worst = 0;
        for (int i = 0; i < 2000; ++i) {
            Configuration c = random.configuration();
            c.s = s;
            c.alpha = std::max(c.alpha, 0.1);
            c.NoV = std::max(c.NoV, 0.1);
            c.elevation = random(0.1, 1.5);
            const double point = respond(c, CND_SPECULAR_POINT).a;
            worst = std::max(worst, std::abs(respond(c).a / point - 1));
            c.elevation = -std::asin(s) - 1e-9;
            EXPECT_EQ(respond(c).a, 0);
        }
        std::cout << "s " << s << ": largest relative difference to the point light " << worst
                  << "\n";
        EXPECT_LE(worst, 1000 * s * s + 1e-7); // measured in the far tail of alpha = 0.1
    }
}

} // namespace candelabra::test
