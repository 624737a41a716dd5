// SPDX-License-Identifier: Apache-2.0
// Makes a weighted histogram of log2 luminance. The counts are the same on every device that rounds to
// nearest: luminance is computed in a fixed order, the bin follows from its bits, and weights are
// integers.
#version 460
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_samplerless_texture_functions : require
#include "shared/exposure.h"

layout(local_size_x = HISTOGRAM_GROUP_X, local_size_y = HISTOGRAM_GROUP_Y) in;
layout(push_constant, scalar) uniform Push
{
    LuminanceHistogramParams params;
};
layout(binding = HISTOGRAM_RADIANCE) uniform texture2D radianceImage;
layout(scalar, binding = HISTOGRAM_MASK) readonly buffer Mask
{
    uint mask[];
};
layout(scalar, binding = HISTOGRAM_DATA) buffer Data
{
    HistogramData data;
};

const uint GROUP = HISTOGRAM_GROUP_X * HISTOGRAM_GROUP_Y; // one lane per bin when merging
shared uint bins[HISTOGRAM_BINS];
shared uint invalidPixels;
shared uint blackWeight;

// Returns the integer weight of a pixel. The products fit into 32 bits up to 16384 x 16384 pixels.
uint weightOf(uvec2 pixel)
{
    const uvec2 size = params.size;
    if (params.metering == METERING_CENTRE_WEIGHTED) {
        const uvec2 d = uvec2(abs(ivec2(2u * pixel + 1u) - ivec2(size)));
        const uint fall = MAX_METERING_WEIGHT * max(d.x * size.y, d.y * size.x) / (size.x * size.y);
        return MAX_METERING_WEIGHT - min(MAX_METERING_WEIGHT - 1u, fall);
    }
    if (params.metering == METERING_MASK) {
        const uvec2 texel = pixel * params.maskSize / size;
        return mask[texel.y * params.maskSize.x + texel.x];
    }
    return 1u;
}

// Returns the ITU-R BT.709 luminance, computed in a fixed order without fused operations.
float luminance(vec3 c)
{
    precise float red = 0.2126 * c.r;
    precise float green = 0.7152 * c.g;
    precise float blue = 0.0722 * c.b;
    precise float sum = red + green;
    precise float y = sum + blue;
    return y;
}

void count(uvec2 pixel)
{
    const float y = luminance(texelFetch(radianceImage, ivec2(pixel), 0).rgb);
    const uint bits = floatBitsToUint(y);
    if ((bits & 0x7FFFFFFFu) > 0x7F800000u) { // NaN; isnan() may be compiled to false
        atomicAdd(invalidPixels, 1u);
        return;
    }
    const uint weight = weightOf(pixel);
    if (!(y >= HISTOGRAM_BLACK)) {
        atomicAdd(blackWeight, weight);
        return;
    }
    uint bin = (bits >> HISTOGRAM_BIN_SHIFT) - HISTOGRAM_FIRST_CODE;
    uint fraction = (bits >> HISTOGRAM_FRACTION_SHIFT) & (HISTOGRAM_FRACTIONS - 1u);
    if (!(y >= HISTOGRAM_MIN_LUMINANCE)) {
        bin = 0u;
        fraction = 0u;
    } else if (y >= HISTOGRAM_MAX_LUMINANCE) {
        bin = HISTOGRAM_BINS - 1u;
        fraction = HISTOGRAM_FRACTIONS - 1u;
    }
    atomicAdd(bins[bin], (weight << HISTOGRAM_COUNT_SHIFT) | weight * fraction);
}

void main()
{
    const uint lane = gl_LocalInvocationIndex;
    for (uint bin = lane; bin < HISTOGRAM_BINS; bin += GROUP)
        bins[bin] = 0u;
    if (lane == 0u) {
        invalidPixels = 0u;
        blackWeight = 0u;
    }
    barrier();
    const uvec2 first = gl_WorkGroupID.xy * uvec2(HISTOGRAM_GROUP_X,
                                                  HISTOGRAM_GROUP_Y * HISTOGRAM_ROWS_PER_LANE) +
                        gl_LocalInvocationID.xy;
    for (uint row = 0u; row < HISTOGRAM_ROWS_PER_LANE; ++row) {
        const uvec2 pixel = first + uvec2(0u, row * HISTOGRAM_GROUP_Y);
        if (all(lessThan(pixel, params.size)))
            count(pixel);
    }
    barrier();
    for (uint bin = lane; bin < HISTOGRAM_BINS; bin += GROUP) {
        const uint packed = bins[bin];
        if (packed == 0u)
            continue;
        atomicAdd(data.counts[bin], packed >> HISTOGRAM_COUNT_SHIFT);
        const uint fraction = packed & ((1u << HISTOGRAM_COUNT_SHIFT) - 1u);
        // A 64-bit sum: the addition that overflows the low word carries.
        if (atomicAdd(data.fractions[bin].x, fraction) + fraction < fraction)
            atomicAdd(data.fractions[bin].y, 1u);
    }
    if (lane == 0u && invalidPixels != 0u)
        atomicAdd(data.invalidPixels, invalidPixels);
    if (lane == 0u && blackWeight != 0u) {
        atomicAdd(data.counts[0], blackWeight);
        atomicAdd(data.blackWeight, blackWeight);
    }
}
