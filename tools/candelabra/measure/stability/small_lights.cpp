// SPDX-License-Identifier: Apache-2.0
// Compares the responses to small lights with those to points.
#include <algorithm>
#include <cmath>
#include <numbers>

#include <fmt/format.h>

#include "generate/random.h"
#include "measure/kernels/vectors.h"
#include "measure/stability/stability.h"
#include "reference/brdf.h"
#include "reference/response.h"
#include "scene/polygons.h"

namespace candelabra::app
{
namespace
{

using std::numbers::pi;

struct SmallLight {
    CndLight light;
    double solidAngle; // to first order
};

// Returns a light in this direction whose longest half axis is `size` times its distance.
SmallLight makeLight(uint32_t type, const glm::dvec3& direction, double size, Random& random)
{
    const double distance = std::pow(10.0, double(random.uniform(-1, 2)));
    const double length = size * distance;
    const double aspect = std::pow(10.0, double(random.uniform(-2, 0)));
    // Tilted by up to 75 degrees from facing the receiver.
    const double tilt = double(random.uniform(0, 75)) * pi / 180;
    const reference::Frame frame =
        reference::frameAround(-direction, polar(std::acos(double(random.uniform(-1, 1))),
                                                 2 * pi * double(random.uniform())));
    const glm::dvec3 normal = std::cos(tilt) * frame.z + std::sin(tilt) * frame.x;
    const glm::dvec3 u = std::cos(tilt) * frame.x - std::sin(tilt) * frame.z;
    SmallLight out{.light = {.type = type}, .solidAngle = pi * size * size};
    set(out.light.position, distance * direction);
    set(out.light.direction, normal);
    out.light.radius = float(length);
    if (cndIsDistant(type)) {
        set(out.light.direction, -direction);
        out.light.radius = float(size);
    }
    const uint32_t fields = cndLightFields(type);
    if (fields & CND_LIGHT_FIELD_AXIS_U_BIT) {
        set(out.light.axisU, length * u);
        set(out.light.axisV, length * aspect * frame.y);
        out.solidAngle = 4 * size * size * aspect * std::cos(tilt);
    } else if (fields & CND_LIGHT_FIELD_TWO_SIDED_BIT) {
        out.solidAngle *= std::cos(tilt);
    }
    if (fields & CND_LIGHT_FIELD_POLYGON_BIT) {
        // Regular ones: their light comes from the centre in the mean.
        const uint32_t corners = 3 + random.below(CND_MAX_CORNERS - 2);
        out.light.polygon = regularPolygon(corners);
        // Its share of the rectangle around it.
        out.solidAngle *= 0.125 * corners * std::sin(2 * pi / corners);
    }
    if (fields & CND_LIGHT_FIELD_AXIS_U_BIT && fields & CND_LIGHT_FIELD_RADIUS_BIT) {
        out.light.radius = float(length * aspect);
        // The outline of a tube: a rectangle and two half discs.
        out.solidAngle += pi * size * size * aspect * aspect;
    }
    return out;
}

} // namespace

SmallLightCheck checkSmallLights(const VulkanContext& context, const Evaluation& evaluation,
                                 uint32_t samples, uint64_t seed)
{
    Random random(seed, 302);
    std::vector<gpu::BenchReceiver> receivers;
    std::vector<CndLight> lights;
    std::vector<double> expected, sizes;
    while (lights.size() < samples) {
        const float roughness = random.uniform(0.045f, 1);
        const double alpha = std::max(double(roughness * roughness), double(gpu::MIN_ALPHA));
        const double view = double(random.uniform(0, 80)) * pi / 180;
        const glm::dvec3 v = polar(view, 2 * pi * double(random.uniform()));
        const glm::dvec3 mirror(-v.x, -v.y, v.z);
        const double away = 3 * alpha * double(random.uniform());
        const glm::dvec3 direction =
            glm::normalize(mirror + away * polar(std::acos(double(random.uniform(-1, 1))),
                                                 2 * pi * double(random.uniform())));
        const double largest = 0.003 * alpha * v.z;
        const double size = largest * std::pow(10.0, double(random.uniform(-3, 0)));
        if (direction.z < 0.05)
            continue;
        const SmallLight small = makeLight(evaluation.lightType, direction, size, random);
        // As the shader sees them, in float.
        const glm::dvec3 seen = glm::normalize(glm::dvec3(glm::vec3(v)));
        const bool distant = cndIsDistant(evaluation.lightType);
        const float* to = distant ? small.light.direction : small.light.position;
        const glm::dvec3 place = (distant ? -1.0 : 1.0) * glm::dvec3(to[0], to[1], to[2]);
        const glm::dvec3 l = glm::normalize(place);
        receivers.push_back({.n = {0, 0, 1}, .v = glm::vec3(v), .perceptualRoughness = roughness});
        lights.push_back(small.light);
        sizes.push_back(size);
        expected.push_back(small.solidAngle * l.z *
                           reference::ggxBrdf({0, 0, 1}, seen, l, alpha).value);
    }
    const auto responses = LightEvaluator(context, evaluation).evaluate(receivers, lights);
    SmallLightCheck out{.evaluation = evaluation, .samples = responses.size(), .worst = {}};
    std::vector<double> errors;
    for (size_t i = 0; i < responses.size(); ++i) {
        errors.push_back(std::abs(double(responses[i].a) / expected[i] - 1));
        if (!(errors.back() <= out.max)) { // NaN counts as the worst error
            out.max = errors.back();
            const double roughness = double(receivers[i].perceptualRoughness);
            out.worst =
                fmt::format("alpha {:.4f}, NoV {:.4f}, NoL {:.4f}, size {:.2e}",
                            roughness * roughness, receivers[i].v.z,
                            lights[i].position[2] /
                                glm::length(glm::dvec3(lights[i].position[0], lights[i].position[1],
                                                       lights[i].position[2])),
                            sizes[i]);
        }
    }
    std::sort(errors.begin(), errors.end());
    out.median = errors[errors.size() / 2];
    out.p99 = errors[errors.size() * 99 / 100];
    return out;
}

} // namespace candelabra::app
