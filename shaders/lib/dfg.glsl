// SPDX-License-Identifier: Apache-2.0
// Looks up the specular lobe's directional albedo. The includer defines DFG_BINDING, where the table
// is bound as a texel buffer, and DFG_SET when that is not set 0.
#ifndef CND_LIB_DFG
#define CND_LIB_DFG

#extension GL_EXT_samplerless_texture_functions : require
#include "lib/dfg_axes.glsl"

#ifndef DFG_SET
#define DFG_SET 0
#endif
layout(set = DFG_SET, binding = DFG_BINDING) uniform textureBuffer dfgTexels;

// Share of a white surrounding's light that the lobe reflects with F = 1 (x) and F = (1 - VoH)^5
// (y), within DFG_ERROR.
vec2 directionalAlbedo(float NoV, float alpha)
{
    const vec2 at = dfgCoordinates(NoV, alpha);
    const vec2 cell = min(floor(at), DFG_LAST - 1.0);
    const vec2 f = at - cell;
    const int entry = int(cell.y) * int(DFG_SIZE) + int(cell.x);
    const vec4 low = texelFetch(dfgTexels, entry);
    const vec4 high = texelFetch(dfgTexels, entry + int(DFG_SIZE));
    const vec4 row = mix(low, high, f.y);
    return mix(row.xy, row.zw, f.x);
}

#endif
