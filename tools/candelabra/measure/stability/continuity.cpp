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
#include "reference/response.h"
#include "reference/vectors.h"
#include "scene/polygons.h"
#include "shading/light_family.h"

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
    glm::dvec3 axis, side; // unit and perpendicular: how lights lie that are no spheres
    double aspect;         // their width divided by their length
};

// The light at a position t in 0..1 along a path.
struct Place {
    glm::dvec3 direction; // unit, towards the light's centre
    double sine;          // the light's size: at distance 1, the sine of a sphere's half angle
    double distance;      // of the light's centre
    glm::dvec3 axis, side;
};
using Way = std::function<Place(const Path&, double)>;

Place placeAt(const Path& p, const glm::dvec3& direction)
{
    return {direction, p.s, 1, p.axis, p.side};
}

Place throughHorizon(const Path& p, double t)
{
    const double elevation = std::asin(p.s) * (2.2 * (1 - t) - 1.1);
    return placeAt(p, polar(pi / 2 - elevation, p.azimuth));
}

// The light goes from well above the horizon to one half angle above it.
Place towardsHorizon(const Path& p, double t)
{
    const double half = std::asin(p.s);
    return placeAt(p, polar((pi / 2 - half) * t, p.azimuth));
}

// The light goes through the mirror direction in the plane of incidence.
Place throughMirror(const Path& p, double t)
{
    const double alpha = double(p.perceptualRoughness) * p.perceptualRoughness;
    const double width = 2 * (std::asin(p.s) + alpha);
    const double angle = std::acos(std::clamp(p.v.z, -1.0, 1.0)) + width * (2 * t - 1);
    return placeAt(p, polar(angle, std::atan2(-p.v.y, -p.v.x)));
}

// The light grows, somewhere within its largest half angle and the lobe's from the mirror
// direction.
Place throughSizes(const Path& p, double t)
{
    const double alpha = double(p.perceptualRoughness) * p.perceptualRoughness;
    const glm::dvec3 mirror(-p.v.x, -p.v.y, p.v.z);
    Place out =
        placeAt(p, glm::normalize(mirror + (p.s + alpha) * polar(2 * p.azimuth, p.azimuth)));
    out.sine = p.s * std::pow(1e-4, 1 - t);
    return out;
}

// The receiver enters the sphere: its distance from the centre goes from 3 R to R / 4.
Place throughSurface(const Path& p, double t)
{
    return {polar(0.5 * pi * p.s, p.azimuth), 1, 3 * (1 - t) + 0.25 * t, p.axis, p.side};
}

// The light turns until it is seen along its axis, or from the side if it is flat, and beyond.
Place turning(const Path& p, double t)
{
    const glm::dvec3 direction = polar(0.4 * pi * p.s, p.azimuth);
    const glm::dvec3 across = glm::normalize(glm::cross(direction, p.axis));
    const double angle = 0.4 * (2 * t - 1);
    return {direction, p.s, 1, std::cos(angle) * direction + std::sin(angle) * across,
            glm::cross(direction, across)};
}

// The place at which a light of that size is brightest: in the mirror direction, facing the
// receiver.
Place placeFacing(const Path& p, const Place& place)
{
    const glm::dvec3 mirror(-p.v.x, -p.v.y, p.v.z);
    const glm::dvec3 axis = glm::normalize(glm::cross(mirror, p.axis));
    return {mirror, place.sine, place.distance, axis, glm::cross(mirror, axis)};
}

enum class Only { Any, Sphere, Shape };
struct Named {
    const char* name;
    Way way;
    Only only; // sphere: at a finite distance; shape: lights that are no spheres
};
const Named ways[] = {{"the horizon", throughHorizon, Only::Any},
                      {"the approach to it", towardsHorizon, Only::Any},
                      {"the mirror direction", throughMirror, Only::Any},
                      {"its sizes", throughSizes, Only::Any},
                      {"the emitter's surface", throughSurface, Only::Sphere},
                      {"its own plane or axis", turning, Only::Shape}};

bool applies(const Named& named, uint32_t lightType)
{
    switch (named.only) {
    case Only::Sphere:
        return lightType == CND_LIGHT_SPHERE;
    case Only::Shape:
        return !lighting::isSphere(lightType);
    default:
        return true;
    }
}

std::vector<Path> makePaths(uint32_t count, uint64_t seed)
{
    Random random(seed, 300), shapes(seed, 301);
    std::vector<Path> out;
    for (uint32_t i = 0; i < count; ++i) {
        Path p{};
        p.perceptualRoughness = random.uniform(0.1f, 1.0f);
        const double view = double(random.uniform(0, 85)) * pi / 180;
        p.v = polar(view, 2 * pi * double(random.uniform()));
        p.s = std::pow(10.0, double(random.uniform(-2.0f, -0.02f)));
        p.azimuth = 2 * pi * double(random.uniform());
        p.axis = polar(std::acos(double(shapes.uniform(-1, 1))), 2 * pi * double(shapes.uniform()));
        const double turn = 2 * pi * double(shapes.uniform());
        const reference::Frame frame = reference::frameAround(p.axis, {0, 0, 1});
        p.side = std::cos(turn) * frame.x + std::sin(turn) * frame.y;
        p.aspect = std::pow(10.0, double(shapes.uniform(-2, 0)));
        out.push_back(p);
    }
    return out;
}

std::string text(const glm::dvec3& v)
{
    return fmt::format("({:.9g}, {:.9g}, {:.9g})", v.x, v.y, v.z);
}

std::string text(const float (&v)[3])
{
    return text(reference::vec3(v));
}

// Lights that are no spheres fit into the sphere of that size. A flat light is seen from both
// sides; a disc's plane is that of both axes.
CndLight lightAt(uint32_t type, const Path& p, const Place& place)
{
    CndLight light{.type = type};
    const glm::dvec3 to = place.direction * place.distance;
    set(light.position, to);
    set(light.direction, -to);
    light.radius = float(place.sine);
    light.twoSided = VK_TRUE;
    if (lighting::isSphere(type))
        return light;
    const uint32_t fields = cndLightFields(type);
    const bool isTube = fields & CND_LIGHT_FIELD_AXIS_U_BIT && fields & CND_LIGHT_FIELD_RADIUS_BIT;
    const double length = place.sine * (isTube ? 0.6 : 0.7);
    const double width = (isTube ? 0.5 : 1) * length * p.aspect;
    set(light.axisU, length * place.axis);
    set(light.axisV, width * place.side);
    set(light.direction, glm::cross(place.axis, place.side));
    if (isTube)
        light.radius = float(width);
    light.polygon = regularPolygon(5);
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

    // The responses with F = 1 at `perPath` positions of each path; `peak`: to the light as it is
    // brightest.
    std::vector<double> evaluate(const std::vector<double>& t, size_t perPath,
                                 bool peak = false) const
    {
        std::vector<gpu::BenchReceiver> receivers;
        std::vector<CndLight> lights;
        for (size_t i = 0; i < paths_.size(); ++i)
            for (size_t k = 0; k < perPath; ++k) {
                const Path& p = paths_[i];
                const Place place = way_(p, t[i * perPath + k]);
                receivers.push_back({.n = {0, 0, 1},
                                     .v = glm::vec3(p.v),
                                     .perceptualRoughness = p.perceptualRoughness});
                lights.push_back(lightAt(lightType_, p, peak ? placeFacing(p, place) : place));
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
    const std::vector<double> peaks = follow.evaluate(low, 1, true);
    for (size_t i = 0; i < paths.size(); ++i) {
        const Path& p = paths[i];
        const double alpha = double(p.perceptualRoughness) * p.perceptualRoughness;
        const double jump = std::abs(atHigh[i] - atLow[i]) / peaks[i];
        if (jump > out.jump) {
            out.jump = jump;
            const Place place = named.way(p, low[i]);
            const CndLight light = lightAt(evaluation.lightType, p, place);
            out.worst = fmt::format(
                "alpha {:.4f}, n (0, 0, 1), v {}, light at {}, facing {}, radius {}, axes {} {}, "
                "before t = {:.6f} of its way",
                alpha, text(p.v), text(light.position), text(light.direction), light.radius,
                text(light.axisU), text(light.axisV), low[i]);
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
        if (applies(named, evaluation.lightType))
            out.push_back(check(context, evaluation, paths, named));
    return out;
}

} // namespace candelabra::app
