// SPDX-License-Identifier: Apache-2.0
// Makes a level of the bloom from the next finer one: blurs that by the weights 1 2 1 along each axis,
// and takes the mean over each coarse texel. At the borders, texels outside are those at the border.
// So every fine texel has as much of the coarse level as it has of the fine one, also where the size is
// odd, and the mean of the level stays the same.
#version 460
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_samplerless_texture_functions : require
#include "shared/bloom.h"

layout(local_size_x = BLOOM_GROUP, local_size_y = BLOOM_GROUP) in;
layout(push_constant, scalar) uniform Push
{
    BloomDownParams params;
};
layout(binding = BLOOM_DOWN_FINE) uniform texture2D fineImage;
layout(binding = BLOOM_DOWN_COARSE, rgba32f) uniform writeonly image2D coarseImage;

// Returns the light of a texel that the bloom spreads. NaN, infinity and negative values are no light:
// this function finds them by their bits and returns 0 for them.
vec3 lightAt(ivec2 at)
{
    const vec3 value = texelFetch(fineImage, clamp(at, ivec2(0), ivec2(params.fineSize) - 1), 0).rgb;
    return mix(vec3(0.0), value, lessThan(floatBitsToUint(value), uvec3(0x7f800000u)));
}

// The length that a fine texel and the coarse texel `j` have in common.
int overlap(int i, int j, int n, int m)
{
    return max(min((i + 1) * m, (j + 1) * n) - max(i * m, j * n), 0);
}

// The weight of a fine texel in the coarse texel `j`.
float weightOf(int i, int j, int n, int m)
{
    const int blurred = overlap(i - 1, j, n, m) + 2 * overlap(i, j, n, m) + overlap(i + 1, j, n, m);
    return float(blurred) / float(4 * n);
}

vec3 rowAt(ivec2 at, int count, vec4 weights, float last)
{
    vec3 sum = weights.x * lightAt(at) + weights.y * lightAt(at + ivec2(1, 0)) +
               weights.z * lightAt(at + ivec2(2, 0)) + weights.w * lightAt(at + ivec2(3, 0));
    if (count > 4)
        sum += last * lightAt(at + ivec2(4, 0));
    return sum;
}

void main()
{
    const ivec2 at = ivec2(gl_GlobalInvocationID.xy);
    const ivec2 n = ivec2(params.fineSize), m = ivec2(params.coarseSize);
    if (any(greaterThanEqual(at, m)))
        return;
    const ivec2 first = at * n / m - 1;
    const ivec2 count = 4 + (n & 1);
    vec4 weights;
    for (int i = 0; i < 4; ++i)
        weights[i] = weightOf(first.x + i, at.x, n.x, m.x);
    const float last = weightOf(first.x + 4, at.x, n.x, m.x);
    vec3 sum = vec3(0.0);
    for (int i = 0; i < count.y; ++i)
        sum += weightOf(first.y + i, at.y, n.y, m.y) *
               rowAt(first + ivec2(0, i), count.x, weights, last);
    imageStore(coarseImage, at, vec4(sum, 1.0));
}
