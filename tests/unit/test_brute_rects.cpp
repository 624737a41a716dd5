// SPDX-License-Identifier: Apache-2.0
#include <cstdint>
#include <vector>

#include <glm/glm.hpp>
#include <gtest/gtest.h>

#include "shading/brute_rects.h"

namespace candelabra::test
{

TEST(BruteRects, CoverEveryPixelOnceWithLimitedWork)
{
    constexpr uint64_t largest = 1 << 20;
    const glm::uvec2 first(5, 3);
    for (const uint64_t lights : {1u, 100u, 1000u, 5000u, 200000u})
        for (const glm::uvec2 size : {glm::uvec2(1, 1), glm::uvec2(8, 8), glm::uvec2(203, 117)}) {
            std::vector<int> times(size.x * size.y, 0);
            lighting::inBruteRects(
                first, first + size, lights, largest, [&](glm::uvec2 from, glm::uvec2 to) {
                    const glm::uvec2 extent = to - from;
                    EXPECT_EQ((from - first) % 8u, glm::uvec2(0)) << "groups keep their pixels";
                    const uint64_t pairs = extent.x * extent.y * lights;
                    EXPECT_TRUE(pairs <= largest || (extent.x <= 8 && extent.y <= 8)) << pairs;
                    for (uint32_t y = from.y; y < to.y; ++y)
                        for (uint32_t x = from.x; x < to.x; ++x)
                            ++times[(y - first.y) * size.x + (x - first.x)];
                });
            for (const int n : times)
                ASSERT_EQ(n, 1) << lights << " lights, " << size.x << "x" << size.y;
        }
}

// If all pairs fit into one dispatch, there is one.
TEST(BruteRects, AreAsFewAsPossible)
{
    uint32_t count = 0;
    lighting::inBruteRects({0, 0}, {1920, 1080}, 100, lighting::brutePairsPerDispatch,
                           [&](glm::uvec2, glm::uvec2) { ++count; });
    EXPECT_EQ(count, 1u);
    lighting::inBruteRects({0, 0}, {1920, 1080}, 1000, lighting::brutePairsPerDispatch,
                           [&](glm::uvec2, glm::uvec2) { ++count; });
    EXPECT_EQ(count, 1u + 8);
}

} // namespace candelabra::test
