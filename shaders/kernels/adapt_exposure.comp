// SPDX-License-Identifier: Apache-2.0
// Histogram -> target EV100 -> adapted EV100 -> exposure. One lane: 256 bins are a few microseconds.
#version 460
#extension GL_GOOGLE_include_directive : require
#include "shared/exposure.h"

layout(local_size_x = 1) in;
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

// log2 of the mean luminance inside a bin.
float binLog2Luminance(uint bin, float meanFraction)
{
    const float step = float(bin % 8u) + (meanFraction + 0.5) / float(HISTOGRAM_FRACTIONS);
    return float(int(bin / 8u) + HISTOGRAM_MIN_EXPONENT) + log2(1.0 + step / 8.0);
}

// Mean of log2 luminance between the two percentiles; bins on the border count with the part inside.
// Returns false without counts. Cumulative counts are exact integers; as floats their error is 6e-8
// of the total, so of the mean.
bool percentileMean(out float meanLog2)
{
    uint total = 0u;
    for (uint bin = 0u; bin < HISTOGRAM_BINS; ++bin)
        total += data.counts[bin];
    const float first = params.lowPercentile * float(total);
    const float last = params.highPercentile * float(total);
    uint below = 0u;
    float mass = 0.0;
    float sum = 0.0;
    for (uint bin = 0u; bin < HISTOGRAM_BINS; ++bin) {
        const uint count = data.counts[bin];
        const float inside = min(float(below + count), last) - max(float(below), first);
        below += count;
        if (count != 0u && inside > 0.0) {
            const uvec2 fractions = data.fractions[bin];
            const float fraction = float(fractions.y) * 4294967296.0 + float(fractions.x);
            mass += inside;
            sum += inside * binLog2Luminance(bin, fraction / float(count));
        }
    }
    meanLog2 = mass > 0.0 ? sum / mass : 0.0;
    return mass > 0.0;
}

void main()
{
    const float previous = state.adaptedEv100;
    float target = params.manualEv100;
    float adapted = target;
    if (params.manual == 0u) {
        float meanLog2;
        // EV100 = log2(L 100 / 12.5) = log2(L) + 3.
        target = percentileMean(meanLog2) ? meanLog2 + 3.0 : params.reset != 0u ? 0.0 : previous;
        target = clamp(target, params.minEv100, params.maxEv100);
        const float start = params.reset != 0u ? target : previous;
        const float keep = target > start ? params.keepUp : params.keepDown;
        adapted = clamp(target + (start - target) * keep, params.minEv100, params.maxEv100);
    }
    state.targetEv100 = target;
    state.adaptedEv100 = adapted;
    // Saturation-based speed, ISO 12232; Lagarde and de Rousiers 2014, eq. 85.
    state.exposure = 1.0 / (1.2 * exp2(adapted - params.compensation));
}
