// SPDX-License-Identifier: Apache-2.0
// Tests G-buffers of hosts: five layouts, which together use every encoding of normals and of
// roughness, are lit like the FULL layout of the same surfaces. Because layouts round differently,
// both get the surfaces as they are after the host's rounding; what that rounding costs is printed.
#include "gpu/host_gbuffer_harness.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <functional>
#include <iostream>
#include <random>

#include <glm/gtc/matrix_transform.hpp>

#include "candelabra/candelabra.hpp"

namespace candelabra::test
{
namespace
{

constexpr uint32_t imageWidth = 72, imageHeight = 48;
// Metres. With a nearer plane, depth that is not reversed would show how a device rounds 24 bits to
// a float: at 0.1 m the last bit is 0.5 mm of the farthest wall.
constexpr double nearPlane = 0.5;

struct Layout {
    const char* name;
    CndGBufferDesc desc;
    bool reversed; // depth is reversed, and then the far plane is infinite
    double tolerance = 1e-3;
    CndSpecularMethod method = CND_SPECULAR_KARIS;
    bool orthographic = false;
};

const Layout layouts[] = {
    // The layouts that the module must support at least.
    {"WorldRgb10",
     {.normalEncoding = CND_NORMAL_UNORM,
      .normalSpace = CND_NORMALS_WORLD,
      .roughness = CND_CHANNEL_SPECULAR_R,
      .metalness = CND_CHANNEL_SPECULAR_G,
      .normalRoughnessFormat = VK_FORMAT_A2B10G10R10_UNORM_PACK32,
      .albedoFormat = VK_FORMAT_R8G8B8A8_UNORM,
      .specularFormat = VK_FORMAT_R8G8_UNORM,
      .depthFormat = VK_FORMAT_D32_SFLOAT},
     false,
     1e-3,
     CND_SPECULAR_CONIC},
    {"OctahedralSpecularColour",
     {.normalEncoding = CND_NORMAL_OCTAHEDRAL_UNORM,
      .normalSpace = CND_NORMALS_VIEW,
      .roughness = CND_CHANNEL_ALBEDO_A,
      .roughnessKind = CND_ROUGHNESS_SMOOTHNESS,
      .reflectance = CND_REFLECTANCE_SPECULAR,
      .normalRoughnessFormat = VK_FORMAT_R16G16_UNORM,
      .albedoFormat = VK_FORMAT_R8G8B8A8_UNORM,
      .specularFormat = VK_FORMAT_R8G8B8A8_UNORM,
      .depthFormat = VK_FORMAT_X8_D24_UNORM_PACK32},
     false},
    {"SnormAlpha",
     {.normalEncoding = CND_NORMAL_SNORM,
      .normalSpace = CND_NORMALS_WORLD,
      .roughness = CND_CHANNEL_NORMAL_A,
      .roughnessKind = CND_ROUGHNESS_ALPHA,
      .metalness = CND_CHANNEL_ALBEDO_A,
      .dielectricF0 = 0.06f,
      .normalRoughnessFormat = VK_FORMAT_R8G8B8A8_SNORM,
      .albedoFormat = VK_FORMAT_R8G8B8A8_SRGB,
      .specularFormat = VK_FORMAT_R8G8_UNORM,
      .depthFormat = VK_FORMAT_D16_UNORM},
     false},
    {"HalfOctahedral",
     {.normalEncoding = CND_NORMAL_OCTAHEDRAL_SNORM,
      .normalSpace = CND_NORMALS_WORLD,
      .roughness = CND_CHANNEL_NORMAL_B,
      .metalness = CND_CHANNEL_NORMAL_A,
      .normalRoughnessFormat = VK_FORMAT_R16G16B16A16_SFLOAT,
      .albedoFormat = VK_FORMAT_R16G16B16A16_SFLOAT,
      .specularFormat = VK_FORMAT_R16G16B16A16_SFLOAT,
      .depthFormat = VK_FORMAT_R32_SFLOAT},
     true},
    {"SnormOctahedralF90",
     {.normalEncoding = CND_NORMAL_OCTAHEDRAL_SNORM,
      .normalSpace = CND_NORMALS_VIEW,
      .roughness = CND_CHANNEL_ALBEDO_A,
      .reflectance = CND_REFLECTANCE_SPECULAR,
      .f90 = CND_CHANNEL_SPECULAR_A,
      .normalRoughnessFormat = VK_FORMAT_R16G16_SNORM,
      .albedoFormat = VK_FORMAT_R8G8B8A8_SRGB,
      .specularFormat = VK_FORMAT_R16G16B16A16_SFLOAT,
      .depthFormat = VK_FORMAT_D32_SFLOAT_S8_UINT},
     true},
    // Hosts without some of the channels, and without depth.
    {"ConstantsLinearDepth",
     {.normalEncoding = CND_NORMAL_SNORM,
      .normalSpace = CND_NORMALS_VIEW,
      .constantRoughness = 0.4f,
      .constantMetalness = 0.5f,
      .normalRoughnessFormat = VK_FORMAT_R16G16B16A16_SFLOAT,
      .albedoFormat = VK_FORMAT_R8G8B8A8_UNORM,
      .specularFormat = VK_FORMAT_R8G8_UNORM,
      .depthFormat = VK_FORMAT_R32_SFLOAT,
      .depthKind = CND_DEPTH_LINEAR,
      .depthUnit = 2},
     true},
    {"PositionsOrthographic",
     {.normalEncoding = CND_NORMAL_SNORM,
      .normalSpace = CND_NORMALS_WORLD,
      .roughness = CND_CHANNEL_NORMAL_A,
      .normalRoughnessFormat = VK_FORMAT_R16G16B16A16_SFLOAT,
      .albedoFormat = VK_FORMAT_R8G8B8A8_UNORM,
      .specularFormat = VK_FORMAT_R8G8_UNORM,
      .depthFormat = VK_FORMAT_R32G32B32A32_SFLOAT,
      .depthKind = CND_DEPTH_POSITION_WORLD},
     false,
     1e-3,
     CND_SPECULAR_KARIS,
     true},
};

CndCamera cameraOf(const Layout& layout)
{
    CndCamera out;
    const double aspect = double(imageWidth) / imageHeight;
    if (layout.orthographic)
        setOrthographic(out, 12, aspect, nearPlane, 60, layout.reversed);
    else
        setPerspective(out, 1.0, aspect, nearPlane, layout.reversed ? 0 : 60, layout.reversed);
    const glm::dmat4 viewFromWorld =
        glm::translate(glm::rotate(glm::dmat4(1), 1.1, glm::normalize(glm::dvec3(1, 2, -0.5))),
                       glm::dvec3(4, -7, 2));
    std::memcpy(out.viewFromWorld, &viewFromWorld, sizeof out.viewFromWorld);
    return out;
}

// Walls at several depths with holes between them; every pixel has its own bump and material.
HostPixels randomSurfaces(const Layout& layout)
{
    const CndCamera c = cameraOf(layout);
    const float clearDepth = layout.reversed ? 0.0f : 1.0f;
    const CpuGBuffer walls = randomGBuffer(imageWidth, imageHeight, c, clearDepth, 4);
    HostPacking packing(layout.desc, imageWidth, imageHeight, c, clearDepth);
    std::mt19937 random(8);
    std::uniform_real_distribution<double> uniform(0, 1);
    for (size_t i = 0; i < walls.depth.size(); ++i) {
        HostSurface s{.normal = storedNormal(walls, i),
                      .perceptualRoughness = 0.2 + 0.8 * uniform(random),
                      .metalness = std::floor(3 * uniform(random)) / 2};
        s.baseColour = {uniform(random), uniform(random), uniform(random)};
        packing.add(s, double(walls.depth[i]));
    }
    return packing.pixels();
}

// Returns lights near the surfaces, in world space.
std::vector<CndLight> lightsOf(const CpuGBuffer& g)
{
    std::vector<CndLight> lights = randomSpheres(g, 60, 3);
    glm::dmat4 viewFromWorld;
    std::memcpy(&viewFromWorld, g.camera.viewFromWorld, sizeof viewFromWorld);
    const glm::dmat4 worldFromView = glm::inverse(viewFromWorld);
    for (CndLight& light : lights) {
        const glm::dvec4 view(light.position[0], light.position[1], light.position[2], 1);
        for (int i = 0; i < 3; ++i)
            light.position[i] = float((worldFromView * view)[i]);
        light.influenceRadius *= 3;
    }
    return lights;
}

class Layouts : public HostGBufferTest, public ::testing::WithParamInterface<Layout>
{
protected:
    void SetUp() override
    {
        HostGBufferTest::SetUp();
        VkFormatProperties properties{};
        vkGetPhysicalDeviceFormatProperties(context().info().handle, GetParam().desc.depthFormat,
                                            &properties);
        if (!(properties.optimalTilingFeatures & VK_FORMAT_FEATURE_SAMPLED_IMAGE_BIT))
            GTEST_SKIP() << "the device has no depth of this format";
    }
    // Devices may decode sRGB as they like within half a step of its 8 bits. Where the curve is
    // steepest that is (0.5 / 255) (2.4 / 1.055) of the largest value. llvmpipe's curve is off by
    // 1.3e-3.
    double tolerance() const
    {
        const bool isSrgb = GetParam().desc.albedoFormat == VK_FORMAT_R8G8B8A8_SRGB;
        if (!isSrgb)
            return GetParam().tolerance;
        return device().lanesAreCpuVector ? 2e-3 : 0.5 / 255 * 2.4 / 1.055;
    }
    // Shades with lists and by brute force.
    std::array<std::vector<glm::vec4>, 2> light(const HostPixels& pixels,
                                                const std::vector<CndLight>& lights)
    {
        const Images images = uploadImages(pixels.asFull);
        const HostImages host = uploadHost(pixels);
        auto lighting = Lighting::create(
            deviceDesc(), {.framesInFlight = 1,
                           .gbufferLayout = CND_GBUFFER_HOST,
                           .specularMethods = 1u << GetParam().method,
                           .shading = CND_SHADING_CLUSTERED_BIT | CND_SHADING_BRUTE_BIT,
                           .gbuffer = pixels.desc});
        EXPECT_TRUE(lighting) << lighting.error().message;
        auto view = lighting.value().createView({.maxWidth = imageWidth, .maxHeight = imageHeight});
        EXPECT_TRUE(view) << view.error().message;
        EXPECT_TRUE(lighting.value().setLights(lights, {0, 0, 0}));
        std::array<std::vector<glm::vec4>, 2> out;
        for (const CndCulling culling : {CND_CULLING_CLUSTERED, CND_CULLING_BRUTE}) {
            const RunOptions options{.specular = GetParam().method, .culling = culling};
            const CndLightingFrame frame = withHost(frameOf(pixels.asFull, images, options), host);
            context().submitAndWait([&](VkCommandBuffer cmd) {
                clearRadiance(cmd, images);
                const auto recorded = view.value().record(cmd, frame);
                EXPECT_TRUE(recorded) << recorded.error().message;
            });
            out[culling] = readRadiance(images);
        }
        return out;
    }
};

TEST_P(Layouts, AreLitLikeOurOwn)
{
    const HostPixels pixels = randomSurfaces(GetParam());
    const std::vector<CndLight> lights = lightsOf(pixels.asFull);
    const auto own = [&](const CpuGBuffer& g) {
        return run(g, lights, {.specular = GetParam().method}).radiance;
    };
    const auto [host, brute] = light(pixels, lights);
    const double decoded = maxRelativeDifference(host, own(pixels.asFull));
    std::cout << GetParam().name << ": largest difference of the peak " << decoded
              << ", with what the host's formats round "
              << maxRelativeDifference(host, own(pixels.unrounded)) << '\n';
    EXPECT_LT(decoded, tolerance());
    EXPECT_TRUE(agree(host, brute));
}

// Tells whether the normal of a pixel points at an edge between two faces of a cube map, except for
// rounding. Normals of few bits often do.
bool pointsAtCubeEdge(const CpuGBuffer& g, size_t pixel)
{
    glm::dmat4 viewFromWorld;
    std::memcpy(&viewFromWorld, g.camera.viewFromWorld, sizeof viewFromWorld);
    const glm::dvec3 world = glm::transpose(glm::dmat3(viewFromWorld)) * storedNormal(g, pixel);
    std::array<double, 3> n{std::abs(world.x), std::abs(world.y), std::abs(world.z)};
    std::sort(n.begin(), n.end());
    return n[2] - n[1] < 1e-5;
}

TEST_P(Layouts, AreLitByTheEnvironmentLikeOurOwn)
{
    const HostPixels pixels = randomSurfaces(GetParam());
    const EnvironmentImage sky =
        imageOf([](const glm::dvec3& d) { return 1.5 + d.y + 0.5 * std::sin(4 * d.x); }, 64);
    setImage(sky, 64);
    const std::vector<glm::vec4> own = shade(pixels.asFull);
    setImage(sky, 64, &GetParam().desc);
    const Images images = uploadImages(pixels.asFull);
    const HostImages host = uploadHost(pixels);
    const CndEnvironmentFrame frame = withHost(environmentFrame(pixels.asFull, images, {}), host);
    CndError error{};
    context().submitAndWait([&](VkCommandBuffer cmd) {
        clearRadiance(cmd, images);
        EXPECT_EQ(cndRecordEnvironment(environment_, cmd, &frame, &error), CND_SUCCESS)
            << error.message;
    });
    std::vector<glm::vec4> lit = readRadiance(images);
    // On drivers that do not filter across the edges of cube maps, what the faces show differs
    // there, and rounding decides which face is read.
    size_t leftOut = 0;
    if (whyNoReflections())
        for (size_t i = 0; i < lit.size(); ++i)
            if (pointsAtCubeEdge(pixels.asFull, i)) {
                lit[i] = own[i];
                ++leftOut;
            }
    EXPECT_LE(leftOut, lit.size() / 100);
    const double difference = maxRelativeDifference(lit, own);
    std::cout << GetParam().name << ": largest difference of the peak " << difference << '\n';
    EXPECT_LT(difference, tolerance());
}

INSTANTIATE_TEST_SUITE_P(HostGBuffer, Layouts, ::testing::ValuesIn(layouts),
                         [](const auto& test) { return test.param.name; });

// --- the overlay

const CndGBufferDesc floats{.normalEncoding = CND_NORMAL_SNORM,
                            .normalSpace = CND_NORMALS_WORLD,
                            .roughness = CND_CHANNEL_NORMAL_A,
                            .metalness = CND_CHANNEL_ALBEDO_A,
                            .normalRoughnessFormat = VK_FORMAT_R32G32B32A32_SFLOAT,
                            .albedoFormat = VK_FORMAT_R32G32B32A32_SFLOAT,
                            .specularFormat = VK_FORMAT_R8G8_UNORM,
                            .depthFormat = VK_FORMAT_R32_SFLOAT};

// A pixel as it is stored, and the colour in which the overlay must show it.
struct Planted {
    const char* what;
    glm::dvec4 normalRoughness, albedoMetalness;
    double depth;
    glm::u8vec3 colour;
};

class SurfaceOverlay : public HostGBufferTest
{
protected:
    using Picture = std::vector<glm::u8vec4>;
    // Returns one picture per CndSurfaceQuantity.
    std::vector<Picture> show(const HostPixels& pixels)
    {
        const HostImages host = uploadHost(pixels);
        return show(withHost(frameOf(pixels.asFull), host), CND_GBUFFER_HOST, pixels.desc);
    }
    std::vector<Picture> show(const CpuGBuffer& full)
    {
        const Images images = uploadImages(full);
        return show(surfaceFrame<CndLightingFrame>(full, images), CND_GBUFFER_FULL, {});
    }
    // Returns an image to record pictures into.
    gpu::Image createPicture(uint32_t width, uint32_t height)
    {
        return gpu::createImage(device(), "overlay", VK_FORMAT_R8G8B8A8_UNORM, width, height,
                                VK_IMAGE_USAGE_STORAGE_BIT | VK_IMAGE_USAGE_TRANSFER_SRC_BIT,
                                VK_IMAGE_ASPECT_COLOR_BIT);
    }

private:
    static CndLightingFrame frameOf(const CpuGBuffer& g)
    {
        return {
            .width = g.width, .height = g.height, .camera = g.camera, .clearDepth = g.clearDepth};
    }
    std::vector<Picture> show(const CndLightingFrame& frame, CndGBufferLayout layout,
                              const CndGBufferDesc& gbuffer)
    {
        const gpu::Image picture = createPicture(frame.width, frame.height);
        auto lighting = Lighting::create(deviceDesc(), {.framesInFlight = 1,
                                                        .gbufferLayout = layout,
                                                        .specularMethods = 1u << CND_SPECULAR_NONE,
                                                        .shading = CND_SHADING_CLUSTERED_BIT,
                                                        .gbuffer = gbuffer});
        auto view =
            lighting.value().createView({.maxWidth = frame.width, .maxHeight = frame.height});
        std::vector<Picture> out;
        for (int quantity = CND_SURFACE_ALL; quantity <= CND_SURFACE_FAULTS; ++quantity) {
            context().submitAndWait([&](VkCommandBuffer cmd) {
                transition(cmd, picture.image.get(), VK_IMAGE_ASPECT_COLOR_BIT,
                           VK_IMAGE_LAYOUT_UNDEFINED, VK_IMAGE_LAYOUT_GENERAL);
                const auto recorded = view.value().recordOverlay(
                    cmd, frame,
                    {.quantity = CndSurfaceQuantity(quantity), .image = picture.view.get()});
                EXPECT_TRUE(recorded) << recorded.error().message;
            });
            const std::vector<std::byte> bytes =
                readImage(picture, VK_IMAGE_ASPECT_COLOR_BIT, VK_IMAGE_LAYOUT_GENERAL, 4);
            out.emplace_back(bytes.size() / 4);
            std::memcpy(out.back().data(), bytes.data(), bytes.size());
        }
        return out;
    }
};

TEST_F(SurfaceOverlay, MarksPlantedMistakes)
{
    CndCamera c;
    setPerspective(c, 0.2, 1, nearPlane);
    const double near = double(depthAt(c, 3)), nan = std::nan(""), infinity = HUGE_VAL;
    const glm::dvec4 good(0, 0, 1, 0.5), grey(0.5, 0.5, 0.5, 0);
    const glm::u8vec3 magenta(255, 0, 255), blue(0, 0, 255), yellow(255, 255, 0), red(255, 0, 0),
        cyan(0, 255, 255), orange(255, 128, 0);
    const Planted pixels[] = {
        {"nothing", good, grey, near, {128, 128, 128}},
        {"no surface", {nan, 0, 0, 9}, {9, 9, 9, 9}, 0, {0, 0, 0}},
        {"NaN in a normal", {nan, 0, 1, 0.5}, grey, near, magenta},
        {"infinite normal", {infinity, 0, 1, 0.5}, grey, near, magenta},
        {"NaN roughness", {0, 0, 1, nan}, grey, near, magenta},
        {"NaN in a colour", good, {0.5, nan, 0.5, 0}, near, magenta},
        {"behind the eye", good, grey, -near, blue},
        {"normal too long", {0, 0, 1.1, 0.5}, grey, near, yellow},
        {"no normal", {0, 0, 0, 0.5}, grey, near, yellow},
        {"normal turned round", {0, 0, -1, 0.5}, grey, near, red},
        {"roughness in steps of 255", {0, 0, 1, 128}, grey, near, cyan},
        {"negative roughness", {0, 0, 1, -0.1}, grey, near, cyan},
        {"base colour beyond 1", good, {0.5, 1.4, 0.5, 0}, near, orange},
        {"metalness beyond 1", good, {0.5, 0.5, 0.5, 1.5}, near, orange},
    };
    HostPixels p{.desc = floats, .width = uint32_t(std::size(pixels)), .height = 1};
    p.asFull = {.width = p.width, .height = 1, .camera = c, .clearDepth = 0};
    for (const Planted& pixel : pixels) {
        appendTexel(p.images[0], floats.normalRoughnessFormat, pixel.normalRoughness);
        appendTexel(p.images[1], floats.albedoFormat, pixel.albedoMetalness);
        appendTexel(p.images[2], floats.specularFormat, {});
        appendDepth(p.depth, floats.depthFormat, pixel.depth);
    }
    const Picture shown = show(p)[CND_SURFACE_FAULTS];
    for (size_t i = 0; i < std::size(pixels); ++i)
        for (int k = 0; k < 3; ++k) // NoV of the first pixel is almost 1
            EXPECT_NEAR(shown[i][k], pixels[i].colour[k], 2) << pixels[i].what << ' ' << k;
}

// Positions that cannot be seen are marked like depths behind the eye.
TEST_F(SurfaceOverlay, MarksPositionsThatCannotBe)
{
    CndGBufferDesc desc = floats;
    desc.depthFormat = VK_FORMAT_R32G32B32A32_SFLOAT;
    desc.depthKind = CND_DEPTH_POSITION_VIEW;
    const double nan = std::nan(""), infinity = HUGE_VAL;
    const std::pair<glm::dvec4, glm::u8vec3> pixels[] = {{{0, 0, -3, 1}, {128, 128, 128}},
                                                         {{9, 9, 9, 0}, {0, 0, 0}}, // no surface
                                                         {{0, 0, 3, 1}, {0, 0, 255}},
                                                         {{0, 0, nan, 1}, {0, 0, 255}},
                                                         {{0, 0, -infinity, 1}, {0, 0, 255}}};
    HostPixels p{.desc = desc, .width = uint32_t(std::size(pixels)), .height = 1};
    p.asFull = {.width = p.width, .height = 1, .clearDepth = 0};
    setPerspective(p.asFull.camera, 0.2, 1, nearPlane);
    for (const auto& [position, colour] : pixels) {
        appendTexel(p.images[0], desc.normalRoughnessFormat, {0, 0, 1, 0.5});
        appendTexel(p.images[1], desc.albedoFormat, {0.5, 0.5, 0.5, 0});
        appendTexel(p.images[2], desc.specularFormat, {});
        appendTexel(p.depth, desc.depthFormat, position);
    }
    const Picture shown = show(p)[CND_SURFACE_FAULTS];
    for (size_t i = 0; i < std::size(pixels); ++i)
        for (int k = 0; k < 3; ++k)
            EXPECT_NEAR(shown[i][k], pixels[i].second[k], 2) << i << ' ' << k;
}

// Checks every quantity, and the six small pictures of CND_SURFACE_ALL.
TEST_F(SurfaceOverlay, ShowsWhatIsRead)
{
    const HostPixels p = randomSurfaces({"", floats, true});
    const std::vector<Picture> shown = show(p);
    const Picture& all = shown[CND_SURFACE_ALL];
    glm::dmat4 viewFromWorld;
    std::memcpy(&viewFromWorld, p.asFull.camera.viewFromWorld, sizeof viewFromWorld);
    const glm::dmat4 worldFromView = glm::inverse(viewFromWorld);
    const auto srgb = [](double x) {
        return x <= 0.0031308 ? 12.92 * x : 1.055 * std::pow(x, 1 / 2.4) - 0.055;
    };
    for (int q = CND_SURFACE_NORMAL; q <= CND_SURFACE_FAULTS; ++q) {
        const Picture& one = shown[size_t(q)];
        for (uint32_t y = 0; y < imageHeight; ++y)
            for (uint32_t x = 0; x < imageWidth; ++x) {
                const size_t i = size_t(y) * imageWidth + x;
                const glm::dvec3 albedo = storedAlbedo(p.asFull, i);
                const glm::dvec4 f0 = storedSpecular(p.asFull, i);
                const glm::dvec4 world =
                    worldFromView * glm::dvec4(viewPosition(p.asFull, x, y), 1);
                for (int k = 0; k < 3; ++k) {
                    const double expected[] = {
                        0.5 + 0.5 * (glm::dmat3(worldFromView) * storedNormal(p.asFull, i))[k],
                        storedRoughness(p.asFull, i), srgb(albedo[k]), srgb(f0[k]),
                        std::abs(2 * (world[k] / 2 - std::floor(world[k] / 2)) - 1)};
                    const bool surface = p.asFull.depth[i] != p.asFull.clearDepth;
                    if (q == CND_SURFACE_FAULTS)
                        continue;
                    ASSERT_NEAR(one[i][k], surface ? 255 * expected[q - 1] : 0, 1.1)
                        << q << ' ' << x << ' ' << y << ' ' << k;
                }
                const uint32_t column = uint32_t(q - 1) % 3, row = uint32_t(q - 1) / 3;
                if (x % 3 == 0 && y % 2 == 0) { // 72 = 3 * 24, 48 = 2 * 24
                    ASSERT_EQ(all[(row * 24 + y / 2) * imageWidth + column * 24 + x / 3].x,
                              one[i].x);
                }
            }
    }
}

// FULL surfaces that face the eye, under every kind of camera: no fault is marked, and positions
// are right.
TEST_F(SurfaceOverlay, MarksNothingThatIsRight)
{
    for (const bool reversed : {false, true})
        for (const bool perspective : {false, true}) {
            CndCamera c;
            if (perspective)
                setPerspective(c, 0.4, 1, nearPlane, 60, reversed);
            else
                setOrthographic(c, 8, 1, nearPlane, 60, reversed);
            CpuGBuffer g{.width = 32, .height = 32, .camera = c, .clearDepth = reversed ? 0.0f : 1};
            for (int i = 0; i < 32 * 32; ++i)
                addPixel(g, {.depth = depthAt(c, 2 + i % 37),
                             .normal = {0.03 * (i % 32 - 15), 0.02 * (i % 29 - 14), 1},
                             .perceptualRoughness = (i % 9) / 8.0,
                             .albedo = glm::vec3(0.25f * float(i % 5)),
                             .F0F90 = glm::vec4(0.04f, 0.5f, 1, 1)});
            const std::vector<Picture> shown = show(g);
            for (uint32_t i = 0; i < 32 * 32; ++i) {
                const glm::u8vec4 mark = shown[CND_SURFACE_FAULTS][i];
                ASSERT_TRUE(mark.x == mark.y && mark.y == mark.z && mark.x > 80) << i;
                const glm::dvec3 at = viewPosition(g, i % 32, i / 32) / 2.0;
                for (int k = 0; k < 3; ++k)
                    ASSERT_NEAR(shown[CND_SURFACE_POSITION][i][k],
                                255 * std::abs(2 * (at[k] - std::floor(at[k])) - 1), 1.1);
            }
        }
}

// One command buffer holds the lighting and the overlay of one slot, with different cameras, in
// either order. The device runs both after the host has written the parameters of both: each must
// still read its own.
TEST_F(SurfaceOverlay, AndLightingOfTheSameSlotHaveTheirOwnCameras)
{
    const CpuGBuffer g = randomGBuffer(imageWidth, imageHeight, 9);
    const Images images = uploadImages(g);
    const gpu::Image picture = createPicture(g.width, g.height);
    const auto own = createLighting(g, 1);
    setLights(own.lighting, randomSpheres(g, 40, 9));
    const CndLightingFrame frame = LightingTest::frameOf(g, images, {});
    CndLightingFrame zoomed = frame;
    setPerspective(zoomed.camera, 0.3, double(g.width) / g.height, nearPlane);

    using Record = std::function<void(VkCommandBuffer)>;
    const auto lightingOf = [&](const CndLightingFrame& f) -> Record {
        return [&](VkCommandBuffer cmd) {
            CndError error{};
            EXPECT_EQ(cndRecordLighting(own.view, cmd, &f, &error), CND_SUCCESS) << error.message;
        };
    };
    const auto overlayOf = [&](const CndLightingFrame& f) -> Record {
        return [&](VkCommandBuffer cmd) {
            const CndSurfaceOverlay position{sizeof position, CND_SURFACE_POSITION,
                                             picture.view.get()};
            CndError error{};
            EXPECT_EQ(cndRecordSurfaceOverlay(own.view, cmd, &f, &position, &error), CND_SUCCESS)
                << error.message;
        };
    };
    // Returns the radiance and the picture after one command buffer.
    const auto draw = [&](const std::vector<Record>& records) {
        context().submitAndWait([&](VkCommandBuffer cmd) {
            clearRadiance(cmd, images);
            transition(cmd, picture.image.get(), VK_IMAGE_ASPECT_COLOR_BIT,
                       VK_IMAGE_LAYOUT_UNDEFINED, VK_IMAGE_LAYOUT_GENERAL);
            for (const Record& record : records)
                record(cmd);
        });
        return std::pair{readRadiance(images),
                         readImage(picture, VK_IMAGE_ASPECT_COLOR_BIT, VK_IMAGE_LAYOUT_GENERAL, 4)};
    };
    const std::vector<glm::vec4> radiance = draw({lightingOf(frame)}).first;
    const std::vector<std::byte> shown = draw({overlayOf(zoomed)}).second;
    EXPECT_FALSE(sameBits(draw({lightingOf(zoomed)}).first, radiance)); // the cameras do matter
    EXPECT_NE(draw({overlayOf(frame)}).second, shown);
    for (const auto& both : {std::vector{lightingOf(frame), overlayOf(zoomed)},
                             std::vector{overlayOf(zoomed), lightingOf(frame)}}) {
        const auto [lit, over] = draw(both);
        EXPECT_TRUE(sameBits(lit, radiance));
        EXPECT_EQ(over, shown);
    }
}

} // namespace
} // namespace candelabra::test
