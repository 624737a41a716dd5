// SPDX-License-Identifier: Apache-2.0
// Laws that the shading of spheres must obey, whatever its accuracy: the limit of a point,
// reciprocity, no light from below the horizon, a sun as far away as the Sun.
#include <cmath>
#include <numbers>

#include "gpu/conic_probe.h"
#include "gpu/lighting_harness.h"
#include "measure/stability/stability.h"
#include "reference/brdf.h"
#include "reference/light.h"
#include "render/setting_names.h"

namespace candelabra::test
{
namespace
{

class LightLimits : public ConicProbeTest
{
protected:
    LightLimits() { random_.seed(77); }
};

} // namespace

// The luminance is pi s^2 f NoL, as for a point light of the same intensity; the difference is of
// order (s / alpha)^2.
TEST_F(LightLimits, SmallSpheresBecomePoints)
{
    for (const double s : {1e-1, 1e-2, 1e-3}) {
        std::vector<gpu::ConicProbeInput> inputs;
        std::vector<double> expected;
        for (int i = 0; i < 20000; ++i) {
            const glm::dvec3 v = direction(uniform(0.2, 1)), l = direction(uniform(0.2, 1));
            const double alpha = uniform(0.2, 1);
            inputs.push_back({glm::vec3(v), glm::vec3(l), float(s), float(alpha)});
            const double f = reference::ggxBrdf({0, 0, 1}, v, l, alpha).value;
            expected.push_back(std::numbers::pi * s * s * f * l.z);
        }
        const auto outputs = evaluate(inputs);
        double worst = 0;
        for (size_t i = 0; i < inputs.size(); ++i)
            worst = std::max(worst, std::abs(outputs[i].response.x / expected[i] - 1));
        std::cout << "s " << s << ": largest relative difference to the point light " << worst
                  << "\n";
        EXPECT_LE(worst, 2.5 * std::pow(s / 0.2, 2)); // 0.2: the smallest alpha
    }
}

// f(v, l) = f(l, v), tested with a light so small that it has only one direction.
TEST_F(LightLimits, EyeAndLightAreExchangeable)
{
    constexpr double s = 1e-3;
    std::vector<gpu::ConicProbeInput> inputs;
    for (int i = 0; i < 20000; ++i) {
        const glm::vec3 v(direction(uniform(0.1, 1))), l(direction(uniform(0.1, 1)));
        const float alpha = float(uniform(0.1, 1));
        inputs.push_back({v, l, float(s), alpha});
        inputs.push_back({l, v, float(s), alpha});
    }
    const auto outputs = evaluate(inputs);
    double worst = 0;
    for (size_t i = 0; i < inputs.size(); i += 2) {
        const double forth = outputs[i].response.x / inputs[i].toLight.z;
        const double back = outputs[i + 1].response.x / inputs[i + 1].toLight.z;
        worst = std::max(worst, std::abs(forth / back - 1));
    }
    std::cout << "largest relative difference after exchanging eye and light " << worst << "\n";
    EXPECT_LE(worst, 1e-3);
}

class LightLaws : public LightingTest
{
protected:
    // Returns a plane across the view at this distance. All its pixels have the same normal, a
    // random one.
    CpuGBuffer plane(uint32_t size, double distance)
    {
        CndCamera camera{};
        setPerspective(camera, 0.8, 1, 0.1);
        CpuGBuffer g = randomGBuffer(size, size, camera, 0, 1);
        g.depth.assign(g.depth.size(), depthAt(camera, distance));
        g.normalRoughness.assign(g.normalRoughness.size(), g.normalRoughness[0]);
        return g;
    }
};

TEST_F(LightLaws, NothingComesFromBelowTheHorizon)
{
    const CpuGBuffer g = plane(32, 5);
    const glm::dvec3 n = storedNormal(g, 0);
    std::vector<CndLight> lights;
    for (uint32_t i = 0; i < 30; ++i) {
        CndLight light{.type = i % 3 == 2 ? uint32_t{CND_LIGHT_DISTANT_SPHERE}
                                          : uint32_t{CND_LIGHT_SPHERE},
                       .radius = 0.1f + 0.02f * float(i),
                       .emission = {1000, 1000, 1000},
                       .influenceRadius = 1000};
        // The light is behind every plane through a surface sample, because samples are within 5 m
        // of (0, 0, -5).
        const glm::dvec3 centre = glm::dvec3(0, 0, -5) - n * (5.0 + light.radius + 0.01);
        for (int k = 0; k < 3; ++k) {
            light.position[k] = float(centre[k]);
            light.direction[k] = float(n[k]); // the direction in which it travels
        }
        if (light.type == CND_LIGHT_DISTANT_SPHERE)
            light.radius = 0.9f;
        lights.push_back(light);
    }
    for (const app::Choice<CndSpecularMethod>& method : app::specularChoices) {
        RunOptions options{.specular = method.value};
        for (const CndCulling culling : {CND_CULLING_CLUSTERED, CND_CULLING_BRUTE}) {
            options.culling = culling;
            for (const glm::vec4& pixel : run(g, lights, options).radiance)
                ASSERT_EQ(pixel, glm::vec4(0)) << method.name;
        }
    }
}

// Spots of different widths that light the same disc from as far away as that needs, along an axis
// with no special direction. In the narrow ones cosines of float would be wrong by the whole edge.
TEST_F(LightLaws, NarrowSpotsKeepTheirEdges)
{
    const CpuGBuffer g = plane(32, 5);
    const glm::dvec3 axis = glm::normalize(glm::dvec3(0.3, -0.5, -1));
    for (const double outer : {0.5, 0.02, 2e-3, 2e-4, 1e-4}) {
        for (const double share : {0.0, 0.5}) {
            CndLight spot{.type = CND_LIGHT_SPOT,
                          .influenceRadius = std::numeric_limits<float>::infinity(),
                          .innerConeAngle = float(share * outer),
                          .outerConeAngle = float(outer)};
            const double distance = 1.5 / std::tan(outer);
            for (int k = 0; k < 3; ++k) {
                spot.position[k] = float((glm::dvec3(0, 0, -5) - distance * axis)[k]);
                spot.direction[k] = float(axis[k]);
                spot.emission[k] = float(distance * distance);
            }
            const auto radiance = run(g, {spot}, {.specular = CND_SPECULAR_NONE}).radiance;
            double peak = 0, worst = 0;
            for (uint32_t i = 0; i < radiance.size(); ++i) {
                const glm::dvec3 position = viewPosition(g, i % g.width, i / g.width);
                const glm::dvec3 expected = reference::outgoingLuminance(
                    {position, storedNormal(g, i), glm::normalize(-position)},
                    {.diffuseAlbedo = storedAlbedo(g, i)}, spot, glm::dvec3(0), CND_SPECULAR_NONE);
                for (int c = 0; c < 3; ++c) {
                    peak = std::max(peak, expected[c]);
                    worst = std::max(worst, std::abs(double(radiance[i][c]) - expected[c]));
                }
            }
            std::cout << "spot of " << outer << " rad, inner angle " << share
                      << " of that: largest error " << worst / peak << " of the peak\n";
            EXPECT_GT(peak, 0);
            EXPECT_LE(worst, 5e-3 * peak);
        }
    }
}

// The Sun as a sphere at a distance of 149.6 million km with a radius of 696,000 km, and as a
// distant sphere. Then both with camera and scene 1,000 km from the origin.
// Where the horizon cuts the Sun, the lobe over the rest is the sum of the integrals along two arcs
// (lib/specular/conic_clip.glsl). In one pixel with alpha 0.017 the Sun is 124 degrees off the
// mirror direction, and the sum is 1e-8 of what it is there, less than the rounding of the arcs.
// Quotients and roots that are wrong by up to 2.5 ULP, as Vulkan allows, moved its luminance by up
// to 4e-7 of what a lobe with F = 1 has in the mirror direction, which was 2.5 times the pixel's
// own luminance. (That was before the axes of cut cones became less sensitive to rounding.) They
// moved no other pixel by more than 5e-5.
TEST_F(LightLaws, SunIsTheSameFromAfar)
{
    CpuGBuffer g = randomGBuffer(64, 48, plane(8, 5).camera, 0, 3);
    constexpr double distance = 149.6e9, radius = 6.96e8;
    const glm::dvec3 towards = glm::normalize(glm::dvec3(0.3, 0.8, 0.6));
    CndLight near{.type = CND_LIGHT_SPHERE,
                  .radius = float(radius),
                  .emission = {1.6e9f, 1.6e9f, 1.5e9f},
                  .influenceRadius = std::numeric_limits<float>::infinity()};
    CndLight sun = near;
    sun.type = CND_LIGHT_DISTANT_SPHERE;
    sun.radius = float(radius / distance);
    for (int k = 0; k < 3; ++k) {
        near.position[k] = float(towards[k] * distance);
        sun.direction[k] = float(-towards[k]);
    }
    const auto asSphere = run(g, {near}, {.specular = CND_SPECULAR_CONIC}).radiance;
    const auto asSun = run(g, {sun}, {.specular = CND_SPECULAR_CONIC}).radiance;
    double worst = 0;
    for (uint32_t i = 0; i < asSun.size(); ++i) {
        const glm::dvec3 n = storedNormal(g, i);
        const double NoV = -glm::dot(n, glm::normalize(viewPosition(g, i % g.width, i / g.width)));
        const double alpha = std::max(std::pow(storedRoughness(g, i), 2), double(gpu::MIN_ALPHA));
        const double s = radius / distance;
        const bool isCut = std::abs(glm::dot(n, towards)) < s;
        const double rounding = isCut && !device().lanesAreCpuVector
                                    ? 1e-6 * app::onAxisResponse(s, alpha, std::max(NoV, 0.02))
                                    : 0;
        for (int c = 0; c < 3; ++c) {
            const double error = std::abs(double(asSphere[i][c]) - double(asSun[i][c]));
            const double allowed = rounding * double(sun.emission[c]);
            if (asSun[i][c] > 0)
                worst = std::max(worst, (error - allowed) / double(asSun[i][c]));
        }
    }
    std::cout << "Sun at 149.6e9 m: largest relative difference to the distant sphere " << worst
              << "\n";
    EXPECT_LE(worst, 1e-3);

    CpuGBuffer far = g;
    RunOptions options{.specular = CND_SPECULAR_CONIC, .lightOrigin = {1e6, -1e6, 1e6}};
    for (int k = 0; k < 3; ++k)
        far.camera.viewFromWorld[12 + k] = -options.lightOrigin[k];
    const auto sunFar = run(far, {sun}, options).radiance;
    EXPECT_EQ(maxRelativeDifference(sunFar, asSun), 0);
}

} // namespace candelabra::test
