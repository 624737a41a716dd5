// SPDX-License-Identifier: Apache-2.0
// The bridges, the big wheel and the masts of the field, and the hills around it.
#include <cmath>
#include <numbers>

#include "generate/field.h"

namespace candelabra::app::field
{
namespace
{

using std::numbers::pi;
constexpr double riverWidth = riverSouth - riverNorth;

void addDeck(Kit& kit, double x)
{
    SceneBuilder& b = kit.builder;
    // The deck is built in pieces half as long as a block.
    for (int i = 0; i < 4; ++i) {
        b.place(kit.mesh.box, kit.material.asphalt[1],
                {x, -0.3, riverNorth + riverWidth * (i + 0.5) / 4},
                {2 * bridgeHalfWidth, 0.7, 0.25 * riverWidth});
    }
    for (const double side : {-1.0, 1.0}) {
        const double edge = x + side * (bridgeHalfWidth - 0.2);
        b.placeRod(kit.mesh.rod, kit.material.steel, {edge, 1.15, riverNorth},
                   {edge, 1.15, riverSouth}, 0.06);
        constexpr int posts = 32;
        for (int i = 0; i <= posts; ++i) {
            const double z = riverNorth + riverWidth * i / posts;
            b.placeRod(kit.mesh.rod, kit.material.steel, {edge, 0, z}, {edge, 1.15, z}, 0.04);
        }
    }
}

void addArchedPiers(Kit& kit, double x)
{
    for (int i = 1; i < 4; ++i) {
        kit.builder.place(kit.mesh.box, kit.material.concrete,
                          {x, waterLevel - 0.2, riverNorth + riverWidth * i / 4},
                          {2 * bridgeHalfWidth + 1, 1.6, 4});
    }
}

void addSuspension(Kit& kit)
{
    SceneBuilder& b = kit.builder;
    const Materials& m = kit.material;
    for (const double side : {-1.0, 1.0}) {
        const double x = side * bridgeHalfWidth;
        for (const double z : {riverNorth, riverSouth}) {
            b.place(kit.mesh.box, m.painted, {x, 0.5 * pylonHeight, z},
                    {1.6, pylonHeight + 2, 2.2});
        }
        constexpr int pieces = 32;
        const auto onCable = [&](int i) {
            const double t = double(i) / pieces;
            return glm::dvec3(x, cableHeight(t), riverNorth + riverWidth * t);
        };
        for (int i = 0; i < pieces; ++i) {
            b.placeRod(kit.mesh.rod, m.painted, onCable(i), onCable(i + 1), 0.22);
            const glm::dvec3 top = onCable(i);
            b.placeRod(kit.mesh.rod, m.steel, {x, 0, top.z}, top, 0.05);
        }
        // The stays from the pylons back to the ground.
        b.placeRod(kit.mesh.rod, m.painted, onCable(0), {x, 0, riverNorth - 60}, 0.22);
        b.placeRod(kit.mesh.rod, m.painted, onCable(pieces), {x, 0, riverSouth + 60}, 0.22);
    }
    for (const double z : {riverNorth, riverSouth}) {
        for (const double y : {12.0, pylonHeight - 1})
            b.place(kit.mesh.box, m.painted, {0, y, z}, {2 * bridgeHalfWidth, 1.6, 1.6});
    }
}

void addWheel(Kit& kit)
{
    SceneBuilder& b = kit.builder;
    const Materials& m = kit.material;
    constexpr int spokes = 24;
    for (const double z : {-2.5, 2.5}) {
        const glm::dvec3 hub = wheelHub + glm::dvec3(0, 0, z);
        for (const double radius : {wheelRadius, 0.92 * wheelRadius}) {
            b.place(kit.mesh.ring, m.steel,
                    glm::translate(glm::dmat4(1), hub) *
                        glm::rotate(glm::dmat4(1), 0.5 * pi, {1, 0, 0}) *
                        glm::scale(glm::dmat4(1), glm::dvec3(radius)));
        }
        for (int i = 0; i < spokes; ++i) {
            const double angle = 2 * pi * i / spokes;
            const glm::dvec3 out{std::cos(angle), std::sin(angle), 0};
            b.placeRod(kit.mesh.rod, m.steel, hub, hub + wheelRadius * out, 0.12);
        }
        for (const double x : {-22.0, 22.0})
            b.placeRod(kit.mesh.rod, m.painted, {hub.x + x, kerbHeight, hub.z + 2 * z}, hub, 0.8);
    }
    b.place(kit.mesh.ball, m.painted, wheelHub, glm::dvec3(3, 3, 4.5));
    for (int i = 0; i < spokes; ++i) {
        const double angle = 2 * pi * (i + 0.5) / spokes;
        const glm::dvec3 rim =
            wheelHub + wheelRadius * glm::dvec3(std::cos(angle), std::sin(angle), 0);
        b.placeRod(kit.mesh.rod, m.steel, rim - glm::dvec3(0, 0, 2.5), rim + glm::dvec3(0, 0, 2.5),
                   0.1);
        b.place(kit.mesh.ball, i % 2 ? m.painted : m.gold, rim - glm::dvec3(0, 1.8, 0),
                glm::dvec3(1.4, 1.6, 1.4));
    }
}

// Adds the country around the city in tiles of 500 m, and hills on the horizon.
void addSurroundings(Kit& kit, Random& random)
{
    SceneBuilder& b = kit.builder;
    constexpr double tile = 500;
    constexpr int half = 11; // tiles to each side, which are 5.5 km
    constexpr int city = int(cityHalf / tile);
    for (int x = -half; x < half; ++x) {
        for (int z = -half; z < half; ++z) {
            const bool inside = x >= -city && x < city && z >= -city && z < city;
            if (!inside) {
                b.place(kit.mesh.street, kit.material.grass,
                        {tile * (x + 0.5), -0.3, tile * (z + 0.5)}, {tile, 1, tile});
            }
        }
    }
    for (int i = 0; i < 40; ++i) {
        const double x = 5200.0 * (i + 0.5) / 20 - 5200;
        const double z = -3300 - 1500 * random.uniform();
        const glm::dvec3 size{random.uniform(350.0f, 900.0f), random.uniform(70.0f, 330.0f),
                              random.uniform(300.0f, 700.0f)};
        b.place(kit.mesh.hill, kit.material.hill, {x, -0.25 * size.y, z}, size);
    }
}

} // namespace

void addLandmarks(Kit& kit, Random& random)
{
    for (int street = 1; street < blockCount; street += 4) {
        addDeck(kit, streetAt(street));
        if (streetAt(street) == 0) {
            addSuspension(kit);
        } else {
            addArchedPiers(kit, streetAt(street));
        }
    }
    addWheel(kit);
    const glm::dvec3 masts[] = {{300, 0, 1240}, {-620, 0, 1180}, {1100, 0, 640}, {-1500, 0, -300}};
    for (const glm::dvec3& mast : masts)
        kit.builder.place(kit.mesh.mast, kit.material.painted, mast, glm::dvec3(75));
    // A monument stands on the bank and is reflected in the river.
    kit.builder.place(kit.mesh.ball, kit.material.chrome, {120, 12, 1064}, glm::dvec3(9));
    kit.builder.place(kit.mesh.box, kit.material.concrete, {120, 1.6, 1064}, {12, 3.2, 12});
    addSurroundings(kit, random);
}

} // namespace candelabra::app::field
