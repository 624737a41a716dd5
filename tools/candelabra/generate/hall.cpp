// SPDX-License-Identifier: Apache-2.0
#include "generate/hall.h"
#include "generate/generators.h"

#include <algorithm>
#include <iterator>
#include <numbers>
#include <string>
#include <utility>

#include "generate/mesh_builder.h"
#include "generate/shapes.h"

namespace candelabra::app
{
namespace hall
{
namespace
{

using std::numbers::pi_v;

Mesh makeColumnBase()
{
    // Attic base: torus, scotia, torus; the plinth below it is a box.
    return makeLathe({{{0.62f, 0.16f}, {0.66f, 0.20f}, {0.66f, 0.28f}, {0.62f, 0.32f}},
                      {{0.55f, 0.33f}, {0.50f, 0.38f}, {0.49f, 0.44f}, {0.53f, 0.47f}},
                      {{0.53f, 0.47f}, {0.55f, 0.50f}, {0.53f, 0.54f}, {0.45f, 0.56f}}},
                     24);
}

Mesh makeShaft()
{
    // Entasis: thickest a third up, then thinner to 5/6.
    return makeLathe({{{0.43f, 0.54f},
                       {0.435f, 1.6f},
                       {0.43f, 2.6f},
                       {0.41f, 3.6f},
                       {0.385f, 4.4f},
                       {0.36f, 5.0f}}},
                     24);
}

Mesh makeCapital()
{
    return makeLathe({{{0.36f, 5.0f}, {0.42f, 5.03f}, {0.42f, 5.09f}, {0.36f, 5.12f}},
                      {{0.36f, 5.12f},
                       {0.38f, 5.25f},
                       {0.46f, 5.38f},
                       {0.60f, 5.47f},
                       {0.66f, 5.56f},
                       {0.62f, 5.6f}}},
                     24);
}

Mesh makeVase()
{
    return makeLathe({{{0, 0}, {0.16f, 0}},
                      {{0.16f, 0},
                       {0.17f, 0.03f},
                       {0.10f, 0.08f},
                       {0.20f, 0.22f},
                       {0.28f, 0.40f},
                       {0.27f, 0.55f},
                       {0.16f, 0.72f},
                       {0.11f, 0.82f},
                       {0.13f, 0.92f},
                       {0.20f, 1.0f}},
                      {{0.20f, 1.0f}, {0.18f, 1.0f}},
                      {{0.18f, 1.0f}, {0.11f, 0.92f}, {0.09f, 0.82f}, {0, 0.75f}}},
                     14);
}

// Makes the ribs of a lamp, which stand in a circle around its light and bulge like a pear. The
// gaps between them take three quarters of it.
Mesh makeLampRibs()
{
    constexpr int ribs = 8;
    constexpr float halfWidth = pi_v<float> / ribs / 4, thickness = 0.02f;
    constexpr glm::vec2 profile[] = {{0.14f, 0.02f},  {0.27f, 0.12f}, {0.335f, 0.28f},
                                     {0.345f, 0.43f}, {0.30f, 0.60f}, {0.20f, 0.73f}};
    Mesh mesh;
    for (int rib = 0; rib < ribs; ++rib) {
        const auto at = [&](const glm::vec2& point, float aside, float out) {
            const glm::vec2 around = direction(2 * pi_v<float> * float(rib) / ribs + aside);
            return glm::vec3(around.x * (point.x + out), point.y, around.y * (point.x + out));
        };
        for (size_t i = 0; i + 1 < std::size(profile); ++i) {
            const glm::vec2 &low = profile[i], &high = profile[i + 1];
            const auto addFace = [&](float from, float fromOut, float to, float toOut,
                                     const glm::vec3& outward) {
                appendQuad(mesh, at(low, from, fromOut), at(low, to, toOut), at(high, to, toOut),
                           at(high, from, fromOut), outward);
            };
            const glm::vec3 out = at({1, 0}, 0, 0);
            addFace(-halfWidth, 0, halfWidth, 0, -out);
            addFace(-halfWidth, 0, 0, thickness, out);
            addFace(0, thickness, halfWidth, 0, out);
        }
    }
    return mesh;
}

// Makes the metal at both ends of the ribs.
Mesh makeLampCaps()
{
    return makeLathe(
        {{{0, -0.12f}, {0.04f, -0.08f}, {0.02f, -0.03f}, {0.10f, -0.01f}, {0.16f, 0.025f}},
         {{0.19f, 0.735f},
          {0.2f, 0.75f},
          {0.13f, 0.84f},
          {0.04f, 0.91f},
          {0.03f, 1.0f},
          {0, 1.02f}}},
        14);
}

Mesh makeBaluster()
{
    return makeLathe({{{0.045f, 0},
                       {0.045f, 0.08f},
                       {0.025f, 0.12f},
                       {0.055f, 0.30f},
                       {0.022f, 0.55f},
                       {0.022f, 0.70f},
                       {0.045f, 0.74f},
                       {0.045f, 0.80f}}},
                     8);
}

} // namespace

void addMeshes(Kit& kit)
{
    SceneBuilder& b = kit.builder;
    kit.mesh.box = b.addMesh(makeBevelledBox(0.02f));
    kit.mesh.tile = b.addMesh(makeTile(0.012f));
    kit.mesh.shaft = b.addMesh(makeShaft());
    kit.mesh.columnBase = b.addMesh(makeColumnBase());
    kit.mesh.capital = b.addMesh(makeCapital());
    kit.mesh.archedWall =
        b.addMesh(makeArchedWall(float(bayWidth), float(arcadeTop - springingHeight),
                                 float(arcadeDepth), float(archRadius), 24));
    kit.mesh.archRing = b.addMesh(makeArchRing(1, 1.07f, 1, pi_v<float>, 28));
    kit.mesh.vault = b.addMesh(makeVault(32));
    kit.mesh.ball = b.addMesh(makeSphere(14, 9));
    kit.mesh.fineBall = b.addMesh(makeSphere(28, 16));
    kit.mesh.ring = b.addMesh(makeTorus(1, 0.035f, 28, 5));
    kit.mesh.vase = b.addMesh(makeVase());
    kit.mesh.knot = b.addMesh(makeKnot(0.11f, 96, 10));
    kit.mesh.baluster = b.addMesh(makeBaluster());
    kit.mesh.rod = b.addMesh(makeCylinder(6));
    kit.mesh.link = b.addMesh(makeTorus(1, 0.24f, 10, 4));
    kit.mesh.disc = b.addMesh(makeCylinder(32));
    kit.mesh.ribs = b.addMesh(makeLampRibs());
    kit.mesh.caps = b.addMesh(makeLampCaps());
    kit.mesh.roseWall = b.addMesh(makeArchedWall(10, 4.5f, 0.46f, float(roseRadius), 48));
}

namespace
{

// Adds the dark frosted glass of the ribs. A lamp is so near that it lights even this glass to
// about the luminance of white marble in the hall.
void addLampGlass(Kit& kit)
{
    const auto add = [&](const std::string& name, const glm::vec3& colour) {
        const glm::vec3 albedo = 0.02f * colour / std::max({colour.r, colour.g, colour.b});
        return kit.builder.addDielectric(name, albedo, 0.9f);
    };
    kit.material.amberGlass = add("amber glass", {1, 0.6f, 0.3f});
    for (int hue = 0; hue < lanternHueCount; ++hue)
        kit.material.lantern.push_back(
            add("lantern glass " + std::to_string(hue), lanternColour(hue, 0)));
}

} // namespace

void addMaterials(Kit& kit)
{
    SceneBuilder& b = kit.builder;
    Materials& m = kit.material;
    // F0 of metals: Lagarde 2011, "Feeding a physically based shading model" (linear).
    m.gold = b.addMetal("gold", {1.0f, 0.766f, 0.336f}, 0.28f);
    m.copper = b.addMetal("copper", {0.955f, 0.637f, 0.538f}, 0.28f);
    m.iron = b.addMetal("iron", {0.56f, 0.57f, 0.58f}, 0.45f);
    m.chrome = b.addMetal("chrome", {0.549f, 0.556f, 0.554f}, 0.12f);
    m.silver = b.addMetal("silver", {0.972f, 0.960f, 0.915f}, 0.22f);
    m.bronze = b.addMetal("bronze", {0.80f, 0.58f, 0.36f}, 0.38f);
    m.marble = b.addDielectric("white marble", {0.72f, 0.69f, 0.64f}, 0.22f);
    m.darkMarble = b.addDielectric("black marble", {0.035f, 0.035f, 0.04f}, 0.10f);
    m.sandstone = b.addDielectric("sandstone", {0.55f, 0.46f, 0.35f}, 0.75f);
    m.plaster = b.addDielectric("plaster", {0.62f, 0.60f, 0.56f}, 0.85f);
    m.wood = b.addDielectric("oak", {0.24f, 0.13f, 0.07f}, 0.5f);
    m.grout = b.addDielectric("grout", {0.10f, 0.09f, 0.08f}, 0.95f);

    const struct {
        const char* name;
        glm::vec3 albedo;
        float perceptualRoughness;
    } floors[] = {{"floor: mirror black", {0.03f, 0.03f, 0.035f}, 0.05f},
                  {"floor: polished white", {0.70f, 0.67f, 0.62f}, 0.09f},
                  {"floor: polished green", {0.07f, 0.16f, 0.11f}, 0.13f},
                  {"floor: honed red", {0.34f, 0.10f, 0.07f}, 0.20f},
                  {"floor: honed cream", {0.62f, 0.54f, 0.42f}, 0.28f},
                  {"floor: worn black", {0.05f, 0.05f, 0.055f}, 0.36f},
                  {"floor: worn grey", {0.33f, 0.33f, 0.34f}, 0.50f},
                  {"floor: rough terracotta", {0.45f, 0.22f, 0.13f}, 0.70f}};
    for (const auto& floor : floors)
        m.floor.push_back(b.addDielectric(floor.name, floor.albedo, floor.perceptualRoughness));
    m.stone = {m.sandstone, b.addDielectric("pale stone", {0.60f, 0.53f, 0.43f}, 0.8f),
               b.addDielectric("brown stone", {0.45f, 0.36f, 0.27f}, 0.7f),
               b.addDielectric("smooth stone", {0.52f, 0.47f, 0.40f}, 0.45f)};
    const glm::vec3 glazes[] = {{0.60f, 0.05f, 0.04f}, {0.75f, 0.32f, 0.04f}, {0.72f, 0.62f, 0.10f},
                                {0.10f, 0.42f, 0.14f}, {0.05f, 0.38f, 0.42f}, {0.05f, 0.12f, 0.50f},
                                {0.32f, 0.08f, 0.45f}, {0.70f, 0.20f, 0.35f}, {0.80f, 0.78f, 0.74f},
                                {0.04f, 0.04f, 0.05f}};
    const float roughnesses[] = {0.06f, 0.18f, 0.35f, 0.6f};
    for (size_t i = 0; i < std::size(glazes); ++i) {
        m.glaze.push_back(b.addDielectric("glaze " + std::to_string(i), glazes[i],
                                          roughnesses[i % std::size(roughnesses)]));
    }
    addLampGlass(kit);
}

} // namespace hall

Scene generateHall(const SceneOptions& options)
{
    const uint32_t count = options.lights.value_or(defaultLightCount);
    checkLightOptions("hall", count, options);
    hall::Kit kit{};
    kit.builder.scene.name = "hall";
    hall::addMeshes(kit);
    hall::addMaterials(kit);
    Random random(options.seed);
    hall::addArchitecture(kit, random);
    hall::addFurnishings(kit, random);

    Scene scene = std::move(kit.builder.scene);
    scene.background = {0.45f, 0.75f, 1.7f}; // the evening sky in the windows, cd/m^2
    scene.interior = true;
    scene.cameras = {
        makeUprightCamera("nave", {-28.2, 2.6, 1.4}, {1, 0.035, -0.065}, glm::radians(58.0)),
        makeUprightCamera("gallery", {27.5, 9.8, -4.6}, {-1, -0.22, 0.16}, glm::radians(62.0))};
    addSphereLights(scene, hall::lightSites(count, options), options);
    return scene;
}

} // namespace candelabra::app
