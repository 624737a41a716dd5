// SPDX-License-Identifier: Apache-2.0
// One bit per (coarse tile, light): may the light reach the tile? Every word has one writer, so the
// result has neither order nor overflow. x: mask word, y: coarse tile.
#version 460
#extension GL_GOOGLE_include_directive : require
#include "shared/lighting.h"
#include "lib/bounds.glsl"
#define LIGHT_STREAM_CORE COARSE_MASKS_CORE
#define LIGHT_STREAM_CORE_WORDS COARSE_MASKS_CORE_WORDS
#include "lib/light_stream.glsl"

layout(local_size_x = COARSE_MASKS_GROUP) in;
layout(push_constant, scalar) uniform Push
{
    CoarseMasksParams params;
};
layout(scalar, binding = COARSE_MASKS_BOUNDS) readonly buffer Bounds
{
    TileBounds coarse[];
};
layout(scalar, binding = COARSE_MASKS_MASKS) writeonly buffer Masks
{
    uint masks[];
};

void main()
{
    const uint word = gl_GlobalInvocationID.x;
    const uint tile = gl_WorkGroupID.y;
    if (word >= params.wordCount)
        return;
    const TileBounds bounds = coarse[tile];
    const uint first = word * MASK_BITS;
    const uint count = isEmpty(bounds) ? 0u : min(MASK_BITS, params.lightCount - first);
    uint mask = 0u;
    for (uint bit = 0u; bit < count; ++bit) {
        const uint light = params.firstLight + first + bit;
        if (sphereTouches(bounds, lightCentre(light).xyz, lightEmission(light).w))
            mask |= 1u << bit;
    }
    masks[tile * params.wordCount + word] = mask;
}
