// SPDX-License-Identifier: Apache-2.0
#include "reference/sphere_light.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <stdexcept>

#include "reference/brdf.h"

namespace candelabra::reference
{

namespace
{

// Returns x - sin x for x >= 0 without cancellation. Below 1 it sums the alternating series x^3/3!
// - x^5/5! + ... until the sum no longer changes.
double minusSine(double x)
{
    if (x >= 1)
        return x - std::sin(x);
    double term = x * x * x / 6;
    double sum = 0;
    for (int n = 4; sum + term != sum; n += 2) {
        sum += term;
        term *= -x * x / (n * (n + 1));
    }
    return sum;
}

// The crossing case for a centre on or above the horizon, 0 <= c < s. With m, q = sqrt(1 - s^2) and
// sin b = sqrt(1 - c^2), the textbook form is
//     pi F = c s^2 acos(-c q / (s sin b)) + asin(m / sin b) - m q,    m = sqrt(s^2 - c^2).
// Both angles have simple sines (m / (s sin b) and m / sin b), so atan2 gives them without loss at
// tangency; and with phi = asin(m / sin b), m q = sin^2 b sin phi cos phi, so that
//     asin(m / sin b) - m q = (2 phi - sin 2 phi) / 2 + c^2 m q / sin^2 b
// is a sum of positive terms.
double crossingFormFactor(double c, double s)
{
    const double m = std::sqrt((s - c) * (s + c));
    const double q = std::sqrt((1 - s) * (1 + s));
    const double sin2 = (1 - c) * (1 + c);
    const double theta = std::atan2(m, -c * q);
    const double phi = std::atan2(m, q);
    const double lens = minusSine(2 * phi) / 2 + c * c * m * q / sin2;
    return (c * s * s * theta + lens) / std::numbers::pi;
}

} // namespace

double sphereFormFactor(double c, double s)
{
    if (!(std::abs(c) <= 1 && s >= 0 && s <= 1))
        throw std::domain_error("sphereFormFactor: needs -1 <= c <= 1 and 0 <= s <= 1");
    if (std::abs(c) >= s)
        return std::max(c, 0.0) * s * s;
    // The form factor of a whole circle is the sum of the parts above and below: F(c) - F(-c) = c
    // s^2.
    if (c < 0)
        return std::max(crossingFormFactor(-c, s) + c * s * s, 0.0);
    return crossingFormFactor(c, s);
}

double lightWindow(double distance, double influenceRadius)
{
    if (std::isinf(influenceRadius))
        return 1;
    if (distance >= influenceRadius)
        return 0;
    const double x = distance / influenceRadius;
    const double y = 1 - x * x * x * x;
    return y * y;
}

double sphereDiffuse(const SurfacePoint& surface, const glm::dvec3& center, double radius)
{
    const glm::dvec3 toCenter = center - surface.position;
    const double distance = glm::length(toCenter);
    if (distance == 0)
        return sphereFormFactor(0, 1);
    const double c = glm::dot(surface.normal, toCenter) / distance;
    return sphereFormFactor(std::clamp(c, -1.0, 1.0), std::min(radius / distance, 1.0));
}

SpecularResponse karisSphereSpecular(const SurfacePoint& surface, double alpha,
                                     const glm::dvec3& center, double radius)
{
    const glm::dvec3& n = surface.normal;
    const glm::dvec3& v = surface.toEye;
    const glm::dvec3 toCenter = center - surface.position;
    const double distance = glm::length(toCenter);
    const glm::dvec3 mirror = 2 * std::max(glm::dot(n, v), minNoV) * n - v;
    const glm::dvec3 centerToRay = glm::dot(toCenter, mirror) * mirror - toCenter;
    const double miss = glm::length(centerToRay);
    const double share = miss > radius ? radius / miss : 1;
    const glm::dvec3 closest = toCenter + centerToRay * share;
    const double closestLength = glm::length(closest);
    if (closestLength == 0)
        return {};
    const glm::dvec3 l = closest / closestLength;
    const double NoL = glm::dot(n, l);
    if (NoL <= 0)
        return {};
    const double widened = distance > 0 ? std::min(alpha + radius / (2 * distance), 1.0) : 1.0;
    const double normalisation = (alpha / widened) * (alpha / widened);
    const double s = distance > radius ? radius / distance : 1;
    const SpecularBrdf brdf = ggxBrdf(n, v, l, alpha);
    const double a = std::numbers::pi * s * s * brdf.value * NoL * normalisation;
    return {a, a * brdf.schlickWeight};
}

} // namespace candelabra::reference
