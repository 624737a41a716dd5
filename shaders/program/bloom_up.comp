// SPDX-License-Identifier: Apache-2.0
// Adds a level of the bloom to the next finer one. Its weights are those of bloom_down,
// transposed, so that every coarse texel spreads all of its light.
#version 460
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_samplerless_texture_functions : require
#include "shared/bloom.h"

layout(local_size_x = BLOOM_GROUP, local_size_y = BLOOM_GROUP) in;
layout(push_constant, scalar) uniform Push
{
    BloomUpParams params;
};
layout(binding = BLOOM_UP_FINE) uniform texture2D fineImage;
layout(binding = BLOOM_UP_COARSE) uniform texture2D coarseImage;
layout(binding = BLOOM_UP_OUTPUT, rgba32f) uniform writeonly image2D outputImage;

vec3 coarseAt(ivec2 at)
{
    return texelFetch(coarseImage, min(at, ivec2(params.coarseSize) - 1), 0).rgb;
}

// The lengths that the coarse texels j, j + 1 and j + 2 have in common with a fine texel.
vec3 overlaps(int i, int j, int n, int m)
{
    const ivec3 coarse = j + ivec3(0, 1, 2);
    return vec3(max(min(ivec3((i + 1) * m), (coarse + 1) * n) - max(ivec3(i * m), coarse * n), 0));
}

// The weights of the coarse texels j, j + 1 and j + 2 in a fine texel.
vec3 weightsOf(int i, int j, int n, int m)
{
    return (overlaps(max(i - 1, 0), j, n, m) + 2.0 * overlaps(i, j, n, m) +
            overlaps(min(i + 1, n - 1), j, n, m)) / float(4 * m);
}

vec3 rowAt(ivec2 at, vec3 weights, bool three)
{
    vec3 sum = weights.x * coarseAt(at) + weights.y * coarseAt(at + ivec2(1, 0));
    if (three)
        sum += weights.z * coarseAt(at + ivec2(2, 0));
    return sum;
}

void main()
{
    const ivec2 at = ivec2(gl_GlobalInvocationID.xy);
    const ivec2 n = ivec2(params.fineSize), m = ivec2(params.coarseSize);
    if (any(greaterThanEqual(at, n)))
        return;
    const ivec2 first = max(at - 1, ivec2(0)) * m / n;
    const vec3 across = weightsOf(at.x, first.x, n.x, m.x);
    const vec3 down = weightsOf(at.y, first.y, n.y, m.y);
    // In even sizes the third weight is 0.
    const bvec2 three = equal(n & 1, ivec2(1));
    vec3 sum = down.x * rowAt(first, across, three.x) +
               down.y * rowAt(first + ivec2(0, 1), across, three.x);
    if (three.y)
        sum += down.z * rowAt(first + ivec2(0, 2), across, three.x);
    sum *= params.coarseWeight;
    if (params.fineWeight != 0.0)
        sum += params.fineWeight * texelFetch(fineImage, at, 0).rgb;
    imageStore(outputImage, at, vec4(sum, 1.0));
}
