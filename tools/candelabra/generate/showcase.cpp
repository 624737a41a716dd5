// SPDX-License-Identifier: Apache-2.0
// One light of every type over balls of several roughnesses, on a floor that shows reflections:
// what each type looks like, side by side.
#include <algorithm>
#include <string>

#include <glm/gtc/constants.hpp>

#include "generate/generators.h"
#include "generate/lights.h"
#include "generate/scene_builder.h"
#include "scene/scene_error.h"

namespace candelabra::app
{

namespace
{

// Stations stand in a row along x, one per light that has a place; the camera looks along -z.
constexpr int stationCount = 6;
constexpr double spacing = 1.7; // metres
constexpr double ballRadius = 0.36;
constexpr float luminousPower = 600; // lm of each lamp: a bulb of 40 W of old

double stationX(int station)
{
    return (station - 0.5 * (stationCount - 1)) * spacing;
}

void addBalls(SceneBuilder& b)
{
    const auto add = [&](const glm::dvec3& center, uint32_t material) {
        AnalyticObject ball;
        ball.type = AnalyticObject::Type::Ball;
        ball.point = center;
        ball.radius = ballRadius;
        ball.material = material;
        b.scene.analyticObjects.push_back(ball);
    };
    const float roughnesses[stationCount] = {0.08f, 0.2f, 0.35f, 0.5f, 0.7f, 1.0f};
    for (int i = 0; i < stationCount; ++i) {
        const std::string roughness = std::to_string(roughnesses[i]).substr(0, 4);
        // F0 of aluminium: Lagarde 2011, "Feeding a physically based shading model" (linear).
        add({stationX(i) - 0.41, ballRadius, 0.1},
            b.addMetal("aluminium, roughness " + roughness, {0.913f, 0.921f, 0.925f},
                       roughnesses[i]));
        add({stationX(i) + 0.41, ballRadius, 0.1},
            b.addDielectric("red paint, roughness " + roughness, {0.5f, 0.06f, 0.04f},
                            roughnesses[i]));
    }
}

void set(float (&out)[3], const glm::vec3& v)
{
    for (int i = 0; i < 3; ++i)
        out[i] = v[i];
}

// Emission of `colour` (luminance 1), scaled so that the lamp emits luminousPower.
void setPower(CndLight& light, const glm::vec3& colour)
{
    set(light.emission, glm::vec3(1));
    float power[3] = {};
    cndLuminousPowerOfLight(&light, power, nullptr);
    set(light.emission, luminousPower / power[1] * colour);
}

// A lamp over the station, a little behind the balls; flat ones face down and towards the camera.
CndLight makeLamp(CndLightType type, int station, const glm::vec3& colour)
{
    CndLight light{};
    light.type = type;
    set(light.position, {static_cast<float>(stationX(station)), 1.75f, -0.9f});
    light.influenceRadius = 7;
    const glm::vec3 down = glm::normalize(glm::vec3(0, -1, 0.7f));
    const glm::vec3 up = glm::cross(glm::vec3(1, 0, 0), down); // in the plane of a flat lamp
    switch (type) {
    case CND_LIGHT_SPHERE:
        light.radius = 0.22f;
        break;
    case CND_LIGHT_SPOT:
        set(light.direction, down);
        light.innerConeAngle = 0.25f;
        light.outerConeAngle = 0.6f;
        break;
    case CND_LIGHT_TUBE:
        light.radius = 0.035f;
        set(light.axisU, {0.5f, 0.12f, 0.1f});
        break;
    case CND_LIGHT_RECTANGLE:
        set(light.axisU, {0.5f, 0, 0});
        set(light.axisV, 0.22f * up);
        if (glm::dot(glm::cross(glm::vec3(1, 0, 0), up), down) < 0)
            set(light.axisV, -0.22f * up);
        break;
    case CND_LIGHT_DISC:
        light.radius = 0.3f;
        set(light.direction, down);
        light.twoSided = VK_TRUE;
        break;
    default:
        break;
    }
    setPower(light, colour);
    return light;
}

// Weak, so that the lamps are what is seen: dusk.
void addDistantLights(Scene& scene)
{
    CndLight sky{};
    sky.type = CND_LIGHT_DIRECTIONAL;
    set(sky.direction, glm::normalize(glm::vec3(0.5f, -1, -0.6f)));
    set(sky.emission, 6.0f * blackbodyColour(12000)); // lx
    scene.lights.push_back(sky);
    // A sun four times as wide as the real one, behind the lamps in the picture.
    CndLight evening{};
    evening.type = CND_LIGHT_DIRECTIONAL;
    set(evening.direction, glm::normalize(glm::vec3(-0.16f, -0.1f, 1)));
    set(evening.emission, 8.0f * blackbodyColour(2400)); // lx, facing it
    CndLight sun{};
    cndDistantSphereFromDirectional(&evening, 4 * CND_SUN_SINE, &sun, nullptr);
    scene.lights.push_back(sun);
}

} // namespace

Scene generateShowcase(const SceneOptions& options)
{
    if (options.lights.value_or(0))
        throw SceneError("showcase: lights: it has one light of every type, no number to choose");
    SceneBuilder b;
    b.scene.name = "showcase";
    AnalyticObject ground;
    ground.material = b.addDielectric("floor", {0.22f, 0.23f, 0.25f}, 0.25f);
    b.scene.analyticObjects.push_back(ground);
    addBalls(b);

    const CndLightType lamps[stationCount] = {CND_LIGHT_POINT,     CND_LIGHT_SPOT,
                                              CND_LIGHT_SPHERE,    CND_LIGHT_TUBE,
                                              CND_LIGHT_RECTANGLE, CND_LIGHT_DISC};
    const float kelvins[stationCount] = {2700, 6500, 3500, 7500, 4200, 3000};
    for (int i = 0; i < stationCount; ++i)
        b.scene.lights.push_back(makeLamp(lamps[i], i, blackbodyColour(kelvins[i])));
    addDistantLights(b.scene);
    if (options.moving)
        for (size_t i = 0; i < b.scene.lights.size(); ++i)
            b.scene.lightMotions.push_back({.axisU = {0.4f, 0, 0},
                                            .axisV = {0, 0, 0.4f},
                                            .angularSpeed = 0.7f,
                                            .phase = static_cast<float>(i)});

    Scene scene = std::move(b.scene);
    scene.background = {0.02f, 0.03f, 0.05f}; // cd/m^2
    scene.cameras = {makeUprightCamera("front", {0, 2.3, 8.6}, {0, -1.35, -8.6}, 0.72),
                     makeUprightCamera("above", {-2.5, 6.5, 4.2}, {0.4, -1.2, -0.75}, 0.8)};
    return scene;
}

} // namespace candelabra::app
