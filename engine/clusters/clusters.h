// SPDX-License-Identifier: Apache-2.0
// Clusters of surface samples, the light tree, and the lists that the one gives the other: the
// buffers of one view and the passes that fill them (shared/clusters.h).
#pragma once

#include <algorithm>
#include <array>

#include "gpu/recordings.h"
#include "lights/light_types.h"
#include "shared/clusters.h"
#include "surfaces/frame_uniforms.h"
#include "surfaces/host_gbuffer.h"
#include "surfaces/host_kernels.h"

namespace candelabra::lighting
{

struct ClusterKernels {
    // `gbuffer`: value of SPEC_GBUFFER; `tileClasses`: of SPEC_TILE_CLASSES.
    ClusterKernels(const gpu::Device& device, const surfaces::HostKernels& host, uint32_t gbuffer,
                   uint32_t tileClasses);
    gpu::Kernel<gpu::LightTreeParams> lightTree;
    gpu::Kernel<gpu::TileClustersParams> tileClusters, splitTiles;
    gpu::Kernel<gpu::BlockClustersParams> blockClusters;
    gpu::Kernel<gpu::ClusterListsParams> clusterLists;
};

// Byte offset of the work list of one material class in a buffer with a list per class.
constexpr VkDeviceSize workListAt(uint32_t list)
{
    return list * sizeof(gpu::WorkList);
}
// Over all classes.
inline uint32_t surfaceTileCount(const gpu::LightingCounters& counters)
{
    uint32_t count = 0;
    for (const uint32_t ofClass : counters.surfaceTiles)
        count += ofClass;
    return count;
}

using TreeShapes = std::array<gpu::TreeShape, CND_LIGHT_TYPE_COUNT>;
// Trees of lights that are sorted by type.
TreeShapes treeShapes(const LightTypeCounts& counts);

class Clusters
{
public:
    struct Sizes {
        uint32_t slots;          // frames in flight
        uint32_t tileClasses;    // classes of tiles that work lists have room for
        glm::uvec2 maxTiles;     // of a frame
        VkDeviceSize listBudget; // bytes for the pages of lists
    };
    // Throws gpu::Failure when the device's buffers are too small for so many tiles. All that are
    // referred to must outlive it.
    Clusters(const gpu::Device& device, const ClusterKernels& kernels, gpu::Recordings& recordings,
             const Sizes& sizes);

    // Makes room for a set of lights; buffers that are too small are retired, and what they held
    // is lost.
    void grow(uint32_t lightCapacity, const LightTypeCounts& types);

    struct Inputs {
        const surfaces::GBufferViews& gbuffer;
        const surfaces::FrameUniforms& uniforms;
        const gpu::Buffer &core, &counters;
    };
    void writeBindings(uint32_t slot, const LightTypeCounts& types, const Inputs& inputs) const;

    // Each begins with what the one before it wrote made visible, and ends with a barrier of its
    // own or leaves it to the caller as said.
    void recordReset(const gpu::Frame& frame, const LightTypeCounts& types) const noexcept;
    void recordTree(const gpu::Frame& frame, const gpu::TreeShape& tree) const noexcept;
    // Bounds of tiles, their slices and blocks. Unless `forLists`, only finds the tiles that hold a
    // surface. Tiles longer than `splitLength` metres are split into slices.
    void recordClusters(const gpu::Frame& frame, glm::uvec2 tileCount, float splitLength,
                        bool forLists) const noexcept;
    // `longest`: list that shading can walk.
    void recordLists(const gpu::Frame& frame, uint32_t type, const gpu::TreeShape& tree,
                     glm::uvec2 tileCount, uint32_t longest) const noexcept;

    // The light lists of one light type.
    struct Lists {
        gpu::Buffer heads;         // per cluster
        gpu::Buffer lit, unlisted; // WorkLists of tiles, by class
    };
    const Lists& lists(uint32_t type) const { return lists_[type]; }
    // WorkLists of the tiles that shade_tiles takes: all with a surface where there are no lists.
    const gpu::Buffer& tilesToShade(uint32_t type) const;
    const gpu::Buffer& tiles() const { return tiles_; }
    const gpu::Buffer& clusters() const { return clusters_; }
    const gpu::Buffer& entries() const { return entries_; }
    const gpu::Buffer& nodes() const { return nodes_; }
    const gpu::Buffer& splits() const { return splits_; }
    // The number of tiles that were split, where `asked` tiles asked for it: there is limited room.
    uint32_t splitTileCount(uint32_t asked) const { return std::min(asked, splitCapacity_); }
    const gpu::Buffer& surfaces() const { return surfaces_; } // WorkLists of tiles, by class

private:
    // Where the records of a level lie: tiles, then blocks of rising size.
    struct Level {
        glm::uvec2 count;      // tiles or blocks
        uint32_t first;        // in the buffer of TileClusters
        uint32_t firstCluster; // in the buffer of clusters
    };
    std::array<Level, 1 + gpu::BLOCK_LEVELS> levels(glm::uvec2 tileCount) const;
    uint32_t maxTileCount() const { return sizes_.maxTiles.x * sizes_.maxTiles.y; }
    uint32_t firstSplit() const { return maxTileCount(); } // cluster of split tiles
    VkDeviceSize tileWorkBytes() const;
    Lists createLists() const;

    const gpu::Device& device_;
    const ClusterKernels& kernels_;
    gpu::Recordings& recordings_;
    Sizes sizes_;
    uint32_t splitCapacity_, clusterCount_;
    gpu::Bindings treeSets_, tileSets_, splitSets_, blockSets_; // per slot
    gpu::Bindings listSets_;                                    // per slot and type
    gpu::Buffer nodes_;                                         // per light
    gpu::Buffer tiles_, clusters_, surfaces_, splits_;
    gpu::Buffer entries_;
    Lists lists_[CND_LIGHT_TYPE_COUNT];
};

} // namespace candelabra::lighting
