// SPDX-License-Identifier: Apache-2.0
// Linearly transformed cosines (Heitz, Dupuy, Hill and Neubelt 2016, "Real-time polygonal-light shading
// with linearly transformed cosines"), with our own fit of the lobe, to compare with the engine's
// closed forms. Its maps keep the horizon in place. So lights are cut at the true horizon, no light
// leaks from below it, and the response to a light that fills the hemisphere is the lobe's directional
// albedo.
#ifndef CND_BENCH_LTC_LOBES
#define CND_BENCH_LTC_LOBES

#include "shared/bench.h"
#include "shared/ltc.h"
#include "bench/ltc/contour.glsl"
#include "bench/ltc/elliptic_cone.glsl"
#include "bench/ltc/table.glsl"
#include "lib/brdf.glsl"
#include "lib/lights/rectangle_facing.glsl"

// The lobe with F = 1, given by a linear map with the rows rowX, rowY and n: w = (rowX.l, rowY.l, n.l).
struct LtcLobe {
    vec3 rowX, rowY;
    float albedo;       // directional albedo
    float xx, yy, xz;   // products of the rows that are not 0 or 1
    float determinant2; // squared determinant of the map
};

// The values that do not depend on the light.
struct LtcPoint {
    vec3 n;
    LtcLobe lobe;
    float dielectricAlbedo; // directional albedo with F0 = LTC_DIELECTRIC_F0
};

vec4 ltcEntry(uvec2 low, vec2 f, uint texel)
{
    const uint index = LTC_TEXELS * (low.y * LTC_TABLE_SIZE + low.x) + texel;
    const uint row = LTC_TEXELS * LTC_TABLE_SIZE;
    return mix(mix(ltcTexel(index), ltcTexel(index + LTC_TEXELS), f.x),
               mix(ltcTexel(index + row), ltcTexel(index + row + LTC_TEXELS), f.x), f.y);
}

LtcLobe makeLtcLobe(vec4 shape, vec3 n, vec3 tangent, float NoV, float invAlpha)
{
    const float sine = sqrt(1.0 - NoV * NoV);
    const float sharpnessX = shape.x * invAlpha;
    const float sharpnessY = shape.y * invAlpha;
    LtcLobe q;
    q.rowX = sharpnessX * (NoV * tangent + sine * n) + shape.z * (NoV * n - sine * tangent);
    q.rowY = sharpnessY * cross(n, tangent);
    q.albedo = shape.w;
    q.xx = sharpnessX * sharpnessX + shape.z * shape.z;
    q.yy = sharpnessY * sharpnessY;
    q.xz = sharpnessX * sine + shape.z * NoV;
    const float inPlane = sharpnessX * NoV - shape.z * sine;
    q.determinant2 = inPlane * inPlane * q.yy;
    return q;
}

// Returns the lobe of a point. A view direction below LTC_MIN_NOV is tilted up to it.
LtcPoint makeLtcPoint(ShadingPoint p)
{
    const float cosine = dot(p.n, p.v);
    const vec3 across = p.v - cosine * p.n;
    const float across2 = length2(across);
    // If the view is along the normal, any tangent will do.
    const vec3 tangent = across2 > 1e-12 ? across * inversesqrt(across2) : anyPerpendicular(p.n);
    const float NoV = clamp(cosine, LTC_MIN_NOV, 1.0);

    const float last = float(LTC_TABLE_SIZE - 1u);
    const float perceptualRoughness = sqrt(p.alpha);
    const vec2 coordinate = vec2((perceptualRoughness - LTC_MIN_ROUGHNESS) / (1.0 - LTC_MIN_ROUGHNESS),
                                 sqrt(max(1.0 - sqrt((NoV - LTC_MIN_NOV) / (1.0 - LTC_MIN_NOV)), 0.0)));
    const vec2 at = last * clamp(coordinate, 0.0, 1.0);
    const vec2 low = min(floor(at), last - 1.0);
    LtcPoint q;
    q.n = p.n;
    q.lobe = makeLtcLobe(ltcEntry(uvec2(low), at - low, 0u), p.n, tangent, NoV, 1.0 / p.alpha);
    q.dielectricAlbedo = ltcEntry(uvec2(low), at - low, 1u).x;
    return q;
}

vec3 ltcMap(LtcLobe q, vec3 n, vec3 l)
{
    return vec3(dot(q.rowX, l), dot(q.rowY, l), dot(n, l));
}

const vec3 LTC_NORMAL = vec3(0.0, 0.0, 1.0);

// Returns the responses (A, B) with F = 1 and F = (1 - VoH)^5 to a light of unit luminance.
// `formFactor` is that of the light under the lobe. B / A is the same as in a uniform environment; the
// response of a dielectric is F0 (A - B) + B.
vec2 ltcResponse(LtcPoint q, float formFactor)
{
    const float a = q.lobe.albedo * formFactor;
    const float mixed = q.dielectricAlbedo * formFactor;
    const float b = (mixed - LTC_DIELECTRIC_F0 * a) / (1.0 - LTC_DIELECTRIC_F0);
    return vec2(a, clamp(b, 0.0, a));
}

// Returns the responses to a sphere in the unit direction c; s2 is sin^2 of its half angle. In the
// mapped space its dual cone is s2 M M^T - w w^T, where w is the mapped c, so no axes are needed.
vec2 ltcSphere(LtcPoint point, vec3 c, float sine2)
{
    const LtcLobe q = point.lobe;
    const float s2 = min(sine2, 0.9999);
    const vec3 w = ltcMap(q, point.n, c);
    const float w2 = length2(w);
    const float trace = q.xx + q.yy + 1.0;
    const float wGw = q.xx * w.x * w.x + q.yy * w.y * w.y + w.z * w.z + 2.0 * q.xz * w.x * w.z;
    const float minors = q.xx * q.yy + q.yy + q.xx - q.xz * q.xz;
    const DualCone cone = DualCone(s2 * q.xx - w.x * w.x, s2 * q.yy - w.y * w.y, s2 - w.z * w.z,
                                   -w.x * w.y, s2 * q.xz - w.x * w.z, -w.y * w.z,
                                   s2 * trace - w2, s2 * (s2 * minors - (trace * w2 - wGw)),
                                   s2 * s2 * (1.0 - s2) * q.determinant2);
    return ltcResponse(point, ellipticConeFormFactor(cone, w));
}

vec2 ltcRectangle(LtcPoint q, vec3 toCentre, vec3 axisU, vec3 axisV, bool twoSided)
{
    if (!facesRectangle(toCentre, axisU, axisV, twoSided))
        return vec2(0.0);
    return ltcResponse(q, parallelogramFormFactor(LTC_NORMAL, ltcMap(q.lobe, q.n, toCentre),
                                                  ltcMap(q.lobe, q.n, axisU),
                                                  ltcMap(q.lobe, q.n, axisV)));
}

mat3 ltcMatrix(LtcLobe q, vec3 n)
{
    return transpose(mat3(q.rowX, q.rowY, n));
}

#endif
