// SPDX-License-Identifier: Apache-2.0
// Exposes the scene radiance, applies the tone curve and the sRGB encoding, and dithers to the
// steps of the display.
#version 460
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_samplerless_texture_functions : require
#include "lib/tone_map.glsl"

layout(local_size_x = TONE_MAP_GROUP) in;
layout(constant_id = SPEC_TONE_MAP) const uint curve = TONEMAP_NONE;
layout(constant_id = SPEC_DISPLAY_STEPS) const uint lastStep = 255u;
layout(push_constant, scalar) uniform Push
{
    ToneMapParams params;
};
layout(binding = TONE_MAP_RADIANCE) uniform texture2D radianceImage;
layout(scalar, binding = TONE_MAP_STATE) readonly buffer State
{
    ExposureState state;
};
layout(binding = TONE_MAP_DISPLAY, rgba8) uniform writeonly image2D displayImage;

void main()
{
    uvec2 pixel = uvec2(gl_GlobalInvocationID.x, gl_WorkGroupID.y * TONE_MAP_ROWS);
    if (any(greaterThanEqual(pixel, params.size)))
        return;
    const uint end = min(pixel.y + TONE_MAP_ROWS, params.size.y);
    const float exposure = state.exposure;
    const uint dither = params.dither, seed = params.ditherSeed;
    const float last = float(lastStep);
    do {
        const ivec2 texel = ivec2(pixel + params.firstTexel);
        const vec3 radiance = texelFetch(radianceImage, texel, 0).rgb;
        const vec3 encoded = encodeSrgb(toneMap(curve, expose(radiance, exposure)));
        const vec3 steps =
            dither != 0u ? quantize(encoded, last, ditherNoise(uvec3(pixel, seed)))
                         : quantize(encoded, last);
        imageStore(displayImage, texel, vec4(steps / last, 1.0));
        ++pixel.y;
    } while (pixel.y < end);
}
