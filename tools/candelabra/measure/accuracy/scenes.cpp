// SPDX-License-Identifier: Apache-2.0
// The scenes of the accuracy benchmark. Each shows one thing that specular methods find hard.
#include <cmath>
#include <limits>

#include "generate/generators.h"
#include "measure/accuracy/image_level.h"

namespace candelabra::app
{
namespace
{

struct Look {
    glm::vec3 baseColour{0.5f};
    float alpha = 0.1f;
    float metalness = 0;
};

uint32_t addMaterial(Scene& scene, const Look& look)
{
    scene.materials.push_back({.name = "surface",
                               .baseColor = look.baseColour,
                               .metalness = look.metalness,
                               .perceptualRoughness = std::sqrt(look.alpha)});
    return uint32_t(scene.materials.size()) - 1;
}

void addPlane(Scene& scene, const Look& look)
{
    scene.analyticObjects.push_back({.type = AnalyticObject::Type::Plane,
                                     .point = {0, 0, 0},
                                     .normal = {0, 1, 0},
                                     .material = addMaterial(scene, look)});
}

void addBall(Scene& scene, const glm::dvec3& centre, double radius, const Look& look)
{
    scene.analyticObjects.push_back({.type = AnalyticObject::Type::Ball,
                                     .point = centre,
                                     .radius = radius,
                                     .material = addMaterial(scene, look)});
}

CndLight light(CndLightType type, const glm::vec3& position, float radius,
               const glm::vec3& emission)
{
    CndLight out{.type = type,
                 .position = {position.x, position.y, position.z},
                 .radius = radius,
                 .direction = {0, -1, 0},
                 .emission = {emission.x, emission.y, emission.z}};
    out.influenceRadius = std::numeric_limits<float>::infinity();
    return out;
}

void addSphere(Scene& scene, const glm::vec3& position, float radius, const glm::vec3& emission)
{
    scene.lights.push_back(light(CND_LIGHT_SPHERE, position, radius, emission));
}

Scene emptyScene(const char* name, const glm::dvec3& eye, const glm::dvec3& target,
                 double fovDegrees)
{
    Scene scene;
    scene.name = name;
    scene.lightsVisible = false;
    scene.lobes = CND_LOBES_SUM; // what the truth integrates
    scene.cameras.push_back({.name = "eye",
                             .position = eye,
                             .forward = glm::normalize(target - eye),
                             .up = {0, 1, 0},
                             .verticalFov = fovDegrees * 3.14159265358979 / 180});
    return scene;
}

Scene smallLights()
{
    Scene s = emptyScene("small lights over a rough floor", {0, 2.2, 5}, {0, 0.3, 0}, 45);
    addPlane(s, {{0.55f, 0.5f, 0.45f}, 0.25f, 0});
    addBall(s, {0, 0.7, 0}, 0.7, {{0.7f, 0.7f, 0.72f}, 0.09f, 1});
    for (int i = 0; i < 6; ++i) {
        const float angle = float(i) * 1.0472f;
        addSphere(s, {2 * std::cos(angle), 0.5f + 0.2f * float(i), 2 * std::sin(angle)}, 0.06f,
                  {800, 600.0f + 60 * float(i), 400});
    }
    return s;
}

Scene glossyBalls()
{
    Scene s = emptyScene("metal balls, three sizes of light", {0, 1.4, 5}, {0, 0.9, 0}, 42);
    addPlane(s, {{0.3f, 0.3f, 0.3f}, 0.4f, 0});
    const float alphas[] = {0.01f, 0.04f, 0.16f, 0.5f};
    for (int i = 0; i < 4; ++i)
        addBall(s, {1.2 * (i - 1.5), 0.55, 0}, 0.5, {{1.0f, 0.77f, 0.34f}, alphas[i], 1});
    addSphere(s, {-2.5f, 3, 1.5f}, 0.1f, {4000, 4000, 4000});
    addSphere(s, {0, 3.2f, -1}, 0.5f, {120, 130, 160});
    addSphere(s, {2.6f, 1.6f, 1.8f}, 1.0f, {40, 30, 20});
    return s;
}

Scene cutPlane()
{
    Scene s = emptyScene("glossy floor cut by a light", {0, 1.6, 4}, {0, 0, -0.3}, 45);
    addPlane(s, {{0.2f, 0.2f, 0.22f}, 0.1f, 0});
    addSphere(s, {0, 0.15f, -0.5f}, 0.6f, {100, 95, 80});
    addSphere(s, {1.8f, -0.1f, 0.4f}, 0.4f, {30, 60, 120});
    return s;
}

Scene grazing()
{
    Scene s = emptyScene("large light at grazing angles", {0, 0.35, 4}, {0, 0.1, -2}, 40);
    addPlane(s, {{0.4f, 0.38f, 0.35f}, 0.15f, 0});
    addSphere(s, {0, 1.2f, -4}, 1.1f, {90, 90, 100});
    return s;
}

Scene tinyBright()
{
    Scene s = emptyScene("tiny bright lights on lacquer", {0, 1.5, 4.5}, {0, 0.5, 0}, 42);
    addPlane(s, {{0.35f, 0.3f, 0.28f}, 0.3f, 0});
    const float alphas[] = {0.03f, 0.1f, 0.3f};
    for (int i = 0; i < 3; ++i)
        addBall(s, {1.1 * (i - 1), 0.5, 0}, 0.5, {{0.55f, 0.08f, 0.06f}, alphas[i], 0});
    addSphere(s, {-1.5f, 2.2f, 1.5f}, 0.004f, {2e6f, 1.9e6f, 1.7e6f});
    addSphere(s, {1.8f, 1.2f, 2}, 0.01f, {1e5f, 1.3e5f, 1.8e5f});
    return s;
}

Scene manyOnMetal()
{
    Scene s = emptyScene("a row of metal under five spheres", {0, 1.1, 5.5}, {0, 0.6, 0}, 44);
    addPlane(s, {{0.9f, 0.85f, 0.8f}, 0.25f, 1});
    for (int i = 0; i < 5; ++i)
        addBall(s, {1.1 * (i - 2), 0.5, 0.2 * (i % 2)}, 0.45,
                {{0.95f, 0.93f, 0.88f}, 0.02f + 0.12f * float(i), 1});
    for (int i = 0; i < 5; ++i)
        addSphere(s, {1.4f * float(i - 2), 1.9f + 0.3f * float(i % 3), 0.8f - 0.5f * float(i % 2)},
                  0.08f + 0.1f * float(i), {60.0f + 20 * float(i), 90, 150 - 25 * float(i)});
    return s;
}

Scene everyShape()
{
    Scene s = emptyScene("tube, rectangle, disc and sun", {0, 2, 5}, {0, 0.5, 0}, 48);
    addPlane(s, {{0.5f, 0.5f, 0.5f}, 0.16f, 0});
    addBall(s, {-0.9, 0.6, 0.3}, 0.6, {{0.95f, 0.64f, 0.54f}, 0.04f, 1});
    addBall(s, {0.9, 0.6, 0.3}, 0.6, {{0.6f, 0.2f, 0.15f}, 0.12f, 0});
    CndLight tube = light(CND_LIGHT_TUBE, {0, 1.4f, -1.5f}, 0.05f, {300, 320, 400});
    tube.axisU[0] = 1.5f;
    CndLight rectangle = light(CND_LIGHT_RECTANGLE, {-2.2f, 1.2f, 0}, 0, {60, 50, 40});
    rectangle.axisU[1] = 0.8f; // faces +x
    rectangle.axisV[2] = 0.5f;
    CndLight disc = light(CND_LIGHT_DISC, {2.2f, 1.5f, 0.2f}, 0.5f, {40, 60, 50});
    disc.direction[0] = -0.8f;
    disc.direction[1] = -0.6f;
    CndLight sun = light(CND_LIGHT_DISTANT_SPHERE, {0, 0, 0}, 0.00465f, {1e5f, 9e4f, 8e4f});
    sun.direction[0] = 0.48f;
    sun.direction[1] = -0.6f;
    sun.direction[2] = -0.64f;
    s.lights.insert(s.lights.end(), {tube, rectangle, disc, sun});
    return s;
}

Scene showcase()
{
    Scene s = generateShowcase({});
    s.lightsVisible = false;
    s.lobes = CND_LOBES_SUM;
    return s;
}

} // namespace

std::vector<Scene> benchScenes()
{
    return {smallLights(), glossyBalls(), cutPlane(),   grazing(),
            tinyBright(),  manyOnMetal(), everyShape(), showcase()};
}

} // namespace candelabra::app
