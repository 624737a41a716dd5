// SPDX-License-Identifier: Apache-2.0
// Places the lights of the field.
#include <algorithm>
#include <cmath>
#include <numbers>

#include "generate/field.h"

namespace candelabra::app::field
{
namespace
{

using std::numbers::pi;

// A zone of the city with its share of the lights. Lights become sparser with the distance from the
// default camera: near streets have many small ones, and far districts are lit by few with a large
// influence. The zones are discs on the ground, and the whole city.
struct Zone {
    float share; // of the lights; the shares of all zones add up to 1
    glm::dvec2 centre;
    double radius;
};
constexpr Zone zones[] = {{0.34f, {20, 1270}, 330}, {0.36f, {-80, 850}, 900}};

glm::dvec2 inCity(Random& random)
{
    return cityHalf * (2.0 * glm::dvec2(random.uniform2()) - 1.0);
}

bool isInside(const Zone& zone, const glm::dvec2& p)
{
    const glm::dvec2 d = p - zone.centre;
    return glm::dot(d, d) < zone.radius * zone.radius;
}

glm::dvec2 drawPlace(Random& random)
{
    float at = random.uniform();
    for (const Zone& zone : zones) {
        if (at < zone.share) {
            // Points are uniform in the disc: those of its square outside the disc are rejected.
            glm::dvec2 p;
            do {
                p = zone.centre + zone.radius * (2.0 * glm::dvec2(random.uniform2()) - 1.0);
            } while (!isInside(zone, p) || std::abs(p.y) > cityHalf);
            return p;
        }
        at -= zone.share;
    }
    return inCity(random);
}

// The density of lights around `p` per square metre, if there were one light in all.
double density(const glm::dvec2& p)
{
    double sum = 0, rest = 1;
    for (const Zone& zone : zones) {
        rest -= zone.share;
        if (isInside(zone, p))
            sum += zone.share / (pi * zone.radius * zone.radius);
    }
    return sum + rest / (4 * cityHalf * cityHalf);
}

// A place on one of the streets: `street` is the coordinate of its middle, `along` the place on it.
struct StreetPlace {
    bool runsAlongZ;
    double street, along;

    glm::dvec3 at(double across, double y) const
    {
        return runsAlongZ ? glm::dvec3(street + across, y, along)
                          : glm::dvec3(along, y, street + across);
    }
};

StreetPlace nearestStreet(Random& random, const glm::dvec2& p)
{
    StreetPlace place;
    place.runsAlongZ = random.chance(0.5f);
    const double across = place.runsAlongZ ? p.x : p.y;
    place.along = place.runsAlongZ ? p.y : p.x;
    const double street = std::round((across + cityHalf) / blockSize);
    place.street = streetAt(int(std::clamp(street, 0.0, 1.0 * blockCount)));
    return place;
}

using Buildings = std::vector<std::vector<Building>>;

LightSite onLamp(Random& random, const glm::dvec2& p, const Buildings&)
{
    LightSite site;
    StreetPlace place = nearestStreet(random, p);
    const float side = random.side();
    const double jitter = random.bell();
    place.along = lampSpacing * (std::floor(place.along / lampSpacing) + 0.5);
    place.along += 0.15 * jitter;
    site.position = place.at(side * (lampOffset - lampReach), lampHeight);
    site.radius = random.uniform(0.12f, 0.35f);
    // A district has either sodium lamps or white ones.
    const bool sodium = std::floor(p.x / 400) + std::floor(p.y / 560) > -1;
    site.colour = blackbodyColour(sodium ? random.uniform(2100, 2900) : random.uniform(3600, 5600));
    site.edgeIlluminance = 1.2f;
    return site;
}

LightSite onCar(Random& random, const glm::dvec2& p, const Buildings&)
{
    LightSite site;
    const StreetPlace place = nearestStreet(random, p);
    const float side = random.side();
    const double lane = random.uniform(1.5f, 4.5f);
    site.radius = random.uniform(0.10f, 0.18f);
    site.position = place.at(side * lane, 0.75);
    const float warm = random.uniform(4000, 6500);
    site.colour = side > 0 ? blackbodyColour(warm) : hueColour(0.0f, 0.85f);
    site.edgeIlluminance = side > 0 ? 1.0f : 0.6f;
    return site;
}

// Places signs and shop windows along the fronts of houses.
LightSite onFront(Random& random, const glm::dvec2& p, const Buildings&)
{
    LightSite site;
    const StreetPlace place = nearestStreet(random, p);
    const float side = random.side(), up = random.uniform();
    site.radius = random.skewed(0.15f, 0.9f);
    site.position = place.at(side * (0.5 * streetWidth + pavementWidth - 0.6 - site.radius),
                             2.6 + site.radius + 9 * up * up);
    const float hue = random.uniform();
    site.colour = hueColour(hue, random.uniform(0.55f, 0.85f));
    site.edgeIlluminance = 1.2f;
    return site;
}

LightSite onRoof(Random& random, const glm::dvec2& p, const Buildings& buildings)
{
    LightSite site = onLamp(random, p, buildings);
    const auto block = [](double at) {
        return std::clamp(int(std::floor((at + cityHalf) / blockSize)), 0, blockCount - 1);
    };
    const std::vector<Building>& choice = buildings[size_t(blockCount) * block(p.y) + block(p.x)];
    if (choice.empty()) {
        return site; // in parks and at the river it stays a street lamp
    }
    const Building& building = random.anyOf(choice);
    const glm::dvec2 offset = 0.8 * (2.0 * glm::dvec2(random.uniform2()) - 1.0);
    site.radius = random.skewed(0.3f, building.height > 60 ? 3.0f : 1.2f);
    site.position =
        building.base + glm::dvec3(offset.x * building.halfX, building.height + 1 + site.radius,
                                   offset.y * building.halfZ);
    const bool red = random.chance(0.3f);
    site.colour = red ? hueColour(0.99f, 0.8f) : hueColour(random.uniform(0.45f, 0.7f), 0.6f);
    site.edgeIlluminance = 0.8f;
    return site;
}

// Places lanterns that rise over the city and drift over the water.
LightSite lantern(Random& random, const glm::dvec2& p, const Buildings&)
{
    LightSite site;
    const float up = random.uniform();
    site.radius = random.uniform(0.3f, 0.9f);
    site.position = {p.x, isRiver(p.y) ? 0.3 + site.radius : 18 + 60 * up, p.y};
    site.reach = isRiver(p.y) ? 1 : 1.6f;
    site.colour = blackbodyColour(random.uniform(1800, 2600));
    site.edgeIlluminance = 0.5f;
    return site;
}

// Places lights along the rim of the wheel and the cables of the suspension bridge.
LightSite onLandmark(Random& random, const glm::dvec2&, const Buildings&)
{
    LightSite site;
    const bool wheel = random.chance(0.5f);
    const float t = random.uniform(), side = random.side(), vary = random.uniform();
    site.radius = random.uniform(0.12f, 0.3f);
    if (wheel) {
        const double angle = 2 * pi * t;
        const double radius = wheelRadius + 0.7;
        site.position =
            wheelHub + glm::dvec3(radius * std::cos(angle), radius * std::sin(angle), 2.5 * side);
        site.colour = hueColour(3 * t + 0.1f * vary, 0.75f);
    } else {
        site.position = {side * bridgeHalfWidth, cableHeight(t) + 0.6,
                         riverNorth + (riverSouth - riverNorth) * t};
        site.colour = blackbodyColour(2400 + 1500 * vary);
    }
    site.edgeIlluminance = 1;
    return site;
}

using MakeSite = LightSite (*)(Random&, const glm::dvec2&, const Buildings&);

constexpr Share<MakeSite> kinds[] = {{0.44f, onLamp}, {0.14f, onCar},   {0.22f, onFront},
                                     {0.10f, onRoof}, {0.07f, lantern}, {0.03f, onLandmark}};

} // namespace

std::vector<LightSite> lightSites(const Kit& kit, uint32_t count, const SceneOptions& options)
{
    // Each kind of light has a random stream of its own, as in the hall.
    Random random(options.seed, 1), motionRandom(options.seed, 2);
    const double farDensity = density({cityHalf, -cityHalf});
    std::vector<LightSite> sites;
    sites.reserve(count);
    for (uint32_t i = 0; i < count; ++i) {
        const glm::dvec2 place = drawPlace(random);
        const MakeSite make = random.oneOf(kinds);
        LightSite site = make(random, place, kit.buildings);
        const bool overWater = isRiver(site.position.z) && make != onLandmark && make != lantern;
        if (overWater)
            site = lantern(random, place, kit.buildings);
        // The influence radius is proportional to the mean distance of neighbours.
        site.reach *= float(std::sqrt(farDensity / density({site.position.x, site.position.z})));
        site.reach *= random.uniform(0.7f, 1.45f);
        if (options.moving) {
            const float radius = motionRandom.skewed(0.5f, 8);
            const float speed = motionRandom.uniform(1, 8);
            site.motion = circleMotion(motionRandom, site.position.y, site.radius, radius, speed);
        }
        sites.push_back(site);
    }
    return sites;
}

} // namespace candelabra::app::field
