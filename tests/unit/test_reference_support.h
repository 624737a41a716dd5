// SPDX-License-Identifier: Apache-2.0
// Helpers of the reference tests: a record of the worst case of a sweep, and brute-force quadrature
// that does not use the closed forms under test.
#pragma once

#include <cmath>
#include <functional>
#include <numbers>
#include <sstream>
#include <string>

#include <glm/glm.hpp>
#include <gtest/gtest.h>

#include "candelabra/candelabra.h"

namespace candelabra::test
{

// Keeps the largest error of a sweep and the place where it occurred. NaN counts as larger than
// everything, and a sweep that checked nothing fails.
class WorstCase
{
public:
    template <class... Where>
    void add(double error, const Where&... where)
    {
        if (error <= worst_ || std::isnan(worst_))
            return;
        worst_ = error;
        std::ostringstream text;
        text.precision(9);
        ((text << where << ' '), ...);
        where_ = text.str();
    }

    testing::AssertionResult within(double bound) const
    {
        if (worst_ >= 0 && worst_ <= bound)
            return testing::AssertionSuccess();
        return testing::AssertionFailure()
               << "worst error " << worst_ << " exceeds " << bound << " at " << where_;
    }

private:
    double worst_ = -1;
    std::string where_ = "(nothing was checked)";
};

// Tanh-sinh quadrature over [a, b] (Takahasi and Mori 1974), which converges despite integrable
// kinks and square-root ends. 300 nodes, error about 1e-13 of the integrand's size.
inline double integrate(double a, double b, const std::function<double(double)>& f)
{
    const double step = 1.0 / 48;
    const double middle = (a + b) / 2, half = (b - a) / 2;
    double sum = 0;
    for (int i = -150; i <= 150; ++i) {
        const double t = i * step;
        const double u = std::numbers::pi / 2 * std::sinh(t);
        const double weight = std::numbers::pi / 2 * std::cosh(t) / (std::cosh(u) * std::cosh(u));
        sum += weight * f(middle + half * std::tanh(u));
    }
    return sum * step * half;
}

// Integrates max(A + B cos phi, 0) over phi in [0, 2 pi], by the midpoint rule on the interval in
// which the integrand is positive.
inline double integratePositivePart(double A, double B)
{
    if (A <= -std::abs(B))
        return 0;
    const double edge = A >= std::abs(B) ? std::numbers::pi : std::acos(-A / B);
    const int count = 64;
    if (edge == std::numbers::pi) {
        double sum = 0;
        for (int i = 0; i < count; ++i)
            sum += A + B * std::cos(edge * (i + 0.5) / count);
        return 2 * sum * edge / count;
    }
    return 2 * integrate(0, edge, [=](double phi) { return A + B * std::cos(phi); });
}

// Integrates f over the directions within asin(s) of the unit axis; f must be smooth on the cap.
inline glm::dvec3 integrateCap(const glm::dvec3& axis, double s,
                               const std::function<glm::dvec3(const glm::dvec3&)>& f)
{
    const glm::dvec3 helper = std::abs(axis.x) < 0.5 ? glm::dvec3(1, 0, 0) : glm::dvec3(0, 1, 0);
    const glm::dvec3 tangent = glm::normalize(glm::cross(axis, helper));
    const glm::dvec3 bitangent = glm::cross(axis, tangent);
    // The area of a cap is proportional to w = 1 - cos. Uses the midpoint rule in u with w = u^2,
    // which makes the integrand smooth at the axis.
    const double height = s * s / (1 + std::sqrt(1 - s * s));
    const int rings = 48, spokes = 64;
    glm::dvec3 sum(0);
    for (int ring = 0; ring < rings; ++ring) {
        const double u = (ring + 0.5) / rings;
        const double omc = height * u * u;
        const double sine = std::sqrt(omc * (2 - omc));
        for (int spoke = 0; spoke < spokes; ++spoke) {
            const double phi = 2 * std::numbers::pi * (spoke + 0.5) / spokes;
            const glm::dvec3 direction =
                (1 - omc) * axis + sine * (std::cos(phi) * tangent + std::sin(phi) * bitangent);
            sum += 2 * u * f(direction);
        }
    }
    return sum * (2 * std::numbers::pi * height / (rings * spokes));
}

inline CndLight makeSphere(const glm::vec3& position, float radius, const glm::vec3& luminance)
{
    CndLight light{};
    light.type = CND_LIGHT_SPHERE;
    light.radius = radius;
    light.influenceRadius = INFINITY;
    for (int i = 0; i < 3; ++i) {
        light.position[i] = position[i];
        light.emission[i] = luminance[i];
    }
    return light;
}

inline void set(float (&out)[3], const glm::dvec3& value)
{
    for (int i = 0; i < 3; ++i)
        out[i] = static_cast<float>(value[i]);
}

inline CndLight makeRectangle(const glm::dvec3& center, const glm::dvec3& u, const glm::dvec3& v)
{
    CndLight light = makeSphere(glm::vec3(center), 0, glm::vec3(1));
    light.type = CND_LIGHT_RECTANGLE;
    set(light.axisU, u);
    set(light.axisV, v);
    return light;
}

inline CndLight makeDisc(const glm::dvec3& center, const glm::dvec3& normal, float radius)
{
    CndLight light = makeSphere(glm::vec3(center), radius, glm::vec3(1));
    light.type = CND_LIGHT_DISC;
    set(light.direction, normal);
    return light;
}

inline CndLight makeTube(const glm::dvec3& center, const glm::dvec3& half, float radius)
{
    CndLight light = makeSphere(glm::vec3(center), radius, glm::vec3(1));
    light.type = CND_LIGHT_TUBE;
    set(light.axisU, half);
    return light;
}

} // namespace candelabra::test
