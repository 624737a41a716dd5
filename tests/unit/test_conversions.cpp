// SPDX-License-Identifier: Apache-2.0
// Tests the photometric conversions of the public interface against irradiance computed in double
// precision.
#include <cmath>
#include <iostream>
#include <random>
#include <string>

#include <gtest/gtest.h>

#include "candelabra/candelabra.hpp"
#include "harness/constants.h"
#include "reference/sphere_light.h"
#include "reference/truth.h"
#include "scene/polygons.h"

namespace candelabra::test
{

namespace
{

glm::dvec3 doubleVector(const float (&v)[3])
{
    return {v[0], v[1], v[2]};
}

CndLight light(CndLightType type)
{
    return {.type = uint32_t(type),
            .position = {1, 2, -3},
            .radius = 0.25f,
            .direction = {0.6f, -0.8f, 0},
            .emission = {100, 200, 50},
            .influenceRadius = infinity,
            .innerConeAngle = 0.2f,
            .outerConeAngle = 0.7f,
            .axisU = {0.5f, 0, 0},
            .axisV = {0, 0.3f, 0.4f},
            .polygon = app::regularPolygon(6)};
}

// Returns the irradiance, in the green channel, of a surface at `at` that faces the light's centre,
// with the window; the whole emitter is above its horizon.
double irradianceFacing(const CndLight& l, const glm::dvec3& at)
{
    const glm::dvec3 toLight = doubleVector(l.position) - at;
    const double distance = glm::length(toLight);
    const double emission = l.emission[1];
    const double w =
        l.influenceRadius > 0 ? reference::lightWindow(distance, l.influenceRadius) : 1;
    switch (l.type) {
    case CND_LIGHT_POINT:
        return emission / (distance * distance) * w;
    case CND_LIGHT_SPHERE:
        return pi * emission * reference::sphereFormFactor(1, double(l.radius) / distance) * w;
    case CND_LIGHT_DISTANT_SPHERE:
        return pi * emission * reference::sphereFormFactor(1, double(l.radius));
    default:
        return emission; // directional
    }
}

// Returns the luminous power in the green channel: the irradiance of a large sphere around the
// light, integrated (Gauss-Legendre with 12 nodes along the axis, 24 steps around it).
double powerThroughSphere(const CndLight& l)
{
    // Abramowitz and Stegun 1964, table 25.4, n = 12.
    constexpr double nodes[] = {0.125233408511469, 0.367831498998180, 0.587317954286617,
                                0.769902674194305, 0.904117256370475, 0.981560634246719};
    constexpr double weights[] = {0.249147045813403, 0.233492536538355, 0.203167426723066,
                                  0.160078328543346, 0.106939325995318, 0.047175336386512};
    constexpr double distance = 3;
    double power = 0;
    for (int i = 0; i < 24; ++i)
        for (int k = 0; k < 24; ++k) {
            const double node = i % 12 < 6 ? nodes[i % 6] : -nodes[i % 6];
            const double z = (i < 12 ? 0.5 : -0.5) * (1 + node);
            const double phi = 2 * pi * (k + 0.5) / 24, r = std::sqrt(1 - z * z);
            // The luminance of a flat light jumps at its plane, so z is taken along the normal.
            const glm::dvec3 normal = cndLightFields(l.type) & CND_LIGHT_FIELD_DIRECTION_BIT
                                          ? glm::dvec3(0.6, -0.8, 0)
                                          : glm::dvec3(0, -0.8, 0.6);
            const glm::dvec3 x(normal.z, 0, -normal.x), u = glm::normalize(x);
            const glm::dvec3 direction =
                z * normal + r * (std::cos(phi) * u + std::sin(phi) * glm::cross(normal, u));
            const reference::SurfacePoint receiver{doubleVector(l.position) + distance * direction,
                                                   -direction, -direction};
            const double f = reference::truthResponse(receiver, 0, l, glm::dvec3(0), 1e-7).f;
            const double weight = weights[i % 6] / 2 * 2 * pi / 24 * distance * distance;
            power += weight * pi * double(l.emission[1]) * f;
        }
    return power;
}

TEST(Conversions, PowerIsWhatASurroundingSphereReceives)
{
    for (uint32_t type = 0; type < CND_LIGHT_TYPE_COUNT; ++type)
        for (const bool twoSided : {false, true}) {
            if (cndIsDistant(type) || cndIsPunctual(type))
                continue;
            CndLight l = light(CndLightType(type));
            l.twoSided = twoSided;
            float power[3];
            CndError error{};
            ASSERT_EQ(cndLuminousPowerOfLight(&l, power, &error), CND_SUCCESS) << error.message;
            const double received = powerThroughSphere(l);
            std::cout << "type " << type << (twoSided ? " two-sided" : "") << ": emits " << power[1]
                      << " lm, a sphere around it receives " << received << " lm, error "
                      << std::abs(received / double(power[1]) - 1) << '\n';
            EXPECT_NEAR(received / double(power[1]), 1, 1e-4);
            EXPECT_FLOAT_EQ(power[0], power[1] / 2);
        }
}

TEST(Conversions, LuminanceFromPowerIsTheInverseOfPower)
{
    CndLight l = light(CND_LIGHT_TUBE);
    const auto powerOf = [&] {
        float power[3] = {};
        EXPECT_EQ(cndLuminousPowerOfLight(&l, power, nullptr), CND_SUCCESS);
        return power[1];
    };
    EXPECT_FLOAT_EQ(cndTubeLuminanceFromPower(powerOf(), 1, 0.25f), 200);
    // A tube without length is a sphere.
    EXPECT_EQ(cndTubeLuminanceFromPower(7, 0, 0.25f), cndSphereLuminanceFromPower(7, 0.25f));
    for (const VkBool32 twoSided : {VK_FALSE, VK_TRUE}) {
        l = light(CND_LIGHT_RECTANGLE);
        l.twoSided = twoSided;
        EXPECT_FLOAT_EQ(cndRectangleLuminanceFromPower(powerOf(), 1, 1, twoSided), 200);
        l = light(CND_LIGHT_DISC);
        l.twoSided = twoSided;
        EXPECT_FLOAT_EQ(cndDiscLuminanceFromPower(powerOf(), 0.25f, twoSided), 200);
        l = light(CND_LIGHT_POLYGON);
        l.twoSided = twoSided;
        EXPECT_FLOAT_EQ(cndPolygonLuminanceFromPower(powerOf(), &l), 200);
    }
    l = light(CND_LIGHT_SPHERE);
    EXPECT_FLOAT_EQ(cndSphereLuminanceFromPower(powerOf(), 0.25f), 200);
    l = light(CND_LIGHT_POINT);
    EXPECT_FLOAT_EQ(powerOf(), float(4 * pi * 200));
    // A cone with hard edges and a half angle of 90 degrees contains half of all directions.
    l = light(CND_LIGHT_SPOT);
    l.innerConeAngle = l.outerConeAngle = float(pi / 2);
    EXPECT_FLOAT_EQ(powerOf(), float(2 * pi * 200));
    // Smooth edges, integrated by the midpoint rule over the cosine with the spot's own
    // attenuation.
    l = light(CND_LIGHT_SPOT);
    double sum = 0;
    constexpr int steps = 200000;
    const double inner = std::cos(double(l.innerConeAngle));
    const double outer = std::cos(double(l.outerConeAngle));
    for (int i = 0; i < steps; ++i) {
        const double c = outer + (1 - outer) * (i + 0.5) / steps;
        const double t = std::min((c - outer) / (inner - outer), 1.0);
        sum += t * t * (1 - outer) / steps;
    }
    EXPECT_NEAR(double(powerOf()) / (2 * pi * 200 * sum), 1, 1e-6);
}

// With constant power the irradiance stays the same while the radius shrinks a millionfold.
TEST(Conversions, ConstantPowerRadiusSweep)
{
    const glm::dvec3 at(1, 2, 2);
    const double wanted = 1500 / (4 * pi * 25); // Phi / (4 pi d^2)
    double worst = 0;
    for (double radius = 4; radius > 4e-6; radius /= 1.7) {
        CndLight l = light(CND_LIGHT_SPHERE);
        l.radius = float(radius);
        l.emission[1] = cndSphereLuminanceFromPower(1500, l.radius);
        worst = std::max(worst, std::abs(irradianceFacing(l, at) / wanted - 1));
    }
    std::cout << "1500 lm at 5 m, radius 4 m to 4 um: irradiance off by at most " << worst << '\n';
    EXPECT_LE(worst, 2e-7);
}

// Converts random lights there and back: the irradiance at the receiver stays the same to single
// precision.
TEST(Conversions, IrradianceIsMatched)
{
    std::mt19937 random(7);
    const auto uniform = [&](double a, double b) {
        return a + (b - a) * (double(random()) / 4294967296.0);
    };
    double worst[5] = {};
    const auto expectSame = [&](int kind, const Result<CndLight>& to, const CndLight& from,
                                const glm::dvec3& at) {
        ASSERT_TRUE(to) << kind << ": " << to.error().message;
        const CndLight l = Result<CndLight>(to).value();
        const double error = std::abs(irradianceFacing(l, at) / irradianceFacing(from, at) - 1);
        worst[kind] = std::max(worst[kind], error);
    };
    for (int i = 0; i < 20000; ++i) {
        const double scale = std::pow(10, uniform(-3, 6));
        const float at[3] = {float(scale * uniform(-1, 1)), float(scale * uniform(-1, 1)),
                             float(scale * uniform(-1, 1))};
        const glm::dvec3 receiver(at[0], at[1], at[2]);
        CndLight point = light(CND_LIGHT_POINT);
        const double away = scale * std::pow(10, uniform(-2, 3));
        for (int k = 0; k < 3; ++k)
            point.position[k] = at[k] + float(away * uniform(0.2, 1));
        const double distance = glm::length(doubleVector(point.position) - receiver);
        point.emission[1] = float(std::pow(10, uniform(-6, 6)));
        if (i % 2)
            point.influenceRadius = float(distance * uniform(1.1, 30));
        const float radius = i % 3 ? float(distance * std::pow(10, uniform(-5, -0.1))) : 0.0f;
        if (!(radius < point.influenceRadius))
            continue;
        const auto sphere = sphereFromPoint(point, at, radius);
        expectSame(0, sphere, point, receiver);
        const CndLight from = Result<CndLight>(sphere).value();
        expectSame(1, pointFromSphere(from), from, receiver);
        expectSame(2, directionalFromSphere(from, at), from, receiver);

        CndLight sun = light(CND_LIGHT_DIRECTIONAL);
        sun.emission[1] = float(std::pow(10, uniform(-3, 6)));
        const float sine = i % 3 ? float(std::pow(10, uniform(-4, -0.01))) : 0.0f;
        const auto distant = distantSphereFromDirectional(sun, sine);
        expectSame(3, distant, sun, receiver);
        const CndLight distantSphere = Result<CndLight>(distant).value();
        expectSame(3, directionalFromDistantSphere(distantSphere), distantSphere, receiver);
        const float metres = i % 2 ? float(scale * std::pow(10, uniform(0, 5))) : 0.0f;
        expectSame(4, sphereFromDirectional(sun, at, metres, sine), sun, receiver);
    }
    const char* names[] = {"point to sphere", "sphere to point", "sphere to directional",
                           "directional to distant sphere and back", "directional to sphere"};
    for (int kind = 0; kind < 5; ++kind) {
        std::cout << names[kind] << ": irradiance off by at most " << worst[kind] << '\n';
        EXPECT_GT(worst[kind], 0);
        EXPECT_LE(worst[kind], 1e-6) << names[kind];
    }
}

TEST(Conversions, LayersAreKept)
{
    const float at[3] = {1, 2, 3};
    const auto with = [](CndLightType type) {
        CndLight l = light(type);
        l.layers = 5;
        return l;
    };
    const CndLight point = with(CND_LIGHT_POINT), sphere = with(CND_LIGHT_SPHERE),
                   sun = with(CND_LIGHT_DISTANT_SPHERE), directional = with(CND_LIGHT_DIRECTIONAL);
    EXPECT_EQ(sphereFromPoint(point, at).value().layers, 5u);
    EXPECT_EQ(pointFromSphere(sphere).value().layers, 5u);
    EXPECT_EQ(distantSphereFromDirectional(directional).value().layers, 5u);
    EXPECT_EQ(directionalFromDistantSphere(sun).value().layers, 5u);
    EXPECT_EQ(sphereFromDirectional(directional, at).value().layers, 5u);
    EXPECT_EQ(directionalFromSphere(sphere, at).value().layers, 5u);
}

TEST(Conversions, ChosenSizesFitSinglePrecision)
{
    for (const double distance : {1e-6, 1.0, 1e4, 1e12}) {
        CndLight point = light(CND_LIGHT_POINT);
        point.position[0] = 0, point.position[1] = float(distance), point.position[2] = 0;
        const float at[3] = {};
        auto sphere = sphereFromPoint(point, at);
        ASSERT_TRUE(sphere) << sphere.error().message;
        EXPECT_FLOAT_EQ(sphere.value().radius, float(distance / 1000));
    }
    for (const float at : {0.0f, 3e5f, 1e14f}) {
        const float receiver[3] = {at, 0, 0};
        const CndLight sun = light(CND_LIGHT_DIRECTIONAL);
        auto sphere = sphereFromDirectional(sun, receiver);
        ASSERT_TRUE(sphere) << sphere.error().message;
        const glm::dvec3 toLight = doubleVector(sphere.value().position) - doubleVector(receiver);
        const double distance = glm::length(toLight);
        EXPECT_NEAR(distance / std::max(1e6, double(at)), 1, 1e-6);
        EXPECT_NEAR(double(sphere.value().radius) / distance, double(CND_SUN_SINE), 1e-8);
        const double angle =
            glm::length(toLight / distance + glm::normalize(doubleVector(sun.direction)));
        std::cout << "receiver at " << at << " m: the light's direction is off by " << angle
                  << " rad\n";
        EXPECT_LE(angle, 1.2e-7);
    }
    CndLight near = light(CND_LIGHT_POINT); // the receiver is far outside the light's influence
    near.influenceRadius = 0.5f;
    const float far[3] = {1e6f, 0, 0};
    auto sphere = sphereFromPoint(near, far);
    ASSERT_TRUE(sphere) << sphere.error().message;
    EXPECT_FLOAT_EQ(sphere.value().radius, 0.125f);
}

TEST(Conversions, ErrorsAreOneSentence)
{
    const float at[3] = {1, 2, 0}, inside[3] = {1, 2, -3};
    const CndLight point = light(CND_LIGHT_POINT), sphere = light(CND_LIGHT_SPHERE),
                   sun = light(CND_LIGHT_DIRECTIONAL);
    CndLight other{};
    const auto expect = [](const Result<CndLight>& result, const char* part) {
        ASSERT_FALSE(result) << part;
        EXPECT_EQ(result.error().code, CND_ERROR_INVALID_ARGUMENT);
        EXPECT_NE(std::string(result.error().message).find(part), std::string::npos)
            << result.error().message;
    };
    expect(sphereFromPoint(sphere, at), "of another type");
    expect(sphereFromPoint(point, at, -1), "radius must be >= 0 and smaller than the distance");
    expect(sphereFromPoint(point, at, NAN), "radius must be >= 0 and smaller than the distance");
    expect(sphereFromPoint(point, at, 4), "which is 3.000000 m");
    expect(sphereFromPoint(point, inside), "smaller than the distance");
    expect(sphereFromPoint(point, {NAN, 0, 0}), "at must be finite");
    expect(sphereFromPoint(point, at, 1e-30f), "not a finite float");
    other = point;
    other.influenceRadius = 0.5f;
    expect(sphereFromPoint(other, at, 0.5f), "smaller than influenceRadius");
    expect(pointFromSphere(point), "of another type");
    expect(directionalFromSphere(sphere, inside), "outside the sphere light");
    expect(distantSphereFromDirectional(sun, 1.5f), "sine must be between 0 and 1");
    expect(distantSphereFromDirectional(point), "of another type");
    other = sun;
    other.direction[1] = 3;
    expect(distantSphereFromDirectional(other), "direction");
    expect(sphereFromDirectional(sun, at, -1), "distance must be >= 0");
    expect(sphereFromDirectional(sun, at, 1e16f), "farther than 1e15 m");
    expect(sphereFromDirectional(sun, at, 10, 1), "inside the light");
    expect(directionalFromDistantSphere(sun), "of another type");

    float power[3] = {-1, -1, -1};
    CndError error{};
    EXPECT_EQ(cndLuminousPowerOfLight(&sun, power, &error), CND_ERROR_INVALID_ARGUMENT);
    EXPECT_NE(std::string(error.message).find("no luminous power"), std::string::npos);
    EXPECT_EQ(power[0], -1);
    EXPECT_EQ(cndLuminousPowerOfLight(nullptr, power, &error), CND_ERROR_INVALID_ARGUMENT);
    EXPECT_EQ(cndSphereFromPoint(&point, 0, at, nullptr, nullptr), CND_ERROR_INVALID_ARGUMENT);
}

} // namespace

} // namespace candelabra::test
