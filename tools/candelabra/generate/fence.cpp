// SPDX-License-Identifier: Apache-2.0
// The fence: rows of slats one behind the other, bamboo with leaves between them, a wall far
// behind. Nearly every tile of the image holds several depths: what culling by tiles fears. x to
// the right, y = 0 is the ground, the camera looks along -z. Metres.
#include <algorithm>
#include <array>
#include <numbers>
#include <utility>

#include "generate/generators.h"
#include "generate/lights.h"
#include "generate/random.h"
#include "generate/scene_builder.h"
#include "generate/shapes.h"

namespace candelabra::app
{
namespace
{

using std::numbers::pi;
constexpr double cameraZ = 9, wallZ = -26, wallHeight = 21, wallHalfWidth = 30;
constexpr std::array<double, 6> rowZ = {4, 0, -5, -10, -15, -20};
constexpr double slatPitch = 0.17;
constexpr uint32_t poleCount = 700, leavesPerPole = 9;

// Half the width of what is built at `z`: a little more than the camera sees.
double reachAt(double z)
{
    return std::min(0.95 * (cameraZ - z) + 2, wallHalfWidth);
}

struct Pole {
    glm::dvec3 foot{0}, top{0};
};

struct Kit {
    SceneBuilder builder;
    uint32_t box = 0, rod = 0;
    uint32_t ground = 0, wall = 0, rail = 0, bamboo = 0;
    std::vector<uint32_t> paints, greens;
    std::vector<Pole> poles;
};

void addMaterials(Kit& kit)
{
    SceneBuilder& b = kit.builder;
    kit.box = b.addMesh(makeBox());
    kit.rod = b.addMesh(makeCylinder(8));
    kit.ground = b.addDielectric("gravel", {0.32f, 0.29f, 0.25f}, 0.85f);
    kit.wall = b.addDielectric("lime wash", {0.66f, 0.62f, 0.55f}, 0.8f);
    kit.rail = b.addMetal("galvanised steel", {0.60f, 0.61f, 0.62f}, 0.35f);
    kit.bamboo = b.addDielectric("bamboo", {0.42f, 0.36f, 0.13f}, 0.3f);
    kit.paints = {b.addDielectric("white paint", {0.72f, 0.71f, 0.68f}, 0.4f),
                  b.addDielectric("weathered wood", {0.38f, 0.34f, 0.29f}, 0.75f),
                  b.addDielectric("red stain", {0.34f, 0.09f, 0.06f}, 0.55f),
                  b.addDielectric("blue paint", {0.10f, 0.20f, 0.34f}, 0.25f)};
    kit.greens = {b.addDielectric("young leaf", {0.26f, 0.42f, 0.09f}, 0.35f),
                  b.addDielectric("leaf", {0.11f, 0.28f, 0.07f}, 0.4f),
                  b.addDielectric("old leaf", {0.34f, 0.30f, 0.08f}, 0.6f)};
}

void addFences(Kit& kit, Random& random)
{
    SceneBuilder& b = kit.builder;
    for (size_t row = 0; row < rowZ.size(); ++row) {
        const double z = rowZ[row], reach = reachAt(z);
        const double height = 1.35 + 0.22 * double(row);
        for (const double at : {0.22, 0.8})
            b.place(kit.box, kit.rail, {0, at * height, z - 0.05}, {2 * reach, 0.05, 0.03});
        for (double x = -reach; x < reach; x += slatPitch) {
            const double tall = height * random.uniform(0.9f, 1.1f);
            const double wide = random.uniform(0.05f, 0.09f);
            const double yaw = 0.25 * random.bell(), aside = 0.02 * random.bell();
            const uint32_t paint = kit.paints[(row + (random.chance(0.1f) ? 1 : 0)) % 4];
            b.place(kit.box, paint, {x + aside, 0.5 * tall + 0.02, z}, {wide, tall, 0.02}, yaw);
        }
    }
}

void addLeaf(Kit& kit, Random& random, const Pole& pole)
{
    const double at = random.uniform(0.3f, 1), azimuth = 2 * pi * double(random.uniform());
    const double droop = 0.6 * double(random.uniform(-0.3f, 1));
    const double length = random.uniform(0.18f, 0.5f), width = random.uniform(0.03f, 0.08f);
    glm::dmat4 leaf = glm::translate(glm::dmat4(1), glm::mix(pole.foot, pole.top, at));
    leaf = glm::rotate(leaf, azimuth, glm::dvec3(0, 1, 0));
    leaf = glm::rotate(leaf, -droop, glm::dvec3(0, 0, 1));
    leaf = glm::translate(leaf, glm::dvec3(0.5 * length + 0.04, 0, 0));
    leaf = glm::rotate(leaf, pi * double(random.uniform()), glm::dvec3(1, 0, 0));
    kit.builder.place(kit.box, random.anyOf(kit.greens),
                      glm::scale(leaf, glm::dvec3(length, 0.004, width)));
}

void addBamboo(Kit& kit, Random& random)
{
    for (uint32_t i = 0; i < poleCount; ++i) {
        const double z = random.uniform(float(wallZ + 1), 5.5f);
        const double x = reachAt(z) * double(random.uniform(-1, 1));
        const double height = random.uniform(4, 13);
        const glm::dvec3 lean(0.06 * height * double(random.bell()), height,
                              0.06 * height * double(random.bell()));
        const Pole pole{{x, 0, z}, glm::dvec3(x, 0, z) + lean};
        kit.builder.placeRod(kit.rod, kit.bamboo, pole.foot, pole.top,
                             double(random.uniform(0.015f, 0.05f)));
        for (uint32_t leaf = 0; leaf < leavesPerPole; ++leaf)
            addLeaf(kit, random, pole);
        kit.poles.push_back(pole);
    }
}

// Lamps on the posts, along the rails, on the gravel, in the bamboo, and fireflies.
LightSite anySite(const Kit& kit, Random& random)
{
    LightSite site;
    const double where = random.uniform();
    const size_t row = random.below(uint32_t(rowZ.size()));
    const double across = random.uniform(-1, 1), up = random.uniform(), ahead = random.bell();
    site.radius = random.uniform(0.015f, 0.06f);
    if (where < 0.3) { // strings of lamps in front of the slats
        site.position = {reachAt(rowZ[row]) * across, 0.3 + 1.6 * up, rowZ[row] + 0.12};
        site.colour = hueColour(0.15f * float(row) + 0.1f * random.uniform(), 0.6f);
    } else if (where < 0.5) { // between the rows
        const double z = rowZ[row] + 2.4 * ahead;
        site.position = {reachAt(z) * across, 0.1 + 0.4 * up, z};
        site.colour = blackbodyColour(random.uniform(2000, 5000));
    } else if (where < 0.85) { // in the bamboo
        const Pole& pole = random.anyOf(kit.poles);
        site.position = glm::mix(pole.foot, pole.top, 0.1 + 0.85 * up);
        site.position += glm::dvec3(0.25 * across, 0, 0.2 + 0.15 * ahead);
        site.colour = hueColour(random.uniform(0.08f, 0.55f), random.uniform(0.3f, 0.7f));
        site.reach = 1.3f;
    } else if (where < 0.93) { // along the wall
        site.position = {wallHalfWidth * across, 0.3 + 14 * up, wallZ + 0.5};
        site.colour = blackbodyColour(random.uniform(2200, 7000));
        site.reach = 2;
    } else {
        const double z = wallZ + 1 + (5 - wallZ) * (0.5 + 0.5 * ahead);
        site.position = {reachAt(z) * across, 0.15 + 9 * up * up, z};
        site.colour = hueColour(random.uniform(0.1f, 0.25f), 0.5f);
    }
    site.reach *= random.uniform(0.7f, 1.45f);
    return site;
}

std::vector<LightSite> lightSites(const Kit& kit, uint32_t count, const SceneOptions& options)
{
    Random random(options.seed, 1), motionRandom(options.seed, 2);
    std::vector<LightSite> sites;
    for (uint32_t i = 0; i < count; ++i) {
        sites.push_back(anySite(kit, random));
        LightSite& site = sites.back();
        const float radius = motionRandom.uniform(0.1f, 0.8f);
        if (options.moving)
            site.motion = circleMotion(motionRandom, site.position.y, site.radius, radius,
                                       motionRandom.uniform(0.3f, 1.2f));
    }
    return sites;
}

} // namespace

Scene generateFence(const SceneOptions& options)
{
    const uint32_t count = options.lights.value_or(defaultLightCount);
    checkLightOptions("fence", count, options);
    Kit kit;
    kit.builder.scene.name = "fence";
    addMaterials(kit);
    const double middle = 0.5 * (wallZ + cameraZ);
    kit.builder.place(kit.box, kit.ground, {0, -0.1, middle},
                      {2 * wallHalfWidth, 0.2, cameraZ - wallZ + 4});
    kit.builder.place(kit.box, kit.wall, {0, 0.5 * wallHeight, wallZ - 0.2},
                      {2 * wallHalfWidth, wallHeight, 0.4});
    Random random(options.seed);
    addFences(kit, random);
    addBamboo(kit, random);

    Scene& scene = kit.builder.scene;
    scene.background = {0.22f, 0.33f, 0.60f};
    scene.cameras = {
        makeUprightCamera("path", {0.3, 1.7, cameraZ}, {-0.06, 0.05, -1}, glm::radians(50.0)),
        makeUprightCamera("above", {-12, 10, 12}, {0.45, -0.4, -1}, glm::radians(55.0))};
    addSphereLights(scene, lightSites(kit, count, options), options);
    return std::move(scene);
}

} // namespace candelabra::app
