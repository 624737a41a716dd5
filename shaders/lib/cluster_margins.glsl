// SPDX-License-Identifier: Apache-2.0
// Widens the bounds of surface samples by what rounding may change between the kernel that makes them
// and the kernels that shade the samples.
//
// Both read the same depth and the same normal, but they need not get the same position: viewPosition()
// divides, and Vulkan allows a quotient to be off by 2.5 ULP, in each pipeline differently. How far two
// results may lie apart, with u = 2^-23, of which an ULP is at most that share of its number:
//   z   The operands of its division have the same bits, because they are `precise`. Two quotients
//       differ by at most 5 u |z|.
//   w   = m23 z + m33. Let Z be the largest |z| of the samples and W = |m23| Z + |m33|. Besides 5 u W
//       from z there are two operations, each with a rounding error of u / 2 W in each kernel: 7 u W.
//   x   = (ndc w - m20 z - m30) / m00 with |ndc| <= 1. Let T = W + |m20| Z + |m30|. The numerator
//       differs by 7 u W + 5 u |m20| Z and by four roundings of u / 2 T in each kernel, so by 11 u T.
//       The division adds 5 u |x| <= 5 u T / |m00|: together 16 u T / |m00|.
//   y   likewise, with m21, m31 and m11.
// POSITION_ERROR has a quarter more, for products of these errors.
#ifndef CND_LIB_CLUSTER_MARGINS
#define CND_LIB_CLUSTER_MARGINS

#include "shared/cluster_data.h"
#include "lib/bounds.glsl"

const float POSITION_ERROR = 20.0 / 8388608.0;

// Returns how far two kernels may place a sample apart along each axis, if no sample is farther away
// along the z axis than `farthest`.
vec3 positionMargin(Projection m, float farthest)
{
    const float w = abs(m.m23) * farthest + abs(m.m33);
    return POSITION_ERROR * vec3((w + abs(m.m20) * farthest + abs(m.m30)) / abs(m.m00),
                                 (w + abs(m.m21) * farthest + abs(m.m31)) / abs(m.m11), farthest);
}

// Returns the slope of a cone that still holds the samples of a cone with this slope when each sample p
// or the axis moves by at most shift |p|. With h the component of p along the axis, |p| is at most
// h sqrt(1 + slope^2). So p is at most slope h + shift |p| aside and at least h - shift |p| ahead.
float widerSlope(float slope, float shift)
{
    const float turn = shift * sqrt(1.0 + slope * slope);
    return turn < 1.0 ? min((slope + turn) / (1.0 - turn), MAX_SLOPE) : MAX_SLOPE;
}

// Bound of the error of the cosine between two normals: their lengths may differ from 1 by 8 ULP each
// if a driver normalises by a square root and a division, which is 32 of these units; the rest is the
// dot product (3) and the directions (8). The error of the sine of a small angle is far larger, and a
// light just above the horizon must not be taken for one below it.
const float COS_MARGIN = 48.0 / 16777216.0;

Cluster withoutCone(Cluster c)
{
    c.ray = vec3(0.0);
    c.slope = 0.0;
    return c;
}

// Returns the cluster widened by the largest effect of rounding, and with finite bounds.
Cluster withMargins(Cluster c, Projection m)
{
    c.min = max(c.min, -UNBOUNDED);
    c.max = min(c.max, UNBOUNDED);
    const vec3 moved = positionMargin(m, max(abs(c.min.z), abs(c.max.z)));
    c.min -= moved;
    c.max += moved;
    const float slabMargin =
        DOT_MARGIN * max(largest(c.min), largest(c.max)) + moved.x + moved.y + moved.z;
    c.slabMin = max(c.slabMin, -UNBOUNDED) - slabMargin;
    c.slabMax = min(c.slabMax, UNBOUNDED) + slabMargin;
    c.minCos -= COS_MARGIN;
    // There is no cone of view rays in orthographic views, whose boxes are aligned with the rays, and
    // in very wide views, where a tile may hold rays more than a quarter turn from its axis.
    if (m.eyeIsPoint == 0.0)
        return withoutCone(c);
    // In a perspective view a sample moves by a share of its |z|, which is at most its distance. Its
    // distance from the axis of the cone is computed with an error of at most DOT_MARGIN times its
    // distance from the eye, and divided and rooted with a relative error of less than DOT_MARGIN.
    const vec3 share = positionMargin(m, 1.0);
    c.slope = widerSlope(c.slope * (1.0 + DOT_MARGIN), DOT_MARGIN + share.x + share.y + share.z);
    return c.slope < MAX_SLOPE ? c : withoutCone(c);
}

#endif
