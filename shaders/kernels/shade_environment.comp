// SPDX-License-Identifier: Apache-2.0
// Adds the environment's light to every pixel with a surface, and the environment itself to the other
// pixels. Distant lights visible there stay, because surfaces are lit by both as well.
#version 460
#extension GL_GOOGLE_include_directive : require
#include "shared/environment_data.h"
#include "kernels/common/read_gbuffer.glsl"
#include "kernels/common/stored_depth.glsl"
#include "lib/dfg.glsl"
#include "lib/joining.glsl"
#include "lib/projection.glsl"

layout(local_size_x = SHADE_ENVIRONMENT_GROUP, local_size_y = SHADE_ENVIRONMENT_GROUP) in;
layout(push_constant, scalar) uniform Push
{
    ShadeEnvironmentParams params;
};
layout(binding = SHADE_ENVIRONMENT_DEPTH) uniform texture2D depthImage;
#include "kernels/common/add_radiance.glsl"
layout(binding = SHADE_ENVIRONMENT_CUBE) uniform samplerCube environment;
layout(binding = SHADE_ENVIRONMENT_PREFILTERED) uniform samplerCube prefiltered;
layout(binding = SHADE_ENVIRONMENT_IRRADIANCE) uniform samplerCube irradiance;
layout(binding = SHADE_ENVIRONMENT_DFG) uniform textureBuffer dfgTexels;

// lib/dfg.glsl reads its table through this function.
vec4 dfgTexel(int entry)
{
    return texelFetch(dfgTexels, entry);
}

// Returns what the eye sees beyond all surfaces, from the mip whose texels are as large as the pixel.
vec3 background(uvec2 pixel)
{
    const float texels = frameParams.invImageSize.y * float(textureSize(environment, 0).x) /
                         abs(frameParams.projection.m11);
    const float mip = frameParams.projection.eyeIsPoint * max(log2(texels), 0.0);
    const vec3 view = viewRay(frameParams.projection, pixel, frameParams.invImageSize);
    return textureLod(environment, params.environmentFromView * view, mip).rgb;
}

// Returns the reflected light by the split sum (Karis 2013): the lobe's mean radiance, prefiltered for
// v = n and looked up in the mirror direction, times its directional albedo. It is exact for a uniform
// environment. In others, lobes seen at grazing angles are rounder than they should be.
vec3 shade(ShadingPoint p)
{
    const vec2 albedo = directionalAlbedo(p.NoV, p.alpha);
    joinLobes(p, albedo, frameParams.lobes & (COMPENSATE_ENERGY - 1u),
              frameParams.lobes & COMPENSATE_ENERGY);
    // Level k is for alpha = 2^(k - last). Below level 1 the lobe fades into the mirror image.
    const float level = params.lastLevel + log2(p.alpha);
    const float fade = p.alpha * exp2(params.lastLevel - 1.0);
    const vec3 mirrored = textureLod(prefiltered, params.environmentFromView * p.mirror,
                                     max(level, min(fade, 1.0))).rgb;
    const vec3 diffuse = textureLod(irradiance, params.environmentFromView * p.n, 0.0).rgb;
    return p.albedo * diffuse + schlick(p, albedo) * mirrored;
}

void main()
{
    const uvec2 pixel = gl_GlobalInvocationID.xy;
    if (any(greaterThanEqual(pixel, frameParams.size)))
        return;
    const float depth = visibleDepth(params.depth, texelFetch(depthImage, depthTexelOf(pixel), 0));
    if (depth == frameParams.clearDepth) {
        if (params.showsBackground == 0u)
            return;
        const vec3 seen = params.scale * background(pixel);
        const ivec2 texel = texelOf(pixel);
        storeRadiance(texel, vec4(imageLoad(radianceImage, texel).rgb + seen, 1.0));
        return;
    }
    const vec3 position = viewPosition(frameParams.projection, pixel, frameParams.invImageSize, depth);
    const vec3 light = shade(makeShadingPoint(readSurface(pixel), position,
                                              towardsEye(frameParams.projection, position)));
    addRadiance(pixel, params.scale * light);
}
