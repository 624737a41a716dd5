// SPDX-License-Identifier: Apache-2.0
// Tests which surfaces cast shadows, and that the truth takes the same ones.
#include <gtest/gtest.h>

#include "generate/generators.h"
#include "scene/shadow_casters.h"
#include "truth/reference_scene.h"

namespace candelabra::test
{

namespace
{

using namespace candelabra::app;

// A square of two triangles with a material of that mode, whose texture is there from `first` on
// along u.
Scene squareScene(AlphaMode mode, uint32_t first)
{
    constexpr uint32_t width = 16;
    Scene out;
    Texture& texture = out.textures.emplace_back();
    texture.width = width;
    texture.height = 1;
    for (uint32_t x = 0; x < width; ++x)
        texture.rgba.insert(texture.rgba.end(), {0, 0, 0, uint8_t(x < first ? 100 : 160)});
    Mesh& mesh = out.meshes.emplace_back();
    for (const glm::vec2 at : {glm::vec2(0, 0), glm::vec2(1, 0), glm::vec2(1, 1), glm::vec2(0, 1)})
        mesh.vertices.push_back({.position = glm::vec3(at, 0), .uv = {at}});
    mesh.indices = {0, 1, 2, 0, 2, 3};
    out.materials.push_back({.alphaMode = mode, .baseColorTexture = {.texture = 0}});
    out.instances.push_back({});
    out.cameras.push_back({.position = {0, 0, 2}});
    return out;
}

// Whether each of the two triangles casts a shadow.
std::vector<bool> casters(const Scene& scene)
{
    std::vector<bool> out;
    for (size_t i = 0; i < 2; ++i)
        out.push_back(castsShadow(scene, scene.materials[0], scene.meshes[0], i));
    const reference::Scene truth = toReference(scene, scene.cameras[0], 1, false);
    for (size_t i = 0; i < truth.triangles.size(); ++i)
        EXPECT_EQ(truth.triangles[i].blocks, out[i]) << i;
    return out;
}

} // namespace

TEST(ShadowCasters, MaskedTrianglesCastWholeShadowsOrNone)
{
    using Both = std::vector<bool>;
    EXPECT_EQ(casters(squareScene(AlphaMode::Mask, 0)), Both({true, true}));
    EXPECT_EQ(casters(squareScene(AlphaMode::Mask, 16)), Both({false, false}));
    // The first triangle has most of its area at large u.
    EXPECT_EQ(casters(squareScene(AlphaMode::Mask, 8)), Both({true, false}));
    EXPECT_EQ(casters(squareScene(AlphaMode::Opaque, 16)), Both({true, true}));
    EXPECT_EQ(casters(squareScene(AlphaMode::Blend, 0)), Both({false, false}));
}

TEST(ShadowCasters, TexturesRepeatAndMirror)
{
    Scene scene = squareScene(AlphaMode::Mask, 8);
    TextureRef& ref = scene.materials[0].baseColorTexture;
    ref.uRow.z = 1; // repeats: as before
    EXPECT_EQ(casters(scene), std::vector<bool>({true, false}));
    scene.textures[0].mirrorU = true;
    EXPECT_EQ(casters(scene), std::vector<bool>({false, true}));
    ref.uRow.z = -2;
    EXPECT_EQ(casters(scene), std::vector<bool>({true, false}));
    scene.textures[0].repeatU = scene.textures[0].mirrorU = false;
    EXPECT_EQ(casters(scene), std::vector<bool>({false, false}));
}

TEST(ShadowCasters, WhatIsInexactIsCounted)
{
    EXPECT_TRUE(inexactShadows(generateScene("rooms", {.lights = 0})).empty());
    Scene scene = squareScene(AlphaMode::Mask, 0);
    scene.materials.push_back({.alphaMode = AlphaMode::Blend});
    scene.instances.push_back({.material = 1});
    scene.instances.push_back({.material = 1});
    const std::vector<std::string> sentences = inexactShadows(scene);
    ASSERT_EQ(sentences.size(), 2u);
    EXPECT_NE(sentences[0].find("2 of 3 objects are blended"), std::string::npos);
    EXPECT_NE(sentences[1].find("1 of 3 objects are masked"), std::string::npos);
}

TEST(ShadowCasters, TheTruthHasTheLayersOfOccluders)
{
    Scene scene = squareScene(AlphaMode::Opaque, 0);
    scene.instances[0].occluderLayer = 3;
    scene.analyticObjects.push_back({.occluderLayer = 2});
    scene.lights.resize(3);
    scene.lights[0].unshadowed = VK_TRUE;
    scene.lights[1].unshadowedBy = 0b1000;
    const reference::Scene truth = toReference(scene, scene.cameras[0], 1, false);
    EXPECT_EQ(truth.triangles[0].occluderLayer, 3u);
    EXPECT_EQ(truth.objects[0].occluderLayer, 2u);
    EXPECT_EQ(truth.ignoredLayers, std::vector<uint32_t>({~0u, 0b1000, 0}));
}

} // namespace candelabra::test
