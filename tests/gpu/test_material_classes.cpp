// SPDX-License-Identifier: Apache-2.0
// Tiles whose surfaces all lack a lobe are shaded without it, and look the same.
#include "gpu/lighting_harness.h"
#include "harness/full_tests.h"

#include <glm/gtc/packing.hpp>

namespace candelabra::test
{
namespace
{

constexpr uint32_t tile = 8;

glm::uvec2 half4(const glm::vec4& v)
{
    return {glm::packHalf2x16({v.x, v.y}), glm::packHalf2x16({v.z, v.w})};
}

// From the left: columns of tiles without a specular lobe, without a diffuse one, with both; in the
// second row of tiles every one has a pixel that is not like the others.
CpuGBuffer threeClasses(uint32_t width, uint32_t height)
{
    CndCamera camera;
    setPerspective(camera, 1.0, double(width) / height, 0.1);
    CpuGBuffer g = randomGBuffer(width, height, camera, 0, 11);
    for (uint32_t y = 0; y < height; ++y)
        for (uint32_t x = 0; x < width; ++x) {
            const size_t i = y * width + x;
            const bool odd = y / tile == 1 && y % tile == 5 && x % tile == 3;
            const uint32_t third = 3 * (x / tile) / (width / tile);
            const glm::vec3 colour(0.2 + 0.01 * double(i % 50), 0.5, 0.7);
            if (y / tile == 1) // a hole to the background would have no class
                g.depth[i] = depthAt(camera, 4);
            g.albedo[i] = half4(glm::vec4(third == 1 && !odd ? glm::vec3(0) : colour, 0));
            g.specular[i] = half4(third == 0 && !odd ? glm::vec4(0) : glm::vec4(0.5f * colour, 1));
        }
    return g;
}

} // namespace

TEST_F(LightingTest, TilesThatLackALobeAreShadedWithoutIt)
{
    const CpuGBuffer g = threeClasses(144, 96);
    constexpr uint32_t both = CND_MATERIAL_DIFFUSE_ONLY | CND_MATERIAL_SPECULAR_ONLY;
    std::vector<uint32_t> types = {CND_LIGHT_SPHERE, CND_LIGHT_TUBE, CND_LIGHT_DIRECTIONAL};
    if (fullTests())
        types.insert(types.end(), {CND_LIGHT_RECTANGLE, CND_LIGHT_DISC, CND_LIGHT_POINT,
                                   CND_LIGHT_SPOT, CND_LIGHT_DISTANT_SPHERE});
    const auto create = [&](uint32_t classes) {
        const CndLightingDesc desc{
            .structSize = sizeof desc, .framesInFlight = 2, .materialClasses = classes};
        CndLighting lighting{};
        CndError error{};
        EXPECT_EQ(cndCreateLighting(&deviceDesc(), &desc, &lighting, &error), CND_SUCCESS)
            << error.message;
        return lighting;
    };
    const CndLighting plain = create(0), classed = create(both);
    for (const uint32_t type : types) {
        const std::vector<CndLight> lights = lightsOf(CndLightType(type), g, 60, 5 + type);
        for (const CndLobeJoining lobes : {CND_LOBES_SUM, CND_LOBES_CONSERVING}) {
            RunOptions options{.specular = CND_SPECULAR_CONIC,
                               .countPairs = true,
                               .lighting = plain,
                               .lobes = lobes};
            const LightingResult together = run(g, lights, options);
            options.lighting = classed;
            const LightingResult apart = run(g, lights, options);
            EXPECT_LE(maxRelativeDifference(apart.radiance, together.radiance), 1e-6) << type;
            EXPECT_EQ(together.stats.diffuseTileCount, 0u);
            EXPECT_EQ(together.stats.specularTileCount, 0u);
            EXPECT_EQ(apart.stats.tileCount, together.stats.tileCount);
            // 6 columns each in 12 rows, but for the second; fewer where a tile has no surface.
            EXPECT_GT(apart.stats.diffuseTileCount, 50u);
            EXPECT_LE(apart.stats.diffuseTileCount, 66u);
            EXPECT_GT(apart.stats.specularTileCount, 50u);
            EXPECT_LE(apart.stats.specularTileCount, 66u);
            EXPECT_EQ(apart.stats.listedPairs, together.stats.listedPairs);
            EXPECT_EQ(apart.stats.contributingPairs, together.stats.contributingPairs);
            EXPECT_TRUE(sameBits(apart, run(g, lights, options)));
        }
    }
    cndDestroyLighting(plain);
    cndDestroyLighting(classed);
}

// Which cluster finds room for its list depends on the schedule, so a class is shaded alike with
// and without lists.
TEST_F(LightingTest, ClassesAreAlikeWithoutRoomForLists)
{
    const CpuGBuffer g = threeClasses(144, 96);
    const std::vector<CndLight> lights = randomSpheres(g, 200, 3);
    constexpr uint32_t both = CND_MATERIAL_DIFFUSE_ONLY | CND_MATERIAL_SPECULAR_ONLY;
    RunOptions options{.specular = CND_SPECULAR_CONIC, .materialClasses = both};
    const LightingResult roomy = run(g, lights, options);
    options.listBudget = 8192;
    const LightingResult tight = run(g, lights, options);
    EXPECT_EQ(roomy.stats.unlistedClusters, 0u);
    EXPECT_GT(tight.stats.unlistedClusters, 0u);
    EXPECT_TRUE(sameBits(roomy, tight));
}

TEST_F(LightingTest, ClassesAreThoseAskedFor)
{
    const CpuGBuffer g = threeClasses(144, 96);
    const std::vector<CndLight> lights = randomSpheres(g, 40, 3);
    const auto stats = [&](uint32_t classes) {
        return run(g, lights, {.materialClasses = classes}).stats;
    };
    const CndLightingStats diffuse = stats(CND_MATERIAL_DIFFUSE_ONLY);
    const CndLightingStats specular = stats(CND_MATERIAL_SPECULAR_ONLY);
    EXPECT_GT(diffuse.diffuseTileCount, 0u);
    EXPECT_EQ(diffuse.specularTileCount, 0u);
    EXPECT_EQ(specular.diffuseTileCount, 0u);
    EXPECT_GT(specular.specularTileCount, 0u);

    CndLighting lighting{};
    CndError error{};
    const CndLightingDesc wrong{
        .structSize = sizeof wrong, .framesInFlight = 1, .materialClasses = 4};
    EXPECT_EQ(cndCreateLighting(&deviceDesc(), &wrong, &lighting, &error),
              CND_ERROR_INVALID_ARGUMENT);
    EXPECT_NE(std::string(error.message).find("materialClasses"), std::string::npos);
}

} // namespace candelabra::test
