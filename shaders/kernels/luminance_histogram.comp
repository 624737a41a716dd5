// SPDX-License-Identifier: Apache-2.0
// Makes a weighted histogram of log2 luminance. The counts are the same on every device that rounds to
// nearest: luminance is computed in a fixed order, the bin follows from its bits, and weights are
// integers.
#version 460
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_samplerless_texture_functions : require
#include "shared/exposure_data.h"

layout(local_size_x = HISTOGRAM_GROUP) in;
layout(constant_id = SPEC_METERING) const uint metering = METERING_AVERAGE;
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

// Two more bins, after those of the histogram: pixels without light and pixels whose luminance is NaN.
const uint BLACK_BIN = HISTOGRAM_BINS;
const uint INVALID_BIN = HISTOGRAM_BINS + 1u;
const uint GROUP_BINS = HISTOGRAM_BINS + 2u;
shared uint bins[GROUP_BINS];

// Returns the integer weight of a pixel. The products fit into 32 bits up to 16384 x 16384 pixels.
uint weightOf(uvec2 pixel)
{
    const uvec2 size = params.size;
    if (metering == METERING_CENTRE_WEIGHTED) {
        const uvec2 d = uvec2(abs(ivec2(2u * pixel + 1u) - ivec2(size)));
        const uint fall = MAX_METERING_WEIGHT * max(d.x * size.y, d.y * size.x) / (size.x * size.y);
        return MAX_METERING_WEIGHT - min(MAX_METERING_WEIGHT - 1u, fall);
    }
    if (metering == METERING_MASK) {
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

// The contribution of a pixel to the histogram of its group.
struct Entry {
    uint bin;
    uint packed; // weight and fraction
};

Entry entryOf(uvec2 pixel)
{
    const float y = luminance(texelFetch(radianceImage, ivec2(pixel + params.firstTexel), 0).rgb);
    const uint bits = floatBitsToUint(y);
    // Tests the bits, because isnan() may be compiled to false.
    if ((bits & 0x7FFFFFFFu) > 0x7F800000u)
        return Entry(INVALID_BIN, 1u << HISTOGRAM_COUNT_SHIFT);
    const uint weight = weightOf(pixel);
    uint bin = (bits >> HISTOGRAM_BIN_SHIFT) - HISTOGRAM_FIRST_CODE;
    uint fraction = (bits >> HISTOGRAM_FRACTION_SHIFT) & (HISTOGRAM_FRACTIONS - 1u);
    if (!(y >= HISTOGRAM_MIN_LUMINANCE)) {
        bin = y >= HISTOGRAM_BLACK ? 0u : BLACK_BIN;
        fraction = 0u;
    } else if (y >= HISTOGRAM_MAX_LUMINANCE) {
        bin = HISTOGRAM_BINS - 1u;
        fraction = HISTOGRAM_FRACTIONS - 1u;
    }
    return Entry(bin, (weight << HISTOGRAM_COUNT_SHIFT) | weight * fraction);
}

// Counts the pixels of a column from `pixel` on. Successive pixels of the same bin are added up before
// they go to shared memory, because atomics take most of this kernel's time.
void countColumn(uvec2 pixel, uint end)
{
    Entry run = Entry(0u, 0u);
    do {
        const Entry entry = entryOf(pixel);
        if (entry.bin != run.bin) {
            atomicAdd(bins[run.bin], run.packed);
            run = Entry(entry.bin, 0u);
        }
        run.packed += entry.packed;
        ++pixel.y;
    } while (pixel.y < end);
    atomicAdd(bins[run.bin], run.packed);
}

void main()
{
    const uint lane = gl_LocalInvocationIndex;
    for (uint bin = lane; bin < GROUP_BINS; bin += HISTOGRAM_GROUP)
        bins[bin] = 0u;
    barrier();
    const uvec2 first = gl_WorkGroupID.xy * uvec2(HISTOGRAM_COLUMNS, HISTOGRAM_ROWS) +
                        uvec2(lane % HISTOGRAM_COLUMNS,
                              lane / HISTOGRAM_COLUMNS * HISTOGRAM_ROWS_PER_LANE);
    if (all(lessThan(first, params.size)))
        countColumn(first, min(first.y + HISTOGRAM_ROWS_PER_LANE, params.size.y));
    barrier();
    for (uint bin = lane; bin < HISTOGRAM_BINS; bin += HISTOGRAM_GROUP) {
        const uint packed = bins[bin];
        if (packed == 0u)
            continue;
        atomicAdd(data.counts[bin], packed >> HISTOGRAM_COUNT_SHIFT);
        const uint fraction = packed & ((1u << HISTOGRAM_COUNT_SHIFT) - 1u);
        // A 64-bit sum: the addition that overflows the low word carries.
        if (atomicAdd(data.fractions[bin].x, fraction) + fraction < fraction)
            atomicAdd(data.fractions[bin].y, 1u);
    }
    if (lane != 0u)
        return;
    const uint black = bins[BLACK_BIN] >> HISTOGRAM_COUNT_SHIFT;
    const uint invalid = bins[INVALID_BIN] >> HISTOGRAM_COUNT_SHIFT;
    if (invalid != 0u)
        atomicAdd(data.invalidPixels, invalid);
    if (black != 0u) {
        atomicAdd(data.counts[0], black);
        atomicAdd(data.blackWeight, black);
    }
}
