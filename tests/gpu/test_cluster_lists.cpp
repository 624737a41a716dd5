// SPDX-License-Identifier: Apache-2.0
// light_tree and cluster_lists have a form for GPUs, in which the lanes of a group work together,
// and one for llvmpipe, in which each lane works alone. Both must make the same boxes and the
// same lists, to the bit.
#include <algorithm>
#include <iterator>
#include <random>

#include "candelabra_shaders.h"
#include "gpu/kernel.h"
#include "harness/gpu_fixture.h"
#include "shared/cluster_data.h"

namespace candelabra::test
{
namespace
{

using Lights = std::vector<std::vector<uint32_t>>; // per cluster

// A set of lights and clusters: tiles, slices of split tiles, and blocks.
struct Scene {
    static constexpr glm::uvec2 tileCount = {21, 10};
    static constexpr uint32_t tiles = tileCount.x * tileCount.y, splitTiles = 9,
                              slices = splitTiles * gpu::SLICES, blocks = 60;
    static constexpr uint32_t firstSlice = tiles, firstBlock = firstSlice + slices,
                              clusters = firstBlock + blocks;
    gpu::TreeShape tree{};
    std::vector<glm::vec4> core;
    std::vector<gpu::Cluster> cluster;
    std::vector<gpu::TileClusters> tile;
};

// The output of the kernels.
struct Made {
    std::vector<glm::vec4> nodes;
    std::vector<uint32_t> heads, entries;
    std::vector<uint32_t> lit, unlisted;            // tiles, sorted
    std::vector<uint32_t> litAt[gpu::TILE_HEIGHTS]; // those of `lit` by their heights
    gpu::LightingCounters counters;
};

// The way in which the lanes of a group work.
struct Form {
    bool together;
    uint32_t lanes = gpu::CLUSTER_LISTS_GROUP; // of a group of cluster_lists
};
constexpr Form byLane{false}, byGroup{true};

struct Limits {
    uint32_t pages = 1u << 15, longest = UINT32_MAX, maxUnlistedSteps = UINT32_MAX;
    uint32_t longestOfBlocks = UINT32_MAX;
    bool findsHeights = false;
};

// Lights lie along a curve through a cube of 20 m, as the sorted lights of the engine do, so that
// the boxes of the tree are small. One in eight is in none of the frame's layers.
void addLights(Scene& s, uint32_t count, std::mt19937& random)
{
    std::uniform_real_distribution<float> unit(0, 1);
    s.tree = {.firstLight = 5, .lightCount = count, .firstNode = 3};
    const float reach = 8.0f / std::cbrt(float(count));
    for (uint32_t i = 0; i < s.tree.firstLight + count; ++i) {
        const float t = float(i) / float(count) * 200;
        const glm::vec3 centre(10 * std::sin(t) + unit(random), 10 * std::cos(1.7f * t),
                               -30 - 10 * std::sin(0.6f * t) + unit(random));
        const float radius = reach * (0.2f + 2 * unit(random) * unit(random));
        const bool none = i % 8 == 5;
        s.core.emplace_back(centre, none ? gpu::BOUNDING_RADIUS_OF_NONE : 0.1f * radius);
        s.core.emplace_back(1, 1, 1, none ? gpu::INFLUENCE2_OF_NONE : radius * radius);
    }
}

// Returns a cluster of a block whose box is `share` as long as that of its parent, in which it
// lies.
gpu::Cluster clusterIn(const Scene& s, uint32_t parent, float share, std::mt19937& random)
{
    std::uniform_real_distribution<float> unit(0, 1);
    const glm::vec3 whole = s.cluster[parent].max - s.cluster[parent].min;
    const glm::vec3 first =
        s.cluster[parent].min +
        whole * (1 - share) * glm::vec3(unit(random), unit(random), unit(random));
    return {.min = first,
            .max = first + share * whole,
            .parent = parent,
            .slabMin = -1e6f,
            .slabMax = 1e6f,
            .minCos = 0};
}

// Adds what only clusters of tiles have: a slab, a cone of normals, a cone of
// samples. One cluster in five has no sample.
void makeClusterOfTile(gpu::Cluster& c, uint32_t tile, std::mt19937& random)
{
    std::uniform_real_distribution<float> unit(0, 1);
    const glm::vec3 middle = 0.5f * (c.min + c.max);
    const float size = 0.5f * glm::distance(c.min, c.max);
    c.tile = tile;
    c.axis = glm::normalize(glm::vec3(unit(random), unit(random), unit(random)) - 0.5f);
    c.slabMin = glm::dot(c.axis, middle) - 0.5f * size;
    c.slabMax = glm::dot(c.axis, middle) + 0.5f * size;
    c.minCos = 0.9f * unit(random);
    c.ray = glm::normalize(middle);
    c.slope = size / glm::length(middle);
    if (random() % 5 == 0)
        std::swap(c.min, c.max);
}

// Adds the clusters of tiles and of slices, each in some block, and the records of tiles.
void addTiles(Scene& s, float share, std::mt19937& random)
{
    for (uint32_t i = 0; i < Scene::firstBlock; ++i) {
        const uint32_t block = Scene::firstBlock + uint32_t(random()) % Scene::blocks;
        s.cluster[i] = clusterIn(s, block, share, random);
        const uint32_t tile = i < Scene::tiles ? i : (i - Scene::firstSlice) / gpu::SLICES;
        makeClusterOfTile(s.cluster[i], tile, random);
    }
    for (uint32_t i = 0; i < Scene::tiles; ++i)
        if (i < Scene::splitTiles)
            s.tile.push_back({Scene::firstSlice + i * gpu::SLICES, 0, 7, 1, 0});
        else if (i % 11 == 0) // without a surface
            s.tile.push_back({0, 1, 0, gpu::UNSPLIT, 0});
        else
            s.tile.push_back({i, 0, 7, gpu::UNSPLIT, (i % 2) << gpu::CLASS_BITS});
}

// `blockLength`: length of the boxes of blocks, as a share of the cube.
Scene randomScene(uint32_t lights, uint32_t seed, float blockLength = 0.3f)
{
    Scene s;
    std::mt19937 random(seed);
    addLights(s, lights, random);
    s.cluster.resize(Scene::clusters);
    s.cluster[0] = {.min = {-10, -10, -40}, .max = {10, 10, -20}};
    for (uint32_t i = Scene::firstBlock; i < Scene::clusters; ++i)
        s.cluster[i] = clusterIn(s, 0, blockLength, random);
    addTiles(s, 0.5f, random);
    return s;
}

// Numbers of lights in the lists of consecutive blocks of blockScene. Up to a page, of 63 lights,
// lists of tiles are made together, and runs of pairs end next to and far from those of 8, 16 and
// 32 lanes.
constexpr uint32_t lightsOfBlocks[] = {1, 7, 8, 0, 31, 32, 33, 62, 63, 64, 126, 127, 130};

// Blocks lie in a row, far from each other, each with as many lights of its own as lightsOfBlocks
// says. `reach`: m, radius of influence of the lights.
Scene blockScene(uint32_t seed, float reach, float share)
{
    Scene s;
    std::mt19937 random(seed);
    std::uniform_real_distribution<float> unit(-1, 1);
    s.tree = {.firstLight = 3, .firstNode = 1};
    s.core.resize(2 * s.tree.firstLight);
    s.cluster.resize(Scene::clusters);
    for (uint32_t i = 0; i < Scene::blocks; ++i) {
        const glm::vec3 middle(100 * i, 0, -30);
        s.cluster[Scene::firstBlock + i] = {.min = middle - 2.0f, .max = middle + 2.0f};
        const uint32_t lights = lightsOfBlocks[i % std::size(lightsOfBlocks)];
        for (uint32_t k = 0; k < lights; ++k) {
            s.core.emplace_back(middle + 2.0f * glm::vec3(unit(random), unit(random), unit(random)),
                                0.1f);
            s.core.emplace_back(1, 1, 1, reach * reach);
        }
        s.tree.lightCount += lights;
    }
    for (uint32_t i = Scene::firstBlock; i < Scene::clusters; ++i) {
        s.cluster[i].slabMin = -1e6f;
        s.cluster[i].slabMax = 1e6f;
    }
    addTiles(s, share, random);
    return s;
}

// Returns the tiles of `count` work lists from `first` on, without parts of lists, sorted.
std::vector<uint32_t> tilesOf(const gpu::Buffer& work, uint32_t first = 0,
                              uint32_t count = gpu::TILE_WORK_LISTS)
{
    const auto words = work.as<uint32_t>();
    const uint32_t* tiles =
        words.data() + gpu::TILE_WORK_LISTS * sizeof(gpu::WorkList) / sizeof(uint32_t);
    std::vector<uint32_t> out;
    for (const gpu::WorkList& list : work.as<gpu::WorkList>().subspan(first, count))
        std::copy_if(tiles + list.first, tiles + list.first + list.count, std::back_inserter(out),
                     [](uint32_t tile) { return tile < Scene::tiles; });
    std::ranges::sort(out);
    return out;
}

// Returns the lights of each list, and nothing for lists without pages.
Lights lightsOf(const Made& made)
{
    Lights out;
    for (const uint32_t head : made.heads) {
        std::vector<uint32_t>& lights = out.emplace_back();
        if (head == gpu::LIST_UNLISTED || head == gpu::LIST_LONG)
            continue;
        for (uint32_t page = head; page;) {
            const uint32_t* words = made.entries.data() + page * gpu::PAGE_WORDS;
            const uint32_t count = words[0] & ((1u << gpu::PAGE_COUNT_BITS) - 1);
            lights.insert(lights.end(), words + 1, words + 1 + count);
            page = words[0] >> gpu::PAGE_COUNT_BITS;
        }
    }
    return out;
}

class ClusterListsTest : public GpuTest
{
protected:
    // Runs light_tree and cluster_lists as Clusters::recordTree and recordLists do.
    Made make(const Scene& s, Form form, const Limits& limits = {});

private:
    gpu::Buffer workOfTiles(const char* name, uint32_t parts = 0) const;
    void recordTree(const gpu::Frame& f, const Scene& s, const gpu::Kernel<gpu::LightTreeParams>& k,
                    VkDescriptorSet set, Form form);
    void recordLists(const gpu::Frame& f, const Scene& s, const Limits& limits,
                     const gpu::Kernel<gpu::ClusterListsParams>& k, VkDescriptorSet set, Form form);
};

gpu::Buffer ClusterListsTest::workOfTiles(const char* name, uint32_t parts) const
{
    const uint32_t room = Scene::tiles + parts;
    gpu::Buffer work = readback(name, gpu::TILE_WORK_LISTS * (sizeof(gpu::WorkList) + 4 * room));
    for (uint32_t i = 0; i < gpu::TILE_WORK_LISTS; ++i)
        work.as<gpu::WorkList>()[i].first = i * room;
    return work;
}

void ClusterListsTest::recordTree(const gpu::Frame& f, const Scene& s,
                                  const gpu::Kernel<gpu::LightTreeParams>& k, VkDescriptorSet set,
                                  Form form)
{
    gpu::LightTreeParams p{.childFirst = s.tree.firstLight,
                           .childCount = s.tree.lightCount,
                           .lowerFirst = s.tree.firstNode,
                           .fromLights = 1};
    while (p.childCount > (p.fromLights ? 0 : gpu::TREE_WIDTH)) {
        const uint32_t lower = gpu::divideUp(p.childCount, gpu::TREE_WIDTH);
        const uint32_t upper = gpu::divideUp(lower, gpu::TREE_WIDTH);
        p.upperFirst = p.lowerFirst + lower;
        // In several rows: large trees have more groups than one row.
        k.dispatch(f, set, p, gpu::divideUp(upper, form.together ? 3 : gpu::LIGHT_TREE_GROUP),
                   form.together ? 3 : 1);
        fullBarrier(f.cmd);
        p = {.childFirst = p.upperFirst, .childCount = upper, .lowerFirst = p.upperFirst + upper};
    }
}

void ClusterListsTest::recordLists(const gpu::Frame& f, const Scene& s, const Limits& limits,
                                   const gpu::Kernel<gpu::ClusterListsParams>& k,
                                   VkDescriptorSet set, Form form)
{
    gpu::ClusterListsParams p{.tree = s.tree,
                              .pageCount = limits.pages / 2,
                              .longest = limits.longestOfBlocks,
                              .maxSteps = UINT32_MAX,
                              .maxUnlistedSteps = limits.maxUnlistedSteps,
                              .lightType = 2,
                              .tileCountX = Scene::tileCount.x,
                              .tileCountY = Scene::tileCount.y,
                              .findsHeights = limits.findsHeights,
                              .mostParts = limits.pages / gpu::PAGES_PER_PART,
                              .longestShared = limits.longestOfBlocks};
    const auto dispatch = [&](uint32_t which, uint32_t first, uint32_t count, uint32_t lists) {
        p.which = which;
        p.firstCluster = first;
        p.clusterCount = count;
        k.dispatch(f, set, p, form.together ? lists : gpu::divideUp(lists, form.lanes));
        fullBarrier(f.cmd);
    };
    dispatch(gpu::LISTS_OF_BLOCKS, Scene::firstBlock, Scene::blocks, Scene::blocks);
    p.pageCount = limits.pages;
    p.longest = p.longestShared = limits.longest;
    constexpr uint32_t side = gpu::BLOCK_SIDE;
    dispatch(gpu::LISTS_OF_TILES, 0, 0,
             gpu::divideUp(Scene::tileCount.x, side) * gpu::divideUp(Scene::tileCount.y, side) *
                 side * side);
    dispatch(gpu::LISTS_OF_SLICES, Scene::firstSlice, Scene::slices, Scene::slices + 40);
}

Made ClusterListsTest::make(const Scene& s, Form form, const Limits& limits)
{
    using namespace gpu;
    Buffer core = upload("lights", s.core);
    createTexelView(device(), core);
    const uint32_t nodeCount = s.tree.firstNode + s.tree.lightCount / 7 + 2 * TREE_LEVELS;
    Buffer nodes = upload("nodes", std::vector<glm::vec4>(nodeCount * TREE_NODE_STRIDE));
    createTexelView(device(), nodes);
    const Buffer clusters = upload("clusters", s.cluster), tiles = upload("tiles", s.tile);
    const Buffer splits = readback("splits", sizeof(WorkList));
    splits.as<WorkList>()[0].count = Scene::splitTiles;
    const Buffer heads = readback("heads", Scene::clusters * sizeof(uint32_t));
    const Buffer entries = readback("entries", limits.pages * PAGE_WORDS * sizeof(uint32_t));
    const Buffer counters = readback("counters", sizeof(LightingCounters));
    const Buffer lit = workOfTiles("lit", limits.pages / PAGES_PER_PART);
    const Buffer unlisted = workOfTiles("unlisted");

    // Both ways to read lights, one with each form, as far as texel buffers are large enough.
    const bool fit = std::max(core.size, nodes.size) / sizeof(glm::vec4) <=
                     device().limits.maxTexelBufferElements;
    const SpecConstant texels{SPEC_FOR_CPU, !form.together && fit};
    const Kernel<LightTreeParams> tree(
        device(), form.together ? spirv::light_tree_comp : spirv::cpu_light_tree_comp, {texels});
    const Kernel<ClusterListsParams> lists(
        device(), form.together ? spirv::cluster_lists_comp : spirv::cpu_cluster_lists_comp,
        {texels, {SPEC_LISTS_LANES, form.lanes}});
    const Bindings treeSet = tree.createBindings(1), listSet = lists.createBindings(1);
    treeSet.write(0, {Binding::ofTexels(LIGHT_CORE_TEXELS, core), Binding::of(LIGHT_CORE, core),
                      Binding::of(LIGHT_TREE_NODES, nodes)});
    listSet.write(
        0, {Binding::ofTexels(LIGHT_CORE_TEXELS, core), Binding::of(LIGHT_CORE, core),
            Binding::ofTexels(TREE_NODE_TEXELS, nodes), Binding::of(TREE_NODES, nodes),
            Binding::of(CLUSTER_LISTS_CLUSTERS, clusters), Binding::of(CLUSTER_LISTS_TILES, tiles),
            Binding::of(CLUSTER_LISTS_SPLITS, splits), Binding::of(CLUSTER_LISTS_LISTS, heads),
            Binding::of(CLUSTER_LISTS_ENTRIES, entries), Binding::of(CLUSTER_LISTS_LIT, lit),
            Binding::of(CLUSTER_LISTS_UNLISTED, unlisted),
            Binding::of(CLUSTER_LISTS_COUNTERS, counters)});
    Timer timer(device(), "lists", 1, false);
    context().submitAndWait([&](VkCommandBuffer cmd) {
        timer.begin(cmd, 0);
        const Frame f{device(), cmd, timer, 0};
        recordTree(f, s, tree, treeSet.set(0), form);
        recordLists(f, s, limits, lists, listSet.set(0), form);
    });
    const auto copy = []<typename T>(std::span<T> values) {
        return std::vector<T>(values.begin(), values.end());
    };
    Made made{.nodes = copy(nodes.as<glm::vec4>()),
              .heads = copy(heads.as<uint32_t>()),
              .entries = copy(entries.as<uint32_t>()),
              .lit = tilesOf(lit),
              .unlisted = tilesOf(unlisted),
              .counters = counters.as<LightingCounters>()[0]};
    for (uint32_t height = 0; height < TILE_HEIGHTS; ++height)
        made.litAt[height] = tilesOf(lit, height * TILE_CLASSES, TILE_CLASSES);
    return made;
}

// Returns how many clusters have this head.
long countHeads(const Made& made, uint32_t head, uint32_t end = Scene::clusters)
{
    return std::count(made.heads.begin(), made.heads.begin() + end, head);
}

// Expects that a light reaches none of 1,000 random points of a cluster's box that lie in its slab
// and in its cone, as its samples do. Returns how many points were tried.
size_t expectOutOfReach(const Scene& s, uint32_t cluster, uint32_t light)
{
    const gpu::Cluster& c = s.cluster[cluster];
    const glm::dvec3 centre = s.core[2 * light], low = c.min, high = c.max;
    const double influence2 = s.core[2 * light + 1].w;
    std::mt19937 random(light);
    std::uniform_real_distribution<double> unit(0, 1);
    size_t tried = 0;
    for (int i = 0; i < 1000; ++i) {
        const glm::dvec3 p =
            low + (high - low) * glm::dvec3(unit(random), unit(random), unit(random));
        const double height = glm::dot(glm::dvec3(c.axis), p);
        const glm::dvec3 ray = c.ray;
        if (height < c.slabMin || height > c.slabMax ||
            glm::length(glm::cross(p, ray)) > c.slope * glm::dot(p, ray))
            continue;
        ++tried;
        EXPECT_GE(glm::dot(p - centre, p - centre), influence2) << cluster << ", light " << light;
    }
    return tried;
}

} // namespace

TEST_F(ClusterListsTest, GroupsAndLanesMakeTheSame)
{
    uint64_t longest = 0;
    for (const uint32_t lights : {1, 7, 8, 9, 63, 64, 65, 300, 511, 513, 4095, 5000, 33000}) {
        const Scene scene = randomScene(lights, lights);
        const Made lanes = make(scene, byLane), group = make(scene, byGroup);
        EXPECT_EQ(std::memcmp(lanes.nodes.data(), group.nodes.data(),
                              lanes.nodes.size() * sizeof(glm::vec4)),
                  0)
            << lights;
        const Lights listed = lightsOf(group);
        EXPECT_EQ(listed, lightsOf(lanes)) << lights;
        for (const auto& list : listed)
            EXPECT_TRUE(std::ranges::is_sorted(list)) << lights;
        EXPECT_EQ(group.lit, lanes.lit) << lights;
        EXPECT_TRUE(group.unlisted.empty() && lanes.unlisted.empty()) << lights;
        EXPECT_EQ(group.counters.listEntries, lanes.counters.listEntries) << lights;
        EXPECT_EQ(group.counters.maxListLength, lanes.counters.maxListLength) << lights;
        longest = std::max<uint64_t>(longest, group.counters.maxListLength);
    }
    EXPECT_GT(longest, 3 * gpu::PAGE_LIGHTS);
}

// Every tile that is not split is a horizontal square of 1 m, far from the others, under a sphere
// of 1 m radius or two. Whatever is found of heights, the lists are the same.
TEST_F(ClusterListsTest, TilesAreOnTheWorkListsOfTheirHeights)
{
    struct Case {
        std::vector<float> heights; // of the centres of spheres, m
        float minCos;               // of the cone of normals
        uint32_t expected;
    };
    const Case cases[] = {{{0.5f}, 1, gpu::ANY_HEIGHT},       {{1.5f}, 1, gpu::NONE_ACROSS},
                          {{2.5f}, 1, gpu::ALL_ABOVE},        {{2.5f, 1.5f}, 1, gpu::NONE_ACROSS},
                          {{0.5f, 2.5f}, 1, gpu::ANY_HEIGHT}, {{4, 3}, 1, gpu::ALL_ABOVE},
                          {{2.5f}, 0.75f, gpu::NONE_ACROSS},  {{2.5f}, 0.3f, gpu::ANY_HEIGHT},
                          {{2.5f}, -0.5f, gpu::ANY_HEIGHT}};
    Scene s;
    s.tree = {.firstLight = 0, .firstNode = 0};
    const gpu::Cluster everything{.min = {-1, -1, -40},
                                  .max = {100 * Scene::tiles, 1, -20},
                                  .slabMin = -1e6f,
                                  .slabMax = 1e6f};
    s.cluster.assign(Scene::clusters, everything);
    std::vector<uint32_t> expected[gpu::TILE_HEIGHTS];
    for (uint32_t tile = 0; tile < Scene::tiles; ++tile) {
        const bool split = tile < Scene::splitTiles;
        const Case& c = cases[split ? 2 : tile % std::size(cases)];
        const glm::vec3 middle(100 * tile, 0, -30);
        for (const float height : c.heights) {
            s.core.emplace_back(middle.x, middle.y, middle.z + height, 1);
            s.core.emplace_back(1, 1, 1, 25);
        }
        const uint32_t cluster = split ? Scene::firstSlice + tile * gpu::SLICES : tile;
        for (uint32_t i = cluster; i < cluster + (split ? gpu::SLICES : 1); ++i)
            s.cluster[i] = {.min = middle - glm::vec3(0.5f, 0.5f, 0),
                            .tile = tile,
                            .max = middle + glm::vec3(0.5f, 0.5f, 0),
                            .parent = Scene::firstBlock,
                            .axis = {0, 0, 1},
                            .slabMin = middle.z,
                            .slabMax = middle.z,
                            .minCos = c.minCos};
        s.tile.push_back({cluster, 0, 7, split ? 1 : gpu::UNSPLIT, (tile % 2) << gpu::CLASS_BITS});
        expected[split ? gpu::ANY_HEIGHT : c.expected].push_back(tile);
    }
    s.tree.lightCount = uint32_t(s.core.size() / gpu::LIGHT_CORE_STRIDE);
    const Made found = make(s, byLane, {.findsHeights = true}), unknown = make(s, byLane);
    for (uint32_t height = 0; height < gpu::TILE_HEIGHTS; ++height) {
        EXPECT_FALSE(expected[height].empty());
        EXPECT_EQ(found.litAt[height], expected[height]) << height;
    }
    EXPECT_EQ(unknown.litAt[gpu::ANY_HEIGHT].size(), Scene::tiles);
    EXPECT_EQ(make(s, byGroup).litAt[gpu::ANY_HEIGHT].size(), Scene::tiles);
    EXPECT_EQ(lightsOf(found), lightsOf(unknown));
}

// On GPUs a group is mostly one subgroup, whose lanes need no shared memory to agree. Groups of
// fewer lanes make that so on devices with smaller subgroups too.
TEST_F(ClusterListsTest, GroupsOfAnySizeMakeTheSame)
{
    const Scene scene = randomScene(5000, 9);
    const Lights expected = lightsOf(make(scene, byGroup));
    for (const uint32_t lanes : {8, 16})
        EXPECT_EQ(lightsOf(make(scene, {true, lanes})), expected) << lanes;
}

// The tree of a million lights has seven levels, one more than the tree of 33,000.
TEST_F(ClusterListsTest, GroupsAndLanesMakeTheSameOfAMillionLights)
{
    // Each walk is short enough for llvmpipe, which ends loops after 65535 turns.
    const Scene scene = randomScene(1'000'000, 3, 0.125f);
    const Limits limits{.pages = 1u << 17};
    const Made lanes = make(scene, byLane, limits), group = make(scene, byGroup, limits);
    EXPECT_EQ(lightsOf(group), lightsOf(lanes));
    EXPECT_EQ(group.lit, lanes.lit);
    EXPECT_EQ(group.counters.listEntries, lanes.counters.listEntries);
    EXPECT_GT(group.counters.listEntries, 1000u);
}

// Clusters whose block has more lights than it may list find their lights in the tree, the same in
// both forms. A box of the tree may rule out a light that the light's own test does not. Such a
// light reaches no sample, and no light is found that is not in the lists made from the lists of
// blocks.
TEST_F(ClusterListsTest, ClustersOfBlocksWithoutListsWalkTheTree)
{
    const Scene scene = randomScene(33000, 4);
    const Lights byParents = lightsOf(make(scene, byLane));
    const Limits limits{.longestOfBlocks = 200};
    const Made lanes = make(scene, byLane, limits), group = make(scene, byGroup, limits);
    const Lights lights = lightsOf(lanes);
    EXPECT_EQ(lights, lightsOf(group));
    EXPECT_EQ(lanes.lit, group.lit);
    EXPECT_EQ(lanes.counters.listEntries, group.counters.listEntries);

    size_t listed = 0, blocksWithout = 0, found = 0, foundByParents = 0, points = 0;
    for (uint32_t i = 0; i < Scene::clusters; ++i) {
        EXPECT_EQ(lanes.heads[i] == gpu::LIST_LONG, group.heads[i] == gpu::LIST_LONG) << i;
        if (i >= Scene::firstBlock) {
            const bool tooLong = byParents[i].size() > 200;
            EXPECT_EQ(lanes.heads[i] == gpu::LIST_LONG, tooLong) << i;
            blocksWithout += tooLong;
            continue;
        }
        EXPECT_TRUE(std::ranges::includes(byParents[i], lights[i])) << i;
        if (lanes.heads[scene.cluster[i].parent] == gpu::LIST_LONG) {
            found += lights[i].size();
            foundByParents += byParents[i].size();
            std::vector<uint32_t> missing;
            std::ranges::set_difference(byParents[i], lights[i], std::back_inserter(missing));
            for (const uint32_t light : missing)
                points += expectOutOfReach(scene, i, light);
        } else {
            listed += !lights[i].empty();
            EXPECT_EQ(lights[i], byParents[i]) << i;
        }
    }
    EXPECT_GT(listed, 5u);
    EXPECT_GT(blocksWithout, 5u);
    EXPECT_GT(found, foundByParents / 10 * 9);
    EXPECT_GT(points, 100u);
}

// Lists of tiles are made together or alone, depending on how long the lists of their parents are.
// Lights of a turn belong to several lists, some lists do not exist, and some are empty.
TEST_F(ClusterListsTest, ListsThatShareAGroupHoldTheirOwnLights)
{
    size_t wholePages = 0;
    for (const auto& [reach, share] : {std::pair(0.3f, 0.5f), {1.0f, 0.3f}, {8.0f, 1.0f}})
        for (const uint32_t lanes : {8, 16, 32}) {
            SCOPED_TRACE(testing::Message() << reach << " m, " << lanes << " lanes");
            const Scene scene = blockScene(lanes, reach, share);
            const Made lane = make(scene, byLane), group = make(scene, {true, lanes});
            const Lights listed = lightsOf(group);
            EXPECT_EQ(listed, lightsOf(lane));
            for (uint32_t i = 0; i < Scene::blocks; ++i)
                EXPECT_EQ(listed[Scene::firstBlock + i].size(),
                          lightsOfBlocks[i % std::size(lightsOfBlocks)]);
            EXPECT_EQ(group.lit, lane.lit);
            EXPECT_EQ(group.counters.listEntries, lane.counters.listEntries);
            EXPECT_EQ(group.counters.maxListLength, lane.counters.maxListLength);
            for (uint32_t i = 0; i < Scene::firstBlock; ++i)
                wholePages += listed[i].size() == gpu::PAGE_LIGHTS;
        }
    EXPECT_GT(wholePages, 5u);
}

// The schedule decides which lists find pages. Those that do hold the same lights as with enough
// pages, and all others are marked.
TEST_F(ClusterListsTest, ListsOfGroupsWithoutRoomAreMarked)
{
    const auto check = [&](const Scene& scene, uint32_t pages, long leastShort) {
        const Lights expected = lightsOf(make(scene, byGroup));
        for (const Form form : {byLane, byGroup}) {
            const Made few = make(scene, form, {.pages = pages});
            const Lights got = lightsOf(few);
            // Lists of tiles and slices whose parents' lists have one page.
            long shortListed = 0, shortUnlisted = 0;
            for (uint32_t i = 0; i < Scene::clusters; ++i) {
                const bool listed =
                    few.heads[i] != gpu::LIST_UNLISTED && few.heads[i] != gpu::LIST_LONG;
                if (listed) {
                    EXPECT_EQ(got[i], expected[i]) << i;
                }
                const size_t candidates =
                    i < Scene::firstBlock ? got[scene.cluster[i].parent].size() : 0;
                if (candidates != 0 && candidates <= gpu::PAGE_LIGHTS) {
                    shortListed += listed && !got[i].empty();
                    shortUnlisted += few.heads[i] == gpu::LIST_UNLISTED;
                }
            }
            EXPECT_GE(shortListed, leastShort);
            EXPECT_GE(shortUnlisted, leastShort);
            const long unlisted = countHeads(few, gpu::LIST_UNLISTED, Scene::firstBlock);
            EXPECT_GT(unlisted, 10);
            EXPECT_EQ(few.counters.unlistedClusters, unlisted);
            EXPECT_FALSE(few.unlisted.empty());
        }
    };
    check(randomScene(5000, 6), 60, 0); // 0: this check does not need short lists
    // Blocks have lists, and the pages end among the lists of tiles that are made together.
    check(blockScene(6, 1, 0.5f), 232, 10);
}

// On devices that limit loops, lists that are too long to be walked, and unlisted clusters with too
// long a walk through the tree, are marked as long.
TEST_F(ClusterListsTest, LongListsOfGroupsAreMarked)
{
    const Scene scene = randomScene(5000, 6);
    const Limits limits{.longest = 15};
    const Made lanes = make(scene, byLane, limits), group = make(scene, byGroup, limits);
    EXPECT_GT(countHeads(group, gpu::LIST_LONG), 10);
    for (uint32_t i = 0; i < Scene::clusters; ++i)
        EXPECT_EQ(group.heads[i] == gpu::LIST_LONG, lanes.heads[i] == gpu::LIST_LONG) << i;
    EXPECT_EQ(lightsOf(group), lightsOf(lanes));
    EXPECT_EQ(group.unlisted, lanes.unlisted);

    const Limits noPages{.pages = 2, .maxUnlistedSteps = 300};
    const Made emptyLanes = make(scene, byLane, noPages),
               emptyGroup = make(scene, byGroup, noPages);
    EXPECT_GT(countHeads(emptyGroup, gpu::LIST_LONG, Scene::firstBlock), 10);
    for (uint32_t i = 0; i < Scene::clusters; ++i)
        if (emptyGroup.heads[i] != gpu::LIST_EMPTY) {
            EXPECT_EQ(emptyGroup.heads[i], emptyLanes.heads[i]) << i;
        }
}

} // namespace candelabra::test
