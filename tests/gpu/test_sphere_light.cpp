// SPDX-License-Identifier: Apache-2.0
// Tests the shipping float32 shader functions of sphere lights against double precision.
#include <cmath>

#include "candelabra_probes.h"
#include "gpu/probe.h"
#include "reference/sphere_light.h"

namespace candelabra::test
{
namespace
{

class SphereLight : public ProbeTest
{
protected:
    SphereLight() { random_.seed(12345); }
    std::vector<gpu::SphereProbeOutput> evaluate(const std::vector<gpu::SphereProbeInput>& inputs)
    {
        return runProbe<gpu::SphereProbeOutput>(spirv::sphere_light_comp, inputs);
    }
};

reference::SurfacePoint surfaceOf(const gpu::SphereProbeInput& in)
{
    return {glm::dvec3(0), glm::dvec3(in.n), glm::normalize(glm::dvec3(in.v))};
}

} // namespace

// Where the sphere crosses the horizon, F is at most about s^3, which is the natural scale of its
// error. Elsewhere F is the product c s^2, exact but for rounding.
TEST_F(SphereLight, FormFactorIsExactToThreeTenMillionths)
{
    std::vector<gpu::SphereProbeInput> inputs;
    for (int i = 0; i < 400000; ++i) {
        const double s = std::pow(10.0, uniform(-5, 0));
        // Two thirds are near the horizon, including tangency, the rest anywhere.
        const double c = i % 3 ? std::clamp(uniform(-1.02, 1.02) * s, -1.0, 1.0) : uniform(-1, 1);
        inputs.push_back({.n = {0, 0, 1},
                          .v = {0, 0, 1},
                          .centre = {0, 0, 1},
                          .radius = 0.5f,
                          .alpha = 0.5f,
                          .c = float(c),
                          .s2 = float(s * s)});
    }
    inputs[0].c = inputs[1].c = 0;
    inputs[1].s2 = inputs[2].s2 = inputs[3].s2 = 1;
    inputs[2].c = 1;
    inputs[3].c = -1;
    const auto outputs = evaluate(inputs);
    double worst = 0, worstAbove = 0;
    size_t worstAt = 0;
    for (size_t i = 0; i < inputs.size(); ++i) {
        const double c = inputs[i].c, s = std::sqrt(double(inputs[i].s2));
        const double expected = reference::sphereFormFactor(c, s);
        const double difference = std::abs(outputs[i].formFactor - expected);
        if (std::abs(c) >= s) {
            worstAbove = std::max(worstAbove, difference / std::max(expected, 1e-30));
            continue;
        }
        const double error = difference / (s * s * s);
        if (!(error <= worst)) {
            worst = error;
            worstAt = i;
        }
    }
    std::cout << "largest form factor error: crossing " << worst << " s^3, above " << worstAbove
              << " relative\n";
    EXPECT_LE(worst, 3e-7) << "s2 " << inputs[worstAt].s2 << " c " << inputs[worstAt].c;
    EXPECT_LE(worstAbove, 1.2e-7);
}

TEST_F(SphereLight, KarisMatchesDouble)
{
    std::vector<gpu::SphereProbeInput> inputs;
    for (int i = 0; i < 200000; ++i) {
        const double perceptualRoughness = uniform(0.0448, 1);
        const double s = std::pow(10.0, uniform(-3, -0.05));
        const double distance = std::pow(10.0, uniform(-2, 3));
        const glm::dvec3 v = direction(uniform(0.05, 1));
        const glm::dvec3 mirror(-v.x, -v.y, v.z);
        const double spread = s + 2 * perceptualRoughness * perceptualRoughness;
        glm::dvec3 l = mirror + spread * uniform(0, 2) * direction(uniform(-1, 1));
        l = glm::length(l) > 0.01 ? glm::normalize(l) : mirror;
        inputs.push_back({.n = {0, 0, 1},
                          .v = glm::vec3(v),
                          .centre = glm::vec3(l * distance),
                          .radius = float(s * distance),
                          .alpha = float(perceptualRoughness * perceptualRoughness)});
    }
    const auto outputs = evaluate(inputs);
    double worst = 0;
    size_t worstAt = 0;
    for (size_t i = 0; i < inputs.size(); ++i) {
        const gpu::SphereProbeInput& in = inputs[i];
        // The shader evaluates sqrt(alpha)^2 in float32.
        const float roughness = std::sqrt(in.alpha);
        const double alpha = double(roughness * roughness);
        const reference::SpecularResponse expected =
            reference::karisSphereSpecular(surfaceOf(in), alpha, glm::dvec3(in.centre), in.radius);
        ASSERT_TRUE(std::isfinite(outputs[i].a) && outputs[i].a >= 0) << i;
        // Rounding of the directions (6e-8) moves the lobe by that amount relative to alpha.
        const double scale = expected.a * (1 + 0.01 / alpha) + 1e-4;
        const double error =
            std::max(std::abs(outputs[i].a - expected.a), std::abs(outputs[i].b - expected.b)) /
            scale;
        if (!(error <= worst)) {
            worst = error;
            worstAt = i;
        }
    }
    const gpu::SphereProbeInput& in = inputs[worstAt];
    std::cout << "largest karis error: " << worst << "\n";
    EXPECT_LE(worst, 3e-4) << "alpha " << in.alpha << " radius " << in.radius << " centre "
                           << in.centre.x << " " << in.centre.y << " " << in.centre.z << " v "
                           << in.v.x << " " << in.v.y << " " << in.v.z;
}

// Degenerate geometry: V = N, L = N, L on the mirror ray, grazing views, receivers inside, tiny and
// huge scales.
TEST_F(SphereLight, NeverNanNegativeOrInfinite)
{
    const std::vector<glm::vec3> directions = {{0, 0, 1},      {0, 0, -1},      {1, 0, 0},
                                               {1, 0, 1e-3f},  {0.6f, 0, 0.8f}, {-0.6f, 0, 0.8f},
                                               {1, 0, -1e-4f}, {1e-20f, 0, 1}};
    std::vector<gpu::SphereProbeInput> inputs;
    for (const glm::vec3& v : directions)
        for (const glm::vec3& l : directions)
            for (const float distance : {0.0f, 1e-20f, 1e-6f, 1.0f, 1e7f, 1e18f})
                for (const float s : {1e-7f, 1e-3f, 0.5f, 1 - 1e-6f, 1.0f, 1 + 1e-6f, 100.0f})
                    for (const float alpha : {0.0f, 1e-6f, 0.002f, 0.1f, 1.0f})
                        inputs.push_back({.n = {0, 0, 1},
                                          .v = v,
                                          .centre = l * distance,
                                          .radius = s * std::max(distance, 1e-6f),
                                          .alpha = alpha});
    const auto outputs = evaluate(inputs);
    for (size_t i = 0; i < inputs.size(); ++i)
        for (const float value : {outputs[i].formFactor, outputs[i].a, outputs[i].b})
            ASSERT_TRUE(std::isfinite(value) && value >= 0)
                << value << " at " << i << ": alpha " << inputs[i].alpha << " radius "
                << inputs[i].radius << " centre " << inputs[i].centre.x << " " << inputs[i].centre.z
                << " v " << inputs[i].v.x << " " << inputs[i].v.z;
}

} // namespace candelabra::test
