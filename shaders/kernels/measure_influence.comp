// SPDX-License-Identifier: Apache-2.0
// Every light at some pixels, uncut: luminance by the illuminance that lights give there at most, which
// is what they are cut by.
#version 460
#extension GL_GOOGLE_include_directive : require
#include "lib/influence.glsl"
#include "lib/shade_receiver.glsl"

// The k-th light of the batch.
uint lightAt(uint k)
{
    return params.firstLight + k;
}

#include "lib/light_walk.glsl"

layout(local_size_x = MEASURE_INFLUENCE_GROUP) in;
layout(scalar, binding = MEASURE_INFLUENCE_DATA) readonly buffer Data
{
    InfluenceData data;
};
layout(scalar, binding = MEASURE_INFLUENCE_SUMS) buffer SampleSums
{
    vec3 sums[];
};

uint slotOf(Receiver r, uint light)
{
    if (IS_DISTANT)
        return INFLUENCE_DISTANT;
    const vec4 centreReach = lightCentre(light);
    const float d2 = length2(towardsLight(centreReach.xyz, r.p.position));
    const float intensity =
        peakIntensity(lightType, lightEmission(light).xyz, centreReach.w,
                      lightAux[light * LIGHT_AUX_STRIDE], lightAux[light * LIGHT_AUX_STRIDE + 1u]);
    return influenceBin(intensity * data.frame.exposure / max(d2, MIN_LENGTH2));
}

// As SHADE_FOUND. A lane that is done may run once more: what it finds then counts for nothing.
#define MEASURE_FOUND(r, first, found, evaluate)                                                   \
    if (!none(found)) {                                                                            \
        uvec2 left = found;                                                                        \
        do {                                                                                       \
            const uint light = lightAt((first) + lowest(left));                                    \
            const uint slot = none(left) ? INFLUENCE_NONE : slotOf(r, light);                      \
            sums[firstSlot + slot] += evaluate(r, light);                                          \
            left = withoutLowest(left);                                                            \
        } while (!none(left));                                                                     \
    }

void main()
{
    const uint sampleIndex = gl_GlobalInvocationID.x;
    if (sampleIndex >= data.frame.samples.x * data.frame.samples.y)
        return;
    const uint turn = influenceFrame(data.frame, data.states[data.frame.previous]) + params.batchLevel;
    const uvec2 pixel = influencePixel(data.frame, sampleIndex, turn);
    if (any(greaterThanEqual(pixel, params.size)))
        return;
    const float depth = texelFetch(depthImage, ivec2(pixel), 0).x;
    if (depth == params.clearDepth)
        return;
    const Receiver r = makeReceiver(readShadingPoint(pixel, depth), 0.0, params.sampleCount,
                                    pixelSeed(pixel));
    const uint firstSlot = sampleIndex * INFLUENCE_SLOTS;
    for (uint first = 0u; first < params.lightCount; first += WALK_BLOCK) {
        const Found found =
            findLights(r, first, min(WALK_BLOCK, params.lightCount - first), false);
#if HAS_CONIC
        MEASURE_FOUND(r, first, found.near, evaluateNear)
#endif
#if HAS_SPHERES
        MEASURE_FOUND(r, first, found.above, evaluateAbove)
#endif
        MEASURE_FOUND(r, first, found.general, evaluateGeneral)
    }
}
