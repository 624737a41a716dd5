// SPDX-License-Identifier: Apache-2.0
// Adds up frames whose cameras are shifted by parts of a pixel: their scene radiance, and the light
// that their display images represent. Then turns the sums into means.
#version 460
#extension GL_GOOGLE_include_directive : require
#include "lib/tone_map.glsl"
#include "shared/accumulate.h"

layout(local_size_x = ACCUMULATE_GROUP, local_size_y = ACCUMULATE_GROUP) in;
layout(push_constant, scalar) uniform Push
{
    AccumulateParams params;
};
layout(binding = ACCUMULATE_RADIANCE, rgba32f) uniform image2D radianceImage;
layout(binding = ACCUMULATE_SAMPLE, rgba8) uniform readonly image2D sampleImage;
layout(binding = ACCUMULATE_RADIANCE_SUM, rgba32f) uniform image2D radianceSum;
layout(binding = ACCUMULATE_DISPLAY_SUM, rgba32f) uniform image2D displaySum;
layout(binding = ACCUMULATE_DISPLAY, rgba8) uniform writeonly image2D displayImage;

// Returns the display image of the frame as linear light.
vec3 loadSample(ivec2 at)
{
    return decodeSrgb(imageLoad(sampleImage, at).rgb);
}

// Adds what the frame's nine nearest samples see around the centre of the pixel. Their weights are
// those of the quadratic B-spline at their distances in x and in y, which add up to 1: nearly a Gauss
// curve with a standard deviation of half a pixel.
void addFrame(ivec2 at)
{
    const vec2 before = 0.5 * (0.5 + params.offset) * (0.5 + params.offset);
    const vec2 after = 0.5 * (0.5 - params.offset) * (0.5 - params.offset);
    const vec2 middle = 0.75 - params.offset * params.offset;
    const vec2 weights[3] = vec2[](before, middle, after);
    vec4 radiance = vec4(0.0);
    vec3 display = vec3(0.0);
    for (int y = 0; y < 3; ++y)
        for (int x = 0; x < 3; ++x) {
            const ivec2 near = clamp(at + ivec2(x - 1, y - 1), ivec2(0), ivec2(params.size) - 1);
            const float weight = weights[x].x * weights[y].y;
            radiance += weight * imageLoad(radianceImage, near);
            display += weight * loadSample(near);
        }
    if (params.index > 0u) {
        radiance += imageLoad(radianceSum, at);
        display += imageLoad(displaySum, at).rgb;
    }
    imageStore(radianceSum, at, radiance);
    imageStore(displaySum, at, vec4(display, 1.0));
}

void storeMeans(ivec2 at)
{
    const float count = float(params.count);
    imageStore(radianceImage, at, imageLoad(radianceSum, at) / count);
    // The display images are dithered, each with other noise, so their mean is finer than their
    // steps. It is dithered with the same noise whatever the number of frames.
    const vec3 encoded = encodeSrgb(min(imageLoad(displaySum, at).rgb / count, vec3(1.0)));
    const float last = 255.0;
    const vec3 steps = params.dither != 0u ? quantize(encoded, last, ditherNoise(uvec3(at, ~0u)))
                                           : quantize(encoded, last);
    imageStore(displayImage, at, vec4(steps / last, 1.0));
}

void main()
{
    if (any(greaterThanEqual(gl_GlobalInvocationID.xy, params.size)))
        return;
    const ivec2 at = ivec2(gl_GlobalInvocationID.xy);
    if (params.count == 0u)
        addFrame(at);
    else
        storeMeans(at);
}
