// SPDX-License-Identifier: Apache-2.0
#include "reference/albedo.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <stdexcept>
#include <vector>

#include "reference/brdf.h"

namespace candelabra::reference
{

namespace
{

using std::numbers::pi;

struct Node {
    double x, weight; // on [0, 1]
};

// Tanh-sinh rule (Takahasi and Mori 1974) with 2 n + 1 nodes: it converges whatever the function
// does at the ends.
std::vector<Node> tanhSinh(int n)
{
    std::vector<Node> nodes;
    const double step = 3.0 / n; // weights beyond t = 3 are below 1e-12
    for (int i = -n; i <= n; ++i) {
        const double t = i * step;
        const double u = pi / 2 * std::sinh(t);
        const double weight = pi / 4 * std::cosh(t) / (std::cosh(u) * std::cosh(u));
        nodes.push_back({0.5 + 0.5 * std::tanh(u), weight * step});
    }
    return nodes;
}

// Integrates over microfacet normals at azimuth phi relative to the eye's. Their angle theta from
// the surface normal is parametrised by tan(theta) = alpha sinh(x), which spreads the lobe's peak
// and tail evenly. The reflected ray is above the horizon while cos(2 theta - psi) > 0.
DirectionalAlbedo azimuthSlice(double NoV, double alpha, double phi, const std::vector<Node>& rule)
{
    const double sinV = std::sqrt((1 - NoV) * (1 + NoV));
    const double tilt = sinV * std::cos(phi);
    const double psi = std::atan2(tilt, NoV);
    const double end = std::asinh(std::tan((psi + pi / 2) / 2) / alpha);
    const double lambdaV = smithLambda(NoV, alpha);
    DirectionalAlbedo sum;
    for (const Node& node : rule) {
        const double x = end * node.x;
        const double tangent = alpha * std::sinh(x);
        const double NoH = 1 / std::sqrt(1 + tangent * tangent);
        const double sinH = tangent * NoH;
        const double VoH = tilt * sinH + NoV * NoH;
        const double NoL = 2 * VoH * NoH - NoV;
        if (NoL <= 0 || VoH <= 0) // rounding errors at the end of the interval
            continue;
        const double g2 = 1 / (1 + lambdaV + smithLambda(std::min(NoL, 1.0), alpha));
        const double dTheta = alpha * std::cosh(x) * NoH * NoH; // d theta / d x
        const double value = ggxD(NoH, alpha) * g2 * VoH / NoV * sinH * dTheta * node.weight * end;
        sum.a += value;
        sum.b += value * schlickWeight(std::min(VoH, 1.0));
    }
    return sum;
}

DirectionalAlbedo integrateSlices(double NoV, double alpha, int n)
{
    const std::vector<Node> rule = tanhSinh(n);
    DirectionalAlbedo sum;
    // At grazing angles the slices change quickly where the azimuth is a right angle, so split
    // there.
    for (const double start : {0.0, pi / 2})
        for (const Node& node : rule) {
            const DirectionalAlbedo slice = azimuthSlice(NoV, alpha, start + pi / 2 * node.x, rule);
            const double weight = 2 * (pi / 2) * node.weight; // factor 2: both sides of the eye's
                                                              // plane
            sum.a += weight * slice.a;
            sum.b += weight * slice.b;
        }
    return sum;
}

} // namespace

DirectionalAlbedo specularAlbedo(double NoV, double alpha, double tolerance)
{
    if (!(NoV >= minNoV && NoV <= 1 && alpha >= 0.002 && alpha <= 1))
        throw std::domain_error("specularAlbedo: NoV must be 1e-4..1 and alpha 0.002..1");
    DirectionalAlbedo previous = integrateSlices(NoV, alpha, 16);
    for (int n = 32; n <= 512; n *= 2) {
        const DirectionalAlbedo next = integrateSlices(NoV, alpha, n);
        if (std::abs(next.a - previous.a) <= tolerance &&
            std::abs(next.b - previous.b) <= tolerance)
            return next;
        previous = next;
    }
    throw std::runtime_error("specularAlbedo: the quadrature does not settle");
}

double schlickShareOfDiffuse(double NoV)
{
    if (!(NoV > 0 && NoV <= 1))
        throw std::domain_error("schlickShareOfDiffuse: NoV must be in (0, 1]");
    const double sinV = std::sqrt((1 - NoV) * (1 + NoV));
    const std::vector<Node> rule = tanhSinh(64);
    double sum = 0;
    for (const Node& cosine : rule)
        for (const Node& azimuth : rule) {
            const double NoL = cosine.x;
            const double sinL = std::sqrt((1 - NoL) * (1 + NoL));
            const double VoL = sinV * sinL * std::cos(pi * azimuth.x) + NoV * NoL;
            const double VoH = std::sqrt(std::clamp((1 + VoL) / 2, 0.0, 1.0));
            sum += 2 * NoL * schlickWeight(VoH) * cosine.weight * azimuth.weight;
        }
    return sum;
}

} // namespace candelabra::reference
