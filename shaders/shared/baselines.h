// SPDX-License-Identifier: Apache-2.0
// What crosses between `candelabra bench culling` and its kernels: other ways to cull lights, which
// shade with the shipping functions, so that only culling and lists differ.
#ifndef CND_SHARED_BASELINES_H
#define CND_SHARED_BASELINES_H

#include "shared/lighting.h"

GPU_BEGIN

// --- baseline_spheres: spheres of influence, one texel each, one lane per light
const uint BASELINE_GROUP = 64u;
const uint BASELINE_SPHERES_CORE = 0u;
const uint BASELINE_SPHERES_OUTPUT = 1u; // vec4: centre, radius
struct BaselineSpheresParams {
    uint lightCount;
};
GPU_SIZE(BaselineSpheresParams, 4)

// Lists of both baselines: `heads` are indices into `entries`.
struct BaselineCounters {
    uint entryCursor;                                                  // tiles: words in use
    uint listEntries;                                                  // lights of all lists
    uint overflowed;                                                   // 1: entries did not fit
    uvec2 listedPairs, evaluatedPairs, insidePairs, contributingPairs; // 64 bit: low, high
};
GPU_SIZE(BaselineCounters, 44)

// --- baseline_tiles: 16x16 pixel tiles between their lowest and highest depth (Lauritzen 2010);
// one lane per tile tests every light. A list is a chain of pages as in shared/clusters.h. Where
// loops have a limit, lights come in batches: pages of the later ones lie in front.
const uint BASELINE_TILE_SIZE = 16u; // pixels
const uint BASELINE_TILES_DEPTH = 0u;
const uint BASELINE_TILES_SPHERES = 1u;
const uint BASELINE_TILES_HEADS = 2u;
const uint BASELINE_TILES_ENTRIES = 3u;
const uint BASELINE_TILES_COUNTERS = 4u;
const uint BASELINE_TILES_RANGES = 5u; // vec2 per tile: nearest and farthest distance along -z
struct BaselineTilesParams {
    Projection projection;
    uvec2 size;
    uint tileCountX, tileCount;
    uint firstLight, endLight; // of the batch
    uint entryCapacity;        // words
    float clearDepth;
    vec2 invImageSize;
};
GPU_SIZE(BaselineTilesParams, 96)

// --- baseline_froxels, baseline_scan: 64x64 pixel tiles in slices whose depth grows exponentially,
// between the nearest and farthest surface (Persson 2013); a lane per light counts itself in the
// froxels whose box it touches, then enters itself.
const uint FROXEL_SIZE = 64u; // pixels
const uint FROXEL_SLICES = 32u;
const uint BASELINE_FROXELS_SPHERES = 0u;
const uint BASELINE_FROXELS_BOXES = 1u;   // texels: (min, 0), (max, 0) per froxel
const uint BASELINE_FROXELS_HEADS = 2u;   // one more than froxels; while counting, the counts
const uint BASELINE_FROXELS_CURSORS = 3u; // of froxels, while entering
const uint BASELINE_FROXELS_ENTRIES = 4u;
const uint SPEC_FROXELS_ENTER = 19u; // 0: count, 1: enter
struct BaselineFroxelsParams {
    Projection projection;
    uvec2 froxelCount; // in x and y
    vec2 pixelsPerNdc; // half the image
    float nearest;     // m along -z
    float slicesPerOctave;
    uint lightCount;
    uint entryCapacity;
};
GPU_SIZE(BaselineFroxelsParams, 88)

const uint BASELINE_SCAN_HEADS = 0u;
const uint BASELINE_SCAN_CURSORS = 1u;
const uint BASELINE_SCAN_COUNTERS = 2u;
struct BaselineScanParams {
    uint count;
    uint entryCapacity;
};
GPU_SIZE(BaselineScanParams, 8)

// --- baseline_shade, baseline_pairs, baseline_floor: bindings of lighting.h, and
const uint BASELINE_HEADS = 30u;
const uint BASELINE_ENTRIES = 31u;
const uint BASELINE_GRID = 32u;
const uint BASELINE_COUNTERS = 33u; // baseline_pairs
const uint BASELINE_FOUND = 34u;    // uint per pixel: evaluations above, near, general, 8 bits each
struct BaselineGrid {
    uvec2 count; // tiles or froxels in x and y
    float nearest, slicesPerOctave;
};
GPU_SIZE(BaselineGrid, 16)
const uint SPEC_BASELINE = 20u;
const uint BASELINE_OF_TILES = 0u;
const uint BASELINE_OF_FROXELS = 1u;
// Lights that baseline_floor evaluates again and again.
const uint FLOOR_LIGHTS = 8u;

GPU_END

#endif
