// SPDX-License-Identifier: Apache-2.0
// The points of a light source for which shadows are found (lib/visibility). Written by
// `candelabra_fit points`, which places the points so that an edge of a shadow across a light
// counts the right share of them. The root mean square of share of points minus share of area, over
// half-planes, is 0.0104 (64 in the disc), 0.0182 (32), 0.0087 (64 in the square) and 0.0156 (32).
// Half-planes whose edge is nearly along a side of the square count 8 times.
// A unit test (PointSets) computes it again. engine/tables/point_table.h derives sets of points
// from them.
//
// Bit i of a mask belongs to point i: bits 0..31 are in x, bits 32..63 in y. All coordinates lie
// inside (-1, 1), in units of the half axes of the facet.
#ifndef CND_SHARED_VISIBILITY_POINTS_H
#define CND_SHARED_VISIBILITY_POINTS_H

#include "shared/prelude.h"

GPU_BEGIN

// Which points a facet has: those in the unit disc, those in the square, or only (0, 0).
const uint FACET_DISC = 0u;
const uint FACET_SQUARE = 1u;
const uint FACET_POINT = 2u;

// How many sets there are of points below a coordinate, and of points in a stadium.
const uint POINT_PREFIXES = 33u;
const uint STADIUM_RATIOS = 16u;

// clang-format off
// The points in the disc, then those in the square; the same again for 32.
const vec2 POINTS_64[128] = {
    vec2(-0.91103f, 0.00359f), vec2(-0.87595f, -0.26054f), vec2(-0.85650f, 0.20122f),
    vec2(-0.80536f, 0.42626f), vec2(-0.76483f, -0.51043f), vec2(-0.69078f, -0.06172f),
    vec2(-0.66167f, 0.15424f), vec2(-0.66123f, 0.63650f), vec2(-0.65279f, -0.30659f),
    vec2(-0.57851f, 0.39156f), vec2(-0.56495f, -0.71744f), vec2(-0.53791f, -0.50905f),
    vec2(-0.46930f, -0.02052f), vec2(-0.45414f, 0.56112f), vec2(-0.45168f, -0.24397f),
    vec2(-0.44725f, 0.24127f), vec2(-0.43619f, 0.80416f), vec2(-0.36083f, -0.83533f),
    vec2(-0.29870f, -0.46737f), vec2(-0.26533f, -0.25514f), vec2(-0.25799f, 0.01444f),
    vec2(-0.25366f, 0.23331f), vec2(-0.24143f, 0.46209f), vec2(-0.23909f, -0.66669f),
    vec2(-0.23776f, 0.69926f), vec2(-0.15971f, 0.89917f), vec2(-0.14577f, -0.90601f),
    vec2(-0.08959f, -0.13443f), vec2(-0.05598f, 0.12734f), vec2(-0.05305f, -0.35358f),
    vec2(-0.04150f, -0.60333f), vec2(-0.03214f, 0.66682f), vec2(-0.03111f, 0.45585f),
    vec2(0.03733f, -0.79910f), vec2(0.08337f, 0.91060f), vec2(0.08461f, 0.27017f),
    vec2(0.11341f, 0.02100f), vec2(0.13152f, -0.23198f), vec2(0.15454f, -0.45964f),
    vec2(0.16288f, 0.63986f), vec2(0.22364f, -0.88539f), vec2(0.22678f, 0.43020f),
    vec2(0.24553f, -0.65294f), vec2(0.31703f, 0.17910f), vec2(0.32477f, 0.85618f),
    vec2(0.32490f, -0.06444f), vec2(0.37924f, -0.30518f), vec2(0.38710f, 0.63471f),
    vec2(0.41159f, -0.53975f), vec2(0.43669f, 0.38346f), vec2(0.45947f, -0.79081f),
    vec2(0.49583f, 0.10573f), vec2(0.55206f, -0.15628f), vec2(0.58801f, 0.70770f),
    vec2(0.59981f, -0.36617f), vec2(0.62317f, -0.62767f), vec2(0.64464f, 0.51831f),
    vec2(0.64785f, 0.26567f), vec2(0.68396f, -0.00268f), vec2(0.80184f, -0.46837f),
    vec2(0.82047f, -0.25878f), vec2(0.83664f, 0.40923f), vec2(0.86053f, 0.16815f),
    vec2(0.91536f, -0.04377f), vec2(-0.97427f, 0.20929f), vec2(-0.95672f, -0.76735f),
    vec2(-0.91716f, 0.61171f), vec2(-0.89896f, -0.34886f), vec2(-0.84850f, -0.11092f),
    vec2(-0.84212f, 0.84865f), vec2(-0.78363f, -0.58276f), vec2(-0.77453f, 0.32973f),
    vec2(-0.73884f, -0.93943f), vec2(-0.70510f, 0.48950f), vec2(-0.65830f, 0.07532f),
    vec2(-0.65065f, -0.41238f), vec2(-0.59716f, -0.16888f), vec2(-0.57308f, 0.97172f),
    vec2(-0.54637f, 0.72307f), vec2(-0.52925f, -0.66878f), vec2(-0.46943f, 0.53939f),
    vec2(-0.46851f, -0.87442f), vec2(-0.44428f, 0.27842f), vec2(-0.37716f, 0.02358f),
    vec2(-0.37635f, -0.46464f), vec2(-0.30977f, -0.22371f), vec2(-0.28909f, 0.80676f),
    vec2(-0.27123f, -0.76578f), vec2(-0.24524f, 0.40579f), vec2(-0.19065f, 0.15515f),
    vec2(-0.16366f, -0.50620f), vec2(-0.14577f, 0.64278f), vec2(-0.10562f, -0.26841f),
    vec2(-0.05811f, 0.87824f), vec2(-0.04010f, -0.03133f), vec2(-0.02932f, -0.95408f),
    vec2(0.01567f, -0.71698f), vec2(0.03717f, 0.45609f), vec2(0.06925f, 0.22817f),
    vec2(0.12144f, -0.30121f), vec2(0.14159f, 0.71656f), vec2(0.16439f, -0.56493f),
    vec2(0.20799f, -0.09363f), vec2(0.22974f, 0.95120f), vec2(0.27232f, -0.83683f),
    vec2(0.28597f, 0.42692f), vec2(0.32563f, 0.09677f), vec2(0.37201f, -0.33626f),
    vec2(0.39950f, 0.76686f), vec2(0.41447f, -0.60159f), vec2(0.45602f, 0.35386f),
    vec2(0.48918f, -0.86799f), vec2(0.52054f, 0.58513f), vec2(0.53125f, -0.15266f),
    vec2(0.58040f, 0.17206f), vec2(0.61210f, -0.38605f), vec2(0.65313f, 0.91446f),
    vec2(0.66590f, -0.64420f), vec2(0.72834f, 0.03699f), vec2(0.73788f, 0.65881f),
    vec2(0.74844f, -0.93896f), vec2(0.80687f, 0.29002f), vec2(0.80823f, -0.20112f),
    vec2(0.86774f, -0.48767f), vec2(0.87565f, 0.51377f), vec2(0.94358f, -0.75444f),
    vec2(0.95229f, 0.83179f), vec2(0.95402f, -0.02154f)};
const vec2 POINTS_32[64] = {
    vec2(-0.84898f, 0.15450f), vec2(-0.84097f, -0.18567f), vec2(-0.72542f, 0.46533f),
    vec2(-0.70584f, -0.49170f), vec2(-0.57805f, -0.05011f), vec2(-0.49317f, 0.70586f),
    vec2(-0.47580f, 0.24913f), vec2(-0.46662f, -0.72591f), vec2(-0.41411f, -0.34351f),
    vec2(-0.28218f, -0.01958f), vec2(-0.27608f, 0.49317f), vec2(-0.20488f, -0.51843f),
    vec2(-0.18450f, 0.84038f), vec2(-0.14008f, -0.86611f), vec2(-0.09875f, 0.21925f),
    vec2(-0.02971f, -0.15579f), vec2(0.02996f, 0.54140f), vec2(0.07553f, -0.50667f),
    vec2(0.15345f, 0.84912f), vec2(0.18364f, -0.83983f), vec2(0.22667f, 0.16249f),
    vec2(0.25329f, -0.15654f), vec2(0.30499f, 0.48205f), vec2(0.36210f, -0.43414f),
    vec2(0.47731f, 0.72862f), vec2(0.49206f, -0.70875f), vec2(0.54118f, 0.19252f),
    vec2(0.55861f, -0.11572f), vec2(0.69425f, 0.49079f), vec2(0.73092f, -0.48477f),
    vec2(0.83518f, -0.16034f), vec2(0.85347f, 0.19890f), vec2(-0.94924f, 0.25133f),
    vec2(-0.88616f, -0.26287f), vec2(-0.82487f, 0.85818f), vec2(-0.81776f, -0.86630f),
    vec2(-0.70330f, 0.51073f), vec2(-0.68202f, -0.52630f), vec2(-0.60562f, -0.06944f),
    vec2(-0.51227f, 0.15001f), vec2(-0.44558f, -0.79585f), vec2(-0.42668f, 0.63570f),
    vec2(-0.32073f, -0.32494f), vec2(-0.28577f, 0.96683f), vec2(-0.20054f, -0.64434f),
    vec2(-0.19287f, 0.40442f), vec2(-0.09551f, 0.04640f), vec2(-0.00145f, -0.40018f),
    vec2(0.02923f, 0.74763f), vec2(0.08544f, -0.96135f), vec2(0.13571f, 0.33309f),
    vec2(0.20907f, -0.14011f), vec2(0.29888f, -0.71934f), vec2(0.32609f, 0.61292f),
    vec2(0.39781f, 0.10479f), vec2(0.50192f, 0.88737f), vec2(0.51057f, -0.51027f),
    vec2(0.59070f, -0.23536f), vec2(0.66840f, 0.48462f), vec2(0.70064f, -0.85613f),
    vec2(0.79240f, 0.26339f), vec2(0.83766f, -0.07912f), vec2(0.92645f, -0.60272f),
    vec2(0.93381f, 0.76081f)};
// clang-format on

GPU_END

#endif
