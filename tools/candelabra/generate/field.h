// SPDX-License-Identifier: Apache-2.0
// The plan of the field, which the files that build it share: a city of 4 km x 4 km at night. y = 0
// is the height of the streets. The default camera stands in the south (+z) and looks north over a
// river. All lengths are in metres.
//
//   -z north: hills (beyond 2000) - downtown - river (z 880..1040) - low houses - camera - +z south
#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "generate/lights.h"
#include "generate/random.h"
#include "generate/scene_builder.h"

namespace candelabra::app::field
{

constexpr double blockSize = 80; // from street to street
constexpr int blockCount = 50;   // in x and in z
constexpr double cityHalf = 0.5 * blockSize * blockCount;
constexpr double streetWidth = 16;  // from kerb to kerb
constexpr double pavementWidth = 3; // from the kerb to the houses
constexpr double kerbHeight = 0.18;
constexpr double riverSouth = 1040, riverNorth = 880; // z of the banks, on block borders
constexpr double waterLevel = -1.2;
constexpr double lampSpacing = 20, lampHeight = 7.2;
constexpr double lampOffset = 0.5 * streetWidth + 0.8; // from the middle of the street to the post
constexpr double lampReach = 2.4;                      // length of the arm over the street

// The x or z of the middle of a block, 0 to blockCount - 1, and of the street before it; street
// blockCount follows the last block.
constexpr double blockCentre(int block)
{
    return -cityHalf + blockSize * (block + 0.5);
}
constexpr double streetAt(int street)
{
    return -cityHalf + blockSize * street;
}
constexpr bool isRiver(double z)
{
    return z > riverNorth && z < riverSouth;
}

// The position of the default camera. Details become coarser with the distance from it.
constexpr glm::dvec3 cameraPosition{52, 88, 1600};

// The luminance of the sky in cd/m^2.
constexpr glm::vec3 skyLuminance{0.22f, 0.33f, 0.60f};

// The suspension bridge that crosses the river on the street x = 0.
constexpr double pylonHeight = 38;
constexpr double bridgeHalfWidth = 7.5;
// The height of its cables at `t` = 0..1 between the pylons on the two banks.
constexpr double cableHeight(double t)
{
    return pylonHeight - 4 * (pylonHeight - 4) * t * (1 - t);
}

// The big wheel on the north bank turns in a plane across the view.
constexpr glm::dvec3 wheelHub{-170, 66, 850};
constexpr double wheelRadius = 60;

struct Building {
    glm::dvec3 base{0}; // middle of the ground floor
    double halfX = 0, halfZ = 0, height = 0;
};

struct Meshes {
    uint32_t box, slab, street, plainHouse, ledgedHouse, gabledHouse, setbackTower, roundTower;
    uint32_t lamp, tree, rod, ring, ball, hill, mast;
};

// The numbers of storeys over which the windows of facades are spread.
constexpr std::array<int, 5> facadeStoreys = {3, 7, 14, 26, 48};

struct Materials {
    std::vector<uint32_t> asphalt; // from wet to dry
    std::vector<uint32_t> facades; // one per style and number of storeys
    uint32_t pavement, water, grass, leaves, steel, painted, chrome, gold, concrete, hill, roof;
};

struct Kit {
    SceneBuilder builder;
    Meshes mesh;
    Materials material;
    // The buildings of each block; the index of a block is blockCount * z + x.
    std::vector<std::vector<Building>> buildings;
};

void addMeshes(Kit& kit);
void addMaterials(Kit& kit, Random& random);
void addCity(Kit& kit, Random& random);
void addLandmarks(Kit& kit, Random& random);

std::vector<LightSite> lightSites(const Kit& kit, uint32_t count, const SceneOptions& options);

} // namespace candelabra::app::field
