// SPDX-License-Identifier: Apache-2.0
// NoV and alpha of the columns and rows of the directional albedo table, and the position in the table
// of a given NoV and alpha.
#ifndef CND_LIB_DFG_AXES
#define CND_LIB_DFG_AXES

#include "shared/dfg.h"
#include "shared/lighting_data.h"
#include "lib/math.glsl"

const float DFG_LAST = float(DFG_SIZE - 1u);
const float DFG_FIRST_ROW = 0.21147425; // MIN_ALPHA^(1/4)
const float DFG_FIRST_COLUMN = 0.1;     // MIN_NOV^(1/4)

float dfgNoV(uint column)
{
    const float x = mix(DFG_FIRST_COLUMN, 1.0, float(column) / DFG_LAST);
    return min(x * x * x * x, 1.0);
}

float dfgAlpha(uint row)
{
    const float y = mix(DFG_FIRST_ROW, 1.0, float(row) / DFG_LAST);
    return y * y * y * y;
}

// Returns the column (x) and the row (y), with fractions and clamped to the table.
vec2 dfgCoordinates(float NoV, float alpha)
{
    const vec2 first = vec2(DFG_FIRST_COLUMN, DFG_FIRST_ROW);
    return clamp((sqrt(sqrt(vec2(NoV, alpha))) - first) / (1.0 - first), 0.0, 1.0) * DFG_LAST;
}

#endif
