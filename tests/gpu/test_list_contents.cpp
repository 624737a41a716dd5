// SPDX-License-Identifier: Apache-2.0
// Compares the light list of every cluster with the lights that the host finds for the cluster's
// samples, in double precision and without a tree. A compiler that gets a loop inside a divergent
// loop wrong loses entries that an image may not show: other lights are brighter, or the lost one
// is black.
#include <algorithm>
#include <cmath>
#include <cstring>
#include <functional>
#include <iostream>
#include <map>
#include <span>

#include "gpu/kernel.h"
#include "gpu/lighting_harness.h"
#include "gpu/module_spy.h"
#include "shared/cluster_data.h"

namespace candelabra::test
{
namespace
{

struct Sample {
    glm::dvec3 position, normal;
};

// The buffers of a frame, read back after its lists were made.
struct ListBuffers {
    gpu::Buffer tiles, heads, entries, core;
};

// Returns the samples of every cluster that has some.
std::map<uint32_t, std::vector<Sample>> samplesOfClusters(const CpuGBuffer& g,
                                                          std::span<gpu::TileClusters> tiles)
{
    std::map<uint32_t, std::vector<Sample>> out;
    const uint32_t row = gpu::divideUp(g.width, gpu::TILE_SIZE);
    for (uint32_t y = 0; y < g.height; ++y)
        for (uint32_t x = 0; x < g.width; ++x) {
            const size_t pixel = size_t(y) * g.width + x;
            if (g.depth[pixel] == g.clearDepth)
                continue;
            const gpu::TileClusters& tile = tiles[y / gpu::TILE_SIZE * row + x / gpu::TILE_SIZE];
            uint32_t bits;
            std::memcpy(&bits, &g.depth[pixel], sizeof bits);
            out[tile.first + ((bits - tile.lowest) >> tile.shift)].push_back(
                {viewPosition(g, x, y), storedNormal(g, pixel)});
        }
    return out;
}

// Returns the lights of a list. Fails if their order is wrong.
std::vector<uint32_t> listOf(uint32_t head, std::span<uint32_t> entries)
{
    std::vector<uint32_t> out;
    EXPECT_TRUE(head != gpu::LIST_UNLISTED && head != gpu::LIST_LONG);
    for (uint32_t page = head; page != gpu::LIST_EMPTY;) {
        const uint32_t* const words = entries.data() + size_t(page) * gpu::PAGE_WORDS;
        const uint32_t count = words[0] & ((1u << gpu::PAGE_COUNT_BITS) - 1);
        out.insert(out.end(), words + 1, words + 1 + count);
        page = words[0] >> gpu::PAGE_COUNT_BITS;
    }
    EXPECT_TRUE(std::is_sorted(out.begin(), out.end(), std::less_equal<>()));
    return out;
}

// Tells whether a light surely adds to a sample, which float32 cannot decide near the borders.
bool surelyReaches(const glm::vec4* core, const Sample& s)
{
    const glm::dvec3 toLight = glm::dvec3(core[0]) - s.position;
    const double d = glm::length(toLight), reach = std::sqrt(double(core[1].w));
    return d < reach * (1 - 1e-5) - 1e-5 &&
           glm::dot(s.normal, toLight) > -double(core[0].w) + 1e-5 * d;
}

} // namespace

class ListContents : public LightingTest
{
protected:
    // Lights `g` and returns what the lists hold.
    ListBuffers listsOf(const CpuGBuffer& g, const std::vector<CndLight>& lights)
    {
        ListBuffers out;
        ModuleSpy spy(deviceDesc());
        spy.onPass = [&](VkCommandBuffer cmd, const std::string& pass) {
            if (pass != "shade_tiles" || out.tiles.size)
                return;
            fullBarrier(cmd);
            const auto copy = [&](const char* name) {
                const ModuleSpy::Seen& from = spy.buffer(name);
                gpu::Buffer to = readback(name, from.size);
                const VkBufferCopy all{.size = from.size};
                vkCmdCopyBuffer(cmd, from.buffer, to.get(), 1, &all);
                return to;
            };
            out = {copy("tiles"), copy("list heads"), copy("list entries"), copy("light core")};
            fullBarrier(cmd);
        };
        const LightingResult result = run(g, lights, {.host = &spy.desc()});
        EXPECT_EQ(result.stats.unlistedClusters, 0u);
        EXPECT_GT(result.stats.splitTileCount, 0u);
        return out;
    }
};

TEST_F(ListContents, AreTheLightsThatReachTheSamples)
{
    const CpuGBuffer g = randomGBuffer(203, 117, 5);
    for (const uint32_t count : {40u, 700u, 5000u}) {
        const ListBuffers made = listsOf(g, randomSpheres(g, count, count));
        const auto heads = made.heads.as<uint32_t>(), entries = made.entries.as<uint32_t>();
        const auto core = made.core.as<glm::vec4>();
        size_t reaching = 0, listed = 0, lost = 0;
        for (const auto& [cluster, samples] :
             samplesOfClusters(g, made.tiles.as<gpu::TileClusters>())) {
            const std::vector<uint32_t> list = listOf(heads[cluster], entries);
            listed += list.size();
            for (uint32_t light = 0; light < count; ++light) {
                const glm::vec4* const at = &core[size_t(light) * gpu::LIGHT_CORE_STRIDE];
                if (std::none_of(samples.begin(), samples.end(),
                                 [&](const Sample& s) { return surelyReaches(at, s); }))
                    continue;
                ++reaching;
                lost += !std::binary_search(list.begin(), list.end(), light);
            }
            ASSERT_TRUE(list.empty() || list.back() < count);
        }
        EXPECT_EQ(lost, 0u) << count << " lights";
        EXPECT_GT(reaching, count / 2);
        // Lists hold few other lights.
        EXPECT_LT(listed, 3 * reaching + 1000) << count << " lights";
        std::cout << count << " lights: " << reaching << " reach a cluster, " << listed
                  << " are listed\n";
    }
}

} // namespace candelabra::test
