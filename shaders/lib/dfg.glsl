// SPDX-License-Identifier: Apache-2.0
// Looks up the specular lobe's directional albedo in the table that dfg_table.comp makes.
#ifndef CND_LIB_DFG
#define CND_LIB_DFG

#include "lib/dfg_axes.glsl"

// Returns an entry of the table. The includer defines this function.
vec4 dfgTexel(int entry);

// Returns which share of a uniform white environment's light the lobe reflects with F = 1 (x) and with
// F = (1 - VoH)^5 (y). The error is at most DFG_ERROR.
vec2 directionalAlbedo(float NoV, float alpha)
{
    const vec2 at = dfgCoordinates(NoV, alpha);
    const vec2 cell = min(floor(at), DFG_LAST - 1.0);
    const vec2 f = at - cell;
    const int entry = int(cell.y) * int(DFG_SIZE) + int(cell.x);
    const vec4 low = dfgTexel(entry);
    const vec4 high = dfgTexel(entry + int(DFG_SIZE));
    const vec4 row = mix(low, high, f.y);
    return mix(row.xy, row.zw, f.x);
}

#endif
