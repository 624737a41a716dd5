// SPDX-License-Identifier: Apache-2.0
// The points of a light source for which shadows are found (lib/visibility). Written by
// `candelabra_fit points`, which places the points so that an edge of a shadow across a light
// counts the right share of them. The root mean square of share of points minus share of area, over
// half-planes, is 0.0104 (64 in the disc), 0.0182 (32), 0.0097 (64 in the square) and 0.0171 (32).
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
    vec2(0.91536f, -0.04377f), vec2(-0.93027f, -0.22193f), vec2(-0.92730f, -0.82272f),
    vec2(-0.90977f, 0.88893f), vec2(-0.90548f, 0.43397f), vec2(-0.88095f, 0.16706f),
    vec2(-0.87996f, -0.51980f), vec2(-0.80622f, 0.66817f), vec2(-0.76642f, -0.06135f),
    vec2(-0.70309f, -0.67932f), vec2(-0.68011f, 0.41878f), vec2(-0.67211f, -0.39568f),
    vec2(-0.64217f, -0.89554f), vec2(-0.62677f, 0.86395f), vec2(-0.61352f, 0.10494f),
    vec2(-0.52897f, -0.20244f), vec2(-0.52037f, 0.63897f), vec2(-0.48071f, -0.56322f),
    vec2(-0.45690f, 0.27829f), vec2(-0.38885f, -0.86900f), vec2(-0.36086f, 0.92724f),
    vec2(-0.34982f, -0.00005f), vec2(-0.34634f, -0.33587f), vec2(-0.31945f, 0.41278f),
    vec2(-0.26780f, 0.68366f), vec2(-0.25319f, -0.64433f), vec2(-0.18081f, 0.21879f),
    vec2(-0.16323f, -0.13526f), vec2(-0.12874f, -0.91471f), vec2(-0.10335f, -0.45673f),
    vec2(-0.08944f, 0.55637f), vec2(-0.06728f, 0.86879f), vec2(-0.02644f, 0.03681f),
    vec2(0.01431f, -0.72795f), vec2(0.04779f, -0.27116f), vec2(0.06037f, 0.35103f),
    vec2(0.13022f, 0.67973f), vec2(0.13592f, -0.49178f), vec2(0.19789f, 0.91134f),
    vec2(0.19869f, 0.14556f), vec2(0.20163f, -0.91023f), vec2(0.24630f, -0.13712f),
    vec2(0.26815f, 0.48812f), vec2(0.32500f, -0.60392f), vec2(0.41620f, -0.37453f),
    vec2(0.41832f, 0.77984f), vec2(0.41987f, 0.29016f), vec2(0.43160f, 0.01488f),
    vec2(0.45323f, -0.80883f), vec2(0.54641f, -0.19425f), vec2(0.55166f, 0.55241f),
    vec2(0.61046f, 0.91599f), vec2(0.63350f, 0.18099f), vec2(0.63574f, -0.61580f),
    vec2(0.63963f, -0.91743f), vec2(0.71505f, -0.40892f), vec2(0.73251f, 0.69090f),
    vec2(0.74052f, -0.06153f), vec2(0.76051f, 0.37775f), vec2(0.89301f, -0.85755f),
    vec2(0.89461f, 0.86372f), vec2(0.89650f, -0.59247f), vec2(0.90013f, -0.26718f),
    vec2(0.91644f, 0.10347f), vec2(0.92893f, 0.48962f)};
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
    vec2(0.83518f, -0.16034f), vec2(0.85347f, 0.19890f), vec2(-0.89028f, 0.40694f),
    vec2(-0.86663f, -0.49958f), vec2(-0.85858f, -0.09830f), vec2(-0.82088f, 0.85402f),
    vec2(-0.79046f, -0.86032f), vec2(-0.61466f, 0.15710f), vec2(-0.57731f, -0.27321f),
    vec2(-0.55955f, 0.57982f), vec2(-0.49764f, -0.70111f), vec2(-0.36937f, 0.88565f),
    vec2(-0.30580f, 0.33540f), vec2(-0.28114f, -0.05004f), vec2(-0.23648f, -0.48397f),
    vec2(-0.16573f, -0.91041f), vec2(-0.12856f, 0.63630f), vec2(-0.00001f, -0.22067f),
    vec2(0.01839f, 0.18568f), vec2(0.08062f, -0.67215f), vec2(0.15117f, 0.87505f),
    vec2(0.24584f, 0.46670f), vec2(0.29398f, -0.38721f), vec2(0.31979f, 0.05638f),
    vec2(0.38853f, -0.86666f), vec2(0.45924f, 0.70771f), vec2(0.58728f, -0.14983f),
    vec2(0.60152f, 0.32687f), vec2(0.60389f, -0.57713f), vec2(0.76865f, 0.89368f),
    vec2(0.81819f, -0.85032f), vec2(0.85964f, 0.07634f), vec2(0.86545f, 0.54534f),
    vec2(0.90666f, -0.38022f)};
// clang-format on

GPU_END

#endif
