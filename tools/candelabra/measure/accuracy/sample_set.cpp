// SPDX-License-Identifier: Apache-2.0
#include "measure/accuracy/sample_set.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

#include "generate/random.h"
#include "lights/light_types.h"
#include "measure/kernels/parallel.h"
#include "measure/kernels/vectors.h"
#include "reference/truth.h"
#include "scene/polygons.h"

namespace candelabra::app
{
namespace
{

using std::numbers::pi;
constexpr double degree = pi / 180;

struct Group {
    float perceptualRoughness;
    glm::dvec3 v;
    double halfAngle; // of the emitter as seen, radians
    double distance;  // m
    // For shapes other than spheres: turn and tilt to the direction, and how long they are.
    double turn, tilt, aspect;
    uint32_t outline; // which polygon
};

double uniform(Random& random, double low, double high)
{
    return low + (high - low) * double(random.uniform());
}

double logUniform(Random& random, double low, double high)
{
    return low * std::pow(high / low, double(random.uniform()));
}

Group makeGroup(uint32_t type, uint32_t index, uint32_t groups, Random& random)
{
    Group g{};
    g.perceptualRoughness =
        float(0.045 + (1 - 0.045) * (index + double(random.uniform())) / groups);
    const double viewAngle = uniform(random, 0, 88.85) * degree;
    g.v = polar(viewAngle, uniform(random, 0, 2 * pi));
    g.halfAngle = degree * (lighting::isSphere(type) ? logUniform(random, 0.1, 80)
                                                     : logUniform(random, 1, 60));
    g.distance = logUniform(random, 0.3, 30);
    g.turn = uniform(random, 0, 2 * pi);
    g.tilt = uniform(random, 0, 75) * degree;
    g.aspect = logUniform(random, 1, 6);
    g.outline = index;
    return g;
}

CndLight makeLight(uint32_t type, const Group& g, const glm::dvec3& direction)
{
    CndLight light{.type = type, .emission = {1, 1, 1}};
    light.influenceRadius = std::numeric_limits<float>::infinity();
    set(light.position, g.distance * direction);
    if (type == CND_LIGHT_SPHERE) {
        light.radius = float(g.distance * std::sin(g.halfAngle));
        return light;
    }
    if (type == CND_LIGHT_DISTANT_SPHERE) {
        set(light.direction, -direction);
        light.radius = float(std::sin(g.halfAngle));
        return light;
    }
    // The frame of the shape: w from the light to the receiver, tilted towards u.
    const reference::Frame frame = reference::frameAround(-direction, {0, 0, 1});
    const glm::dvec3 across = std::cos(g.turn) * frame.x + std::sin(g.turn) * frame.y;
    const glm::dvec3 w = std::cos(g.tilt) * frame.z + std::sin(g.tilt) * across;
    const glm::dvec3 u = std::cos(g.tilt) * across - std::sin(g.tilt) * frame.z;
    const double half = g.distance * std::tan(g.halfAngle);
    set(light.direction, w);
    light.radius = float(half);
    set(light.axisU, half * u);
    set(light.axisV, half / g.aspect * glm::cross(w, u));
    light.polygon = somePolygon(g.outline);
    const uint32_t fields = cndLightFields(type);
    if (fields & CND_LIGHT_FIELD_AXIS_U_BIT && fields & CND_LIGHT_FIELD_RADIUS_BIT) {
        // A body: small enough to leave the receiver outside whichever way it points.
        const double length = std::min(half, 0.6 * g.distance);
        set(light.axisU, length * u);
        set(light.axisV, length / g.aspect * glm::cross(w, u));
        light.radius = float(length / (2 * g.aspect));
    }
    return light;
}

// Returns the light with its lengths multiplied. The radius of a type with axisU is its thickness.
CndLight scaled(CndLight light, LightScale scale)
{
    const uint32_t fields = cndLightFields(light.type);
    const bool hasLength = (fields & CND_LIGHT_FIELD_AXIS_U_BIT) != 0;
    light.radius *= float(scale.size * (hasLength ? scale.thickness : 1));
    for (float& u : light.axisU)
        u *= float(scale.size);
    for (float& v : light.axisV)
        v *= float(scale.size * scale.thickness);
    return light;
}

std::vector<glm::dvec3> directionsOf(const Group& g, Random& random)
{
    const double alpha = double(g.perceptualRoughness) * g.perceptualRoughness;
    const double scale = g.halfAngle + 2 * alpha;
    const glm::dvec3 mirror(-g.v.x, -g.v.y, g.v.z);
    const reference::Frame frame = reference::frameAround(mirror, {0, 0, 1});
    std::vector<glm::dvec3> out;
    for (int i = 0; i < 26; ++i) {
        // Leaves out the last percent of the tail, where most groups would give nothing but pi, the
        // direction opposite the mirror direction.
        const double angle = std::min(scale * std::tan(0.5 * pi * uniform(random, 0, 0.99)), pi);
        const glm::dvec3 d = polar(angle, uniform(random, 0, 2 * pi));
        out.push_back(d.x * frame.x + d.y * frame.y + d.z * frame.z);
    }
    for (int i = 0; i < 14; ++i) {
        const double z = uniform(random, -std::sin(g.halfAngle), 1);
        out.push_back(polar(std::acos(std::clamp(z, -1.0, 1.0)), uniform(random, 0, 2 * pi)));
    }
    const double mirrorAngle = std::acos(std::clamp(g.v.z, -1.0, 1.0));
    const double azimuth = std::atan2(-g.v.y, -g.v.x);
    const double edge = pi / 2 + g.halfAngle;
    const double low = std::max(mirrorAngle - 3 * scale, -edge);
    const double high = std::min(mirrorAngle + 3 * scale, edge);
    for (int i = 0; i < 49; ++i)
        out.push_back(polar(low + (high - low) * i / 48, azimuth));
    return out;
}

// Lowest and highest point of the emitter over the plane through the receiver.
std::pair<double, double> heights(const CndLight& light)
{
    const uint32_t fields = cndLightFields(light.type);
    const double radius = light.radius;
    if (cndIsDistant(light.type))
        return {-light.direction[2] - radius, -light.direction[2] + radius};
    // A body with two axes is taken as its bounding sphere.
    if (fields & CND_LIGHT_FIELD_AXIS_V_BIT && fields & CND_LIGHT_FIELD_RADIUS_BIT) {
        const double bound = cndEmitterBoundingRadius(&light);
        return {light.position[2] - bound, light.position[2] + bound};
    }
    double half = 0;
    if (fields & CND_LIGHT_FIELD_AXIS_U_BIT)
        half += std::abs(double(light.axisU[2]));
    if (fields & CND_LIGHT_FIELD_AXIS_V_BIT)
        half += std::abs(double(light.axisV[2]));
    if (fields & CND_LIGHT_FIELD_RADIUS_BIT) {
        const bool flat = fields & CND_LIGHT_FIELD_DIRECTION_BIT;
        const double normal = flat ? double(light.direction[2]) : 0;
        half += radius * std::sqrt(std::max(0.0, 1 - normal * normal));
    }
    const double z = light.position[2];
    return {z - half, z + half};
}

} // namespace

Horizon horizonOf(const CndLight& light)
{
    const auto [low, high] = heights(light);
    return low >= 0 ? Horizon::Above : high <= 0 ? Horizon::Below : Horizon::Crossing;
}

double SampleSet::alphaOf(size_t i) const
{
    const float roughness = receivers[i].perceptualRoughness;
    return std::max(roughness * roughness, gpu::MIN_ALPHA);
}

SampleSet makeSamples(uint32_t lightType, uint32_t groups, uint64_t seed, LightScale scale)
{
    SampleSet out{
        .lightType = lightType, .groups = groups, .receivers = {}, .lights = {}, .samples = {}};
    Random random(seed, lightType);
    for (uint32_t i = 0; i < groups; ++i) {
        const Group g = makeGroup(lightType, i, groups, random);
        const std::vector<glm::dvec3> directions = directionsOf(g, random);
        for (size_t k = 0; k < directions.size(); ++k) {
            out.receivers.push_back({.n = {0, 0, 1},
                                     .v = glm::vec3(g.v),
                                     .perceptualRoughness = g.perceptualRoughness});
            out.lights.push_back(scaled(makeLight(lightType, g, directions[k]), scale));
            out.samples.push_back({.group = i,
                                   .scan = k >= 26 + 14,
                                   .horizon = horizonOf(out.lights.back()),
                                   .truth = {}});
        }
    }
    return out;
}

void integrateTruth(SampleSet& set, double relative, const std::function<void(size_t)>& onDone)
{
    parallelFor(
        set.samples.size(),
        [&](size_t i) {
            const reference::SurfacePoint surface{glm::dvec3(0), glm::dvec3(set.receivers[i].n),
                                                  glm::normalize(glm::dvec3(set.receivers[i].v))};
            if (set.samples[i].horizon != Horizon::Below)
                set.samples[i].truth = reference::truthResponse(
                    surface, set.alphaOf(i), set.lights[i], glm::dvec3(0), relative);
        },
        onDone);
}

} // namespace candelabra::app
