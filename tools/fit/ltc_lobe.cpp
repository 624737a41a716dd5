// SPDX-License-Identifier: Apache-2.0
#include "fit/ltc_lobe.h"

#include <cmath>
#include <numbers>

#include "fit/nelder_mead.h"
#include "reference/albedo.h"
#include "reference/brdf.h"

namespace candelabra::fit
{
namespace
{

using std::numbers::pi;
constexpr int latticeSize = 3000;
constexpr int pointCount = 240;
constexpr int capsPerSize = 16;
// Half angles of the lights that the fit uses, in degrees. The fit assumes that the logarithm of
// the half angle is uniformly distributed from 0.1 to 80 degrees, as it is for sphere lights in the
// sample set on which methods are compared.
constexpr std::array capHalfAngles = {1.0, 2.0, 5.0, 10.0, 20.0, 40.0, 70.0};
constexpr double smallestLight = 0.1, largestLight = 80;

// Returns point i of a low-discrepancy sequence in the unit square: the additive sequence of the
// plastic number (Roberts 2018, "The unreasonable effectiveness of quasirandom sequences").
glm::dvec2 lattice(int i)
{
    constexpr double g = 1.32471795724474602596;
    return glm::fract(0.5 + double(i) * glm::dvec2(1 / g, 1 / (g * g)));
}

glm::dvec3 polar(double angle, double azimuth)
{
    return {std::sin(angle) * std::cos(azimuth), std::sin(angle) * std::sin(azimuth),
            std::cos(angle)};
}

// Maps uniform u to the angle between a light and the mirror direction. Half of the lights are
// within 1.4 (alpha + s / 2), with s the half angle; the rest are in the long tail of a Cauchy
// distribution.
double tailAngle(double u, double alpha, double halfAngle)
{
    return std::min(0.7 * (2 * alpha + halfAngle) * std::tan(pi * u / 2), 2.8);
}

} // namespace

LtcLobe::LtcLobe(double alpha, double NoV, double F0) : alpha_(alpha), NoV_(NoV), F0_(F0)
{
    const reference::DirectionalAlbedo albedo = reference::specularAlbedo(NoV, alpha, 1e-5);
    albedo_ = std::min(F0 * (albedo.a - albedo.b) + albedo.b, 1.0);
    const double sine = std::sqrt(std::max(0.0, 1 - NoV * NoV));
    eye_ = {sine, 0, NoV};
    mirror_ = {-sine, 0, NoV};
    x_ = {NoV, 0, sine};
    makeLattice();
    makePoints();
    for (const double degrees : capHalfAngles)
        if (glm::radians(degrees) > 0.7 * alpha) // smaller lights act as points in this lobe
            makeCaps(glm::radians(degrees));
    const double logAlpha = std::log(glm::degrees(alpha) / smallestLight);
    pointShare_ = std::clamp(logAlpha / std::log(largestLight / smallestLight), 0.05, 0.95);
}

LtcLobe::Direction LtcLobe::direction(const glm::dvec3& l, double solidAngle) const
{
    double response = 0;
    if (l.z > 0) {
        const reference::SpecularBrdf brdf = reference::ggxBrdf({0, 0, 1}, eye_, l, alpha_);
        response = brdf.value * (F0_ + (1 - F0_) * brdf.schlickWeight) * l.z;
    }
    return {{glm::dot(l, x_), l.y, glm::dot(l, mirror_)}, response, solidAngle};
}

// Half of the directions are chosen so that their half vectors have the density D cos, the other
// half so that the directions have the density of a cosine. Each is weighted by the sum of both
// densities (the balance heuristic of Veach 1997).
void LtcLobe::makeLattice()
{
    for (int i = 0; i < latticeSize; ++i) {
        const glm::dvec2 u = lattice(i);
        const double azimuth = 2 * pi * u.y;
        glm::dvec3 l;
        if (i < latticeSize / 2) {
            const glm::dvec3 h = polar(std::atan(alpha_ * std::sqrt(u.x / (1 - u.x))), azimuth);
            l = 2 * glm::dot(eye_, h) * h - eye_;
        } else {
            l = polar(std::acos(std::sqrt(u.x)), azimuth);
        }
        if (l.z <= 0)
            continue;
        const glm::dvec3 h = glm::normalize(eye_ + l);
        const double VoH = std::min(glm::dot(eye_, h), 1.0);
        const double density =
            0.5 * reference::ggxD(std::min(h.z, 1.0), alpha_) * h.z / (4 * VoH) + 0.5 * l.z / pi;
        lattice_.push_back(direction(l, 1 / (density * latticeSize)));
    }
}

void LtcLobe::makePoints()
{
    const double reach = std::min(1.5, 6 * alpha_);
    for (int i = -200; i <= 200; ++i) {
        const double angle = reach * i / 200;
        const glm::dvec3 l = std::sin(angle) * x_ + std::cos(angle) * mirror_;
        pointPeak_ = std::max(pointPeak_, direction(l, 0).response);
    }
    for (int i = 0; i < pointCount; ++i) {
        const glm::dvec2 u = lattice(i);
        const glm::dvec3 l = polar(tailAngle(u.x, alpha_, 0), 2 * pi * u.y);
        const Direction d = direction(l.x * x_ + glm::dvec3(0, l.y, 0) + l.z * mirror_, 0);
        if (d.response > 0)
            points_.push_back(d);
    }
}

double LtcLobe::capResponse(const glm::dvec3& centre, double cosHalfAngle) const
{
    double sum = 0;
    for (const Direction& d : lattice_)
        if (glm::dot(d.l, centre) > cosHalfAngle)
            sum += d.response * d.solidAngle;
    return sum;
}

void LtcLobe::makeCaps(double halfAngle)
{
    const double cosHalfAngle = std::cos(halfAngle);
    double peak = 0;
    for (int i = -8; i <= 8; ++i) { // the peak lies in the plane of incidence
        const double angle = 0.25 * i * (alpha_ + 0.3 * halfAngle);
        peak = std::max(peak, capResponse({std::sin(angle), 0, std::cos(angle)}, cosHalfAngle));
    }
    const size_t first = caps_.size();
    for (int i = 0; i < capsPerSize; ++i) {
        const glm::dvec2 u = lattice(i + int(first));
        const double angle = i == 0 ? 0 : tailAngle(u.x, alpha_, halfAngle);
        const glm::dvec3 centre = polar(angle, 2 * pi * u.y);
        Cap cap;
        double response = 0;
        for (uint32_t k = 0; k < lattice_.size(); ++k)
            if (glm::dot(lattice_[k].l, centre) > cosHalfAngle) {
                cap.inside.push_back(k);
                response += lattice_[k].response * lattice_[k].solidAngle;
            }
        if (response <= 0)
            continue; // wholly below the horizon, where the lobe and the fit are exactly 0
        peak = std::max(peak, response);
        caps_.push_back(std::move(cap));
    }
    for (size_t i = first; i < caps_.size(); ++i)
        caps_[i].peak = peak;
}

// Heitz et al. 2016, eq. 1: D(l) = D_cosine(w / |w|) |det M^-1| / |w|^3 with w = M^-1 l.
double LtcLobe::evaluate(const LtcShape& shape, const glm::dvec3& l) const
{
    const double i1 = shape.sharpnessX / alpha_, i2 = shape.sharpnessY / alpha_;
    const glm::dvec3 w(i1 * l.x + shape.shift * l.z, i2 * l.y, eye_.x * l.x + NoV_ * l.z); // z: l.n
    if (w.z <= 0)
        return 0;
    const double determinant = i2 * std::abs(NoV_ * i1 - eye_.x * shape.shift);
    const double w2 = glm::dot(w, w);
    return albedo_ * w.z * determinant / (pi * w2 * w2);
}

LtcLobe::Error LtcLobe::error(const LtcShape& shape) const
{
    Error all;
    const auto add = [&](double error, double weight) {
        all.cost += weight * error * std::sqrt(error);
        all.mean += weight * error;
        all.largest = std::max(all.largest, error);
    };
    const double pointWeight = (caps_.empty() ? 1 : pointShare_) / double(points_.size());
    for (const Direction& d : points_)
        add(std::abs(evaluate(shape, d.l) - d.response) / pointPeak_, pointWeight);
    if (caps_.empty())
        return all;
    std::vector<double> difference(lattice_.size());
    for (size_t k = 0; k < lattice_.size(); ++k)
        difference[k] =
            (evaluate(shape, lattice_[k].l) - lattice_[k].response) * lattice_[k].solidAngle;
    const double capWeight = (1 - pointShare_) / double(caps_.size());
    for (const Cap& cap : caps_) {
        double sum = 0;
        for (const uint32_t k : cap.inside)
            sum += difference[k];
        add(std::abs(sum) / cap.peak, capWeight);
    }
    return all;
}

LtcShape LtcLobe::fitted(const LtcShape& start, std::initializer_list<double> steps) const
{
    const auto shape = [&](const std::array<double, 3>& p) {
        return LtcShape{std::exp(p[0]), std::exp(p[1]), p[2]};
    };
    const auto cost = [&](const std::array<double, 3>& p) {
        const LtcShape s = shape(p);
        // The map is nearly singular or turns the lobe around. No good fit is near such maps.
        const double determinant = NoV_ * s.sharpnessX / alpha_ - eye_.x * s.shift;
        const bool sound = s.sharpnessX > 0.1 * NoV_ && s.sharpnessY > 0.1 * NoV_ &&
                           s.sharpnessX < 5 && s.sharpnessY < 5 && determinant > 0.1;
        return sound ? error(s).cost : 1e9;
    };
    std::array<double, 3> at = {std::log(start.sharpnessX), std::log(start.sharpnessY),
                                start.shift};
    for (const double step : steps)
        at = minimise<3>(cost, at, step, 100).at;
    return shape(at);
}

} // namespace candelabra::fit
