// SPDX-License-Identifier: Apache-2.0
// The pixel that a shading kernel lights, with its lobes joined.
#include "lib/shade_inputs.glsl"
#define DFG_BINDING SHADE_DFG
#include "lib/dfg.glsl"
#include "lib/joining.glsl"

ShadingPoint readShadingPoint(uvec2 pixel, float depth)
{
    const vec3 position = viewPosition(params.projection, pixel, params.invImageSize, depth);
    ShadingPoint p = makeShadingPoint(readSurface(ivec2(pixel)), position,
                                      towardsEye(params.projection, position));
    if (params.lobes != LOBES_SUM || params.energyCompensation != 0u)
        joinLobes(p, directionalAlbedo(p.NoV, p.alpha), params.lobes, params.energyCompensation);
    return p;
}
