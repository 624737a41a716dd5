// SPDX-License-Identifier: Apache-2.0
// Data that `candelabra bench culling` and its kernels share. The baselines are other ways to
// cull lights. They shade with the shipping functions, so that only culling and lists differ.
#ifndef CND_SHARED_BASELINES_H
#define CND_SHARED_BASELINES_H

#include "shared/lighting_data.h"

GPU_BEGIN

// --- baseline_spheres: writes the spheres of influence, one texel each; one lane per light
const uint BASELINE_GROUP = 64u;
const uint BASELINE_SPHERES_CORE = 0u;
const uint BASELINE_SPHERES_OUTPUT = 1u; // vec4: centre, radius
struct BaselineSpheresParams {
    uint lightCount;
};
GPU_SIZE(BaselineSpheresParams, 4)

// Bindings of the spheres in baseline_tiles and baseline_froxels, as a texel buffer and as a
// storage buffer.
const uint BASELINE_SPHERE_TEXELS = 10u;
const uint BASELINE_SPHERES = 11u;

// Both baselines have buffers `heads`, one index per tile or froxel, and `entries`, which these
// indices point into and which holds the lists.
struct BaselineCounters {
    uint entryCursor;                                                  // tiles: words in use
    uint listEntries;                                                  // lights in all lists
    uint overflowed;                                                   // 1: entries did not fit
    uvec2 listedPairs, evaluatedPairs, insidePairs, contributingPairs; // 64 bit: low, high
};
GPU_SIZE(BaselineCounters, 44)

// --- baseline_tiles: 16x16 pixel tiles between their lowest and highest depth (Lauritzen 2010);
// one lane per tile tests every light. A list is a chain of pages as in shared/cluster_data.h. On
// devices that limit loops, lights are tested in batches, and the pages of a later batch come first
// in the chain.
const uint BASELINE_TILE_SIZE = 16u; // pixels
const uint BASELINE_TILES_DEPTH = 0u;
const uint BASELINE_TILES_HEADS = 2u;
const uint BASELINE_TILES_ENTRIES = 3u;
const uint BASELINE_TILES_COUNTERS = 4u;
const uint BASELINE_TILES_RANGES = 5u; // vec2 per tile: nearest and farthest distance along -z
struct BaselineTilesParams {
    Projection projection;
    uvec2 size;
    uint tileCountX, tileCount;
    uint firstLight, endLight; // the batch
    uint entryCapacity;        // words
    float clearDepth;
    vec2 invImageSize;
};
GPU_SIZE(BaselineTilesParams, 96)

// --- baseline_froxels, baseline_scan: froxels are 64x64 pixel tiles cut into slices whose depth
// grows exponentially, between the nearest and the farthest surface (Persson 2013). One lane per
// light adds the light to the counts of the froxels whose boxes it touches and, in a second
// dispatch, to their lists.
const uint FROXEL_SIZE = 64u; // pixels
const uint FROXEL_SLICES = 32u;
const uint BASELINE_FROXELS_BOXES = 1u;   // two texels per froxel: (min, 0), (max, 0)
const uint BASELINE_FROXELS_HEADS = 2u;   // one more than froxels; after counting, the counts
const uint BASELINE_FROXELS_CURSORS = 3u; // where the next light of each froxel is entered
const uint BASELINE_FROXELS_ENTRIES = 4u;
const uint BASELINE_FROXELS_BOX_WORDS = 6u; // the boxes as a storage buffer
const uint SPEC_FROXELS_ENTER = 19u;        // 0: count, 1: enter
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

// --- baseline_shade, baseline_pairs, baseline_floor: the bindings of lighting_data.h and these
const uint BASELINE_HEADS = 30u;
const uint BASELINE_ENTRIES = 31u;
const uint BASELINE_GRID = 32u;
const uint BASELINE_COUNTERS = 33u; // baseline_pairs
const uint BASELINE_FOUND = 34u;    // uint per pixel: how many lights are evaluated as above the
                                    // horizon, as near it and as general, 8 bits each
struct BaselineGrid {
    uvec2 count; // tiles or froxels in x and y
    float nearest, slicesPerOctave;
};
GPU_SIZE(BaselineGrid, 16)
const uint SPEC_BASELINE = 20u; // specialisation constant: one of the two below
const uint BASELINE_OF_TILES = 0u;
const uint BASELINE_OF_FROXELS = 1u;
// The number of different lights that baseline_floor evaluates.
const uint FLOOR_LIGHTS = 8u;

GPU_END

#endif
