// SPDX-License-Identifier: Apache-2.0
// The specular method, and the values that a surface point prepares once for all lights.
#ifndef CND_SHADING_RECEIVER
#define CND_SHADING_RECEIVER

#include "lib/brdf.glsl"
#include "shading/light_families.glsl"
#include "shared/lighting_data.h"
#ifdef LIGHT_FAMILY_CONIC
#include "lib/specular/conic.glsl"
#endif
#ifdef HAS_OUTLINES
#include "lib/outline/outline.glsl"
#endif

// specularMethod is the method for spheres, areaMethod the one for tubes, rectangles, discs and
// polygons.
#ifdef LIGHT_FAMILY_ALL
const uint specularMethod = SPECULAR_CONIC;
const uint areaMethod = SPECULAR_CONIC;
#else
layout(constant_id = SPEC_SPECULAR_METHOD) const uint specularMethod = SPECULAR_CONIC;
const uint areaMethod = specularMethod;
#endif
const bool BY_OUTLINE = areaMethod == SPECULAR_CONIC || areaMethod == SPECULAR_CONIC_FULL;

// The values that a pixel prepares once for all lights.
struct Receiver {
    ShadingPoint p;
    uint sampleCount; // SPECULAR_SAMPLED: samples per light
    uint sampleSeed;
#if defined(LIGHT_FAMILY_CONIC) || defined(HAS_OUTLINES)
    ConicPoint conic;
#endif
#ifdef HAS_OUTLINES
    OutlineFrame frame;
#endif
};

// `sampleSeed`: the seed of the pixel.
Receiver makeReceiver(ShadingPoint p, uint sampleCount, uint sampleSeed)
{
    Receiver r;
    r.p = p;
    r.sampleCount = sampleCount;
    r.sampleSeed = sampleSeed;
#if defined(LIGHT_FAMILY_CONIC) || defined(HAS_OUTLINES)
    r.conic = makeConicPoint(p);
#endif
#ifdef HAS_OUTLINES
    r.frame = makeOutlineFrame(r.conic);
#endif
    return r;
}

#endif
