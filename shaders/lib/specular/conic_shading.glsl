// SPDX-License-Identifier: Apache-2.0
// Shadowing and Fresnel over a conic region: taken at its mean half vector, or at two nodes that have
// the mean and variance of N . L over it. Everything before this was exact; this is not.
#ifndef CND_LIB_SPECULAR_CONIC_SHADING
#define CND_LIB_SPECULAR_CONIC_SHADING

#include "lib/specular/conic_region.glsl"

// Upper bound of the slope variance, in units of alpha^2: reached far outside the lobe only.
const float MAX_SLOPE_VARIANCE = 1e6;

// integral 2 (v . m) NoL / (NoL smithV + NoV smithL) is D G2 / (4 NoL NoV) NoL over the region with
// G2 (Heitz 2014, eq. 99) at NoL; half of it, for one of two nodes.
float shadowedHalf(ConicPoint p, ConicRegion o, float NoL)
{
    const float smithL = sqrt(p.a2 + p.oneMinusA2 * NoL * NoL);
    return o.integral * o.mu * NoL / (NoL * p.smithV + p.NoV * smithL);
}

// One node, at the mean half vector. 0.75 of the slope variance shortens it (fitted: none leaves 4x
// the error).
vec2 shadeOneNode(ConicPoint p, ConicRegion o)
{
    const float q = 1.0 + o.x2 * p.invA2;
    const float variance = p.a2 * min(o.integral * q * q, MAX_SLOPE_VARIANCE);
    const float im2 = 1.0 / (1.0 + o.x2 + 0.75 * variance);
    const float VoH = saturate(o.mu * sqrt(im2));
    const float NoL = clamp(2.0 * o.mu * im2 - p.NoV, 1e-6, 1.0);
    const float a = min(2.0 * shadowedHalf(p, o, NoL), 1.0);
    return vec2(a, a * pow5(1.0 - VoH));
}

// Range and mean of N . l over the part of a cap above the horizon, each direction weighted alike.
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
    const float cut = z.high *
        min(0.4 + u * (0.036 + u * (0.02 + 0.044 * u2 * u + 0.24 * cap.omc)), 0.5 + 0.5 * cosS);
    const float u8 = u2 * u2 * u2 * u2;
    z.mean = cut + u8 * (whole - cut);
    return z;
}

// Two nodes. cap: the light as it is; sinC = |n x cap.c|; v1: v_t . c_t / |c_t| of the cap the region
// was made from. N . L has two estimates: from the half vector's mean and variance (narrow lobes) and
// from the light's heights weighted by D (wide ones); they are blended by lobe width against the
// height of the light. Constants fitted to quadrature.
vec2 shadeTwoNodes(ConicPoint p, ConicRegion o, SphereCap cap, float sinC, float v1)
{
    const CapHeights z = capHeights(cap, sinC);
    // From the half vector: N . L = 2 (v . m) / (m . m) - NoV at the mean, its gradient in slopes
    // d = v_t - tau * slope, and the slope variance along it.
    const float q = 1.0 + o.x2 * p.invA2;
    const float variance = p.a2 * min(o.integral * q * q, MAX_SLOPE_VARIANCE);
    const float gz = 2.0 / (1.0 + o.x2 + 0.865 * variance);
    const float tau = o.mu * gz;
    const float dv = p.vv - tau * o.av;
    const float ds = o.av - tau * o.x2;
    const float dd = max(p.vv - tau * (o.av + ds), 1e-8);
    const float lobeHeight = clamp(tau - p.NoV, z.low, z.high);
    const float lobeVariance = 1.038 * variance * gz * gz * dd;
    const float room = 0.242 * (lobeHeight - z.low) * (z.high - lobeHeight); // variance that fits
    const float shift = sqrt(lobeVariance * room / (lobeVariance + room + 1e-20));
    const float stepSlope = shift / (gz * dd); // the same deviation in slopes, along d
    const float rel = clamp(stepSlope * dv / o.mu, -0.9, 0.9); // to the (v . m)-weighted mean
    const float fromLobe = clamp(lobeHeight + shift * rel, z.low, z.high);
    // From the light: two heights a and b on the line through its mean, weighted with D.
    const float spread =
        min(sqrt(max(0.174 * (z.mean - z.low) * (z.high - z.mean), 0.0)), 0.98 * z.mean);
    const float za = z.mean - spread;
    const float zb = min(z.mean + spread, 1.0);
    const float across = p.vv - v1 * v1;
    const float reachA = v1 + sqrt(max(1.0 - za * za, 0.0));
    const float reachB = v1 + sqrt(max(1.0 - zb * zb, 0.0));
    const float ha = reachA * reachA + across; // |h_t|^2 and (n . h)^2 of both
    const float hb = reachB * reachB + across;
    const float ma = (p.NoV + za) * (p.NoV + za);
    const float mb = (p.NoV + zb) * (p.NoV + zb);
    const float da = (ha + ma) * (hb + p.a2 * mb);
    const float db = (hb + mb) * (ha + p.a2 * ma);
    const float share = db * db / (da * da + db * db);
    const float fromLight = za + (zb - za) * share;
    const float lightVariance = (zb - za) * (zb - za) * share * (1.0 - share);
    const float lobeWidth = p.a2 + 2.93 * o.x2;
    const float height = z.high - z.low;
    const float wide = lobeWidth / (lobeWidth + 0.539 * p.oneMinusA2 * height * height);
    // Both.
    const float mean = max(fromLobe + wide * (fromLight - fromLobe), 1e-6);
    const float room1 = 0.242 * max(0.0, mean - z.low) * max(0.0, z.high - mean);
    const float fromLobe2 = 1.79 * lobeVariance * room1 / (lobeVariance + room1 + 1e-20);
    const float deviation =
        min(sqrt(fromLobe2 + wide * (1.295 * lightVariance - fromLobe2)), 0.98 * mean);
    const float low = shadowedHalf(p, o, mean - deviation);
    const float high = shadowedHalf(p, o, min(mean + deviation, 1.0));
    const float stepLow = stepSlope * (rel - 1.0);
    const float stepHigh = stepSlope * (rel + 1.0);
    const float m2 = 1.0 + o.x2 + 0.64 * variance;
    const float m2Low = max(m2 + stepLow * (2.0 * ds + stepLow * dd), 1e-20);
    const float m2High = max(m2 + stepHigh * (2.0 * ds + stepHigh * dd), 1e-20);
    const float VoHLow = saturate((o.mu + stepLow * dv) / sqrt(m2Low));
    const float VoHHigh = saturate((o.mu + stepHigh * dv) / sqrt(m2High));
    return min(vec2(low + high, low * pow5(1.0 - VoHLow) + high * pow5(1.0 - VoHHigh)), vec2(1.0));
}

#endif
