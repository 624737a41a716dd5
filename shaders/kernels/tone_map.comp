// SPDX-License-Identifier: Apache-2.0
// Scene luminance -> exposed -> tone mapped -> sRGB, dithered to 8 bits.
#version 460
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_samplerless_texture_functions : require
#include "lib/tone_map.glsl"

layout(local_size_x = TONE_MAP_GROUP, local_size_y = TONE_MAP_GROUP) in;
layout(constant_id = SPEC_TONE_MAP) const uint curve = TONEMAP_NONE;
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

// pcg3d: Jarzynski and Olano 2020, "Hash Functions for GPU Rendering".
uvec3 hash(uvec3 v)
{
    v = v * 1664525u + 1013904223u;
    v.x += v.y * v.z;
    v.y += v.z * v.x;
    v.z += v.x * v.y;
    v ^= v >> 16u;
    v.x += v.y * v.z;
    v.y += v.z * v.x;
    v.z += v.x * v.y;
    return v;
}

// Triangular in (-1, 1), mean 0: the sum of two uniforms makes the error independent of the signal.
vec3 triangularNoise(uvec2 pixel)
{
    const uvec3 h = hash(uvec3(pixel, params.ditherSeed));
    return (vec3(h & 0xFFFFu) + vec3(h >> 16u) + 1.0) / 65536.0 - 1.0;
}

void main()
{
    const uvec2 pixel = gl_GlobalInvocationID.xy;
    if (any(greaterThanEqual(pixel, params.size)))
        return;
    const vec3 radiance = texelFetch(radianceImage, ivec2(pixel), 0).rgb;
    const vec3 encoded = encodeSrgb(toneMap(curve, radiance * state.exposure));
    const vec3 noise = params.dither != 0u ? triangularNoise(pixel) : vec3(0.0);
    const vec3 steps = floor(clamp(encoded * 255.0 + noise, 0.0, 255.0) + 0.5);
    imageStore(displayImage, ivec2(pixel), vec4(steps / 255.0, 1.0));
}
