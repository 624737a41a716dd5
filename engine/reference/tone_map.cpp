// SPDX-License-Identifier: Apache-2.0
#include "reference/tone_map.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <stdexcept>

namespace candelabra::reference
{

namespace
{

constexpr double whiteBeyond = 1e15;

glm::dvec3 clip(const glm::dvec3& color)
{
    return glm::clamp(color, 0.0, 1.0);
}

// The arguments are rows, as in the publications; glm stores columns.
glm::dmat3 fromRows(const glm::dvec3& x, const glm::dvec3& y, const glm::dvec3& z)
{
    return glm::transpose(glm::dmat3(x, y, z));
}

// S. Hill's fit. The input matrix combines linear sRGB -> XYZ -> D60 -> AP1 -> RRT saturation, the
// output matrix the way back including the ODT's saturation.
glm::dvec3 hillAces(const glm::dvec3& color)
{
    static const glm::dmat3 input = fromRows(
        {0.59719, 0.35458, 0.04823}, {0.07600, 0.90834, 0.01566}, {0.02840, 0.13383, 0.83777});
    static const glm::dmat3 output =
        fromRows({1.60475, -0.53108, -0.07367}, {-0.10208, 1.10813, -0.00605},
                 {-0.00327, -0.07276, 1.07602});
    const glm::dvec3 v = input * color;
    const glm::dvec3 numerator = v * v + 0.0245786 * v - 0.000090537;
    const glm::dvec3 denominator = 0.983729 * v * v + 0.4329510 * v + 0.238081;
    return clip(output * (numerator / denominator));
}

// The names are those of the specification: F90, Ks and Kd are its constants.
glm::dvec3 pbrNeutral(const glm::dvec3& color)
{
    constexpr double f90 = 0.04;
    constexpr double ks = 0.8 - f90;
    constexpr double kd = 0.15;
    const double x = std::min({color.r, color.g, color.b});
    const double f = x <= 2 * f90 ? x - x * x / (4 * f90) : f90;
    const glm::dvec3 shifted = color - f;
    const double p = std::max({shifted.r, shifted.g, shifted.b});
    if (p <= ks)
        return clip(shifted);
    const double pn = 1 - (1 - ks) * (1 - ks) / (p + 1 - 2 * ks);
    const double g = 1 / (kd * (p - pn) + 1);
    return clip(shifted * (pn / p) * g + glm::dvec3(pn * (1 - g)));
}

double agxContrast(double x)
{
    // Wrensch's fit of Sobotka's sigmoid, highest power first.
    constexpr double coefficients[] = {15.5, -40.14, 31.96, -6.868, 0.4298, 0.1191, -0.00232};
    double sum = 0;
    for (const double coefficient : coefficients)
        sum = sum * x + coefficient;
    return sum;
}

glm::dvec3 agx(const glm::dvec3& color)
{
    // The columns as published.
    static const glm::dmat3 inset(0.842479062253094, 0.0423282422610123, 0.0423756549057051,
                                  0.0784335999999992, 0.878468636469772, 0.0784336,
                                  0.0792237451477643, 0.0791661274605434, 0.879142973793104);
    static const glm::dmat3 outset(1.19687900512017, -0.0528968517574562, -0.0529716355144438,
                                   -0.0980208811401368, 1.15190312990417, -0.0980434501171241,
                                   -0.0990297440797205, -0.0989611768448433, 1.15107367264116);
    // AgX's range in log2: 10 stops below and 6.5 stops above middle grey 0.18.
    constexpr double minEv = -12.47393;
    constexpr double maxEv = 4.026069;
    constexpr double displayExponent = 2.2;
    glm::dvec3 value = inset * color;
    for (int i = 0; i < 3; ++i) {
        const double ev = std::clamp(std::log2(value[i]), minEv, maxEv);
        value[i] = agxContrast((ev - minEv) / (maxEv - minEv));
    }
    value = clip(outset * value);
    return glm::pow(value, glm::dvec3(displayExponent));
}

// Applies the curve as its authors published it.
glm::dvec3 publishedCurve(CndToneMap curve, const glm::dvec3& color)
{
    switch (curve) {
    case CND_TONEMAP_NONE:
        return clip(color);
    case CND_TONEMAP_REINHARD:
        return color / (1.0 + color);
    case CND_TONEMAP_ACES:
        return hillAces(color);
    case CND_TONEMAP_PBR_NEUTRAL:
        return pbrNeutral(color);
    case CND_TONEMAP_AGX:
        return agx(color);
    default:
        throw std::invalid_argument("the tone mapping curve is unknown");
    }
}

// Finds the grey that a curve displays at a luminance of 0.18, by bisection, divided by 0.18.
double findMiddleGreyGain(CndToneMap curve)
{
    constexpr double middleGrey = 0.18;
    const glm::dvec3 luminanceWeights{0.2126, 0.7152, 0.0722};
    double below = 0, above = 1;
    for (int i = 0; i < 60; ++i) {
        const double middle = 0.5 * (below + above);
        const glm::dvec3 shown = publishedCurve(curve, glm::dvec3(middle));
        (glm::dot(luminanceWeights, shown) < middleGrey ? below : above) = middle;
    }
    return above / middleGrey;
}

} // namespace

double middleGreyGain(CndToneMap curve)
{
    static const auto gains = [] {
        std::array<double, CND_TONEMAP_COUNT> out{};
        for (int i = 0; i < CND_TONEMAP_COUNT; ++i)
            out[i] = findMiddleGreyGain(CndToneMap(i));
        return out;
    }();
    if (uint32_t(curve) >= gains.size())
        throw std::invalid_argument("the tone mapping curve is unknown");
    return gains[curve];
}

glm::dvec3 toneMap(CndToneMap curve, const glm::dvec3& exposed)
{
    const double gain = middleGreyGain(curve);
    glm::dvec3 color;
    for (int i = 0; i < 3; ++i)
        color[i] = exposed[i] > 0 ? gain * std::min(exposed[i], whiteBeyond) : 0;
    return publishedCurve(curve, color);
}

double srgbEncode(double linear)
{
    return linear <= 0.0031308 ? 12.92 * linear : 1.055 * std::pow(linear, 1 / 2.4) - 0.055;
}

} // namespace candelabra::reference
