// SPDX-License-Identifier: Apache-2.0
// Shadowing and Fresnel over a conic region: taken at its mean half vector, or at two nodes of
// N . L. Everything before this was exact; this is not. Constants without a derivation are fitted to
// quadrature on 1500 random surfaces and light sizes, 85 light directions each.
#ifndef CND_LIB_SPECULAR_CONIC_SHADING
#define CND_LIB_SPECULAR_CONIC_SHADING

#include "lib/specular/conic_region.glsl"

// Upper bound of the slope variance, in units of alpha^2: reached far outside the lobe only.
const float MAX_SLOPE_VARIANCE = 1e6;

// Keeps quotients of variances finite where the light is a point.
const float MIN_VARIANCE = 1e-12;

// sqrt(a2 + (1 - a2) NoL^2). With it 2 (v . m) NoL / (NoL smithV + NoV smith(NoL)) is what the half
// vectors' D (n . h) has to be multiplied by to give D G2 / (4 NoL NoV) NoL (G2: Heitz 2014, eq. 99).
float smith(ConicPoint p, float NoL)
{
    return sqrt(p.a2 + p.oneMinusA2 * NoL * NoL);
}

// One node, at the mean half vector. 0.75 of the slope variance shortens it (none leaves 4x the error).
vec2 shadeOneNode(ConicPoint p, ConicRegion o)
{
    const float q = 1.0 + o.x2 * p.invA2;
    const float variance = p.a2 * min(o.integral * q * q, MAX_SLOPE_VARIANCE);
    const float im2 = 1.0 / (1.0 + o.x2 + 0.75 * variance);
    const float VoH = saturate(o.mu * sqrt(im2));
    const float NoL = clamp(2.0 * o.mu * im2 - p.NoV, 1e-6, 1.0);
    const float a = min(2.0 * o.integral * o.mu * NoL / (NoL * p.smithV + p.NoV * smith(p, NoL)), 1.0);
    return vec2(a, a * pow5(1.0 - VoH));
}

// N . l over the part of a cap above the horizon: its range, and its mean with every direction
// weighted alike.
struct CapHeights {
    float low, high, mean;
};

CapHeights capHeights(SphereCap cap, float sinC)
{
    const float cosS = 1.0 - cap.omc;
    CapHeights z;
    z.high = cap.NoC >= cosS ? 1.0 : cap.NoC * cosS + sinC * cap.s;
    z.low = max(0.0, cap.NoC * cosS - sinC * cap.s);
    const float whole = cap.NoC * (1.0 - 0.5 * cap.omc); // exact while nothing is below the horizon
    // Below: mean / high is close to 0.4..0.5 for every cap; the polynomial is fitted, u = 1 where the
    // cap leaves the horizon.
    const float u = saturate(0.5 + 0.5 * cap.NoC / cap.s);
    const float u2 = u * u;
    const float fraction = 0.3653 + u * (0.2182 + u * (0.1443 * u2 * u + 0.1923 * cap.omc - 0.1941));
    const float cut = z.high * min(fraction, 0.5 + 0.5 * cosS);
    const float u8 = u2 * u2 * u2 * u2;
    z.mean = cut + u8 * (whole - cut);
    return z;
}

// N . l over the light weighted with D, as wide lobes see it: two heights about the mean, weighted.
// Needs no region: callers ask for it first, so that its long chain of operations overlaps the root's.
struct LightHeights {
    float low, high;
    float mean, variance;
};

// v1: v_t . c_t / |c_t| of the cap the region is made from.
LightHeights lightHeights(ConicPoint p, SphereCap cap, float sinC, float v1)
{
    const CapHeights z = capHeights(cap, sinC);
    const float spread2 = 0.2212 * (z.mean - z.low) * (z.high - z.mean);
    const float spread = min(sqrt(max(spread2, 0.0)), 0.98 * z.mean);
    const float za = z.mean - spread;
    const float zb = min(z.mean + spread, 1.0);
    const float across = p.vv - v1 * v1;
    const float reachA = v1 + sqrt(max(1.0 - za * za, 0.0));
    const float reachB = v1 + sqrt(max(1.0 - zb * zb, 0.0));
    const float ha = reachA * reachA + across; // |h_t|^2 and (n . h)^2 of both
    const float hb = reachB * reachB + across;
    const float ma = (p.NoV + za) * (p.NoV + za);
    const float mb = (p.NoV + zb) * (p.NoV + zb);
    const float da = (ha + ma) * (hb + p.a2 * mb); // D is proportional to 1 / da^2
    const float db = (hb + mb) * (ha + p.a2 * ma);
    const float share = db * db / (da * da + db * db);
    const float gap = zb - za;
    return LightHeights(z.low, z.high, za + gap * share, gap * gap * share * (1.0 - share));
}

// Two nodes. N . L has two estimates, of mean and variance: from the half vector's (narrow lobes) and
// from the light's heights (wide ones), blended by lobe width against the height of the light. The
// nodes are those of Gauss quadrature for the beta distribution of that mean and variance over the
// light's range of heights: unequal, skewed away from the nearer end. Fresnel takes the same nodes as
// steps of the half vector along the slope direction of steepest N . L.
vec2 shadeTwoNodes(ConicPoint p, ConicRegion o, LightHeights z)
{
    // N . L = 2 (v . m) / (m . m) - NoV at the mean half vector, its gradient in slopes gz d with
    // d = v_t - tau * slope, and the slope variance: I q^2 a2 for a small region (its area), growing
    // without bound as the region takes in the whole lobe.
    const float height = z.high - z.low;
    const float lobeWidth = p.a2 + 3.684 * o.x2;
    const float q = 1.0 + o.x2 * p.invA2;
    const float m2 = 1.0 + o.x2;
    const float partial = 1.0 - 0.8444 * o.integral;
    const float spread = p.a2 * min(o.integral * q * q, MAX_SLOPE_VARIANCE); // variance * partial
    const float m2p = m2 * partial + 0.4669 * spread;
    const float lobeAndLight = lobeWidth + 0.9612 * p.oneMinusA2 * height * height;
    const float invFirst = 1.0 / (lobeAndLight * m2p); // one division for two; so below
    const float wide = lobeWidth * m2p * invFirst;
    const float invM2p = lobeAndLight * invFirst;
    const float gz = 2.0 * partial * invM2p; // 2 / (m2 + 0.4669 variance)
    const float tau = o.mu * gz;
    const float dv = p.vv - tau * o.av;
    const float ds = o.av - tau * o.x2;
    const float dd = max(p.vv - tau * (o.av + ds), 1e-8);
    const float lobeHeight = clamp(tau - p.NoV, z.low, z.high);
    const float gdd = gz * dd;
    const float lobeVariance = 0.8506 * spread * invM2p * gdd;
    const float room = 0.2621 * (lobeHeight - z.low) * (z.high - lobeHeight); // variance that fits
    const float sum = lobeVariance + room + MIN_VARIANCE;
    const float invSecond = 1.0 / (sum * gdd * o.mu);
    const float shift2 = lobeVariance * room * gdd * o.mu * invSecond;
    const float shift = sqrt(shift2);
    const float meanSlope = shift * sum * o.mu * invSecond; // the same deviation in slopes, along d
    // To the mean weighted with v . m.
    const float rel = clamp(meanSlope * dv * sum * gdd * invSecond, -0.4089, 0.4089);
    const float fromLobe = clamp(lobeHeight + shift * rel, z.low, z.high);

    const float mean = max(fromLobe + wide * (z.mean - fromLobe), 1e-6);
    const float largest = max(0.0, mean - z.low) * max(0.0, z.high - mean); // of the two ends
    const float blended = mix(1.778 * shift2, 1.128 * z.variance, wide);
    const float v = min(blended, 0.95 * largest);
    // Gauss nodes, in deviations sqrt(v) from the mean: t -+ sqrt(t^2 + 1), t the half skewness.
    const float deviation = sqrt(v);
    const float scale = largest + v + MIN_VARIANCE;
    const float t = (z.low + z.high - 2.0 * mean) * deviation;
    const float root = sqrt(t * t + scale * scale);
    const float invThird = 1.0 / (root * scale);
    const float stepLow = (t - root) * root * invThird;
    const float stepHigh = (t + root) * root * invThird;
    const float weight = t * scale * invThird;

    const float below = max(mean + deviation * stepLow, 1e-6);
    const float above = mean + deviation * stepHigh;
    const float shadowBelow = below * p.smithV + p.NoV * smith(p, below);
    const float shadowAbove = above * p.smithV + p.NoV * smith(p, above);
    const float share = o.integral * o.mu / (shadowBelow * shadowAbove);
    const float low = share * (1.0 + weight) * below * shadowAbove;
    const float high = share * (1.0 - weight) * above * shadowBelow;

    const float slopeLow = meanSlope * (rel + 0.7392 * stepLow);
    const float slopeHigh = meanSlope * (rel + 0.7392 * stepHigh);
    const float mm = m2 + 0.8924 * spread / partial;
    const float mmLow = max(mm + slopeLow * (2.0 * ds + slopeLow * dd), 1e-6);
    const float mmHigh = max(mm + slopeHigh * (2.0 * ds + slopeHigh * dd), 1e-6);
    const float invMm = 1.0 / (mmLow * mmHigh);
    const float VoHLow = saturate((o.mu + slopeLow * dv) * sqrt(mmHigh * invMm));
    const float VoHHigh = saturate((o.mu + slopeHigh * dv) * sqrt(mmLow * invMm));
    return min(vec2(low + high, low * pow5(1.0 - VoHLow) + high * pow5(1.0 - VoHHigh)), vec2(1.0));
}

#endif
