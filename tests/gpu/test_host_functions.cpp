// SPDX-License-Identifier: Apache-2.0
// Tests functions of a host in the kernels (candelabra/compiler.h): its shadow term multiplies each
// light by id, and a G-buffer that it reads itself is lit like the same surfaces in a built-in
// layout.
#include <cmath>
#include <cstdlib>
#include <string>

#include "candelabra/compiler.hpp"
#include "gpu/environment_harness.h"
#include "gpu/fill_image.h"
#include "gpu/gpu_like_device.h"
#include "gpu/host_surface.h"
#include "harness/full_tests.h"

namespace candelabra::test
{
namespace
{

// A light as the shadow term expects it, and how much of it is visible.
struct Shadow {
    glm::vec3 centre; // for distant lights the unit vector towards the light
    float visible;
    uint32_t type;
};

// A shadow term that also checks its query: if the light is not the expected one, it returns too
// much light.
constexpr const char* shadowSource = R"(
struct Shadow { vec3 centre; float visible; uint type; };
layout(scalar, set = 1, binding = 0) readonly buffer Shadows { Shadow shadows[]; };
float candelabraVisibility(CndShadowQuery q)
{
    const Shadow s = shadows[q.light & ~CND_LIGHT_OF_DEVICE];
    const bool distant = s.type == CND_LIGHT_DIRECTIONAL || s.type == CND_LIGHT_DISTANT_SPHERE;
    const vec3 centre = distant ? q.toLight : q.position + q.toLight;
    const bool right = q.type == s.type && distance(centre, s.centre) < 1e-3 &&
                       abs(length(q.normal) - 1.0) < 1e-3;
    return right ? s.visible : 7.0;
}
)";

CompiledKernels compiled(CndCompileDesc desc)
{
    auto kernels = CompiledKernels::create(desc);
    EXPECT_TRUE(kernels) << kernels.error().message;
    return kernels ? std::move(kernels.value()) : CompiledKernels();
}

class HostFunctions : public EnvironmentTest
{
protected:
    void SetUp() override
    {
        EnvironmentTest::SetUp();
        if (IsSkipped() || HasFatalFailure())
            return;
        g_ = randomGBuffer(64, 48, 3);
        shadowSet_ = gpu::Bindings(device(), "shadows", {{0, VK_DESCRIPTOR_TYPE_STORAGE_BUFFER, 1}},
                                   VK_SHADER_STAGE_COMPUTE_BIT, 1);
        shadows_ = gpu::createBuffer(device(), "shadows", 1000 * sizeof(Shadow),
                                     VK_BUFFER_USAGE_STORAGE_BUFFER_BIT, gpu::MemoryUse::Upload);
        shadowSet_.write(0, {gpu::Binding::of(0, shadows_)});
    }
    void TearDown() override
    {
        shadowSet_ = {};
        shadows_ = {};
        images_ = {};
        EnvironmentTest::TearDown();
    }
    // Sets the visibility of the light with this id; returns the light as it then appears.
    CndLight shadowed(CndLightId id, CndLight light)
    {
        constexpr float parts[] = {0, 0.25f, 0.5f, 1}; // factors that multiply without rounding
        const float visible = parts[(id * 7 + light.type) % 4];
        const bool distant = cndIsDistant(light.type);
        const float* p = distant ? light.direction : light.position;
        shadows_.as<Shadow>()[uint32_t(id)] = {
            (distant ? -1.0f : 1.0f) * glm::vec3(p[0], p[1], p[2]), visible, light.type};
        for (float& e : light.emission)
            e *= visible;
        return light;
    }
    RunOptions withShadows(const CompiledKernels& kernels, RunOptions options = {}) const
    {
        options.hostKernels = kernels.hostKernels(shadowSet_.layout());
        options.hostSet = shadowSet_.set(0);
        return options;
    }

    LightingAndView create(const RunOptions& options)
    {
        images_ = uploadImages(g_);
        return createLighting(g_, CndLightingDesc{.framesInFlight = 1,
                                                  .gbufferLayout = options.layout,
                                                  .specularMethods = 1u << options.specular,
                                                  .shading = CND_SHADING_CLUSTERED_BIT |
                                                             CND_SHADING_BRUTE_BIT |
                                                             CND_SHADING_COUNT_PAIRS_BIT,
                                                  .gbuffer = options.gbuffer,
                                                  .hostKernels = options.hostKernels});
    }
    CndLightingView createNarrowView(CndLighting lighting)
    {
        CndError error{};
        const CndLightingViewDesc desc{sizeof desc, g_.width, g_.height, 4096};
        CndLightingView view{};
        EXPECT_EQ(cndCreateLightingView(lighting, &desc, &view, &error), CND_SUCCESS)
            << error.message;
        return view;
    }
    // Puts linear depths, in metres, in place of images_.depth.
    void storeLinearDepth()
    {
        std::vector<float> distances;
        for (uint32_t y = 0; y < g_.height; ++y)
            for (uint32_t x = 0; x < g_.width; ++x)
                distances.push_back(g_.depth[size_t(y) * g_.width + x] == g_.clearDepth
                                        ? g_.clearDepth
                                        : float(-viewPosition(g_, x, y).z));
        const gpu::Buffer data = upload("linear depth data", distances);
        images_.depth =
            gpu::createImage(device(), "linear depth", VK_FORMAT_R32_SFLOAT, g_.width, g_.height,
                             VK_IMAGE_USAGE_SAMPLED_BIT | VK_IMAGE_USAGE_TRANSFER_DST_BIT,
                             VK_IMAGE_ASPECT_COLOR_BIT);
        context().submitAndWait([&](VkCommandBuffer cmd) {
            fillImage(cmd, data, images_.depth.image.get(), g_.width, g_.height);
        });
    }
    std::vector<glm::vec4> frame(CndLightingView view, const RunOptions& options)
    {
        return drawFrame(view, frameOf(g_, images_, options), images_);
    }

    // Returns the picture of what is read from the G-buffer.
    std::vector<std::byte> overlay(CndLightingView view, const RunOptions& options)
    {
        const gpu::Image picture =
            gpu::createImage(device(), "overlay", VK_FORMAT_R8G8B8A8_UNORM, g_.width, g_.height,
                             VK_IMAGE_USAGE_STORAGE_BIT | VK_IMAGE_USAGE_TRANSFER_SRC_BIT,
                             VK_IMAGE_ASPECT_COLOR_BIT);
        const CndLightingFrame f = frameOf(g_, images_, options);
        const CndSurfaceOverlay all{sizeof all, CND_SURFACE_ALL, picture.view.get()};
        CndError error{};
        context().submitAndWait([&](VkCommandBuffer cmd) {
            transition(cmd, picture.image.get(), VK_IMAGE_ASPECT_COLOR_BIT,
                       VK_IMAGE_LAYOUT_UNDEFINED, VK_IMAGE_LAYOUT_GENERAL);
            EXPECT_EQ(cndRecordSurfaceOverlay(view, cmd, &f, &all, &error), CND_SUCCESS)
                << error.message;
        });
        return readImage(picture, VK_IMAGE_ASPECT_COLOR_BIT, VK_IMAGE_LAYOUT_GENERAL, 4);
    }

    CpuGBuffer g_;
    Images images_;
    gpu::Bindings shadowSet_;
    gpu::Buffer shadows_;
};

// With lists, with no room for lists, and with every light at every pixel.
TEST_F(HostFunctions, AShadowTermScalesEachLightById)
{
    // Kernels take long to create. The other types differ from these in their formulas alone.
    const uint32_t types = fullTests() ? (1u << CND_LIGHT_TYPE_COUNT) - 1
                                       : 1u << CND_LIGHT_SPHERE | 1u << CND_LIGHT_RECTANGLE |
                                             1u << CND_LIGHT_SPOT | 1u << CND_LIGHT_DISTANT_SPHERE;
    const CompiledKernels kernels = compiled({.functions = CND_HOST_VISIBILITY_BIT,
                                              .source = shadowSource,
                                              .lightTypes = types,
                                              .specularMethods = 1u << RunOptions{}.specular});
    const RunOptions options = withShadows(kernels);
    const auto [lighting, view] = create(options);
    const CndLightingView narrow = createNarrowView(lighting);
    std::vector<CndLight> lights, scaled;
    for (uint32_t type = 0; type < CND_LIGHT_TYPE_COUNT; ++type) {
        if (!(types >> type & 1))
            continue;
        for (const CndLight& light : lightsOf(CndLightType(type), g_, 20, 40 + type)) {
            scaled.push_back(shadowed(lights.size(), light));
            lights.push_back(light);
        }
    }
    setLights(lighting, lights);
    const std::vector<glm::vec4> image = frame(view, options);
    EXPECT_TRUE(agree(frame(narrow, options), image));
    EXPECT_GT(statsOf(narrow).unlistedClusters, 0u);
    RunOptions brute = options;
    brute.culling = CND_CULLING_BRUTE;
    EXPECT_TRUE(agree(frame(view, brute), image));
    for (size_t id = 0; id < lights.size(); ++id)
        shadows_.as<Shadow>()[id].visible = 1;
    EXPECT_FALSE(sameBits(frame(view, options), image));
    setLights(lighting, scaled);
    EXPECT_TRUE(sameBits(frame(view, options), image));
    cndDestroyLightingView(narrow);
}

// The form of shading that GPUs run asks the shadow term for the same lights.
TEST_F(HostFunctions, FormsForGpusAskTheShadowTermAlike)
{
    const CompiledKernels kernels = compiled({.functions = CND_HOST_VISIBILITY_BIT,
                                              .source = shadowSource,
                                              .lightTypes = 1u << CND_LIGHT_SPHERE});
    const std::vector<CndLight> lights = lightsOf(CND_LIGHT_SPHERE, g_, 300, 41);
    std::vector<CndLight> scaled;
    for (const CndLight& light : lights)
        scaled.push_back(shadowed(scaled.size(), light));
    const RunOptions plain{.specular = CND_SPECULAR_CONIC};
    RunOptions options = withShadows(kernels, plain);
    const LightingResult alone = run(g_, lights, options);
    EXPECT_TRUE(agree(alone.radiance, run(g_, scaled, plain).radiance));
    EXPECT_FALSE(sameBits(alone, run(g_, lights, plain)));
    const CndDeviceDesc gpu = gpuLike(deviceDesc());
    options.host = &gpu;
    EXPECT_TRUE(sameBits(run(g_, lights, options), alone));
}

// Ids of lights that are added and removed, and of lights on the device. Compares with kernels
// without a shadow term and lights that are scaled instead.
TEST_F(HostFunctions, IdsStayThroughEdits)
{
    const CompiledKernels kernels = compiled({.functions = CND_HOST_VISIBILITY_BIT,
                                              .source = shadowSource,
                                              .lightTypes = 1u << CND_LIGHT_POINT,
                                              .specularMethods = 1u << RunOptions{}.specular});
    const RunOptions options = withShadows(kernels);
    const LightingAndView own = create(options);
    const LightingAndView plain = create({});
    std::vector<CndLight> lights = randomSpheres(g_, 120, 9);
    for (size_t i = 0; i < lights.size(); i += 2)
        lights[i].type = CND_LIGHT_POINT;
    std::vector<CndLightId> ids(lights.size());
    CndError error{};
    const auto add = [&](size_t first, size_t count) {
        EXPECT_EQ(cndAddLights(own.lighting, uint32_t(count), &lights[first], &ids[first], &error),
                  CND_SUCCESS);
        std::vector<CndLight> scaled;
        for (size_t i = first; i < first + count; ++i)
            scaled.push_back(shadowed(ids[i], lights[i]));
        std::vector<CndLightId> same(count);
        EXPECT_EQ(cndAddLights(plain.lighting, uint32_t(count), scaled.data(), same.data(), &error),
                  CND_SUCCESS);
        EXPECT_TRUE(std::equal(same.begin(), same.end(), ids.begin() + long(first)));
    };
    add(0, 60);
    const std::vector<glm::vec4> before = frame(plain.view, {});
    EXPECT_TRUE(agree(frame(own.view, options), before));
    for (const CndLighting each : {own.lighting, plain.lighting})
        EXPECT_EQ(cndRemoveLights(each, 20, &ids[5], &error), CND_SUCCESS) << error.message;
    add(60, 30);                        // some reuse the places of removed lights
    std::swap(lights[40], lights[100]); // another light under the same id
    const CndLight scaled = shadowed(ids[40], lights[40]);
    EXPECT_EQ(cndUpdateLights(own.lighting, 1, &ids[40], &lights[40], &error), CND_SUCCESS);
    EXPECT_EQ(cndUpdateLights(plain.lighting, 1, &ids[40], &scaled, &error), CND_SUCCESS);
    const std::vector<glm::vec4> edited = frame(plain.view, {});
    EXPECT_TRUE(agree(frame(own.view, options), edited));
    EXPECT_FALSE(sameBits(edited, before));

    const std::vector<CndLight> onDevice = randomSpheres(g_, 3, 10);
    const gpu::Buffer buffer =
        gpu::createBuffer(device(), "particles", onDevice.size() * sizeof(CndDeviceLight),
                          VK_BUFFER_USAGE_STORAGE_BUFFER_BIT, gpu::MemoryUse::Upload);
    std::vector<CndLight> seen;
    for (size_t i = 0; i < onDevice.size(); ++i) {
        const CndLight& l = onDevice[i];
        buffer.as<CndDeviceLight>()[i] = {{l.position[0], l.position[1], l.position[2]},
                                          l.radius,
                                          {l.emission[0], l.emission[1], l.emission[2]},
                                          l.influenceRadius};
        seen.push_back(shadowed(i, l));
    }
    const CndDeviceLights device{.type = CND_LIGHT_SPHERE,
                                 .maxCount = uint32_t(onDevice.size()),
                                 .buffer = buffer.get(),
                                 .boundsMin = {-10, -10, -20},
                                 .boundsMax = {10, 10, 0},
                                 .influenceRadius = 2};
    const CndLightSet particles{.structSize = sizeof particles, .deviceLights = &device};
    EXPECT_EQ(cndSetLights(own.lighting, &particles, &error), CND_SUCCESS) << error.message;
    setLights(plain.lighting, seen);
    const std::vector<glm::vec4> fromDevice = frame(own.view, options);
    EXPECT_TRUE(agree(fromDevice, frame(plain.view, {}), 1e-6));
}

TEST_F(HostFunctions, ASurfaceThatTheHostReadsIsLitLikeOneOfOurLayout)
{
    const CompiledKernels kernels = compiled({.functions = CND_HOST_READ_SURFACE_BIT,
                                              .source = surfaceSource,
                                              .lightTypes = 1u << CND_LIGHT_SPHERE,
                                              .specularMethods = 1u << RunOptions{}.specular});
    images_ = uploadImages(g_);
    const Images read = uploadImages(g_);
    const gpu::Bindings host = surfaceSet(device(), read);
    RunOptions options{.layout = CND_GBUFFER_CUSTOM,
                       .hostKernels = kernels.hostKernels(host.layout()),
                       .hostSet = host.set(0)};
    const std::vector<CndLight> lights = randomSpheres(g_, 200, 9);
    const auto [lighting, view] = create(options);
    const auto [plain, plainView] = create({});
    setLights(lighting, lights);
    setLights(plain, lights);
    const std::vector<glm::vec4> expected = frame(plainView, {.countPairs = true});
    const std::vector<std::byte> ours = overlay(plainView, {});
    images_.normalRoughness.view = {}; // only the depth image may be used
    images_.albedo.view = {};
    images_.specular.view = {};
    options.countPairs = true;
    const std::vector<glm::vec4> clustered = frame(view, options);
    const CndLightingStats stats[2]{statsOf(view), statsOf(plainView)};
    // Normals are normalised once more, so a light at the horizon may count in only one of the two.
    EXPECT_LE(maxRelativeDifference(clustered, expected), 1e-4);
    EXPECT_NEAR(double(stats[0].contributingPairs), double(stats[1].contributingPairs), 5);
    EXPECT_GT(stats[0].contributingPairs, 100u);
    options.culling = CND_CULLING_BRUTE;
    EXPECT_TRUE(agree(frame(view, options), clustered));
    const std::vector<std::byte> theirs = overlay(view, options);
    int largest = 0;
    for (size_t i = 0; i < ours.size(); ++i)
        largest = std::max(largest, std::abs(int(ours[i]) - int(theirs[i])));
    EXPECT_LE(largest, 1);
    EXPECT_EQ(theirs.size(), ours.size());

    const EnvironmentImage sky = imageOf([](const glm::dvec3& d) { return 2 + d.y; }, 64);
    setImage(sky, 64);
    const std::vector<glm::vec4> underSky = shade(g_);
    setImage(sky, 64, nullptr, &options.hostKernels);
    CndEnvironmentFrame environment = environmentFrame(g_, images_, {});
    CndError error{};
    context().submitAndWait([&](VkCommandBuffer cmd) {
        clearRadiance(cmd, images_);
        EXPECT_EQ(cndRecordEnvironment(environment_, cmd, &environment, &error),
                  CND_ERROR_INVALID_ARGUMENT);
        EXPECT_STREQ(error.message, "CndEnvironmentFrame: hostSet is null, but kernels of "
                                    "CndHostKernels use descriptor set 1");
        environment.hostSet = options.hostSet;
        EXPECT_EQ(cndRecordEnvironment(environment_, cmd, &environment, &error), CND_SUCCESS)
            << error.message;
    });
    EXPECT_LE(maxRelativeDifference(readRadiance(images_), underSky), 1e-4);
}

// The module turns linear depths into depth for hosts' functions too.
TEST_F(HostFunctions, ASurfaceThatTheHostReadsMayHaveLinearDepth)
{
    const CompiledKernels kernels = compiled({.functions = CND_HOST_READ_SURFACE_BIT,
                                              .source = surfaceSource,
                                              .lightTypes = 1u << CND_LIGHT_SPHERE,
                                              .specularMethods = 1u << RunOptions{}.specular});
    const Images read = uploadImages(g_);
    const gpu::Bindings host = surfaceSet(device(), read);
    const RunOptions options{
        .layout = CND_GBUFFER_CUSTOM,
        .gbuffer = {.depthFormat = VK_FORMAT_R32_SFLOAT, .depthKind = CND_DEPTH_LINEAR},
        .hostKernels = kernels.hostKernels(host.layout()),
        .hostSet = host.set(0)};
    const std::vector<CndLight> lights = randomSpheres(g_, 200, 9);
    const auto [plain, plainView] = create({});
    setLights(plain, lights);
    const std::vector<glm::vec4> expected = frame(plainView, {});
    const auto [lighting, view] = create(options);
    setLights(lighting, lights);
    storeLinearDepth();
    EXPECT_LE(maxRelativeDifference(frame(view, options), expected), 1e-4);
}

// A set layout alone requires no set. A shadow term does not affect the environment, which needs no
// set for it.
TEST_F(HostFunctions, ASetIsNeededWhereAKernelUsesIt)
{
    CndCompileDesc desc{.functions = CND_HOST_VISIBILITY_BIT,
                        .source = shadowSource,
                        .lightTypes = 1u << CND_LIGHT_SPHERE,
                        .specularMethods = 1u << RunOptions{}.specular};
    const CompiledKernels byId = compiled(desc);
    const EnvironmentImage sky = imageOf([](const glm::dvec3& d) { return 2 + d.y; }, 64);
    setImage(sky, 64);
    const std::vector<glm::vec4> underSky = shade(g_);
    const CndHostKernels withSet = byId.hostKernels(shadowSet_.layout());
    setImage(sky, 64, nullptr, &withSet, CND_GBUFFER_FULL);
    EXPECT_TRUE(agree(shade(g_), underSky));

    desc.source = "float candelabraVisibility(CndShadowQuery q) { return 1.0; }";
    const CompiledKernels plain = compiled(desc);
    const std::vector<CndLight> lights = randomSpheres(g_, 20, 9);
    EXPECT_TRUE(
        agree(run(g_, lights, {.hostKernels = plain.hostKernels(shadowSet_.layout())}).radiance,
              run(g_, lights).radiance));
}

TEST_F(HostFunctions, WhatIsMissingOrForeignIsNamed)
{
    const CompiledKernels kernels = compiled({.functions = CND_HOST_VISIBILITY_BIT,
                                              .source = shadowSource,
                                              .lightTypes = 1u << CND_LIGHT_SPHERE,
                                              .specularMethods = 1u << RunOptions{}.specular});
    const RunOptions options = withShadows(kernels);
    const auto refused = [&](const char* named, const CndHostKernels& host,
                             CndGBufferLayout layout = CND_GBUFFER_FULL) {
        const CndLightingDesc desc{.structSize = sizeof desc,
                                   .framesInFlight = 1,
                                   .gbufferLayout = layout,
                                   .specularMethods = 1u << RunOptions{}.specular,
                                   .hostKernels = host};
        CndLighting lighting{};
        CndError error{};
        EXPECT_EQ(cndCreateLighting(&deviceDesc(), &desc, &lighting, &error),
                  CND_ERROR_INVALID_ARGUMENT);
        EXPECT_NE(std::string(error.message).find(named), std::string::npos) << error.message;
    };
    const CndKernelCode tiles = options.hostKernels.kernels[0];
    refused("kernels is null", {1, nullptr, VK_NULL_HANDLE});
    refused("setLayout is null", kernels.hostKernels());
    refused("tile_clusters is missing", options.hostKernels, CND_GBUFFER_CUSTOM);
    CndKernelCode code = tiles;
    const auto alone = [&] { return CndHostKernels{1, &code, shadowSet_.layout()}; };
    refused("shade_unlisted:SPHERE is missing", alone());
    code.name = "shade_moon";
    refused("there is no kernel shade_moon", alone());
    code.name = "shade_unlisted:SPHERE";
    refused("other bindings", alone());
    code = tiles;
    code.wordCount -= 1;
    refused("is not SPIR-V", alone());
    code.wordCount = 3;
    refused("is not SPIR-V", alone());

    const LightingAndView own = create(options);
    CndError error{};
    CndLightId id{};
    const CndLight tube = lightsOf(CND_LIGHT_TUBE, g_, 1, 1)[0];
    EXPECT_EQ(cndAddLights(own.lighting, 1, &tube, &id, &error), CND_ERROR_INVALID_ARGUMENT);
    EXPECT_NE(std::string(error.message).find("shade_tiles:TUBE is missing"), std::string::npos)
        << error.message;
    expectRefused(own.view, frameOf(g_, images_, {}), "hostSet is null");
}

} // namespace
// The host's shadow term multiplies the shadows of occluders.
TEST_F(HostFunctions, AShadowTermMultipliesShadowsOfOccluders)
{
    const CompiledKernels kernels =
        compiled({.functions = CND_HOST_VISIBILITY_BIT,
                  .source = "float candelabraVisibility(CndShadowQuery q) { return 0.5; }",
                  .lightTypes = 1u << CND_LIGHT_SPHERE,
                  .shadows = VK_TRUE});
    auto lights = randomSpheres(g_, 20, 3);
    for (CndLight& light : lights) { // near the camera, which is in front of the occluder
        light.position[2] = -1;
        light.influenceRadius = INFINITY;
    }
    const float positions[] = {-2, -2, -2, 2, -2, -2, 0, 2, -2};
    const CndOccluderMesh mesh{.positions = positions, .vertexCount = 3, .triangleCount = 1};
    const Images images = uploadImages(g_);
    std::vector<glm::vec4> drawn[2];
    for (int ofHost = 0; ofHost < 2; ++ofHost) {
        const auto own = createLighting(
            g_, CndLightingDesc{.framesInFlight = 1,
                                .specularMethods = 1u << CND_SPECULAR_CONIC,
                                .shading = CND_SHADING_CLUSTERED_BIT,
                                .hostKernels = ofHost ? kernels.hostKernels() : CndHostKernels{},
                                .shadows = {.points = 64}});
        setLights(own.lighting, lights);
        const CndLightingFrame frame =
            frameOf(g_, images, {.specular = CND_SPECULAR_CONIC, .hostSet = shadowSet_.set(0)});
        const auto unshadowed = drawFrame(own.view, frame, images);
        CndOccluderInstance instance{.worldFromMesh = {1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0}};
        CndOccluderId id = 0;
        CndError error{};
        ASSERT_EQ(cndAddOccluderMeshes(own.lighting, 1, &mesh, &instance.mesh, &error), CND_SUCCESS)
            << error.message;
        ASSERT_EQ(cndAddOccluders(own.lighting, 1, &instance, &id, &error), CND_SUCCESS)
            << error.message;
        drawn[ofHost] = drawFrame(own.view, frame, images);
        EXPECT_FALSE(sameBits(drawn[ofHost], unshadowed));
    }
    for (glm::vec4& pixel : drawn[1])
        pixel *= 2;
    EXPECT_TRUE(agree(drawn[0], drawn[1]));
}

} // namespace candelabra::test
