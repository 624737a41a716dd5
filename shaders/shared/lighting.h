// SPDX-License-Identifier: Apache-2.0
// Everything that crosses between the lighting module and its kernels: records, parameters, binding
// ids, group sizes. Positions are in view space, metres.
#ifndef CND_SHARED_LIGHTING_H
#define CND_SHARED_LIGHTING_H

#include "shared/dfg.h"
#include "shared/light_types.h"
#include "shared/prelude.h"
#include "shared/specular_methods.h"

GPU_BEGIN

// A light as the host sends it, relative to the light set's origin. Made by pack_lights.cpp; sorted
// by type, since each type has its own shading pipeline.
struct LightRecord {
    vec3 position; // m; distant types: unit direction towards the light
    float reach;   // m, from the centre to the farthest point of the emitter; distant sphere:
                   //   the sine of its angular radius
    vec3 emission; // as CndLight
    float influenceRadius; // m, may be infinite
    vec3 axisU;            // m; spot: unit, the way the light travels; disc: unit normal
    float radius;          // m; tube
    vec3 axisV; // m; spot: (scale, offset), attenuation = sat(cos(angle) scale + offset)^2
    uint type;  // LIGHT_*, plus LIGHT_TWO_SIDED
};
GPU_SIZE(LightRecord, 64)
const uint LIGHT_TWO_SIDED = 256u;

// After prepare_lights, two vec4 per light, hot in every loop:
//   core[2 i]     = position in view space, reach
//   core[2 i + 1] = emission, squared influence radius
// and, read only by the types that need them:
//   aux[2 i]      = axisU in view space, radius
//   aux[2 i + 1]  = axisV in view space (spot: as it is), 1 if two-sided else 0
const uint LIGHT_CORE_STRIDE = 2u;
const uint LIGHT_AUX_STRIDE = 2u;

// Non-zero elements of clipFromView (m<column><row>), enough for perspective and orthographic, and
// the way back from pixel and depth to view space.
struct Projection {
    float m00, m11, m20, m21, m30, m31, m22, m32, m23, m33;
    vec3 eye;         // position of the eye (perspective: 0) or direction towards it (orthographic)
    float eyeIsPoint; // 1 perspective, 0 orthographic
};
GPU_SIZE(Projection, 56)

const uint TILE_SIZE = 8u;         // pixels; one shading workgroup per tile
const uint COARSE_FACTOR_MIN = 8u; // tiles per coarse tile side, a power of two >= this
const uint MASK_BITS = 32u;        // lights per mask word

// Bounds of the surface samples of a tile; min > max when there are none.
struct TileBounds {
    vec3 min;
    vec3 max;
};
GPU_SIZE(TileBounds, 24)

const uint UNLISTED = 0xFFFFFFFFu; // TileList.offset: the list did not fit, walk all lights
// Lights are culled and shaded in batches, one per type (more where the device limits loops); a
// list is that of the batch at hand.
struct TileList {
    uint offset; // first entry in the list buffer
    uint count;
    uint total;        // count over the frame's batches so far
    uint everUnlisted; // 0 or 1
};
GPU_SIZE(TileList, 16)

// Counters of one frame, cleared before and read back after.
struct LightingCounters {
    uint listCursor; // first free entry of the list buffer; back to 0 for every batch
    uint listEntries;
    uint maxListLength;
    uint unlistedTiles;
    uint surfaceTiles;
    uvec2 listedPairs; // 64 bit: low, high
    uvec2 insidePairs;
    uvec2 evaluatedPairs;
};
GPU_SIZE(LightingCounters, 44)

// --- prepare_lights: world -> view, one lane per light
const uint PREPARE_LIGHTS_GROUP = 64u;
const uint PREPARE_LIGHTS_RECORDS = 0u;
const uint PREPARE_LIGHTS_CORE = 1u;
const uint PREPARE_LIGHTS_AUX = 2u;
struct PrepareLightsParams {
    mat3 viewFromWorld; // rotation
    vec3 originView;    // the light set's origin in view space, subtracted in double
    uint lightCount;
};
GPU_SIZE(PrepareLightsParams, 52)

// --- tile_bounds: bounds of the surface samples of each tile, one lane per tile. 128: 16384 x
// 16384 pixels are 32768 groups, of 65535 that every device allows.
const uint TILE_BOUNDS_GROUP = 128u;
const uint TILE_BOUNDS_DEPTH = 0u;
const uint TILE_BOUNDS_BOUNDS = 1u;
const uint TILE_BOUNDS_COUNTERS = 2u;
struct TileBoundsParams {
    Projection projection;
    uvec2 size; // pixels
    uint tileCountX, tileCount;
    float clearDepth;
    vec2 invImageSize; // 1 / size; bit for bit that of ShadeParams
};
GPU_SIZE(TileBoundsParams, 84)

// --- coarse_bounds: union over a block of tiles, one lane per coarse tile
const uint COARSE_BOUNDS_GROUP = 64u;
const uint COARSE_BOUNDS_TILES = 0u;
const uint COARSE_BOUNDS_COARSE = 1u;
struct CoarseBoundsParams {
    uint tileCountX, tileCountY;
    uint coarseCountX, coarseCount;
    uint factor;
};
GPU_SIZE(CoarseBoundsParams, 20)

// --- coarse_masks: one bit per light and coarse tile; one lane per word, y = coarse tile
const uint COARSE_MASKS_GROUP = 64u;
const uint COARSE_MASKS_CORE = 0u;       // texel buffer
const uint COARSE_MASKS_CORE_WORDS = 1u; // the same data as a storage buffer
const uint COARSE_MASKS_BOUNDS = 2u;
const uint COARSE_MASKS_MASKS = 3u;
struct CoarseMasksParams {
    uint firstLight; // of the batch
    uint lightCount; // of the batch
    uint wordCount;
};
GPU_SIZE(CoarseMasksParams, 12)

// --- tile_lists: mask -> exact ordered list per tile; one lane per tile, 8x8 tiles per group
const uint TILE_LISTS_GROUP_X = 8u;
const uint TILE_LISTS_GROUP_Y = 8u;
const uint TILE_LISTS_CORE = 0u;
const uint TILE_LISTS_CORE_WORDS = 1u;
const uint TILE_LISTS_BOUNDS = 2u;
const uint TILE_LISTS_MASKS = 3u;
const uint TILE_LISTS_LISTS = 4u;
const uint TILE_LISTS_ENTRIES = 5u;
const uint TILE_LISTS_COUNTERS = 6u;
struct TileListsParams {
    uint tileCountX, tileCountY;
    uint coarseCountX;
    uint factor;
    uint wordCount;
    uint firstLight; // of the batch
    uint lightCount; // of the batch
    uint capacity;   // entries that fit the list buffer
};
GPU_SIZE(TileListsParams, 32)

// --- shade_tiles, shade_brute, count_pairs: 8x8 pixels per group, one lane per pixel
const uint SHADE_CORE = 0u;
const uint SHADE_CORE_WORDS = 1u;
const uint SHADE_AUX = 2u;
const uint SHADE_NORMAL_ROUGHNESS = 3u;
const uint SHADE_ALBEDO = 4u;
const uint SHADE_SPECULAR = 5u;
const uint SHADE_DEPTH = 6u;
const uint SHADE_RADIANCE = 7u;
const uint SHADE_LISTS = 8u;     // not in shade_brute
const uint SHADE_ENTRIES = 9u;   // not in shade_brute
const uint SHADE_COUNTERS = 10u; // count_pairs
const uint SHADE_DFG = 11u;      // all that shade: directional albedo (shared/dfg.h)
const uint SHADE_LTC = 12u;      // all that shade: transformed cosines (shared/ltc.h)
struct ShadeParams {
    Projection projection;
    uvec2 size;
    uvec2 origin;    // shade_brute: first pixel of the rectangle (size: its end)
    uint firstLight; // of the batch
    uint lightCount; // of the batch
    uint tileCountX;
    float clearDepth;
    vec2 invImageSize; // 1 / pixels of the whole image
    uint sampleCount;  // SPECULAR_SAMPLED: samples per light
    uint sampleSeed;
    float errorBudget;       // relative to the highest response; 0: every light in full
    uint lobes;              // LOBES_*
    uint energyCompensation; // 0 or 1
};
GPU_SIZE(ShadeParams, 116)

// Specialisation constants of the kernels above.
const uint SPEC_LIGHTS_AS_TEXELS = 0u; // read core as a texel buffer (else as a storage buffer)
const uint SPEC_SPECULAR_METHOD = 1u;  // SPECULAR_*
const uint SPEC_LIGHT_TYPE = 2u;       // LIGHT_* of every light in the batch
const uint SPEC_GBUFFER_LAYOUT = 3u;   // CndGBufferLayout
const uint SPEC_ERROR_BUDGET = 4u;     // 1: ShadeParams::errorBudget may be > 0

// Specular is evaluated at alpha >= this: below it float32 NoH loses the peak (measured: relative
// error of D up to 7e-5 at 0.002, growing as 1/alpha^2).
const float MIN_ALPHA = 0.002f;

GPU_END

#endif
