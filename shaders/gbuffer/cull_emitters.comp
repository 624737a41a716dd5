// SPDX-License-Identifier: Apache-2.0
// Leaves out the visible area lights whose quad (emitter_quad.glsl) covers no sample: most lights are
// smaller than a pixel, or outside of the image. One lane tests up to PIECE_EMITTERS consecutive lights
// of one shape, and writes the others, in their old order, with a draw command for them. The test may
// keep quads that cover nothing, but drops none that covers a sample.
#version 460
#extension GL_GOOGLE_include_directive : require
#include "gbuffer/emitter_quad.glsl"
#include "gbuffer/sample_bounds.glsl"
#include "gbuffer/slack.glsl"

layout(local_size_x = CULL_EMITTERS_GROUP) in;
layout(push_constant, scalar) uniform Push
{
    CullEmittersParams params;
};
layout(scalar, binding = CULL_EMITTERS_RECORDS) readonly buffer Records
{
    EmitterRecord records[];
};
layout(scalar, binding = CULL_EMITTERS_CORNERS) readonly buffer Corners
{
    vec4 corners[];
};
layout(scalar, binding = CULL_EMITTERS_KEPT_RECORDS) writeonly buffer KeptRecords
{
    EmitterRecord keptRecords[];
};
layout(scalar, binding = CULL_EMITTERS_KEPT_CORNERS) writeonly buffer KeptCorners
{
    vec4 keptCorners[];
};
layout(scalar, binding = CULL_EMITTERS_DRAWS) writeonly buffer Draws
{
    EmitterDraw draws[];
};

// Tells whether the quad of an emitter may cover a sample.
bool mayCoverSample(EmitterRecord emitter)
{
    const float radius =
        emitterBoundingRadius(params.shape, emitter.axisU, emitter.axisV, emitter.radius);
    const EmitterQuad quad =
        emitterQuad(params.shape, emitterCenter(params.shape, emitter.position), radius);
    const mat4 m = frame.clipFromView;
    vec2 low = vec2(1e30), high = vec2(-1e30);
    float nearest = 1e30, farthest = -1e30, error = 0.0;
    for (int i = 0; i < 4; ++i) {
        const vec3 view = quadCorner(quad, vec2(i & 1, i >> 1) * 2.0 - 1.0);
        const vec4 clip = m * vec4(view, 1.0);
        const vec4 magnitude = abs(m[0] * view.x) + abs(m[1] * view.y) + abs(m[2] * view.z) + abs(m[3]);
        const float w = max(clip.w, 1e-6); // smaller ones are dealt with below
        const vec2 ndc = clip.xy / w;
        low = min(low, ndc);
        high = max(high, ndc);
        nearest = min(nearest, clip.w);
        farthest = max(farthest, clip.w);
        const vec2 far = abs(ndc);
        error = max(error, (max(magnitude.x, magnitude.y) + max(far.x, far.y) * magnitude.w) / w);
    }
    // Quads are clipped where w is below 1e-3, by their depth.
    if (farthest < 0.0 && !quad.fillsScreen)
        return false;
    const vec2 halfSize = 0.5 * frame.size;
    const float pixelError = SLACK * max(halfSize.x, halfSize.y) * error + params.snap;
    const SampleBounds samples =
        samplesIn((low + 1.0) * halfSize, (high + 1.0) * halfSize, pixelError, frame.size);
    return quad.fillsScreen || !(nearest > 1e-3) || !isEmpty(samples);
}

void main()
{
    const uint piece = gl_GlobalInvocationID.x;
    if (piece >= params.pieceCount)
        return;
    const uint begin = piece * PIECE_EMITTERS; // counted within the shape
    const uint end = min(begin + PIECE_EMITTERS, params.count);
    uint kept = begin;
    for (uint i = begin; i < end; ++i) {
        const EmitterRecord emitter = records[params.first + i];
        if (mayCoverSample(emitter)) {
            keptRecords[params.first + kept] = emitter;
            if (params.shape == LIGHT_POLYGON)
                for (uint k = 0u; k < EMITTER_CORNER_PAIRS; ++k)
                    keptCorners[params.firstCorners + kept * EMITTER_CORNER_PAIRS + k] =
                        corners[params.firstCorners + i * EMITTER_CORNER_PAIRS + k];
            ++kept;
        }
    }
    draws[params.firstPiece + piece] = EmitterDraw(4u, kept - begin, 0u, begin);
}
