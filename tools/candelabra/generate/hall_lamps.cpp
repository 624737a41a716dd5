// SPDX-License-Identifier: Apache-2.0
// What lights the hall whatever the number of its lights: lamps in closed shades and the evening
// light that comes in from outside. Their emitters are out of sight, inside the shades or past the
// walls, and may therefore be far brighter than what a display shows in colour. The engine has no
// translucent materials: a shade does not hold back the light of its lamp, and the glow of the
// shade, which lights nothing, is chosen by eye.
#include <cmath>
#include <iterator>

#include "generate/hall.h"

namespace candelabra::app::hall
{
namespace
{

// Lamps that move go around circles of this radius in metres, which keeps them inside their shades.
constexpr float lampSway = 0.2f;

// A lamp inside its shade, which is 0.69 x 0.8 x 0.69 m times `shade` large.
struct ShadedLamp {
    glm::dvec3 position{0};
    glm::dvec3 shade{1};
    int hue = -1; // hue of lanternColour(); -1 is the colour of all lamps of its kind

    // The middle of the shade's bottom. The lamp is where the shade is widest.
    glm::dvec3 foot() const { return position - glm::dvec3(0, 0.42 * shade.y, 0); }
    glm::dvec3 top() const { return foot() + glm::dvec3(0, shade.y, 0); }
};

constexpr double bothSides[] = {-1.0, 1.0};

std::vector<ShadedLamp> chandelierLamps()
{
    std::vector<ShadedLamp> lamps;
    for (int i = 0; i < chandeliers; ++i)
        lamps.push_back({{chandelierX(i), chandelierY - 0.05, 0}, {1.9, 1.5, 1.9}});
    return lamps;
}

// Lamps that hang under the arches of the arcades.
std::vector<ShadedLamp> archLamps()
{
    std::vector<ShadedLamp> lamps;
    for (int bay = 0; bay < bays; ++bay) {
        for (const double side : bothSides)
            lamps.push_back({{bayCentre(bay), 5.6, side * naveHalf}});
    }
    return lamps;
}

// Lamps at the columns of the outer walls.
std::vector<ShadedLamp> wallLamps()
{
    std::vector<ShadedLamp> lamps;
    for (int column = 0; column <= bays; ++column) {
        for (const double side : bothSides)
            lamps.push_back({{columnX(column), 3.6, side * (halfWidth - 1.1)}, glm::dvec3(0.85)});
    }
    return lamps;
}

// Coloured lanterns on the floor of the nave, before the columns. Opposite lanterns differ in hue.
std::vector<ShadedLamp> floorLanterns()
{
    std::vector<ShadedLamp> lamps;
    for (int column = 1; column < bays; ++column) {
        for (const double side : bothSides) {
            lamps.push_back({{columnX(column), 0.5, side * (naveHalf - 1.3)},
                             glm::dvec3(0.85),
                             column + (side > 0 ? 2 : 0)});
        }
    }
    return lamps;
}

// Coloured lanterns that hang from the cables across the nave.
std::vector<ShadedLamp> cableLanterns()
{
    std::vector<ShadedLamp> lamps;
    for (int column = 2; column < bays; ++column) {
        for (const int at : {-1, 0, 1}) {
            const double t = 0.5 + 0.29 * at;
            lamps.push_back(
                {{columnX(column), hanging(cableY, cableSag, t) - 0.75, (2 * t - 1) * cableHalf},
                 glm::dvec3(0.75),
                 2 * column + at + 1});
        }
    }
    return lamps;
}

// A kind of key light: `peak` is the radiance of its brightest channel.
struct KeyLight {
    float radius, influenceRadius; // metres
    float peak;                    // cd/m^2
    glm::vec3 colour;
};

// The influence radius in metres that lights of reach 1 get when 8 lights overlap. Fitted to what
// addSphereLights found; from 300 to 64,000 lights it is right within 15%.
float usualInfluenceRadius(uint32_t lightCount)
{
    return 1.4f * std::pow(static_cast<float>(lightCount) / defaultLightCount, -0.43f);
}

void placeShade(Kit& kit, const ShadedLamp& lamp, uint32_t glass, uint32_t metal)
{
    kit.builder.place(kit.mesh.shade, glass, lamp.foot(), lamp.shade);
    kit.builder.place(kit.mesh.shadeCap, metal, lamp.foot(), lamp.shade);
    kit.builder.place(kit.mesh.ring, metal, lamp.position, 0.348 * lamp.shade);
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
    const auto lanternGlass = [&](const ShadedLamp& lamp) {
        return m.lantern[static_cast<size_t>(lamp.hue % lanternHueCount)];
    };
    for (const ShadedLamp& lamp : chandelierLamps())
        placeShade(kit, lamp, m.alabaster, m.gold);
    for (const ShadedLamp& lamp : archLamps()) {
        placeShade(kit, lamp, m.amberGlass, m.bronze);
        b.placeRod(kit.mesh.rod, m.iron, lamp.top(),
                   {lamp.position.x, springingHeight + archRadius, lamp.position.z}, 0.012);
    }
    for (const ShadedLamp& lamp : wallLamps()) {
        placeShade(kit, lamp, m.amberGlass, m.bronze);
        const double wall = std::copysign(halfWidth - 0.4, lamp.position.z);
        b.placeRod(kit.mesh.rod, m.iron, lamp.top(), {lamp.position.x, lamp.top().y + 0.15, wall},
                   0.025);
    }
    for (const ShadedLamp& lamp : floorLanterns()) {
        placeShade(kit, lamp, lanternGlass(lamp), m.bronze);
        b.place(kit.mesh.disc, m.bronze, {lamp.position.x, 0, lamp.position.z}, {0.2, 0.14, 0.2});
    }
    for (const ShadedLamp& lamp : cableLanterns()) {
        placeShade(kit, lamp, lanternGlass(lamp), m.bronze);
        b.placeRod(kit.mesh.rod, m.iron, lamp.top(), lamp.position + glm::dvec3(0, 0.75, 0), 0.012);
    }
}

std::vector<LightSite> keyLights(uint32_t lightCount, bool moving, Random& random)
{
    const float reachPerMetre = 1 / usualInfluenceRadius(lightCount);
    std::vector<LightSite> sites;
    const auto add = [&](const KeyLight& kind, const glm::dvec3& position) {
        LightSite site;
        site.position = position;
        site.radius = kind.radius;
        site.reach = reachPerMetre * kind.influenceRadius;
        site.colour = kind.colour;
        site.luminance = luminanceOfPeak(kind.colour, kind.peak);
        if (moving) {
            const float speed = random.uniform(0.1f, 0.3f);
            site.motion = circleMotion(random, position.y, kind.radius, lampSway, speed);
        }
        sites.push_back(site);
    };
    const auto addAll = [&](KeyLight kind, const std::vector<ShadedLamp>& lamps) {
        for (const ShadedLamp& lamp : lamps) {
            if (lamp.hue >= 0)
                kind.colour = lanternColour(lamp.hue, 0);
            add(kind, lamp.position);
        }
    };
    addAll({0.3f, 13, 1200, blackbodyColour(3800)}, chandelierLamps());
    // The sky past the rose window at the far end, which floor and columns reflect, and past the
    // near end.
    const glm::vec3 evening = hueColour(0.60f, 0.6f);
    add({3.2f, 75, 5, hueColour(0.61f, 0.9f)}, {halfLength + 8, 10.6, 0});
    add({3.0f, 30, 40, blackbodyColour(5000)}, {-halfLength - 7, 9, 0});
    addAll({0.1f, 7, 2500, blackbodyColour(3000)}, archLamps());
    addAll({0.05f, 5, 6000, {}}, cableLanterns());
    addAll({0.05f, 4.5f, 6000, blackbodyColour(2500)}, wallLamps());
    addAll({0.05f, 4, 3000, {}}, floorLanterns());
    // The sky above the roofs of the aisles, through the panes of the gallery, and past the windows
    // of the aisles.
    for (int bay = 1; bay < bays; bay += 3) {
        for (const double side : bothSides)
            add({1.8f, 13, 120, evening}, {bayCentre(bay), 11, side * (naveHalf + 4.2)});
    }
    for (int bay = 0; bay < bays; ++bay) {
        for (const double side : bothSides)
            add({1.2f, 6, 80, evening}, {bayCentre(bay), 3.9, side * (halfWidth + 2.2)});
    }
    return sites;
}

} // namespace candelabra::app::hall
