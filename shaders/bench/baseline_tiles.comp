// SPDX-License-Identifier: Apache-2.0
// Light lists of 16x16 pixel tiles: tests spheres against the planes of the tile's frustum and its
// depth range. One lane per tile, so that the lanes of a subgroup, eight or more tiles, test a light
// that all of them read. 32 lights are tested before those that passed are written.
#version 460
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_samplerless_texture_functions : require
#include "shared/baselines.h"
#include "shared/cluster_data.h"
#include "lib/projection.glsl"
#include "bench/spheres.glsl"

layout(local_size_x = BASELINE_GROUP) in;
layout(push_constant, scalar) uniform Push
{
    BaselineTilesParams params;
};
layout(binding = BASELINE_TILES_DEPTH) uniform texture2D depthImage;
layout(scalar, binding = BASELINE_TILES_HEADS) buffer Heads
{
    uint heads[];
};
layout(scalar, binding = BASELINE_TILES_ENTRIES) buffer Entries
{
    uint entries[];
};
layout(scalar, binding = BASELINE_TILES_COUNTERS) buffer Counters
{
    BaselineCounters counters;
};
layout(scalar, binding = BASELINE_TILES_RANGES) writeonly buffer Ranges
{
    vec2 ranges[];
};

// Returns the unit normal of a frustum side through the eye: its components along one axis and along z.
vec2 side(float m, float m2, float ndc, float m23, float inwards)
{
    return inwards * normalize(vec2(m, m2 - ndc * m23));
}

// The sides of a tile's frustum, and its range of z.
struct TileFrustum {
    vec2 left, right, top, bottom;
    float zMin, zMax;
};

// Returns the frustum of the pixels first .. end - 1 between two depths.
TileFrustum frustumOf(uvec2 first, uvec2 end, float lowest, float highest)
{
    const Projection m = params.projection;
    const float a = viewPosition(m, first, params.invImageSize, lowest).z;
    const float b = viewPosition(m, first, params.invImageSize, highest).z;
    const vec2 low = 2.0 * vec2(first) * params.invImageSize - 1.0;
    const vec2 high = 2.0 * vec2(end) * params.invImageSize - 1.0;
    // A point is inside where clip.x >= low w, clip.x <= high w, and so on, for w > 0.
    return TileFrustum(side(m.m00, m.m20, low.x, m.m23, 1.0), side(m.m00, m.m20, high.x, m.m23, -1.0),
                       side(m.m11, m.m21, low.y, m.m23, 1.0), side(m.m11, m.m21, high.y, m.m23, -1.0),
                       min(a, b), max(a, b));
}

bool touches(TileFrustum f, vec4 s)
{
    const float inside = min(min(dot(f.left, s.xz), dot(f.right, s.xz)),
                             min(dot(f.top, s.yz), dot(f.bottom, s.yz)));
    return min(inside, min(s.z - f.zMin, f.zMax - s.z)) > -s.w;
}

void main()
{
    const uint tile = gl_GlobalInvocationID.x;
    if (tile >= params.tileCount)
        return;
    const uvec2 first =
        BASELINE_TILE_SIZE * uvec2(tile % params.tileCountX, tile / params.tileCountX);
    const uvec2 end = min(first + BASELINE_TILE_SIZE, params.size);
    float lowest = 2.0, highest = -1.0;
    for (uint y = first.y; y < end.y; ++y)
        for (uint x = first.x; x < end.x; ++x) {
            const float depth = texelFetch(depthImage, ivec2(x, y), 0).x;
            const bool surface = depth != params.clearDepth;
            lowest = surface ? min(lowest, depth) : lowest;
            highest = surface ? max(highest, depth) : highest;
        }
    const bool empty = highest < lowest;
    const TileFrustum frustum = frustumOf(first, end, lowest, highest);
    ranges[tile] = empty ? vec2(0.0) : vec2(-frustum.zMax, -frustum.zMin);

    const uint before = heads[tile]; // 0, or the list made by earlier batches
    uint head = before, page = 0u, inPage = PAGE_LIGHTS, total = 0u;
    const uint endLight = empty ? 0u : params.endLight;
    for (uint begin = params.firstLight; begin < endLight; begin += 32u) {
        const uint count = min(32u, endLight - begin);
        uint passed = 0u;
        for (uint k = 0u; k < count; ++k)
            passed |= touches(frustum, sphereOf(begin + k)) ? 1u << k : 0u;
        total += uint(bitCount(passed));
        while (passed != 0u) {
            if (inPage == PAGE_LIGHTS) { // a chain of pages never ends with an empty page
                const uint next = atomicAdd(counters.entryCursor, PAGE_WORDS) + PAGE_WORDS;
                if (next + PAGE_WORDS > params.entryCapacity) {
                    counters.overflowed = 1u;
                    break;
                }
                if (page != 0u)
                    entries[page] = next / PAGE_WORDS << PAGE_COUNT_BITS | inPage;
                else
                    head = next;
                page = next;
                inPage = 0u;
            }
            ++inPage;
            entries[page + inPage] = begin + findLSB(passed);
            passed &= passed - 1u;
        }
    }
    if (page != 0u)
        entries[page] = before / PAGE_WORDS << PAGE_COUNT_BITS | inPage;
    heads[tile] = head;
    atomicAdd(counters.listEntries, total);
}
