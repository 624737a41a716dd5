// SPDX-License-Identifier: Apache-2.0
// Streets, blocks, houses, lamps and trees of the field.
#include <cmath>
#include <numbers>

#include "generate/field.h"

namespace candelabra::app::field
{
namespace
{

using std::numbers::pi;
// The distances from the default camera up to which details are worth their triangles. In a picture
// with 720 lines a ledge of 0.3 m is one pixel high at about 250 m, and its house some 60 pixels
// wide at 900 m.
constexpr double ledgesUntil = 1000, lampsUntil = 950, treesUntil = 1500, streetTreesUntil = 600;

double distanceToCamera(double x, double z)
{
    return glm::length(glm::dvec2(x - cameraPosition.x, z - cameraPosition.z));
}

double bump(double x, double z, const glm::dvec2& centre, double width)
{
    const glm::dvec2 d = (glm::dvec2(x, z) - centre) / width;
    const double fall = 1 / (1 + glm::dot(d, d));
    return fall * fall;
}

// The typical height of towers at a place. There are two centres of high buildings; the first is
// downtown.
double skyline(double x, double z)
{
    return 230 * bump(x, z, {-300, 380}, 400) + 100 * bump(x, z, {780, 250}, 260) +
           40 * bump(x, z, {-1200, -400}, 400);
}

uint32_t facade(const Kit& kit, Random& random, double height)
{
    constexpr double storey = 3.3;
    size_t nearest = 0;
    for (size_t i = 1; i < facadeStoreys.size(); ++i) {
        if (std::abs(facadeStoreys[i] * storey - height) <
            std::abs(facadeStoreys[nearest] * storey - height)) {
            nearest = i;
        }
    }
    const uint32_t styles = uint32_t(kit.material.facades.size() / facadeStoreys.size());
    return kit.material.facades[random.below(styles) * facadeStoreys.size() + nearest];
}

void addBuilding(Kit& kit, Random& random, std::vector<Building>& block, const Building& building)
{
    const double distance = distanceToCamera(building.base.x, building.base.z);
    const uint32_t kind = random.below(10);
    const uint32_t material = facade(kit, random, building.height);
    uint32_t mesh = distance < ledgesUntil ? kit.mesh.ledgedHouse : kit.mesh.plainHouse;
    if (building.height > 60 && kind < 4) {
        mesh = kit.mesh.setbackTower;
    } else if (building.height > 45 && kind == 4) {
        mesh = kit.mesh.roundTower;
    } else if (building.height < 13 && kind < 6) {
        mesh = kit.mesh.gabledHouse;
    }
    kit.builder.place(mesh, material, building.base,
                      {2 * building.halfX, building.height, 2 * building.halfZ});
    block.push_back(building);
}

void addTree(Kit& kit, Random& random, double x, double z)
{
    const double height = random.uniform(5.0f, 11.0f);
    const double width = height * random.uniform(0.8f, 1.2f);
    const double yaw = 2 * pi * random.uniform();
    kit.builder.place(kit.mesh.tree, kit.material.leaves, {x, kerbHeight, z},
                      {width, height, width}, yaw);
}

void addHouses(Kit& kit, Random& random, std::vector<Building>& block, double x, double z)
{
    const double free =
        0.5 * (blockSize - streetWidth) - pavementWidth; // half the width that may be built on
    const double towers = skyline(x, z);
    const double tall = random.uniform();
    if (towers * tall > 35) {
        // The block has one tower with a forecourt.
        const double half = free * random.uniform(0.45f, 0.75f);
        addBuilding(kit, random, block,
                    {{x, kerbHeight, z}, half, half, 25 + towers * (0.35 + 0.65 * tall * tall)});
        return;
    }
    for (int lot = 0; lot < 4; ++lot) {
        const double low = random.uniform();
        const double vary = random.uniform();
        const double height = 7 + 13 * low * low + 0.35 * towers * vary;
        const double halfX = 0.5 * free * random.uniform(0.72f, 0.94f);
        const double halfZ = 0.5 * free * random.uniform(0.72f, 0.94f);
        const bool garden = random.chance(0.07f);
        // The fronts of the houses stand in line along the pavement.
        const double cx = x + (lot % 2 ? 1 : -1) * (free - halfX);
        const double cz = z + (lot / 2 ? 1 : -1) * (free - halfZ);
        if (garden) {
            for (int tree = 0; tree < 4; ++tree) {
                const glm::dvec2 at = 2.0 * glm::dvec2(random.uniform2()) - 1.0;
                addTree(kit, random, cx + halfX * at.x, cz + halfZ * at.y);
            }
        } else {
            addBuilding(kit, random, block, {{cx, kerbHeight, cz}, halfX, halfZ, height});
        }
    }
}

void addPark(Kit& kit, Random& random, double x, double z)
{
    const double half = 0.5 * (blockSize - streetWidth) - 2;
    const bool near = distanceToCamera(x, z) < treesUntil;
    for (int i = 0; i < (near ? 22 : 8); ++i) {
        const glm::dvec2 at(random.uniform2());
        addTree(kit, random, x + half * (2 * at.x - 1), z + half * (2 * at.y - 1));
    }
    // A sculpture stands in the middle.
    const bool chrome = random.chance(0.5f);
    kit.builder.place(kit.mesh.box, kit.material.concrete, {x, kerbHeight + 1, z}, {5, 2, 5});
    kit.builder.place(kit.mesh.ball, chrome ? kit.material.chrome : kit.material.gold,
                      {x, kerbHeight + 5.4, z}, glm::dvec3(3.5));
}

// Adds lamps along the four kerbs of the block, and some trees between them.
void addKerbside(Kit& kit, Random& random, double x, double z)
{
    const double edge = 0.5 * blockSize - lampOffset;
    const int perSide = int(blockSize / lampSpacing);
    const glm::dvec2 outward[] = {{0, 1}, {1, 0}, {0, -1}, {-1, 0}};
    for (int side = 0; side < 4; ++side) {
        // The lamp's arm, which points to +z in the mesh, points away from the block.
        const double yaw = 0.5 * pi * side;
        const glm::dvec2& out = outward[side];
        for (int i = 0; i < perSide; ++i) {
            const double along = lampSpacing * (i + 0.5) - 0.5 * blockSize;
            const glm::dvec2 at = glm::dvec2(x, z) + edge * out + along * glm::dvec2(-out.y, out.x);
            kit.builder.place(kit.mesh.lamp, kit.material.steel, {at.x, kerbHeight, at.y},
                              glm::dvec3(1), yaw);
            const bool tree =
                random.chance(distanceToCamera(x, z) < streetTreesUntil ? 0.25f : 0.0f);
            if (tree) {
                const glm::dvec2 beside = at + 0.5 * lampSpacing * glm::dvec2(-out.y, out.x);
                addTree(kit, random, beside.x, beside.y);
            }
        }
    }
}

void addBlock(Kit& kit, Random& random, int blockX, int blockZ)
{
    SceneBuilder& b = kit.builder;
    const Materials& m = kit.material;
    std::vector<Building>& block = kit.buildings[size_t(blockCount) * blockZ + blockX];
    const double x = blockCentre(blockX), z = blockCentre(blockZ);
    if (isRiver(z)) {
        b.place(kit.mesh.street, m.water, {x, waterLevel, z}, {blockSize, 1, blockSize});
        return;
    }
    b.place(kit.mesh.street, random.anyOf(m.asphalt), {x, 0, z}, {blockSize, 1, blockSize});
    const bool besideWheel = glm::length(glm::dvec2(x - wheelHub.x, z - wheelHub.z)) < 75;
    const bool park = random.chance(0.07f) || besideWheel;
    // The rim of the slab is 0.012 high in the mesh.
    const double inner = blockSize - streetWidth;
    b.place(kit.mesh.slab, park ? m.grass : m.pavement, {x, kerbHeight, z},
            {inner, kerbHeight / 0.012, inner});
    if (besideWheel)
        return;
    if (park) {
        addPark(kit, random, x, z);
    } else {
        addHouses(kit, random, block, x, z);
    }
    if (distanceToCamera(x, z) < lampsUntil)
        addKerbside(kit, random, x, z);
}

} // namespace

void addCity(Kit& kit, Random& random)
{
    kit.buildings.resize(size_t(blockCount) * blockCount);
    for (int z = 0; z < blockCount; ++z) {
        for (int x = 0; x < blockCount; ++x)
            addBlock(kit, random, x, z);
    }
    // The quays are built in pieces as long as a block.
    for (int x = 0; x < blockCount; ++x) {
        for (const double z : {riverNorth - 0.6, riverSouth + 0.6}) {
            kit.builder.place(kit.mesh.box, kit.material.concrete, {blockCentre(x), -0.9, z},
                              {blockSize, 2.4, 1.2});
        }
    }
}

} // namespace candelabra::app::field
