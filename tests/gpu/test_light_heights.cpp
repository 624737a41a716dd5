// SPDX-License-Identifier: Apache-2.0
// Tiles whose spheres are all above the horizons of their pixels are shaded by kernels that
// evaluate no other spheres (shared/lighting_data.h, ANY_HEIGHT). The picture must be the same.
#include <algorithm>
#include <cmath>
#include <iostream>
#include <numbers>

#include "gpu/lighting_harness.h"
#include "gpu/module_spy.h"
#include "shared/cluster_data.h"

namespace candelabra::test
{
namespace
{

constexpr double distance = 10; // m, of the surfaces from the eye

// Returns a wall that faces the eye. The normal of each pixel is turned from the wall's by up to
// `tilt` radians; in every third column of tiles no normal is turned.
CpuGBuffer bumpyWall(uint32_t width, uint32_t height, double tilt)
{
    CpuGBuffer g{.width = width, .height = height};
    setPerspective(g.camera, 1, double(width) / height, 0.1);
    std::mt19937 random(11);
    std::uniform_real_distribution<double> unit(0, 1);
    for (uint32_t y = 0; y < height; ++y)
        for (uint32_t x = 0; x < width; ++x) {
            const double angle = x / gpu::TILE_SIZE % 3 ? tilt * unit(random) : 0;
            const double azimuth = 2 * std::numbers::pi * unit(random);
            addPixel(g, {.depth = depthAt(g.camera, distance),
                         .normal = {std::sin(angle) * std::cos(azimuth),
                                    std::sin(angle) * std::sin(azimuth), std::cos(angle)},
                         .perceptualRoughness = 0.3 + 0.5 * unit(random),
                         .albedo = {0.5, 0.4, 0.3},
                         .F0F90 = {0.04, 0.04, 0.04, 1}});
        }
    return g;
}

// Returns spheres in front of the wall. The centres of one in ten are half a radius above it, those
// of the others 1.1 to 4.1 radii. `reach`: radius of influence, in radii of the sphere.
std::vector<CndLight> spheresAbove(uint32_t count, float reach = 4)
{
    std::mt19937 random(5);
    std::uniform_real_distribution<float> unit(0, 1);
    std::vector<CndLight> lights(count);
    for (CndLight& light : lights) {
        light = {.type = CND_LIGHT_SPHERE};
        light.radius = 0.1f + 0.3f * unit(random);
        const float height = light.radius * (unit(random) < 0.1f ? 0.5f : 1.1f + 3 * unit(random));
        light.position[0] = 14 * unit(random) - 7;
        light.position[1] = 9 * unit(random) - 4.5f;
        light.position[2] = float(-distance) + height;
        light.influenceRadius = reach * light.radius;
        for (float& channel : light.emission)
            channel = 1 + 10 * unit(random);
    }
    return lights;
}

// Looks at tiles all of whose spheres are at least `radii` of their radii above the wall. Returns
// how many of their pixels have a sphere that is lower than that above the pixel's own horizon.
size_t lowerAtPixels(const CpuGBuffer& g, const std::vector<CndLight>& lights, double radii)
{
    const auto isLower = [&](size_t pixel, const glm::dvec3& normal) {
        const glm::dvec3 p = viewPosition(g, uint32_t(pixel % g.width), uint32_t(pixel / g.width));
        return std::ranges::any_of(lights, [&](const CndLight& light) {
            const glm::dvec3 v =
                glm::dvec3(light.position[0], light.position[1], light.position[2]) - p;
            const double above = glm::dot(normal, v);
            return glm::length(v) < light.influenceRadius && above > -light.radius &&
                   above < radii * light.radius;
        });
    };
    size_t count = 0;
    for (uint32_t tileY = 0; tileY < g.height; tileY += gpu::TILE_SIZE)
        for (uint32_t tileX = 0; tileX < g.width; tileX += gpu::TILE_SIZE) {
            size_t flat = 0, lower = 0;
            for (uint32_t i = 0; i < gpu::TILE_SIZE * gpu::TILE_SIZE; ++i) {
                const size_t pixel =
                    size_t(tileY + i / gpu::TILE_SIZE) * g.width + tileX + i % gpu::TILE_SIZE;
                flat += isLower(pixel, {0, 0, 1});
                lower += isLower(pixel, storedNormal(g, pixel));
            }
            count += flat ? 0 : lower;
        }
    return count;
}

} // namespace

TEST_F(LightingTest, TilesUnderHighLightsAreShadedAsOthers)
{
    for (const double tilt : {0.0, 0.3, 0.7}) {
        const CpuGBuffer g = bumpyWall(144, 96, tilt);
        const std::vector<CndLight> lights = spheresAbove(60);
        if (tilt > 0.5) {
            // A test of the wall alone would take spheres for higher than they are at these pixels.
            EXPECT_GT(lowerAtPixels(g, lights, 1), 100u);
            EXPECT_GT(lowerAtPixels(g, lights, 2), 200u);
        }
        for (const CndSpecularMethod method :
             {CND_SPECULAR_NONE, CND_SPECULAR_KARIS, CND_SPECULAR_CONIC, CND_SPECULAR_CONIC_FULL}) {
            RunOptions options{.specular = method};
            const LightingResult clustered = run(g, lights, options);
            options.culling = CND_CULLING_BRUTE;
            EXPECT_TRUE(agree(clustered.radiance, run(g, lights, options).radiance))
                << "tilt " << tilt << ", method " << method;
        }
    }
}

// Compares the pictures of lights that end near their spheres, of a lighting with kernels for
// classes of materials, and of a wall in steps, whose tiles are split into slices of depth.
TEST_F(LightingTest, SplitAndClassedTilesUnderHighLightsAreShadedAsOthers)
{
    CpuGBuffer stepped = bumpyWall(144, 96, 0.3);
    for (size_t pixel = 0; pixel < stepped.depth.size(); ++pixel)
        if (pixel % stepped.width % 40 < 20)
            stepped.depth[pixel] = depthAt(stepped.camera, 5 * distance);
    struct Case {
        CpuGBuffer g;
        std::vector<CndLight> lights;
        bool diffuseOnlyTiles;
    };
    const Case cases[] = {{bumpyWall(144, 96, 0.3), spheresAbove(200, 1.5f), false},
                          {bumpyWall(144, 96, 0.3), spheresAbove(60), true},
                          {stepped, spheresAbove(60), false}};
    for (const Case& c : cases) {
        RunOptions options{.specular = CND_SPECULAR_CONIC, .diffuseOnlyTiles = c.diffuseOnlyTiles};
        const LightingResult clustered = run(c.g, c.lights, options);
        options.culling = CND_CULLING_BRUTE;
        EXPECT_TRUE(agree(clustered.radiance, run(c.g, c.lights, options).radiance)) << &c - cases;
        EXPECT_EQ(clustered.stats.splitTileCount > 0, &c - cases == 2);
    }
}

// On llvmpipe there are tiles of every height, elsewhere of one.
TEST_F(LightingTest, TilesUnderHighLightsHaveWorkListsOfTheirOwn)
{
    const CpuGBuffer g = bumpyWall(144, 96, 0.3);
    gpu::Buffer lit;
    ModuleSpy spy(deviceDesc());
    spy.onPass = [&](VkCommandBuffer cmd, const std::string& pass) {
        if (pass != "shade_tiles" || lit.size)
            return;
        fullBarrier(cmd);
        const ModuleSpy::Seen& from = spy.buffer("lit tiles");
        lit = readback("lit tiles", from.size);
        const VkBufferCopy all{.size = from.size};
        vkCmdCopyBuffer(cmd, from.buffer, lit.get(), 1, &all);
        fullBarrier(cmd);
    };
    run(g, spheresAbove(60), {.specular = CND_SPECULAR_CONIC, .host = &spy.desc()});
    for (uint32_t height = 0; height < gpu::TILE_HEIGHTS; ++height) {
        const uint32_t tiles = lit.as<gpu::WorkList>()[height * gpu::TILE_CLASSES].count;
        std::cout << "height " << height << ": " << tiles << " tiles\n";
        EXPECT_EQ(tiles > 10, height == gpu::ANY_HEIGHT || device().lanesAreCpuVector) << height;
    }
}

} // namespace candelabra::test
