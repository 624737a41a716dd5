// SPDX-License-Identifier: Apache-2.0
// Which share of a light's response is left when some points of its facet are hidden.
#ifndef CND_LIB_VISIBILITY_VISIBLE_SHARES
#define CND_LIB_VISIBILITY_VISIBLE_SHARES

#include "lib/brdf.glsl"
#include "lib/visibility/facet.glsl"

// Share of the solid angle of a point that is added to alpha^2 in weights of the specular lobe, so that
// one point of a mirror's reflection does not hold all of the weight.
const float LOBE_WIDENING = 0.2;

// Returns the solid angle in steradians that one point stands for in the middle of a small facet.
float solidAngleOfPoint(Facet f, uint count)
{
    const float area = f.shape == FACET_DISC ? PI : 4.0; // in units of halfU and halfV
    const float c2 = max(dot(f.centre, f.centre), MIN_LENGTH2);
    return area * abs(dot(cross(f.halfU, f.halfV), f.centre)) / (c2 * sqrt(c2) * float(count));
}

// Returns the weights of a point of the facet for the diffuse lobe (x) and the specular lobe (y).
// q: the point; n: unit normal of the facet.
vec2 pointWeights(vec3 q, vec3 n, ShadingPoint p)
{
    const float d2 = max(dot(q, q), MIN_LENGTH2);
    const float inverse = inversesqrt(d2);
    const vec3 l = q * inverse;
    const float NoL = dot(p.n, l);
    if (!(NoL > 0.0))
        return vec2(0.0);
    const float solidAngle = abs(dot(n, l)) * (inverse * inverse);
    return vec2(NoL, specularResponse(p, l).x) * solidAngle;
}

// Returns the visible share of the weight. points: how many are lit (x) of how many (y).
float shareOf(float lit, float all, vec2 points)
{
    return all > 0.0 ? min(lit / all, 1.0) : points.x / points.y;
}

// Returns the factors of the closed forms of the diffuse lobe (x) and the specular lobe (y): the ratio
// estimator of Heitz, Hill and McGuire 2018 over the points of the facet. `lit` has the visible points.
vec2 visibleShares(Facet f, uint count, uvec2 lit, ShadingPoint p)
{
    const uvec2 visible = lit & f.members;
    if (isEmpty(f.members))
        return vec2(1.0);
    if (isEmpty(visible))
        return vec2(0.0);
    if (visible == f.members)
        return vec2(1.0);
    const vec3 n = normalize(cross(f.halfU, f.halfV));
    p.alpha = sqrt(p.alpha * p.alpha + LOBE_WIDENING * solidAngleOfPoint(f, count));
    deriveTerms(p);
    vec2 litSum = vec2(0.0), sum = vec2(0.0);
    float litPoints = 0.0, points = 0.0;
    for (uint i = 0u; i < count; ++i) {
        const uint bit = 1u << (i & 31u);
        if (((i < 32u ? f.members.x : f.members.y) & bit) == 0u)
            continue;
        const bool isLit = ((i < 32u ? visible.x : visible.y) & bit) != 0u;
        const vec2 uv = facetPoint(count, f.shape, i);
        const vec2 w = pointWeights(f.centre + uv.x * f.halfU + uv.y * f.halfV, n, p);
        sum += w;
        litSum += isLit ? w : vec2(0.0);
        points += 1.0;
        litPoints += isLit ? 1.0 : 0.0;
    }
    const vec2 counts = vec2(litPoints, points);
    return vec2(shareOf(litSum.x, sum.x, counts), shareOf(litSum.y, sum.y, counts));
}

#endif
