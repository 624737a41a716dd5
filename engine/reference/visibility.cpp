// SPDX-License-Identifier: Apache-2.0
#include "reference/visibility.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <numbers>
#include <vector>

#include "reference/brdf.h"
#include "reference/emitter_points.h"
#include "reference/response.h"
#include "reference/truth.h"

namespace candelabra::reference
{

namespace
{

// Up to this number, testing every occluder of a shaft is faster than walking the tree per point.
constexpr size_t mostListed = 64;

// SplitMix64 (Steele, Lea and Flood 2014).
uint64_t mixed(uint64_t x)
{
    x += 0x9e3779b97f4a7c15;
    x = (x ^ (x >> 30)) * 0xbf58476d1ce4e5b9;
    x = (x ^ (x >> 27)) * 0x94d049bb133111eb;
    return x ^ (x >> 31);
}

// Returns point i of the (0, 2)-sequence of Sobol, its digits inverted by `seed`. In its first 2^m
// points every row, column and cell of 2^m equal cells, however wide or high, has one.
glm::dvec2 sobolPoint(uint32_t i, uint64_t seed)
{
    uint32_t x = 0, y = 0;
    uint32_t xDigit = 1u << 31, yDigit = 1u << 31;
    for (uint32_t rest = i; rest != 0; rest >>= 1) {
        if (rest & 1) {
            x ^= xDigit;
            y ^= yDigit;
        }
        xDigit >>= 1;
        yDigit ^= yDigit >> 1;
    }
    x ^= static_cast<uint32_t>(seed);
    y ^= static_cast<uint32_t>(seed >> 32);
    return (glm::dvec2(x, y) + 0.5) * 0x1p-32;
}

// Directions of the specular lobe: mirrored at visible normals of microfacets (Heitz 2018,
// "Sampling the GGX distribution of visible normals").
class SampledLobe
{
public:
    // The eye is above the horizon.
    SampledLobe(const SurfacePoint& surface, double alpha)
        : surface_(surface),
          alpha_(alpha),
          frame_(frameAround(surface.normal, surface.toEye)),
          eye_(glm::dot(frame_.x, surface.toEye), 0, glm::dot(frame_.z, surface.toEye))
    {
    }

    glm::dvec3 direction(const glm::dvec2& uv) const
    {
        // The hemisphere of normals is stretched so that the lobe becomes that of alpha = 1.
        const glm::dvec3 eye = glm::normalize(glm::dvec3(alpha_ * eye_.x, 0, eye_.z));
        const glm::dvec3 across(0, 1, 0), along = glm::cross(eye, across);
        const double radius = std::sqrt(uv.x), angle = 2 * std::numbers::pi * uv.y;
        const double s = (1 + eye.z) / 2, x = radius * std::cos(angle);
        const double y = std::sqrt(1 - x * x) * (1 - s) + s * radius * std::sin(angle);
        const glm::dvec3 stretched =
            x * across + y * along + std::sqrt(std::max(0.0, 1 - x * x - y * y)) * eye;
        const glm::dvec3 local = glm::normalize(
            glm::dvec3(alpha_ * stretched.x, alpha_ * stretched.y, std::max(stretched.z, 0.0)));
        const glm::dvec3 normal = local.x * frame_.x + local.y * frame_.y + local.z * frame_.z;
        return glm::normalize(2 * glm::dot(surface_.toEye, normal) * normal - surface_.toEye);
    }

    // Returns the density of direction(), 1/sr.
    double density(const glm::dvec3& toLight) const
    {
        const glm::dvec3 half = glm::normalize(surface_.toEye + toLight);
        return ggxD(glm::dot(surface_.normal, half), alpha_) /
               (4 * eye_.z * (1 + smithLambda(eye_.z, alpha_)));
    }

private:
    const SurfacePoint& surface_;
    double alpha_;
    Frame frame_;
    glm::dvec3 eye_;
};

// A light that occluders may hide.
class HiddenLight
{
public:
    // `index`: of the light.
    HiddenLight(const LightsOfPixel& all, size_t index, const SurfacePoint& surface, double alpha,
                const Truth& truth)
        : occluders_(*all.occluders),
          ignoredLayers_(index < all.ignoredLayers.size() ? all.ignoredLayers[index] : 0),
          emitter_(all.lights[index], all.lightOrigin, surface.position),
          surface_(liftEye(surface)),
          alpha_(alpha),
          truth_(truth),
          seed_(mixed(mixed(all.seed) + index))
    {
        isListed_ = occluders_.collect(emitter_.shaft(), ignoredLayers_, mostListed, list_);
    }

    // Tells that more points do not change what is visible.
    bool isSettled() const { return visible_.w == 0 || visible_.w == all_.w; }

    // Evaluates points until there are `points`. There are none if nothing can hide the light.
    void evaluate(uint32_t points)
    {
        if (emitter_.contain() || (isListed_ && list_.empty()))
            return;
        if (emitter_.isPoint())
            points = 1;
        const bool glossy = truth_.a != glm::dvec3(0) || truth_.b != glm::dvec3(0);
        const SampledLobe lobe(surface_, alpha_);
        for (; count_ < points; ++count_) {
            const glm::dvec2 uv = sobolPoint(count_, seed_);
            add(emitter_.at(uv.x, uv.y), glossy ? &lobe : nullptr, true);
            if (!glossy)
                continue;
            const glm::dvec3 direction = lobe.direction(sobolPoint(count_, mixed(seed_)));
            if (const auto point = emitter_.along(direction))
                add(*point, &lobe, false);
        }
    }

    glm::dvec3 luminance() const
    {
        if (visible_.w == all_.w)
            return truth_.luminance;
        const auto share = [&](int term) {
            return all_[term] > 0 ? visible_[term] / all_[term] : visible_.w / all_.w;
        };
        return share(0) * truth_.a + share(1) * truth_.b + share(2) * truth_.f;
    }

private:
    void add(const EmitterPoint& point, const SampledLobe* lobe, bool ofEmitter)
    {
        const double NoL = glm::dot(surface_.normal, point.direction);
        if (!(point.density > 0 && NoL > 0))
            return;
        glm::dvec4 terms(0, 0, ofEmitter ? NoL / point.density : 0, 1);
        if (lobe) {
            const SpecularBrdf brdf =
                ggxBrdf(surface_.normal, surface_.toEye, point.direction, alpha_);
            terms.x = brdf.value * NoL / (point.density + lobe->density(point.direction));
            terms.y = terms.x * brdf.schlickWeight;
        }
        all_ += terms;
        if (!isStopped(point))
            visible_ += terms;
    }

    // Occluders count up to the emitter, but for a margin: its own drawn surface hides nothing.
    bool isStopped(const EmitterPoint& point) const
    {
        const bool distant = std::isinf(point.distance);
        const LightRay ray{.origin = surface_.position,
                           .direction =
                               distant ? point.direction : point.distance * point.direction,
                           .end = distant ? point.distance : 1 / (1 + 0x1p-12),
                           .ignoredLayers = ignoredLayers_};
        return isListed_ ? occluders_.stop(ray, list_) : occluders_.stop(ray);
    }

    const Occluders& occluders_;
    uint32_t ignoredLayers_;
    EmitterPoints emitter_;
    SurfacePoint surface_;
    double alpha_;
    Truth truth_;
    uint64_t seed_;
    std::vector<uint32_t> list_;
    bool isListed_ = false; // list_ holds all that may hide the light
    uint32_t count_ = 0;
    glm::dvec4 all_{0}, visible_{0}; // sums of the integrands of a, b and f, and the points
};

double brightest(const glm::dvec3& colour)
{
    return std::max({colour.r, colour.g, colour.b});
}

// Adds lights that may be hidden. Returns how many missed the tolerance.
uint64_t addHidden(std::vector<HiddenLight>& lights, glm::dvec3& pixel)
{
    glm::dvec3 before(0);
    for (uint32_t points = firstShadowPoints;; points *= 2) {
        glm::dvec3 sum = pixel;
        uint64_t unsettled = 0;
        for (HiddenLight& light : lights) {
            if (points == firstShadowPoints || !light.isSettled())
                light.evaluate(points);
            unsettled += light.isSettled() ? 0 : 1;
            sum += light.luminance();
        }
        const bool still = points > firstShadowPoints &&
                           brightest(glm::abs(sum - before)) <= shadowTolerance * brightest(sum);
        if (unsettled == 0 || still || points == mostShadowPoints) {
            pixel = sum;
            return still ? 0 : unsettled;
        }
        before = sum;
    }
}

} // namespace

uint64_t addLights(const LightsOfPixel& all, const SurfacePoint& surface, const Material& material,
                   glm::dvec3& pixel)
{
    uint64_t unconverged = 0;
    std::vector<HiddenLight> mayBeHidden;
    for (size_t i = 0; i < all.lights.size(); ++i) {
        const Truth truth =
            truthLuminance(surface, material, all.lights[i], all.lightOrigin, all.relative);
        unconverged += truth.converged ? 0 : 1;
        if (!all.occluders)
            pixel += truth.luminance;
        else if (truth.luminance != glm::dvec3(0))
            mayBeHidden.emplace_back(all, i, surface, material.alpha, truth);
    }
    return unconverged + addHidden(mayBeHidden, pixel);
}

} // namespace candelabra::reference
