// SPDX-License-Identifier: Apache-2.0
#include "reference/direction_domain.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "reference/brdf.h"
#include "reference/quadrature.h"

namespace candelabra::reference
{

namespace
{

using std::numbers::pi;

// Polar coordinates around a pole, and the part of the outline above the horizon in them.
class PolarRegion
{
public:
    PolarRegion(const Outline& outline, const glm::dvec3& normal, const Frame& pole)
        : outline_(outline), normal_(normal), pole_(pole)
    {
    }

    glm::dvec3 spoke(double phi) const { return std::cos(phi) * pole_.x + std::sin(phi) * pole_.y; }

    // Returns the interval of theta on a spoke, inside [0, pi].
    std::optional<Arc> interval(const glm::dvec3& spoke) const
    {
        std::optional<Arc> arc = outline_.arc(pole_.z, spoke);
        if (arc)
            arc = intersect(
                *arc, {std::atan2(glm::dot(normal_, spoke), glm::dot(normal_, pole_.z)), pi / 2});
        if (arc)
            arc = intersect({pi / 2, pi / 2}, *arc);
        return arc;
    }

    // Returns the angles phi at which the ends of the interval are not smooth: tangents and corners
    // of the outline, and where the outline meets the horizon.
    std::vector<double> breaks() const
    {
        std::vector<double> out = outline_.angles(pole_);
        const Frame horizon = frameAround(normal_, pole_.z);
        if (const auto arc = outline_.arc(horizon.x, horizon.y))
            for (const double t : {arc->centre - arc->halfWidth, arc->centre + arc->halfWidth}) {
                const glm::dvec3 meeting = std::cos(t) * horizon.x + std::sin(t) * horizon.y;
                out.push_back(std::atan2(glm::dot(meeting, pole_.y), glm::dot(meeting, pole_.x)));
            }
        for (double& phi : out)
            phi = std::remainder(phi, 2 * pi);
        out.insert(out.end(), {-pi, 0, pi});
        std::sort(out.begin(), out.end());
        return out;
    }

private:
    const Outline& outline_;
    glm::dvec3 normal_;
    Frame pole_;
};

} // namespace

LightResponse directionDomainSpecular(const SurfacePoint& given, double alpha,
                                      const Outline& outline, double relative)
{
    const SurfacePoint surface = liftEye(given);
    const glm::dvec3& n = surface.normal;
    const double NoV = glm::dot(n, surface.toEye);
    // Computed from the tangential part, so that the mirror direction is as exact at grazing angles
    // as elsewhere.
    const glm::dvec3 mirror = glm::normalize(NoV * n - (surface.toEye - NoV * n));
    const Frame pole = frameAround(mirror, n);
    const PolarRegion region(outline, n, pole);
    const std::vector<double> breaks = region.breaks();
    const auto along = [&](double phi) {
        std::array<double, 4> out{};
        const glm::dvec3 spoke = region.spoke(phi);
        const std::optional<Arc> arc = region.interval(spoke);
        if (!arc)
            return out;
        // Distance from the mirror direction at which the half-vector slope is alpha: in half
        // angles it is alpha NoV across the plane of incidence and alpha along it.
        const double cosine = std::cos(phi), sine = std::sin(phi);
        const double width = alpha * NoV / std::sqrt(NoV * NoV * cosine * cosine + sine * sine);
        const auto toU = [&](double theta) {
            return std::atan(std::tan(std::clamp(theta, 0.0, pi) / 2) / width);
        };
        const std::array<double, 2> ends = {toU(arc->centre - arc->halfWidth),
                                            toU(arc->centre + arc->halfWidth)};
        const auto part = integrate<2, 60>(
            std::span<const double>(ends), relative / 8, negligible, [&](double u) {
                const double t = width * std::tan(u), t2 = t * t;
                const double cosTheta = (1 - t2) / (1 + t2), sinTheta = 2 * t / (1 + t2);
                const glm::dvec3 l = cosTheta * mirror + sinTheta * spoke;
                const double NoL = glm::dot(n, l);
                const double cosU = std::cos(u);
                const SpecularBrdf brdf = ggxBrdf(n, surface.toEye, l, alpha);
                const double a = brdf.value * std::max(NoL, 0.0) * sinTheta * 2 * width /
                                 (cosU * cosU * (1 + t2));
                return std::array<double, 2>{a, a * brdf.schlickWeight};
            });
        for (size_t i = 0; i < 2; ++i) {
            out[i] = part.value[i];
            out[i + 2] = part.error[i];
        }
        return out;
    };
    const auto sum = integratePanels<2>(
        std::span<const double>(breaks), relative,
        [&](double phi) { return region.interval(region.spoke(phi)).has_value(); }, along);
    LightResponse out;
    out.a = sum.value[0];
    out.b = sum.value[1];
    out.aError = sum.error[0] + sum.value[2];
    out.bError = sum.error[1] + sum.value[3];
    out.converged = sum.converged;
    return out;
}

LightResponse directionDomainDiffuse(const glm::dvec3& normal, const Outline& outline,
                                     double relative)
{
    const Frame pole = frameAround(outline.centre(), normal);
    const PolarRegion region(outline, normal, pole);
    const std::vector<double> breaks = region.breaks();
    const double nz = glm::dot(normal, pole.z);
    const auto sum = integratePanels<1>(
        std::span<const double>(breaks), relative,
        [&](double phi) { return region.interval(region.spoke(phi)).has_value(); },
        [&](double phi) {
            const glm::dvec3 spoke = region.spoke(phi);
            const std::optional<Arc> arc = region.interval(spoke);
            if (!arc)
                return std::array<double, 1>{0};
            // Integral of (nz cos + nx sin) sin over the interval, with nx = n . spoke.
            const double sum2 = 2 * arc->centre, width = 2 * arc->halfWidth;
            const double sinWidth = std::sin(width);
            const double nx = glm::dot(normal, spoke);
            return std::array<double, 1>{
                (nz * sinWidth * std::sin(sum2) + nx * (width - sinWidth * std::cos(sum2))) / 2};
        });
    LightResponse out;
    out.f = std::max(sum.value[0], 0.0) / pi;
    out.fError = sum.error[0] / pi;
    out.converged = sum.converged;
    return out;
}

} // namespace candelabra::reference
