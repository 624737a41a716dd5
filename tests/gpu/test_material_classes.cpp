// SPDX-License-Identifier: Apache-2.0
// Tiles without a specular lobe are shaded without it, and must look the same.
#include <algorithm>
#include <cmath>
#include <iostream>

#include "gpu/host_gbuffer_harness.h"
#include "gpu/pixel_difference.h"
#include "gpu/two_classes.h"
#include "harness/full_tests.h"

namespace candelabra::test
{
namespace
{

// Tolerance per pixel on llvmpipe: the formulas are the same, but in another order. Other drivers
// may fuse and round each pipeline in its own way. There a dark pixel whose sphere is cut by the
// horizon, far outside of its narrow lobe, differs by a part of itself, as it does if its position
// changes by an ulp, and what is compared is what the engine promises (LightingTest::agree).
constexpr double classTolerance = 1e-5;

// Converts surfaces to the COMPACT layout: base colour and metalness, normals with 12 bits per
// component.
CpuGBuffer compact(CpuGBuffer g)
{
    const auto coordinate = [](uint32_t code) {
        const double u = double(int32_t(code << 9) >> 9) / ((1 << 22) - 1);
        return uint32_t(std::lround(u * 2047)) & 0xFFFu;
    };
    for (size_t i = 0; i < g.depth.size(); ++i) {
        const uint32_t roughness = uint32_t(std::lround(255 * storedRoughness(g, i)));
        const glm::uvec2 code = g.normalRoughness[i];
        g.normalRoughness[i] = {coordinate(code.x) | coordinate(code.y) << 12 | roughness << 24, 0};
        const glm::vec3 base(storedAlbedo(g, i));
        g.albedo[i] = {glm::packHalf2x16({base.r, base.g}), glm::packHalf2x16({base.b, 0})};
    }
    g.albedoFormat = VK_FORMAT_R16G16B16A16_SFLOAT;
    return g;
}

// Converts surfaces to the layout of a host that stores diffuse and specular colour separately.
HostPixels hostPixels(const CpuGBuffer& g, const CndGBufferDesc& desc)
{
    HostPixels out{.desc = desc, .width = g.width, .height = g.height};
    for (size_t i = 0; i < g.depth.size(); ++i) {
        const glm::dvec4 texels[] = {glm::dvec4(storedNormal(g, i), storedRoughness(g, i)),
                                     glm::dvec4(storedAlbedo(g, i), 0), storedSpecular(g, i)};
        for (int image = 0; image < 3; ++image)
            appendTexel(out.images[image], VK_FORMAT_R32G32B32A32_SFLOAT, texels[image]);
        appendDepth(out.depth, desc.depthFormat, double(g.depth[i]));
    }
    return out;
}

constexpr CndGBufferDesc floatChannels(CndGBufferChannel f90)
{
    return {.normalEncoding = CND_NORMAL_SNORM,
            .normalSpace = CND_NORMALS_VIEW,
            .roughness = CND_CHANNEL_NORMAL_A,
            .reflectance = CND_REFLECTANCE_SPECULAR,
            .f90 = f90,
            .normalRoughnessFormat = VK_FORMAT_R32G32B32A32_SFLOAT,
            .albedoFormat = VK_FORMAT_R32G32B32A32_SFLOAT,
            .specularFormat = VK_FORMAT_R32G32B32A32_SFLOAT,
            .depthFormat = VK_FORMAT_R32_SFLOAT};
}

bool keptLists(const CndLightingStats& stats)
{
    return std::any_of(stats.passes, stats.passes + stats.passCount, [](const CndPassPlan& pass) {
        return std::string(pass.name) == "tile_clusters" && pass.skipped;
    });
}

struct ClassCase {
    const char* name;
    RunOptions options;
    CndLightType lights = CND_LIGHT_SPHERE;
    bool diffuseClass = true; // whether the layout can store it
};

const ClassCase classCases[] = {
    {"CompactLayout", {.layout = CND_GBUFFER_COMPACT}, CND_LIGHT_SPHERE, false},
    {"HostLayout", {.layout = CND_GBUFFER_HOST, .gbuffer = floatChannels(CND_CHANNEL_SPECULAR_A)}},
    {"HostLayoutWithoutF90",
     {.layout = CND_GBUFFER_HOST, .gbuffer = floatChannels(CND_CHANNEL_NONE)},
     CND_LIGHT_SPHERE,
     false},
    {"NoSpecular", {.specular = CND_SPECULAR_NONE}},
    {"Rectangles", {.specular = CND_SPECULAR_CONIC}, CND_LIGHT_RECTANGLE},
    {"Sampled", {.specular = CND_SPECULAR_SAMPLED, .sampleCount = 4}},
};

class MaterialClasses : public HostGBufferTest, public ::testing::WithParamInterface<ClassCase>
{
};

} // namespace

TEST_P(MaterialClasses, LookTheSame)
{
    RunOptions options = GetParam().options;
    CpuGBuffer g = twoClasses(72, 48);
    const std::vector<CndLight> lights = lightsOf(GetParam().lights, g, 40, 7);
    HostImages images;
    if (options.layout == CND_GBUFFER_HOST) {
        images = uploadHost(hostPixels(g, options.gbuffer));
        options.withFrame = [&](CndLightingFrame& frame) { frame = withHost(frame, images); };
    }
    if (options.layout == CND_GBUFFER_COMPACT)
        g = compact(std::move(g));
    options.countPairs = true;
    const LightingResult together = run(g, lights, options);
    options.diffuseOnlyTiles = true;
    const LightingResult apart = run(g, lights, options);
    const double difference = maxPixelDifference(apart.radiance, together.radiance);
    std::cout << GetParam().name << ": largest difference of a pixel " << difference << '\n';
    EXPECT_TRUE(device().lanesAreCpuVector ? difference <= classTolerance
                                           : agree(apart.radiance, together.radiance));
    EXPECT_GT(apart.stats.contributingPairs, 0u);
    // Three columns of six tiles, without the row that has other pixels; fewer if a tile has no
    // surface.
    EXPECT_EQ(apart.stats.diffuseTileCount > 8, GetParam().diffuseClass);
    EXPECT_LE(apart.stats.diffuseTileCount, GetParam().diffuseClass ? 15u : 0u);
    EXPECT_EQ(apart.stats.tileCount, together.stats.tileCount);
}

INSTANTIATE_TEST_SUITE_P(In, MaterialClasses, ::testing::ValuesIn(classCases),
                         [](const auto& test) { return test.param.name; });

TEST_F(LightingTest, TilesWithoutASpecularLobeAreShadedWithoutIt)
{
    const CpuGBuffer g = twoClasses(144, 96);
    std::vector<uint32_t> types = {CND_LIGHT_SPHERE, CND_LIGHT_TUBE, CND_LIGHT_DIRECTIONAL};
    if (fullTests())
        types.insert(types.end(), {CND_LIGHT_RECTANGLE, CND_LIGHT_DISC, CND_LIGHT_POINT,
                                   CND_LIGHT_SPOT, CND_LIGHT_DISTANT_SPHERE});
    const auto create = [&](bool diffuseOnlyTiles) {
        const CndLightingDesc desc{.structSize = sizeof desc,
                                   .framesInFlight = 2,
                                   .shading =
                                       CND_SHADING_CLUSTERED_BIT | CND_SHADING_COUNT_PAIRS_BIT,
                                   .diffuseOnlyTiles = diffuseOnlyTiles};
        CndLighting lighting{};
        CndError error{};
        EXPECT_EQ(cndCreateLighting(&deviceDesc(), &desc, &lighting, &error), CND_SUCCESS)
            << error.message;
        return lighting;
    };
    const CndLighting plain = create(false), classed = create(true);
    const auto compare = [&](uint32_t type, RunOptions options) {
        const std::vector<CndLight> lights = lightsOf(CndLightType(type), g, 60, 5 + type);
        options.specular = CND_SPECULAR_CONIC;
        options.countPairs = true;
        options.lighting = plain;
        const LightingResult together = run(g, lights, options);
        options.lighting = classed;
        const LightingResult apart = run(g, lights, options);
        const double difference = maxPixelDifference(apart.radiance, together.radiance);
        std::cout << "type " << type << ": largest difference of a pixel " << difference << '\n';
        EXPECT_TRUE(device().lanesAreCpuVector ? difference <= classTolerance
                                               : agree(apart.radiance, together.radiance))
            << type << ": " << difference;
        EXPECT_EQ(together.stats.diffuseTileCount, 0u);
        EXPECT_EQ(apart.stats.tileCount, together.stats.tileCount);
        // Six columns in 12 rows, without the second row; fewer if a tile has no surface.
        EXPECT_GT(apart.stats.diffuseTileCount, 50u);
        EXPECT_LE(apart.stats.diffuseTileCount, 66u);
        EXPECT_EQ(apart.stats.unlistedClusters > 0, options.listBudget > 0);
        EXPECT_EQ(keptLists(apart.stats), options.unchanged);
        if (!options.listBudget) {
            EXPECT_EQ(apart.stats.listedPairs, together.stats.listedPairs);
            EXPECT_EQ(apart.stats.contributingPairs, together.stats.contributingPairs);
        }
        EXPECT_TRUE(sameBits(apart, run(g, lights, options)));
    };
    for (const uint32_t type : types)
        for (const CndLobeJoining lobes : {CND_LOBES_SUM, CND_LOBES_CONSERVING})
            compare(type, {.lobes = lobes});
    for (const RunOptions& options :
         {RunOptions{.energyCompensation = true}, RunOptions{.frames = 2, .unchanged = true},
          RunOptions{.listBudget = 8192, .frames = 2, .unchanged = true}})
        compare(CND_LIGHT_SPHERE, options);
    cndDestroyLighting(plain);
    cndDestroyLighting(classed);
}

// The schedule decides which cluster finds room for its list, so a class must be shaded the same
// way with and without lists, as far as the driver compiles pipelines the same way.
TEST_F(LightingTest, ClassesAreAlikeWithoutRoomForLists)
{
    const CpuGBuffer g = twoClasses(144, 96);
    const std::vector<CndLight> lights = randomSpheres(g, 200, 3);
    RunOptions options{.specular = CND_SPECULAR_CONIC, .diffuseOnlyTiles = true};
    const LightingResult roomy = run(g, lights, options);
    options.listBudget = 8192;
    const LightingResult tight = run(g, lights, options);
    EXPECT_EQ(roomy.stats.unlistedClusters, 0u);
    EXPECT_GT(tight.stats.unlistedClusters, 0u);
    EXPECT_TRUE(agree(roomy.radiance, tight.radiance));
}

} // namespace candelabra::test
