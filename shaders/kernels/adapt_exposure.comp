// SPDX-License-Identifier: Apache-2.0
// Computes the target EV100 from the histogram, adapts to it, and derives the exposure. Counts go up to
// 15 * 2^28, which float32 cannot hold exactly. So a position among the sorted pixels is an integer and
// a fraction, and nothing is rounded before two positions are subtracted.
#version 460
#extension GL_GOOGLE_include_directive : require
#include "shared/exposure_data.h"

layout(local_size_x = HISTOGRAM_BINS) in;
layout(push_constant, scalar) uniform Push
{
    AdaptExposureParams params;
};
layout(scalar, binding = ADAPT_DATA) readonly buffer Data
{
    HistogramData data;
};
layout(scalar, binding = ADAPT_STATE) buffer State
{
    ExposureState state;
};

#include "kernels/common/group_sums.glsl"
shared vec2 sums[HISTOGRAM_BINS];

// Returns log2 of the mean luminance inside a bin.
float binLog2Luminance(uint bin, float meanFraction)
{
    const float step = float(bin % 8u) + (meanFraction + 0.5) / float(HISTOGRAM_FRACTIONS);
    return float(int(bin / 8u) + HISTOGRAM_MIN_EXPONENT) + log2(1.0 + step / 8.0);
}

// Sums the values of all lanes pairwise. Only lane 0 gets the result.
vec2 sumOverLanes(vec2 value)
{
    const uint lane = gl_LocalInvocationIndex;
    sums[lane] = value;
    barrier();
    for (uint count = HISTOGRAM_BINS / 2u; count > 0u; count /= 2u) {
        if (lane < count)
            sums[lane] += sums[lane + count];
        barrier();
    }
    return sums[0];
}

// A position among the pixels sorted by luminance, whose weights add up to the total.
struct Place {
    uint whole;
    float fraction; // [0, 1]
};

// Returns total * share / 2^32.
Place placeFromBottom(uint total, uint share)
{
    uint whole, rest;
    umulExtended(total, share, whole, rest);
    return Place(whole, float(rest) * exp2(-32.0));
}

// Returns total - total * share / 2^32.
Place placeFromTop(uint total, uint share)
{
    const Place p = placeFromBottom(total, share);
    return p.fraction > 0.0 ? Place(total - p.whole - 1u, 1.0 - p.fraction)
                            : Place(total - p.whole, 0.0);
}

// Returns how much of the interval from `below` to `above` lies between the two places.
float countInside(uint below, uint above, Place first, Place last)
{
    if (below > first.whole)
        first = Place(below, 0.0);
    if (above <= last.whole)
        last = Place(above, 0.0);
    if (last.whole < first.whole)
        return 0.0;
    return max(float(last.whole - first.whole) + (last.fraction - first.fraction), 0.0);
}

// Returns to lane 0 the weighted sum of log2 luminance between the two percentiles, and the weight.
vec2 measure()
{
    const uint bin = gl_LocalInvocationIndex;
    const uint black = data.blackWeight;
    const uint count = data.counts[bin] - (bin == 0u ? black : 0u);
    addPrefixes(count);
    const uint total = prefixes[HISTOGRAM_BINS - 1u];
    if (total == 0u && black != 0u)
        return vec2(binLog2Luminance(0u, 0.0), 1.0);
    const uint above = prefixes[bin];
    const float inside = countInside(above - count, above, placeFromBottom(total, params.lowShare),
                                     placeFromTop(total, params.highShare));
    const uvec2 fractions = data.fractions[bin];
    const float fraction = (float(fractions.y) * 4294967296.0 + float(fractions.x)) /
                           float(max(count, 1u));
    return sumOverLanes(inside * vec2(binLog2Luminance(bin, fraction), 1.0));
}

void main()
{
    const vec2 measured = measure();
    if (gl_LocalInvocationIndex != 0u)
        return;
    const bool reset = params.reset != 0u || state.owner != params.owner;
    const float previous = reset ? 0.0 : state.adaptedEv100;
    float target = params.manualEv100;
    float adapted = target;
    if (params.manual == 0u) {
        // EV100 = log2(L 100 / 12.5) = log2(L) + 3. If nothing was measured, EV100 stays as it was.
        target = measured.y > 0.0 ? measured.x / measured.y + 3.0 : previous;
        target = clamp(target, params.minEv100, params.maxEv100);
        const float start = reset ? target : previous;
        const float keep = target > start ? params.keepUp : params.keepDown;
        adapted = clamp(target + (start - target) * keep, params.minEv100, params.maxEv100);
    }
    state.targetEv100 = target;
    state.adaptedEv100 = adapted;
    // The luminance that EV100 stands for, 2^EV100 / 8 cd/m^2, gets the exposed value middleGrey.
    state.exposure = 8.0 * params.middleGrey / exp2(adapted - params.compensation);
    state.owner = params.owner;
}
