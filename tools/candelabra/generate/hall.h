// SPDX-License-Identifier: Apache-2.0
// The hall's plan, shared by the files that build it. x runs along the nave, z across it, y = 0 is
// the floor; mirror-symmetric about z = 0. Metres.
//
//        z: 12 | wall | aisle | arcade (6) | nave | arcade (-6) | aisle | wall | -12
//   y:  0 floor - 5.8 springing - 8.5 arcade top - 10.4 vault springing - 16.7 crown
#pragma once

#include <cstdint>
#include <vector>

#include "generate/lights.h"
#include "generate/random.h"
#include "generate/scene_builder.h"

namespace candelabra::app::hall
{

constexpr double halfLength = 30;
constexpr double halfWidth = 12;
constexpr double naveHalf = 6; // from the middle to the arcades' planes
constexpr double bayWidth = 5;
constexpr int bays = 12;
constexpr double columnRadius = 0.42;
constexpr double springingHeight = 5.8; // of the arcades
constexpr double archRadius = 2.05;
constexpr double arcadeDepth = 0.9;
constexpr double arcadeTop = 8.5;
constexpr double gallery = 8.7; // top of the cornice, railings stand on it
constexpr double vaultSpringing = 10.4;
constexpr double vaultRadius = 6.3;
constexpr double roseY = 10.6, roseRadius = 3.2; // of the round windows in the end walls
constexpr double chandelierY = 7.2;
constexpr double lanternZ = naveHalf - 1.3; // of the lanterns on the floor, on both sides
constexpr double chandelierRadius = 1.6;
constexpr int chandelierCups = 16;

// Middle of bay 0 .. bays - 1, and the columns before it (and after the last).
constexpr double bayCentre(int bay)
{
    return -halfLength + bayWidth * (bay + 0.5);
}
constexpr double columnX(int column)
{
    return -halfLength + bayWidth * column;
}

// Chandeliers hang over the middle of every other bay.
constexpr int chandeliers = bays / 2;
constexpr double chandelierX(int chandelier)
{
    return bayCentre(2 * chandelier);
}

// Height of a cable that hangs across the nave, or between columns, at t = 0..1 along it.
constexpr double hanging(double height, double sag, double t)
{
    return height - 4 * sag * t * (1 - t);
}
constexpr double cableY = 6.6, cableSag = 1.6; // across the nave at every column
constexpr double cableHalf = naveHalf - 0.4;
constexpr double garlandY = 5.3, garlandSag = 0.9; // along the arcades

struct Meshes {
    uint32_t box, tile, shaft, columnBase, capital, archedWall, archRing, vault;
    uint32_t ball, fineBall, ring, vase, knot, baluster, rod, link, disc;
    uint32_t ribs, caps; // of lamps; the ribs are from y = 0 to 0.73
    uint32_t roseWall;
};

struct Materials {
    uint32_t gold, copper, iron, chrome, bronze, silver;
    uint32_t marble, darkMarble, sandstone, plaster, wood, grout;
    std::vector<uint32_t> floor;   // from mirror-smooth to rough
    std::vector<uint32_t> stone;   // wall blocks
    std::vector<uint32_t> glaze;   // coloured dielectrics of all roughnesses
    uint32_t amberGlass;           // ribs of lamps
    std::vector<uint32_t> lantern; // ribs of coloured lanterns, one for each hue
};

struct Kit {
    SceneBuilder builder;
    Meshes mesh;
    Materials material;
};

void addMeshes(Kit& kit);
void addMaterials(Kit& kit);
void addArchitecture(Kit& kit, Random& random);
void addFurnishings(Kit& kit, Random& random);

// Adds the open cages of the lamps and what holds them.
void addLampFixtures(Kit& kit);
// Returns the colour of a lantern by its hue: 0 to lanternHueCount - 1, and on from 0 again.
// `variation` is added to its place on the colour circle.
constexpr int lanternHueCount = 5;
glm::vec3 lanternColour(int hue, float variation);
// Returns the lamps and the light that comes in from outside, the most important first. They are
// the first lights of a hall of `lightCount` lights. `random` is for motion alone.
std::vector<LightSite> keyLights(uint32_t lightCount, bool moving, Random& random);

// Returns all lights: the key lights, then small ones.
std::vector<LightSite> lightSites(uint32_t count, const SceneOptions& options);

} // namespace candelabra::app::hall
