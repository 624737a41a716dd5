// SPDX-License-Identifier: Apache-2.0
#include "transcription/conic_parts.h"

namespace candelabra::transcription
{

// Transcribed from shaders/lib/specular/conic_clip.glsl. Two steps are left out that change nothing
// but the rounding of floats: makeConeAxes() there multiplies e1 by the matrix q + lam I, and
// capArc() computes the lengths of an arc's ends from w . e if the cone is narrow.
glm::dvec2 atanTail(glm::dvec2 t2)
{
    glm::dvec2 k = -double(gpu::CONIC_ATAN_T15) * t2 + double(gpu::CONIC_ATAN_T13);
    k = k * t2 - double(gpu::CONIC_ATAN_T11);
    k = k * t2 + double(gpu::CONIC_ATAN_T9);
    k = k * t2 - double(gpu::CONIC_ATAN_T7);
    k = k * t2 + double(gpu::CONIC_ATAN_T5);
    return k * t2 - double(gpu::CONIC_ATAN_T3);
}

glm::dvec2 atan2Pair(glm::dvec2 y, glm::dvec2 x)
{
    const glm::dvec2 ax = glm::abs(x);
    const glm::dvec2 ay = glm::abs(y);
    const glm::dvec2 larger = glm::max(glm::max(ax, ay), 1e-18);
    const glm::dvec2 t =
        glm::min(ax, ay) * glm::dvec2(larger.y, larger.x) * (1.0 / (larger.x * larger.y));
    const glm::dvec2 t2 = t * t;
    const glm::dvec2 first = t + t * t2 * atanTail(t2);
    const glm::dvec2 quarter = glm::mix(first, HALF_PI - first, glm::greaterThan(ay, ax));
    const glm::dvec2 upper = glm::mix(quarter, PI - quarter, glm::lessThan(x, glm::dvec2(0.0)));
    return glm::mix(upper, -upper, glm::lessThan(y, glm::dvec2(0.0)));
}

double atanhRatio(double y, double x)
{
    return 0.5 * std::log(glm::max(x + y, 1e-30) / glm::max(x - y, 1e-30));
}

double conicRoot(double tr, double m2, double D0)
{
    const double boundA =
        2.0 * D0 / glm::max(m2 + std::sqrt(glm::max(m2 * m2 + 4.0 * tr * D0, 0.0)), 1e-30);
    const double qd = std::sqrt(glm::max(tr * tr - 4.0 * m2, 0.0));
    const double tq = tr > 0.0 ? -2.0 * m2 / (tr + qd) : 0.5 * (qd - tr);
    const double mb = m2 - D0 / glm::max(tq, 1e-30);
    const double qb = std::sqrt(glm::max(tr * tr - 4.0 * mb, 0.0));
    const double boundB = tr > 0.0 ? -2.0 * mb / (tr + qb) : 0.5 * (qb - tr);
    const double negative = tr > 0.0 ? glm::min(boundA, boundB) : boundB;
    double lam = glm::max(m2 < 0.0 ? negative : boundA, 1e-12);
    lam = halley(lam, tr, m2, D0);
    return halley(lam, tr, m2, D0);
}

CapFrame makeCapFrame(ConicPoint p, glm::dvec3 c, double NoC)
{
    CapFrame f{};
    f.sinC = std::sqrt(glm::max(1.0 - NoC * NoC, 1e-12));
    const double inv = 1.0 / f.sinC;
    f.v1 = (glm::dot(p.v, c) - p.NoV * NoC) * inv;
    f.v2 = glm::dot(p.vxn, c) * inv;
    return f;
}

Chord makeChord(SphereCap cap, double sinC)
{
    Chord o;
    const double inv = 1.0 / sinC;
    const double sp2 = glm::max(0.0, (cap.s * cap.s - cap.NoC * cap.NoC) * inv * inv);
    o.cp = glm::min((1.0 - cap.omc) * inv, 1.0);
    o.sp = std::sqrt(sp2);
    o.cm = sp2 / (1.0 + o.cp);
    return o;
}

glm::dvec3 horizonArc(ConicPoint p, CapFrame f, Chord chord)
{
    const double hz = p.alpha * p.NoV;
    const double hz2 = hz * hz;
    const double NoV2 = p.NoV * p.NoV;
    const double A0 = 1.0 + p.vv + hz2;
    const double rh = p.NoV * std::sqrt(NoV2 + (2.0 * (1.0 + p.vv) + hz2) * p.a2);
    const double E0 = (1.0 + f.v1) * (1.0 + f.v1) + f.v2 * f.v2 + hz2;
    const glm::dvec2 angles =
        atan2Pair(chord.sp * glm::dvec2(rh, 1.0), glm::dvec2(E0 - A0 * chord.cm, chord.cp));
    const double J0 = 2.0 / rh * angles.x;
    const double pc = angles.y;
    const double pp = pc - 0.5 * A0 * J0;
    const double qq = -atanhRatio(2.0 * f.v2 * chord.sp, E0 - 2.0 * f.v1 * chord.cm);
    const double scale = -hz / glm::max(p.vv, 1e-4);
    const glm::dvec2 across = p.vv > 1e-4
                                  ? glm::dvec2(pp * f.v1 - qq * f.v2, pp * f.v2 + qq * f.v1) * scale
                                  : glm::dvec2(-2.0 * hz * chord.sp / A0, 0.0);
    return glm::dvec3(across, pc + 0.5 * NoV2 * p.oneMinusA2 * J0);
}

CapCone makeCapCone(ConicPoint p, SphereCap cap, CapFrame f)
{
    const double cx = f.sinC;
    const double cz = cap.NoC;
    const double vz = p.NoV;
    const double v1 = f.v1;
    const double v2 = f.v2;
    const double s2 = cap.s * cap.s;
    const glm::dvec3 dl = cap.c - p.mirror;
    const double z0 = 0.5 * length2(dl) - cap.omc;
    const double G = glm::max(length2(vz * dl - (cz - vz) * p.mirror), 1e-14);
    const double t = v1 * cx;
    const double w2 = v2 * v2 * cx * cx;
    const double hh = 0.5 * ((v1 + cx) * (v1 + cx) + v2 * v2 + (vz + cz) * (vz + cz));
    const double signedK = hh - cap.omc;
    CapCone q{};
    q.sg = signedK < 0.0 ? -1.0 : 1.0;
    const double ak = glm::max(std::abs(signedK), 1e-4 * hh);
    const double k = q.sg * ak;
    const double AC = 2.0 * (k - t);
    const double Z = z0 * p.invA2;
    q.D0 = ak * s2 * p.invA2;
    q.tr = q.sg * (AC + Z);
    const double m2 = k * (k - 2.0 * t) - w2 + AC * Z - G * p.invA2;
    q.lam = conicRoot(q.tr, m2, q.D0);
    const double invAlpha = 1.0 / p.alpha;
    q.xx = q.sg * (k - 2.0 * t);
    q.xy = -q.sg * v2 * cx;
    q.xz = -q.sg * (v1 * cz + vz * cx) * invAlpha;
    q.yy = ak;
    q.yz = -q.sg * v2 * cz * invAlpha;
    q.zz = q.sg * Z;
    return q;
}

ConeAxes makeConeAxes(CapCone q, glm::dvec3 inside)
{
    const double X = q.xx + q.lam;
    const double Y = q.yy + q.lam;
    const double W = q.zz + q.lam;
    const double adjXY = q.yz * q.xz - q.xy * W;
    const double adjXZ = q.xy * q.yz - q.xz * Y;
    const double adjYZ = q.xy * q.xz - q.yz * X;
    const glm::dvec3 E =
        glm::dvec3((Y * W - q.yz * q.yz) * inside.x + adjXY * inside.y + adjXZ * inside.z,
                   adjXY * inside.x + (X * W - q.xz * q.xz) * inside.y + adjYZ * inside.z,
                   adjXZ * inside.x + adjYZ * inside.y + (X * Y - q.xy * q.xy) * inside.z);
    const double se = E.z < 0.0 ? -1.0 : 1.0;
    const double reach = std::sqrt(glm::max(length2(E), 1e-36));
    const double stretch = se * reach + E.z;
    const double invE = 1.0 / (reach * stretch);
    ConeAxes o{};
    o.e = E * (stretch * invE);
    const double fb = -E.x * E.y * invE;
    const glm::dvec3 f1 = glm::dvec3(1.0 - se * E.x * E.x * invE, se * fb, -se * o.e.x);
    const glm::dvec3 f2 = glm::dvec3(fb, se - E.y * E.y * invE, -o.e.y);
    const glm::dvec3 qf1 =
        glm::dvec3(q.xx * f1.x + q.xy * f1.y + q.xz * f1.z, q.xy * f1.x + q.yy * f1.y + q.yz * f1.z,
                   q.xz * f1.x + q.yz * f1.y + q.zz * f1.z);
    const double S = 0.5 * (q.tr + q.lam);
    const double de = glm::dot(f1, qf1) - S;
    const double be = glm::dot(f2, qf1);
    const double ade = std::abs(de) + 1e-15;
    const double r = std::sqrt(ade * ade + be * be);
    const double l1 = S + r;
    const double invLD = 1.0 / (l1 * q.D0);
    o.A2 = q.lam * q.D0 * invLD;
    o.B2 = glm::max(q.lam * q.lam * l1 * l1 * invLD, o.A2);
    const double turn = inversesqrt(2.0 * r * (r + ade));
    const double ph = (r + ade) * turn;
    const double qh = be * turn;
    const double cosT = de >= 0.0 ? ph : std::abs(qh);
    const double sinT = de >= 0.0 ? qh : (be < 0.0 ? -ph : ph);
    o.e1 = cosT * f1 + sinT * f2;
    o.e2 = cosT * f2 - sinT * f1;
    return o;
}

glm::dvec3 capArc(ConeAxes axes, double sg, glm::dvec3 wc, double sp, bool above)
{
    const double a = std::sqrt(axes.A2);
    const double b = std::sqrt(axes.B2);
    const double w1 = glm::dot(wc, axes.e1);
    const double w2e = glm::dot(wc, axes.e2);
    const glm::dvec2 plus = glm::dvec2((w1 + sp * axes.e1.y) * b, (w2e + sp * axes.e2.y) * a);
    const glm::dvec2 minus = glm::dvec2((w1 - sp * axes.e1.y) * b, (w2e - sp * axes.e2.y) * a);
    const double lp = std::sqrt(glm::max(glm::dot(plus, plus), 1e-36));
    const double lm = std::sqrt(glm::max(glm::dot(minus, minus), 1e-36));
    const double oa = 1.0 + axes.A2;
    const double ob = 1.0 + axes.B2;
    const double oab = oa * ob;
    const double soab = std::sqrt(oab);
    const double df = glm::max(axes.B2 - axes.A2, 1e-6 * ob);
    const double inv = 1.0 / (oab * df);
    const double invSoab = soab * df * inv;
    const double g2 = df * df * ob * inv;
    const double g = std::sqrt(g2);
    const double h = g * oa * invSoab;
    const double co = oa * plus.x * minus.x + ob * plus.y * minus.y;
    const double si = sg * soab * (plus.x * minus.y - minus.x * plus.y);
    const double lpm = lp * lm;
    const glm::dvec2 angles = atan2Pair(glm::dvec2(si, g * (minus.y * lp - plus.y * lm)),
                                        glm::dvec2(co, lpm + g2 * plus.y * minus.y));
    const double angle = angles.x;
    const bool full = co > 7.0 * std::abs(si) ? above : angle < 0.0;
    const double dt = full ? angle + 2.0 * PI : angle;
    return axes.e1 * (-b * g * oab * inv * angles.y) +
           axes.e2 *
               (a * h * oab * inv *
                atanhRatio(h * (minus.x * lp - plus.x * lm), lpm - h * h * plus.x * minus.x)) +
           axes.e * (sg * a * b * dt * invSoab);
}

ConicRegion clippedCap(ConicPoint p, SphereCap cap, CapFrame f)
{
    const Chord chord = makeChord(cap, f.sinC);
    const glm::dvec3 horizon = horizonArc(p, f, chord);
    const CapCone cone = makeCapCone(p, cap, f);
    const glm::dvec3 wc = glm::dvec3(1.0 + f.v1 - chord.cm, f.v2, p.alpha * p.NoV);
    const glm::dvec3 arc = capArc(makeConeAxes(cone, wc), cone.sg, wc, chord.sp, cap.NoC > 0.0);
    const double phiZ = (arc.z + horizon.z) * (0.5 * INV_PI);
    const glm::dvec2 slope =
        (glm::dvec2(arc) + glm::dvec2(horizon)) * (0.5 * INV_PI * p.alpha / glm::max(phiZ, 1e-12));
    ConicRegion o{};
    o.integral = saturate(phiZ);
    o.av = f.v1 * slope.x + f.v2 * slope.y;
    o.x2 = glm::dot(slope, slope);
    o.mu = glm::max(p.NoV + o.av, MIN_CONIC_MU);
    return o;
}

SubstituteCap substituteCap(ConicPoint p, SphereCap cap, const ConicConstants& k)
{
    const double sinC = std::sqrt(glm::max(1.0 - cap.NoC * cap.NoC, 0.0));
    const double mean = capHeights(cap, sinC, k).mean;
    SubstituteCap o{};
    o.c = cap.c + p.n * (mean - cap.NoC);
    o.c *= inversesqrt(glm::max(length2(o.c), MIN_LENGTH2));
    o.NoC = glm::dot(p.n, o.c);

    const double u = saturate(0.5 + 0.5 * cap.NoC / cap.s);
    o.omc = cap.omc * u * std::sqrt(u) *
            (gpu::CONIC_SEGMENT - u * (gpu::CONIC_SEGMENT_U + double(gpu::CONIC_SEGMENT_U2) * u));
    o.s2 = o.omc * (2.0 - o.omc);
    return o;
}

// Transcribed from shaders/lib/specular/conic.glsl.

unsigned conicClass(double heightAbove, double radius, double d2, double a2)
{
    const double r2 = glm::min(radius * radius, MAX_SPECULAR_S2 * d2);
    const double signed2 = heightAbove * std::abs(heightAbove);
    if (signed2 <= -r2)
        return gpu::CONIC_BELOW;
    if (signed2 >= 4.0 * r2)
        return gpu::CONIC_ABOVE;
    return signed2 >= r2 || r2 <= SMALL_CAP * a2 * d2 ? gpu::CONIC_NEAR : gpu::CONIC_CLIPPED;
}

glm::dvec2 conicAbove(ConicPoint p, SphereCap cap, const ConicConstants& k)
{
    return shadeOneNode(p, wholeCap(p, cap.c, cap.NoC, cap.s * cap.s, cap.omc), k);
}

double nearness(SphereCap cap)
{
    return saturate(2.0 - cap.NoC / cap.s);
}

glm::dvec2 conicUnclipped(ConicPoint p, SphereCap cap, bool mixed, const ConicConstants& k)
{
    SubstituteCap sub{cap.c, cap.NoC, cap.s * cap.s, cap.omc};
    const SubstituteCap cut = substituteCap(p, cap, k);
    if (cap.NoC < cap.s)
        sub = cut;
    const double sinC = std::sqrt(glm::max(1.0 - cap.NoC * cap.NoC, 0.0));
    const LightHeights z =
        lightHeights(p, capHeights(cap, sinC, k), makeCapFrame(p, sub.c, sub.NoC).v1, k);
    const ConicRegion o = wholeCap(p, sub.c, sub.NoC, sub.s2, sub.omc);
    const glm::dvec2 two = shadeTwoNodes(p, o, z, 0.0, k);
    return mixed ? glm::mix(shadeOneNode(p, o, k), two, nearness(cap)) : two;
}

glm::dvec2 conicNear(ConicPoint p, SphereCap cap, const ConicConstants& k)
{
    return conicUnclipped(p, cap, true, k);
}

glm::dvec2 conicFullUnclipped(ConicPoint p, SphereCap cap, const ConicConstants& k)
{
    return conicUnclipped(p, cap, false, k);
}

glm::dvec2 conicClipped(ConicPoint p, SphereCap cap, const ConicConstants& k)
{
    const CapFrame f = makeCapFrame(p, cap.c, cap.NoC);
    const LightHeights z = lightHeights(p, capHeights(cap, f.sinC, k), f.v1, k);
    return shadeTwoNodes(p, clippedCap(p, cap, f), z, 0.0, k);
}

unsigned conicClassOf(ConicPoint p, SphereCap cap)
{
    return conicClass(cap.NoC, cap.s, 1.0, p.a2);
}

glm::dvec2 conicResponse(ConicPoint p, SphereCap cap, const ConicConstants& k)
{
    switch (conicClassOf(p, cap)) {
    case gpu::CONIC_ABOVE:
        return conicAbove(p, cap, k);
    case gpu::CONIC_NEAR:
        return conicNear(p, cap, k);
    case gpu::CONIC_CLIPPED:
        return conicClipped(p, cap, k);
    }
    return glm::dvec2(0.0);
}

glm::dvec2 conicFullResponse(ConicPoint p, SphereCap cap, const ConicConstants& k)
{
    switch (conicClassOf(p, cap)) {
    case gpu::CONIC_ABOVE:
    case gpu::CONIC_NEAR:
        return conicFullUnclipped(p, cap, k);
    case gpu::CONIC_CLIPPED:
        return conicClipped(p, cap, k);
    }
    return glm::dvec2(0.0);
}

} // namespace candelabra::transcription
