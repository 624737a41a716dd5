// SPDX-License-Identifier: Apache-2.0
// The trees over occluders' triangles: they hold every triangle once in boxes that fit, walks find
// the triangles that a look at all of them finds, and nothing goes wrong with degenerate input.
#include <numeric>
#include <random>

#include <gtest/gtest.h>

#include "harness/occluder_walk.h"
#include "occluders/refit_plan.h"

namespace candelabra::test
{
namespace
{

using lighting::Box;
using lighting::TreeItem;
using Triangles = std::vector<gpu::OccluderTriangle>;
using Nodes = std::vector<gpu::OccluderNode>;

Box boxAround(const gpu::OccluderTriangle& t)
{
    Box box;
    for (const glm::vec3& corner : t.corners)
        box.add(corner);
    return box;
}

std::vector<TreeItem> itemsOf(const Triangles& triangles)
{
    std::vector<TreeItem> items;
    for (const gpu::OccluderTriangle& t : triangles)
        items.push_back({boxAround(t), uint32_t(items.size())});
    return items;
}

struct MeshTree {
    Triangles triangles; // in its order
    Nodes nodes;
};

MeshTree treeOf(const Triangles& triangles, uint32_t leafItems)
{
    std::vector<TreeItem> items = itemsOf(triangles);
    MeshTree tree{.nodes = Nodes(2 * items.size() - 1)};
    tree.nodes.resize(lighting::buildTree(items, leafItems, tree.nodes));
    for (const TreeItem& item : items)
        tree.triangles.push_back(triangles[item.index]);
    return tree;
}

// Checks links, leaves and boxes of all nodes, and returns the depth.
uint32_t checkTree(const Nodes& nodes, const std::vector<TreeItem>& items, uint32_t leafItems)
{
    std::vector<uint32_t> ends; // of the subtrees around the present node
    uint32_t next = 0, depth = 0;
    for (uint32_t node = 0; node < nodes.size(); ++node) {
        while (!ends.empty() && ends.back() == node)
            ends.pop_back();
        const gpu::OccluderNode& n = nodes[node];
        const uint32_t end = ends.empty() ? uint32_t(nodes.size()) : ends.back();
        EXPECT_LE(n.skip, end);
        if (n.leaf) {
            EXPECT_EQ(n.skip, node + 1);
            EXPECT_EQ(lighting::leafFirst(n), next);
            EXPECT_GT(lighting::leafEnd(n), next);
            EXPECT_LE(lighting::leafEnd(n), next + leafItems);
            next = lighting::leafEnd(n);
        } else {
            EXPECT_EQ(nodes[nodes[node + 1].skip].skip, n.skip); // it has two children
            ends.push_back(n.skip);
            depth = std::max(depth, uint32_t(ends.size()));
        }
        const Box box = lighting::fittedBox(nodes, node, [&](uint32_t i) { return items[i].box; });
        EXPECT_TRUE(box == lighting::boxOf(n)) << node;
        if (::testing::Test::HasFailure())
            return 0;
    }
    EXPECT_EQ(next, items.size());
    return depth;
}

// Builds a tree over items, and checks it.
void expectSound(std::vector<TreeItem> items, const char* what)
{
    SCOPED_TRACE(what);
    Nodes nodes(2 * std::max<size_t>(items.size(), 1) - 1);
    nodes.resize(lighting::buildTree(items, 4, nodes));
    EXPECT_LE(checkTree(nodes, items, 4), 80u);
    std::vector<bool> seen(items.size());
    for (const TreeItem& item : items)
        seen[item.index] = true;
    EXPECT_EQ(std::ranges::count(seen, false), 0);
}

class RandomTriangles
{
public:
    explicit RandomTriangles(uint32_t seed) : random_(seed) {}
    float number(float low, float high)
    {
        return low + (high - low) * float(random_() >> 8) / float(1 << 24);
    }
    glm::vec3 point(float size) { return {inside(size), inside(size), inside(size)}; }
    Triangles triangles(uint32_t count)
    {
        Triangles out(count);
        for (gpu::OccluderTriangle& t : out) {
            const glm::vec3 centre = point(10);
            const float size = std::exp2(number(-3, 4));
            for (glm::vec3& corner : t.corners)
                corner = centre + point(size);
        }
        return out;
    }
    Segment segment() { return {glm::dvec3(point(12)), glm::dvec3(point(12))}; }

private:
    float inside(float size) { return number(-size, size); }
    std::mt19937 random_;
};

uint32_t crossedInTree(const MeshTree& tree, const Segment& s)
{
    uint32_t found = 0;
    walkTree(tree.nodes, s, [&](uint32_t i) { found += crosses(s, tree.triangles[i]); });
    return found;
}

} // namespace

TEST(OccluderTree, WalksFindWhatALookAtAllTrianglesFinds)
{
    RandomTriangles random(1);
    uint64_t crossings = 0;
    for (const uint32_t count : {1, 2, 3, 4, 5, 9, 30, 100, 333, 1000}) {
        const Triangles triangles = random.triangles(count);
        const MeshTree fours = treeOf(triangles, 4), ones = treeOf(triangles, 1);
        for (int i = 0; i < 400; ++i) {
            const Segment s = random.segment();
            const auto expected = std::ranges::count_if(
                triangles, [&](const gpu::OccluderTriangle& t) { return crosses(s, t); });
            EXPECT_EQ(crossedInTree(fours, s), expected);
            EXPECT_EQ(crossedInTree(ones, s), expected);
            crossings += uint64_t(expected);
        }
    }
    EXPECT_GT(crossings, 4000u);
}

TEST(OccluderTree, FitsPositionsThatMoved)
{
    RandomTriangles random(2);
    MeshTree tree = treeOf(random.triangles(500), 4);
    tree.triangles = random.triangles(500);
    lighting::fitTree(tree.nodes, [&](uint32_t i) { return boxAround(tree.triangles[i]); });
    checkTree(tree.nodes, itemsOf(tree.triangles), 4);
    for (int i = 0; i < 300; ++i) {
        const Segment s = random.segment();
        EXPECT_EQ(crossedInTree(tree, s), std::ranges::count_if(tree.triangles, [&](const auto& t) {
                      return crosses(s, t);
                  }));
    }
}

// The plan has every node once, children in an earlier round or group than their parents.
TEST(OccluderTree, IsRefittedFromTheLeavesUp)
{
    RandomTriangles random(4);
    Triangles ever(3000); // makes a tree deep
    for (size_t i = 0; i < ever.size(); ++i)
        ever[i] = {{glm::vec3(std::exp2(float(i % 250) - 125)), glm::vec3(0), glm::vec3(0)}};
    for (const Triangles& triangles : {Triangles(), random.triangles(1), random.triangles(9),
                                       random.triangles(400), random.triangles(20000), ever}) {
        std::vector<TreeItem> items = itemsOf(triangles);
        Nodes nodes(2 * std::max<size_t>(items.size(), 1) - 1);
        nodes.resize(lighting::buildTree(items, 4, nodes));
        const uint32_t count = uint32_t(nodes.size());
        std::vector<uint8_t> heights(count);
        std::vector<uint32_t> words(lighting::maxRefitPlanWords(count));
        const lighting::RefitPlan plan = lighting::writeRefitPlan(nodes, heights, words);
        EXPECT_LE(plan.words, words.size());
        EXPECT_EQ(plan.subtreeGroups > 0, count > 0);
        EXPECT_EQ(plan.hasTop, count > 512);
        constexpr uint32_t none = UINT32_MAX;
        std::vector<uint32_t> groupOf(count, none), roundOf(count, none);
        for (uint32_t group = 0; group < plan.subtreeGroups + plan.hasTop; ++group) {
            const uint32_t at = words[group], rounds = words[at];
            uint32_t next = at + 1 + rounds;
            for (uint32_t round = 0; round < rounds; ++round)
                for (uint32_t i = 0; i < words[at + 1 + round]; ++i, ++next) {
                    ASSERT_LT(next, plan.words);
                    ASSERT_LT(words[next], count);
                    EXPECT_EQ(groupOf[words[next]], none) << "a node comes twice";
                    groupOf[words[next]] = group;
                    roundOf[words[next]] = round;
                }
        }
        const auto isFirst = [&](uint32_t child, uint32_t node) {
            return groupOf[child] == groupOf[node] ? roundOf[child] < roundOf[node]
                                                   : groupOf[node] == plan.subtreeGroups;
        };
        for (uint32_t node = 0; node < count; ++node) {
            ASSERT_NE(groupOf[node], none);
            if (nodes[node].leaf) {
                EXPECT_EQ(roundOf[node], 0u);
                EXPECT_LT(groupOf[node], plan.subtreeGroups);
            } else {
                EXPECT_TRUE(isFirst(node + 1, node));
                EXPECT_TRUE(isFirst(nodes[node + 1].skip, node));
            }
        }
    }
}

TEST(OccluderTree, IsSoundForAnyInput)
{
    RandomTriangles random(3);
    expectSound({}, "nothing");
    for (const uint32_t count : {1, 2, 3, 4, 5, 17, 1000})
        expectSound(itemsOf(random.triangles(count)), "triangles");

    const gpu::OccluderTriangle one = random.triangles(1)[0];
    expectSound(itemsOf(Triangles(1'000'000, one)), "a million equal triangles");
    expectSound(itemsOf(Triangles(1000, {{glm::vec3(1), glm::vec3(1), glm::vec3(1)}})),
                "all in one point");

    Triangles flatOnes = random.triangles(1000), needles = flatOnes;
    for (gpu::OccluderTriangle& t : flatOnes)
        for (glm::vec3& corner : t.corners)
            corner.y = 3;
    expectSound(itemsOf(flatOnes), "flat");
    for (gpu::OccluderTriangle& t : needles)
        t.corners[2] = t.corners[1] = t.corners[0] + glm::vec3(100, 1e-7f, 0);
    expectSound(itemsOf(needles), "needles");

    // Each bin of the first axis but the first one has at most one of them, at every depth.
    Triangles ever(3000);
    for (size_t i = 0; i < ever.size(); ++i) {
        const float at = float(std::exp2(double(i % 250) - 125));
        ever[i] = {{glm::vec3(at, 0, 0), glm::vec3(at, 1e-30f, 0), glm::vec3(at, 0, 1e-30f)}};
    }
    expectSound(itemsOf(ever), "ever farther apart");
    Triangles wide = random.triangles(1000);
    for (gpu::OccluderTriangle& t : wide)
        for (glm::vec3& corner : t.corners)
            corner *= 1e14f;
    expectSound(itemsOf(wide), "coordinates up to 1e15");
}

} // namespace candelabra::test
