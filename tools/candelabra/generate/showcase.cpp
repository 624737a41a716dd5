// SPDX-License-Identifier: Apache-2.0
// One light of every type over balls of several roughnesses, on a floor that shows reflections:
// what each type looks like, side by side.
#include <algorithm>
#include <iterator>
#include <string>
#include <vector>

#include "candelabra/glm.hpp"
#include "generate/generators.h"
#include "generate/lights.h"
#include "generate/scene_builder.h"
#include "io/table.h"
#include "scene/light_types.h"
#include "scene/scene_error.h"

namespace candelabra::app
{

namespace
{

// Stations stand in a row along x, one per type of light that has a place; the camera looks along
// -z.
constexpr double spacing = 1.62; // metres
constexpr double ballRadius = 0.38;
// The radiance of the brightest channel of lamps with a size, in cd/m^2: beside a floor at dusk a
// display still shows it in colour.
constexpr float lampPeak = 7;
// The same for lamps without a size, in cd: about as much light, of a spot in its cone.
constexpr float pointPeak = 12, spotPeak = 40;

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

void addBall(SceneBuilder& b, const glm::dvec3& center, double radius, uint32_t material)
{
    AnalyticObject ball;
    ball.type = AnalyticObject::Type::Ball;
    ball.point = center;
    ball.radius = radius;
    ball.material = material;
    b.scene.analyticObjects.push_back(ball);
}

void addBalls(SceneBuilder& b, size_t stations)
{
    constexpr float roughnesses[] = {0.08f, 0.2f, 0.35f, 0.5f, 0.7f, 1.0f};
    const glm::vec3 paints[] = {{0.5f, 0.06f, 0.04f}, {0.5f, 0.45f, 0.36f}, {0.05f, 0.16f, 0.42f}};
    for (size_t i = 0; i < stations; ++i) {
        const float perceptualRoughness = roughnesses[i % std::size(roughnesses)];
        const std::string roughness = std::to_string(perceptualRoughness).substr(0, 4);
        // F0 of aluminium: Lagarde 2011, "Feeding a physically based shading model" (linear).
        addBall(b, {stationX(i, stations) - 0.41, ballRadius, 0.1}, ballRadius,
                b.addMetal("aluminium, roughness " + roughness, {0.913f, 0.921f, 0.925f},
                           perceptualRoughness));
        addBall(b, {stationX(i, stations) + 0.41, ballRadius, 0.1}, ballRadius,
                b.addDielectric("paint, roughness " + roughness, paints[i % std::size(paints)],
                                perceptualRoughness));
    }
}

// Makes a lamp over the station; flat ones face down and towards the camera.
CndLight makeLamp(uint32_t type, double x, const glm::vec3& colour)
{
    const uint32_t fields = cndLightFields(type);
    CndLight light = lightTypeInfo(type).lamp;
    light.type = type;
    assign(light.position, glm::vec3(x, 1.5f, -0.15f));
    light.influenceRadius = 7;
    const glm::vec3 down = glm::normalize(glm::vec3(0, -1, 0.7f));
    const glm::vec3 up = glm::cross(glm::vec3(1, 0, 0), down); // in the plane of a flat lamp
    if (fields & CND_LIGHT_FIELD_DIRECTION_BIT)
        assign(light.direction, down);
    if (fields & CND_LIGHT_FIELD_AXIS_V_BIT) {
        const bool facesDown = glm::dot(glm::cross(glm::vec3(1, 0, 0), up), down) >= 0;
        assign(light.axisV, (facesDown ? light.axisV[0] : -light.axisV[0]) * up);
    }
    const float peak = !cndIsPunctual(type)                     ? lampPeak
                       : fields & CND_LIGHT_FIELD_DIRECTION_BIT ? spotPeak
                                                                : pointPeak;
    assign(light.emission, luminanceOfPeak(colour, peak) * colour);
    return light;
}

// Adds the brass balls that hold a lamp: at the corners of a rectangle or polygon, at the ends of a
// tube, at the back of what has a direction, else on top.
void addHolders(SceneBuilder& b, const CndLight& light, uint32_t brass)
{
    const glm::dvec3 centre(toGlm(light.position)), u(toGlm(light.axisU)), v(toGlm(light.axisV));
    const double radius = light.radius;
    const uint32_t fields = cndLightFields(light.type);
    if (fields & CND_LIGHT_FIELD_POLYGON_BIT) {
        for (uint32_t i = 0; i < light.polygon->cornerCount; ++i) {
            const float(&corner)[2] = light.polygon->corners[i];
            addBall(b, centre + double(corner[0]) * u + double(corner[1]) * v, 0.05, brass);
        }
    } else if (fields & CND_LIGHT_FIELD_AXIS_V_BIT) {
        for (const glm::dvec3& corner : {u + v, u - v, v - u, -u - v})
            addBall(b, centre + corner, 0.05, brass);
    } else if (fields & CND_LIGHT_FIELD_AXIS_U_BIT) {
        for (const double side : {-1.0, 1.0})
            addBall(b, centre + side * u, 1.3 * radius, brass);
    } else if (fields & CND_LIGHT_FIELD_DIRECTION_BIT) {
        const double gap = cndIsPunctual(light.type) ? 0.11 : 0; // a spot stays outside
        addBall(b, centre - gap * glm::dvec3(toGlm(light.direction)), 0.1, brass);
    } else {
        addBall(b, centre + glm::dvec3(0, 0.85 * radius + 0.04, 0), std::max(0.5 * radius, 0.06),
                brass);
    }
}

// Adds what comes from afar: a cool sky from the front, which shows the form of what the lamps
// leave dark, and a low wide sun in the picture.
void addDistantLights(Scene& scene)
{
    CndLight sky{};
    sky.type = CND_LIGHT_DIRECTIONAL;
    assign(sky.direction, glm::normalize(glm::vec3(0.5f, -1, -0.6f)));
    assign(sky.emission, 4.0f * hueColour(0.6f, 0.4f)); // lx
    scene.lights.push_back(sky);
    CndLight sun{};
    sun.type = CND_LIGHT_DISTANT_SPHERE;
    sun.radius = 0.035f; // the sine of its angular radius
    assign(sun.direction, glm::normalize(glm::vec3(-0.16f, -0.047f, 1)));
    const glm::vec3 colour = hueColour(0.05f, 0.93f);
    assign(sun.emission, luminanceOfPeak(colour, 4) * colour); // cd/m^2
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
    ground.material = b.addMaterial({.name = "polished stone",
                                     .baseColor = glm::vec3(0.2f),
                                     .perceptualRoughness = 0.15f,
                                     .dielectricF0 = glm::vec3(0.1f)});
    b.scene.analyticObjects.push_back(ground);
    const std::vector<uint32_t> lamps = lampTypes();
    addBalls(b, lamps.size());

    const uint32_t brass = b.addMetal("brass", {0.91f, 0.78f, 0.42f}, 0.3f);
    const glm::vec3 colours[] = {hueColour(0.09f, 0.8f),   hueColour(0.57f, 0.8f),
                                 hueColour(0.065f, 0.97f), hueColour(0.46f, 0.95f),
                                 hueColour(0.65f, 0.9f),   hueColour(0.95f, 0.93f)};
    for (size_t i = 0; i < lamps.size(); ++i) {
        b.scene.lights.push_back(
            makeLamp(lamps[i], stationX(i, lamps.size()), colours[i % std::size(colours)]));
        if (!options.moving) // lamps that move would leave their holders
            addHolders(b, b.scene.lights.back(), brass);
    }
    addDistantLights(b.scene);
    if (options.moving)
        for (size_t i = 0; i < b.scene.lights.size(); ++i)
            b.scene.lightMotions.push_back({.axisU = {0.4f, 0, 0},
                                            .axisV = {0, 0, 0.4f},
                                            .angularSpeed = 0.7f,
                                            .phase = float(i)});

    Scene scene = std::move(b.scene);
    scene.background = {0.6f, 0.38f, 0.5f}; // cd/m^2
    std::vector<std::string> names;
    for (const uint32_t type : lamps)
        names.push_back(lightTypeLabel(type));
    scene.notes.push_back("the showcase has, from left to right, " + listed(names) +
                          "; a distant sphere behind them and a directional light also light it");
    // All lamps fit if the picture is 16:9.
    scene.cameras = {makeUprightCamera("front", {0, 2.9, 10.6}, {0, -2.0, -10.6}, 0.62),
                     makeUprightCamera("above", {-2.5, 6.5, 4.2}, {0.4, -1.2, -0.75}, 0.8)};
    return scene;
}

} // namespace candelabra::app
