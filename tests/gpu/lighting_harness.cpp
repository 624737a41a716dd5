// SPDX-License-Identifier: Apache-2.0
#include "gpu/lighting_harness.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <tuple>

#include "gpu/fill_image.h"
#include "scene/polygons.h"

namespace candelabra::test
{
namespace
{

void setIdentityView(CndCamera& camera)
{
    for (int i = 0; i < 16; ++i)
        camera.viewFromWorld[i] = i % 5 == 0;
}

// The packing of the FULL layout, written a second time, independently of the shader's.

// Returns the code of the nearest unit float with `mantissa` bits of mantissa.
uint32_t unitFloatCode(double x, int mantissa)
{
    // The exponent of the largest power of two that is not above x, but at least -7.
    const int exponent = x < std::ldexp(1, -7) ? -7 : std::ilogb(x);
    const double scaled = std::ldexp(x, mantissa - exponent);
    const long code = x < std::ldexp(1, -7) ? std::lrint(scaled) // to even
                                            : ((exponent + 7L) << mantissa) + std::lround(scaled);
    return uint32_t(std::max(code, 1L) - 1);
}

double unitFloatValue(uint32_t code, int mantissa)
{
    const uint32_t steps = code ? code + 1 : 0, one = 1u << mantissa;
    if (steps < one)
        return std::ldexp(steps, -7 - mantissa);
    return std::ldexp(steps % one + one, int(steps >> mantissa) - 8 - mantissa);
}

constexpr int roughnessMantissa = 15, colourMantissa = 18, shortMantissa = 13;

glm::uvec2 packNormal(glm::dvec3 n, double roughness)
{
    n /= std::abs(n.x) + std::abs(n.y) + std::abs(n.z);
    glm::dvec2 p(n);
    if (n.z < 0)
        p = {(1 - std::abs(n.y)) * (n.x < 0 ? -1 : 1), (1 - std::abs(n.x)) * (n.y < 0 ? -1 : 1)};
    constexpr double scale = (1 << 22) - 1;
    const uint32_t u = uint32_t(int32_t(std::lround(p.x * scale))) & 0x7FFFFF;
    const uint32_t v = uint32_t(int32_t(std::lround(p.y * scale))) & 0x7FFFFF;
    const uint32_t r = unitFloatCode(roughness, roughnessMantissa);
    return {u | r << 23, v | r >> 9 << 23};
}

double uniformOf(std::mt19937& random)
{
    return double(random()) / 4294967296.0;
}

} // namespace

void setPerspective(CndCamera& camera, double verticalFov, double aspect, double nearPlane,
                    double farPlane, bool reversed)
{
    setIdentityView(camera);
    float* m = camera.clipFromView;
    std::fill_n(m, 16, 0.0f);
    const double f = 1 / std::tan(verticalFov / 2);
    m[0] = float(f / aspect);
    m[5] = float(-f);
    m[11] = -1;
    // depth = (m[10] z + m[14]) / -z, with z = -near and -far at the ends.
    const double near = reversed ? 1 : 0, far = reversed ? 0 : 1;
    if (farPlane == 0) {
        m[10] = float(-far);
        m[14] = float(nearPlane * (near - far));
    } else {
        m[10] = float((nearPlane * near - farPlane * far) / (farPlane - nearPlane));
        m[14] = float(nearPlane * farPlane * (near - far) / (farPlane - nearPlane));
    }
}

void setOrthographic(CndCamera& camera, double height, double aspect, double nearPlane,
                     double farPlane, bool reversed)
{
    setIdentityView(camera);
    float* m = camera.clipFromView;
    std::fill_n(m, 16, 0.0f);
    m[0] = float(2 / (height * aspect));
    m[5] = float(-2 / height);
    const double sign = reversed ? 1 : -1;
    m[10] = float(sign / (farPlane - nearPlane));
    m[14] =
        float(reversed ? farPlane / (farPlane - nearPlane) : -nearPlane / (farPlane - nearPlane));
    m[15] = 1;
}

float depthAt(const CndCamera& camera, double distance)
{
    const float* m = camera.clipFromView;
    return float((m[10] * -distance + m[14]) / (m[11] * -distance + m[15]));
}

glm::dvec3 viewPosition(const CpuGBuffer& g, uint32_t x, uint32_t y)
{
    const float* m = g.camera.clipFromView;
    const double depth = g.depth[size_t(y) * g.width + x];
    const double z = (m[14] - depth * m[15]) / (depth * m[11] - m[10]);
    const double w = m[11] * z + m[15];
    const double ndcX = (2.0 * x + 1) / g.width - 1, ndcY = (2.0 * y + 1) / g.height - 1;
    return {(ndcX * w - m[8] * z - m[12]) / m[0], (ndcY * w - m[9] * z - m[13]) / m[5], z};
}

glm::dvec3 storedNormal(const CpuGBuffer& g, size_t pixel)
{
    const auto coordinate = [](uint32_t code) {
        return double(int32_t(code << 9) >> 9) / ((1 << 22) - 1);
    };
    const glm::uvec2 code = g.normalRoughness[pixel];
    const double u = coordinate(code.x), v = coordinate(code.y);
    glm::dvec3 n(u, v, 1 - std::abs(u) - std::abs(v));
    if (n.z < 0) {
        n.x = (1 - std::abs(v)) * (u < 0 ? -1 : 1);
        n.y = (1 - std::abs(u)) * (v < 0 ? -1 : 1);
    }
    return glm::normalize(n);
}

double storedRoughness(const CpuGBuffer& g, size_t pixel)
{
    const glm::uvec2 code = g.normalRoughness[pixel];
    return unitFloatValue(code.x >> 23 | code.y >> 23 << 9, roughnessMantissa);
}

glm::uvec2 packAlbedo(const glm::dvec3& albedo)
{
    glm::uvec3 code;
    for (int c = 0; c < 3; ++c)
        code[c] = unitFloatCode(albedo[c], colourMantissa);
    return {code.r | code.b << 21, code.g | code.b >> 11 << 21};
}

glm::uvec2 packSpecular(const glm::dvec4& F0F90)
{
    if (F0F90.a >= 1)
        return packAlbedo(F0F90) | glm::uvec2(0, 1u << 31);
    glm::uvec3 code;
    for (int c = 0; c < 3; ++c)
        code[c] = unitFloatCode(F0F90[c], shortMantissa);
    return {code.r | code.g << 16, code.b | uint32_t(std::lrint(float(F0F90.a) * 0x7FFF)) << 16};
}

namespace
{

glm::dvec3 unpackColour(glm::uvec2 texel)
{
    const uint32_t blue = texel.x >> 21 | (texel.y >> 21 & 0x3FF) << 11;
    return {unitFloatValue(texel.x & 0x1FFFFF, colourMantissa),
            unitFloatValue(texel.y & 0x1FFFFF, colourMantissa),
            unitFloatValue(blue, colourMantissa)};
}

} // namespace

glm::dvec3 storedAlbedo(const CpuGBuffer& g, size_t pixel)
{
    return unpackColour(g.albedo[pixel]);
}

glm::dvec4 storedSpecular(const CpuGBuffer& g, size_t pixel)
{
    const glm::uvec2 texel = g.specular[pixel];
    if (texel.y >> 31)
        return {unpackColour(texel), 1};
    return {unitFloatValue(texel.x & 0xFFFF, shortMantissa),
            unitFloatValue(texel.x >> 16, shortMantissa),
            unitFloatValue(texel.y & 0xFFFF, shortMantissa), (texel.y >> 16) / double(0x7FFF)};
}

void addPixel(CpuGBuffer& g, const CpuSurface& surface)
{
    g.depth.push_back(surface.depth);
    g.normalRoughness.push_back(
        packNormal(glm::normalize(surface.normal), surface.perceptualRoughness));
    g.albedo.push_back(packAlbedo(surface.albedo));
    g.specular.push_back(packSpecular(surface.F0F90));
}

CpuGBuffer randomGBuffer(uint32_t width, uint32_t height, const CndCamera& camera, float clearDepth,
                         uint32_t seed)
{
    std::mt19937 random(seed);
    CpuGBuffer g{.width = width, .height = height, .camera = camera, .clearDepth = clearDepth};
    for (uint32_t y = 0; y < height; ++y)
        for (uint32_t x = 0; x < width; ++x) {
            // Vertical walls, 11 pixels wide, at 3 to 27 m in the top row and 1 cm farther in each
            // row, with bumps of up to 5 cm.
            const uint32_t wall = (x / 11 * 7 + seed) % 5;
            const double distance = 3 + 6 * wall + y * 0.01 + 0.05 * uniformOf(random);
            const bool hole = (x / 5 + y / 7) % 9 == 0;
            g.depth.push_back(hole ? clearDepth : depthAt(camera, distance));
            glm::dvec3 n(uniformOf(random) - 0.5, uniformOf(random) - 0.5, 0.4 + uniformOf(random));
            const double roughness = 0.1 + 0.9 * uniformOf(random);
            g.normalRoughness.push_back(packNormal(glm::normalize(n), roughness));
            const double metal = uniformOf(random) < 0.3 ? 1 : 0;
            const glm::dvec3 base(uniformOf(random), uniformOf(random), uniformOf(random));
            g.albedo.push_back(packAlbedo(base * (1 - metal)));
            g.specular.push_back(packSpecular({glm::mix(glm::dvec3(0.04), base, metal), 1}));
        }
    return g;
}

CpuGBuffer randomGBuffer(uint32_t width, uint32_t height, uint32_t seed)
{
    CndCamera camera;
    setPerspective(camera, 1.0, double(width) / height, 0.1);
    return randomGBuffer(width, height, camera, 0, seed);
}

std::vector<CndLight> randomSpheres(const CpuGBuffer& g, uint32_t count, uint32_t seed)
{
    std::mt19937 random(seed);
    std::vector<CndLight> lights;
    while (lights.size() < count) {
        const uint32_t x = uint32_t(random() % g.width), y = uint32_t(random() % g.height);
        const bool hole = g.depth[size_t(y) * g.width + x] == g.clearDepth;
        glm::dvec3 p = hole ? glm::dvec3(0, 0, -10) : viewPosition(g, x, y);
        for (int i = 0; i < 3; ++i)
            p[i] += 3 * (uniformOf(random) - 0.5);
        CndLight light{.type = CND_LIGHT_SPHERE,
                       .position = {float(p.x), float(p.y), float(p.z)},
                       .radius = float(0.01 + 0.5 * std::pow(uniformOf(random), 3))};
        for (float& e : light.emission)
            e = float(1000 * uniformOf(random));
        light.influenceRadius = light.radius * 1.5f + float(3 * uniformOf(random));
        lights.push_back(light);
    }
    return lights;
}

std::vector<CndLight> lightsOf(CndLightType type, const CpuGBuffer& g, uint32_t count,
                               uint32_t seed)
{
    std::vector<CndLight> lights = randomSpheres(g, count, seed);
    for (uint32_t i = 0; i < count; ++i) {
        CndLight& light = lights[i];
        light.type = type;
        const double angle = 2.4 * (i + seed); // about the golden angle
        const glm::dvec3 d(0.8 * std::cos(angle), 0.8 * std::sin(angle), -0.6);
        const glm::dvec3 u = glm::normalize(glm::cross(d, glm::dvec3(0.3, 1, 0.2)));
        const glm::dvec3 v = glm::cross(d, u);
        for (int k = 0; k < 3; ++k) {
            light.direction[k] = float(d[k]);
            light.axisU[k] = float(u[k] * 2.5 * light.radius);
            light.axisV[k] = float(v[k] * light.radius);
        }
        light.innerConeAngle = 0.2f;
        light.outerConeAngle = 0.9f;
        light.twoSided = i % 3 == 0;
        light.polygon = app::somePolygon(i);
        light.influenceRadius += 3 * light.radius;
        if (i % 5 == 0)
            light.influenceRadius = std::numeric_limits<float>::infinity();
        if (type == CND_LIGHT_DISTANT_SPHERE)
            light.radius = i % 2 ? 0.00465f : 0.3f;
    }
    return lights;
}

LightingTest::Images LightingTest::uploadImages(const CpuGBuffer& g)
{
    constexpr VkImageUsageFlags use = VK_IMAGE_USAGE_SAMPLED_BIT | VK_IMAGE_USAGE_TRANSFER_DST_BIT;
    const auto make = [&](const char* name, VkFormat format, VkImageUsageFlags more,
                          VkImageAspectFlags aspect) {
        return gpu::createImage(device(), name, format, g.width, g.height, use | more, aspect);
    };
    constexpr VkImageAspectFlags colour = VK_IMAGE_ASPECT_COLOR_BIT;
    Images images{make("normalRoughness", VK_FORMAT_R32G32_UINT, 0, colour),
                  make("albedo", g.albedoFormat, 0, colour),
                  make("specular", VK_FORMAT_R32G32_UINT, 0, colour),
                  make("depth", VK_FORMAT_D32_SFLOAT, VK_IMAGE_USAGE_DEPTH_STENCIL_ATTACHMENT_BIT,
                       VK_IMAGE_ASPECT_DEPTH_BIT),
                  make("radiance", VK_FORMAT_R32G32B32A32_SFLOAT,
                       VK_IMAGE_USAGE_STORAGE_BIT | VK_IMAGE_USAGE_TRANSFER_SRC_BIT, colour)};
    const gpu::Buffer sources[] = {
        upload("normalRoughness data", g.normalRoughness), upload("albedo data", g.albedo),
        upload("specular data", g.specular), upload("depth data", g.depth)};
    const gpu::Image* targets[] = {&images.normalRoughness, &images.albedo, &images.specular,
                                   &images.depth};
    context().submitAndWait([&](VkCommandBuffer cmd) {
        for (size_t i = 0; i < 4; ++i) {
            const VkImageAspectFlags aspect =
                i == 3 ? VkImageAspectFlags(VK_IMAGE_ASPECT_DEPTH_BIT) : colour;
            fillImage(cmd, sources[i], targets[i]->image.get(), g.width, g.height, aspect);
        }
        transition(cmd, images.radiance.image.get(), colour, VK_IMAGE_LAYOUT_UNDEFINED,
                   VK_IMAGE_LAYOUT_GENERAL);
    });
    return images;
}

void LightingTest::clearRadiance(VkCommandBuffer cmd, const Images& images)
{
    const VkClearColorValue zero{};
    const VkImageSubresourceRange all{VK_IMAGE_ASPECT_COLOR_BIT, 0, 1, 0, 1};
    vkCmdClearColorImage(cmd, images.radiance.image.get(), VK_IMAGE_LAYOUT_GENERAL, &zero, 1, &all);
    fullBarrier(cmd);
}

CndLightingFrame LightingTest::frameOf(const CpuGBuffer& g, const Images& images,
                                       const RunOptions& options)
{
    CndLightingFrame frame = surfaceFrame<CndLightingFrame>(g, images);
    frame.specularMethod = options.specular;
    frame.sampleCount = options.sampleCount;
    frame.lobes = options.lobes;
    frame.energyCompensation = options.energyCompensation;
    frame.culling = options.culling;
    frame.influence = options.influence;
    frame.countPairs = options.countPairs;
    frame.layers = options.layers;
    frame.hostSet = options.hostSet;
    return frame;
}

std::vector<glm::vec4> LightingTest::readRadiance(const Images& images) const
{
    const std::vector<std::byte> bytes = readImage(images.radiance, VK_IMAGE_ASPECT_COLOR_BIT,
                                                   VK_IMAGE_LAYOUT_GENERAL, sizeof(glm::vec4));
    std::vector<glm::vec4> radiance(bytes.size() / sizeof(glm::vec4));
    std::memcpy(radiance.data(), bytes.data(), bytes.size());
    return radiance;
}

LightingTest::LightingAndView LightingTest::createLighting(const CpuGBuffer& g,
                                                           CndLightingDesc desc)
{
    CndError error{};
    desc.structSize = sizeof desc;
    CndLighting lighting{};
    EXPECT_EQ(cndCreateLighting(&deviceDesc(), &desc, &lighting, &error), CND_SUCCESS)
        << error.message;
    const CndLightingViewDesc viewDesc{sizeof viewDesc, g.width, g.height, 0};
    CndLightingView view{};
    EXPECT_EQ(cndCreateLightingView(lighting, &viewDesc, &view, &error), CND_SUCCESS)
        << error.message;
    return created_.emplace_back(LightingAndView{lighting, view});
}

LightingTest::LightingAndView LightingTest::createLighting(const CpuGBuffer& g,
                                                           uint32_t framesInFlight)
{
    return createLighting(g, CndLightingDesc{.framesInFlight = framesInFlight,
                                             .specularMethods = 1u << RunOptions{}.specular,
                                             .shading = CND_SHADING_CLUSTERED_BIT |
                                                        CND_SHADING_BRUTE_BIT |
                                                        CND_SHADING_COUNT_PAIRS_BIT});
}

void LightingTest::setLights(CndLighting lighting, const std::vector<CndLight>& lights)
{
    CndError error{};
    const CndLightSet set{
        .structSize = sizeof set, .count = uint32_t(lights.size()), .lights = lights.data()};
    EXPECT_EQ(cndSetLights(lighting, &set, &error), CND_SUCCESS) << error.message;
}

CndLightingStats LightingTest::statsOf(CndLightingView view, uint32_t frameSlot)
{
    CndLightingStats stats{.structSize = sizeof stats};
    EXPECT_EQ(cndGetLightingStats(view, frameSlot, &stats), CND_SUCCESS);
    return stats;
}

std::vector<glm::vec4> LightingTest::drawFrame(CndLightingView view, const CndLightingFrame& frame,
                                               const Images& images)
{
    context().submitAndWait([&](VkCommandBuffer cmd) {
        CndError error{};
        clearRadiance(cmd, images);
        EXPECT_EQ(cndRecordLighting(view, cmd, &frame, &error), CND_SUCCESS) << error.message;
    });
    return readRadiance(images);
}

void LightingTest::expectRefused(CndLightingView view, const CndLightingFrame& frame,
                                 const char* word)
{
    context().submitAndWait([&](VkCommandBuffer cmd) {
        CndError error{};
        EXPECT_EQ(cndRecordLighting(view, cmd, &frame, &error), CND_ERROR_INVALID_ARGUMENT);
        EXPECT_NE(std::string(error.message).find(word), std::string::npos) << error.message;
    });
}

void LightingTest::TearDown()
{
    for (const LightingAndView& created : created_) {
        cndDestroyLightingView(created.view);
        cndDestroyLighting(created.lighting);
    }
    GpuTest::TearDown();
}

// The number of frame slots that run() draws with in turn.
constexpr uint32_t runFramesInFlight = 2;

// Without a GPU, making pipelines takes longer than drawing with them, so tests begin with those of
// their first frame, and get others when a frame needs them. What a frame needs is what shadingOf
// of engine/shading/shade_kernels.h returns.
static uint32_t shadingOf(const CndLightingFrame& frame)
{
    const bool brute = frame.culling == CND_CULLING_BRUTE;
    return (brute ? CND_SHADING_BRUTE_BIT : CND_SHADING_CLUSTERED_BIT) |
           (frame.countPairs && !brute ? CND_SHADING_COUNT_PAIRS_BIT : 0);
}

CndLighting LightingTest::createFor(const RunOptions& options)
{
    const CndLightingDesc desc{.structSize = sizeof desc,
                               .framesInFlight = runFramesInFlight,
                               .gbufferLayout = options.layout,
                               .timestamps = true,
                               .specularMethods = 1u << options.specular,
                               .shading = CND_SHADING_CLUSTERED_BIT,
                               .gbuffer = options.gbuffer,
                               .diffuseOnlyTiles = options.diffuseOnlyTiles,
                               .hostKernels = options.hostKernels,
                               .influenceByError =
                                   options.influence.rule == CND_INFLUENCE_BY_ERROR};
    CndLighting lighting{};
    CndError error{};
    EXPECT_EQ(
        cndCreateLighting(options.host ? options.host : &deviceDesc(), &desc, &lighting, &error),
        CND_SUCCESS)
        << error.message;
    return lighting;
}

CndLighting LightingTest::lightingFor(const RunOptions& options)
{
    if (!shares(options))
        return createFor(options);
    static std::map<std::tuple<CndGBufferLayout, bool, bool>, CndLighting> shared;
    if (shared.empty())
        destroyAfterTests([] {
            for (const auto& [description, lighting] : shared)
                cndDestroyLighting(lighting);
        });
    const auto [found, isNew] =
        shared.try_emplace({options.layout, options.diffuseOnlyTiles,
                            options.influence.rule == CND_INFLUENCE_BY_ERROR});
    if (isNew)
        found->second = createFor(options);
    return found->second;
}

LightingResult LightingTest::run(const CpuGBuffer& g, const std::vector<CndLight>& lights,
                                 const RunOptions& options)
{
    const Images images = uploadImages(g);
    CndError error{};
    const CndLighting lighting = options.lighting ? options.lighting : lightingFor(options);
    const CndLightingViewDesc viewDesc{.structSize = sizeof viewDesc,
                                       .maxWidth = std::max(g.width, options.maxWidth),
                                       .maxHeight = g.height,
                                       .listBudget = options.listBudget,
                                       .shadowBudget = options.shadowBudget};
    CndLightingView view{};
    EXPECT_EQ(cndCreateLightingView(lighting, &viewDesc, &view, &error), CND_SUCCESS)
        << error.message;
    CndLightSet set{
        .structSize = sizeof set, .count = uint32_t(lights.size()), .lights = lights.data()};
    std::copy_n(options.lightOrigin, 3, set.origin);
    set.deviceLights = options.deviceLights;
    EXPECT_EQ(cndSetLights(lighting, &set, &error), CND_SUCCESS) << error.message;

    CndLightingFrame frame = frameOf(g, images, options);
    options.withFrame(frame);
    const uint32_t noMethod = 1u << CND_SPECULAR_DEFAULT;
    const CndLightingPipelines needed{.structSize = sizeof needed,
                                      .specularMethods = 1u << frame.specularMethod & ~noMethod,
                                      .shading = shadingOf(frame)};
    EXPECT_EQ(cndAddLightingPipelines(lighting, &needed, &error), CND_SUCCESS) << error.message;
    LightingResult result;
    for (int i = 0; i < options.frames; ++i) {
        frame.frameSlot = uint32_t(i) % runFramesInFlight;
        frame.surfacesUnchanged = options.unchanged && i > 0;
        options.beforeFrame();
        options.changeFrame(frame);
        result.radiance = drawFrame(view, frame, images);
    }
    result.stats = statsOf(view, frame.frameSlot);
    cndDestroyLightingView(view);
    if (!options.lighting && !shares(options))
        cndDestroyLighting(lighting);
    return result;
}

::testing::AssertionResult LightingTest::agree(const std::vector<glm::vec4>& a,
                                               const std::vector<glm::vec4>& b,
                                               double onLlvmpipe) const
{
    if (sameBits(a, b))
        return ::testing::AssertionSuccess();
    const double largest = device().lanesAreCpuVector ? onLlvmpipe : acrossPipelines;
    const double difference = maxRelativeDifference(a, b);
    return (a.size() == b.size() && largest > 0 && difference <= largest
                ? ::testing::AssertionSuccess()
                : ::testing::AssertionFailure())
           << "the images differ by " << difference << " of the largest radiance, at most "
           << largest << " is allowed";
}

bool sameBits(const std::vector<glm::vec4>& a, const std::vector<glm::vec4>& b)
{
    return a.size() == b.size() && !std::memcmp(a.data(), b.data(), a.size() * sizeof a[0]);
}

double maxRelativeDifference(const std::vector<glm::vec4>& a, const std::vector<glm::vec4>& b)
{
    double largest = 0, peak = 0;
    for (size_t i = 0; i < a.size(); ++i)
        for (int c = 0; c < 3; ++c) {
            const double difference = std::abs(double(a[i][c]) - b[i][c]);
            // Written so that a NaN counts as the largest difference.
            largest = !(difference <= largest) ? difference : largest;
            peak = std::max(peak, double(b[i][c]));
        }
    return peak > 0 ? largest / peak : largest;
}

} // namespace candelabra::test
