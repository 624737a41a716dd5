// SPDX-License-Identifier: Apache-2.0
// The lighting module through its C ABI: clustered against brute force and against the
// double-precision reference, lists without room, growth, invalid input.
#include "gpu/lighting_harness.h"
#include "harness/constants.h"
#include "harness/full_tests.h"

#include <cmath>
#include <numbers>
#include <tuple>

#include "reference/light.h"
#include "shared/specular_methods.h"

namespace candelabra::test
{
namespace
{

CndCamera defaultCamera(uint32_t width, uint32_t height)
{
    CndCamera camera;
    setPerspective(camera, 1.0, double(width) / height, 0.1);
    return camera;
}

double peak(const std::vector<glm::vec4>& image)
{
    double p = 0;
    for (const glm::vec4& v : image)
        p = std::max({p, double(v.x), double(v.y), double(v.z)});
    return p;
}

// Returns spheres, points, spots and directional lights, some of them uncut.
std::vector<CndLight> mixedLights(const CpuGBuffer& g, uint32_t count, uint32_t seed)
{
    std::vector<CndLight> lights = randomSpheres(g, count, seed);
    for (uint32_t i = 0; i < lights.size(); ++i) {
        CndLight& light = lights[i];
        light.type = i % 4;
        const float a = float(i);
        light.direction[0] = 0.6f * std::cos(a);
        light.direction[1] = 0.6f * std::sin(a);
        light.direction[2] = -0.8f;
        light.innerConeAngle = 0.2f;
        light.outerConeAngle = i % 8 == 2 ? float(std::numbers::pi / 2) : 0.7f;
        if (i % 5 == 0)
            light.influenceRadius = infinity;
    }
    return lights;
}

// Returns `light` as a tube, rectangle or disc of about its size.
CndLight everyAreaLight(CndLight light, size_t which)
{
    light.type = which % 3 == 0   ? uint32_t{CND_LIGHT_TUBE}
                 : which % 3 == 1 ? uint32_t{CND_LIGHT_RECTANGLE}
                                  : uint32_t{CND_LIGHT_DISC};
    light.axisU[0] = light.axisV[1] = light.radius;
    light.influenceRadius = std::max(light.influenceRadius, 3 * light.radius);
    return light;
}

} // namespace

class LightingSizes : public LightingTest,
                      public ::testing::WithParamInterface<std::tuple<glm::uvec2, uint32_t>>
{
};

TEST_P(LightingSizes, ClusteredEqualsBrute)
{
    const auto [size, count] = GetParam();
    const CpuGBuffer g = randomGBuffer(size.x, size.y, defaultCamera(size.x, size.y), 0, count + 1);
    for (const bool mixed : {false, true}) {
        const auto lights = mixed ? mixedLights(g, count, 7) : randomSpheres(g, count, 7);
        const LightingResult clustered = run(g, lights, {.countPairs = true});
        const LightingResult brute = run(g, lights, {.culling = CND_CULLING_BRUTE});
        EXPECT_TRUE(agree(clustered.radiance, brute.radiance, batchesOnLlvmpipe));
        EXPECT_EQ(clustered.stats.lightCount, count);
        EXPECT_EQ(clustered.stats.unlistedClusters, 0u);
        EXPECT_LE(clustered.stats.insidePairs, clustered.stats.listedPairs);
        EXPECT_LE(clustered.stats.contributingPairs, clustered.stats.insidePairs);
        if (count >= 33 && size.x > 17) {
            EXPECT_GT(peak(brute.radiance), 0);
        }
    }
}

INSTANTIATE_TEST_SUITE_P(Sizes, LightingSizes,
                         ::testing::Combine(::testing::Values(glm::uvec2(1, 1), glm::uvec2(17, 3),
                                                              glm::uvec2(64, 64),
                                                              glm::uvec2(203, 117)),
                                            ::testing::Values(0u, 1u, 33u, 700u)));

TEST_F(LightingTest, ClusteredEqualsBruteUnderEveryProjection)
{
    std::vector<std::pair<const char*, CndCamera>> cameras(7);
    const double deg = std::numbers::pi / 180;
    cameras[0].first = "1 degree";
    setPerspective(cameras[0].second, 1 * deg, 1.5, 0.1);
    cameras[1].first = "170 degrees";
    setPerspective(cameras[1].second, 170 * deg, 1.5, 0.01);
    cameras[2].first = "finite reversed";
    setPerspective(cameras[2].second, 60 * deg, 1.5, 0.1, 100);
    cameras[3].first = "finite standard";
    setPerspective(cameras[3].second, 60 * deg, 1.5, 0.1, 100, false);
    cameras[4].first = "infinite standard";
    setPerspective(cameras[4].second, 60 * deg, 1.5, 0.1, 0, false);
    cameras[5].first = "orthographic reversed";
    setOrthographic(cameras[5].second, 10, 1.5, 0.1, 100);
    cameras[6].first = "orthographic standard";
    setOrthographic(cameras[6].second, 10, 1.5, 0.1, 100, false);
    for (auto& [name, camera] : cameras) {
        const bool standard = std::string(name).find("standard") != std::string::npos;
        const CpuGBuffer g = randomGBuffer(120, 80, camera, standard ? 1.0f : 0.0f, 3);
        const auto lights = mixedLights(g, 300, 5);
        const LightingResult clustered = run(g, lights);
        const LightingResult brute = run(g, lights, {.culling = CND_CULLING_BRUTE});
        EXPECT_TRUE(agree(clustered.radiance, brute.radiance, batchesOnLlvmpipe)) << name;
        EXPECT_GT(peak(brute.radiance), 0) << name;
    }
}

TEST_F(LightingTest, EqualsDoublePrecisionReference)
{
    const CpuGBuffer g = randomGBuffer(96, 64, defaultCamera(96, 64), 0, 11);
    const auto lights = mixedLights(g, 60, 3);
    for (const CndSpecularMethod method : {CND_SPECULAR_NONE, CND_SPECULAR_KARIS}) {
        const LightingResult gpu = run(g, lights, {.specular = method});
        double worst = 0;
        size_t worstPixel = 0;
        for (size_t i = 0; i < g.depth.size(); ++i) {
            if (g.depth[i] == g.clearDepth) {
                EXPECT_EQ(gpu.radiance[i], glm::vec4(0)) << "background pixel " << i;
                continue;
            }
            const glm::dvec3 position =
                viewPosition(g, uint32_t(i % g.width), uint32_t(i / g.width));
            const glm::dvec4 specular = storedSpecular(g, i);
            const double roughness = storedRoughness(g, i);
            const reference::Material material{.diffuseAlbedo = storedAlbedo(g, i),
                                               .f0 = specular,
                                               .specularWeight = specular.w,
                                               .alpha = roughness * roughness};
            const reference::SurfacePoint surface{position, storedNormal(g, i),
                                                  glm::normalize(-position)};
            glm::dvec3 expected(0);
            for (const CndLight& light : lights)
                expected +=
                    reference::outgoingLuminance(surface, material, light, glm::dvec3(0), method);
            for (int c = 0; c < 3; ++c) {
                const double scale = expected[c] + 1e-3; // cd/m^2; the luminance of the lights is
                                                         // 0..1000
                const double error = std::abs(gpu.radiance[i][c] - expected[c]) / scale;
                if (!(error <= worst)) {
                    worst = error;
                    worstPixel = i;
                }
            }
        }
        // alpha >= 0.01 here: the bound is the float32 error of positions (1e-7 d) relative to the
        // narrowest lobe.
        EXPECT_LE(worst, 1e-3) << "method " << method << ", pixel " << worstPixel;
        std::cout << "largest relative error to double, method " << method << ": " << worst << "\n";
    }
}

TEST_F(LightingTest, ListsOverBudgetLoseNothing)
{
    const CpuGBuffer g = randomGBuffer(160, 96, defaultCamera(160, 96), 0, 2);
    const auto spheres = randomSpheres(g, 2000, 9);
    std::vector<CndLight> mixed = mixedLights(g, 600, 4);
    for (size_t i = 0; i < mixed.size(); i += 6) // include area lights
        mixed[i] = everyAreaLight(mixed[i], i / 6);
    for (const auto& [lights, method] :
         {std::pair(spheres, CND_SPECULAR_KARIS), std::pair(spheres, CND_SPECULAR_CONIC),
          std::pair(mixed, CND_SPECULAR_CONIC), std::pair(mixed, CND_SPECULAR_KARIS)}) {
        RunOptions options{.specular = method};
        const LightingResult whole = run(g, lights, options);
        options.listBudget = 4096;
        const LightingResult tiny = run(g, lights, options);
        EXPECT_EQ(whole.stats.unlistedClusters, 0u);
        EXPECT_GT(tiny.stats.unlistedClusters, 0u);
        EXPECT_LE(tiny.stats.listEntries, 1024u);
        EXPECT_TRUE(agree(whole.radiance, tiny.radiance));
    }
}

TEST_F(LightingTest, RunsAreBitIdentical)
{
    const CpuGBuffer g = randomGBuffer(203, 117, defaultCamera(203, 117), 0, 4);
    const auto lights = mixedLights(g, 900, 1);
    const LightingResult first = run(g, lights);
    const int runs = fullTests() ? 20 : 8;
    for (int i = 0; i < runs; ++i) // the first four with a new lighting each
        EXPECT_TRUE(sameBits(first.radiance,
                             run(g, lights, {.ownLighting = i < 4, .frames = i % 4 + 1}).radiance));
    // The schedule decides which lists find a page, and so which pipeline shades a cluster.
    for (int i = 0; i < 5; ++i)
        EXPECT_TRUE(agree(first.radiance, run(g, lights, {.listBudget = 100000}).radiance));
}

TEST_F(LightingTest, FarFromTheOriginLooksTheSame)
{
    CpuGBuffer g = randomGBuffer(96, 64, defaultCamera(96, 64), 0, 6);
    const auto lights = randomSpheres(g, 200, 6);
    const LightingResult near = run(g, lights);
    RunOptions far;
    const double place[3] = {1e6, -3e6, 7e6};
    for (int i = 0; i < 3; ++i) {
        far.lightOrigin[i] = place[i];
        g.camera.viewFromWorld[12 + i] = -place[i];
    }
    // Origin and camera cancel exactly in double precision, so the image must not change at all.
    EXPECT_TRUE(sameBits(near.radiance, run(g, lights, far).radiance));
}

TEST_F(LightingTest, LightSetGrowsAndShrinksAcrossFrames)
{
    const CpuGBuffer g = randomGBuffer(64, 48, defaultCamera(64, 48), 0, 8);
    const Images images = uploadImages(g);
    constexpr uint32_t framesInFlight = 3;
    const auto own = createLighting(g, framesInFlight);
    uint32_t slot = 0;
    for (const uint32_t count : {3u, 5000u, 0u, 100u, 20000u, 7u}) {
        const auto lights = randomSpheres(g, count, count);
        setLights(own.lighting, lights);
        CndLightingFrame frame = frameOf(g, images, {});
        frame.frameSlot = slot++ % framesInFlight;
        EXPECT_TRUE(sameBits(drawFrame(own.view, frame, images), run(g, lights).radiance)) << count;
    }
}

// Frames make only the pipelines that they need, so no other test makes all of them.
TEST_F(LightingTest, EveryPipelineIsMadeWithoutValidationMessages)
{
    const uint32_t allTypes = (1u << CND_LIGHT_TYPE_COUNT) - 1;
    const CndLightingDesc desc{
        .structSize = sizeof desc,
        .framesInFlight = 1,
        .specularMethods = fullTests() ? gpu::ALL_SPECULAR_METHODS : 1u << CND_SPECULAR_CONIC,
        .shading = 0, // all of it
        .diffuseOnlyTiles = VK_TRUE,
        .lightTypes = fullTests() ? allTypes : 1u << CND_LIGHT_SPHERE | 1u << CND_LIGHT_TUBE,
        .influenceByError = VK_TRUE};
    CndLighting lighting{};
    CndError error{};
    EXPECT_EQ(cndCreateLighting(&deviceDesc(), &desc, &lighting, &error), CND_SUCCESS)
        << error.message;
    cndDestroyLighting(lighting);
}

TEST_F(LightingTest, BadLightsAreRefusedByNameAndTheOldSetStays)
{
    const CpuGBuffer g = randomGBuffer(16, 16, defaultCamera(16, 16), 0, 8);
    CndError error{};
    const CndLightingDesc desc{.structSize = sizeof desc, .framesInFlight = 1};
    CndLighting lighting{};
    ASSERT_EQ(cndCreateLighting(&deviceDesc(), &desc, &lighting, &error), CND_SUCCESS)
        << error.message;
    struct Case {
        void (*spoil)(CndLight&, float value);
        const char* word;
    };
    const Case cases[] = {
        {[](CndLight& l, float n) { l.position[1] = n; }, "position"},
        {[](CndLight& l, float) { l.radius = 0; }, "radius"},
        {[](CndLight& l, float) { l.influenceRadius = l.radius; }, "influenceRadius"},
        {[](CndLight& l, float n) { l.influenceRadius = n; }, "influenceRadius"},
        {[](CndLight& l, float) { l.emission[2] = -1; }, "emission"},
        {[](CndLight& l, float) { l.emission[0] = infinity; }, "emission"},
        {[](CndLight& l, float) { l.type = 99; }, "type"},
        {[](CndLight& l, float) { l.type = CND_LIGHT_DIRECTIONAL; }, "direction"},
        {[](CndLight& l, float) {
             l.type = CND_LIGHT_SPOT;
             l.direction[2] = 1;
             l.innerConeAngle = l.outerConeAngle = 0.5f;
         },
         "cone"},
        {[](CndLight& l, float) {
             l.type = CND_LIGHT_SPOT;
             l.direction[2] = 1;
             l.outerConeAngle = 0.5f;
             l.innerConeAngle = 0.5f - 0.5f * CND_MIN_CONE_EDGE;
         },
         "CND_MIN_CONE_EDGE"},
    };
    auto lights = randomSpheres(g, 3, 1);
    const CndLightSet set{sizeof set, 3, lights.data(), {}};
    for (const Case& c : cases) {
        const CndLight good = lights[1];
        c.spoil(lights[1], nan);
        EXPECT_EQ(cndSetLights(lighting, &set, &error), CND_ERROR_INVALID_ARGUMENT) << c.word;
        EXPECT_NE(std::string(error.message).find("lights[1]"), std::string::npos) << error.message;
        EXPECT_NE(std::string(error.message).find(c.word), std::string::npos) << error.message;
        lights[1] = good;
    }
    EXPECT_EQ(cndSetLights(lighting, &set, &error), CND_SUCCESS);
    cndDestroyLighting(lighting);
}

TEST_F(LightingTest, ReceiverAtCentreInsideAndOnTheSphereIsFinite)
{
    const CpuGBuffer g = randomGBuffer(32, 32, defaultCamera(32, 32), 0, 1);
    const float roughly[] = {0.5f, 1 - 1e-6f, 1, 1 + 1e-6f, 2, 1e6f};
    for (size_t pixel = 0; pixel < g.depth.size(); pixel += 37) {
        if (g.depth[pixel] == g.clearDepth)
            continue;
        const glm::dvec3 p = viewPosition(g, uint32_t(pixel % g.width), uint32_t(pixel / g.width));
        const glm::dvec3 n = storedNormal(g, pixel);
        std::vector<CndLight> lights;
        for (const float x : roughly)
            for (const double offset : {0.0, 1.0, -1.0}) {
                const glm::dvec3 c = p + n * offset * double(x) * 0.25;
                CndLight light{.type = CND_LIGHT_SPHERE,
                               .position = {float(c.x), float(c.y), float(c.z)},
                               .radius = 0.25f,
                               .emission = {1e9f, 1, 1e-8f},
                               .influenceRadius = infinity};
                lights.push_back(light);
            }
        for (const glm::vec4& v : run(g, lights).radiance)
            for (int c = 0; c < 3; ++c)
                ASSERT_TRUE(v[c] >= 0 && v[c] < infinity) << v[c];
        return;
    }
}

} // namespace candelabra::test
