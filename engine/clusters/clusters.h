// SPDX-License-Identifier: Apache-2.0
// Clusters of surface samples, the light tree, and the light lists that each cluster gets from the
// tree: the buffers of one view and the passes that fill them (shared/cluster_data.h).
#pragma once

#include <algorithm>
#include <array>
#include <utility>

#include "gpu/recordings.h"
#include "lights/light_types.h"
#include "shared/cluster_data.h"
#include "surfaces/frame_uniforms.h"
#include "surfaces/host_gbuffer.h"
#include "surfaces/host_kernels.h"

namespace candelabra::lighting
{

struct ClusterKernels {
    // `gbuffer` and `findsDiffuse`: values of SPEC_GBUFFER and SPEC_FINDS_DIFFUSE.
    ClusterKernels(const gpu::Device& device, const surfaces::HostKernels& host, uint32_t gbuffer,
                   bool findsDiffuse);
    bool lanesTogether; // the kernels are those for GPUs, not those of kernels/cpu
    gpu::Kernel<gpu::LightTreeParams> lightTree;
    gpu::Kernel<gpu::TileClustersParams> tileClusters, splitTiles;
    gpu::Kernel<gpu::BlockClustersParams> blockClusters;
    gpu::Kernel<gpu::ClusterListsParams> clusterLists;
};

// Returns the byte offset of a work list in the buffer that begins with it and others.
constexpr VkDeviceSize workListAt(uint32_t list)
{
    return list * sizeof(gpu::WorkList);
}
// The same in a buffer of tiles, for a height, such as gpu::ANY_HEIGHT, and a tile class.
constexpr VkDeviceSize tileWorkListAt(uint32_t height, uint32_t tileClass)
{
    return workListAt(height * gpu::TILE_CLASSES + tileClass);
}
// Returns how many heights of tiles are distinguished for lights of a type: all for spheres on
// llvmpipe, where a loop costs time even if no light needs it, else only gpu::ANY_HEIGHT (DECISIONS
// 72).
uint32_t tileHeightsOf(const gpu::Device& device, uint32_t lightType);
// Returns the number of tiles with a surface, of all tile classes.
inline uint32_t surfaceTileCount(const gpu::LightingCounters& counters)
{
    uint32_t count = 0;
    for (const uint32_t tiles : counters.surfaceTiles)
        count += tiles;
    return count;
}

using TreeShapes = std::array<gpu::TreeShape, CND_LIGHT_TYPE_COUNT>;
// Returns the trees over lights that are sorted by type.
TreeShapes treeShapes(const LightTypeCounts& counts);

class Clusters
{
public:
    struct Sizes {
        uint32_t slots;          // frames in flight
        uint32_t tileClasses;    // tile classes that work lists have room for
        glm::uvec2 maxTiles;     // tiles of the largest frame, in x and y
        VkDeviceSize listBudget; // bytes for the pages of lists
    };
    // Throws gpu::Failure if the device's limit for buffers is too small for so many tiles. The
    // device, the kernels and the recordings must outlive this object.
    Clusters(const gpu::Device& device, const ClusterKernels& kernels, gpu::Recordings& recordings,
             const Sizes& sizes);

    // Makes room for a set of lights. Replaces buffers that are too small, and does not keep what
    // they contain.
    void grow(uint32_t lightCapacity, const LightTypeCounts& types);

    struct Inputs {
        const surfaces::GBufferViews& gbuffer;
        const surfaces::FrameUniforms& uniforms;
        const gpu::Buffer &core, &counters;
    };
    void writeBindings(uint32_t slot, const LightTypeCounts& types, const Inputs& inputs) const;

    // Each of these functions needs what the previous one has written to be visible. recordTree and
    // recordClusters end with a barrier; after recordReset and recordLists the caller records one.
    void recordReset(const gpu::Frame& frame, const LightTypeCounts& types) const noexcept;
    void recordTree(const gpu::Frame& frame, const gpu::TreeShape& tree) const noexcept;
    // Computes the bounds of tiles, of their slices and of blocks. Unless `forLists`, finds only
    // the tiles that hold a surface. Tiles longer than `splitLength` metres are split into slices.
    void recordClusters(const gpu::Frame& frame, glm::uvec2 tileCount, float splitLength,
                        bool forLists) const noexcept;
    // Makes the lists of blocks. forProofs: lists may be longer, because proofs follow.
    void recordBlockLists(const gpu::Frame& frame, uint32_t type, const gpu::TreeShape& tree,
                          glm::uvec2 tileCount, bool forProofs) const noexcept;
    // Makes the lists of tiles and slices from those of blocks. `longest`: number of lights in the
    // longest list that shading can walk.
    void recordLists(const gpu::Frame& frame, uint32_t type, const gpu::TreeShape& tree,
                     glm::uvec2 tileCount, uint32_t longest) const noexcept;

    // The light lists of one light type.
    struct Lists {
        gpu::Buffer heads; // per cluster
        // WorkLists by height and tile class: tiles with lists that hold lights, and parts of lists
        gpu::Buffer lit;
        gpu::Buffer unlisted; // WorkLists by tile class: tiles with clusters that have no list
    };
    const Lists& lists(uint32_t type) const { return lists_[type]; }
    // Returns the WorkLists of the tiles that shade_tiles takes. For distant lights, which have no
    // lists, these are all tiles with a surface.
    const gpu::Buffer& tilesToShade(uint32_t type) const;
    const gpu::Buffer& tiles() const { return tiles_; }
    const gpu::Buffer& clusters() const { return clusters_; }
    uint32_t splitCapacity() const { return splitCapacity_; }
    uint32_t firstSplit() const { return maxTileCount(); }
    // The number of clusters of tiles and slices, which come before those of blocks.
    uint32_t firstOfBlocks() const { return firstSplit() + splitCapacity_ * gpu::SLICES; }
    // The clusters of blocks: the first one, and how many.
    std::pair<uint32_t, uint32_t> blockClusters(glm::uvec2 tileCount) const;
    uint32_t blockPages() const; // of lists of blocks; at most
    const gpu::Buffer& entries() const { return entries_; }
    const gpu::Buffer& sums() const { return sums_; } // of parts of lists (gpu::PART_PAGES)
    const gpu::Buffer& nodes() const { return nodes_; }
    const gpu::Buffer& splits() const { return splits_; }
    // Returns how many tiles have been split if `asked` tiles were deep: there may be room for
    // fewer.
    uint32_t splitTileCount(uint32_t asked) const { return std::min(asked, splitCapacity_); }
    // Returns how many bytes of Sizes::listBudget were missing, at most. While lists of blocks lack
    // pages, those of tiles are longer than they will be.
    VkDeviceSize missingBytes(const gpu::LightingCounters& counters) const;
    // WorkLists by tile class: tiles with a surface.
    const gpu::Buffer& surfaces() const { return surfaces_; }

private:
    // The buffer of clusters holds one per tile of the largest frame, then the slices of split
    // tiles, then the slices of blocks.
    uint32_t maxTileCount() const { return sizes_.maxTiles.x * sizes_.maxTiles.y; }
    uint32_t pageCount() const
    {
        return uint32_t(entries_.size / (gpu::PAGE_WORDS * sizeof(uint32_t)));
    }
    // The parts of lists that there is room for, and the pages at the beginning of sums_ that count
    // those that are done.
    uint32_t mostParts() const { return pageCount() / gpu::PAGES_PER_PART; }
    uint32_t donePages() const { return std::max(mostParts() / 2, 1u); }
    VkDeviceSize tileWorkBytes(uint32_t heights, uint32_t parts = 0) const;
    Lists createLists(uint32_t type) const;
    uint32_t listGroups(uint32_t lists) const noexcept;
    gpu::ClusterListsParams listParams(uint32_t type, const gpu::TreeShape& tree,
                                       glm::uvec2 tileCount) const noexcept;
    void recordMaking(const gpu::Frame& frame, const gpu::ClusterListsParams& params,
                      uint32_t lists) const noexcept;

    const gpu::Device& device_;
    const ClusterKernels& kernels_;
    gpu::Recordings& recordings_;
    Sizes sizes_;
    uint32_t splitCapacity_, clusterCount_;
    gpu::Bindings treeSets_, tileSets_, splitSets_, blockSets_; // per slot
    gpu::Bindings listSets_;                                    // per slot and type
    gpu::Buffer nodes_;                                         // of the light trees
    gpu::Buffer tiles_, clusters_, surfaces_, splits_;
    gpu::Buffer entries_, sums_;
    Lists lists_[CND_LIGHT_TYPE_COUNT];
};

} // namespace candelabra::lighting
