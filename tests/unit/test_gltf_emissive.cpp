// SPDX-License-Identifier: Apache-2.0
// Tests emissive rectangles that become area lights.
#include <cmath>

#include "unit/gltf_fixture.h"

namespace candelabra::test
{

namespace
{

using namespace candelabra::app;

class GltfEmissive : public GltfTest
{
protected:
    GltfEmissive() { lit_.emissiveLights = true; }

    // A mesh with an emissive material, whose front is at +z, below a node of that scale.
    static GltfBuilder panel(const std::vector<float>& positions,
                             const std::vector<uint16_t>& indices, const Json& scale = {1, 1, 1})
    {
        GltfBuilder b = triangleScene(); // something that is not a light
        b.json["materials"] = Json::parse(R"([{"emissiveFactor": [1, 0.5, 0.25], "extensions":
            {"KHR_materials_emissive_strength": {"emissiveStrength": 400}}}])");
        b.rootNode({{"mesh", b.mesh({{"attributes", {{"POSITION", b.floats(positions, "VEC3")}}},
                                     {"indices", b.indices(indices)},
                                     {"material", 0}})},
                    {"translation", {5, 0, 0}},
                    {"scale", scale}});
        return b;
    }

    const std::vector<float> rectangle_ = {-1, -1, 0, 1, -1, 0, -1, 1, 0, 1, 1, 0};
    const std::vector<uint16_t> corners_ = {0, 1, 2, 2, 1, 3};
    SceneOptions lit_;
};

glm::vec3 axis(const float (&v)[3])
{
    return {v[0], v[1], v[2]};
}

TEST_F(GltfEmissive, RectanglesBecomeLights)
{
    const GltfBuilder b = panel(rectangle_, corners_, {1, 3, 1});
    const Scene scene = load(b, lit_);
    ASSERT_EQ(scene.lights.size(), 1u);
    EXPECT_EQ(scene.instances.size(), 1u);
    const CndLight& light = scene.lights[0];
    EXPECT_EQ(light.type, uint32_t{CND_LIGHT_RECTANGLE});
    EXPECT_EQ(glm::vec3(scene.lightOrigin) + axis(light.position), glm::vec3(5, 0, 0));
    EXPECT_EQ(axis(light.emission), glm::vec3(400, 200, 100));
    const float sides[2] = {glm::length(axis(light.axisU)), glm::length(axis(light.axisV))};
    EXPECT_NEAR(std::min(sides[0], sides[1]), 1, 1e-6);
    EXPECT_NEAR(std::max(sides[0], sides[1]), 3, 1e-6);
    EXPECT_NEAR(glm::cross(axis(light.axisU), axis(light.axisV)).z, 3, 1e-5);
    EXPECT_FALSE(light.twoSided);
    EXPECT_TRUE(scene.warnings.empty());

    const Scene asMeshes = load(b);
    EXPECT_TRUE(asMeshes.lights.empty());
    EXPECT_EQ(asMeshes.instances.size(), 2u);

    // Mirrored along z the front is at -z.
    EXPECT_NEAR(
        glm::cross(axis(load(panel(rectangle_, corners_, {1, 1, -1}), lit_).lights[0].axisU),
                   axis(load(panel(rectangle_, corners_, {1, 1, -1}), lit_).lights[0].axisV))
            .z,
        -1, 1e-5);
    GltfBuilder twoSided = b;
    twoSided.json["materials"][0]["doubleSided"] = true;
    EXPECT_TRUE(load(twoSided, lit_).lights.at(0).twoSided);
}

TEST_F(GltfEmissive, RectanglesMayConsistOfManyTriangles)
{
    std::vector<float> positions;
    std::vector<uint16_t> indices;
    for (uint16_t y = 0; y < 5; ++y)
        for (uint16_t x = 0; x < 4; ++x) {
            // A square grid, turned by 45 degrees about x, with seams between its cells.
            const auto corner = [&](int dx, int dy) {
                positions.insert(positions.end(),
                                 {static_cast<float>(x + dx), static_cast<float>(y + dy),
                                  static_cast<float>(y + dy)});
            };
            const auto first = static_cast<uint16_t>(positions.size() / 3);
            corner(0, 0);
            corner(1, 0);
            corner(0, 1);
            corner(1, 1);
            for (const uint16_t i : corners_)
                indices.push_back(static_cast<uint16_t>(first + i));
        }
    const Scene scene = load(panel(positions, indices), lit_);
    ASSERT_EQ(scene.lights.size(), 1u);
    const CndLight& light = scene.lights[0];
    const glm::vec3 normal = glm::cross(axis(light.axisU), axis(light.axisV));
    EXPECT_NEAR(glm::length(normal), 2 * 2.5 * std::sqrt(2.0), 1e-5); // a quarter of the area
    EXPECT_NEAR(normal.z, -normal.y, 1e-5);
    EXPECT_GT(normal.z, 0);
    // Without one triangle it is no rectangle any more.
    indices.resize(indices.size() - 3);
    const Scene torn = load(panel(positions, indices), lit_);
    EXPECT_TRUE(torn.lights.empty());
    EXPECT_TRUE(warns(torn, "has 1 emissive surfaces that are no flat rectangles"));
}

TEST_F(GltfEmissive, OtherShapesStayMeshes)
{
    const std::vector<float> shapes[] = {
        {-1, -1, 0, 1, -1, 0, -1, 1, 0, 1, 1, 0.1f},    // bent
        {-1, -1, 0, 1, -1, 0, -0.9f, 1, 0, 1.1f, 1, 0}, // a parallelogram
        {-1, -1, 0, 1, -1, 0, -0.5f, 1, 0, 0.5f, 1, 0}, // a trapezium
        {-1, 0, 0, 1, 0, 0, 0, 1, 0, 0.25f, 0.5f, 0},   // a triangle
        {-1, -1, 0, 1, -1, 0, -1, -1, 0, 1, -1, 0},     // a line
        {-1, -1, 0, -1, -1, 0, -1, -1, 0, -1, -1, 0}};  // a point
    for (const std::vector<float>& positions : shapes) {
        const Scene scene = load(panel(positions, corners_), lit_);
        EXPECT_TRUE(scene.lights.empty());
        EXPECT_EQ(scene.instances.size(), 2u);
        EXPECT_TRUE(warns(scene, "has 1 emissive surfaces that are no flat rectangles"));
    }
    // Both halves of this one are the same triangle.
    EXPECT_TRUE(load(panel(rectangle_, {0, 1, 2, 0, 1, 2}), lit_).lights.empty());
    // This one faces both sides at once.
    EXPECT_TRUE(load(panel(rectangle_, {0, 1, 2, 2, 3, 1}), lit_).lights.empty());
}

// An emissive octahedron of that many of its eight sides around the origin, and a point light in
// it.
GltfBuilder bulb(size_t sides, const Json& light = {0, 0.1, 0})
{
    GltfBuilder b = triangleScene();
    b.json["materials"] = Json::parse(R"([{"emissiveFactor": [1, 0.5, 0.25]}, {}])");
    std::vector<uint16_t> indices = {0, 2, 4, 2, 1, 4, 1, 3, 4, 3, 0, 4,
                                     2, 0, 5, 1, 2, 5, 3, 1, 5, 0, 3, 5};
    indices.resize(3 * sides);
    b.rootNode(
        {{"mesh",
          b.mesh({{"attributes",
                   {{"POSITION",
                     b.floats({1, 0, 0, -1, 0, 0, 0, 1, 0, 0, -1, 0, 0, 0, 1, 0, 0, -1}, "VEC3")}}},
                  {"indices", b.indices(indices)},
                  {"material", 0}})}});
    b.json["extensionsUsed"] = {"KHR_lights_punctual"};
    b.json["extensions"]["KHR_lights_punctual"]["lights"] = {{{"type", "point"}}};
    b.rootNode({{"translation", light}, {"extensions", {{"KHR_lights_punctual", {{"light", 0}}}}}});
    return b;
}

TEST_F(GltfEmissive, LampsDoNotShadowTheirLights)
{
    const auto layers = [this](const GltfBuilder& b) {
        const Scene scene = load(b);
        EXPECT_EQ(scene.lights.size(), 1u);
        EXPECT_EQ(scene.instances[0].occluderLayer, 0u); // the triangle
        return std::pair(scene.instances.at(1).occluderLayer, scene.lights.at(0).unshadowedBy);
    };
    const std::pair<uint32_t, uint32_t> isBody(1, 2), isNone(0, 0);
    EXPECT_EQ(layers(bulb(8)), isBody);
    EXPECT_EQ(layers(bulb(7)), isBody);              // without its base
    EXPECT_EQ(layers(bulb(3)), isNone);              // a reflector
    EXPECT_EQ(layers(bulb(8, {0, 1.1, 0})), isNone); // beside it
    EXPECT_EQ(layers(bulb(8, {0.6, 0.6, 0.6})), isNone);
    GltfBuilder dark = bulb(8);
    dark.json["meshes"][1]["primitives"][0]["material"] = 1;
    EXPECT_EQ(layers(dark), isNone);
}

} // namespace

} // namespace candelabra::test
