// SPDX-License-Identifier: Apache-2.0
// The neighbours of the triangles of occluders.
#include <algorithm>
#include <array>
#include <random>

#include <gtest/gtest.h>

#include "occluders/neighbours.h"

namespace candelabra::test
{
namespace
{

using Triangles = std::vector<gpu::OccluderTriangle>;

uint32_t boundaryEdges(const lighting::Neighbours& neighbours)
{
    uint32_t count = 0;
    for (const gpu::OccluderNeighbours& n : neighbours)
        count += uint32_t(std::ranges::count(n.edges, gpu::NO_NEIGHBOUR));
    return count;
}

} // namespace

TEST(OccluderNeighbours, ShareEdgesOfEqualBits)
{
    const glm::vec3 a(0), b(1, 0, 0), c(0, 1, 0), d(1, 1, 0), e(0, 0, 1);
    // Two triangles share an edge; the second one may be turned round.
    const Triangles two = {{{a, b, c}}, {{d, c, b}}}, turned = {{{a, b, c}}, {{d, b, c}}};
    constexpr uint32_t none = gpu::NO_NEIGHBOUR;
    auto found = lighting::findNeighbours(two);
    EXPECT_TRUE(std::ranges::equal(found[0].edges, std::array{none, 2u, none}));
    EXPECT_TRUE(std::ranges::equal(found[1].edges, std::array{none, 0u, none}));
    found = lighting::findNeighbours(turned);
    EXPECT_TRUE(std::ranges::equal(found[0].edges, std::array{none, 3u, none}));
    EXPECT_TRUE(std::ranges::equal(found[1].edges, std::array{none, 1u, none}));
    // An edge of three triangles, of a triangle twice, and of ends that coincide is a boundary.
    EXPECT_EQ(boundaryEdges(lighting::findNeighbours(Triangles{two[0], two[1], {{e, b, c}}})), 9u);
    EXPECT_EQ(boundaryEdges(lighting::findNeighbours(Triangles{{{a, b, a}}, {{a, a, a}}})), 6u);
    EXPECT_EQ(boundaryEdges(lighting::findNeighbours(Triangles{{{a, b, b}}, {{b, b, d}}})), 6u);
}

TEST(OccluderNeighbours, PartWhereNewPositionsDiffer)
{
    std::mt19937 random(1);
    Triangles sheet;
    for (int x = 0; x < 6; ++x)
        for (int y = 0; y < 6; ++y) {
            const glm::vec3 a(x, y, 0), b(x + 1, y, 0), c(x + 1, y + 1, 0), d(x, y + 1, 0);
            sheet.push_back({{a, b, c}});
            sheet.push_back({{a, c, d}});
        }
    const auto neighbours = lighting::findNeighbours(sheet);
    EXPECT_EQ(boundaryEdges(neighbours), 24u);
    lighting::Neighbours copied(neighbours.size());
    lighting::copyNeighboursThatMeet(sheet, neighbours, copied);
    EXPECT_EQ(boundaryEdges(copied), 24u);
    for (int i = 0; i < 50; ++i) {
        sheet[random() % sheet.size()].corners[random() % 3].z += 0.01f;
        lighting::copyNeighboursThatMeet(sheet, neighbours, copied);
        const auto expected = lighting::findNeighbours(sheet);
        for (size_t t = 0; t < sheet.size(); ++t)
            EXPECT_TRUE(std::ranges::equal(copied[t].edges, expected[t].edges)) << i << ", " << t;
    }
    EXPECT_GT(boundaryEdges(copied), 24u);
}

TEST(OccluderNeighbours, OfVerticesStayWhateverThePositionsAre)
{
    const glm::vec3 a(0), b(1, 0, 0), c(0, 1, 0), d(1, 1, 0), e(2, 0, 0);
    const Triangles three = {{{a, b, c}}, {{d, c, b}}, {{d, b, e}}};
    const std::vector<glm::uvec3> corners = {{0, 1, 2}, {3, 2, 1}, {3, 7, 4}}; // 7: also at b
    const auto neighbours = lighting::findNeighbours(three);
    EXPECT_EQ(boundaryEdges(neighbours), 5u);
    lighting::Neighbours copied(three.size());
    lighting::copyNeighboursOfVertices(corners, neighbours, copied);
    constexpr uint32_t none = gpu::NO_NEIGHBOUR;
    EXPECT_TRUE(std::ranges::equal(copied[0].edges, std::array{none, 2u, none}));
    EXPECT_TRUE(std::ranges::equal(copied[1].edges, std::array{none, 0u, none}));
    EXPECT_EQ(boundaryEdges(copied), 7u);
}

} // namespace candelabra::test
