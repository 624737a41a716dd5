// SPDX-License-Identifier: Apache-2.0
// Shadowing and Fresnel over the region of a light (conic_region.glsl, conic_clip.glsl). The region's
// integral and mean slope are exact. The functions here are not: they replace the mean of a function of
// the half vector by its value at one node, the mean half vector, or at two nodes of N . L.
//
// The response to a light is an integral over its half vectors of D (n . h), whose integral the region
// has, times Fresnel and
//   2 (v . m) NoL / (NoL smithV + NoV smith(NoL)).
// This is G2 / (4 NoL NoV) (Heitz 2014, eq. 99) times NoL, times 4 (v . h), which converts the solid
// angle of half vectors to that of light directions (Walter et al. 2007, eq. 14), and divided by the
// lobe's n . h. In slopes, n . l = 2 (v . m) / (m . m) - NoV and v . h = (v . m) / |m|. Both depend on
// m . m, whose mean is 1 + |mean slope|^2 + the variance of the slopes.
//
// The variance comes from the region's area. The lobe's density in slopes is 1 / (pi alpha^2 q^2) with
// q = 1 + |slope|^2 / alpha^2, so a small region of a given integral has the area of a disc with
//   squared slope radius = alpha^2 integral q^2.
// The variance of the disc is half of that, and a quarter along any line. Larger regions are not discs
// of constant density, so the factors are fitted. shared/conic_constants.h has all of them and says
// what each one scales.
#ifndef CND_LIB_SPECULAR_CONIC_SHADING
#define CND_LIB_SPECULAR_CONIC_SHADING

#include "lib/specular/conic_region.glsl"

// Returns sqrt(a2 + (1 - a2) NoL^2), which is NoL (1 + 2 Lambda(NoL)) with Smith's Lambda (Heitz 2014,
// eq. 72).
float smith(ConicPoint p, float NoL)
{
    return sqrt(p.a2 + p.oneMinusA2 * NoL * NoL);
}

// Returns the response with one node, the mean half vector. Without the variance in m . m the error
// would be four times as large.
vec2 shadeOneNode(ConicPoint p, ConicRegion o)
{
    const float q = 1.0 + o.x2 * p.invA2;
    const float slopeRadius2 = p.a2 * min(o.integral * q * q, MAX_SLOPE_VARIANCE);
    const float im2 = 1.0 / (1.0 + o.x2 + CONIC_ONE_NODE_LENGTHENING * slopeRadius2);
    const float VoH = saturate(o.mu * sqrt(im2));
    const float NoL = clamp(2.0 * o.mu * im2 - p.NoV, 1e-6, 1.0);
    const float a = min(2.0 * o.integral * o.mu * NoL / (NoL * p.smithV + p.NoV * smith(p, NoL)), 1.0);
    return vec2(a, a * pow5(1.0 - VoH));
}

// N . L over the part of a cap above the horizon: its range, and its mean with equal weights for all
// directions.
struct CapHeights {
    float low, high, mean;
};

CapHeights capHeights(SphereCap cap, float sinC)
{
    const float cosS = 1.0 - cap.omc;
    CapHeights z;
    z.high = cap.NoC >= cosS ? 1.0 : cap.NoC * cosS + sinC * cap.s;
    z.low = max(0.0, cap.NoC * cosS - sinC * cap.s);
    // For a cap wholly above the horizon the mean of N . L is exactly NoC (1 + cos S) / 2.
    const float whole = cap.NoC * (1.0 - 0.5 * cap.omc);
    // For a cap that crosses the horizon, mean / high is close to 0.4..0.5, and at most the value of a
    // cap around the normal, (1 + cos S) / 2. u is 1 where the cap leaves the horizon; there the eighth
    // power of u leads over to the exact mean.
    const float u = saturate(0.5 + 0.5 * cap.NoC / cap.s);
    const float u2 = u * u;
    const float fraction = CONIC_CUT_MEAN + u * (CONIC_CUT_MEAN_U + u *
        (CONIC_CUT_MEAN_U5 * u2 * u + CONIC_CUT_MEAN_U2_SIZE * cap.omc - CONIC_CUT_MEAN_U2));
    const float cut = z.high * min(fraction, 0.5 + 0.5 * cosS);
    const float u8 = u2 * u2 * u2 * u2;
    z.mean = cut + u8 * (whole - cut);
    return z;
}

// N . L over a light, weighted by D, as wide lobes see it: its range, mean and variance.
struct LightHeights {
    float low, high;
    float mean, variance;
};

// N . L of two directions that replace a light, equally far from the mean.
struct HeightNodes {
    float low, high;
};

// `share`: their squared distance from the mean over (mean - low) (high - mean).
HeightNodes heightNodes(CapHeights z, float share)
{
    const float spread2 = share * (z.mean - z.low) * (z.high - z.mean);
    const float spread = min(sqrt(max(spread2, 0.0)), 0.98 * z.mean); // keeps both above the horizon
    return HeightNodes(z.mean - spread, min(z.mean + spread, 1.0));
}

// Returns the squared length, in the plane of the surface, of the half vector v + l of a direction with
// N . L = z. v: components of the eye's direction along an azimuth and perpendicular to it; `aside`:
// the perpendicular component of l.
float squaredReach(vec2 v, float z, float aside)
{
    const float along = v.x + sqrt(max(1.0 - z * z - aside * aside, 0.0));
    return along * along + (v.y + aside) * (v.y + aside);
}

// Returns N . L over a light with the heights z that two directions replace. D at both gives their
// weights: ha and hb are the squared lengths of their half vectors in the plane of the surface.
LightHeights weighHeights(ConicPoint p, CapHeights z, HeightNodes nodes, float ha, float hb)
{
    const float za = nodes.low;
    const float zb = nodes.high;
    const float ma = (p.NoV + za) * (p.NoV + za); // squared length along the normal
    const float mb = (p.NoV + zb) * (p.NoV + zb);
    const float da = (ha + ma) * (hb + p.a2 * mb); // D at both directions has the ratio da^2 : db^2
    const float db = (hb + mb) * (ha + p.a2 * ma);
    const float share = db * db / (da * da + db * db);
    const float gap = zb - za;
    return LightHeights(z.low, z.high, za + gap * share, gap * gap * share * (1.0 - share));
}

// Returns N . L over a round light, whose two directions are in the plane of n and its centre. With
// v1 = v_t . c_t / |c_t|, where c is the direction to the centre (of the cap that the region is made
// from), the half vector v + l of a direction with N . L = z has the squared length
// (v1 + sqrt(1 - z^2))^2 + |v_t|^2 - v1^2 in the plane of the surface. The function does not need the
// region. Callers call it first, so that its long chain of operations overlaps the computation of the
// region's root.
LightHeights lightHeights(ConicPoint p, CapHeights z, float v1)
{
    const HeightNodes nodes = heightNodes(z, CONIC_LIGHT_SPREAD);
    const float across = p.vv - v1 * v1;
    const float reachA = v1 + sqrt(max(1.0 - nodes.low * nodes.low, 0.0));
    const float reachB = v1 + sqrt(max(1.0 - nodes.high * nodes.high, 0.0));
    return weighHeights(p, z, nodes, reachA * reachA + across, reachB * reachB + across);
}

// The two nodes of N . L in step 3 of shadeTwoNodes, as steps from the mean in standard deviations, and
// the difference of their weights.
struct BetaNodes {
    float stepLow, stepHigh, weight;
};

// `largest` is L. The half skewness is t / scale here.
BetaNodes betaNodes(LightHeights z, float mean, float v, float deviation, float largest)
{
    const float scale = largest + v + MIN_VARIANCE;
    const float t = (z.low + z.high - 2.0 * mean) * deviation;
    const float root = sqrt(t * t + scale * scale);
    const float inverse = 1.0 / (root * scale); // one division for two reciprocals
    return BetaNodes((t - root) * root * inverse, (t + root) * root * inverse, t * scale * inverse);
}

// Returns (1 - VoH)^5 at the half vectors that lead to both nodes, which are the steps x and y along d.
// `mm` is m . m, and `vm` is v . m, before the steps; dv, ds and dd are the products of d with v, with
// the slope and with itself.
vec2 fresnelAtNodes(vec2 steps, float mm, float vm, float dv, float ds, float dd)
{
    const float mmLow = max(mm + steps.x * (2.0 * ds + steps.x * dd), 1e-6);
    const float mmHigh = max(mm + steps.y * (2.0 * ds + steps.y * dd), 1e-6);
    const float inverse = 1.0 / (mmLow * mmHigh);
    const float VoHLow = saturate((vm + steps.x * dv) * sqrt(mmHigh * inverse));
    const float VoHHigh = saturate((vm + steps.y * dv) * sqrt(mmLow * inverse));
    return vec2(pow5(1.0 - VoHLow), pow5(1.0 - VoHHigh));
}

// Returns the response with two nodes of N . L.
//
// 1. For narrow lobes the slopes determine N . L. The mean of N . L is its value at the mean slope. The
//    variance is the variance of the slopes along the gradient of N . L, limited by the light's range
//    of N . L: the two are combined by 1 / both = 1 / one + 1 / other. The gradient is gz d with
//    d = v_t - tau slope, gz = 2 / (m . m) and tau = gz (v . m). The response weights half vectors by
//    v . m, which shifts the mean.
// 2. For wide lobes the light determines N . L (lightHeights). Means and variances of 1 and 2 are
//    blended by the ratio of the lobe's width to the light's range of N . L.
// 3. N . L is assumed to have the beta distribution with this mean and variance v on the light's range.
//    Let L = (mean - low) (high - mean). The half skewness of the distribution is
//      t = (low + high - 2 mean) sqrt(v) / (L + v),
//    and the two nodes of Gauss quadrature are mean + sqrt(v) (t -+ sqrt(t^2 + 1)), with the weights
//    (1 +- t / sqrt(t^2 + 1)) / 2. They depend on these three moments only, and they lie in the range
//    because the distribution does.
// 4. Shadowing is evaluated at both nodes, and Fresnel at two half vectors that lead to them, which are
//    steps along d.
// 5. The area gives the geometric mean of the two principal variances of the slopes. `elongation` is
//    the ratio of their arithmetic mean to it, minus 1, and so the variance is that of a disc times
//    1 + elongation. A light that holds much of the lobe is cut off by the lobe, which is round. A
//    light longer than the lobe is cut off as well: the squared slope radius of a long thin light tends
//    to alpha^2 q / CONIC_LINE_LIMIT. (The lobe's variance along a line is alpha^2 q.)
vec2 shadeTwoNodes(ConicPoint p, ConicRegion o, LightHeights z, float elongation)
{
    // The variance of the slopes is proportional to 1 / partial, because the variance of the whole lobe
    // is infinite.
    const float height = z.high - z.low;
    const float lobeWidth = p.a2 + CONIC_WIDTH_FROM_SLOPE * o.x2;
    const float q = 1.0 + o.x2 * p.invA2;
    const float m2 = 1.0 + o.x2;
    const float partial = 1.0 - CONIC_TAIL * o.integral;
    const float discRadius2 = p.a2 * min(o.integral * q * q, MAX_SLOPE_VARIANCE);
    const float unlimited = elongation * max(1.0 - 2.0 * o.integral, 0.0);
    const float longer = unlimited / (1.0 + CONIC_LINE_LIMIT * unlimited * o.integral * q);
    const float slopeRadius2 = discRadius2 + longer * discRadius2;
    const float m2p = m2 * partial + CONIC_LENGTHENING * slopeRadius2; // m . m times `partial`
    const float lobeAndLight = lobeWidth + CONIC_WIDTH_FROM_HEIGHT * p.oneMinusA2 * height * height;
    const float invFirst = 1.0 / (lobeAndLight * m2p); // one division for two reciprocals, as below
    const float wide = lobeWidth * m2p * invFirst;
    const float invM2p = lobeAndLight * invFirst;
    const float gz = 2.0 * partial * invM2p;
    const float tau = o.mu * gz;
    const float dv = p.vv - tau * o.av; // d . v, d . slope and d . d
    const float ds = o.av - tau * o.x2;
    const float dd = max(p.vv - tau * (o.av + ds), 1e-8);
    const float lobeHeight = clamp(tau - p.NoV, z.low, z.high);
    const float gdd = gz * dd;
    const float lobeVariance = CONIC_LOBE_VARIANCE * slopeRadius2 * invM2p * gdd;
    // The variance combined with the light's range.
    const float room = CONIC_RANGE_VARIANCE * (lobeHeight - z.low) * (z.high - lobeHeight);
    const float sum = lobeVariance + room + MIN_VARIANCE;
    const float invSecond = 1.0 / (sum * gdd * o.mu);
    const float shift2 = lobeVariance * room * gdd * o.mu * invSecond;
    const float shift = sqrt(shift2);
    const float meanSlope = shift * sum * o.mu * invSecond; // the same deviation as a slope along d
    // Relative change of v . m over one standard deviation.
    const float rel = clamp(meanSlope * dv * sum * gdd * invSecond,
                            -CONIC_MAX_MEAN_SHIFT, CONIC_MAX_MEAN_SHIFT);
    const float fromLobe = clamp(lobeHeight + shift * rel, z.low, z.high);

    const float mean = max(fromLobe + wide * (z.mean - fromLobe), 1e-6);
    const float largest = max(0.0, mean - z.low) * max(0.0, z.high - mean); // L
    const float blended = mix(CONIC_NARROW_VARIANCE * shift2, CONIC_WIDE_VARIANCE * z.variance, wide);
    // The variance of any distribution is at most L. Rounding may take `blended` below 0, because the
    // quotients `wide` and `share` (in lightHeights) may be an ulp above 1. The root of v would then be
    // NaN, which the last min() of this function would turn into a full response.
    const float v = max(min(blended, 0.95 * largest), 0.0);
    const float deviation = sqrt(v);
    const BetaNodes nodes = betaNodes(z, mean, v, deviation, largest);
    const float below = max(mean + deviation * nodes.stepLow, 1e-6);
    const float above = mean + deviation * nodes.stepHigh;
    const float shadowBelow = below * p.smithV + p.NoV * smith(p, below);
    const float shadowAbove = above * p.smithV + p.NoV * smith(p, above);
    const float share = o.integral * o.mu / (shadowBelow * shadowAbove);
    const float low = share * (1.0 + nodes.weight) * below * shadowAbove;
    const float high = share * (1.0 - nodes.weight) * above * shadowBelow;
    const vec2 steps = vec2(meanSlope * (rel + CONIC_FRESNEL_STEP * nodes.stepLow),
                            meanSlope * (rel + CONIC_FRESNEL_STEP * nodes.stepHigh));
    const float mm = m2 + CONIC_FRESNEL_LENGTHENING * slopeRadius2 / partial;
    const vec2 fresnel = fresnelAtNodes(steps, mm, o.mu, dv, ds, dd);
    return min(vec2(low + high, low * fresnel.x + high * fresnel.y), vec2(1.0));
}

#endif
