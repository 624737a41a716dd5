// SPDX-License-Identifier: Apache-2.0
// Places the hall's lights.
#include <algorithm>
#include <cmath>
#include <numbers>

#include "generate/hall.h"

namespace candelabra::app::hall
{
namespace
{

using std::numbers::pi;
// Positions are drawn again when they fall into stone, at most this often.
constexpr int maxTries = 16;

// Is a ball around `p` free of columns, walls, arcades and vault?
bool isFree(const glm::dvec3& p, double radius)
{
    const double side = std::abs(p.z);
    if (std::abs(p.x) > halfLength - 0.05 - radius || side > halfWidth - 0.1 - radius ||
        p.y < radius + 0.02) {
        return false;
    }
    if (p.y < springingHeight) {
        const double dx = p.x - bayWidth * std::round(p.x / bayWidth), dz = side - naveHalf;
        const double keep = radius + (p.y < 0.6 || p.y > 5 ? 0.68 : columnRadius + 0.03);
        return dx * dx + dz * dz > keep * keep;
    }
    if (std::abs(side - naveHalf) < 0.5 * arcadeDepth + 0.05 + radius && p.y < gallery + radius) {
        // Only the openings of the arches.
        const double dx = p.x - bayWidth * (std::floor(p.x / bayWidth) + 0.5),
                     dy = p.y - springingHeight;
        const double free = archRadius - 0.02 - radius;
        return free > 0 && dx * dx + dy * dy < free * free;
    }
    if (side > naveHalf)
        return p.y < arcadeTop - 0.3 - radius;
    const double above = std::max(p.y - vaultSpringing, 0.0);
    const double free = vaultRadius - 0.5 - radius;
    return above * above + side * side < free * free;
}

// Sets how bright a light in sight is. `peak` is the radiance of its brightest channel in cd/m^2.
// That is too bright for a display, so the light must be small in the picture: its radius is at
// most a small share of how far it reaches.
void setGlow(LightSite& site, float peak)
{
    site.luminance = luminanceOfPeak(site.colour, peak);
    site.radiusShare = 0.022f;
}

// Returns the colour of a small lamp of coloured glass.
glm::vec3 glassColour(Random& random, int hue)
{
    return lanternColour(hue, random.uniform(-0.02f, 0.02f));
}

LightSite onChandelier(Random& random)
{
    LightSite site;
    const int chandelier = int(random.below(chandeliers));
    const double angle = 2 * pi * random.below(chandelierCups) / chandelierCups;
    const glm::dvec3 jitter(random.uniform3() - 0.5f);
    site.position = glm::dvec3(chandelierX(chandelier), chandelierY + 0.25, 0) +
                    chandelierRadius * glm::dvec3(std::cos(angle), 0, std::sin(angle)) +
                    glm::dvec3(0.3, 0.25, 0.3) * jitter;
    site.radius = random.skewed(0.03f, 0.08f);
    site.colour = blackbodyColour(random.uniform(1900, 2700));
    site.reach = 1.5f;
    setGlow(site, 280);
    return site;
}

// Coloured bulbs on the cables across the nave.
LightSite onCable(Random& random)
{
    LightSite site;
    const uint32_t column = 1 + random.below(bays - 1);
    const float t = random.uniform(), drop = random.uniform();
    const float along = random.bell();
    site.position = {columnX(int(column)) + 0.15 * along,
                     hanging(cableY, cableSag, t) - 0.08 - 0.25 * drop,
                     (2 * t - 1) * (naveHalf - 0.6)};
    site.radius = random.skewed(0.04f, 0.15f);
    site.colour = glassColour(random, int(column));
    setGlow(site, 280);
    return site;
}

LightSite onGarland(Random& random)
{
    LightSite site;
    const int bay = int(random.below(bays));
    const float side = random.side(), t = random.uniform(), drop = random.uniform();
    site.position = {columnX(bay) + 0.3 + t * (bayWidth - 0.6),
                     hanging(garlandY, garlandSag, t) - 0.06 - 0.15 * drop, side * naveHalf};
    site.radius = random.skewed(0.03f, 0.09f);
    site.colour = blackbodyColour(random.uniform(2300, 3600));
    setGlow(site, 280);
    return site;
}

// Spirals around the columns.
LightSite aroundColumn(Random& random)
{
    LightSite site;
    const int column = int(random.below(bays + 1));
    const float side = random.side(), t = random.uniform(), out = random.uniform();
    const double angle = 2 * pi * 4 * t + column;
    const double distance = columnRadius + 0.12 + 0.25 * out * out;
    site.position = {columnX(column) + distance * std::cos(angle), 0.75 + 4.1 * t,
                     side * naveHalf + distance * std::sin(angle)};
    site.radius = random.skewed(0.03f, 0.09f);
    site.colour = glassColour(random, column);
    setGlow(site, 320);
    return site;
}

// Lights between the things on the floor. Each side of a bay has its hue.
LightSite onFloor(Random& random)
{
    LightSite site;
    const int bay = int(random.below(bays));
    const float side = random.side(), across = random.bell(), along = random.uniform();
    const float size = random.uniform();
    site.radius = 0.07f + 0.25f * size * size;
    const float lift = random.uniform();
    const bool aisle = random.chance(0.35f);
    site.position = {columnX(bay) + bayWidth * along, site.radius + 0.05 + 0.7 * lift * lift,
                     side * (aisle ? 9.2 + 2.3 * across : 3.9 + 1.9 * across)};
    site.colour = glassColour(random, bay + (side > 0 ? 2 : 0));
    setGlow(site, 280);
    return site;
}

LightSite onWall(Random& random)
{
    LightSite site;
    const int column = int(random.below(bays + 1));
    const float side = random.side(), up = random.uniform(), along = random.bell();
    site.radius = random.skewed(0.06f, 0.20f);
    site.position = {columnX(column) + 1.4 * along, 2.2 + 4.5 * up,
                     side * (halfWidth - 0.75 - site.radius)};
    const bool teal = random.chance(0.4f);
    const float vary = random.uniform();
    site.colour =
        teal ? hueColour(0.47f + 0.08f * vary, 0.65f) : blackbodyColour(1800 + 900 * vary);
    setGlow(site, 280);
    return site;
}

LightSite onGallery(Random& random)
{
    LightSite site;
    const float along = random.uniform(-1, 1), side = random.side(), up = random.uniform();
    site.radius = random.skewed(0.04f, 0.12f);
    site.position = {along * (halfLength - 0.5), gallery + 0.95 + 0.5 * up,
                     side * (naveHalf - 0.55)};
    site.colour = blackbodyColour(random.uniform(4000, 9000));
    setGlow(site, 280);
    return site;
}

LightSite underVault(Random& random)
{
    LightSite site;
    const float angle = float(pi) * random.uniform(0.08f, 0.92f);
    const int rib = int(random.below(bays + 1));
    const float along = random.bell();
    const double distance = vaultRadius - 0.75;
    site.position = {columnX(rib) + 0.8 * along, vaultSpringing + distance * std::sin(angle),
                     distance * std::cos(angle)};
    site.radius = random.skewed(0.05f, 0.16f);
    const float hue = random.uniform(0.58f, 0.86f);
    site.colour = hueColour(hue, random.uniform(0.4f, 0.7f));
    setGlow(site, 320);
    return site;
}

// Lights that float in nave and aisles.
LightSite floating(Random& random)
{
    LightSite site;
    const float along = random.uniform(-1, 1), across = random.bell(), up = random.uniform();
    const bool aisle = random.chance(0.35f);
    const float side = random.side();
    site.radius = random.uniform(0.08f, 0.22f);
    site.position =
        aisle ? glm::dvec3(along * (halfLength - 2), 2.5 + 4.5 * up, side * (9 + 1.5 * across))
              : glm::dvec3(along * (halfLength - 2), 2.5 + 9 * up, 4.5 * across);
    site.reach = 1.5f;
    site.colour = blackbodyColour(random.uniform(1900, 2600));
    setGlow(site, 280);
    return site;
}

// Fireflies everywhere.
LightSite firefly(Random& random)
{
    LightSite site;
    const glm::dvec3 at(random.uniform3());
    site.position = {(2 * at.x - 1) * halfLength, 0.1 + at.y * (vaultSpringing + 5),
                     (2 * at.z - 1) * halfWidth};
    site.radius = random.uniform(0.02f, 0.03f);
    site.reach = 1.2f;
    const float hue = random.uniform(0.1f, 0.2f);
    site.colour = hueColour(hue, random.uniform(0.3f, 0.6f));
    setGlow(site, 560);
    return site;
}

// Small lamps let into the floor of the nave, in the joints of the tiles.
LightSite inPavement(Random& random)
{
    LightSite site;
    const uint32_t cell = random.below(2 * uint32_t(halfLength));
    const float across = random.uniform(-1, 1), along = random.bell();
    site.radius = random.uniform(0.02f, 0.045f);
    site.position = {cell - halfLength + 0.08 * along, 0.03 + site.radius, 3.9 * across};
    site.colour = blackbodyColour(random.uniform(2200, 5000));
    setGlow(site, 480);
    return site;
}

// Around the golden knot at the far end.
LightSite onShrine(Random& random)
{
    LightSite site;
    const float along = random.uniform(), across = random.bell(), up = random.uniform();
    site.radius = random.skewed(0.03f, 0.12f);
    site.position = {22.5 + 6.5 * along, 1.2 + 5 * up, 4.5 * across};
    site.colour = blackbodyColour(random.uniform(1900, 3200));
    setGlow(site, 280);
    return site;
}

using MakeSite = LightSite (*)(Random&);

constexpr Share<MakeSite> kinds[] = {{0.13f, onChandelier}, {0.17f, onCable},    {0.10f, onGarland},
                                     {0.12f, aroundColumn}, {0.14f, onFloor},    {0.10f, onWall},
                                     {0.05f, onGallery},    {0.05f, underVault}, {0.03f, floating},
                                     {0.06f, firefly},      {0.04f, inPavement}, {0.01f, onShrine}};

} // namespace

std::vector<LightSite> lightSites(uint32_t count, const SceneOptions& options)
{
    // Lights have separate random streams, so the hall is the same for any number of lights, and
    // resting and moving lights start from the same places.
    Random random(options.seed, 1), motionRandom(options.seed, 2);
    std::vector<LightSite> sites = keyLights(count, options.moving, motionRandom);
    sites.resize(std::min<size_t>(sites.size(), count));
    sites.reserve(count);
    while (sites.size() < count) {
        const MakeSite make = random.oneOf(kinds);
        LightSite site = make(random);
        for (int attempt = 1; attempt < maxTries && !isFree(site.position, site.radius);
             ++attempt) {
            site = make(random);
        }
        site.reach *= random.uniform(0.7f, 1.45f);
        if (options.moving) {
            const float radius = 0.2f + motionRandom.skewed(0.0f, 1.8f);
            const float speed = motionRandom.uniform(0.3f, 1.5f);
            site.motion = circleMotion(motionRandom, site.position.y, site.radius, radius, speed);
        }
        sites.push_back(site);
    }
    return sites;
}

} // namespace candelabra::app::hall
