// SPDX-License-Identifier: Apache-2.0
// Makes the furnishings of the hall.
#include <algorithm>
#include <cmath>
#include <numbers>

#include "generate/hall.h"

namespace candelabra::app::hall
{
namespace
{

using std::numbers::pi;
// Balls nearer than this to the default camera (x = -28) show facets when coarse.
constexpr double fineUntilX = -22;

void addChain(Kit& kit, const glm::dvec3& from, double toY)
{
    constexpr double pitch = 0.22, size = 0.09;
    const int links = int((toY - from.y) / pitch);
    for (int i = 0; i < links; ++i) {
        // Links stand upright, longer than wide, every other one turned by a quarter.
        const glm::dvec3 at = from + glm::dvec3(0, pitch * (i + 0.5), 0);
        kit.builder.place(kit.mesh.link, kit.material.iron,
                          glm::translate(glm::dmat4(1), at) *
                              glm::rotate(glm::dmat4(1), 0.5 * pi * (i % 2), {0, 1, 0}) *
                              glm::rotate(glm::dmat4(1), 0.5 * pi, {1, 0, 0}) *
                              glm::scale(glm::dmat4(1), {0.6 * size, size, 1.5 * size}));
    }
}

void addChandelier(Kit& kit, double x)
{
    SceneBuilder& b = kit.builder;
    const Materials& m = kit.material;
    const glm::dvec3 hub{x, chandelierY + 1.3, 0};
    addChain(kit, hub, vaultSpringing + vaultRadius - 0.2);
    b.place(kit.mesh.ball, m.gold, hub, glm::dvec3(0.16));
    b.place(kit.mesh.ring, m.gold, {x, chandelierY, 0}, glm::dvec3(chandelierRadius));
    b.place(kit.mesh.ring, m.bronze, {x, chandelierY + 0.7, 0},
            glm::dvec3(0.55 * chandelierRadius));
    for (int i = 0; i < chandelierCups; ++i) {
        const double angle = 2 * pi * i / chandelierCups;
        const glm::dvec3 out{std::cos(angle), 0, std::sin(angle)};
        const glm::dvec3 cup = glm::dvec3(x, chandelierY, 0) + chandelierRadius * out;
        b.place(kit.mesh.vase, m.gold, cup, glm::dvec3(0.16, 0.11, 0.16));
        if (i % 2 == 0) {
            b.placeRod(kit.mesh.rod, m.bronze, cup, hub, 0.015);
            b.placeRod(kit.mesh.rod, m.bronze, glm::dvec3(x, chandelierY, 0) + 0.65 * out, cup,
                       0.02);
        }
    }
}

// Thin cables between points of one height, in straight pieces.
void addCable(Kit& kit, const glm::dvec3& from, const glm::dvec3& to, double sag, int pieces)
{
    for (int i = 0; i < pieces; ++i) {
        const double t0 = double(i) / pieces, t1 = (i + 1.0) / pieces;
        glm::dvec3 a = glm::mix(from, to, t0), b = glm::mix(from, to, t1);
        a.y = hanging(from.y, sag, t0);
        b.y = hanging(from.y, sag, t1);
        kit.builder.placeRod(kit.mesh.rod, kit.material.iron, a, b, 0.012);
    }
}

void addCables(Kit& kit)
{
    for (int column = 0; column <= bays; ++column) {
        const double x = columnX(column);
        if (column > 0 && column < bays)
            addCable(kit, {x, cableY, -cableHalf}, {x, cableY, cableHalf}, cableSag, 12);
        if (column < bays) {
            for (const double side : {-1.0, 1.0}) {
                addCable(kit, {x + 0.3, garlandY, side * naveHalf},
                         {x + bayWidth - 0.3, garlandY, side * naveHalf}, garlandSag, 6);
            }
        }
    }
}

void addGalleryRailings(Kit& kit)
{
    SceneBuilder& b = kit.builder;
    constexpr double spacing = 0.3125; // 16 per bay
    constexpr int perSide = int(2 * halfLength / spacing);
    for (const double side : {-1.0, 1.0}) {
        const double z = side * (naveHalf - 0.5);
        for (int i = 0; i < perSide; ++i) {
            b.place(kit.mesh.baluster, i % 16 == 0 ? kit.material.gold : kit.material.bronze,
                    {-halfLength + spacing * (i + 0.5), gallery, z});
        }
        for (int bay = 0; bay < bays; ++bay) {
            b.place(kit.mesh.box, kit.material.wood, {bayCentre(bay), gallery + 0.84, z},
                    {bayWidth, 0.08, 0.14});
        }
    }
}

// A screen of crossing rods in a frame, between a column and the outer wall.
void addScreen(Kit& kit, double x, double side)
{
    SceneBuilder& b = kit.builder;
    constexpr double low = naveHalf + 0.8, high = halfWidth - 0.8, top = 3.4;
    const auto at = [&](double z, double y) { return glm::dvec3(x, y, side * z); };
    for (const double y : {0.15, top}) {
        b.place(kit.mesh.box, kit.material.wood, at(0.5 * (low + high), y),
                {0.14, 0.16, high - low});
    }
    for (const double z : {low, high})
        b.place(kit.mesh.box, kit.material.wood, at(z, 0.5 * top), {0.16, top, 0.16});
    // Diagonals of both directions, cut at the frame.
    constexpr double spacing = 0.55, height = top - 0.15, width = high - low;
    for (double start = -height + spacing; start < width; start += spacing) {
        const double z0 = std::max(start, 0.0), z1 = std::min(start + height, width);
        const double y0 = z0 - start, y1 = z1 - start;
        b.placeRod(kit.mesh.rod, kit.material.bronze, at(low + z0, 0.15 + y0),
                   at(low + z1, 0.15 + y1), 0.02);
        b.placeRod(kit.mesh.rod, kit.material.bronze, at(high - z0, 0.15 + y0),
                   at(high - z1, 0.15 + y1), 0.02);
    }
}

// One exhibit on a pedestal.
void addExhibit(Kit& kit, Random& random, const glm::dvec3& at, int kind)
{
    SceneBuilder& b = kit.builder;
    const Materials& m = kit.material;
    const uint32_t metals[] = {m.gold, m.copper, m.chrome, m.silver, m.bronze, m.iron};
    const bool metal = random.chance(0.5f);
    const uint32_t material = metal ? random.anyOf(metals) : random.anyOf(m.glaze);
    const double yaw = 2 * pi * random.uniform();
    b.place(kit.mesh.box, m.darkMarble, at + glm::dvec3(0, 0.08, 0), {0.95, 0.16, 0.95});
    b.place(kit.mesh.box, m.stone[3], at + glm::dvec3(0, 0.56, 0), {0.7, 0.8, 0.7});
    b.place(kit.mesh.box, m.marble, at + glm::dvec3(0, 1.0, 0), {0.85, 0.08, 0.85});
    const glm::dvec3 top = at + glm::dvec3(0, 1.04, 0);
    if (kind == 0) {
        b.place(kit.mesh.vase, material, top, glm::dvec3(1.1), yaw);
    } else if (kind == 1) {
        b.place(kit.mesh.fineBall, material, top + glm::dvec3(0, 0.42, 0), glm::dvec3(0.42));
    } else if (kind == 2) {
        b.place(kit.mesh.knot, material,
                glm::translate(glm::dmat4(1), top + glm::dvec3(0, 0.6, 0)) *
                    glm::rotate(glm::dmat4(1), yaw, {0, 1, 0}) *
                    glm::rotate(glm::dmat4(1), 0.5 * pi, {1, 0, 0}));
    } else {
        // Rings within rings, like an armillary sphere.
        for (int i = 0; i < 5; ++i) {
            b.place(kit.mesh.ring, material,
                    glm::translate(glm::dmat4(1), top + glm::dvec3(0, 0.55, 0)) *
                        glm::rotate(glm::dmat4(1), yaw + 0.6 * i, {0, 1, 0}) *
                        glm::rotate(glm::dmat4(1), 0.35 * pi * i, {1, 0, 0}) *
                        glm::scale(glm::dmat4(1), glm::dvec3(0.5 - 0.06 * i)));
        }
        b.place(kit.mesh.fineBall, m.chrome, top + glm::dvec3(0, 0.55, 0), glm::dvec3(0.16));
    }
}

// Balls and boxes that lie around the exhibits.
void addScatter(Kit& kit, Random& random)
{
    SceneBuilder& b = kit.builder;
    const Materials& m = kit.material;
    const uint32_t metals[] = {m.gold, m.copper, m.chrome, m.silver, m.iron};
    constexpr int count = 700;
    for (int i = 0; i < count; ++i) {
        const double x = columnX(0) + 1 + (2 * halfLength - 2) * random.uniform();
        const double side = random.chance(0.5f) ? 1 : -1;
        // Along both edges of the nave, thinning out towards its middle, and in the aisles.
        const bool aisle = random.chance(0.3f);
        const double spread = random.bell();
        const double z = side * (aisle ? 9 + 2 * spread : 4 + 1.8 * spread);
        const float share = random.uniform();
        const double radius = 0.06 + 0.26 * share * share * share;
        const double toLantern =
            std::hypot(x - bayWidth * std::round(x / bayWidth), std::abs(z) - lanternZ);
        const bool metal = random.chance(0.35f);
        const uint32_t material = metal ? random.anyOf(metals) : random.anyOf(m.glaze);
        const bool round = random.chance(0.8f);
        if (toLantern < 0.3 + 1.2 * radius)
            continue; // it would lie in the lantern
        if (round) {
            b.place(x < fineUntilX ? kit.mesh.fineBall : kit.mesh.ball, material, {x, radius, z},
                    glm::dvec3(radius));
        } else {
            const double height = radius * random.uniform(1.0f, 3.0f);
            b.place(kit.mesh.box, material, {x, 0.5 * height, z},
                    {1.6 * radius, height, 1.6 * radius}, 2 * pi * random.uniform());
        }
    }
}

// Steps at the far end that carry the golden knot.
void addShrine(Kit& kit)
{
    SceneBuilder& b = kit.builder;
    const Materials& m = kit.material;
    for (int step = 0; step < 4; ++step) {
        b.place(kit.mesh.box, step % 2 == 0 ? m.darkMarble : m.marble,
                {25.5 + 0.35 * step, 0.125 + 0.25 * step, 0},
                {7.0 - 0.9 * step, 0.25, 8.0 - 1.4 * step});
    }
    b.place(kit.mesh.box, m.marble, {26.5, 1.5, 0}, {1.5, 1.0, 1.5});
    b.place(kit.mesh.knot, m.gold,
            glm::translate(glm::dmat4(1), {26.5, 3.9, 0}) *
                glm::rotate(glm::dmat4(1), 0.5 * pi, {0, 0, 1}) *
                glm::scale(glm::dmat4(1), glm::dvec3(3.2)));
    for (const double z : {-2.6, 2.6})
        b.place(kit.mesh.vase, m.copper, {25.6, 0.75, z}, glm::dvec3(1.8));
}

} // namespace

void addFurnishings(Kit& kit, Random& random)
{
    for (int i = 0; i < chandeliers; ++i)
        addChandelier(kit, chandelierX(i));
    addLampFixtures(kit);
    addCables(kit);
    addGalleryRailings(kit);
    for (int bay = 0; bay < bays; ++bay) {
        for (const double side : {-1.0, 1.0}) {
            addExhibit(kit, random, {bayCentre(bay), 0, side * 5.2}, int(random.below(4)));
            if (bay % 2 == 1) {
                addScreen(kit, columnX(bay), side);
            } else {
                addExhibit(kit, random, {bayCentre(bay), 0, side * 10.2}, int(random.below(4)));
            }
        }
    }
    addScatter(kit, random);
    addShrine(kit);
}

} // namespace candelabra::app::hall
