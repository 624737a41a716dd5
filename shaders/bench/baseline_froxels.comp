// SPDX-License-Identifier: Apache-2.0
// One lane per light. It visits the froxels covered by the bounds of the light's sphere of influence.
// If the sphere touches a froxel's box, it counts the light or enters it into the froxel's list.
#version 460
#extension GL_GOOGLE_include_directive : require
#include "shared/baselines.h"
#include "bench/spheres.glsl"

layout(local_size_x = BASELINE_GROUP) in;
layout(constant_id = SPEC_FROXELS_ENTER) const uint enter = 0u;
layout(push_constant, scalar) uniform Push
{
    BaselineFroxelsParams params;
};
layout(binding = BASELINE_FROXELS_BOXES) uniform textureBuffer boxTexels;
layout(scalar, binding = BASELINE_FROXELS_BOX_WORDS) readonly buffer BoxWords
{
    vec4 boxWords[];
};
layout(scalar, binding = BASELINE_FROXELS_HEADS) buffer Heads
{
    uint heads[];
};
layout(scalar, binding = BASELINE_FROXELS_CURSORS) buffer Cursors
{
    uint cursors[];
};
layout(scalar, binding = BASELINE_FROXELS_ENTRIES) writeonly buffer Entries
{
    uint entries[];
};

// Returns the first and last tile along one axis that the box of a sphere may cover.
ivec2 range(float centre, float r, vec2 near, float m, float m2, float pixelsPerNdc, uint count)
{
    // x / w is largest and smallest at corners of the range of (x, w); w > 0 is the distance from the
    // eye.
    const vec2 low = (m * (centre - r) / near) - m2, high = (m * (centre + r) / near) - m2;
    const float from = min(min(low.x, low.y), min(high.x, high.y));
    const float to = max(max(low.x, low.y), max(high.x, high.y));
    const vec2 pixel = (vec2(from, to) + 1.0) * pixelsPerNdc + vec2(-0.5, 0.5);
    return ivec2(clamp(floor(pixel / float(FROXEL_SIZE)), 0.0, float(count - 1u)));
}

int sliceOf(float distance_)
{
    const float slice = log2(max(distance_, params.nearest) / params.nearest) *
                        params.slicesPerOctave;
    return int(min(slice, float(FROXEL_SLICES - 1u)));
}

vec3 cornerOfBox(uint at)
{
    return READ(boxWords, boxTexels, at).xyz;
}

void main()
{
    const uint light = gl_GlobalInvocationID.x;
    if (light >= params.lightCount)
        return;
    const vec4 s = sphereOf(light);
    const float nearest = max(-s.z - s.w, params.nearest * 0.999), farthest = -s.z + s.w;
    if (farthest < params.nearest * 0.999)
        return;
    const vec2 ends = vec2(nearest, max(farthest, nearest));
    const Projection m = params.projection;
    const ivec2 xs = range(m.m00 < 0.0 ? -s.x : s.x, s.w, ends, abs(m.m00), m.m20,
                           params.pixelsPerNdc.x, params.froxelCount.x);
    const ivec2 ys = range(m.m11 < 0.0 ? -s.y : s.y, s.w, ends, abs(m.m11), m.m21,
                           params.pixelsPerNdc.y, params.froxelCount.y);
    // One more slice on either side, because log2 rounds.
    const int z0 = max(sliceOf(ends.x * 0.9999), 0), z1 = sliceOf(ends.y * 1.0001);
    const int width = xs.y - xs.x + 1, area = width * (ys.y - ys.x + 1);
    const int froxels = area * (z1 - z0 + 1);
    int x = xs.x, y = ys.x, z = z0;
    for (int i = 0; i < froxels; ++i) {
        const uint at = (uint(z) * params.froxelCount.y + uint(y)) * params.froxelCount.x + uint(x);
        const vec3 low = cornerOfBox(2u * at);
        const vec3 high = cornerOfBox(2u * at + 1u);
        const vec3 outside = max(max(low - s.xyz, s.xyz - high), vec3(0.0));
        if (dot(outside, outside) <= s.w * s.w) {
            if (enter == 0u)
                atomicAdd(heads[at], 1u);
            else {
                const uint to = atomicAdd(cursors[at], 1u);
                if (to < params.entryCapacity)
                    entries[to] = light;
            }
        }
        const bool row = x == xs.y;
        const bool slice = row && y == ys.y;
        x = row ? xs.x : x + 1;
        y = slice ? ys.x : row ? y + 1 : y;
        z = slice ? z + 1 : z;
    }
}
