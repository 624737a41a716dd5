// SPDX-License-Identifier: Apache-2.0
// Everything that crosses between the lighting module and its kernels: records, parameters, binding
// ids, group sizes. Positions are in view space, metres.
#ifndef CND_SHARED_LIGHTING_H
#define CND_SHARED_LIGHTING_H

#include "shared/dfg.h"
#include "shared/frame.h"
#include "shared/host_gbuffer.h"
#include "shared/light_types.h"
#include "shared/prelude.h"
#include "shared/specular_methods.h"

GPU_BEGIN

// The shape of an emitter. Members that a type does not have are without meaning (light_types.h).
struct LightShape {
    vec3 axisU;   // m; disc: unit normal; spot: unit, the way the light travels
    float radius; // m; distant sphere: the sine of its angular radius
    vec3 axisV;   // m; spot: scale and offset of its cone (lib/light_shape.glsl)
    uint flags;   // LIGHT_TWO_SIDED
};
GPU_SIZE(LightShape, 32)

// A light as the host sends it, relative to the light set's origin. Made by pack_lights.cpp, in any
// order: light_order.h sorts them by type, since each type has its own shading pipeline.
struct LightRecord {
    vec3 position;         // m; distant types: unit direction towards the light
    float boundingRadius;  // m, of a sphere around the centre that holds the emitter; distant
                           //   sphere: the sine of its angular radius
    vec3 emission;         // as CndLight
    float influenceRadius; // m, may be infinite
    vec3 axisU;            // as LightShape, as are axisV and flags
    uint id;               // low half of the CndLightId, or LIGHT_OF_DEVICE and an index
    vec3 axisV;            // types with a radius and axisU alone: (radius, 0, 0)
    uint flags;            // LIGHT_*, plus LIGHT_TWO_SIDED, plus layers << LIGHT_LAYERS_SHIFT
};
GPU_SIZE(LightRecord, 64)
const uint LIGHT_TYPE_MASK = 255u;
const uint LIGHT_TWO_SIDED = 256u;
const uint LIGHT_LAYERS_SHIFT = 16u;
const uint LIGHT_OF_DEVICE = 0x80000000u;
const uint ALL_LAYERS = 0xFFFFu;

// After prepare_lights, in view space: two vec4 per light, hot in every loop,
//   core[2 i]     = position, bounding radius
//   core[2 i + 1] = emission, squared influence radius
// and a LightShape, read only by the types that need it.
// Lights of other layers than the frame's light nothing: their bounding radius and squared
// influence radius are these, so that no box of the tree and no list holds them, and none is above
// a horizon.
const float BOUNDING_RADIUS_OF_NONE = -1e30f;
const float INFLUENCE2_OF_NONE = -1.0f;
const uint LIGHT_CORE_STRIDE = 2u;

const uint TILE_SIZE = 8u; // pixels; one shading workgroup per tile
// The light tree (shared/clusters.h) over the lights of one type.
struct TreeShape {
    uint firstLight, lightCount;
    uint firstNode; // in the node buffer
};
GPU_SIZE(TreeShape, 12)

// Classes of tiles by what all their surfaces lack; each has a work list and kernels of its own.
// Classes that a module was not asked for have no tiles.
const uint CLASS_ANY = 0u;
const uint CLASS_DIFFUSE = 1u;  // no specular lobe
const uint CLASS_SPECULAR = 2u; // no diffuse lobe
const uint TILE_CLASSES = 3u;

// Counters of one frame, cleared before and read back after.
struct LightingCounters {
    uint pageCursor; // pages of lists in use; page 0 is none
    uint listEntries;
    uint maxListLength;
    uint unlistedClusters;
    uint splitTiles;
    uint surfaceTiles[TILE_CLASSES];
    uint deviceLights, rejectedLights; // shared/device_lights.h
    float cutBelow;                    // lx (shared/influence.h); 0: nothing is
    uvec2 listedPairs;                 // 64 bit: low, high
    uvec2 evaluatedPairs;
    uvec2 insidePairs;
    uvec2 contributingPairs;
};
GPU_SIZE(LightingCounters, 76)

// --- prepare_lights: world -> view, one lane per light
const uint PREPARE_LIGHTS_GROUP = 64u;
const uint PREPARE_LIGHTS_RECORDS = 0u;
const uint PREPARE_LIGHTS_CORE = 1u;
const uint PREPARE_LIGHTS_SHAPES = 2u;
const uint PREPARE_LIGHTS_ORDER = 3u; // shared/light_order.h
const uint PREPARE_LIGHTS_IDS = 4u;   // LightRecord::id, in that order
// Specialisation constant: 1: write ids; 0: nobody reads them.
const uint PREPARE_LIGHTS_WITH_IDS = 0u;
struct PrepareLightsParams {
    mat3 viewFromWorld; // rotation
    vec3 originView;    // the light set's origin in view space, subtracted in double
    uint lightCount;
    uint layers; // of the frame
    uint uncut;  // 1: lights reach everything, whatever their records say
};
GPU_SIZE(PrepareLightsParams, 60)

// --- shade_tiles, shade_unlisted, shade_brute, count_pairs: 8x8 pixels per group, one lane per
// pixel
const uint SHADE_CORE = 0u;
const uint SHADE_CORE_WORDS = 1u;
const uint SHADE_SHAPES = 2u;
const uint SHADE_NORMAL_ROUGHNESS = 3u;
const uint SHADE_ALBEDO = 4u;
const uint SHADE_SPECULAR = 5u;
const uint SHADE_DEPTH = 6u;
const uint SHADE_RADIANCE = 7u;
const uint SHADE_DFG = 8u; // all that shade: directional albedo (shared/dfg.h)
const uint SHADE_LTC = 9u; // all that shade: transformed cosines (shared/ltc.h)
// Not in shade_brute (shared/clusters.h):
const uint SHADE_TILES = 10u;
const uint SHADE_LISTS = 11u;
const uint SHADE_ENTRIES = 12u;
const uint SHADE_WORK = 13u;     // WorkLists, by class, of the tiles to shade
const uint SHADE_COUNTERS = 14u; // count_pairs
const uint SHADE_CLUSTERS = 15u; // shade_unlisted
const uint SHADE_NODES = 16u;    // shade_unlisted
const uint SHADE_NODE_WORDS = 17u;
const uint SHADE_PAIRS = 18u;       // count_pairs: CndLightingFrame::pairImage
const uint SHADE_HOST_NORMAL = 19u; // all that shade (kernels/common/read_gbuffer.glsl)
const uint SHADE_FRAME = 20u;       // all that shade: FrameParams
const uint SHADE_LIGHT_IDS = 21u;   // all that shade: read for the host's shadow term alone
const uint PIXEL_OF_TILE = 1u;      // CndPixelClass
const uint PIXEL_OF_SLICE = 2u;
const uint PIXEL_UNLISTED = 3u;

// Consecutive lights of one type: all of them, or as many as one dispatch takes on devices that
// limit the length of loops.
struct LightBatch {
    uint first, count;
};
GPU_SIZE(LightBatch, 8)

struct ShadeTilesParams {
    LightBatch batch; // read for distant lights alone, which have no lists
};
GPU_SIZE(ShadeTilesParams, 8)

struct ShadeUnlistedParams {
    uint listHead;    // LIST_UNLISTED or LIST_LONG (shared/clusters.h): the dispatch shades the
                      //   clusters with this list head
    uint topLevel;    // the walk begins at this level of the light tree, or at its highest if lower
    LightBatch batch; // the lights that the walk visits: whole nodes of topLevel, apart from the
                      //   last, which ends where the tree ends
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
const uint SPEC_LIGHTS_AS_TEXELS = 0u; // read core as a texel buffer (else as a storage buffer)
const uint SPEC_SPECULAR_METHOD = 1u;  // SPECULAR_*
const uint SPEC_LIGHT_TYPE = 2u;       // LIGHT_* of every light in the batch
const uint SPEC_GBUFFER = 3u;          // layout of the G-buffer (shared/host_gbuffer.h)
const uint SPEC_ERROR_BUDGET = 4u;     // 1: FrameParams::errorBudget may be > 0
const uint SPEC_TILE_CLASS = 5u;       // CLASS_* of the tiles: their work list, and what they lack
const uint SPEC_TILE_CLASSES = 6u;     // tile_clusters: mask of 1 << CLASS_* to be told apart

// Specular is evaluated at alpha >= this: below it float32 NoH loses the peak (measured: relative
// error of D up to 7e-5 at 0.002, growing as 1/alpha^2).
const float MIN_ALPHA = 0.002f;

GPU_END

#endif
