// SPDX-License-Identifier: Apache-2.0
// tile_clusters, split_tiles and block_clusters have a form for GPUs, in which several lanes make a
// cluster, and one for llvmpipe, in which each lane works alone. Both must make the same
// clusters, on llvmpipe to the bit.
#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <optional>
#include <random>

#include "candelabra_shaders.h"
#include "clusters/clusters.h"
#include "gpu/two_classes.h"
#include "shared/cluster_data.h"
#include "surfaces/frame_uniforms.h"
#include "surfaces/host_gbuffer.h"

namespace candelabra::test
{
namespace
{

using gpu::divideUp;

// The places of the records of tiles and blocks, and of their clusters.
struct Places {
    glm::uvec2 tiles, blocks;
    uint32_t firstSlice, firstBlock, clusters; // of clusters

    explicit Places(const CpuGBuffer& g)
        : tiles((glm::uvec2(g.width, g.height) + gpu::TILE_SIZE - 1u) / gpu::TILE_SIZE),
          blocks((tiles + gpu::BLOCK_SIDE - 1u) / gpu::BLOCK_SIDE),
          firstSlice(tileCount()),
          firstBlock(firstSlice + tileCount() * gpu::SLICES),
          clusters(firstBlock + blockCount() * gpu::BLOCK_SLICES)
    {
    }
    uint32_t tileCount() const { return tiles.x * tiles.y; }
    uint32_t blockCount() const { return blocks.x * blocks.y; }
};

// The output of the kernels.
struct Made {
    std::vector<gpu::TileClusters> tiles;
    std::vector<gpu::Cluster> clusters;
    std::vector<uint32_t> ofClass[gpu::TILE_CLASSES]; // tiles, sorted
    std::vector<uint32_t> splits;                     // tiles, sorted
};

// Returns the tiles of one of the work lists with which a buffer begins, sorted.
std::vector<uint32_t> sortedTiles(const gpu::Buffer& buffer, uint32_t lists, uint32_t list)
{
    const gpu::WorkList work = buffer.as<gpu::WorkList>()[list];
    const auto tiles = buffer.as<uint32_t>()
                           .subspan(lists * sizeof(gpu::WorkList) / sizeof(uint32_t))
                           .subspan(work.first, work.count);
    std::vector<uint32_t> out(tiles.begin(), tiles.end());
    std::ranges::sort(out);
    return out;
}

// Tells whether clusters of the two forms agree. On other drivers than llvmpipe a division may have
// other bits in each pipeline. How many slices a block has follows from divisions too, but no block
// of these tests is so close to a limit that the last bit decides.
bool sameBounds(const gpu::Cluster& a, const gpu::Cluster& b, bool bits)
{
    const bool sameBits = std::memcmp(&a, &b, sizeof a) == 0;
    if (bits || sameBits)
        return sameBits;
    const auto near = [](float x, float y) { return std::abs(x - y) <= 1e-4f * (1 + std::abs(x)); };
    bool same = a.tile == b.tile && a.parent == b.parent && a.depthBits == b.depthBits &&
                near(a.slabMin, b.slabMin) && near(a.slabMax, b.slabMax) &&
                near(a.minCos, b.minCos) && near(a.slope, b.slope);
    for (int i = 0; i < 3; ++i)
        same = same && near(a.min[i], b.min[i]) && near(a.max[i], b.max[i]) &&
               near(a.axis[i], b.axis[i]) && near(a.ray[i], b.ray[i]);
    return same;
}

// The kernels in one of their forms.
struct Kernels {
    gpu::Kernel<gpu::TileClustersParams> tile, split;
    gpu::Kernel<gpu::BlockClustersParams> block;
    bool lanesTogether;

    Kernels(const gpu::Device& device, uint32_t gbuffer, bool together)
        : tile(device, together ? spirv::tile_clusters_comp : spirv::cpu_tile_clusters_comp,
               {{gpu::SPEC_GBUFFER, gbuffer}, {gpu::SPEC_FINDS_DIFFUSE, true}}),
          split(device, together ? spirv::split_tiles_comp : spirv::cpu_split_tiles_comp,
                {{gpu::SPEC_GBUFFER, gbuffer}}),
          block(device, together ? spirv::block_clusters_comp : spirv::cpu_block_clusters_comp),
          lanesTogether(together)
    {
    }
};

// Their descriptor sets and the buffers that they fill.
struct State {
    gpu::Bindings tileSet, splitSet, blockSet;
    gpu::Buffer tiles, clusters, ofClass, splits;
};

// Dispatches at least as many groups, in two rows: large frames have more groups than one row.
void dispatch(const gpu::Frame& f, const auto& kernel, const gpu::Bindings& set, const auto& params,
              uint32_t groups)
{
    kernel.dispatch(f, set.set(0), params, divideUp(groups, 2), 2);
    fullBarrier(f.cmd);
}

// Records what Clusters::recordClusters does.
void record(const gpu::Frame& f, const Kernels& k, const State& s, const Places& at,
            float splitLength)
{
    const gpu::TileClustersParams params{.tileCount = at.tileCount(),
                                         .firstSplit = at.firstSlice,
                                         .splitCapacity = at.tileCount(),
                                         .splitLength = splitLength};
    dispatch(f, k.tile, s.tileSet, params,
             divideUp(params.tileCount * (k.lanesTogether ? gpu::TILE_SIZE : 1),
                      gpu::TILE_CLUSTERS_GROUP));
    k.split.dispatchIndirect(f, s.splitSet.set(0), params, s.splits);
    fullBarrier(f.cmd);
    dispatch(f, k.block, s.blockSet,
             gpu::BlockClustersParams{.tileCountX = at.tiles.x,
                                      .tileCountY = at.tiles.y,
                                      .blockFirst = at.tileCount(),
                                      .blockCountX = at.blocks.x,
                                      .blockCount = at.blockCount(),
                                      .clusterFirst = at.firstBlock},
             k.lanesTogether
                 ? at.blockCount()
                 : divideUp(at.blockCount() * gpu::BLOCK_SLICES, gpu::BLOCK_CLUSTERS_GROUP));
}

class ClusterBoundsTest : public LightingTest
{
protected:
    // Tiles longer than `splitLength` metres are split.
    Made make(const CpuGBuffer& g, bool lanesTogether, float splitLength);
    // Expects that blocks have as many slices as their length and width ask for, in
    // the form for GPUs or in that for lanes alone. Counts the blocks by the binary logarithm of
    // their number of slices.
    void expectSlices(const CpuGBuffer& g, bool lanesTogether);
    size_t blocksBySlices_[4] = {};
    // Compares what both forms make.
    void compare(const CpuGBuffer& g, float splitLength);
    size_t splits_ = 0; // tiles that were split in all comparisons

private:
    std::optional<Kernels> kernels_[2]; // by lanesTogether
    State stateOf(const Kernels& k, const Places& at, const surfaces::GBufferViews& views,
                  const surfaces::FrameUniforms& uniforms) const;
};

State ClusterBoundsTest::stateOf(const Kernels& k, const Places& at,
                                 const surfaces::GBufferViews& views,
                                 const surfaces::FrameUniforms& uniforms) const
{
    using namespace gpu;
    const uint32_t tiles = at.tileCount();
    std::vector<WorkList> work(2 + divideUp(tiles * sizeof(uint32_t), sizeof(WorkList)));
    work[0] = {.groupsX =
                   SPLIT_ROW * (k.lanesTogether ? TILE_SIZE * SLICES : 1) / SPLIT_TILES_GROUP,
               .groupsZ = 1};
    State s{.tileSet = k.tile.createBindings(1),
            .splitSet = k.split.createBindings(1),
            .blockSet = k.block.createBindings(1),
            .tiles = readback("tiles", (tiles + at.blockCount()) * sizeof(TileClusters)),
            .clusters = readback("clusters", at.clusters * sizeof(Cluster)),
            .ofClass = readback("tiles of classes", TILE_WORK_LISTS * sizeof(WorkList) +
                                                        TILE_CLASSES * tiles * sizeof(uint32_t)),
            .splits = upload("splits", work)};
    for (uint32_t i = 0; i < TILE_CLASSES; ++i)
        s.ofClass.as<WorkList>()[i].first = i * tiles;
    const Binding depth = Binding::sampled(TILE_CLUSTERS_DEPTH, views.depth),
                  params = uniforms.at(0),
                  toClusters = Binding::of(TILE_CLUSTERS_CLUSTERS, s.clusters),
                  toTiles = Binding::of(TILE_CLUSTERS_TILES, s.tiles),
                  toSplits = Binding::of(TILE_CLUSTERS_SPLITS, s.splits);
    s.tileSet.write(0,
                    {depth, params, toClusters, toTiles, toSplits,
                     Binding::of(TILE_CLUSTERS_SURFACES, s.ofClass)},
                    views.bindings());
    s.splitSet.write(0, {depth, params, toClusters, toTiles, toSplits}, views.normalBindings());
    s.blockSet.write(0, {Binding::of(BLOCK_CLUSTERS_CLUSTERS, s.clusters),
                         Binding::of(BLOCK_CLUSTERS_TILES, s.tiles), uniforms.at(0)});
    return s;
}

Made ClusterBoundsTest::make(const CpuGBuffer& g, bool lanesTogether, float splitLength)
{
    const Images images = uploadImages(g);
    surfaces::GBufferSource source(device(), CND_GBUFFER_FULL, {});
    surfaces::FrameUniforms uniforms(device(), 1);
    const auto frame = surfaceFrame<CndLightingFrame>(g, images);
    uniforms.write(0, surfaces::frameParams(frame, source, VK_FORMAT_R32G32B32A32_SFLOAT));
    const Places at(g);
    std::optional<Kernels>& kernels = kernels_[lanesTogether];
    if (!kernels)
        kernels.emplace(device(), source.code(), lanesTogether);
    const State state = stateOf(*kernels, at, source.views(frame), uniforms);
    gpu::Timer timer(device(), "bounds", 1, false);
    context().submitAndWait([&](VkCommandBuffer cmd) {
        timer.begin(cmd, 0);
        const gpu::Frame f{device(), cmd, timer, 0};
        source.record(f);
        record(f, *kernels, state, at, splitLength);
    });
    const auto records = state.tiles.as<gpu::TileClusters>();
    const auto bounds = state.clusters.as<gpu::Cluster>();
    Made made{.tiles = {records.begin(), records.end()},
              .clusters = {bounds.begin(), bounds.end()},
              .splits = sortedTiles(state.splits, 2, 0)};
    for (uint32_t i = 0; i < gpu::TILE_CLASSES; ++i)
        made.ofClass[i] = sortedTiles(state.ofClass, gpu::TILE_WORK_LISTS, i);
    return made;
}

void ClusterBoundsTest::compare(const CpuGBuffer& g, float splitLength)
{
    const Made lanes = make(g, false, splitLength), groups = make(g, true, splitLength);
    for (uint32_t i = 0; i < gpu::TILE_CLASSES; ++i)
        EXPECT_EQ(groups.ofClass[i], lanes.ofClass[i]) << "class " << i;
    EXPECT_EQ(groups.splits, lanes.splits);
    splits_ += lanes.splits.size();
    const Places at(g);
    for (size_t i = 0; i < lanes.tiles.size(); ++i) {
        const gpu::TileClusters &a = groups.tiles[i], &b = lanes.tiles[i];
        // On other drivers than llvmpipe the last bit of a division may decide how many slices a
        // block has, and so its shift. No block of these tests is so close to a limit.
        ASSERT_TRUE(a.lowest == b.lowest && a.highest == b.highest && a.shift == b.shift &&
                    a.onLists == b.onLists)
            << "tile or block " << i;
        if (a.lowest > a.highest)
            continue;
        // The place of a split tile's slices depends on the order in which tiles run.
        const uint32_t count = i >= at.tileCount()       ? gpu::BLOCK_SLICES
                               : a.shift == gpu::UNSPLIT ? 1
                                                         : gpu::SLICES;
        for (uint32_t k = 0; k < count; ++k)
            EXPECT_TRUE(sameBounds(groups.clusters[a.first + k], lanes.clusters[b.first + k],
                                   device().lanesAreCpuVector))
                << "tile or block " << i << ", slice " << k;
    }
}

// Returns the length of a block's samples along the z axis of view space over the width of its
// pixels at the nearest sample, by positions in double precision. NaN if the block has no sample.
double lengthOverWidth(const CpuGBuffer& g, glm::uvec2 first, uint32_t side)
{
    double low = INFINITY, high = -INFINITY;
    CpuGBuffer nearest{.width = g.width, .height = g.height, .camera = g.camera};
    for (uint32_t y = first.y; y < std::min(first.y + side, g.height); ++y)
        for (uint32_t x = first.x; x < std::min(first.x + side, g.width); ++x)
            if (const float depth = g.depth[size_t(y) * g.width + x]; depth != g.clearDepth) {
                const double z = viewPosition(g, x, y).z;
                if (z > high)
                    nearest.depth = {depth, depth};
                low = std::min(low, z);
                high = std::max(high, z);
            }
    if (low > high)
        return NAN;
    return (high - low) / (side * (viewPosition(nearest, 1, 0).x - viewPosition(nearest, 0, 0).x));
}

// Moves each surface to 10 m from the camera, plus up to 12 m at the right edge of the image and
// less at random and to the left.
void deepenToTheRight(CpuGBuffer& g, uint32_t seed)
{
    std::mt19937 random(seed);
    for (size_t i = 0; i < g.depth.size(); ++i)
        if (g.depth[i] != g.clearDepth) {
            const double most = 12.0 * double(i % g.width) / g.width;
            g.depth[i] = depthAt(g.camera, 10 + most * double(random()) / 4294967296.0);
        }
}

// Leaves no surface in whole tiles and blocks: in the right third of the image, in tiles of the
// left third that lie like the black squares of a chessboard, but for the last pixel of every
// fourth of them.
void makeHoles(CpuGBuffer& g)
{
    for (uint32_t y = 0; y < g.height; ++y)
        for (uint32_t x = 0; x < g.width; ++x) {
            const glm::uvec2 tile = glm::uvec2(x, y) / gpu::TILE_SIZE;
            const bool last = (x + 1) % gpu::TILE_SIZE == 0 && (y + 1) % gpu::TILE_SIZE == 0;
            const bool black = (tile.x + tile.y) % 2 == 0 && !(last && tile.x % 4 == 0);
            if (x > g.width * 2 / 3 || (x < g.width / 3 && black))
                g.depth[size_t(y) * g.width + x] = g.clearDepth;
        }
}

void ClusterBoundsTest::expectSlices(const CpuGBuffer& g, bool lanesTogether)
{
    const Made made = make(g, lanesTogether, 1e6f);
    const Places at(g);
    constexpr uint32_t side = gpu::TILE_SIZE * gpu::BLOCK_SIDE;
    for (uint32_t i = 0; i < at.blockCount(); ++i) {
        const gpu::TileClusters& block = made.tiles[at.tileCount() + i];
        const double ratio =
            lengthOverWidth(g, {i % at.blocks.x * side, i / at.blocks.x * side}, side);
        EXPECT_EQ(block.lowest > block.highest, std::isnan(ratio)) << "block " << i;
        const bool atLimit = std::ranges::any_of(
            std::array{1., 2., 4.}, [&](double r) { return std::abs(ratio / r - 1) < 1e-3; });
        if (std::isnan(ratio) || atLimit)
            continue;
        const uint32_t bits = ratio > 4 ? 3 : ratio > 2 ? 2 : ratio > 1 ? 1 : 0;
        const uint32_t width = uint32_t(std::bit_width(block.highest - block.lowest));
        EXPECT_EQ(block.shift, width > bits ? width - bits : 0)
            << "block " << i << ", length / width " << ratio;
        ++blocksBySlices_[bits];
    }
}

} // namespace

TEST_F(ClusterBoundsTest, LongBlocksHaveMoreSlices)
{
    CndCamera reversed{}, notReversed{}, orthographic{};
    setPerspective(reversed, 1.0, 1.65, 0.1);
    setPerspective(notReversed, 1.0, 1.65, 0.1, 100, false);
    setOrthographic(orthographic, 20, 1.65, 0.1, 100, false);
    for (const auto& [camera, clearDepth] :
         {std::pair{reversed, 0.f}, {notReversed, 1.f}, {orthographic, 1.f}})
        for (const bool lanesTogether : {true, false}) {
            CpuGBuffer g = randomGBuffer(331, 200, camera, clearDepth, 1);
            expectSlices(g, lanesTogether);
            deepenToTheRight(g, 2);
            expectSlices(g, lanesTogether);
            makeHoles(g);
            expectSlices(g, lanesTogether);
        }
    for (const size_t blocks : blocksBySlices_)
        EXPECT_GT(blocks, 20u);
}

TEST_F(ClusterBoundsTest, GroupsAndLanesMakeTheSame)
{
    for (const auto& [width, height] :
         {std::pair{1u, 1u}, {8u, 8u}, {9u, 15u}, {130u, 77u}, {331u, 200u}})
        for (const float splitLength : {0.1f, 1.0f, 1e6f})
            compare(randomGBuffer(width, height, width), splitLength);
    EXPECT_GT(splits_, 200u);
}

TEST_F(ClusterBoundsTest, GroupsAndLanesMakeTheSameWhereNothingIsSeen)
{
    for (const auto& [width, height] : {std::pair{8u, 8u}, {130u, 77u}, {331u, 200u}}) {
        CpuGBuffer g = randomGBuffer(width, height, width);
        makeHoles(g);
        compare(g, 1);
        std::ranges::fill(g.depth, g.clearDepth);
        compare(g, 1);
    }
}

TEST_F(ClusterBoundsTest, GroupsAndLanesFindTheSameClasses)
{
    compare(twoClasses(144, 96), 2);
}

TEST_F(ClusterBoundsTest, GroupsAndLanesMakeTheSameOfOrthographicFrames)
{
    CndCamera camera{};
    setOrthographic(camera, 20, 1.5, 0.1, 100, false);
    compare(randomGBuffer(150, 100, camera, 1, 4), 0.5f);
    EXPECT_GT(splits_, 20u);
}

} // namespace candelabra::test
