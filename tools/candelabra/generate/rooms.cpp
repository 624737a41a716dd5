// SPDX-License-Identifier: Apache-2.0
// The rooms: one floor of a house, 12 x 8 rooms of 5 x 4 x 3 m with open doors in most of the walls
// between them. Walls hide most of the lights from most of the rooms: what shadows are for. x runs
// along the long side, z along the short one, y = 0 is the floor. Metres.
#include <algorithm>
#include <utility>
#include <vector>

#include "generate/generators.h"
#include "generate/lights.h"
#include "generate/random.h"
#include "generate/scene_builder.h"
#include "generate/shapes.h"

namespace candelabra::app
{
namespace
{

constexpr uint32_t roomColumns = 12, roomRows = 8, roomCount = roomColumns * roomRows;
constexpr glm::dvec3 roomSize{5, 3, 4};
constexpr double wallThickness = 0.12, doorWidth = 1, doorHeight = 2.1;
// 172 walls stand between two rooms. This many of them, seven in ten, have a door.
constexpr uint32_t doorCount = 119;

struct RoomBox {
    glm::dvec3 low{0}, high{0};
};

struct RoomKit {
    SceneBuilder builder;
    uint32_t box = 0, floor = 0, ceiling = 0, oak = 0, walnut = 0, steel = 0;
    std::vector<uint32_t> paints, fabrics;
    std::vector<RoomBox> furniture[roomCount];
};

// The corner of a room with the smallest coordinates.
glm::dvec3 roomOrigin(uint32_t room)
{
    return roomSize * glm::dvec3(room % roomColumns, 0, room / roomColumns);
}

void addRoomMaterials(RoomKit& kit)
{
    SceneBuilder& b = kit.builder;
    kit.box = b.addMesh(makeBox());
    kit.floor = b.addDielectric("waxed parquet", {0.28f, 0.17f, 0.09f}, 0.33f);
    kit.ceiling = b.addDielectric("ceiling", {0.75f, 0.74f, 0.72f}, 0.9f);
    kit.oak = b.addDielectric("oak", {0.45f, 0.30f, 0.17f}, 0.45f);
    kit.walnut = b.addDielectric("walnut", {0.16f, 0.09f, 0.05f}, 0.25f);
    kit.steel = b.addMetal("brushed steel", {0.56f, 0.57f, 0.58f}, 0.4f);
    kit.paints = {b.addDielectric("white wall", {0.74f, 0.72f, 0.68f}, 0.75f),
                  b.addDielectric("sand wall", {0.66f, 0.56f, 0.42f}, 0.75f),
                  b.addDielectric("sage wall", {0.42f, 0.50f, 0.38f}, 0.7f),
                  b.addDielectric("blue wall", {0.28f, 0.38f, 0.52f}, 0.6f),
                  b.addDielectric("terracotta wall", {0.60f, 0.29f, 0.18f}, 0.75f)};
    kit.fabrics = {b.addDielectric("grey wool", {0.30f, 0.30f, 0.31f}, 0.95f),
                   b.addDielectric("mustard velvet", {0.55f, 0.36f, 0.06f}, 0.8f),
                   b.addDielectric("petrol velvet", {0.04f, 0.22f, 0.25f}, 0.8f),
                   b.addDielectric("red leather", {0.36f, 0.05f, 0.04f}, 0.4f),
                   b.addDielectric("linen", {0.70f, 0.66f, 0.58f}, 0.9f)};
}

void addRoomBox(RoomKit& kit, uint32_t material, const glm::dvec3& low, const glm::dvec3& high)
{
    kit.builder.place(kit.box, material, 0.5 * (low + high), high - low);
}

// Adds a wall that runs from `from` along x or z and reaches into floor and ceiling. Its door, if
// it has one, begins at `door` metres along it.
void addWall(RoomKit& kit, uint32_t paint, const glm::dvec3& from, bool alongX, bool hasDoor,
             double door)
{
    const double length = alongX ? roomSize.x : roomSize.z, half = 0.5 * wallThickness;
    const auto addPart = [&](double begin, double end, double bottom) {
        const glm::dvec3 low =
            alongX ? glm::dvec3(begin, bottom, -half) : glm::dvec3(-half, bottom, begin);
        const glm::dvec3 high = alongX ? glm::dvec3(end, roomSize.y + 0.05, half)
                                       : glm::dvec3(half, roomSize.y + 0.05, end);
        addRoomBox(kit, paint, from + low, from + high);
    };
    if (!hasDoor)
        return addPart(-half, length + half, -0.05);
    addPart(-half, door, -0.05);
    addPart(door + doorWidth, length + half, -0.05);
    addPart(door, door + doorWidth, doorHeight);
}

// Adds floor, ceiling and walls. Doors are in that half of a wall that begins in the room's origin,
// so that furniture has the other half, and rows of doors are nearly in line.
void addWalls(RoomKit& kit, Random& random)
{
    const glm::dvec3 end = roomSize * glm::dvec3(roomColumns, 0, roomRows);
    addRoomBox(kit, kit.floor, {-0.1, -0.2, -0.1}, {end.x + 0.1, 0, end.z + 0.1});
    addRoomBox(kit, kit.ceiling, {-0.1, roomSize.y, -0.1},
               {end.x + 0.1, roomSize.y + 0.2, end.z + 0.1});
    std::vector<bool> doors(2 * roomCount - roomColumns - roomRows);
    std::fill_n(doors.begin(), doorCount, true);
    for (size_t i = doors.size() - 1; i > 0; --i)
        std::vector<bool>::swap(doors[i], doors[random.below(uint32_t(i + 1))]);
    size_t inner = 0;
    const auto add = [&](uint32_t column, uint32_t row, bool alongX) {
        const bool isOuter = alongX ? row % roomRows == 0 : column % roomColumns == 0;
        const uint32_t paint = random.anyOf(kit.paints);
        const double door = random.uniform(0.55f, 0.85f);
        addWall(kit, paint, roomSize * glm::dvec3(column, 0, row), alongX,
                !isOuter && doors[inner++], door);
    };
    for (uint32_t row = 0; row <= roomRows; ++row)
        for (uint32_t column = 0; column < roomColumns; ++column)
            add(column, row, true);
    for (uint32_t row = 0; row < roomRows; ++row)
        for (uint32_t column = 0; column <= roomColumns; ++column)
            add(column, row, false);
}

// Furniture of one room. Boxes are given from the corner of the room, in centimetres.
class Furniture
{
public:
    Furniture(RoomKit& kit, uint32_t room) : kit_(kit), room_(room) {}

    void box(uint32_t material, const glm::dvec3& low, const glm::dvec3& size)
    {
        const glm::dvec3 from = roomOrigin(room_) + 0.01 * low;
        kit_.furniture[room_].push_back({from, from + 0.01 * size});
        addRoomBox(kit_, material, from, from + 0.01 * size);
    }

    // Five boxes.
    void table(uint32_t top, uint32_t legs, const glm::dvec3& low, const glm::dvec3& size)
    {
        constexpr double thick = 5;
        box(top, low + glm::dvec3(0, size.y - thick, 0), {size.x, thick, size.z});
        for (const double x : {3.0, size.x - 3 - thick})
            for (const double z : {3.0, size.z - 3 - thick})
                box(legs, low + glm::dvec3(x, 0, z), {thick, size.y - thick, thick});
    }

    // Four boxes: a seat with its back towards the far wall, and arms.
    void sofa(uint32_t fabric, const glm::dvec3& low, double width)
    {
        box(fabric, low + glm::dvec3(0, 8, 0), {width, 34, 65});
        box(fabric, low + glm::dvec3(0, 8, 65), {width, 75, 20});
        for (const double x : {-18.0, width})
            box(fabric, low + glm::dvec3(x, 4, 0), {18, 56, 85});
    }

    // Five boxes: two sides and three boards.
    void shelf(uint32_t wood, const glm::dvec3& low, const glm::dvec3& size)
    {
        for (const double z : {0.0, size.z - 4})
            box(wood, low + glm::dvec3(0, 0, z), {size.x, size.y, 4});
        for (const double share : {0.1, 0.4, 0.7})
            box(wood, low + glm::dvec3(0, share * size.y, 4), {size.x, 4, size.z - 8});
    }

private:
    RoomKit& kit_;
    uint32_t room_;
};

// A living room or a study, of 15 boxes each.
void furnish(RoomKit& kit, Random& random, uint32_t room)
{
    Furniture add(kit, room);
    const uint32_t fabric = random.anyOf(kit.fabrics), rug = random.anyOf(kit.fabrics);
    const uint32_t wood = random.chance(0.5f) ? kit.oak : kit.walnut;
    const double aside = random.uniform(-20, 20), depth = random.uniform(-10, 10);
    add.shelf(wood, {455, 0, 215 + depth}, {36, 190, 130});
    if (random.chance(0.6f)) {
        add.sofa(fabric, {215 + aside, 0, 300}, 170);
        add.table(wood, kit.steel, {240 + aside, 0, 205 + depth}, {110, 42, 60});
        add.box(rug, {190 + aside, 0, 190 + depth}, {220, 1.2, 105});
        return;
    }
    add.table(wood, kit.oak, {230 + aside, 0, 300}, {160, 74, 80});
    add.box(fabric, {285 + aside, 0, 245 + depth}, {46, 45, 44}); // a stool
    add.box(kit.steel, {30, 0, 345}, {45, 62, 40});
    add.box(fabric, {95, 0, 335 + depth}, {50, 38, 50});
    add.box(wood, {102, 38, 342 + depth}, {34, 26, 34});
    add.box(rug, {200 + aside, 0, 200 + depth}, {200, 1.2, 95});
}

bool isInFurniture(const RoomKit& kit, uint32_t room, const glm::dvec3& position, double margin)
{
    const auto& boxes = kit.furniture[room];
    return std::ranges::any_of(boxes, [&](const RoomBox& box) {
        return glm::all(glm::greaterThan(position, box.low - margin)) &&
               glm::all(glm::lessThan(position, box.high + margin));
    });
}

// A pendant, or a lamp near the floor or the ceiling, most of them along a wall. Every room has a
// colour of its own.
LightSite roomLight(const RoomKit& kit, Random& random, uint32_t room, bool isFirst)
{
    LightSite site;
    const float warmth = float((room * 37) % roomCount) / roomCount;
    const glm::dvec3 origin = roomOrigin(room);
    const double where = isFirst ? 0 : double(random.uniform());
    do {
        const glm::dvec3 at = random.uniform3();
        site.position = origin + 0.25 + (roomSize - 0.5) * at;
        site.radius = random.uniform(0.02f, 0.05f);
        if (where < 0.2) { // a pendant
            site.position.y = random.uniform(2.2f, 2.6f);
            site.radius = random.uniform(0.05f, 0.08f);
            site.reach = 1.6f;
        } else {
            site.position.y = random.chance(0.5f) ? 0.12 : 2.82;
        }
        if (where > 0.35) { // along a wall
            const int axis = random.chance(0.5f) ? 0 : 2;
            const double side = random.chance(0.5f) ? 0.2 : roomSize[axis] - 0.2;
            site.position[axis] = origin[axis] + side;
        }
    } while (isInFurniture(kit, room, site.position, double(site.radius) + 0.02));
    site.colour = random.chance(0.7f) ? blackbodyColour(2200 + 3500 * warmth)
                                      : hueColour(warmth, random.uniform(0.35f, 0.65f));
    site.reach *= random.uniform(0.8f, 1.25f);
    return site;
}

std::vector<LightSite> roomLights(const RoomKit& kit, uint32_t count, const SceneOptions& options)
{
    Random random(options.seed, 1), motionRandom(options.seed, 2);
    std::vector<LightSite> sites;
    for (uint32_t i = 0; i < count; ++i) {
        // 35 and 96 have no common divisor, so few lights are spread over the whole house.
        sites.push_back(roomLight(kit, random, i * 35 % roomCount, i < roomCount));
        LightSite& site = sites.back();
        const float radius = motionRandom.uniform(0.05f, 0.2f);
        if (options.moving)
            site.motion = circleMotion(motionRandom, site.position.y, site.radius, radius,
                                       motionRandom.uniform(0.2f, 0.6f));
    }
    return sites;
}

} // namespace

Scene generateRooms(const SceneOptions& options)
{
    const uint32_t count = options.lights.value_or(defaultLightCount);
    checkLightOptions("rooms", count, options);
    RoomKit kit;
    kit.builder.scene.name = "rooms";
    addRoomMaterials(kit);
    Random random(options.seed);
    addWalls(kit, random);
    for (uint32_t room = 0; room < roomCount; ++room)
        furnish(kit, random, room);

    Scene& scene = kit.builder.scene;
    scene.interior = true;
    scene.cameras = {
        makeUprightCamera("salon", {30.35, 1.6, 12.55}, {1, -0.13, 0.8}, glm::radians(60.0)),
        makeUprightCamera("enfilade", {5.4, 1.55, 17.3}, {1, -0.1, 0.12}, glm::radians(58.0))};
    addSphereLights(scene, roomLights(kit, count, options), options);
    return std::move(scene);
}

} // namespace candelabra::app
