// SPDX-License-Identifier: Apache-2.0
// One light of every type over balls of several roughnesses, on a floor that shows reflections:
// what each type looks like, side by side.
#include <algorithm>
#include <iterator>
#include <string>
#include <vector>

#include "generate/generators.h"
#include "generate/lights.h"
#include "generate/scene_builder.h"
#include "scene/light_types.h"
#include "scene/scene_error.h"

namespace candelabra::app
{

namespace
{

// Stations stand in a row along x, one per type of light that has a place; the camera looks along
// -z.
constexpr double spacing = 1.7; // metres
constexpr double ballRadius = 0.36;
constexpr float luminousPower = 600; // lm of each lamp: a bulb of 40 W of old

// The types of the lamps: those without a size first.
std::vector<uint32_t> lampTypes()
{
    std::vector<uint32_t> types;
    for (const bool punctual : {true, false})
        for (uint32_t type = 0; type < CND_LIGHT_TYPE_COUNT; ++type)
            if (!cndIsDistant(type) && (cndIsPunctual(type) != 0) == punctual)
                types.push_back(type);
    return types;
}

double stationX(size_t station, size_t count)
{
    return (double(station) - 0.5 * double(count - 1)) * spacing;
}

void addBalls(SceneBuilder& b, size_t stations)
{
    const auto add = [&](const glm::dvec3& center, uint32_t material) {
        AnalyticObject ball;
        ball.type = AnalyticObject::Type::Ball;
        ball.point = center;
        ball.radius = ballRadius;
        ball.material = material;
        b.scene.analyticObjects.push_back(ball);
    };
    constexpr float roughnesses[] = {0.08f, 0.2f, 0.35f, 0.5f, 0.7f, 1.0f};
    for (size_t i = 0; i < stations; ++i) {
        const float perceptualRoughness = roughnesses[i % std::size(roughnesses)];
        const std::string roughness = std::to_string(perceptualRoughness).substr(0, 4);
        // F0 of aluminium: Lagarde 2011, "Feeding a physically based shading model" (linear).
        add({stationX(i, stations) - 0.41, ballRadius, 0.1},
            b.addMetal("aluminium, roughness " + roughness, {0.913f, 0.921f, 0.925f},
                       perceptualRoughness));
        add({stationX(i, stations) + 0.41, ballRadius, 0.1},
            b.addDielectric("red paint, roughness " + roughness, {0.5f, 0.06f, 0.04f},
                            perceptualRoughness));
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
CndLight makeLamp(uint32_t type, double x, const glm::vec3& colour)
{
    const uint32_t fields = cndLightFields(type);
    CndLight light = lightTypeInfo(type).lamp;
    light.type = type;
    set(light.position, {static_cast<float>(x), 1.75f, -0.9f});
    light.influenceRadius = 7;
    const glm::vec3 down = glm::normalize(glm::vec3(0, -1, 0.7f));
    const glm::vec3 up = glm::cross(glm::vec3(1, 0, 0), down); // in the plane of a flat lamp
    if (fields & CND_LIGHT_FIELD_DIRECTION_BIT)
        set(light.direction, down);
    if (fields & CND_LIGHT_FIELD_AXIS_V_BIT) {
        const bool facesDown = glm::dot(glm::cross(glm::vec3(1, 0, 0), up), down) >= 0;
        set(light.axisV, (facesDown ? light.axisV[0] : -light.axisV[0]) * up);
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
    const std::vector<uint32_t> lamps = lampTypes();
    addBalls(b, lamps.size());

    constexpr float kelvins[] = {2700, 6500, 3500, 7500, 4200, 3000};
    for (size_t i = 0; i < lamps.size(); ++i)
        b.scene.lights.push_back(makeLamp(lamps[i], stationX(i, lamps.size()),
                                          blackbodyColour(kelvins[i % std::size(kelvins)])));
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
