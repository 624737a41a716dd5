// SPDX-License-Identifier: Apache-2.0
// Floor, columns, arcades, walls and vault of the hall.
#include <cmath>
#include <numbers>

#include "generate/hall.h"

namespace candelabra::app::hall
{
namespace
{

using std::numbers::pi;
// The inner radius of the rings around arches, as a share of that of the arch. They cover the
// arch's edge, which has other corners.
constexpr double archivolt = 0.985;

void addFloor(Kit& kit, Random& random)
{
    const Materials& m = kit.material;
    constexpr int halfX = int(halfLength), halfZ = int(halfWidth);
    // Materials of the patterns, as indices into Materials::floor.
    constexpr uint32_t black = 0, white = 1, green = 2, red = 3, cream = 4, wornBlack = 5, grey = 6,
                       terracotta = 7;
    for (int x = -halfX; x < halfX; ++x) {
        for (int z = -halfZ; z < halfZ; ++z) {
            const int fromMiddle = z < 0 ? -z - 1 : z;
            const bool even = ((x + z) & 1) == 0;
            uint32_t kind = even ? grey : terracotta; // aisles
            if (fromMiddle < 2) {
                kind = (x + halfX) % 5 == 0 ? red : even ? black : white;
            } else if (fromMiddle == 2 || fromMiddle == 5) {
                kind = green;
            } else if (fromMiddle < 5) {
                kind = even ? cream : wornBlack;
            }
            // A few tiles were replaced.
            if (random.chance(0.04f))
                kind = random.below(uint32_t(m.floor.size()));
            kit.builder.place(kit.mesh.tile, m.floor[kind], {x + 0.5, 0, z + 0.5});
        }
    }
    // Shows in the joints only.
    for (int bay = 0; bay < bays; ++bay) {
        kit.builder.place(kit.mesh.box, m.grout, {bayCentre(bay), -0.11, 0},
                          {bayWidth, 0.2, 2 * halfWidth});
    }
}

void addColumn(Kit& kit, double x, double z, uint32_t shaft)
{
    SceneBuilder& b = kit.builder;
    b.place(kit.mesh.box, kit.material.darkMarble, {x, 0.085, z}, {1.4, 0.17, 1.4});
    b.place(kit.mesh.columnBase, kit.material.marble, {x, 0, z});
    b.place(kit.mesh.shaft, shaft, {x, 0, z});
    b.place(kit.mesh.capital, kit.material.gold, {x, 0, z});
    b.place(kit.mesh.box, kit.material.marble, {x, 0.5 * (5.58 + springingHeight), z},
            {1.36, springingHeight - 5.58, 1.36});
}

void addColumns(Kit& kit)
{
    const Materials& m = kit.material;
    for (int column = 0; column <= bays; ++column) {
        const double x = columnX(column);
        for (const double side : {-1.0, 1.0}) {
            addColumn(kit, x, side * naveHalf, column % 2 == 0 ? m.marble : m.floor[2]);
            addColumn(kit, x, side * (halfWidth - 0.15), m.sandstone); // half in the wall
        }
    }
}

// Three small open arches per bay on short columns.
void addTriforium(Kit& kit, int bay, double side)
{
    SceneBuilder& b = kit.builder;
    constexpr double scale = 1.0 / 3.0, rise = scale * (arcadeTop - springingHeight);
    constexpr double z = naveHalf + 0.25, springing = vaultSpringing - rise;
    for (int i = -1; i <= 1; ++i) {
        const double x = bayCentre(bay) + i * bayWidth * scale;
        b.place(kit.mesh.archedWall, kit.material.plaster, {x, springing, side * z},
                glm::dvec3(scale));
        b.placeRod(kit.mesh.rod, kit.material.darkMarble,
                   {x - 0.5 * bayWidth * scale, gallery, side * z},
                   {x - 0.5 * bayWidth * scale, springing, side * z}, 0.07);
    }
}

void addArcades(Kit& kit)
{
    SceneBuilder& b = kit.builder;
    const Materials& m = kit.material;
    for (int bay = 0; bay < bays; ++bay) {
        const double x = bayCentre(bay);
        for (const double side : {-1.0, 1.0}) {
            const double z = side * naveHalf;
            b.place(kit.mesh.archedWall, m.stone[1], {x, springingHeight, z});
            // Archivolts on both faces.
            for (const double face : {-1.0, 1.0}) {
                b.place(kit.mesh.archRing, m.marble,
                        {x, springingHeight, z + face * 0.5 * arcadeDepth},
                        {archivolt * archRadius, archivolt * archRadius, 0.16});
            }
            b.place(kit.mesh.box, m.marble, {x, 0.5 * (arcadeTop + gallery), z},
                    {bayWidth, gallery - arcadeTop, arcadeDepth + 0.5});
            // Aisle ceiling and its beams.
            const double aisle = side * 0.5 * (naveHalf + halfWidth);
            b.place(kit.mesh.box, m.wood, {x, arcadeTop + 0.1, aisle}, {bayWidth, 0.2, 6});
            for (int beam = 0; beam < 4; ++beam) {
                b.place(kit.mesh.box, m.wood,
                        {x + bayWidth * (0.25 * beam - 0.375), arcadeTop - 0.12, aisle},
                        {0.22, 0.26, 6});
            }
            addTriforium(kit, bay, side);
        }
    }
}

// The outer walls are built of courses. Windows take the place of some of them.
constexpr int courses = 9, firstWindowCourse = 2, lastWindowCourse = 6;
constexpr double courseHeight = arcadeTop / courses;
constexpr double windowHalf = 0.95;
constexpr double windowHeadScale = windowHalf / archRadius; // of the arched wall over a window
constexpr double windowSill = courseHeight * firstWindowCourse;
constexpr double windowSpringing =
    courseHeight * (lastWindowCourse + 1) - windowHeadScale * (arcadeTop - springingHeight);

// A lattice without panes in a round-headed opening of the outer wall.
void addAisleWindow(Kit& kit, double x, double side)
{
    SceneBuilder& b = kit.builder;
    constexpr double sill = windowSill, springing = windowSpringing, half = windowHalf;
    const double z = side * (halfWidth - 0.12);
    b.place(kit.mesh.archedWall, kit.material.stone[2], {x, springing, side * (halfWidth + 0.2)},
            {windowHeadScale, windowHeadScale, 0.46 / arcadeDepth});
    b.place(kit.mesh.archRing, kit.material.marble, {x, springing, z},
            {archivolt * half, archivolt * half, 0.3});
    for (const double edge : {-1.0, 1.0}) {
        b.place(kit.mesh.box, kit.material.marble,
                {x + edge * (half + 0.04), 0.5 * (sill + springing), z},
                {0.12, springing - sill, 0.3});
    }
    b.place(kit.mesh.box, kit.material.marble, {x, sill - 0.08, z - side * 0.08},
            {2 * half + 0.5, 0.16, 0.45});
    const double front = z - side * 0.06;
    for (int i = -2; i <= 2; ++i) {
        const double offset = 0.32 * i;
        b.placeRod(kit.mesh.rod, kit.material.iron, {x + offset, sill, front},
                   {x + offset, springing + 0.6, front}, 0.018);
        const double y = 0.5 * (sill + springing) + 0.55 * i;
        b.placeRod(kit.mesh.rod, kit.material.iron, {x - half, y, front}, {x + half, y, front},
                   0.018);
    }
}

void addSideWall(Kit& kit, Random& random, double side)
{
    const auto addBlock = [&](double middle, double length, int course) {
        const double proud = random.uniform(0.0f, 0.04f);
        kit.builder.place(kit.mesh.box, random.anyOf(kit.material.stone),
                          {middle, courseHeight * (course + 0.5), side * (halfWidth + 0.2 - proud)},
                          {length, courseHeight, 0.5});
    };
    for (int course = 0; course < courses; ++course) {
        if (course >= firstWindowCourse && course <= lastWindowCourse) {
            constexpr double length = 0.5 * bayWidth - windowHalf;
            for (int bay = 0; bay < bays; ++bay)
                for (const double edge : {-1.0, 1.0})
                    addBlock(bayCentre(bay) + edge * (windowHalf + 0.5 * length), length, course);
        } else {
            // Running bond: odd courses start half a block earlier.
            constexpr double length = 0.5 * bayWidth;
            for (int i = 0; i <= 2 * bays; ++i)
                addBlock(-halfLength + length * (i + (course % 2 ? 0.0 : 0.5)), length, course);
        }
    }
    for (int bay = 0; bay < bays; ++bay)
        addAisleWindow(kit, bayCentre(bay), side);
}

// Rings and spokes without panes in a round opening of an end wall.
void addRoseWindow(Kit& kit, double end)
{
    SceneBuilder& b = kit.builder;
    const glm::dmat4 inWall = glm::rotate(
        glm::translate(glm::dmat4(1), {end * (halfLength + 0.25), roseY, 0}), 0.5 * pi, {0, 1, 0});
    for (const double turn : {0.0, pi})
        b.place(kit.mesh.roseWall, kit.material.stone[0], glm::rotate(inWall, turn, {0, 0, 1}));
    const double front = end * (halfLength - 0.1);
    for (const double radius : {roseRadius, 2.2, 1.1}) {
        b.place(kit.mesh.ring, kit.material.marble,
                glm::translate(glm::dmat4(1), {front, roseY, 0}) *
                    glm::rotate(glm::dmat4(1), 0.5 * pi, {0, 0, 1}) *
                    glm::scale(glm::dmat4(1), glm::dvec3(radius)));
    }
    for (int spoke = 0; spoke < 16; ++spoke) {
        const double angle = 2 * pi * spoke / 16;
        const glm::dvec3 out{0, std::cos(angle), std::sin(angle)};
        const glm::dvec3 from = glm::dvec3(front, roseY, 0) + 0.3 * out;
        b.placeRod(kit.mesh.rod, kit.material.marble, from, from + 2.9 * out, 0.05);
    }
}

void addEndWall(Kit& kit, Random& random, double end)
{
    constexpr double length = 2, height = 1;
    for (int course = 0; course < 17; ++course) {
        const int half = course < 9 ? 6 : 4; // above the aisles only the nave goes on
        const bool atRose = std::abs(height * (course + 0.5) - roseY) < roseRadius + 0.5 * height;
        for (int i = -half; i <= half; ++i) {
            const double z = length * (i + (course % 2 ? 0.0 : 0.5));
            if (atRose && std::abs(z) < roseRadius + 0.5 * length)
                continue;
            kit.builder.place(kit.mesh.box, random.anyOf(kit.material.stone),
                              {end * (halfLength + 0.25), height * (course + 0.5), z},
                              {0.5, height, length});
        }
    }
    addRoseWindow(kit, end);
}

void addVault(Kit& kit)
{
    SceneBuilder& b = kit.builder;
    for (int bay = 0; bay < bays; ++bay) {
        b.place(kit.mesh.vault, kit.material.plaster, {bayCentre(bay), vaultSpringing, 0},
                {bayWidth, vaultRadius, vaultRadius});
        // Purlins make coffers of the fields between the ribs.
        for (int i = 1; i <= 9; ++i) {
            const double angle = pi * i / 10;
            const glm::dvec3 place{bayCentre(bay),
                                   vaultSpringing + (vaultRadius - 0.08) * std::sin(angle),
                                   (vaultRadius - 0.08) * std::cos(angle)};
            b.place(kit.mesh.box, i % 3 == 0 ? kit.material.gold : kit.material.wood,
                    glm::translate(glm::dmat4(1), place) *
                        glm::rotate(glm::dmat4(1), -angle, {1, 0, 0}) *
                        glm::scale(glm::dmat4(1), {bayWidth, 0.16, 0.16}));
        }
    }
    for (int column = 0; column <= bays; ++column) {
        const double radius = vaultRadius / 1.07; // the ring's outer side on the vault
        b.place(kit.mesh.archRing, kit.material.stone[3], {columnX(column), vaultSpringing, 0},
                {radius, radius, 0.45}, 0.5 * pi);
        // Between the big ribs, a thin one.
        if (column < bays) {
            const double thin = 1.05 * radius;
            b.place(kit.mesh.archRing, kit.material.wood, {bayCentre(column), vaultSpringing, 0},
                    {thin, thin, 0.16}, 0.5 * pi);
        }
    }
}

} // namespace

void addArchitecture(Kit& kit, Random& random)
{
    addFloor(kit, random);
    addColumns(kit);
    addArcades(kit);
    for (const double side : {-1.0, 1.0})
        addSideWall(kit, random, side);
    for (const double end : {-1.0, 1.0})
        addEndWall(kit, random, end);
    addVault(kit);
}

} // namespace candelabra::app::hall
