// SPDX-License-Identifier: Apache-2.0
// Makes the sources of light in the hall, for any number of lights: lamps in open cages and the
// evening light that comes in through the windows. A hall of few lights has the first of them. The
// other lamps hang there dark.
#include <cmath>
#include <iterator>

#include "generate/hall.h"

namespace candelabra::app::hall
{
namespace
{

// Lamps that move go around circles of this radius in metres, which keeps them inside their cages.
constexpr float lampSway = 0.2f;

// A lamp in its cage, which is 0.69 x 0.8 x 0.69 m times `cage` large.
struct Lamp {
    glm::dvec3 position{0};
    double radius = 0; // of the light
    glm::dvec3 cage{1};
    int hue = -1; // hue of lanternColour(); -1 is the colour of all lamps of its kind

    // The middle of the cage's bottom. The lamp is where the cage is widest.
    glm::dvec3 foot() const { return position - glm::dvec3(0, 0.42 * cage.y, 0); }
    glm::dvec3 top() const { return foot() + glm::dvec3(0, cage.y, 0); }
};

constexpr double bothSides[] = {-1.0, 1.0};

std::vector<Lamp> chandelierLamps()
{
    std::vector<Lamp> lamps;
    for (int i = 0; i < chandeliers; ++i)
        lamps.push_back({{chandelierX(i), chandelierY - 0.05, 0}, 0.3, {1.9, 1.5, 1.9}});
    return lamps;
}

// Lamps that hang under the arches of the arcades.
std::vector<Lamp> archLamps()
{
    std::vector<Lamp> lamps;
    for (int bay = 0; bay < bays; ++bay) {
        for (const double side : bothSides)
            lamps.push_back({{bayCentre(bay), 5.6, side * naveHalf}, 0.1});
    }
    return lamps;
}

// Lamps at the columns of the outer walls.
std::vector<Lamp> wallLamps()
{
    std::vector<Lamp> lamps;
    for (int column = 0; column <= bays; ++column) {
        for (const double side : bothSides)
            lamps.push_back(
                {{columnX(column), 3.6, side * (halfWidth - 1.1)}, 0.05, glm::dvec3(0.85)});
    }
    return lamps;
}

// Coloured lanterns on the floor of the nave, before the columns. Opposite lanterns differ in hue.
std::vector<Lamp> floorLanterns()
{
    std::vector<Lamp> lamps;
    for (int column = 1; column < bays; ++column) {
        for (const double side : bothSides) {
            lamps.push_back({{columnX(column), 0.5, side * lanternZ},
                             0.05,
                             glm::dvec3(0.85),
                             column + (side > 0 ? 2 : 0)});
        }
    }
    return lamps;
}

// Coloured lanterns that hang from the cables across the nave.
std::vector<Lamp> cableLanterns()
{
    std::vector<Lamp> lamps;
    for (int column = 2; column < bays; ++column) {
        for (const int at : {-1, 0, 1}) {
            const double t = 0.5 + 0.29 * at;
            lamps.push_back(
                {{columnX(column), hanging(cableY, cableSag, t) - 0.75, (2 * t - 1) * cableHalf},
                 0.05,
                 glm::dvec3(0.75),
                 2 * column + at + 1});
        }
    }
    return lamps;
}

// A kind of key light: `peak` is the radiance of its brightest channel.
struct KeyLight {
    float influenceRadius; // metres
    float peak;            // cd/m^2
    glm::vec3 colour;
};

// The influence radius in metres that lights of reach 1 get when 8 lights overlap. Fitted to what
// addSphereLights found; from 300 to 64,000 lights it is right within 15%.
float usualInfluenceRadius(uint32_t lightCount)
{
    return 1.4f * std::pow(float(lightCount) / defaultLightCount, -0.43f);
}

void placeCage(Kit& kit, const Lamp& lamp, uint32_t glass, uint32_t metal)
{
    SceneBuilder& b = kit.builder;
    b.place(kit.mesh.ribs, glass, lamp.foot(), lamp.cage);
    b.place(kit.mesh.caps, metal, lamp.foot(), lamp.cage);
    b.place(kit.mesh.ring, metal, lamp.position, 0.348 * lamp.cage);
    const glm::dvec3 bottom = lamp.position - glm::dvec3(0, lamp.radius, 0);
    b.placeRod(kit.mesh.rod, metal, lamp.foot(), bottom, 0.3 * lamp.radius);
}

} // namespace

glm::vec3 lanternColour(int hue, float variation)
{
    constexpr float hues[] = {0.085f, 0.56f, 0.01f, 0.47f, 0.90f}; // amber, azure, red, teal, rose
    static_assert(std::size(hues) == lanternHueCount);
    return hueColour(hues[hue % lanternHueCount] + variation, 0.9f);
}

void addLampFixtures(Kit& kit)
{
    SceneBuilder& b = kit.builder;
    const Materials& m = kit.material;
    const auto lanternGlass = [&](const Lamp& lamp) {
        return m.lantern[size_t(lamp.hue % lanternHueCount)];
    };
    for (const Lamp& lamp : chandelierLamps())
        placeCage(kit, lamp, m.marble, m.gold);
    for (const Lamp& lamp : archLamps()) {
        placeCage(kit, lamp, m.amberGlass, m.bronze);
        b.placeRod(kit.mesh.rod, m.iron, lamp.top(),
                   {lamp.position.x, springingHeight + archRadius, lamp.position.z}, 0.012);
    }
    for (const Lamp& lamp : wallLamps()) {
        placeCage(kit, lamp, m.amberGlass, m.bronze);
        const double wall = std::copysign(halfWidth - 0.4, lamp.position.z);
        b.placeRod(kit.mesh.rod, m.iron, lamp.top(), {lamp.position.x, lamp.top().y + 0.15, wall},
                   0.025);
    }
    for (const Lamp& lamp : floorLanterns()) {
        placeCage(kit, lamp, lanternGlass(lamp), m.bronze);
        b.place(kit.mesh.disc, m.bronze, {lamp.position.x, 0, lamp.position.z}, {0.2, 0.14, 0.2});
    }
    for (const Lamp& lamp : cableLanterns()) {
        placeCage(kit, lamp, lanternGlass(lamp), m.bronze);
        b.placeRod(kit.mesh.rod, m.iron, lamp.top(), lamp.position + glm::dvec3(0, 0.75, 0), 0.012);
    }
}

std::vector<LightSite> keyLights(uint32_t lightCount, bool moving, Random& random)
{
    const float reachPerMetre = 1 / usualInfluenceRadius(lightCount);
    std::vector<LightSite> sites;
    const auto add = [&](const KeyLight& kind, const glm::dvec3& position, float radius) {
        LightSite site;
        site.position = position;
        site.radius = radius;
        site.reach = reachPerMetre * kind.influenceRadius;
        site.colour = kind.colour;
        site.luminance = luminanceOfPeak(kind.colour, kind.peak);
        if (moving) {
            const float speed = random.uniform(0.1f, 0.3f);
            site.motion = circleMotion(random, position.y, radius, lampSway, speed);
        }
        sites.push_back(site);
    };
    const auto addAll = [&](KeyLight kind, const std::vector<Lamp>& lamps) {
        for (const Lamp& lamp : lamps) {
            if (lamp.hue >= 0)
                kind.colour = lanternColour(lamp.hue, 0);
            add(kind, lamp.position, float(lamp.radius));
        }
    };
    addAll({13, 1200, blackbodyColour(3800)}, chandelierLamps());
    // The sky past the rose windows of the far end, which floor and columns reflect, and of the
    // near end.
    const glm::vec3 evening = hueColour(0.60f, 0.6f);
    add({75, 5, hueColour(0.61f, 0.9f)}, {halfLength + 8, roseY, 0}, 3.2f);
    add({30, 40, blackbodyColour(5000)}, {-halfLength - 7, 9, 0}, 3);
    addAll({7, 2500, blackbodyColour(3000)}, archLamps());
    addAll({5, 6000, {}}, cableLanterns());
    addAll({4.5f, 6000, blackbodyColour(2500)}, wallLamps());
    addAll({4, 3000, {}}, floorLanterns());
    // The sky above the roofs of the aisles, through the arches of the gallery, and past the
    // windows of the aisles.
    for (int bay = 1; bay < bays; bay += 3) {
        for (const double side : bothSides)
            add({13, 120, evening}, {bayCentre(bay), 11, side * (naveHalf + 4.2)}, 1.8f);
    }
    for (int bay = 0; bay < bays; ++bay) {
        for (const double side : bothSides)
            add({6, 80, evening}, {bayCentre(bay), 3.9, side * (halfWidth + 2.2)}, 1.2f);
    }
    return sites;
}

} // namespace candelabra::app::hall
