// SPDX-License-Identifier: Apache-2.0
// Finds jumps of the response along continuous changes of the input, by bisection on the device.
#include <algorithm>
#include <cmath>
#include <functional>
#include <numbers>

#include <fmt/format.h>

#include "generate/random.h"
#include "measure/kernels/vectors.h"
#include "measure/stability/stability.h"

namespace candelabra::app
{
namespace
{

using std::numbers::pi;

// The constants of one sweep, which are drawn at random.
struct Path {
    float perceptualRoughness;
    glm::dvec3 v;
    double s, azimuth;
};

// The light at a position t in 0..1 along a path.
struct Place {
    glm::dvec3 direction; // unit, towards the light's centre
    double sine;          // the light's radius: at distance 1, the sine of its half angle
    double distance;      // of the light's centre
};
using Way = std::function<Place(const Path&, double)>;

Place throughHorizon(const Path& p, double t)
{
    const double elevation = std::asin(p.s) * (2.2 * (1 - t) - 1.1);
    return {polar(pi / 2 - elevation, p.azimuth), p.s, 1};
}

// The light goes from well above the horizon to one half angle above it.
Place towardsHorizon(const Path& p, double t)
{
    const double half = std::asin(p.s);
    return {polar((pi / 2 - half) * t, p.azimuth), p.s, 1};
}

// The light goes through the mirror direction in the plane of incidence.
Place throughMirror(const Path& p, double t)
{
    const double alpha = double(p.perceptualRoughness) * p.perceptualRoughness;
    const double width = 2 * (std::asin(p.s) + alpha);
    const double angle = std::acos(std::clamp(p.v.z, -1.0, 1.0)) + width * (2 * t - 1);
    return {polar(angle, std::atan2(-p.v.y, -p.v.x)), p.s, 1};
}

// The receiver enters the sphere: its distance from the centre goes from 3 R to R / 4.
Place throughSurface(const Path& p, double t)
{
    return {polar(0.5 * pi * p.s, p.azimuth), 1, 3 * (1 - t) + 0.25 * t};
}

struct Named {
    const char* name;
    Way way;
    bool nearOnly; // only for lights at a finite distance
};
const Named ways[] = {{"the horizon", throughHorizon, false},
                      {"the approach to it", towardsHorizon, false},
                      {"the mirror direction", throughMirror, false},
                      {"the emitter's surface", throughSurface, true}};

std::vector<Path> makePaths(uint32_t count, uint64_t seed)
{
    Random random(seed, 300);
    std::vector<Path> out;
    for (uint32_t i = 0; i < count; ++i) {
        Path p{};
        p.perceptualRoughness = random.uniform(0.1f, 1.0f);
        const double view = double(random.uniform(0, 85)) * pi / 180;
        p.v = polar(view, 2 * pi * double(random.uniform()));
        p.s = std::pow(10.0, double(random.uniform(-2.0f, -0.02f)));
        p.azimuth = 2 * pi * double(random.uniform());
        out.push_back(p);
    }
    return out;
}

CndLight lightAt(uint32_t type, const Place& place)
{
    CndLight light{.type = type};
    const glm::vec3 to(place.direction * place.distance);
    for (int i = 0; i < 3; ++i) {
        light.position[i] = to[i];
        light.direction[i] = -to[i];
    }
    light.radius = float(place.sine);
    return light;
}

class Follow
{
public:
    Follow(const VulkanContext& context, const Evaluation& evaluation,
           const std::vector<Path>& paths, const Way& way)
        : evaluator_(context, evaluation),
          lightType_(evaluation.lightType),
          paths_(paths),
          way_(way)
    {
    }

    // The responses with F = 1 at `perPath` positions of each path.
    std::vector<double> evaluate(const std::vector<double>& t, size_t perPath) const
    {
        std::vector<gpu::BenchReceiver> receivers;
        std::vector<CndLight> lights;
        for (size_t i = 0; i < paths_.size(); ++i)
            for (size_t k = 0; k < perPath; ++k) {
                receivers.push_back({.n = {0, 0, 1},
                                     .v = glm::vec3(paths_[i].v),
                                     .perceptualRoughness = paths_[i].perceptualRoughness});
                lights.push_back(lightAt(lightType_, way_(paths_[i], t[i * perPath + k])));
            }
        std::vector<double> out;
        for (const gpu::BenchResponse& r : evaluator_.evaluate(receivers, lights))
            out.push_back(double(r.a));
        return out;
    }

private:
    LightEvaluator evaluator_;
    uint32_t lightType_;
    const std::vector<Path>& paths_;
    const Way& way_;
};

ContinuityCheck check(const VulkanContext& context, const Evaluation& evaluation,
                      const std::vector<Path>& paths, const Named& named)
{
    constexpr size_t steps = 512;
    constexpr int bisections = 24; // after so many, both ends differ by about a step of a float
    const Follow follow(context, evaluation, paths, named.way);
    std::vector<double> t;
    for (size_t i = 0; i < paths.size(); ++i)
        for (size_t k = 0; k < steps; ++k)
            t.push_back(double(k) / (steps - 1));
    const std::vector<double> coarse = follow.evaluate(t, steps);
    // Bisection begins with the steepest step of each path and always keeps the steeper half.
    std::vector<double> low, high, atLow, atHigh;
    for (size_t i = 0; i < paths.size(); ++i) {
        size_t steepest = 0;
        for (size_t k = 0; k + 1 < steps; ++k)
            if (std::abs(coarse[i * steps + k + 1] - coarse[i * steps + k]) >
                std::abs(coarse[i * steps + steepest + 1] - coarse[i * steps + steepest]))
                steepest = k;
        low.push_back(t[steepest]);
        high.push_back(t[steepest + 1]);
        atLow.push_back(coarse[i * steps + steepest]);
        atHigh.push_back(coarse[i * steps + steepest + 1]);
    }
    for (int round = 0; round < bisections; ++round) {
        std::vector<double> middle;
        for (size_t i = 0; i < paths.size(); ++i)
            middle.push_back(0.5 * (low[i] + high[i]));
        const std::vector<double> values = follow.evaluate(middle, 1);
        for (size_t i = 0; i < paths.size(); ++i) {
            const bool lower = std::abs(values[i] - atLow[i]) > std::abs(atHigh[i] - values[i]);
            (lower ? high : low)[i] = middle[i];
            (lower ? atHigh : atLow)[i] = values[i];
        }
    }
    ContinuityCheck out{.evaluation = evaluation, .through = named.name, .worst = {}};
    for (size_t i = 0; i < paths.size(); ++i) {
        const Path& p = paths[i];
        const double alpha = double(p.perceptualRoughness) * p.perceptualRoughness;
        const double jump =
            std::abs(atHigh[i] - atLow[i]) /
            onAxisResponse(named.way(p, 0.5 * (low[i] + high[i])).sine, alpha, p.v.z);
        if (jump > out.jump) {
            out.jump = jump;
            out.worst = fmt::format("alpha {:.4f}, NoV {:.4f}, s {:.4f}, azimuth {:.3f}, t {:.6f}",
                                    alpha, p.v.z, p.s, p.azimuth, low[i]);
        }
    }
    return out;
}

} // namespace

std::vector<ContinuityCheck> checkContinuity(const VulkanContext& context,
                                             const Evaluation& evaluation, uint32_t sweeps,
                                             uint64_t seed)
{
    const std::vector<Path> paths = makePaths(sweeps, seed);
    std::vector<ContinuityCheck> out;
    for (const Named& named : ways)
        if (!named.nearOnly || evaluation.lightType == CND_LIGHT_SPHERE)
            out.push_back(check(context, evaluation, paths, named));
    return out;
}

} // namespace candelabra::app
