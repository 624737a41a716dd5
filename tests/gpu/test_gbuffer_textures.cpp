// SPDX-License-Identifier: Apache-2.0
// Tests textures, vertex colours, normal maps and alpha masks in the G-buffer.
#include <cmath>

#include <glm/gtc/matrix_transform.hpp>

#include "gpu/gbuffer_harness.h"
#include "harness/constants.h"
#include "shared/gbuffer_data.h"

namespace candelabra::test
{
namespace
{

double linearFromSrgb(double code)
{
    const double c = std::max(code, 0.0) / 255;
    return c <= 0.04045 ? c / 12.92 : std::pow((c + 0.055) / 1.055, 2.4);
}

// Samplers decode with limited accuracy: lavapipe 22.3 is off by up to 0.3 codes (0.7% for a value
// of 0.1).
void expectDecoded(double value, uint8_t code, double factor)
{
    EXPECT_GE(value, factor * linearFromSrgb(code - 0.5));
    EXPECT_LE(value, factor * linearFromSrgb(code + 0.5));
}

// One texel of a 2x2 texture.
using Texel = std::array<uint8_t, 4>;

std::vector<uint8_t> texels(std::initializer_list<Texel> list)
{
    std::vector<uint8_t> rgba;
    for (const Texel& t : list)
        rgba.insert(rgba.end(), t.begin(), t.end());
    return rgba;
}

// Texels top left, top right, bottom left, bottom right.
constexpr Texel quadrants[4] = {
    {10, 200, 90, 255}, {250, 128, 0, 200}, {0, 60, 255, 20}, {180, 30, 130, 100}};

constexpr gbuffer::Texture nearest2x2{.width = 2,
                                      .height = 2,
                                      .wrapU = gbuffer::Wrap::Clamp,
                                      .wrapV = gbuffer::Wrap::Clamp,
                                      .nearest = true};

class GBufferTexture : public RasterTest
{
protected:
    GBufferTexture() : options(perspectiveOptions())
    {
        setOrthographic(options.camera, 2, 1, 0.5, 10);
        options.width = options.height = 64;
        material.perceptualRoughness = 1;
    }

    // Renders a quad, seen straight on, that fills the view exactly.
    RasterImage renderQuad(RasterScene::MeshData mesh = quadMesh(),
                           const glm::dmat4& shape = glm::dmat4(1))
    {
        scene.addInstance(scene.addMesh(std::move(mesh)), scene.addMaterial(material),
                          glm::translate(glm::dmat4(1), glm::dvec3(0, 0, -2)) * shape);
        const RasterImage image = render(scene, options);
        EXPECT_EQ(image.coveredCount(), image.depth.size());
        return image;
    }

    // Returns the index of the pixel in the middle of quadrant x, y.
    static size_t pixel(int x, int y) { return size_t(16 + 32 * y) * 64 + size_t(16 + 32 * x); }

    RasterScene scene;
    gbuffer::Material material;
    RasterOptions options;
};

} // namespace

TEST_F(GBufferTexture, BaseColorIsDecodedAndMultiplied)
{
    gbuffer::Texture texture = nearest2x2;
    texture.srgb = true;
    material.baseColorTexture.texture = int32_t(scene.addTexture(
        texture, texels({quadrants[0], quadrants[1], quadrants[2], quadrants[3]})));
    material.baseColor[1] = 0.5f;
    const RasterImage image = renderQuad();
    for (int q = 0; q < 4; ++q) {
        SCOPED_TRACE(q);
        const glm::dvec3 albedo = storedAlbedo(image, pixel(q % 2, q / 2));
        for (int c = 0; c < 3; ++c)
            expectDecoded(albedo[c], quadrants[q][size_t(c)], double(material.baseColor[c]));
    }
}

// A quarter turn, u' = 1 - v and v' = u; and the second uv set, whose u runs in the opposite
// direction.
TEST_F(GBufferTexture, UvTransformAndSecondSet)
{
    RasterScene::MeshData mesh = quadMesh();
    for (gbuffer::Vertex& v : mesh.vertices)
        v.uv1[0] = 1 - v.uv1[0];
    for (const bool secondSet : {false, true}) {
        SCOPED_TRACE(secondSet);
        scene = {};
        gbuffer::TextureRef& ref = material.baseColorTexture;
        ref.texture = int32_t(scene.addTexture(
            nearest2x2, texels({quadrants[0], quadrants[1], quadrants[2], quadrants[3]})));
        ref.uvSet = secondSet;
        const float u[3] = {0, -1, 1}, v[3] = {1, 0, 0};
        std::copy_n(u, 3, ref.uRow);
        std::copy_n(v, 3, ref.vRow);
        const RasterImage image = renderQuad(mesh);
        for (int y = 0; y < 2; ++y)
            for (int x = 0; x < 2; ++x) {
                const int uIn = secondSet ? 1 - x : x;
                const Texel& expected = quadrants[uIn * 2 + (1 - y)];
                const glm::dvec3 albedo = storedAlbedo(image, pixel(x, y));
                for (int c = 0; c < 3; ++c)
                    EXPECT_NEAR(albedo[c], expected[size_t(c)] / 255.0, 1e-3);
            }
    }
}

TEST_F(GBufferTexture, RoughnessMetalnessAndEmission)
{
    material.metallicRoughnessTexture.texture = int32_t(scene.addTexture(
        nearest2x2, texels({quadrants[0], quadrants[1], quadrants[2], quadrants[3]})));
    gbuffer::Texture srgb = nearest2x2;
    srgb.srgb = true;
    material.emissiveTexture.texture = int32_t(
        scene.addTexture(srgb, texels({quadrants[0], quadrants[1], quadrants[2], quadrants[3]})));
    material.metalness = 0.5f;
    material.perceptualRoughness = 0.75f;
    material.emission[0] = 1000;
    const RasterImage image = renderQuad();
    for (int q = 0; q < 4; ++q) {
        SCOPED_TRACE(q);
        const size_t i = pixel(q % 2, q / 2);
        const double metalness = 0.5 * quadrants[q][2] / 255;
        EXPECT_NEAR(storedRoughness(image, i), 0.75 * quadrants[q][1] / 255,
                    gpu::ROUGHNESS_ERROR_FULL + 1e-6);
        EXPECT_NEAR(storedAlbedo(image, i).r, 1 - metalness, 1e-5);
        EXPECT_NEAR(storedSpecular(image, i).r, 0.04 + 0.96 * metalness, 1e-5);
        expectDecoded(image.radiance[i].r, quadrants[q][0], 1000);
        EXPECT_EQ(image.radiance[i].g, 0);
    }
}

// Meshes whose material is constant, tinted by vertex colours, or read per pixel are drawn by
// different shaders. White textures, which make a mesh of the last kind, change nothing.
TEST_F(GBufferTexture, WhiteTexturesChangeNothing)
{
    material.perceptualRoughness = 0.37f;
    material.baseColor[1] = 0.4f;
    material.specularWeight = 0.9f;
    material.emission[2] = 50;
    for (const float metalness : {0.f, 0.3f})
        for (const bool colored : {false, true}) {
            SCOPED_TRACE(::testing::Message() << metalness << ' ' << colored);
            material.metalness = metalness;
            RasterScene::MeshData mesh = quadMesh();
            if (colored)
                for (gbuffer::Vertex& v : mesh.vertices)
                    v.color[0] = v.position[1] * 0.25f + 0.5f;
            scene = {};
            material.baseColorTexture.texture = material.metallicRoughnessTexture.texture =
                material.emissiveTexture.texture = -1;
            const RasterImage plain = renderQuad(mesh);
            scene = {};
            material.baseColorTexture.texture = material.metallicRoughnessTexture.texture =
                material.emissiveTexture.texture = int32_t(scene.addTexture(
                    nearest2x2, texels({Texel{255, 255, 255, 255}, Texel{255, 255, 255, 255},
                                        Texel{255, 255, 255, 255}, Texel{255, 255, 255, 255}})));
            const RasterImage textured = renderQuad(mesh);
            EXPECT_EQ(plain.radiance, textured.radiance);
            if (!colored) {
                EXPECT_EQ(plain.albedo, textured.albedo);
                EXPECT_EQ(plain.specular, textured.specular);
            }
            for (size_t i = 0; i < plain.albedo.size(); ++i)
                for (int c = 0; c < 3; ++c) {
                    const double albedo = storedAlbedo(textured, i)[c];
                    ASSERT_NEAR(storedAlbedo(plain, i)[c], albedo, 4e-6 * albedo);
                    const double f0 = storedSpecular(textured, i)[c];
                    ASSERT_NEAR(storedSpecular(plain, i)[c], f0, 1.3e-4 * f0);
                }
        }
}

TEST_F(GBufferTexture, VertexColorsAreInterpolated)
{
    RasterScene::MeshData mesh = quadMesh();
    for (gbuffer::Vertex& v : mesh.vertices) {
        v.color[0] = v.position[0] * 0.5f + 0.5f;
        v.color[1] = 0.25f;
    }
    const RasterImage image = renderQuad(mesh);
    for (const int x : {5, 31, 60}) {
        const glm::dvec3 albedo = storedAlbedo(image, size_t(40 * 64 + x));
        EXPECT_NEAR(albedo.r, (x + 0.5) / 64, 1e-3);
        EXPECT_NEAR(albedo.g, 0.25, 1e-3);
        EXPECT_NEAR(albedo.b, 1, 1e-3);
    }
}

// The texel is a direction in the frame (tangent, bitangent, normal). Tested with both
// handednesses, with and without a mirrored instance, with and without normal scale.
TEST_F(GBufferTexture, NormalMapsTurnTheNormal)
{
    constexpr Texel texel{200, 90, 220, 255};
    material.doubleSided = true; // so that no side is left out, however the quad is mirrored
    for (int variant = 0; variant < 8; ++variant) {
        SCOPED_TRACE(variant);
        scene = {};
        material.normalTexture.texture =
            int32_t(scene.addTexture(nearest2x2, texels({texel, texel, texel, texel})));
        material.normalScale = variant & 1 ? 0.5f : 1.0f;
        RasterScene::MeshData mesh = quadMesh();
        const float handedness = variant & 2 ? -1.0f : 1.0f;
        for (gbuffer::Vertex& v : mesh.vertices)
            v.tangent[3] = handedness;
        const double mirror = variant & 4 ? -1 : 1;
        const RasterImage image =
            renderQuad(mesh, glm::scale(glm::dmat4(1), glm::dvec3(mirror, 1, 1)));
        const auto coordinate = [&](size_t i) { return texel[i] / 255.0 * 2 - 1; };
        const double scale = double(material.normalScale);
        const glm::dvec3 expected =
            glm::normalize(glm::dvec3(mirror * scale * coordinate(0),
                                      double(handedness) * scale * coordinate(1), coordinate(2)));
        EXPECT_LE(angleBetween(storedNormal(image, pixel(0, 1)), expected), 2e-6);
    }
}

TEST_F(GBufferTexture, MaskShowsWhatIsBehind)
{
    material.coverage = gbuffer::Coverage::Masked;
    material.alpha = 0.9f;
    material.alphaCutoff = 0.5f;
    // The coverages are 0.9, 0.71, 0.07 and 0.35.
    material.baseColorTexture.texture = int32_t(scene.addTexture(
        nearest2x2, texels({quadrants[0], quadrants[1], quadrants[2], quadrants[3]})));
    gbuffer::Material behind;
    behind.perceptualRoughness = 0.5f;
    scene.addInstance(scene.addMesh(quadMesh()), scene.addMaterial(behind),
                      glm::translate(glm::dmat4(1), glm::dvec3(0, 0, -3)));
    const RasterImage image = renderQuad();
    for (int q = 0; q < 4; ++q) {
        SCOPED_TRACE(q);
        const size_t i = pixel(q % 2, q / 2);
        const bool kept = q < 2;
        EXPECT_NEAR(viewPosition(image, uint32_t(i % 64), uint32_t(i / 64)).z, kept ? -2 : -3,
                    1e-5);
        EXPECT_NEAR(storedRoughness(image, i), kept ? 1 : 0.5, 1e-5);
    }
}

// Counts the pixels that show the surface in z = -2, of which the quad is.
size_t nearCount(const RasterImage& image)
{
    size_t count = 0;
    for (uint32_t y = 0; y < image.height; ++y)
        for (uint32_t x = 0; x < image.width; ++x)
            count += viewPosition(image, x, y).z > -2.5;
    return count;
}

// A surface is drawn at as many pixels as its coverage says, in every frame and, of many frames, at
// every pixel.
TEST_F(GBufferTexture, CoverageIsAShareOfPixelsAndFrames)
{
    material.coverage = gbuffer::Coverage::Dithered;
    gbuffer::GBuffer pass(device(), {.framesInFlight = 1});
    for (const float alpha : {0.f, 0.1f, 0.5f, 0.9f, 1.f}) {
        SCOPED_TRACE(alpha);
        scene = {};
        const uint32_t quad = scene.addMesh(quadMesh());
        scene.addInstance(quad, scene.addMaterial(gbuffer::Material{}),
                          glm::translate(glm::dmat4(1), glm::dvec3(0, 0, -3)));
        material.alpha = alpha;
        scene.addInstance(quad, scene.addMaterial(material),
                          glm::translate(glm::dmat4(1), glm::dvec3(0, 0, -2)));
        const gbuffer::Geometry geometry = uploadGeometry(scene);
        constexpr uint32_t frames = 32;
        std::vector<uint32_t> drawn(64 * 64);
        for (options.coverageFrame = 0; options.coverageFrame < frames; ++options.coverageFrame) {
            const RasterImage image = renderWith(pass, geometry, options);
            EXPECT_NEAR(double(nearCount(image)) / (64 * 64), double(alpha), 0.005);
            for (uint32_t i = 0; i < drawn.size(); ++i)
                drawn[i] += viewPosition(image, i % 64, i / 64).z > -2.5;
        }
        for (const uint32_t count : drawn)
            ASSERT_NEAR(double(count) / frames, double(alpha), 0.1);
        options.coverageFrame = 0;
        expectSameImage(renderWith(pass, geometry, options), renderWith(pass, geometry, options));
    }
}

// Surfaces of coverage 1/2, one behind the other, leave half of the pixels free that those in front
// of them leave free. Every second one shows its back.
TEST_F(GBufferTexture, LayersCoverIndependently)
{
    material.coverage = gbuffer::Coverage::Dithered;
    material.alpha = 0.5f;
    material.doubleSided = true;
    const uint32_t dithered = scene.addMaterial(material);
    const uint32_t quad = scene.addMesh(quadMesh());
    gbuffer::GBuffer pass(device(), {.framesInFlight = 1});
    for (uint32_t layers = 1; layers <= 4; ++layers) {
        SCOPED_TRACE(layers);
        glm::dmat4 shape = glm::translate(glm::dmat4(1), glm::dvec3(0, 0, -1.0 - layers));
        if (layers % 2 == 0)
            shape = glm::rotate(shape, pi, glm::dvec3(0, 1, 0));
        scene.addInstance(quad, dithered, shape);
        const gbuffer::Geometry geometry = uploadGeometry(scene);
        double free = 0;
        for (options.coverageFrame = 0; options.coverageFrame < 8; ++options.coverageFrame)
            free += 1 - double(renderWith(pass, geometry, options).coveredCount()) / (64 * 64);
        EXPECT_NEAR(free / 8, std::pow(0.5, layers), 0.02);
    }
}

TEST_F(GBufferTexture, UnlitSurfacesEmitTextureTimesVertexColour)
{
    material.unlit = true;
    for (float& channel : material.baseColor)
        channel = 0;
    for (const auto layout : {CND_GBUFFER_FULL, CND_GBUFFER_COMPACT}) {
        options.layout = layout;
        scene = {};
        material.emission[0] = 100;
        material.emission[1] = 50;
        RasterScene::MeshData mesh = quadMesh();
        for (gbuffer::Vertex& v : mesh.vertices)
            v.color[1] = 0.5f;
        material.baseColorTexture.texture = int32_t(scene.addTexture(
            nearest2x2, texels({quadrants[0], quadrants[1], quadrants[2], quadrants[3]})));
        const RasterImage image = renderQuad(mesh);
        for (int q = 0; q < 4; ++q) {
            const size_t i = pixel(q % 2, q / 2);
            EXPECT_NEAR(image.radiance[i].r, 100.f * float(quadrants[q][0]) / 255, 1e-3);
            EXPECT_NEAR(image.radiance[i].g, 25.f * float(quadrants[q][1]) / 255, 1e-3);
            EXPECT_EQ(image.radiance[i].b, 0);
            if (layout == CND_GBUFFER_FULL) {
                EXPECT_EQ(image.albedo[i], glm::uvec2(0));
                EXPECT_EQ(image.specular[i], glm::uvec2(0));
            }
        }
        // Without textures and without light it is black, and nothing else.
        scene = {};
        material.baseColorTexture.texture = -1;
        material.emission[0] = material.emission[1] = 0;
        EXPECT_EQ(renderQuad().radiance[0], glm::vec4(0, 0, 0, 1));
    }
}

// With all 8 x 8 texels of a checkerboard in every pixel the result is the average of linear
// values, not of codes.
TEST_F(GBufferTexture, MinifiedTexturesAreAveragedInLinearSpace)
{
    std::vector<uint8_t> checker;
    for (int y = 0; y < 8; ++y)
        for (int x = 0; x < 8; ++x)
            for (int c = 0; c < 4; ++c)
                checker.push_back((x + y) % 2 || c == 3 ? 255 : 0);
    gbuffer::TextureRef& ref = material.baseColorTexture;
    ref.texture =
        int32_t(scene.addTexture({.width = 8, .height = 8, .srgb = true}, std::move(checker)));
    ref.uRow[0] = ref.vRow[1] = 64;
    const RasterImage image = renderQuad();
    for (size_t i = 0; i < image.albedo.size(); i += 37)
        EXPECT_NEAR(storedAlbedo(image, i).r, 0.5, 0.004); // tolerance: one 8-bit step near
                                                           // code 188
}

} // namespace candelabra::test
