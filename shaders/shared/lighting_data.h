// SPDX-License-Identifier: Apache-2.0
// Everything that crosses between the lighting module and its kernels: records, parameters, binding
// ids, group sizes. Positions are in view space, in metres.
#ifndef CND_SHARED_LIGHTING_DATA_H
#define CND_SHARED_LIGHTING_DATA_H

#include "shared/dfg.h"
#include "shared/frame.h"
#include "shared/host_gbuffer_data.h"
#include "shared/lengths.h"
#include "shared/light_type_list.h"
#include "shared/prelude.h"
#include "shared/specular_methods.h"

GPU_BEGIN

// The shape of an emitter. Only the members that its type uses (light_type_list.h) have a meaning.
struct LightShape {
    vec3 axisU;   // m; disc: unit normal; spot: unit, the way the light travels
    float radius; // m; distant sphere: the sine of its angular radius; polygon: how many corners
    vec3 axisV;   // m; spot: squared chord of the outer cone, and slope (lib/light_shape.glsl)
    uint flags;   // LIGHT_TWO_SIDED; polygon: plus the index of its first shape of corners
};
GPU_SIZE(LightShape, 32)

// A thin polygon gets additional corners on its edges (engine/lights/polygon.h). This is the most
// that a polygon of MAX_CORNERS corners can have then.
const uint MAX_RECORD_CORNERS = 2u * MAX_CORNERS - 2u;

// The corners of a polygon are stored after the shapes of all lights, in CORNER_SHAPES elements of
// the same array. axisU and axisV of each are two consecutive corners relative to the centre, so
// that shapes of corners are rotated like all others. Places without a corner repeat the last one.
const uint CORNER_SHAPES = MAX_RECORD_CORNERS / 2u;

// A light as the CPU sends it, relative to the light set's origin. pack_lights.cpp makes the
// records in any order. Then they are sorted by type (light_order.h), because each type has its own
// shading pipeline.
struct LightRecord {
    vec3 position;        // m; distant types: unit direction towards the light
    float boundingRadius; // m; radius of a sphere around the centre that holds the emitter; distant
                          //   sphere: the sine of its angular radius
    vec3 emission;        // as in CndLight
    float influenceRadius; // m; UNBOUNDED: uncut
    vec3 axisU;            // as in LightShape, like axisV and flags
    uint id;               // low half of the CndLightId, or LIGHT_OF_DEVICE and an index; polygon:
                           //   the index of its PolygonRecord, which holds the id
    vec3 axisV;            // types with a radius and axisU but no axisV: (radius, 0, 0)
    // LIGHT_*, plus LIGHT_TWO_SIDED, plus layers << LIGHT_LAYERS_SHIFT, plus what occluder_data.h
    // says of shadows
    uint flags;
};
GPU_SIZE(LightRecord, 64)
const uint LIGHT_TYPE_MASK = 255u;
const uint LIGHT_LAYERS_SHIFT = 8u;
const uint LIGHT_TWO_SIDED = 0x80000000u;
const uint LIGHT_OF_DEVICE = 0x80000000u;
const uint ALL_LAYERS = 0xFFFFu;

// The data of a polygon that its LightRecord does not hold.
struct PolygonRecord {
    vec2 corners[MAX_RECORD_CORNERS]; // along axisU and axisV; the last corner fills the rest
    uint count;                       // of corners
    uint id;                          // low half of the CndLightId
};
GPU_SIZE(PolygonRecord, 120)

// Lights as prepare_lights writes them, in view space. Each has two vec4 that every loop reads,
//   core[2 i]     = position, bounding radius
//   core[2 i + 1] = emission, squared influence radius
// and a LightShape that only some types read.
// A light that is in none of the frame's layers gets the two values below. They keep it out of the
// boxes of the tree and out of all lists, and below every horizon.
const float BOUNDING_RADIUS_OF_NONE = -UNBOUNDED;
const float INFLUENCE2_OF_NONE = -1.0f;
const uint LIGHT_CORE_STRIDE = 2u;
// Bindings of core in all kernels that read lights, and of the nodes of the light tree in all that
// search it. The same buffers are bound as storage buffers and as texel buffers.
const uint LIGHT_CORE_TEXELS = 0u;
const uint LIGHT_CORE = 1u;
const uint TREE_NODE_TEXELS = 14u;
const uint TREE_NODES = 15u;

const uint TILE_SIZE = 8u; // pixels; one shading workgroup per tile
// The light tree (shared/cluster_data.h) over the lights of one type.
struct TreeShape {
    uint firstLight, lightCount;
    uint firstNode; // index in the node buffer
};
GPU_SIZE(TreeShape, 12)

// Classes of tiles. Each has its own work list and kernels. If the host did not ask for
// CLASS_DIFFUSE (CndLightingDesc::diffuseOnlyTiles), all tiles are of CLASS_ANY.
const uint CLASS_ANY = 0u;
const uint CLASS_DIFFUSE = 1u; // no surface has a specular lobe
const uint TILE_CLASSES = 2u;
// Tiles are distinguished by how high their spheres are. The height of a sphere at a sample is how
// far its centre is above the sample's tangent plane, the horizon. A tile's height says what holds
// at every sample of the tile, for every sphere whose light may reach the sample. Each height has a
// kernel without the evaluations that it rules out, and a work list per tile class. All buffers
// of tiles begin with a list for each height and class, at height * TILE_CLASSES + CLASS_*. Those
// of tiles with a surface and of unlisted tiles have room in the lists of ANY_HEIGHT only.
const uint ANY_HEIGHT = 0u;  // nothing is known
const uint NONE_ACROSS = 1u; // every centre is more than one radius above the horizon
const uint ALL_ABOVE = 2u;   // every centre is at least ABOVE_FROM radii above the horizon
const uint TILE_HEIGHTS = 3u;
const uint TILE_WORK_LISTS = TILE_HEIGHTS * TILE_CLASSES;
// The closed form evaluates a sphere as above the horizon if its centre is at least so many of its
// radii above it. All other methods do so from one on.
const float ABOVE_FROM = 2.0f;

// Counters of one frame, cleared before it and read back after it.
struct LightingCounters {
    uint pageCursor;                      // pages in use; page 0 is never used
    uint missingPages, missingBlockPages; // that lists of tiles and of blocks lacked, at most
    uint parts; // of lists that several groups share, also those without room
    uint listEntries;
    uint maxListLength;
    uint unlistedClusters;
    uint splitTiles;
    uint surfaceTiles[TILE_CLASSES];
    uint deviceLights, rejectedLights; // shared/device_light_data.h
    float cutBelow;                    // lx; lights are cut at this illuminance
                                       // (shared/influence_data.h); 0: no light is cut
    uvec2 listedPairs;                 // 64 bit: low, high
    uvec2 evaluatedPairs;
    uvec2 insidePairs;
    uvec2 contributingPairs;
};
GPU_SIZE(LightingCounters, 84)

// --- prepare_lights: transforms lights to view space, one lane per light
const uint PREPARE_LIGHTS_GROUP = 64u;
const uint PREPARE_LIGHTS_RECORDS = 0u;
const uint PREPARE_LIGHTS_CORE = 1u;
const uint PREPARE_LIGHTS_SHAPES = 2u;
const uint PREPARE_LIGHTS_ORDER = 3u;    // shared/light_order_data.h
const uint PREPARE_LIGHTS_IDS = 4u;      // ids in sorted order
const uint PREPARE_LIGHTS_POLYGONS = 5u; // PolygonRecord
// Specialisation constant. 1: write the ids; 0: no kernel or shader reads them.
const uint PREPARE_LIGHTS_WITH_IDS = 0u;
struct PrepareLightsParams {
    mat3 viewFromWorld; // rotation
    vec3 originView;    // the light set's origin in view space, subtracted in double precision
    uint lightCount;
    uint layers; // layers of the frame
    uint uncut;  // 1: ignore the influence radii of the records, so that lights reach everything
    uint firstPolygon;     // index of the first polygon in the sorted order
    uint firstCornerShape; // index of that polygon's first shape of corners
};
GPU_SIZE(PrepareLightsParams, 68)

// --- shade_tiles, shade_unlisted, shade_brute, count_pairs: 8x8 pixels per group, one lane per
// pixel
const uint SHADE_SHAPES = 2u;
const uint SHADE_LIGHT_IDS = 4u; // read only for the host's shadow term
const uint SHADE_PAIRS = 5u;     // count_pairs: CndLightingFrame::pairImage
const uint SHADE_DEPTH = 6u;
const uint SHADE_DFG = 8u; // table of the directional albedo (shared/dfg.h)
// The next four are not in shade_brute (shared/cluster_data.h):
const uint SHADE_TILES = 9u;
const uint SHADE_LISTS = 10u;
const uint SHADE_ENTRIES = 11u;
const uint SHADE_WORK = 12u;         // TILE_WORK_LISTS WorkLists: the tiles to shade
const uint SHADE_COUNTERS = 13u;     // count_pairs
const uint SHADE_ENTRY_TEXELS = 22u; // the same buffer as SHADE_ENTRIES
const uint SHADE_SUMS = 24u;         // sums of parts of lists
const uint PIXEL_OF_TILE = 1u;       // the values of CndPixelClass
const uint PIXEL_OF_SLICE = 2u;
const uint PIXEL_UNLISTED = 3u;

// Consecutive lights of one type: all of them, or as many as one dispatch takes on devices that
// limit the length of loops.
struct LightBatch {
    uint first, count;
};
GPU_SIZE(LightBatch, 8)

struct ShadeTilesParams {
    LightBatch batch; // read only for distant lights, which are in no list
};
GPU_SIZE(ShadeTilesParams, 8)

struct ShadeUnlistedParams {
    uint listHead;    // LIST_UNLISTED or LIST_LONG (shared/cluster_data.h): the dispatch shades the
                      //   clusters with this list head
    uint topLevel;    // the walk begins at this level of the light tree, or at the tree's highest
                      //   level if that is lower
    LightBatch batch; // the lights that the walk visits: whole nodes of topLevel, except that the
                      //   last node may end with the tree
    TreeShape tree;
};
GPU_SIZE(ShadeUnlistedParams, 28)

struct ShadeBruteParams {
    LightBatch batch;
    uvec2 first, end; // pixels of the rectangle: first <= pixel < end
};
GPU_SIZE(ShadeBruteParams, 24)

struct CountPairsParams {
    LightBatch batch; // as in ShadeTilesParams
    uint writesImage; // 1: also adds its counts to the image (SHADE_PAIRS)
};
GPU_SIZE(CountPairsParams, 12)

// Specialisation constants of the kernels above.
const uint SPEC_FOR_CPU = 0u;         // 1: the kernel runs on llvmpipe (lights/light_limits.h)
const uint SPEC_SPECULAR_METHOD = 1u; // SPECULAR_*
const uint SPEC_LIGHT_TYPE = 2u;      // LIGHT_* of every light in the batch
const uint SPEC_TILE_CLASS = 4u;      // CLASS_* of the tiles: which work list
const uint SPEC_FINDS_DIFFUSE = 5u;   // tile_clusters: 1: find the tiles of CLASS_DIFFUSE
// shade_tiles: the height of the tiles that the kernel shades, ANY_HEIGHT or another. The kernel
// takes tiles from the work list of this height and does not evaluate lights that the height rules
// out.
const uint SPEC_TILE_HEIGHT = 8u;

// The lowest alpha of the specular lobe. Below it a float32 NoH cannot resolve the peak (measured:
// the relative error of D is up to 7e-5 at 0.002 and grows as 1 / alpha^2).
const float MIN_ALPHA = 0.002f;

GPU_END

#endif
