// SPDX-License-Identifier: Apache-2.0
// Evaluates every light at some pixels, without cuts, and sums luminance by bins of the largest
// illuminance that a light may give there, which decides whether a cut ends the light. The lanes of a
// pixel share its lights, and each has its own sums. These are added in a fixed order, so that every
// run has the same bits.
#version 460
#extension GL_GOOGLE_include_directive : require
#include "lib/influence.glsl"
#include "kernels/common/shade_receiver.glsl"

layout(push_constant, scalar) uniform Push
{
    MeasureInfluenceParams params;
};

const uint LANES = MEASURE_INFLUENCE_LANES;
const uint SAMPLES_OF_GROUP = MEASURE_INFLUENCE_GROUP / LANES;

// Returns the k-th light of this lane, or the last light of the batch if the lane has fewer lights.
uint lightAt(uint k)
{
    const uint lane = gl_LocalInvocationIndex % LANES;
    return params.batch.first + min(k * LANES + lane, params.batch.count - 1u);
}

#define KEPT_LANES MEASURE_INFLUENCE_GROUP
#define LANES_OF_RECEIVER LANES // the lanes of a pixel have one receiver
#include "shading/light_walk.glsl"

layout(local_size_x = MEASURE_INFLUENCE_GROUP) in;
layout(scalar, binding = MEASURE_INFLUENCE_DATA) readonly buffer Data
{
    InfluenceData data;
};
layout(scalar, binding = MEASURE_INFLUENCE_SUMS) buffer SampleSums
{
    float sums[]; // a vec3 per slot
};

const uint ROWS = 3u * INFLUENCE_SLOTS;
// Indexed by row and lane, so that the lanes of a group never use the same bank of memory.
shared float laneSums[ROWS * MEASURE_INFLUENCE_GROUP];

uint slotOf(Receiver r, uint light)
{
    if (IS_DISTANT)
        return INFLUENCE_DISTANT;
    const vec4 centreRadius = lightCentre(light);
    const float d2 = length2(towardsLight(centreRadius.xyz, r.p.position));
    const float intensity =
        peakIntensity(lightType, lightEmission(light).xyz, centreRadius.w, lightShapes[light]);
    return influenceBin(intensity * data.frame.exposure / max(d2, MIN_LENGTH2));
}

void addToLane(uint slot, vec3 luminance)
{
    const uint at = 3u * slot * MEASURE_INFLUENCE_GROUP + gl_LocalInvocationIndex;
    laneSums[at] += luminance.x;
    laneSums[at + MEASURE_INFLUENCE_GROUP] += luminance.y;
    laneSums[at + 2u * MEASURE_INFLUENCE_GROUP] += luminance.z;
}

// A loop like SHADE_FOUND. A lane whose condition is false may run once more (IF_ANY_LEFT); it then
// adds 0.
#define MEASURE_FOUND(r, first, found, evaluate)                                                   \
    if (!none(found)) {                                                                            \
        uvec2 left = found;                                                                        \
        do {                                                                                       \
            const uint light = lightAt((first) + lowest(left));                                    \
            const vec3 luminance = evaluate(readAgain(r), light);                                  \
            const uint slot = slotOf(readAgain(r), lightAgain(light));                             \
            addToLane(slot, none(left) ? vec3(0.0) : luminance);                                   \
            left = withoutLowest(left);                                                            \
        } while (!none(left));                                                                     \
    }

// Sums this lane's share of the lights at the pixel.
void measure(Receiver r)
{
    for (uint row = 0u; row < ROWS; ++row)
        laneSums[row * MEASURE_INFLUENCE_GROUP + gl_LocalInvocationIndex] = 0.0;
    const uint lane = gl_LocalInvocationIndex % LANES;
    const uint count = (params.batch.count + LANES - 1u - lane) / LANES;
    for (uint first = 0u; first < count; first += WALK_BLOCK) {
        const Found found = findLights(readAgain(r), first, min(WALK_BLOCK, count - first), false);
#define X(WAY, which, SUM, response) MEASURE_FOUND(r, first, found.which, evaluate_##WAY)
        EVALUATIONS(X)
#undef X
    }
}

void main()
{
    const uint sampleIndex = params.firstSample + gl_WorkGroupID.x * SAMPLES_OF_GROUP +
                             gl_LocalInvocationIndex / LANES;
    const bool exists = sampleIndex < data.frame.samples.x * data.frame.samples.y;
    const uint turn = influenceTurn(data.frame, data.states[data.frame.previous], params.round);
    const uvec2 pixel = influencePixel(data.frame, sampleIndex, turn);
    const bool inside = exists && all(lessThan(pixel, frameParams.size));
    const float depth =
        inside ? texelFetch(depthImage, depthTexelOf(pixel), 0).x : frameParams.clearDepth;
    Receiver r;
    if (depth != frameParams.clearDepth) {
        r = makeReceiver(readShadingPoint(pixel, depth), frameParams.sampleCount, pixelSeed(pixel));
        if (gl_LocalInvocationIndex % LANES == 0u)
            keep(r);
    }
    if (KEEPS_RECEIVERS)
        barrier(); // before the other lanes of a pixel read what the first one keeps
    if (depth != frameParams.clearDepth)
        measure(r);
    barrier();
    if (depth == frameParams.clearDepth)
        return;
    // Each lane begins with its own column, so that no two lanes read the same bank.
    const uint lane = gl_LocalInvocationIndex % LANES;
    const uint firstLane = gl_LocalInvocationIndex - lane;
    for (uint row = lane; row < ROWS; row += LANES) {
        float sum = 0.0;
        for (uint i = 0u; i < LANES; ++i)
            sum += laneSums[row * MEASURE_INFLUENCE_GROUP + firstLane + (lane + i) % LANES];
        sums[sampleIndex * ROWS + row] += sum;
    }
}
