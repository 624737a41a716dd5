// SPDX-License-Identifier: Apache-2.0
// Every constant of the closed-form specular of area lights (lib/specular/conic*.glsl) that was
// fitted or chosen. The shaders and the program that fits them (tools/fit) read them here.
// Constants that are derived, or that only protect a quotient or a root from rounding, are in the
// formulas.
#ifndef CND_SHARED_CONIC_CONSTANTS_H
#define CND_SHARED_CONIC_CONSTANTS_H

#include "shared/prelude.h"

GPU_BEGIN

// --- Fitted together, to results of quadrature, by candelabra_fit conic: X(name, value, meaning).
// They place the nodes at which shadowing and Fresnel are evaluated
// (lib/specular/conic_shading.glsl explains the terms). All are dimensionless and positive. If the
// meaning includes a value for a disc, that value was derived for a small disc of slopes in a lobe
// that is constant over the disc; the fit corrects it for real lobes and lights. What errors remain
// is in tools/bench/RESULTS.md (decision 22): with F0 = 1 their mean is 0.05% of the highest
// response, the largest 3.5%. A unit test (ConicFit) fails when a value changes without a new fit.
// Lights of other shapes use those of two nodes, too. A fit to all shapes gave them no smaller
// errors (decision 53).
//
// The first five are the coefficients of the mean of N.L over the part of a cap above the horizon,
// divided by the highest N.L there. u is the share of the cap's diameter above the horizon, 0..1.
#define CND_CONIC_FITTED(X)                                                                        \
    X(CONIC_CUT_MEAN, 0.3653f, "mean over highest N.L of a cut cap, where it sets (u = 0)")        \
    X(CONIC_CUT_MEAN_U, 0.2182f, "mean over highest N.L: term in u")                               \
    X(CONIC_CUT_MEAN_U2, 0.1941f, "mean over highest N.L: term in u^2, subtracted")                \
    X(CONIC_CUT_MEAN_U2_SIZE, 0.1923f,                                                             \
      "mean over highest N.L: term in u^2 (1 - cosine of the cap's half angle)")                   \
    X(CONIC_CUT_MEAN_U5, 0.1443f, "mean over highest N.L: term in u^5")                            \
    X(CONIC_LIGHT_SPREAD, 0.2212f,                                                                 \
      "squared distance of the light's two heights from their mean, over (mean - lowest) "         \
      "(highest - mean) of N.L; 0.25 for a disc")                                                  \
    X(CONIC_WIDTH_FROM_SLOPE, 3.684f,                                                              \
      "weight of the squared mean slope beside alpha^2 in the width of the lobe")                  \
    X(CONIC_WIDTH_FROM_HEIGHT, 0.9612f,                                                            \
      "weight of the light's squared range of N.L, which the width of the lobe is compared with")  \
    X(CONIC_TAIL, 0.8444f,                                                                         \
      "growth of the slope variance towards the whole lobe: 1 / (1 - CONIC_TAIL integral), below " \
      "1; the variance of the whole lobe has no bound")                                            \
    X(CONIC_LENGTHENING, 0.4669f,                                                                  \
      "share of the squared slope radius that is added to m.m for the mean N.L; 0.5 for a disc")   \
    X(CONIC_LOBE_VARIANCE, 0.8506f,                                                                \
      "twice the share of the squared slope radius that is the variance of slopes along one line;" \
      " 0.5 for a disc")                                                                           \
    X(CONIC_RANGE_VARIANCE, 0.2621f,                                                               \
      "variance of N.L that fits into its range, over the largest that any distribution of that "  \
      "mean has; 0.25 for a disc")                                                                 \
    X(CONIC_MAX_MEAN_SHIFT, 0.4089f,                                                               \
      "largest shift of the mean N.L by the weight v.m, in standard deviations")                   \
    X(CONIC_NARROW_VARIANCE, 1.778f,                                                               \
      "factor on the variance of N.L that narrow lobes give, at the nodes")                        \
    X(CONIC_WIDE_VARIANCE, 1.128f,                                                                 \
      "factor on the variance of N.L that wide lobes give, at the nodes")                          \
    X(CONIC_FRESNEL_STEP, 0.7392f,                                                                 \
      "way of the half vector from its mean to a node, over the way that N.L alone would ask for") \
    X(CONIC_FRESNEL_LENGTHENING, 0.8924f,                                                          \
      "share of the squared slope radius that is added to m.m at both nodes")                      \
    X(CONIC_ONE_NODE_LENGTHENING, 0.75f,                                                           \
      "share of the squared slope radius that is added to m.m where one node serves")

#define X(name, value, meaning) const float name = value;
CND_CONIC_FITTED(X)
#undef X

// --- Fitted separately: minimax polynomials (lib/specular/conic_clip.glsl), by the algorithm of
// Remez. The area of a segment of a circle, divided by the area of the circle, is about
//   u^(3/2) (CONIC_SEGMENT - u (CONIC_SEGMENT_U + CONIC_SEGMENT_U2 u)),
// where u in 0..1 is the height of the segment, divided by the diameter. CONIC_SEGMENT is
// 16 / (3 pi), the start of the series, and the sum is 1 at u = 1, so one number was left to fit.
// The largest error is 0.0147 (with CONIC_SEGMENT_U2 = 0.352 it would be 0.0080).
const float CONIC_SEGMENT = 1.698f;
const float CONIC_SEGMENT_U = 0.438f;
const float CONIC_SEGMENT_U2 = 0.26f;
// atan(t) = t - T3 t^3 + T5 t^5 - ... - T15 t^15 for t in 0..1, with a largest error of 5.5e-8 rad.
// The first term is exactly t, because for small caps it is all that cancellation leaves.
const float CONIC_ATAN_T3 = 0.33331659f;
const float CONIC_ATAN_T5 = 0.19962704f;
const float CONIC_ATAN_T7 = 0.13976583f;
const float CONIC_ATAN_T9 = 0.09794236f;
const float CONIC_ATAN_T11 = 0.05777362f;
const float CONIC_ATAN_T13 = 0.02304016f;
const float CONIC_ATAN_T15 = 0.00435541f;

// --- Chosen by trials with thin tubes, rectangles and polygons. Spheres do not use it.
// How soon the lobe limits the variance of slopes over a light that is longer than the lobe.
const float CONIC_LINE_LIMIT = 2.0f;

// --- Chosen for the resolution of float32.
// The lowest NoV; below it the mean slope exceeds what float32 resolves. v is tilted together with
// it: if only the number were clamped, v . n and NoV would disagree and the cap would be no conic.
const float MIN_CONIC_NOV = 0.02f;
// The lowest v . m at the mean slope, because rounding can make it zero or negative.
const float MIN_CONIC_MU = 1e-6f;
// Caps with s^2 <= SMALL_CAP alpha^2 (s: sine of the half angle) are not clipped exactly, because
// the arcs of a tiny cone cancel in float32: the error is about eps (2 alpha / s)^2, with eps =
// 6e-8.
const float SMALL_CAP = 0.003f;
// Upper bound of the squared slope radius, in units of alpha^2. It is reached only far outside the
// lobe.
const float MAX_SLOPE_VARIANCE = 1e6f;
// Keeps quotients of variances of N.L finite for lights as small as a point.
const float MIN_VARIANCE = 1e-12f;

GPU_END

#endif
