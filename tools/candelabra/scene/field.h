// SPDX-License-Identifier: Apache-2.0
// The field's plan, shared by the files that build it: a city of 4 km x 4 km by night, y = 0 is the
// street. The default camera stands in the south (+z) and looks north over a river. Metres.
//
//   -z north: hills (beyond 2000) - downtown - river (z 880..1040) - low houses - camera - +z south
#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "scene/lights.h"
#include "scene/random.h"
#include "scene/scene_builder.h"

namespace candelabra::app::field
{

constexpr double kBlock = 80; // from street to street
constexpr int kBlocks = 50;   // in x and in z
constexpr double kCityHalf = 0.5 * kBlock * kBlocks;
constexpr double kStreet = 16;  // from kerb to kerb
constexpr double kPavement = 3; // from the kerb to the houses
constexpr double kKerb = 0.18;
constexpr double kRiverSouth = 1040, kRiverNorth = 880; // z of the banks, on block borders
constexpr double kWater = -1.2;
constexpr double kLampSpacing = 20, kLampHeight = 7.2;
constexpr double kLampOffset = 0.5 * kStreet + 0.8; // of the post from the middle of the street
constexpr double kLampReach = 2.4;                  // of the arm over the street

// Middle of block 0 .. kBlocks - 1, in x or z, and of the street before it (and after the last).
constexpr double blockCentre(int block)
{
    return -kCityHalf + kBlock * (block + 0.5);
}
constexpr double streetAt(int street)
{
    return -kCityHalf + kBlock * street;
}
constexpr bool isRiver(double z)
{
    return z > kRiverNorth && z < kRiverSouth;
}

// The default camera, which detail is measured against.
constexpr glm::dvec3 kCameraPosition{52, 88, 1600};

// Of the sky, cd/m^2.
constexpr glm::vec3 kSkyLuminance{0.22f, 0.33f, 0.60f};

// The suspension bridge that crosses the river on the street x = 0.
constexpr double kPylonHeight = 38;
constexpr double kBridgeHalfWidth = 7.5;
// Height of its cables at `t` = 0..1 between the banks' pylons.
constexpr double cableHeight(double t)
{
    return kPylonHeight - 4 * (kPylonHeight - 4) * t * (1 - t);
}

// The big wheel on the north bank turns in a plane across the view.
constexpr glm::dvec3 kWheelHub{-170, 66, 850};
constexpr double kWheelRadius = 60;

struct Building {
    glm::dvec3 base{0}; // middle of the ground floor
    double halfX = 0, halfZ = 0, height = 0;
};

struct Meshes {
    uint32_t box, slab, street, plainHouse, ledgedHouse, gabledHouse, setbackTower, roundTower;
    uint32_t lamp, tree, rod, ring, ball, hill, mast;
};

// Facades by how many storeys their windows are spread over.
constexpr std::array<int, 5> kStoreyClasses = {3, 7, 14, 26, 48};

struct Materials {
    std::vector<uint32_t> asphalt; // wet to dry
    std::vector<uint32_t> facades; // styles x storey classes
    uint32_t pavement, water, grass, leaves, steel, painted, chrome, gold, concrete, hill, roof;
};

struct Kit {
    SceneBuilder builder;
    Meshes mesh;
    Materials material;
    // Of all blocks, kBlocks * z + x.
    std::vector<std::vector<Building>> buildings;
};

void addMeshes(Kit& kit);
void addMaterials(Kit& kit, Random& random);
void addCity(Kit& kit, Random& random);
void addLandmarks(Kit& kit, Random& random);

std::vector<LightSite> lightSites(const Kit& kit, uint32_t count, const SceneOptions& options);

} // namespace candelabra::app::field
