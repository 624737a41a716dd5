// SPDX-License-Identifier: Apache-2.0
// Meshes and materials of the field, and the field itself.
#include <cmath>
#include <string>

#include "generate/field.h"
#include "generate/generators.h"
#include "generate/mesh_builder.h"
#include "generate/shapes.h"

namespace candelabra::app::field
{
namespace
{

// The texture of windows has cells of 8 x 8 texels, with 2 texels of wall around each pane.
constexpr uint32_t textureCells = 32, cellTexels = 8, frameTexels = 2;
// The number of panes next to each other on the shorter sides of a facade.
constexpr double windowColumns = 8;

glm::mat4 boxTransform(const glm::vec3& low, const glm::vec3& high)
{
    return glm::scale(glm::translate(glm::mat4(1), 0.5f * (low + high)), high - low);
}

// Appends a box whose sides show the windows that fit its share of the unit house.
void appendStoreys(Mesh& mesh, const glm::vec3& low, const glm::vec3& high)
{
    const size_t first = mesh.vertices.size();
    appendMesh(mesh, makeBox(), boxTransform(low, high));
    for (size_t i = first; i < mesh.vertices.size(); ++i) {
        Vertex& vertex = mesh.vertices[i];
        if (vertex.normal.y == 0) {
            const bool facesX = vertex.normal.x != 0;
            vertex.uv[0].x *= facesX ? high.z - low.z : high.x - low.x;
            vertex.uv[0].y = vertex.position.y;
            vertex.uv[1] = vertex.uv[0];
        }
    }
}

// Appends a box without windows: its uv is the corner of the texture, which shows wall.
void appendSolid(Mesh& mesh, const glm::vec3& low, const glm::vec3& high)
{
    const size_t first = mesh.vertices.size();
    appendMesh(mesh, makeBox(), boxTransform(low, high));
    for (size_t i = first; i < mesh.vertices.size(); ++i)
        mesh.vertices[i].uv[0] = mesh.vertices[i].uv[1] = glm::vec2(0);
}

// Houses are 1 x 1 x 1 in size and stand on y = 0.
Mesh makePlainHouse()
{
    Mesh mesh;
    appendStoreys(mesh, {-0.5f, 0, -0.5f}, {0.5f, 1, 0.5f});
    return mesh;
}

Mesh makeLedgedHouse()
{
    Mesh mesh;
    appendStoreys(mesh, {-0.48f, 0, -0.48f}, {0.48f, 0.97f, 0.48f});
    const float ledges[][3] = {
        {0, 0.04f, 0.5f}, {0.32f, 0.335f, 0.49f}, {0.64f, 0.655f, 0.49f}, {0.93f, 0.98f, 0.5f}};
    for (const auto& [low, high, half] : ledges)
        appendSolid(mesh, {-half, low, -half}, {half, high, half});
    // The head of the stairs on the roof.
    appendSolid(mesh, {-0.2f, 0.97f, -0.1f}, {0.05f, 1.0f, 0.2f});
    return mesh;
}

Mesh makeSetbackTower()
{
    Mesh mesh;
    appendStoreys(mesh, {-0.5f, 0, -0.5f}, {0.5f, 0.45f, 0.5f});
    appendStoreys(mesh, {-0.38f, 0.45f, -0.38f}, {0.38f, 0.75f, 0.38f});
    appendStoreys(mesh, {-0.25f, 0.75f, -0.25f}, {0.25f, 0.9f, 0.25f});
    appendSolid(mesh, {-0.12f, 0.9f, -0.12f}, {0.12f, 0.93f, 0.12f});
    appendSolid(mesh, {-0.012f, 0.93f, -0.012f}, {0.012f, 1.0f, 0.012f});
    return mesh;
}

Mesh makeRoundTower()
{
    // u runs around as many windows as four facades have, and v runs upwards.
    Mesh walls = makeLathe({{{0.5f, 0}, {0.5f, 0.94f}}}, 24);
    for (Vertex& vertex : walls.vertices)
        vertex.uv[0] = vertex.uv[1] = glm::vec2(4 * vertex.uv[0].x, vertex.position.y);
    Mesh roof = makeLathe({{{0.5f, 0.94f}, {0.53f, 0.95f}},
                           {{0.53f, 0.95f}, {0.53f, 0.97f}},
                           {{0.53f, 0.97f}, {0.3f, 1}, {0, 1}}},
                          24);
    for (Vertex& vertex : roof.vertices)
        vertex.uv[0] = vertex.uv[1] = glm::vec2(0);
    Mesh mesh;
    appendMesh(mesh, walls, glm::mat4(1));
    appendMesh(mesh, roof, glm::mat4(1));
    return mesh;
}

// Appends a four-sided rod of radius `radius` between two points.
void appendBar(Mesh& mesh, const glm::vec3& from, const glm::vec3& to, float radius)
{
    const glm::vec3 axis = to - from;
    const glm::vec3 other =
        std::abs(axis.x) < 0.7f * glm::length(axis) ? glm::vec3(1, 0, 0) : glm::vec3(0, 0, 1);
    const glm::vec3 side = glm::normalize(glm::cross(axis, other));
    const glm::vec3 front = glm::cross(side, glm::normalize(axis));
    appendMesh(mesh, makeCylinder(4),
               glm::mat4(glm::vec4(side * radius, 0), glm::vec4(axis, 0),
                         glm::vec4(front * radius, 0), glm::vec4(from, 1)));
}

// A street lamp, which stands at the kerb; its arm points to +z.
Mesh makeLamp()
{
    Mesh mesh;
    const float height = float(lampHeight) + 0.3f;
    const float reach = float(lampReach);
    appendBar(mesh, {0, 0, 0}, {0, height, 0}, 0.09f);
    appendBar(mesh, {0, height, 0}, {0, height + 0.25f, reach}, 0.05f);
    appendMesh(
        mesh, makeBox(),
        boxTransform({-0.25f, height + 0.15f, reach - 0.4f}, {0.25f, height + 0.3f, reach + 0.3f}));
    return mesh;
}

// A tree about 1 high. Vertex colours distinguish trunk and crown.
Mesh makeTree()
{
    Mesh mesh;
    appendMesh(mesh, makeCylinder(4), glm::scale(glm::mat4(1), {0.03f, 0.4f, 0.03f}));
    for (Vertex& vertex : mesh.vertices)
        vertex.color = {0.9f, 0.45f, 0.3f, 1};
    appendMesh(mesh, makeSphere(7, 5),
               glm::scale(glm::translate(glm::mat4(1), {0, 0.65f, 0}), {0.28f, 0.35f, 0.28f}));
    return mesh;
}

// A lattice mast 1 high.
Mesh makeMast()
{
    Mesh mesh;
    constexpr int levels = 9;
    const auto corner = [](int level, int which) {
        const float y = float(level) / levels;
        const float half = 0.08f * (1 - 0.9f * y);
        const float x = which == 0 || which == 3 ? -half : half;
        return glm::vec3(x, y, which < 2 ? -half : half);
    };
    for (int level = 0; level < levels; ++level) {
        for (int which = 0; which < 4; ++which) {
            const int next = (which + 1) % 4;
            appendBar(mesh, corner(level, which), corner(level + 1, which), 0.006f);
            appendBar(mesh, corner(level, which), corner(level + 1, next), 0.003f);
            appendBar(mesh, corner(level + 1, which), corner(level + 1, next), 0.003f);
        }
    }
    return mesh;
}

struct WindowTextures {
    int32_t baseColor, metallicRoughness;
};

// Draws the colour of a pane in sRGB bytes: glass is nearly black, unless curtains are drawn.
glm::u8vec3 paneColour(Random& random)
{
    const glm::u8vec3 curtains[] = {
        {255, 196, 110}, {255, 214, 150}, {235, 240, 255}, {130, 170, 255}};
    const bool drawn = random.chance(0.36f);
    const uint32_t kind = random.below(8);
    const float level = random.uniform(0.35f, 1.0f);
    if (!drawn)
        return glm::u8vec3(40);
    return glm::u8vec3(level * glm::vec3(curtains[kind < 4 ? 0 : kind < 6 ? 1 : kind < 7 ? 2 : 3]));
}

WindowTextures addWindowTextures(Scene& scene, Random& random)
{
    constexpr uint32_t size = textureCells * cellTexels;
    Texture base{.width = size, .height = size, .rgba = std::vector<uint8_t>(4 * size * size, 255)};
    base.srgb = true;
    Texture roughness = base;
    roughness.srgb = false;
    for (uint32_t cellY = 0; cellY < textureCells; ++cellY) {
        for (uint32_t cellX = 0; cellX < textureCells; ++cellX) {
            const glm::u8vec3 colour = paneColour(random);
            for (uint32_t i = 0; i < cellTexels * cellTexels; ++i) {
                const uint32_t x = i % cellTexels, y = i / cellTexels;
                const bool pane = x >= frameTexels && x < cellTexels - frameTexels &&
                                  y >= frameTexels && y < cellTexels - frameTexels;
                const size_t at =
                    4 * ((cellY * cellTexels + y) * size_t(size) + cellX * cellTexels + x);
                for (size_t channel = 0; channel < 3; ++channel) {
                    const int c = int(channel);
                    base.rgba[at + channel] = pane ? colour[c] : uint8_t{255};
                }
                roughness.rgba[at + 1] = pane ? 25 : 200; // 0.1 and 0.78
                roughness.rgba[at + 2] = 0;
            }
        }
    }
    const int32_t first = int32_t(scene.textures.size());
    scene.textures.push_back(std::move(base));
    scene.textures.push_back(std::move(roughness));
    return {first, first + 1};
}

void addFacades(Kit& kit, Random& random)
{
    const WindowTextures textures = addWindowTextures(kit.builder.scene, random);
    const glm::vec3 walls[] = {
        {0.42f, 0.35f, 0.28f}, {0.36f, 0.14f, 0.09f}, {0.50f, 0.48f, 0.44f}, {0.16f, 0.19f, 0.23f}};
    for (size_t style = 0; style < std::size(walls); ++style) {
        for (const int storeys : facadeStoreys) {
            Material facade;
            facade.name =
                "facade " + std::to_string(style) + ", " + std::to_string(storeys) + " storeys";
            facade.baseColor = walls[style];
            // The offset is a whole number of cells, so that uv 0 stays in the corner of a cell,
            // which is wall.
            const glm::vec2 offset = glm::floor(random.uniform2() * float(textureCells));
            const float cells = float(textureCells);
            TextureRef ref;
            ref.uRow = {float(windowColumns) / cells, 0, offset.x / cells};
            ref.vRow = {0, float(storeys) / cells, offset.y / cells};
            ref.texture = textures.baseColor;
            facade.baseColorTexture = ref;
            ref.texture = textures.metallicRoughness;
            facade.metallicRoughnessTexture = ref;
            kit.material.facades.push_back(kit.builder.addMaterial(facade));
        }
    }
}

} // namespace

void addMeshes(Kit& kit)
{
    SceneBuilder& b = kit.builder;
    kit.mesh.box = b.addMesh(makeBox());
    kit.mesh.slab = b.addMesh(makeTile(0.012f));
    kit.mesh.street = b.addMesh(makeGround(2));
    kit.mesh.plainHouse = b.addMesh(makePlainHouse());
    kit.mesh.ledgedHouse = b.addMesh(makeLedgedHouse());
    kit.mesh.gabledHouse = b.addMesh(makeGabledHouse());
    kit.mesh.setbackTower = b.addMesh(makeSetbackTower());
    kit.mesh.roundTower = b.addMesh(makeRoundTower());
    kit.mesh.lamp = b.addMesh(makeLamp());
    kit.mesh.tree = b.addMesh(makeTree());
    kit.mesh.rod = b.addMesh(makeCylinder(6));
    kit.mesh.ring = b.addMesh(makeTorus(1, 0.012f, 64, 5));
    kit.mesh.ball = b.addMesh(makeSphere(24, 14));
    kit.mesh.hill = b.addMesh(makeSphere(32, 16));
    kit.mesh.mast = b.addMesh(makeMast());
}

void addMaterials(Kit& kit, Random& random)
{
    SceneBuilder& b = kit.builder;
    Materials& m = kit.material;
    // Asphalt from puddles to dry.
    for (const float perceptualRoughness : {0.12f, 0.2f, 0.3f, 0.42f, 0.6f})
        m.asphalt.push_back(b.addDielectric("asphalt", glm::vec3(0.06f), perceptualRoughness));
    m.pavement = b.addDielectric("pavement", {0.26f, 0.25f, 0.23f}, 0.55f);
    m.water = b.addDielectric("water", {0.01f, 0.02f, 0.025f}, 0.07f);
    b.scene.materials.back().dielectricF0 = glm::vec3(0.02f); // index of refraction 1.33
    m.grass = b.addDielectric("grass", {0.08f, 0.13f, 0.04f}, 0.9f);
    m.leaves = b.addDielectric("leaves", {0.10f, 0.20f, 0.06f}, 0.7f);
    m.concrete = b.addDielectric("concrete", {0.38f, 0.37f, 0.35f}, 0.75f);
    m.roof = b.addDielectric("roof tiles", {0.32f, 0.13f, 0.08f}, 0.6f);
    m.hill = b.addDielectric("hills", {0.10f, 0.11f, 0.08f}, 0.95f);
    m.painted = b.addDielectric("red paint", {0.52f, 0.07f, 0.05f}, 0.35f);
    // The F0 of metals is that of the hall (Lagarde 2011).
    m.steel = b.addMetal("steel", {0.56f, 0.57f, 0.58f}, 0.4f);
    m.chrome = b.addMetal("chrome", {0.549f, 0.556f, 0.554f}, 0.06f);
    m.gold = b.addMetal("gold", {1.0f, 0.766f, 0.336f}, 0.2f);
    addFacades(kit, random);
}

} // namespace candelabra::app::field

namespace candelabra::app
{

Scene generateField(const SceneOptions& options)
{
    const uint32_t count = options.lights.value_or(defaultLightCount);
    checkLightOptions("field", count, options);
    field::Kit kit{};
    kit.builder.scene.name = "field";
    Random random(options.seed);
    field::addMeshes(kit);
    field::addMaterials(kit, random);
    field::addCity(kit, random);
    field::addLandmarks(kit, random);

    Scene& scene = kit.builder.scene;
    // Blue hour: the sky about as bright as the streets.
    scene.background = field::skyLuminance;
    // In the middle of what the default camera sees near by, where precision is wanted most.
    scene.lightOrigin = {0, 0, 1100};
    scene.cameras = {
        makeUprightCamera("terrace", field::cameraPosition, {-0.09, -0.155, -1},
                          glm::radians(46.0)),
        makeUprightCamera("overview", {-1500, 620, 1900}, {0.75, -0.38, -1}, glm::radians(50.0))};
    for (Camera& camera : scene.cameras)
        camera.nearPlane = 0.5;
    addSphereLights(scene, field::lightSites(kit, count, options), options);
    return std::move(kit.builder.scene);
}

} // namespace candelabra::app
