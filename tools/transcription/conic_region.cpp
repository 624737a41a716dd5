// SPDX-License-Identifier: Apache-2.0
#include "transcription/conic_parts.h"

namespace candelabra::transcription
{

// Transcribed from shaders/lib/lights/sphere_cap.glsl.

SphereCap makeSphereCap(glm::dvec3 n, glm::dvec3 toLight, double radius)
{
    SphereCap cap{};

    const glm::dvec3 t = toLight + 1e-15 * n;
    const double invD = inversesqrt(length2(t) + 1e-32);
    cap.c = t * invD;
    cap.NoC = glm::dot(n, cap.c);
    const double s = glm::min(radius * invD, 1.0);
    cap.s2 = s * s;
    const double specularS2 = glm::min(cap.s2, MAX_SPECULAR_S2);
    cap.s = glm::min(s, 0.99995);
    cap.omc = specularS2 / (1.0 + std::sqrt(1.0 - specularS2));
    return cap;
}

// Transcribed from shaders/lib/specular/conic_region.glsl.

ConicPoint makeConicPoint(ShadingPoint s)
{
    ConicPoint p{};
    p.n = s.n;
    const double NoV = glm::dot(s.n, s.v);
    p.NoV = glm::max(NoV, MIN_CONIC_NOV);
    const glm::dvec3 tangent = s.v - NoV * s.n;
    const glm::dvec3 tilted =
        MIN_CONIC_NOV * s.n + std::sqrt(1.0 - MIN_CONIC_NOV * MIN_CONIC_NOV) *
                                  inversesqrt(glm::max(length2(tangent), 1e-12)) * tangent;
    p.v = NoV < MIN_CONIC_NOV ? tilted : s.v;
    p.mirror = 2.0 * p.NoV * s.n - p.v;
    p.vxn = glm::cross(p.v, s.n);
    p.vv = length2(p.vxn);
    p.alpha = s.alpha;
    p.a2 = s.alpha * s.alpha;
    p.oneMinusA2 = 1.0 - p.a2;
    p.invA2 = 1.0 / p.a2;
    p.smithV = std::sqrt(p.a2 + p.oneMinusA2 * p.NoV * p.NoV);
    return p;
}

double halley(double t, double tr, double m2, double D0)
{
    const double f2 = 3.0 * t + tr;
    const double f = ((t + tr) * t + m2) * t - D0;
    const double f1 = (f2 + tr) * t + m2;
    return glm::max(t - f * f1 / (f1 * f1 - f * f2), 1e-7 * t);
}

ConicRegion wholeCap(ConicPoint p, glm::dvec3 c, double NoC, double s2, double omc)
{
    const glm::dvec3 dl = c - p.mirror;
    const double dz = NoC - p.NoV;
    const double t = glm::dot(p.v, c) - p.NoV * NoC;
    const double ll = 1.0 - NoC * NoC;
    const double w = glm::dot(p.vxn, c);
    const double hh = 0.5 * length2(p.v + c);
    const double k = glm::max(hh - omc, 0.001 * hh);
    const double z0 = 0.5 * length2(dl) - omc;

    const double G = glm::max(length2(p.NoV * dl - dz * p.mirror), 1e-14);
    const double AC = 2.0 * (k - t);
    const double M = k * (k - 2.0 * t) - w * w;
    const double ks = k * s2;
    const double Z = z0 * p.invA2;
    const double D0 = ks * p.invA2;
    const double tr = AC + Z;
    const double m2 = M + AC * Z - G * p.invA2;

    const double u = glm::clamp(M * z0 + ks, 1e-4 * AC * G, AC * G);
    const double inside = glm::max(0.0, -Z);
    const double invU = 1.0 / (u + inside * G);
    const double ka = glm::max(M * G + (AC * G - u) * inside, 0.001 * u * AC) * invU;
    const double c0 = Z >= 0.0 ? D0 * G * invU : G * p.invA2 - Z * ka;
    const double b = 0.5 * (Z + ka);
    const double r = std::sqrt(b * b + c0);
    double lam = b > 0.0 ? c0 / (b + r) : r - b;
    lam = halley(lam, tr, m2, D0);
    lam = halley(lam, tr, m2, D0);

    const double P = glm::max((3.0 * lam + 2.0 * tr) * lam + m2, 1e-20);
    const double kp = k + lam;
    const double kt = kp - t;
    const double adj = glm::max(kt * kt - p.vv * ll, 1e-4 * kp * kp);
    const double invAdj = 1.0 / adj;
    const double a = (kt * NoC + ll * p.NoV) * invAdj;
    const double e = (kt * p.NoV + p.vv * NoC) * invAdj;
    ConicRegion o{};
    o.integral = glm::min(lam * std::sqrt(adj) / P, 1.0);
    o.av = a * p.vv + e * t;
    o.x2 = glm::max(a * (o.av + e * t) + e * e * ll, 0.0);
    o.mu = glm::max(p.NoV + o.av, MIN_CONIC_MU);
    return o;
}

// Transcribed from shaders/lib/specular/conic_shading.glsl.

double smith(ConicPoint p, double NoL)
{
    return std::sqrt(p.a2 + p.oneMinusA2 * NoL * NoL);
}

glm::dvec2 shadeOneNode(ConicPoint p, ConicRegion o, const ConicConstants& k)
{
    const double q = 1.0 + o.x2 * p.invA2;
    const double slopeRadius2 = p.a2 * glm::min(o.integral * q * q, MAX_SLOPE_VARIANCE);
    const double im2 = 1.0 / (1.0 + o.x2 + k.CONIC_ONE_NODE_LENGTHENING * slopeRadius2);
    const double VoH = saturate(o.mu * std::sqrt(im2));
    const double NoL = glm::clamp(2.0 * o.mu * im2 - p.NoV, 1e-6, 1.0);
    const double a =
        glm::min(2.0 * o.integral * o.mu * NoL / (NoL * p.smithV + p.NoV * smith(p, NoL)), 1.0);
    return glm::dvec2(a, a * pow5(1.0 - VoH));
}

CapHeights capHeights(SphereCap cap, double sinC, const ConicConstants& k)
{
    const double cosS = 1.0 - cap.omc;
    CapHeights z{};
    z.high = cap.NoC >= cosS ? 1.0 : cap.NoC * cosS + sinC * cap.s;
    z.low = glm::max(0.0, cap.NoC * cosS - sinC * cap.s);
    const double whole = cap.NoC * (1.0 - 0.5 * cap.omc);

    const double u = saturate(0.5 + 0.5 * cap.NoC / cap.s);
    const double u2 = u * u;
    const double fraction =
        k.CONIC_CUT_MEAN +
        u * (k.CONIC_CUT_MEAN_U + u * (k.CONIC_CUT_MEAN_U5 * u2 * u +
                                       k.CONIC_CUT_MEAN_U2_SIZE * cap.omc - k.CONIC_CUT_MEAN_U2));
    const double cut = z.high * glm::min(fraction, 0.5 + 0.5 * cosS);
    const double u8 = u2 * u2 * u2 * u2;
    z.mean = cut + u8 * (whole - cut);
    return z;
}

HeightNodes heightNodes(CapHeights z, const ConicConstants& k)
{
    const double spread2 = k.CONIC_LIGHT_SPREAD * (z.mean - z.low) * (z.high - z.mean);
    const double spread = glm::min(std::sqrt(glm::max(spread2, 0.0)), 0.98 * z.mean);
    return {z.mean - spread, glm::min(z.mean + spread, 1.0)};
}

LightHeights weighHeights(ConicPoint p, CapHeights z, HeightNodes nodes, double ha, double hb)
{
    const double za = nodes.low;
    const double zb = nodes.high;
    const double ma = (p.NoV + za) * (p.NoV + za);
    const double mb = (p.NoV + zb) * (p.NoV + zb);
    const double da = (ha + ma) * (hb + p.a2 * mb);
    const double db = (hb + mb) * (ha + p.a2 * ma);
    const double share = db * db / (da * da + db * db);
    const double gap = zb - za;
    return {z.low, z.high, za + gap * share, gap * gap * share * (1.0 - share)};
}

LightHeights lightHeights(ConicPoint p, CapHeights z, double v1, const ConicConstants& k)
{
    const HeightNodes nodes = heightNodes(z, k);
    const double across = p.vv - v1 * v1;
    const double reachA = v1 + std::sqrt(glm::max(1.0 - nodes.low * nodes.low, 0.0));
    const double reachB = v1 + std::sqrt(glm::max(1.0 - nodes.high * nodes.high, 0.0));
    return weighHeights(p, z, nodes, reachA * reachA + across, reachB * reachB + across);
}

glm::dvec2 shadeTwoNodes(ConicPoint p, ConicRegion o, LightHeights z, double elongation,
                         const ConicConstants& k)
{
    const double height = z.high - z.low;
    const double lobeWidth = p.a2 + k.CONIC_WIDTH_FROM_SLOPE * o.x2;
    const double q = 1.0 + o.x2 * p.invA2;
    const double m2 = 1.0 + o.x2;
    const double partial = 1.0 - k.CONIC_TAIL * o.integral;
    const double discRadius2 = p.a2 * glm::min(o.integral * q * q, MAX_SLOPE_VARIANCE);
    const double unlimited = elongation * glm::max(1.0 - 2.0 * o.integral, 0.0);
    const double longer = unlimited / (1.0 + gpu::CONIC_LINE_LIMIT * unlimited * o.integral * q);
    const double slopeRadius2 = discRadius2 + longer * discRadius2;
    const double m2p = m2 * partial + k.CONIC_LENGTHENING * slopeRadius2;
    const double lobeAndLight =
        lobeWidth + k.CONIC_WIDTH_FROM_HEIGHT * p.oneMinusA2 * height * height;
    const double invFirst = 1.0 / (lobeAndLight * m2p);
    const double wide = lobeWidth * m2p * invFirst;
    const double invM2p = lobeAndLight * invFirst;
    const double gz = 2.0 * partial * invM2p;
    const double tau = o.mu * gz;
    const double dv = p.vv - tau * o.av;
    const double ds = o.av - tau * o.x2;
    const double dd = glm::max(p.vv - tau * (o.av + ds), 1e-8);
    const double lobeHeight = glm::clamp(tau - p.NoV, z.low, z.high);
    const double gdd = gz * dd;
    const double lobeVariance = k.CONIC_LOBE_VARIANCE * slopeRadius2 * invM2p * gdd;
    const double room = k.CONIC_RANGE_VARIANCE * (lobeHeight - z.low) * (z.high - lobeHeight);
    const double sum = lobeVariance + room + MIN_VARIANCE;
    const double invSecond = 1.0 / (sum * gdd * o.mu);
    const double shift2 = lobeVariance * room * gdd * o.mu * invSecond;
    const double shift = std::sqrt(shift2);
    const double meanSlope = shift * sum * o.mu * invSecond;

    const double rel = glm::clamp(meanSlope * dv * sum * gdd * invSecond, -k.CONIC_MAX_MEAN_SHIFT,
                                  k.CONIC_MAX_MEAN_SHIFT);
    const double fromLobe = glm::clamp(lobeHeight + shift * rel, z.low, z.high);

    const double mean = glm::max(fromLobe + wide * (z.mean - fromLobe), 1e-6);
    const double largest = glm::max(0.0, mean - z.low) * glm::max(0.0, z.high - mean);
    const double blended =
        glm::mix(k.CONIC_NARROW_VARIANCE * shift2, k.CONIC_WIDE_VARIANCE * z.variance, wide);
    const double v = glm::max(glm::min(blended, 0.95 * largest), 0.0);

    const double deviation = std::sqrt(v);
    const double scale = largest + v + MIN_VARIANCE;
    const double t = (z.low + z.high - 2.0 * mean) * deviation;
    const double root = std::sqrt(t * t + scale * scale);
    const double invThird = 1.0 / (root * scale);
    const double stepLow = (t - root) * root * invThird;
    const double stepHigh = (t + root) * root * invThird;
    const double weight = t * scale * invThird;

    const double below = glm::max(mean + deviation * stepLow, 1e-6);
    const double above = mean + deviation * stepHigh;
    const double shadowBelow = below * p.smithV + p.NoV * smith(p, below);
    const double shadowAbove = above * p.smithV + p.NoV * smith(p, above);
    const double share = o.integral * o.mu / (shadowBelow * shadowAbove);
    const double low = share * (1.0 + weight) * below * shadowAbove;
    const double high = share * (1.0 - weight) * above * shadowBelow;

    const double slopeLow = meanSlope * (rel + k.CONIC_FRESNEL_STEP * stepLow);
    const double slopeHigh = meanSlope * (rel + k.CONIC_FRESNEL_STEP * stepHigh);
    const double mm = m2 + k.CONIC_FRESNEL_LENGTHENING * slopeRadius2 / partial;
    const double mmLow = glm::max(mm + slopeLow * (2.0 * ds + slopeLow * dd), 1e-6);
    const double mmHigh = glm::max(mm + slopeHigh * (2.0 * ds + slopeHigh * dd), 1e-6);
    const double invMm = 1.0 / (mmLow * mmHigh);
    const double VoHLow = saturate((o.mu + slopeLow * dv) * std::sqrt(mmHigh * invMm));
    const double VoHHigh = saturate((o.mu + slopeHigh * dv) * std::sqrt(mmLow * invMm));
    return glm::min(glm::dvec2(low + high, low * pow5(1.0 - VoHLow) + high * pow5(1.0 - VoHHigh)),
                    glm::dvec2(1.0));
}

} // namespace candelabra::transcription
