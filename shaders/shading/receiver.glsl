// SPDX-License-Identifier: Apache-2.0
// The values that a surface point prepares once for all lights.
#ifndef CND_SHADING_RECEIVER
#define CND_SHADING_RECEIVER

#include "lib/brdf.glsl"
#include "lib/outline/outline.glsl"
#include "lib/specular/conic.glsl"

struct Receiver {
    ShadingPoint p;
    uint sampleCount; // SPECULAR_SAMPLED: samples per light
    uint sampleSeed;
    ConicPoint conic;   // for spheres by the closed form, and for outlines
    OutlineFrame frame; // for outlines
};

// `sampleSeed`: the seed of the pixel.
Receiver makeReceiver(ShadingPoint p, uint sampleCount, uint sampleSeed)
{
    const ConicPoint conic = makeConicPoint(p);
    return Receiver(p, sampleCount, sampleSeed, conic, makeOutlineFrame(conic));
}

#endif
