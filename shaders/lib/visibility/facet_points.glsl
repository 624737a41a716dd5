// SPDX-License-Identifier: Apache-2.0
// The points of facets, and sets of points as masks. `count` is the number of points, 64 or 32. Before
// this file, the includer defines uvec2 pointTable(uint i), which returns entry i of the table for this
// count (engine/tables/point_table.h). A buffer holds the table, because llvmpipe copies constant
// arrays to the stack wherever they are read.
#ifndef CND_LIB_VISIBILITY_FACET_POINTS
#define CND_LIB_VISIBILITY_FACET_POINTS

#include "shared/visibility_points.h"

// Returns point i in units of the half axes.
vec2 facetPoint(uint count, uint shape, uint i)
{
    if (shape == FACET_POINT)
        return vec2(0.0);
    const uvec2 bits = pointTable(shape * count + i);
    return vec2(uintBitsToFloat(bits.x), uintBitsToFloat(bits.y));
}

uvec2 allPoints(uint count, uint shape)
{
    if (shape == FACET_POINT)
        return uvec2(1u, 0u);
    return uvec2(0xFFFFFFFFu, count == 64u ? 0xFFFFFFFFu : 0u);
}

// Returns the points whose coordinate on the axis (0: u, 1: v) is below -1 + k / 16. `shape` is not
// FACET_POINT.
uvec2 pointsBelow(uint count, uint shape, uint axis, uint k)
{
    return pointTable(2u * count + (shape * 2u + axis) * POINT_PREFIXES + k);
}

// How far beyond bounds points count, which is more than the rounding of the bounds.
const float POINT_SLACK = 1e-4;

// Returns a set that holds all points whose coordinate on the axis lies between the bounds, or at most
// `slack` beside them. The bounds may be infinite.
uvec2 pointsBetween(uint count, uint shape, uint axis, float low, float high, float slack)
{
    if (shape == FACET_POINT)
        return uvec2(low <= slack && high >= -slack ? 1u : 0u, 0u);
    const float first = clamp(floor((low - slack + 1.0) * 16.0), 0.0, 32.0);
    const float last = clamp(ceil((high + slack + 1.0) * 16.0), 0.0, 32.0);
    return pointsBelow(count, shape, axis, uint(last)) & ~pointsBelow(count, shape, axis, uint(first));
}

// Returns the points of the square that lie in a stadium along u that fills it. `ratio`: length of each
// round end, divided by half the length of the stadium; 0..1.
uvec2 stadiumPoints(uint count, float ratio)
{
    const float steps = float(STADIUM_RATIOS);
    const uint i = uint(clamp(floor(ratio * steps + 0.5), 1.0, steps)) - 1u;
    return pointTable(2u * count + 4u * POINT_PREFIXES + i);
}

bool isEmpty(uvec2 points)
{
    return (points.x | points.y) == 0u;
}

#endif
