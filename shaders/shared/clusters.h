// SPDX-License-Identifier: Apache-2.0
// The light tree, clusters of surface samples, and the lists that the one gives the other.
#ifndef CND_SHARED_CLUSTERS_H
#define CND_SHARED_CLUSTERS_H

#include "shared/lighting.h"

GPU_BEGIN

// --- The light tree: over the sorted lights of one type, an implicit tree of boxes. A node of
// level k (1: leaves) stands for TREE_WIDTH^k consecutive lights, so there are no pointers. The
// levels lie one after the other, leaves first; the highest has at most TREE_WIDTH nodes.
const uint TREE_WIDTH_BITS = 3u;
const uint TREE_WIDTH = 8u;
const uint TREE_LEVELS = 8u; // at most: 8^8 lights
// Two texels per node: (min, 0), (max, 0) of its lights' influence, metres, view space.
const uint TREE_NODE_STRIDE = 2u;

// --- light_tree: builds two levels from the one below; one lane per node of the upper one
const uint LIGHT_TREE_GROUP = 64u;
const uint LIGHT_TREE_CORE = 0u;
const uint LIGHT_TREE_CORE_WORDS = 1u;
const uint LIGHT_TREE_NODES = 2u;
struct LightTreeParams {
    uint childFirst, childCount; // lights, or nodes of the level below
    uint lowerFirst, upperFirst; // first nodes of the two levels
    uint fromLights;             // 1: children are lights
};
GPU_SIZE(LightTreeParams, 20)

// --- Clusters: samples of a tile, of a slice of its depth where it is deep, or of a slice of a
// block of tiles. Blocks of two sizes lead from the whole frame to the tiles: what cannot reach a
// block need not be tested against its tiles.
const uint SLICE_BITS = 2u; // of a split tile
const uint SLICES = 4u;
const uint BLOCK_SLICE_BITS = 3u; // of a block
const uint BLOCK_SLICES = 8u;
const uint BLOCK_SIDE = 4u; // tiles, or blocks of the level below
const uint BLOCK_LEVELS = 2u;

// Samples of a cluster, view space, metres. Empty: min > max.
struct Cluster {
    vec3 min;
    uint tile; // not of blocks
    vec3 max;
    uint parent;            // the cluster of a block that it is part of
    vec3 axis;              // unit, near the normals of the samples; 0 for blocks
    float slabMin, slabMax; // of dot(axis, sample)
    float minCos;           // of the angles between axis and normals
    uint depthBits;         // of the lowest depth
    // Unit: the samples lie in a cone around it with its apex in the eye; 0 (and slope 0): unknown.
    vec3 ray;
    float slope;
};
GPU_SIZE(Cluster, 76)

// Where the samples of a tile find their cluster: first + ((depth bits - lowest) >> shift). Of
// blocks: where the clusters of the level below find theirs.
struct TileClusters {
    uint first;
    uint lowest, highest; // depth bits; lowest > highest: no sample
    uint shift;
    uint onLists; // bit per light type, from each of these on; CLASS_*, from CLASS_BITS on
};
GPU_SIZE(TileClusters, 20)
const uint UNLISTED_BITS = 0u; // the tiles of shade_unlisted
const uint LIT_BITS = 15u;     // the tiles of shade_tiles: some cluster has lights
const uint CLASS_BITS = 30u;
const uint UNSPLIT = 31u; // shift of a tile with one cluster

// A list of lights: pages of the entry buffer. A page begins with a header, the number of its
// lights and, above PAGE_COUNT_BITS, the next page (0: none).
const uint PAGE_WORDS = 64u;
const uint PAGE_LIGHTS = 63u;
const uint PAGE_COUNT_BITS = 6u;
// List heads that are no page.
const uint LIST_EMPTY = 0u;
const uint LIST_UNLISTED = 0xFFFFFFFFu; // over the budget: walk the tree
const uint LIST_LONG = 0xFFFFFFFEu;     // longer than a loop may be: walk all lights in batches

// Arguments of an indirect dispatch, and what it is for: `count` of the indices after the list, or
// lists, of a buffer, from `first` on. Groups come in rows, since devices limit the groups of one
// dimension; rows are short where groups are few, since some devices deal out groups in equal
// shares, the idle ones of the last row included.
struct WorkList {
    uint groupsX, groupsY, groupsZ; // groups of a row, rows begun, 1
    uint count, first;
};
GPU_SIZE(WorkList, 20)
const uint TILE_ROW = 256u; // one group per tile
const uint SPLIT_ROW = 8u;  // SPLIT_TILES_GROUP / SLICES tiles per group

// --- tile_clusters: bounds of each tile, one lane per tile. 128: 16384 x 16384 pixels are 32768
// groups, of 65535 that every device allows.
const uint TILE_CLUSTERS_GROUP = 128u;
const uint TILE_CLUSTERS_DEPTH = 0u;
const uint TILE_CLUSTERS_NORMALS = 1u;
const uint TILE_CLUSTERS_CLUSTERS = 2u;
const uint TILE_CLUSTERS_TILES = 3u;
const uint TILE_CLUSTERS_SURFACES = 4u;     // WorkLists, by class, of tiles with a surface
const uint TILE_CLUSTERS_SPLITS = 5u;       // WorkList of tiles to be split
const uint TILE_CLUSTERS_HOST_NORMALS = 6u; // kernels/common/read_gbuffer.glsl
const uint TILE_CLUSTERS_FRAME = 7u;        // FrameParams
const uint TILE_CLUSTERS_ALBEDO = 8u;       // tile_clusters alone
const uint TILE_CLUSTERS_SPECULAR = 9u;     // tile_clusters alone
struct TileClustersParams {
    uint tileCount;
    uint firstSplit, splitCapacity; // first cluster of split tiles; tiles that can be split
    float splitLength;              // m: longer tiles are split
};
GPU_SIZE(TileClustersParams, 16)

// --- split_tiles: bounds of the slices of deep tiles, one lane per slice; bindings as above
const uint SPLIT_TILES_GROUP = 64u;

// --- block_clusters: clusters of blocks from those of the level below, one lane per slice
const uint BLOCK_CLUSTERS_GROUP = 64u;
const uint BLOCK_CLUSTERS_CLUSTERS = 0u;
const uint BLOCK_CLUSTERS_TILES = 1u;
struct BlockClustersParams {
    uint childFirst; // in the buffer of TileClusters
    uint childCountX, childCountY;
    uint blockFirst; // in the buffer of TileClusters
    uint blockCountX, blockCount;
    uint clusterFirst;
};
GPU_SIZE(BlockClustersParams, 28)

// --- cluster_lists: tree, or list of the parent -> exact ordered list; one lane per cluster
const uint CLUSTER_LISTS_GROUP = 64u;
const uint CLUSTER_LISTS_CORE = 0u;
const uint CLUSTER_LISTS_CORE_WORDS = 1u;
const uint CLUSTER_LISTS_NODES = 2u;
const uint CLUSTER_LISTS_NODE_WORDS = 3u;
const uint CLUSTER_LISTS_CLUSTERS = 4u;
const uint CLUSTER_LISTS_TILES = 5u;
const uint CLUSTER_LISTS_SPLITS = 6u;
const uint CLUSTER_LISTS_LISTS = 7u;
const uint CLUSTER_LISTS_ENTRIES = 8u;
const uint CLUSTER_LISTS_UNLISTED = 9u; // WorkLists, by class, of tiles with unlisted clusters
const uint CLUSTER_LISTS_COUNTERS = 10u;
const uint CLUSTER_LISTS_LIT = 11u; // WorkLists, by class, of tiles with lists that hold lights
// Which clusters:
const uint LISTS_OF_BLOCKS = 0u; // firstCluster, clusterCount
const uint LISTS_OF_TILES = 1u;  // that are not split; block by block, so that lanes share parents
const uint LISTS_OF_SLICES = 2u; // of split tiles; firstCluster
struct ClusterListsParams {
    TreeShape tree;
    uint pageCount;        // of the entry buffer
    uint longest;          // list that shading can walk
    uint maxSteps;         // of the walk through the tree or the parent's list
    uint maxUnlistedSteps; // of shade_unlisted through the tree
    uint lightType;
    uint which; // LISTS_OF_*
    uint firstCluster, clusterCount;
    uint tileCountX, tileCountY;
    uint hasParents; // 1: parents have lists
};
GPU_SIZE(ClusterListsParams, 56)

GPU_END

#endif
