// SPDX-License-Identifier: Apache-2.0
#include "reference/brdf.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <sstream>
#include <stdexcept>

namespace candelabra::reference
{

namespace
{

// Cosines of normalised vectors exceed [0, 1] by a few rounding errors.
constexpr double cosineSlack = 1e-12;

void requireDomain(bool inside, const char* name, double value)
{
    if (inside)
        return;
    std::ostringstream message;
    message.precision(17);
    message << name << " = " << value << " is outside its domain";
    throw std::domain_error(message.str());
}

void requireAlpha(double alpha)
{
    requireDomain(alpha > 0 && alpha <= 1, "alpha", alpha);
}

} // namespace

double lambertBrdf()
{
    return std::numbers::inv_pi;
}

double ggxD(double NoH, double alpha)
{
    requireAlpha(alpha);
    requireDomain(std::abs(NoH) <= 1 + cosineSlack, "NoH", NoH);
    if (NoH <= 0)
        return 0;
    const double alpha2 = alpha * alpha;
    const double cos2 = NoH * NoH;
    const double sin2 = (1 - NoH) * (1 + NoH);
    const double denominator = sin2 + alpha2 * cos2;
    return alpha2 / (std::numbers::pi * denominator * denominator);
}

double smithLambda(double cosTheta, double alpha)
{
    requireAlpha(alpha);
    requireDomain(cosTheta > 0 && cosTheta <= 1 + cosineSlack, "cosTheta", cosTheta);
    const double tan2 = std::max(0.0, (1 - cosTheta) * (1 + cosTheta)) / (cosTheta * cosTheta);
    return (std::sqrt(1 + alpha * alpha * tan2) - 1) / 2;
}

double smithVisibility(double NoL, double NoV, double alpha)
{
    const double g2 = 1 / (1 + smithLambda(NoV, alpha) + smithLambda(NoL, alpha));
    return g2 / (4 * NoL * NoV);
}

double schlickWeight(double VoH)
{
    requireDomain(VoH >= -cosineSlack && VoH <= 1 + cosineSlack, "VoH", VoH);
    const double x = std::max(1 - VoH, 0.0), x2 = x * x; // VoH may round to above 1
    return x2 * x2 * x;
}

SpecularBrdf ggxBrdf(const glm::dvec3& normal, const glm::dvec3& toEye, const glm::dvec3& toLight,
                     double alpha)
{
    const double NoL = glm::dot(normal, toLight);
    if (NoL <= 0)
        return {};
    const glm::dvec3 sum = toEye + toLight;
    const double length = glm::length(sum);
    // The eye is exactly opposite the light: only possible with NoV <= 0, where nothing is visible.
    if (length == 0)
        return {};
    const glm::dvec3 half = sum / length;
    const double NoV = std::max(glm::dot(normal, toEye), minNoV);
    const double d = ggxD(glm::dot(normal, half), alpha);
    return {d * smithVisibility(NoL, NoV, alpha), schlickWeight(glm::dot(toEye, half))};
}

} // namespace candelabra::reference
