// SPDX-License-Identifier: Apache-2.0
// Tests glTF materials, textures, texture transforms, and the tangents that normal maps need.
#include <algorithm>
#include <cmath>
#include <memory>

#include <sys/inotify.h>
#include <unistd.h>

#include "io/image.h"
#include "load/load.h"
#include "unit/gltf_compressed.h"
#include "unit/gltf_fixture.h"

namespace candelabra::test
{

namespace
{

using namespace candelabra::app;

class GltfMaterials : public GltfTest
{
protected:
    // Returns an image of 2 x 1 pixels: (10, 20, 30), then white.
    Bytes png()
    {
        const uint8_t rgb[] = {10, 20, 30, 255, 255, 255};
        savePng(folder_.path("pixels.png"), 2, 1, rgb);
        return readBytes(folder_.path("pixels.png"));
    }

    // Returns the triangle scene with a material and `textures` textures, all of that image.
    GltfBuilder withMaterial(const char* material, size_t textures = 0)
    {
        GltfBuilder b = triangleScene();
        b.json["meshes"][0]["primitives"][0]["material"] = 0;
        b.json["materials"] = Json::array({Json::parse(material)});
        for (size_t i = 0; i < textures; ++i)
            b.json["textures"].push_back({{"source", 0}});
        if (textures)
            b.json["images"] = {{{"uri", "data:image/png;base64," + encodeBase64(png())}}};
        return b;
    }
};

TEST_F(GltfMaterials, Factors)
{
    const Scene scene = load(withMaterial(R"({
        "name": "paint", "doubleSided": true, "alphaMode": "MASK", "alphaCutoff": 0.25,
        "emissiveFactor": [1, 0.5, 0],
        "pbrMetallicRoughness": {"baseColorFactor": [0.1, 0.2, 0.3, 0.4],
                                 "metallicFactor": 0.5, "roughnessFactor": 0.75},
        "extensions": {"KHR_materials_emissive_strength": {"emissiveStrength": 5000000000}}})"));
    ASSERT_EQ(scene.materials.size(), 1u);
    const Material& m = scene.materials[0];
    EXPECT_EQ(m.name, "paint");
    EXPECT_TRUE(m.doubleSided);
    EXPECT_EQ(m.alphaMode, AlphaMode::Mask);
    EXPECT_EQ(m.alphaCutoff, 0.25f);
    EXPECT_EQ(m.baseColor, glm::vec3(0.1f, 0.2f, 0.3f));
    EXPECT_EQ(m.alpha, 0.4f);
    EXPECT_EQ(m.metalness, 0.5f);
    EXPECT_EQ(m.perceptualRoughness, 0.75f);
    EXPECT_EQ(m.emission, glm::vec3(5e9f, 2.5e9f, 0)); // cd/m^2; the integer exceeds 32 bits
    EXPECT_EQ(m.dielectricF0, glm::vec3(0.04f));
    EXPECT_EQ(m.specularWeight, 1);
    EXPECT_TRUE(scene.textures.empty());
}

TEST_F(GltfMaterials, TransmissionLeavesAVeil)
{
    const auto read = [&](const char* more, const char* transmission, const char* metal = "0") {
        return load(withMaterial((std::string("{") + more + R"("pbrMetallicRoughness": {)" +
                                  R"("baseColorFactor": [1, 1, 1, 0.5], "metallicFactor": )" +
                                  metal + R"(}, "extensions": {"KHR_materials_transmission": )" +
                                  transmission + "}}")
                                     .c_str(),
                                 1));
    };
    const Material clear =
        read("", R"({"transmissionFactor": 1})").materials.at(0); // the alpha of opaque ones is 1
    EXPECT_EQ(clear.alphaMode, AlphaMode::Blend);
    EXPECT_FLOAT_EQ(clear.alpha, 0.25f);
    const Material both =
        read(R"("alphaMode": "BLEND", )", R"({"transmissionFactor": 0.8})").materials.at(0);
    EXPECT_FLOAT_EQ(both.alpha, 0.5f * 0.4f);
    const char* body =
        R"({"transmissionFactor": 1}, "KHR_materials_volume": {"thicknessFactor": 0.1})";
    for (const Material& opaque : {read("", "{}").materials.at(0), read("", body).materials.at(0),
                                   read("", R"({"transmissionFactor": 1})", "1").materials.at(0)})
        EXPECT_EQ(opaque.alphaMode, AlphaMode::Opaque);
    const Scene masked = read(R"("alphaMode": "MASK", )", R"({"transmissionFactor": 1})");
    EXPECT_EQ(masked.materials.at(0).alphaMode, AlphaMode::Mask);
    EXPECT_TRUE(warns(masked, "materials[0]: has alphaMode MASK, so its transmission is left out"));
    EXPECT_FALSE(warns(read(R"("alphaMode": "MASK", )", "{}"), "transmission"));
    const Scene textured =
        read("", R"({"transmissionFactor": 1, "transmissionTexture": {"index": 0}})");
    EXPECT_EQ(textured.materials.at(0).alphaMode, AlphaMode::Opaque);
    EXPECT_TRUE(warns(textured, "materials[0]: has a texture of its transmission"));
    // Metal lets no light through, so nothing of it is left out.
    EXPECT_FALSE(warns(read(R"("alphaMode": "MASK", )", R"({"transmissionFactor": 1})", "1"),
                       "transmission"));
    EXPECT_FALSE(
        warns(read("", R"({"transmissionFactor": 1, "transmissionTexture": {"index": 0}})", "1"),
              "transmission"));
}

// The alpha of an opaque material has no meaning, nor has that of its texture. A texture of the
// metalness says what is metal, and its factor, 1 by default, does not.
TEST_F(GltfMaterials, TexturesOfGlassDoNotHideIt)
{
    GltfBuilder b = withMaterial(R"({"pbrMetallicRoughness": {
        "baseColorTexture": {"index": 0}, "metallicRoughnessTexture": {"index": 1}},
        "extensions": {"KHR_materials_transmission": {"transmissionFactor": 1}}})",
                                 2);
    b.json["images"][0] = {{"bufferView", b.view(smallWebP())}, {"mimeType", "image/webp"}};
    const Scene scene = load(b);
    const Material& glass = scene.materials.at(0);
    EXPECT_EQ(glass.alphaMode, AlphaMode::Blend);
    EXPECT_FLOAT_EQ(glass.alpha, 0.25f);
    const auto alphaIsOne = [&](int32_t texture) {
        const std::vector<uint8_t>& rgba = scene.textures.at(size_t(texture)).rgba;
        for (size_t i = 3; i < rgba.size(); i += 4)
            if (rgba[i] != 255)
                return false;
        return true;
    };
    EXPECT_TRUE(alphaIsOne(glass.baseColorTexture.texture));
    EXPECT_FALSE(alphaIsOne(0)); // the image itself has another alpha
}

// The alpha of vertex colours counts where that of the material does.
TEST_F(GltfMaterials, VertexColoursDoNotHideGlass)
{
    GltfBuilder b = withMaterial(
        R"({"extensions": {"KHR_materials_transmission": {"transmissionFactor": 1}},
            "pbrMetallicRoughness": {"metallicFactor": 0}})");
    Json& primitive = b.json["meshes"][0]["primitives"][0];
    primitive["attributes"]["COLOR_0"] = b.floats({1, 0, 0, 0, 1, 0, 0, 0, 1, 0, 0, 0}, "VEC4");
    primitive["targets"] = {
        {{"COLOR_0", b.floats({0, 1, 0, -1, 0, 1, 0, -1, 0, 1, 0, -1}, "VEC4")}}};
    b.json["meshes"][0]["weights"] = {1};
    const Scene glass = load(b);
    EXPECT_EQ(glass.materials.at(0).alphaMode, AlphaMode::Blend);
    for (const Vertex& v : glass.meshes.at(0).vertices)
        EXPECT_EQ(v.color, glm::vec4(1, 1, 0, 1));
    b.json["materials"][0]["alphaMode"] = "BLEND";
    const Scene blended = load(b);
    for (const Vertex& v : blended.meshes.at(0).vertices)
        EXPECT_EQ(v.color, glm::vec4(1, 1, 0, 0));
    primitive.erase("material"); // the default material is opaque
    const Scene plain = load(b);
    for (const Vertex& v : plain.meshes.at(0).vertices)
        EXPECT_EQ(v.color, glm::vec4(1, 1, 0, 1));
}

TEST_F(GltfMaterials, WithoutItsTextureASurfaceIsNoMetalAndNoMirror)
{
    GltfBuilder b =
        withMaterial(R"({"pbrMetallicRoughness": {"metallicRoughnessTexture": {"index": 0}}})", 1);
    EXPECT_EQ(load(b).materials.at(0).metalness, 1);
    b.json["images"][0]["uri"] = "missing.png";
    EXPECT_EQ(load(b).materials.at(0).metalness, 0);
    b = withMaterial(R"({"extensions": {"KHR_materials_pbrSpecularGlossiness": {
        "specularGlossinessTexture": {"index": 0}}}})",
                     1);
    b.json["images"][0]["uri"] = "missing.png";
    const Material plaster = load(b).materials.at(0);
    EXPECT_EQ(plaster.dielectricF0, glm::vec3(0.04f));
    EXPECT_EQ(plaster.perceptualRoughness, 1);
}

TEST_F(GltfMaterials, IorAndSpecularSetTheDielectric)
{
    const Material glass = load(withMaterial(R"({"pbrMetallicRoughness": {"metallicFactor": 0},
                              "extensions": {"KHR_materials_ior": {"ior": 2}}})"))
                               .materials.at(0);
    EXPECT_FLOAT_EQ(glass.dielectricF0.x, 1 / 9.0f);
    const Material dull =
        load(withMaterial(R"({"pbrMetallicRoughness": {"metallicFactor": 0}, "extensions": {
            "KHR_materials_ior": {"ior": 3},
            "KHR_materials_specular": {"specularFactor": 0.5,
                                       "specularColorFactor": [1, 0.5, 8]}}})"))
            .materials.at(0);
    // F0 = min(0.25 colour, 1) * 0.5
    EXPECT_EQ(dull.dielectricF0, glm::vec3(0.125f, 0.0625f, 0.5f));
    EXPECT_EQ(dull.specularWeight, 0.5f);
    EXPECT_EQ(load(withMaterial(R"({"extensions": {"KHR_materials_ior": {"ior": 0}}})"))
                  .materials.at(0)
                  .dielectricF0,
              glm::vec3(1));
}

TEST_F(GltfMaterials, TexturesKnowTheirColourSpaceAndSampler)
{
    GltfBuilder b = withMaterial(R"({
        "pbrMetallicRoughness": {"baseColorTexture": {"index": 0},
                                 "metallicRoughnessTexture": {"index": 1, "texCoord": 1}},
        "normalTexture": {"index": 2, "scale": -0.5}, "emissiveTexture": {"index": 0},
        "occlusionTexture": {"index": 0}})",
                                 3);
    b.json["samplers"] = Json::parse(R"([{"wrapS": 33071, "wrapT": 33648, "magFilter": 9728}])");
    b.json["textures"][2]["sampler"] = 0;
    const Scene scene = load(b);
    const Material& m = scene.materials.at(0);
    EXPECT_EQ(scene.textures.size(), 3u); // base colour and emission share a texture
    EXPECT_EQ(m.baseColorTexture.texture, m.emissiveTexture.texture);
    const Texture& base = scene.textures.at(static_cast<size_t>(m.baseColorTexture.texture));
    EXPECT_TRUE(base.srgb && base.repeatU && base.repeatV && !base.mirrorU && !base.nearest);
    ASSERT_EQ(base.width, 2u);
    EXPECT_EQ(base.rgba, (std::vector<uint8_t>{10, 20, 30, 255, 255, 255, 255, 255}));
    EXPECT_EQ(m.metallicRoughnessTexture.uvSet, 1u);
    const Texture& rough =
        scene.textures.at(static_cast<size_t>(m.metallicRoughnessTexture.texture));
    EXPECT_FALSE(rough.srgb);
    const Texture& normal = scene.textures.at(static_cast<size_t>(m.normalTexture.texture));
    EXPECT_TRUE(!normal.srgb && !normal.repeatU && normal.repeatV && normal.mirrorV);
    EXPECT_TRUE(normal.nearest && !normal.mirrorU);
    EXPECT_EQ(m.normalScale, -0.5f);
}

TEST_F(GltfMaterials, ImagesComeFromUrisFilesAndBufferViews)
{
    const char* material = R"({"pbrMetallicRoughness": {"baseColorTexture": {"index": 0}}})";
    GltfBuilder fromFile = withMaterial(material, 1);
    folder_.write("textures/a b.png", png());
    fromFile.json["images"] = {{{"uri", "textures/a%20b.png"}}};
    GltfBuilder fromView = withMaterial(material, 1);
    fromView.json["images"] = {{{"bufferView", fromView.view(png())}, {"mimeType", "image/png"}}};
    for (const GltfBuilder& b : {withMaterial(material, 1), fromFile, fromView})
        EXPECT_EQ(load(b).textures.at(0).rgba[2], 30);
    const Scene binary = loadScene(folder_.write("scene.glb", fromView.glb()), {});
    EXPECT_EQ(binary.textures.at(0).rgba[2], 30);
}

TEST_F(GltfMaterials, TextureTransform)
{
    const Scene scene = load(withMaterial(R"({"pbrMetallicRoughness": {"baseColorTexture": {
        "index": 0, "texCoord": 0, "extensions": {"KHR_texture_transform": {
            "offset": [0.5, 0.25], "rotation": 1.5707963267948966, "scale": [2, 3],
            "texCoord": 1}}}}})",
                                          1));
    const TextureRef& ref = scene.materials.at(0).baseColorTexture;
    EXPECT_EQ(ref.uvSet, 1u);
    // Scaling turns (1, 0) into (2, 0); a quarter turn counter-clockwise, with v pointing down,
    // turns that upwards in the image to (0, -2). Likewise (0, 1) -> (0, 3) -> (3, 0).
    const glm::vec3 u(1, 0, 1), v(0, 1, 1);
    EXPECT_NEAR(glm::dot(ref.uRow, u), 0.5, 1e-6);
    EXPECT_NEAR(glm::dot(ref.vRow, u), 0.25 - 2, 1e-6);
    EXPECT_NEAR(glm::dot(ref.uRow, v), 0.5 + 3, 1e-6);
    EXPECT_NEAR(glm::dot(ref.vRow, v), 0.25, 1e-6);
}

TEST_F(GltfMaterials, WhatIsLeftOutIsReported)
{
    const Scene scene = load(withMaterial(R"({
        "pbrMetallicRoughness": {"baseColorTexture": {"index": 0, "texCoord": 2}}})",
                                          1));
    EXPECT_EQ(scene.materials.at(0).baseColorTexture.texture, -1);
    EXPECT_TRUE(warns(scene, "TEXCOORD_2"));
}

TEST_F(GltfMaterials, EmissiveFactorsAboveOneAreUsed)
{
    const Scene scene = load(withMaterial(R"({"emissiveFactor": [3, 0, 0.5]})"));
    EXPECT_EQ(scene.materials.at(0).emission, glm::vec3(3, 0, 0.5f));
    EXPECT_TRUE(warns(scene, "materials[0]: has an emissiveFactor above 1"));
}

TEST_F(GltfMaterials, UnlitMaterialsEmitTheirColour)
{
    const Scene scene = load(withMaterial(R"({
        "alphaMode": "BLEND", "emissiveFactor": [1, 1, 1], "normalTexture": {"index": 0},
        "pbrMetallicRoughness": {"baseColorFactor": [1, 0.5, 0, 0.25],
                                 "baseColorTexture": {"index": 0}},
        "extensions": {"KHR_materials_unlit": {}}})",
                                          1));
    const Material& m = scene.materials.at(0);
    EXPECT_TRUE(m.unlit);
    EXPECT_EQ(m.emission, glm::vec3(100, 50, 0)); // cd/m^2
    EXPECT_EQ(m.baseColor, glm::vec3(0));
    EXPECT_EQ(m.dielectricF0, glm::vec3(0));
    EXPECT_EQ(m.metalness, 0);
    EXPECT_GE(m.baseColorTexture.texture, 0);
    EXPECT_EQ(m.emissiveTexture.texture, -1);
    EXPECT_EQ(m.normalTexture.texture, -1);
    EXPECT_EQ(m.alphaMode, AlphaMode::Blend);
    EXPECT_EQ(m.alpha, 0.25f);
    EXPECT_EQ(scene.warnings.size(), 1u); // it has no lights
}

TEST_F(GltfMaterials, SpecularGlossiness)
{
    const char* material = R"({"extensions": {"KHR_materials_pbrSpecularGlossiness": {
        "diffuseFactor": [0.5, 0.25, 0.125, 0.75], "specularFactor": [0.5, 0.25, 0.5],
        "glossinessFactor": 0.75, "specularGlossinessTexture": {"index": 0}}}})";
    GltfBuilder b = withMaterial(material, 1);
    const Json extension = b.json["materials"][0]["extensions"];
    b.json["materials"][0]["extensions"]["KHR_materials_pbrSpecularGlossiness"].erase(
        "specularGlossinessTexture");
    const Material plain = load(b).materials.at(0);
    EXPECT_EQ(plain.baseColor, glm::vec3(0.5f, 0.25f, 0.125f));
    EXPECT_EQ(plain.alpha, 0.75f);
    EXPECT_EQ(plain.metalness, 0);
    EXPECT_EQ(plain.perceptualRoughness, 0.25f);
    EXPECT_EQ(plain.dielectricF0, glm::vec3(0.5f, 0.25f, 0.5f));
    EXPECT_EQ(plain.diffuseWeight, 0.5f);
    // The texture is (10, 20, 30) with a glossiness of 1, and white.
    b.json["materials"][0]["extensions"] = extension;
    const Scene textured = load(b);
    const Material& m = textured.materials.at(0);
    const auto linear = [](double code) { return std::pow((code / 255 + 0.055) / 1.055, 2.4); };
    EXPECT_NEAR(m.dielectricF0.y, 0.25 * (linear(20) + 1) / 2, 1e-6);
    EXPECT_EQ(m.perceptualRoughness, 1);
    const Texture& roughness =
        textured.textures.at(static_cast<size_t>(m.metallicRoughnessTexture.texture));
    EXPECT_EQ(roughness.rgba[1], 64); // 255 (1 - 0.75)
    EXPECT_TRUE(warns(textured, "materials[0]: has a specular texture"));
}

TEST_F(GltfMaterials, WebPImages)
{
    GltfBuilder b =
        withMaterial(R"({"pbrMetallicRoughness": {"baseColorTexture": {"index": 0}}})", 1);
    b.json["images"].push_back({{"bufferView", b.view(smallWebP())}, {"mimeType", "image/webp"}});
    // The PNG is for programs that do not know the extension.
    b.json["textures"][0]["extensions"]["EXT_texture_webp"]["source"] = 1;
    const Scene scene = load(b);
    ASSERT_EQ(scene.textures.size(), 1u);
    EXPECT_EQ(scene.textures[0].rgba, (std::vector<uint8_t>{10, 20, 30, 128, 255, 255, 255, 255}));
    EXPECT_EQ(scene.textures[0].width, 2u);
    const size_t at = b.json["bufferViews"].back()["byteOffset"];
    for (const size_t byte : {at, at + 12, at + 20}) {
        GltfBuilder broken = b;
        broken.binary[byte] ^= 0xff;
        const Scene without = load(broken);
        EXPECT_TRUE(warns(without, "images[1]: ")) << byte;
        EXPECT_TRUE(without.textures.empty());
        EXPECT_EQ(without.materials.at(0).baseColorTexture.texture, -1);
    }
}

TEST_F(GltfMaterials, WithoutItsTextureASurfaceDoesNotGlow)
{
    GltfBuilder b =
        withMaterial(R"({"emissiveFactor": [1, 1, 1], "emissiveTexture": {"index": 0}})", 1);
    EXPECT_EQ(load(b).materials.at(0).emission, glm::vec3(1));
    b.json["images"][0]["uri"] = "missing.png";
    const Scene scene = load(b);
    EXPECT_EQ(scene.materials.at(0).emission, glm::vec3(0));
    EXPECT_TRUE(warns(scene, "images[0].uri: \"missing.png\": cannot be opened: No such file or "
                             "directory; the texture is left out"));
}

TEST_F(GltfMaterials, ImagesThatCannotBeReadAreOneWarning)
{
    GltfBuilder b = withMaterial(R"({"pbrMetallicRoughness": {
        "baseColorTexture": {"index": 0}, "metallicRoughnessTexture": {"index": 1}},
        "normalTexture": {"index": 2}, "emissiveTexture": {"index": 3}})",
                                 4);
    // Texture 1 has the image of texture 0, in another colour space.
    for (const int image : {1, 2})
        b.json["textures"][static_cast<size_t>(image + 1)]["source"] = image;
    b.json["images"][0]["uri"] = "stone.png";
    b.json["images"].push_back({{"uri", "wood.png"}});
    b.json["images"].push_back({{"uri", "lamp.png"}});
    const Scene scene = load(b);
    EXPECT_EQ(scene.warnings.size(), 2u); // and it has no lights
    EXPECT_TRUE(warns(scene, "scene.gltf: images[0].uri: \"stone.png\": cannot be opened: No such "
                             "file or directory; the texture is left out, and so are those of 2 "
                             "other images that cannot be read"));
}

// A texture is made for each sampler and colour space of an image. A broken image has none, and is
// opened for the first of them only.
TEST_F(GltfMaterials, ABrokenImageIsReadOnce)
{
    GltfBuilder b = withMaterial(R"({"pbrMetallicRoughness": {
        "baseColorTexture": {"index": 0}, "metallicRoughnessTexture": {"index": 1}},
        "emissiveTexture": {"index": 2}})",
                                 3);
    b.json["samplers"] = Json::parse(R"([{}, {"magFilter": 9728}])");
    for (const size_t texture : {size_t{0}, size_t{1}})
        b.json["textures"][texture + 1]["sampler"] = texture;
    b.json["images"][0] = {{"uri", "broken.png"}};
    const std::string image = folder_.write("broken.png", std::string("no image"));
    const int watch = inotify_init1(IN_NONBLOCK);
    if (watch < 0)
        GTEST_SKIP() << "this system has no more watches of files";
    const std::unique_ptr<const int, void (*)(const int*)> closed(&watch,
                                                                  [](const int* w) { close(*w); });
    // Equal events that follow each other would be one, so it watches for those between them too.
    ASSERT_GE(inotify_add_watch(watch, image.c_str(), IN_OPEN | IN_CLOSE), 0);
    const auto timesOpened = [&] {
        inotify_event events[16]; // no name follows the events of a file that is watched itself
        const ssize_t bytes = read(watch, events, sizeof(events));
        const auto count = bytes < 0 ? 0 : bytes / ssize_t{sizeof(inotify_event)};
        return std::count_if(events, events + count,
                             [](const inotify_event& event) { return event.mask & IN_OPEN; });
    };
    const Scene scene = load(b);
    EXPECT_EQ(timesOpened(), 1);
    EXPECT_EQ(scene.warnings.size(), 2u); // and it has no lights
    EXPECT_TRUE(warns(scene, "scene.gltf: images[0] (broken.png): is neither a PNG, a JPEG nor a "
                             "WebP image; the texture is left out"));
    folder_.write("broken.png", png()); // an image that is not broken is opened for all three
    timesOpened();
    EXPECT_EQ(load(b).textures.size(), 3u);
    EXPECT_EQ(timesOpened(), 3);
}

// Two triangles form a square in z = 0 with the image upright (v down), two more form a square
// beside it with the image mirrored; both share the middle corners.
TEST_F(GltfMaterials, TangentsFollowTheNormalMap)
{
    GltfBuilder b = withMaterial(R"({"normalTexture": {"index": 0}})", 1);
    const int positions = b.floats({0, 0, 0, 1, 0, 0, 1, 1, 0, 0, 1, 0, 2, 0, 0, 2, 1, 0}, "VEC3");
    const int uvs = b.floats({0, 1, 1, 1, 1, 0, 0, 0, 0, 1, 0, 0}, "VEC2");
    const int normals = b.floats({0, 0, 1, 0, 0, 1, 0, 0, 1, 0, 0, 1, 0, 0, 1, 0, 0, 1}, "VEC3");
    Json& primitive = b.json["meshes"][0]["primitives"][0];
    primitive["attributes"] = {{"POSITION", positions}, {"TEXCOORD_0", uvs}, {"NORMAL", normals}};
    primitive["indices"] = b.indices({0, 1, 2, 0, 2, 3, 1, 4, 5, 1, 5, 2});
    const Mesh mesh = load(b).meshes.at(0);
    ASSERT_EQ(mesh.vertices.size(), 8u); // corners 1 and 2 are split
    for (size_t corner = 0; corner < 12; ++corner) {
        const Vertex& v = mesh.vertices[mesh.indices[corner]];
        const bool upright = corner < 6;
        EXPECT_EQ(v.tangent, glm::vec4(upright ? 1 : -1, 0, 0, upright ? 1 : -1)) << corner;
        // The green channel of a normal map points up the image, which is +y everywhere here.
        EXPECT_EQ(glm::cross(v.normal, glm::vec3(v.tangent)) * v.tangent.w, glm::vec3(0, 1, 0));
    }
}

TEST_F(GltfMaterials, TangentsFollowTheTextureTransform)
{
    GltfBuilder b = withMaterial(R"({"normalTexture": {"index": 0, "extensions": {
        "KHR_texture_transform": {"rotation": 1.5707963267948966}}}})",
                                 1);
    b.json["meshes"][0]["primitives"][0]["attributes"]["TEXCOORD_0"] =
        b.floats({0, 1, 1, 1, 0, 0}, "VEC2");
    const Scene scene = load(b);
    for (const Vertex& v : scene.meshes.at(0).vertices) {
        // u' = v, which grows downwards; v' = -u
        EXPECT_NEAR(glm::distance(glm::vec3(v.tangent), glm::vec3(0, -1, 0)), 0, 1e-6f);
        EXPECT_EQ(v.tangent.w, 1);
    }
}

TEST_F(GltfMaterials, UvsWithoutDirectionStillGiveAFrame)
{
    GltfBuilder b = withMaterial(R"({"normalTexture": {"index": 0}})", 1);
    b.json["meshes"][0]["primitives"][0]["attributes"]["TEXCOORD_0"] =
        b.floats({0.5f, 0.5f, 0.5f, 0.5f, 0.5f, 0.5f}, "VEC2");
    const Scene scene = load(b); // the invariants require unit tangents perpendicular to normals
    EXPECT_EQ(scene.meshes.at(0).vertices.size(), 3u);
}

} // namespace

} // namespace candelabra::test
