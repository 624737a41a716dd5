// SPDX-License-Identifier: Apache-2.0
// Finds the highest cut at which the display of no sample changes by more than the allowed error. The
// window also takes light from lights that still reach the sample: of a light that gives 1 / x times
// the illuminance of the cut, (1 - x^2)^2 remains.
#version 460
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_samplerless_texture_functions : require
#include "lib/influence.glsl"
#include "lib/tone_map.glsl"

layout(local_size_x = CHOOSE_INFLUENCE_GROUP) in;
layout(push_constant, scalar) uniform Push
{
    ChooseInfluenceParams params;
};
layout(scalar, binding = CHOOSE_INFLUENCE_DATA) buffer Data
{
    InfluenceData data;
};
layout(scalar, binding = CHOOSE_INFLUENCE_SUMS) readonly buffer Sums
{
    vec3 sums[];
};
layout(binding = CHOOSE_INFLUENCE_DEPTH) uniform texture2D depthImage;
layout(binding = CHOOSE_INFLUENCE_RADIANCE, rgba32f) uniform readonly image2D radianceImage;

// Returns what the display shows of a luminance.
vec3 shown(vec3 luminance)
{
    return encodeSrgb(toneMap(data.frame.toneMap, expose(luminance, data.frame.exposure)));
}

void main()
{
    const uint sampleIndex = gl_GlobalInvocationID.x;
    if (sampleIndex >= params.samples)
        return;
    const uint turn =
        influenceTurn(data.frame, data.states[data.frame.previous], params.round);
    const uvec2 pixel = influencePixel(data.frame, sampleIndex, turn);
    if (any(greaterThanEqual(pixel, data.frame.size)))
        return;
    if (texelFetch(depthImage, ivec2(pixel + data.frame.firstDepthTexel), 0).x == data.frame.clearDepth)
        return;
    const uint firstSlot = sampleIndex * INFLUENCE_SLOTS;
    vec3 placed = vec3(0.0);
    for (uint bin = 0u; bin < INFLUENCE_BINS; ++bin)
        placed += sums[firstSlot + bin];
    const vec3 all = imageLoad(radianceImage, ivec2(pixel + data.frame.firstTexel)).rgb +
                     sums[firstSlot + INFLUENCE_DISTANT] + placed;
    const vec3 uncut = shown(all);
    // Sums of the light in the bins from the cut upwards, weighted by x^2 and by x^4.
    vec3 squares = vec3(0.0), fourths = vec3(0.0);
    vec3 below = placed; // light in the bins below the cut
    uint allowed = INFLUENCE_BINS - 1u;
    for (uint cut = INFLUENCE_BINS - 1u; cut > 0u; --cut) {
        const vec3 bin = sums[firstSlot + cut];
        // By how much x^2 changes from one cut to the next.
        const float x2 = cut < INFLUENCE_COARSE_BINS ? 1.0 / 16.0 : 0.5;
        squares = bin + x2 * squares;
        fourths = bin + x2 * x2 * fourths;
        below = max(below - bin, 0.0);
        const vec3 removed = below + 2.0 * squares - fourths;
        const vec3 change = abs(uncut - shown(max(all - removed, 0.0)));
        if (max(change.x, max(change.y, change.z)) > data.frame.maxError)
            allowed = cut - 1u;
    }
    atomicMin(data.allowed, allowed);
}
