// SPDX-License-Identifier: Apache-2.0
// The light tree, the clusters of surface samples, and the lists of lights of the clusters.
#ifndef CND_SHARED_CLUSTER_DATA_H
#define CND_SHARED_CLUSTER_DATA_H

#include "shared/lighting_data.h"

GPU_BEGIN

// --- The light tree: a tree of boxes over the sorted lights of one type. A node of level k
// (1: leaves) stands for TREE_WIDTH^k consecutive lights, so the tree needs no pointers. The levels
// lie one after the other, leaves first; the highest level has at most TREE_WIDTH nodes.
const uint TREE_WIDTH_BITS = 3u;
const uint TREE_WIDTH = 8u;
const uint TREE_LEVELS = 8u; // the most levels, for 8^8 lights
// A node has two texels, (min, 0) and (max, 0): the box around the spheres of influence of its
// lights, in view space, in metres.
const uint TREE_NODE_STRIDE = 2u;

// --- light_tree: builds two levels from the level below, one group per node of the upper level
// with a lane per child of its children, or one lane per node of the upper level
const uint LIGHT_TREE_GROUP = 64u;
const uint LIGHT_TREE_NODES = 2u;
struct LightTreeParams {
    uint childFirst, childCount; // lights, or nodes of the level below
    uint lowerFirst, upperFirst; // first nodes of the two levels
    uint fromLights;             // 1: the children are lights
};
GPU_SIZE(LightTreeParams, 20)

// --- Clusters: the samples of a tile, of a slice of a deep tile's depth, or of a slice of a block
// of tiles. A light that cannot reach a block need not be tested against its tiles.
const uint SLICE_BITS = 2u; // slices of a deep tile
const uint SLICES = 4u;
const uint BLOCK_SLICES = 8u; // the most slices of a block (sliceBitsOf() in block_clusters.comp)
const uint BLOCK_SIDE = 4u;   // side of a block, in tiles

// Bounds of the samples of a cluster, in view space, in metres. min > max: there is no sample.
struct Cluster {
    vec3 min;
    uint tile; // index of the tile; blocks do not use it
    vec3 max;
    uint parent;            // index of the cluster of the block that holds this cluster
    vec3 axis;              // unit, near the normals of the samples; 0 for blocks
    float slabMin, slabMax; // range of dot(axis, sample)
    float minCos;           // lowest cosine between the axis and a normal
    uint depthBits;         // bits of the lowest depth
    // The samples lie in a cone around the unit vector `ray` with its apex in the eye. `slope` is
    // the tangent of its half angle, less than MAX_SLOPE. Both are 0 if there is no such cone.
    vec3 ray;
    float slope;
};
GPU_SIZE(Cluster, 76)
// Cones that are as wide as this, almost half of all directions, leave out no light worth the test.
const float MAX_SLOPE = 1024.0f;

// A sample of a tile belongs to the cluster first + ((depth bits - lowest) >> shift). In blocks the
// same holds for the clusters of tiles and their parents.
struct TileClusters {
    uint first;
    uint lowest, highest; // range of the depth bits; lowest > highest: no sample
    uint shift;
    // The work lists that hold the tile: a bit per light type from UNLISTED_BITS on and from
    // LIT_BITS on. The tile's class, CLASS_*, is stored from CLASS_BITS on.
    uint onLists;
};
GPU_SIZE(TileClusters, 20)
const uint UNLISTED_BITS = 0u; // work lists of shade_unlisted
const uint LIT_BITS = 15u;     // work lists of shade_tiles: some cluster has lights
const uint CLASS_BITS = 30u;
const uint UNSPLIT = 31u; // shift of a tile with one cluster

// A list of lights consists of pages of the entry buffer. The first word of a page is its header:
// the number of its lights and, from bit PAGE_COUNT_BITS on, the next page (0: none).
const uint PAGE_WORDS = 64u;
const uint PAGE_LIGHTS = 63u;
const uint PAGE_COUNT_BITS = 6u;
// The fewest lights of a page that is not the last of its list (kernels/cpu/cluster_lists.comp).
const uint LEAST_PAGE_LIGHTS = PAGE_LIGHTS - TREE_WIDTH + 1u;
// Several groups share the list of a tile or slice that has more lights than SHARED_FROM. Each
// shades a part of PART_PAGES pages, and the last to end adds the sums of all parts in their order.
// Such a list begins with a page without lights. Five words follow its header: the tile, the number
// of parts, the place of the first part in litTiles, and two indices into the buffer of sums. The
// first index is that of a counter per pixel, which counts the parts that are done. The second one
// is that of the sums of the first part. The parts are on the work list of their tile, each as the
// first page of the list with the bit PART_OF_LIST. A list without room for its sums or for that
// page is not shared.
const uint PART_PAGES = 16u;
const uint SHARED_FROM = PART_PAGES * PAGE_LIGHTS;
const uint SUM_PAGES = 3u; // of a part: a colour per pixel of the tile
const uint PART_OF_LIST = 0x80000000u;
const uint PAGES_PER_PART = 32u; // there is room for the sums of one part per so many pages
// Heads of lists without pages.
const uint LIST_EMPTY = 0u;
const uint LIST_UNLISTED = 0xFFFFFFFFu; // no page was left: the tree is walked per pixel
// The list of a tile or slice is too long for a loop and not shared, and its pixels walk the tree
// in parts. The list of a block is too long to be of use, and the clusters in the block are found
// in the tree.
const uint LIST_LONG = 0xFFFFFFFEu;

// Arguments of an indirect dispatch and the range of indices that it works on. A buffer begins with
// its work lists; the indices follow, and the range is `count` of them from `first` on. Groups are
// arranged in rows, because devices limit the number of groups in one dimension. Rows are short if
// there are few groups, because some devices divide groups into equal shares and count the idle
// groups of the last row.
struct WorkList {
    uint groupsX, groupsY, groupsZ; // groups per row, number of rows, 1
    uint count, first;
};
GPU_SIZE(WorkList, 20)
const uint TILE_ROW = 256u; // one group per tile
// Tiles that one row of groups of split_tiles takes, and slices whose lists one row of groups of
// cluster_lists makes. If all 8x8 tiles of 16384 x 16384 pixels are split, there are 32768 rows;
// every device allows 65535.
const uint SPLIT_ROW = 128u;
const uint SLICE_ROW = SPLIT_ROW * SLICES;

// --- tile_clusters: bounds of each tile. A lane alone makes those of a tile; together,
// TILE_SIZE lanes do.
const uint TILE_CLUSTERS_GROUP = 128u;
const uint TILE_CLUSTERS_DEPTH = 0u;
const uint TILE_CLUSTERS_CLUSTERS = 1u;
const uint TILE_CLUSTERS_TILES = 2u;
const uint TILE_CLUSTERS_SURFACES = 3u; // TILE_WORK_LISTS WorkLists: tiles with a surface
const uint TILE_CLUSTERS_SPLITS = 4u;   // WorkList: tiles to be split
struct TileClustersParams {
    uint tileCount;
    uint firstSplit, splitCapacity; // first cluster of split tiles; how many tiles can be split
    float splitLength;              // m; tiles whose box has a longer diagonal are split
};
GPU_SIZE(TileClustersParams, 16)

// --- split_tiles: bounds of the slices of deep tiles; bindings of tile_clusters. A lane alone
// makes the slices of a tile; together, TILE_SIZE lanes make a slice.
const uint SPLIT_TILES_GROUP = 64u;

// --- block_clusters: clusters of blocks from the clusters of their tiles, one group per block or
// one lane per slice
const uint BLOCK_CLUSTERS_GROUP = 64u;
const uint BLOCK_CLUSTERS_CLUSTERS = 0u;
const uint BLOCK_CLUSTERS_TILES = 1u;
struct BlockClustersParams {
    uint tileCountX, tileCountY;
    uint blockFirst; // index in the buffer of TileClusters
    uint blockCountX, blockCount;
    uint clusterFirst;
};
GPU_SIZE(BlockClustersParams, 24)

// --- cluster_lists: makes the ordered list of a cluster: of a block's from the tree, of a tile's
// from the list of its parent, or from the tree if that has none. One group per cluster, or one
// lane. 32 lanes are one subgroup of many GPUs, which then need no barriers, and a word has a bit
// for each. With 64, short lists would leave more lanes idle.
const uint CLUSTER_LISTS_GROUP = 32u;
// Specialisation constant: lanes of a group, 8, 16 or 32. Tests choose fewer than
// CLUSTER_LISTS_GROUP, so that a group is one subgroup on devices with small ones.
const uint SPEC_LISTS_LANES = 7u;
const uint CLUSTER_LISTS_CLUSTERS = 2u;
const uint CLUSTER_LISTS_TILES = 3u;
const uint CLUSTER_LISTS_SPLITS = 4u;
const uint CLUSTER_LISTS_LISTS = 5u;
const uint CLUSTER_LISTS_ENTRIES = 6u;
const uint CLUSTER_LISTS_UNLISTED = 7u; // TILE_WORK_LISTS WorkLists: tiles with unlisted clusters
const uint CLUSTER_LISTS_COUNTERS = 8u;
const uint CLUSTER_LISTS_LIT = 9u; // TILE_WORK_LISTS WorkLists: tiles with lists that hold lights
// The clusters whose lists are made:
const uint LISTS_OF_BLOCKS = 0u; // those of firstCluster and clusterCount
const uint LISTS_OF_TILES = 1u;  // tiles that are not split, block by block: lanes share parents
const uint LISTS_OF_SLICES = 2u; // slices of split tiles, from firstCluster on
struct ClusterListsParams {
    TreeShape tree;
    uint pageCount;        // pages of the entry buffer
    uint longest;          // longest list that shading can walk, or of a block, that is of use
    uint maxSteps;         // most steps through the tree or the parent's list
    uint maxUnlistedSteps; // most steps of shade_unlisted through the tree
    uint lightType;
    uint which; // LISTS_OF_*
    uint firstCluster, clusterCount;
    uint tileCountX, tileCountY;
    uint findsHeights; // 1: lanes by themselves find the heights of unsplit tiles
    uint mostParts;    // parts of lists that there is room for
    // The most lights of a list that several groups share. It is at least `longest`.
    uint longestShared;
};
GPU_SIZE(ClusterListsParams, 64)

GPU_END

#endif
