// SPDX-License-Identifier: Apache-2.0
#include "clusters/clusters.h"

#include <algorithm>
#include <tuple>

#include "candelabra_shaders.h"
#include "lights/light_limits.h"

namespace candelabra::lighting
{
namespace
{

using gpu::divideUp;

constexpr VkBufferUsageFlags storageUse = VK_BUFFER_USAGE_STORAGE_BUFFER_BIT;
constexpr VkBufferUsageFlags workUse =
    storageUse | VK_BUFFER_USAGE_INDIRECT_BUFFER_BIT | VK_BUFFER_USAGE_TRANSFER_DST_BIT;
constexpr VkDeviceSize pageBytes = gpu::PAGE_WORDS * sizeof(uint32_t);

// The bits of gpu::TileClusters::onLists do not overlap.
static_assert(gpu::UNLISTED_BITS + CND_LIGHT_TYPE_COUNT <= gpu::LIT_BITS &&
              gpu::LIT_BITS + CND_LIGHT_TYPE_COUNT <= gpu::CLASS_BITS);

// A page has a word for each pixel of a tile (gpu::SUM_PAGES).
static_assert(gpu::PAGE_WORDS == gpu::TILE_SIZE * gpu::TILE_SIZE);

// A group of light_tree reads the children of the children of one node.
static_assert(gpu::LIGHT_TREE_GROUP == gpu::TREE_WIDTH * gpu::TREE_WIDTH);

// Blocks with more lights than this have no list, and the clusters in them find their lights in the
// tree: each of them keeps few of so many lights. Of the lengths that were measured, this one is
// among the fastest in the hall, and takes up to 1.3 of the time without a limit in the fence
// (DECISIONS 70).
constexpr uint32_t longestBlockList = 1024;
// The longest list of a block if proofs follow, which may remove most of its lights (DECISIONS 82).
constexpr uint32_t longestProvenList = 16384;

uint32_t nodeCount(uint32_t lights)
{
    uint32_t count = 0;
    for (uint32_t level = lights; level; level = level > 1 ? divideUp(level, gpu::TREE_WIDTH) : 0)
        count += divideUp(level, gpu::TREE_WIDTH);
    return lights == 1 ? 2 : count; // light_tree makes levels in pairs
}

glm::uvec2 blocksOf(glm::uvec2 tileCount)
{
    return {divideUp(tileCount.x, gpu::BLOCK_SIDE), divideUp(tileCount.y, gpu::BLOCK_SIDE)};
}

uint32_t area(glm::uvec2 size)
{
    return size.x * size.y;
}

VkDeviceSize workBytes(uint32_t lists, uint32_t items)
{
    return lists * sizeof(gpu::WorkList) + VkDeviceSize(items) * sizeof(uint32_t);
}

} // namespace

ClusterKernels::ClusterKernels(const gpu::Device& device, const surfaces::HostKernels& host,
                               uint32_t gbuffer, bool findsDiffuse)
    : lanesTogether(!device.lanesAreCpuVector),
      lightTree(device, lanesTogether ? spirv::light_tree_comp : spirv::cpu_light_tree_comp,
                {{gpu::SPEC_FOR_CPU, forCpu(device)}}),
      tileClusters(
          device,
          host.used(lanesTogether ? spirv::tile_clusters_comp : spirv::cpu_tile_clusters_comp),
          {{gpu::SPEC_GBUFFER, gbuffer}, {gpu::SPEC_FINDS_DIFFUSE, findsDiffuse}},
          host.setLayout()),
      splitTiles(device,
                 host.used(lanesTogether ? spirv::split_tiles_comp : spirv::cpu_split_tiles_comp),
                 {{gpu::SPEC_GBUFFER, gbuffer}}, host.setLayout()),
      blockClusters(device,
                    lanesTogether ? spirv::block_clusters_comp : spirv::cpu_block_clusters_comp),
      clusterLists(device,
                   lanesTogether ? spirv::cluster_lists_comp : spirv::cpu_cluster_lists_comp,
                   {{gpu::SPEC_FOR_CPU, forCpu(device)}})
{
}

uint32_t tileHeightsOf(const gpu::Device& device, uint32_t lightType)
{
    const bool spheres = isSphere(lightType) && !isDistant(lightType);
    return device.lanesAreCpuVector && spheres ? gpu::TILE_HEIGHTS : 1;
}

TreeShapes treeShapes(const LightTypeCounts& counts)
{
    TreeShapes shapes{};
    uint32_t light = 0, node = 0;
    for (uint32_t type = 0; type < CND_LIGHT_TYPE_COUNT; ++type) {
        shapes[type] = {.firstLight = light, .lightCount = counts[type], .firstNode = node};
        light += counts[type];
        node += nodeCount(counts[type]);
    }
    return shapes;
}

Clusters::Clusters(const gpu::Device& device, const ClusterKernels& kernels,
                   gpu::Recordings& recordings, const Sizes& sizes)
    : device_(device),
      kernels_(kernels),
      recordings_(recordings),
      sizes_(sizes),
      splitCapacity_(area(sizes.maxTiles))
{
    const glm::uvec2 maxTiles = sizes.maxTiles;
    const uint32_t blockCount = area(blocksOf(maxTiles));
    const VkDeviceSize largest = device.limits.maxStorageBufferRange / sizeof(gpu::Cluster);
    const VkDeviceSize fixed = area(maxTiles) + VkDeviceSize(blockCount) * gpu::BLOCK_SLICES;
    if (largest < fixed)
        gpu::failUnsupported("CndLightingViewDesc: " + std::to_string(area(maxTiles)) +
                             " tiles of 8x8 pixels need " + std::to_string(fixed) +
                             " clusters, the device's maxStorageBufferRange holds " +
                             std::to_string(largest));
    // There is room to split all tiles, unless that exceeds the device's limit for buffers. Then
    // deep tiles without room keep one cluster, whose list is longer but as correct. Which tiles
    // these are depends on the order in which the device runs them.
    splitCapacity_ =
        uint32_t(std::min<VkDeviceSize>(splitCapacity_, (largest - fixed) / gpu::SLICES));
    if (splitCapacity_ < area(maxTiles))
        device.say(CND_MESSAGE_INFO,
                   "cndCreateLightingView: maxStorageBufferRange has room for slices of depth in "
                   "%u of %u tiles: deep tiles beyond that have longer lists",
                   splitCapacity_, area(maxTiles));
    clusterCount_ = uint32_t(fixed) + splitCapacity_ * gpu::SLICES;
    treeSets_ = kernels.lightTree.createBindings(sizes.slots);
    tileSets_ = kernels.tileClusters.createBindings(sizes.slots);
    splitSets_ = kernels.splitTiles.createBindings(sizes.slots);
    blockSets_ = kernels.blockClusters.createBindings(sizes.slots);
    listSets_ = kernels.clusterLists.createBindings(sizes.slots * CND_LIGHT_TYPE_COUNT);
    const auto make = [&](const char* name, VkDeviceSize bytes, VkBufferUsageFlags use) {
        return gpu::createBuffer(device, name, bytes, use, gpu::MemoryUse::Scratch);
    };
    tiles_ = make("tiles", VkDeviceSize(area(maxTiles) + blockCount) * sizeof(gpu::TileClusters),
                  storageUse);
    clusters_ = make("clusters", VkDeviceSize(clusterCount_) * sizeof(gpu::Cluster), storageUse);
    surfaces_ = make("surface tiles", tileWorkBytes(1), workUse | VK_BUFFER_USAGE_TRANSFER_SRC_BIT);
    splits_ = make("split tiles", workBytes(2, splitCapacity_),
                   workUse | VK_BUFFER_USAGE_TRANSFER_SRC_BIT);
    entries_ = make("list entries", std::max(sizes.listBudget, 2 * pageBytes),
                    storageUse | VK_BUFFER_USAGE_UNIFORM_TEXEL_BUFFER_BIT);
    gpu::createTexelView(device, entries_, VK_FORMAT_R32_UINT, sizeof(uint32_t));
    sums_ = make("sums of parts", (donePages() + mostParts() * gpu::SUM_PAGES) * pageBytes,
                 storageUse | VK_BUFFER_USAGE_TRANSFER_DST_BIT);
}

// Each list of a buffer of tiles has room for all tiles, since all may be on the same one, and for
// `parts` of lists. `heights`: for how many heights there is room.
VkDeviceSize Clusters::tileWorkBytes(uint32_t heights, uint32_t parts) const
{
    return workBytes(gpu::TILE_WORK_LISTS, heights * sizes_.tileClasses * (maxTileCount() + parts));
}

Clusters::Lists Clusters::createLists(uint32_t type) const
{
    const auto make = [&](const char* name, VkDeviceSize bytes, VkBufferUsageFlags use) {
        return gpu::createBuffer(device_, name, bytes, use, gpu::MemoryUse::Scratch);
    };
    return {
        .heads = make("list heads", clusterCount_ * sizeof(uint32_t), storageUse),
        .lit = make("lit tiles", tileWorkBytes(tileHeightsOf(device_, type), mostParts()), workUse),
        .unlisted = make("unlisted tiles", tileWorkBytes(1), workUse)};
}

void Clusters::grow(uint32_t lightCapacity, const LightTypeCounts& types)
{
    // There are enough nodes however the lights are distributed over the types: on every level the
    // number of nodes of each type is rounded up.
    const VkDeviceSize nodes = nodeCount(lightCapacity) + CND_LIGHT_TYPE_COUNT * gpu::TREE_LEVELS;
    const VkDeviceSize bytes = nodes * gpu::TREE_NODE_STRIDE * sizeof(glm::vec4);
    if (bytes > nodes_.size) {
        gpu::Buffer grown = gpu::createBuffer(device_, "light tree", bytes,
                                              storageUse | VK_BUFFER_USAGE_UNIFORM_TEXEL_BUFFER_BIT,
                                              gpu::MemoryUse::Scratch);
        gpu::createTexelView(device_, grown);
        recordings_.replace(nodes_, std::move(grown));
    }
    for (uint32_t type = 0; type < CND_LIGHT_TYPE_COUNT; ++type)
        if (types[type] && !lists_[type].heads.buffer)
            lists_[type] = createLists(type);
}

void Clusters::writeBindings(uint32_t slot, const LightTypeCounts& types, const Inputs& in) const
{
    using namespace gpu;
    treeSets_.write(slot,
                    {Binding::ofTexels(LIGHT_CORE_TEXELS, in.core),
                     Binding::of(LIGHT_CORE, in.core), Binding::of(LIGHT_TREE_NODES, nodes_)});
    const Binding depth = Binding::sampled(TILE_CLUSTERS_DEPTH, in.gbuffer.depth);
    const Binding frame = in.uniforms.at(slot);
    tileSets_.write(slot,
                    {depth, frame, Binding::of(TILE_CLUSTERS_CLUSTERS, clusters_),
                     Binding::of(TILE_CLUSTERS_TILES, tiles_),
                     Binding::of(TILE_CLUSTERS_SURFACES, surfaces_),
                     Binding::of(TILE_CLUSTERS_SPLITS, splits_)},
                    in.gbuffer.bindings());
    splitSets_.write(slot,
                     {depth, frame, Binding::of(TILE_CLUSTERS_CLUSTERS, clusters_),
                      Binding::of(TILE_CLUSTERS_TILES, tiles_),
                      Binding::of(TILE_CLUSTERS_SPLITS, splits_)},
                     in.gbuffer.normalBindings());
    blockSets_.write(slot, {Binding::of(BLOCK_CLUSTERS_CLUSTERS, clusters_),
                            Binding::of(BLOCK_CLUSTERS_TILES, tiles_), in.uniforms.at(slot)});
    for (uint32_t type = 0; type < CND_LIGHT_TYPE_COUNT; ++type)
        if (types[type])
            listSets_.write(
                slot * CND_LIGHT_TYPE_COUNT + type,
                {Binding::ofTexels(LIGHT_CORE_TEXELS, in.core), Binding::of(LIGHT_CORE, in.core),
                 Binding::ofTexels(TREE_NODE_TEXELS, nodes_), Binding::of(TREE_NODES, nodes_),
                 Binding::of(CLUSTER_LISTS_CLUSTERS, clusters_),
                 Binding::of(CLUSTER_LISTS_TILES, tiles_),
                 Binding::of(CLUSTER_LISTS_SPLITS, splits_),
                 Binding::of(CLUSTER_LISTS_LISTS, lists_[type].heads),
                 Binding::of(CLUSTER_LISTS_ENTRIES, entries_),
                 Binding::of(CLUSTER_LISTS_LIT, lists_[type].lit),
                 Binding::of(CLUSTER_LISTS_UNLISTED, lists_[type].unlisted),
                 Binding::of(CLUSTER_LISTS_COUNTERS, in.counters)});
}

// Returns how many groups of cluster_lists make so many lists.
uint32_t Clusters::listGroups(uint32_t lists) const noexcept
{
    return kernels_.lanesTogether ? lists : divideUp(lists, gpu::CLUSTER_LISTS_GROUP);
}

const gpu::Buffer& Clusters::tilesToShade(uint32_t type) const
{
    return isDistant(type) ? surfaces_ : lists_[type].lit;
}

void Clusters::recordReset(const gpu::Frame& f, const LightTypeCounts& types) const noexcept
{
    // Work of split_tiles, and of cluster_lists for the slices that split_tiles makes.
    const uint32_t splitLanes =
        gpu::SPLIT_ROW * (kernels_.lanesTogether ? gpu::TILE_SIZE * gpu::SLICES : 1);
    const gpu::WorkList noSplits[] = {
        {.groupsX = splitLanes / gpu::SPLIT_TILES_GROUP, .groupsZ = 1},
        {.groupsX = listGroups(gpu::SLICE_ROW), .groupsZ = 1}};
    f.device.CmdUpdateBuffer(f.cmd, splits_.get(), 0, sizeof noSplits, noSplits);
    // In buffers without room for other heights than gpu::ANY_HEIGHT, their lists stay empty.
    const auto reset = [&](const gpu::Buffer& work, uint32_t parts = 0) {
        gpu::WorkList none[gpu::TILE_WORK_LISTS];
        for (uint32_t i = 0; i < gpu::TILE_WORK_LISTS; ++i) {
            const uint32_t height = i / gpu::TILE_CLASSES, tileClass = i % gpu::TILE_CLASSES;
            none[i] = {.groupsX = gpu::TILE_ROW,
                       .groupsZ = 1,
                       .first =
                           (height * sizes_.tileClasses + tileClass) * (maxTileCount() + parts)};
        }
        f.device.CmdUpdateBuffer(f.cmd, work.get(), 0, sizeof none, none);
    };
    reset(surfaces_);
    f.device.CmdFillBuffer(f.cmd, sums_.get(), 0, donePages() * pageBytes, 0);
    for (uint32_t type = 0; type < CND_LIGHT_TYPE_COUNT; ++type)
        if (types[type]) {
            reset(lists_[type].lit, mostParts());
            reset(lists_[type].unlisted);
        }
}

void Clusters::recordTree(const gpu::Frame& f, const gpu::TreeShape& tree) const noexcept
{
    gpu::LightTreeParams params{.childFirst = tree.firstLight,
                                .childCount = tree.lightCount,
                                .lowerFirst = tree.firstNode,
                                .fromLights = 1};
    while (params.childCount > (params.fromLights ? 0 : gpu::TREE_WIDTH)) {
        const uint32_t lower = divideUp(params.childCount, gpu::TREE_WIDTH);
        const uint32_t upper = divideUp(lower, gpu::TREE_WIDTH);
        params.upperFirst = params.lowerFirst + lower;
        kernels_.lightTree.dispatchInRows(
            f, treeSets_.set(f.slot), params,
            kernels_.lanesTogether ? upper : divideUp(upper, gpu::LIGHT_TREE_GROUP));
        f.barrier();
        params = {.childFirst = params.upperFirst,
                  .childCount = upper,
                  .lowerFirst = params.upperFirst + upper};
    }
}

void Clusters::recordClusters(const gpu::Frame& f, glm::uvec2 tileCount, float splitLength,
                              bool forLists) const noexcept
{
    const gpu::TileClustersParams params{.tileCount = area(tileCount),
                                         .firstSplit = firstSplit(),
                                         .splitCapacity = splitCapacity_,
                                         .splitLength = splitLength};
    kernels_.tileClusters.dispatchInRows(
        f, tileSets_.set(f.slot), params,
        divideUp(kernels_.lanesTogether ? params.tileCount * gpu::TILE_SIZE : params.tileCount,
                 gpu::TILE_CLUSTERS_GROUP));
    f.barrier();
    if (!forLists)
        return;
    kernels_.splitTiles.dispatchIndirect(f, splitSets_.set(f.slot), params, splits_);
    f.barrier();
    const glm::uvec2 blocks = blocksOf(tileCount);
    const uint32_t blockCount = area(blocks);
    kernels_.blockClusters.dispatchInRows(
        f, blockSets_.set(f.slot),
        {.tileCountX = tileCount.x,
         .tileCountY = tileCount.y,
         .blockFirst = params.tileCount,
         .blockCountX = blocks.x,
         .blockCount = blockCount,
         .clusterFirst = firstOfBlocks()},
        kernels_.lanesTogether
            ? blockCount
            : divideUp(blockCount * gpu::BLOCK_SLICES, gpu::BLOCK_CLUSTERS_GROUP));
    f.barrier();
}

std::pair<uint32_t, uint32_t> Clusters::blockClusters(glm::uvec2 tileCount) const
{
    return {firstOfBlocks(), area(blocksOf(tileCount)) * gpu::BLOCK_SLICES};
}

// The lists of blocks take at most half of the pages, so that tiles have the rest.
uint32_t Clusters::blockPages() const
{
    return pageCount() / 2;
}

VkDeviceSize Clusters::missingBytes(const gpu::LightingCounters& counters) const
{
    VkDeviceSize pages =
        counters.missingBlockPages ? 2ull * counters.missingBlockPages : counters.missingPages;
    // The room for sums is a share of the pages.
    if (!pages && counters.parts > mostParts())
        pages = VkDeviceSize(counters.parts) * gpu::PAGES_PER_PART - pageCount();
    return pages * pageBytes;
}

gpu::ClusterListsParams Clusters::listParams(uint32_t type, const gpu::TreeShape& tree,
                                             glm::uvec2 tileCount) const noexcept
{
    const uint32_t loops = device_.maxLoopIterations;
    return {.tree = tree,
            .pageCount = pageCount(),
            .maxSteps = loops == UINT32_MAX ? loops : loops / 4 * 3,
            // In shade_unlisted the walks of four clusters may run one after the other, and the
            // lights found are evaluated as well.
            .maxUnlistedSteps = loops == UINT32_MAX ? loops : loops / 16,
            .lightType = type,
            .tileCountX = tileCount.x,
            .tileCountY = tileCount.y,
            .findsHeights = tileHeightsOf(device_, type) > 1,
            .mostParts = mostParts()};
}

void Clusters::recordMaking(const gpu::Frame& f, const gpu::ClusterListsParams& params,
                            uint32_t lists) const noexcept
{
    kernels_.clusterLists.dispatchInRows(
        f, listSets_.set(f.slot * CND_LIGHT_TYPE_COUNT + params.lightType), params,
        listGroups(lists));
}

void Clusters::recordBlockLists(const gpu::Frame& f, uint32_t type, const gpu::TreeShape& tree,
                                glm::uvec2 tileCount, bool forProofs) const noexcept
{
    gpu::ClusterListsParams params = listParams(type, tree, tileCount);
    params.pageCount = blockPages();
    params.longest = params.longestShared = forProofs ? longestProvenList : longestBlockList;
    params.which = gpu::LISTS_OF_BLOCKS;
    std::tie(params.firstCluster, params.clusterCount) = blockClusters(tileCount);
    recordMaking(f, params, params.clusterCount);
}

void Clusters::recordLists(const gpu::Frame& f, uint32_t type, const gpu::TreeShape& tree,
                           glm::uvec2 tileCount, uint32_t longest) const noexcept
{
    gpu::ClusterListsParams params = listParams(type, tree, tileCount);
    params.longest = longest;
    // Loops over a part are short. But count_pairs walks the whole list, two turns per light.
    params.longestShared =
        longest > gpu::SHARED_FROM ? std::max(longest, params.maxSteps / 2) : longest;
    params.which = gpu::LISTS_OF_TILES;
    recordMaking(f, params, area(blocksOf(tileCount)) * gpu::BLOCK_SIDE * gpu::BLOCK_SIDE);
    params.which = gpu::LISTS_OF_SLICES;
    params.firstCluster = firstSplit();
    params.clusterCount = splitCapacity_ * gpu::SLICES;
    kernels_.clusterLists.dispatchIndirect(f, listSets_.set(f.slot * CND_LIGHT_TYPE_COUNT + type),
                                           params, splits_, sizeof(gpu::WorkList));
}

} // namespace candelabra::lighting
