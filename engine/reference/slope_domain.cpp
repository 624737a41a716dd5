// SPDX-License-Identifier: Apache-2.0
#include "reference/slope_domain.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <vector>

#include "reference/brdf.h"
#include "reference/quadrature.h"

namespace candelabra::reference
{

namespace
{

using std::numbers::pi;

// The integration problem in a frame with the normal as z and the eye in the xz plane.
class SlopeProblem
{
public:
    SlopeProblem(const SurfacePoint& surface, double alpha, const SphereCap& cap)
        : alpha_(alpha), s2_(std::min(cap.sin2, maxSpecularSin2))
    {
        const Frame frame = frameAround(surface.normal, surface.toEye);
        vx_ = glm::dot(surface.toEye, frame.x);
        vz_ = glm::dot(surface.toEye, frame.z);
        c_ = {glm::dot(cap.axis, frame.x), glm::dot(cap.axis, frame.y),
              glm::dot(cap.axis, frame.z)};
        omc_ = s2_ / (1 + std::sqrt(1 - s2_));
        // z0_ = cos s - dot(mirror, c), computed from their difference, which is exact where it
        // matters.
        const glm::dvec3 miss = c_ - glm::dvec3(-vx_, 0, vz_);
        z0_ = glm::dot(miss, miss) / 2 - omc_;
        lambdaV_ = smithLambda(std::min(vz_, 1.0), alpha);
    }

    bool visible() const { return s2_ > 0 && c_.z > -std::sqrt(s2_); }

    // Returns the angles of the rays at which the integral over a ray is not smooth.
    std::vector<double> breaks() const
    {
        std::vector<double> out = {-pi, 0, pi};
        const auto add = [&](double angle) { out.push_back(std::remainder(angle, 2 * pi)); };
        // Rays that touch the cap's conic: discriminant() = A sin^2 + B sin cos + C cos^2 = 0.
        const double sum = vx_ + c_.x;
        const double A = s2_ - sum * sum + 2 * omc_ * vx_ * c_.x;
        const double B = 2 * sum * c_.y - 2 * omc_ * vx_ * c_.y;
        const double C = s2_ - c_.y * c_.y;
        const double root = B * B - 4 * A * C;
        if (root >= 0) {
            const double q = -(B + std::copysign(std::sqrt(root), B)) / 2;
            for (const double angle : {std::atan2(q, A), std::atan2(C, q)}) {
                add(angle);
                add(angle + pi);
            }
        }
        // Rays to the points where the cap's rim meets the horizon: m = l + v there.
        const double across = std::hypot(c_.x, c_.y);
        if (std::abs(c_.z) < std::sqrt(s2_) && across > 0) {
            const double along = std::min((1 - omc_) / across, 1.0);
            const double side = std::sqrt(std::max(0.0, s2_ - c_.z * c_.z)) / across;
            for (const double sign : {-1.0, 1.0}) {
                const double lx = (along * c_.x - sign * side * c_.y) / across;
                const double ly = (along * c_.y + sign * side * c_.x) / across;
                add(std::atan2(ly, lx + vx_));
            }
        }
        std::sort(out.begin(), out.end());
        return out;
    }

    // True if the ray at this angle meets the cap above the horizon.
    bool meets(double angle) const { return makeRay(angle).count > 0; }

    // Returns a and b integrated along one ray, and their estimated errors.
    std::array<double, 4> alongRay(double angle, double relative) const
    {
        const Ray ray = makeRay(angle);
        std::array<double, 4> out{};
        for (int i = 0; i < ray.count; ++i) {
            const std::array<double, 2> ends = {std::atan(ray.low[i] / alpha_),
                                                std::atan(ray.high[i] / alpha_)};
            const auto part = integrate<2, 60>(std::span<const double>(ends), relative, negligible,
                                               [&](double u) { return density(ray, u); });
            for (size_t n = 0; n < 2; ++n) {
                out[n] += part.value[n] / (pi * vz_);
                out[n + 2] += part.error[n] / (pi * vz_);
            }
        }
        return out;
    }

private:
    struct Ray {
        double vd;      // component of the eye along the ray
        double horizon; // slope at which the light direction reaches the horizon
        int count;      // number of slope intervals that are inside the cap and above the horizon
        double low[2], high[2];
    };

    Ray makeRay(double angle) const
    {
        const double cosine = std::cos(angle), sine = std::sin(angle);
        Ray ray{};
        ray.vd = vx_ * cosine;
        const double ve = -vx_ * sine;
        const double cd = c_.x * cosine + c_.y * sine, ce = c_.y * cosine - c_.x * sine;
        // The light is above the horizon where vz r^2 - 2 vd r - vz < 0. The roots multiply to -1.
        const double length = std::hypot(ray.vd, vz_);
        ray.horizon = ray.vd > 0 ? (ray.vd + length) / vz_ : vz_ / (length - ray.vd);
        // The slope r is inside the cap where a r^2 + 2 b r + z0 <= 0. The discriminant in this
        // form is exact: b^2 - a z0 = s^2 - (ve + ce)^2 + 2 (1 - cos s) ve ce.
        const double a = (1 - omc_) + vx_ * c_.x + vz_ * c_.z - 2 * ray.vd * cd;
        const double b = -(vz_ * cd + c_.z * ray.vd);
        const double discriminant = s2_ - (ve + ce) * (ve + ce) + 2 * omc_ * ve * ce;
        const auto add = [&](double low, double high) {
            low = std::max(low, 0.0);
            high = std::min(high, ray.horizon);
            if (low < high) {
                ray.low[ray.count] = low;
                ray.high[ray.count++] = high;
            }
        };
        if (discriminant <= 0) {
            if (a < 0)
                add(0, ray.horizon);
            return ray;
        }
        const double q = -(b + std::copysign(std::sqrt(discriminant), b));
        if (q == 0)
            return ray;
        const double first = z0_ / q;
        if (a == 0) { // one end is at infinity, on the side where 2 b r + z0 <= 0
            if (b < 0)
                add(first, ray.horizon);
            else
                add(0, first);
            return ray;
        }
        const double second = q / a;
        const double low = std::min(first, second), high = std::max(first, second);
        if (a > 0) {
            add(low, high);
        } else {
            add(0, low);
            add(std::max(high, 0.0), ray.horizon);
        }
        return ray;
    }

    // Returns p22 r dr dot(v, m) G2 times pi, and the same times Schlick's weight.
    std::array<double, 2> density(const Ray& ray, double u) const
    {
        const double sine = std::sin(u), cosine = std::cos(u);
        const double slope = alpha_ * sine / cosine;
        const double length2 = 1 + slope * slope;
        const double NoL = vz_ * (ray.horizon - slope) * (slope + 1 / ray.horizon) / length2;
        const double vm = ray.vd * slope + vz_;
        if (!(NoL > 0 && vm > 0))
            return {};
        const double g2 = 1 / (1 + lambdaV_ + smithLambda(std::min(NoL, 1.0), alpha_));
        const double a = sine * cosine * vm * g2;
        return {a, a * schlickWeight(std::min(vm / std::sqrt(length2), 1.0))};
    }

    double alpha_, s2_, omc_, z0_, lambdaV_;
    double vx_, vz_; // eye
    glm::dvec3 c_;   // axis of the cap
};

} // namespace

LightResponse slopeDomainSpecular(const SurfacePoint& surface, double alpha, const SphereCap& cap,
                                  double relative)
{
    LightResponse out;
    const SlopeProblem problem(liftEye(surface), alpha, cap);
    if (!problem.visible())
        return out;
    const std::vector<double> breaks = problem.breaks();
    const auto sum = integratePanels<2>(
        std::span<const double>(breaks), relative,
        [&](double angle) { return problem.meets(angle); },
        [&](double angle) { return problem.alongRay(angle, relative / 8); });
    out.a = sum.value[0];
    out.b = sum.value[1];
    out.aError = sum.error[0] + sum.value[2];
    out.bError = sum.error[1] + sum.value[3];
    out.converged = sum.converged;
    return out;
}

} // namespace candelabra::reference
