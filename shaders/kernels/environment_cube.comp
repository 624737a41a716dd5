// SPDX-License-Identifier: Apache-2.0
// Converts an equirectangular radiance image into a cube.
#version 460
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_samplerless_texture_functions : require
#include "shared/environment.h"
#include "lib/cube.glsl"

layout(local_size_x = ENVIRONMENT_GROUP, local_size_y = ENVIRONMENT_GROUP) in;
layout(push_constant, scalar) uniform Push
{
    EnvironmentCubeParams params;
};
layout(binding = ENVIRONMENT_CUBE_IMAGE) uniform texture2D equirectangularImage;
layout(binding = ENVIRONMENT_CUBE_OUTPUT, rgba32f) uniform writeonly image2DArray cube;
layout(binding = ENVIRONMENT_CUBE_MIRROR, rgba32f) uniform writeonly image2DArray mirror;

// Returns the luminance of a texel. Files may contain any value: NaN and negative values become 0,
// infinity becomes ENVIRONMENT_MAX_LUMINANCE.
vec3 luminanceAt(ivec2 texel)
{
    const ivec2 size = ivec2(params.imageSize);
    const ivec2 at = ivec2((texel.x + size.x) % size.x, clamp(texel.y, 0, size.y - 1));
    const vec3 value = texelFetch(equirectangularImage, at, 0).rgb;
    return mix(vec3(0.0), min(value, ENVIRONMENT_MAX_LUMINANCE), greaterThan(value, vec3(0.0)));
}

// Returns the luminance from a direction, interpolated bilinearly; in x the image wraps around. It uses
// no sampler, so that the host's image may have any format and usage.
vec3 luminanceTowards(vec3 direction)
{
    const vec2 at = equirectangular(normalize(direction)) * vec2(params.imageSize) - 0.5;
    const ivec2 texel = ivec2(floor(at));
    const vec2 f = at - vec2(texel);
    return mix(mix(luminanceAt(texel), luminanceAt(texel + ivec2(1, 0)), f.x),
               mix(luminanceAt(texel + ivec2(0, 1)), luminanceAt(texel + ivec2(1, 1)), f.x), f.y);
}

void main()
{
    const uvec3 texel = gl_GlobalInvocationID;
    if (any(greaterThanEqual(texel.xy, uvec2(params.cubeSize))))
        return;
    vec3 sum = vec3(0.0);
    float weight = 0.0;
    for (uint y = 0u; y < params.samples; ++y)
        for (uint x = 0u; x < params.samples; ++x) {
            const uint size = params.cubeSize * params.samples;
            const vec2 uv = cubeTexelCentre(texel.xy * params.samples + uvec2(x, y), size);
            const float w = cubeTexelSolidAngle(uv, size);
            sum += w * luminanceTowards(cubeDirection(texel.z, uv));
            weight += w;
        }
    const vec4 luminance = vec4(sum / weight, 1.0);
    imageStore(cube, ivec3(texel), luminance);
    imageStore(mirror, ivec3(texel), luminance);
}
