// SPDX-License-Identifier: Apache-2.0
// What casts shadows, as kernels see it: meshes of triangles with their trees, instances of them
// with a tree over all, and the work of the kernels that find which parts of a light a pixel sees.
#ifndef CND_SHARED_OCCLUDER_DATA_H
#define CND_SHARED_OCCLUDER_DATA_H

#include "shared/cluster_data.h"

GPU_BEGIN

// Bits of LightRecord::flags. They are here, so that the kernels of modules without shadows do not
// depend on them. LIGHT_UNSHADOWED: no occluder shadows the light.
const uint LIGHT_UNSHADOWED = 0x1000000u;
const uint LIGHT_UNSHADOWED_BY_SHIFT = 25u; // occluder layers that do not shadow the light

// A node of a tree over triangles or over instances. The nodes of a tree are stored depth first. A
// walk begins at index 0 and goes to the next index from an inner node whose box it touches, and to
// `skip` from any other node. It ends at the `skip` of the root, which is the number of nodes.
// Indices of nodes, triangles and instances are relative to the first of the same tree.
struct OccluderNode {
    vec3 low;
    uint skip;
    vec3 high;
    uint leaf; // 0: inner; otherwise the first triangle or instance << OCCLUDER_LEAF_SHIFT, plus
               //   how many there are
};
GPU_SIZE(OccluderNode, 32)
const uint OCCLUDER_LEAF_SHIFT = 3u;
const uint OCCLUDER_LEAF_COUNT = 7u;     // mask of the count
const uint OCCLUDER_LEAF_TRIANGLES = 4u; // at most
const uint OCCLUDER_LEAF_INSTANCES = 3u;

// In the mesh's own space.
struct OccluderTriangle {
    vec3 corners[3];
};
GPU_SIZE(OccluderTriangle, 36)

// The triangles of the same mesh on the other side of the edges from corner i to the next one: the
// triangle's index << 1, plus 1 if its edge has the same direction, so that it is turned round.
struct OccluderNeighbours {
    uint edges[3];
};
GPU_SIZE(OccluderNeighbours, 12)
const uint NO_NEIGHBOUR =
    0xFFFFFFFFu; // the edge is one of the mesh's boundary, or of three triangles

// An instance as the CPU sends it, at its place in the order of the tree over instances.
struct OccluderRecord {
    mat3 worldFromLocal;
    vec3 positionHi; // of the mesh's origin in the world, as the sum of two floats
    vec3 positionLo;
    uint firstNode; // of the mesh
    uint firstTriangle;
    uint flags;         // layers (shared/lighting_data.h); plus 1 << occluder layer <<
                        //   OCCLUDER_LAYERS_SHIFT; 0: no instance has this place
    float surfaceError; // m
};
GPU_SIZE(OccluderRecord, 76)
const uint OCCLUDER_LAYERS_SHIFT = 16u;
const uint OCCLUDER_LAYER_COUNT = 6u;

// The same as prepare_occluders writes it. A point x of view space is at localFromView x +
// viewInLocal in the mesh's own space.
struct OccluderInstance {
    mat3 viewFromLocal;
    vec3 localInView; // position of the mesh's origin
    mat3 localFromView;
    vec3 viewInLocal; // position of the origin of view space
    uint firstNode;
    uint firstTriangle;
    uint flags;
    float surfaceError;
};
GPU_SIZE(OccluderInstance, 112)

// What walks through occluders need to know of a frame. In a uniform buffer.
struct ShadowView {
    mat3 viewFromTree; // rotation from the space of the tree over instances, that of the world
    vec3 viewInTree;   // position of the origin of view space there
    uint layers;       // of the frame; 0: there is no occluder in them
    uint firstNode;    // of this tree
    float depthStep;   // of a depth format of integers; 0: depth is a float
    uint points;       // as SPEC_VISIBILITY_POINTS
    uint walkTurns;    // as SPEC_WALK_TURNS
    uint asks;         // 0: the frame has no shadows, and its slots are not written
    // The first slot of a batch of distant lights: distantSlots of their type + the index of the
    // batch's first light * distantStride. Unsigned sums wrap.
    uint distantSlots[LIGHT_TYPE_COUNT];
    uint distantStride;
};
GPU_SIZE(ShadowView, 112)

// Bindings of the kernels that walk through occluders, and of the forward set.
const uint SHADOW_INSTANCES = 25u;
const uint SHADOW_NODES = 26u; // of all meshes, and of the tree over instances
const uint SHADOW_TRIANGLES = 27u;
const uint SHADOW_POINTS = 28u; // texel buffer: engine/tables/point_table.h
const uint SHADOW_VIEW = 29u;
// Bindings of the kernels that read or write visible shares.
const uint SHADOW_SLOTS = 30u;
const uint SHADOW_PAGE_PAIRS = 31u; // per page of the entry buffer: index of the first AskRecord
const uint SHADOW_ASKED = 36u;      // AskedPairs, then AskRecords
// In place of SHADOW_VIEW in the forward set of modules whose hosts have rays: shaders with rays
// fit that set alone, and shaders that walk fit the others.
const uint SHADOW_VIEW_OF_RAYS = 35u;
// Instances, nodes and triangles as texels (shading/software_drivers.glsl); not in the forward set.
const uint SHADOW_INSTANCE_TEXELS = 32u;
const uint SHADOW_NODE_TEXELS = 33u;
const uint SHADOW_TRIANGLE_TEXELS = 34u;

// Specialisation constant of kernels that walk through occluders: points per light, 64 or 32.
const uint SPEC_VISIBILITY_POINTS = 9u;
// How many turns of loops the walks of one invocation may take (occluder_walk.glsl); 0: no limit.
const uint SPEC_WALK_TURNS = 10u;

// A pair of cluster and light whose visibility is asked for.
struct AskRecord {
    uint tile;
    uint cluster;
    uint light;
    uint slot; // or SLOT_LIT or SLOT_DARK; list_occluders writes it
};
GPU_SIZE(AskRecord, 16)
const uint PAIR_WORDS = 4u;
const uint PAIR_SLOT = 3u; // word of AskRecord::slot
// The pair that a slot belongs to. A slot has a word for each pixel of the cluster's tile, which
// holds the visible shares of the diffuse lobe (low 16 bits) and of the specular lobe in units of
// 1 / SHARE_UNIT. So a share of 1 is exact.
struct SlotRecord {
    uint pair;  // index of its AskRecord
    uint items; // PAIRS_LISTED: index of the first item << ITEM_COUNT_BITS, plus their number
};
GPU_SIZE(SlotRecord, 8)
const uint RECORD_WORDS = 2u;
const uint ITEM_COUNT_BITS = 6u;
// In place of the slots of pairs that need none: all pixels see all of the light, or nothing.
const uint SLOT_LIT = 0xFFFFFFFFu;
const uint SLOT_DARK = 0xFFFFFFFEu;
// An item has the triangles of a leaf that may shadow samples of a cluster, as OccluderNode::leaf,
// or this bit and the instance of the items that follow it.
const uint ITEM_IS_INSTANCE = 0x80000000u;
// The kinds of pairs, as list_occluders finds them. Those below SLOT_KINDS have slots, and their
// kind is a specialisation constant of pair_visibility.
const uint SPEC_PAIR_KIND = 11u;
const uint PAIRS_WALKED = 0u; // from the root of the tree over instances
const uint PAIRS_LISTED = 1u; // the pair's items hold all triangles that count
const uint SLOT_KINDS = 2u;
const uint PAIRS_LIT = 2u;  // no triangle shadows the cluster
const uint PAIRS_DARK = 3u; // an instance is proven to hide the light from the whole cluster
const uint PAIR_KINDS = 4u;
// The head of the buffer of asked pairs. After it are the AskRecords, the SlotRecords, for each
// kind with slots these slots, and the items (kernels/common/asked_pairs.glsl).
struct AskedPairs {
    uint groups[3];             // of list_occluders, in rows, as WorkList::groupsX, Y and Z
    uint items;                 // also counts items that there was no room for
    WorkList kinds[SLOT_KINDS]; // a group per slot
    uint first;                 // first AskRecord of the light type
    // The next members count for all light types that have asked so far in the frame. Those above
    // are reset for each type.
    uint written; // AskRecords before this one are written
    uint taken;   // AskRecords that lists asked for, also those beyond the capacity
    uint slots;   // slots that pairs asked for, also those beyond the capacity
};
GPU_SIZE(AskedPairs, 72)
// The buffer has room for so many AskRecords and items per slot.
const uint PAIRS_PER_SLOT = 4u;
const uint ITEMS_PER_SLOT = 8u;
// Words per slot, after AskedPairs.
const uint ASKED_WORDS = PAIR_WORDS * PAIRS_PER_SLOT + RECORD_WORDS + SLOT_KINDS + ITEMS_PER_SLOT;

// Bounds of the samples of a cluster in the axes of the world, relative to the eye, in metres.
struct SampleBounds {
    vec3 low;
    // ownDistance and largestOwnDistance: that part of the least and of the largest
    // ownSurfaceDistance() of the samples that depends on no instance.
    float ownDistance;
    vec3 high;
    float largestOwnDistance;
};
GPU_SIZE(SampleBounds, 32)
const uint SLOT_WORDS = 64u;
const uint ASK_ROW = 1024u;               // pairs that a row of groups takes
const uint MOST_PAIRS = 65535u * ASK_ROW; // devices may have no more groups in y
// Lights whose shares a lane finds before it evaluates them, if it walks for itself. The shares of
// more would occupy too many registers.
const uint SHADOW_BLOCK = 16u;
const float SHARE_UNIT = 32768.0f;
const uint SHARES_LIT = 0x80008000u;
// The light does not reach the pixel, or the cluster is not the pixel's. Nothing evaluates the
// light there, unless kernels differ in rounding; then it counts as lit (1 + 1 / SHARE_UNIT).
const uint SHARES_UNASKED = 0x80018001u;

// Counted for one frame, after the LightingCounters in the same buffer.
const uint SHADOW_COUNTERS_AT = 256u; // bytes
struct ShadowCounters {
    // The next members are counted when lists are made. A frame that keeps the lists keeps them.
    uint triedProofs, wonProofs;
    uint missingPairs; // of lists that found no room for their AskRecords
    uint missingSlots; // of other lists
    // A frame that keeps the slots keeps the next two, too.
    uint pairs; // AskRecords that were made
    uint slots; // that were taken
    // The others are counted in every frame.
    uint unfinished;        // pairs
    uint kinds[PAIR_KINDS]; // how many pairs of cluster and light were found of each kind
    uvec2 asked;            // 64 bit: low, high
    uvec2 partly;
    uvec2 dark;
};
GPU_SIZE(ShadowCounters, 68)

// --- polygon_facets: which rectangle stands for a polygon, one lane per polygon
const uint POLYGON_FACETS_GROUP = 64u;
const uint POLYGON_FACETS_RECORDS = 0u;
const uint POLYGON_FACETS_ORDER = 1u; // shared/light_order_data.h
const uint POLYGON_FACETS_SHAPES = 2u;
struct PolygonFacetsParams {
    uint firstPolygon; // in the sorted order
    uint count;
};
GPU_SIZE(PolygonFacetsParams, 8)

// --- ask_proofs: makes a record of each page in the lists of blocks, one lane per cluster of a
// block
const uint ASK_PROOFS_GROUP = 64u;
const uint ASK_PROOFS_CLUSTERS = 0u;
const uint ASK_PROOFS_LISTS = 1u;
const uint ASK_PROOFS_ENTRIES = 2u;
const uint ASK_PROOFS_RECORDS = 3u; // a WorkList, then ProofRecords
struct ProofRecord {
    uint page; // of the entry buffer
    uint cluster;
    uint lightType;
};
GPU_SIZE(ProofRecord, 12)
struct AskProofsParams {
    uint firstCluster, clusterCount; // of blocks
    uint capacity;                   // of records
    uint lightType;
};
GPU_SIZE(AskProofsParams, 16)

// --- prove_dark: removes the lights from a page that occluders hide from all samples of the
// block's cluster, one group per record and one lane per light. Lights, frame and occluders have
// their usual bindings.
const uint PROVE_DARK_GROUP = 64u;
// Leaves whose triangles are tested together: their mask has two words.
const uint PROOF_LEAVES = 64u / OCCLUDER_LEAF_TRIANGLES;
const uint PROVE_DARK_SHAPES = 2u;
const uint PROVE_DARK_CLUSTERS = 3u;
const uint PROVE_DARK_ENTRIES = 4u;
const uint PROVE_DARK_RECORDS = 5u;
const uint PROVE_DARK_COUNTERS = 6u;   // ShadowCounters
const uint PROVE_DARK_NEIGHBOURS = 8u; // OccluderNeighbours
const uint PROOF_ROW = 1024u;          // groups in a row

// --- ask_pairs: makes an AskRecord of each light in a tile's or slice's list, one group per tile
const uint ASK_PAIRS_GROUP = 64u;
const uint ASK_PAIRS_CLUSTERS = 0u;
const uint ASK_PAIRS_TILES = 1u;
const uint ASK_PAIRS_SPLITS = 2u;
const uint ASK_PAIRS_LISTS = 3u;
const uint ASK_PAIRS_ENTRIES = 4u;
const uint ASK_PAIRS_UNLISTED = 5u;
const uint ASK_PAIRS_COUNTERS = 6u;
const uint ASK_PAIRS_SHADOW_COUNTERS = 7u;
const uint ASK_PAIRS_ASKED = 8u; // AskedPairs
const uint ASK_PAIRS_DEPTH = 9u;
const uint ASK_PAIRS_BOUNDS = 10u; // SampleBounds per cluster
struct AskPairsParams {
    uint tileCount;
    uint firstSplit, splitCapacity; // as in TileClustersParams
    uint capacity;                  // of slots
    uint lightType;
};
GPU_SIZE(AskPairsParams, 20)

// --- list_occluders: lists the triangles that may shadow the samples of a cluster from a light,
// one lane per AskRecord. Lights, tiles, lists and occluders are bound as in shade_tiles, and:
const uint LIST_OCCLUDERS_GROUP = 64u;
const uint LIST_OCCLUDERS_COUNTERS = 14u; // LightingCounters
const uint LIST_OCCLUDERS_ASKED = 15u;    // AskedPairs
const uint LIST_OCCLUDERS_BOUNDS = 16u;   // SampleBounds per cluster
const uint LIST_OCCLUDERS_NEIGHBOURS = 17u;
const uint LIST_OCCLUDERS_UNLISTED = 18u;
struct ListOccludersParams {
    uint capacity; // as in AskPairsParams
    uint lightType;
    uint fromHost; // 1: the host finds the points, and all pairs are PAIRS_WALKED
};
GPU_SIZE(ListOccludersParams, 12)

// --- pair_visibility: the visible shares of a light at the pixels of a tile, one group per pair.
// The pairs are those of a kind, or those of all tiles and the lights of a batch, whose slots
// follow one another tile by tile. Other bindings are as in shade_tiles.
const uint VISIBILITY_ASKED = 10u; // AskedPairs
struct PairVisibilityParams {
    LightBatch batch; // the lights at every tile; a count of 0: the pairs are those of the kind
    uvec2 first;      // with a batch: first pixel of the first tile
    uint tileCountX;  // with a batch: tiles in a row
    uint firstSlot;   // with a batch: of its slots
    uint capacity;    // as in AskPairsParams
};
GPU_SIZE(PairVisibilityParams, 28)

// --- count_shadows: counts what pair_visibility has found, 8x8 pixels per group. Bindings are as
// in count_pairs.
struct CountShadowsParams {
    LightBatch batch; // as in ShadeTilesParams
    uint firstSlot;
    uint isDistant;
    uint writesImage; // 1: also adds its counts to the image (SHADE_PAIRS)
};
GPU_SIZE(CountShadowsParams, 20)

// --- prepare_occluders: transforms instances to view space, one lane per instance
const uint PREPARE_OCCLUDERS_GROUP = 64u;
const uint PREPARE_OCCLUDERS_RECORDS = 0u;
const uint PREPARE_OCCLUDERS_INSTANCES = 1u;
struct PrepareOccludersParams {
    mat3 viewFromWorld; // rotation
    vec3 cameraHi;      // the camera's position in the world, as the sum of two floats
    vec3 cameraLo;
    uint count; // of records
};
GPU_SIZE(PrepareOccludersParams, 64)

GPU_END

#endif
