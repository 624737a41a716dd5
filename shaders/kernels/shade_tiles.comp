// SPDX-License-Identifier: Apache-2.0
// Adds the lights of each tile's list to the scene radiance.
#version 460
#extension GL_GOOGLE_include_directive : require
#include "lib/shade_inputs.glsl"
#include "lib/light_eval.glsl"
#include "lib/tile_walk.glsl"

layout(local_size_x = TILE_SIZE, local_size_y = TILE_SIZE) in;
layout(binding = SHADE_RADIANCE, rgba32f) uniform image2D radianceImage;

void main()
{
    const uvec2 pixel = gl_GlobalInvocationID.xy;
    if (any(greaterThanEqual(pixel, params.size)))
        return;
    const TileList list = lists[gl_WorkGroupID.y * params.tileCountX + gl_WorkGroupID.x];
    const float depth = texelFetch(depthImage, ivec2(pixel), 0).x;
    if (list.count == 0u || depth == params.clearDepth)
        return;
    const vec3 position = viewPosition(params.projection, pixel, params.invImageSize, depth);
    const ShadingPoint p = makeShadingPoint(readSurface(ivec2(pixel)), position,
                                            towardsEye(params.projection, position));
    vec3 sum = vec3(0.0);
    // Test a block of the list with all lanes in step, then let each lane shade what it found.
    for (uint first = 0u; first < list.count; first += WALK_BLOCK) {
        uint found = findReaching(list, first, position, p.n);
        while (found != 0u) {
            const uint light = listedLight(list, first + findLSB(found));
            found &= found - 1u;
            sum += evaluateLight(p, light, lightCentre(light), lightEmission(light));
        }
    }
    const vec4 before = imageLoad(radianceImage, ivec2(pixel));
    imageStore(radianceImage, ivec2(pixel), before + vec4(sum, 0.0));
}
