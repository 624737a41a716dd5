// SPDX-License-Identifier: Apache-2.0
// Finds the samples, the centres of pixels, that may be inside of a box in the image.
#ifndef CND_GBUFFER_SAMPLE_BOUNDS
#define CND_GBUFFER_SAMPLE_BOUNDS

// The pixels from `first` to `last`, in both directions; none if one of these is above the other.
struct SampleBounds {
    vec2 first;
    vec2 last;
};

// The box, in pixels, may be off by `error` at each side. `size` is that of the image.
SampleBounds samplesIn(vec2 low, vec2 high, float error, vec2 size)
{
    return SampleBounds(max(ceil(low - (0.5 + error)), vec2(0.0)),
                        min(floor(high - (0.5 - error)), size - 1.0));
}

bool isEmpty(SampleBounds samples)
{
    return samples.first.x > samples.last.x || samples.first.y > samples.last.y;
}

#endif
