// SPDX-License-Identifier: Apache-2.0
// Reads the surface that a shading kernel lights, and joins its lobes.
#include "kernels/common/shade_inputs.glsl"
#include "lib/dfg.glsl"
#include "lib/joining.glsl"

layout(binding = SHADE_DFG) uniform textureBuffer dfgTexels;

// lib/dfg.glsl reads its table through this function.
vec4 dfgTexel(int entry)
{
    return texelFetch(dfgTexels, entry);
}

ShadingPoint readShadingPoint(uvec2 pixel, float depth)
{
    const vec3 position = viewPosition(frameParams.projection, pixel, frameParams.invImageSize, depth);
    ShadingPoint p = makeShadingPoint(readSurface(pixel), position,
                                      towardsEye(frameParams.projection, position));
    if (frameParams.lobes != LOBES_SUM)
        joinLobes(p, directionalAlbedo(p.NoV, p.alpha), frameParams.lobes & (COMPENSATE_ENERGY - 1u),
                  frameParams.lobes & COMPENSATE_ENERGY);
    return p;
}

// Returns a seed for sampling lights, which differs between pixels and frames.
uint pixelSeed(uvec2 pixel)
{
    return frameParams.sampleSeed * 0x9E3779B9u + pixel.y * 0x10000u + pixel.x;
}
