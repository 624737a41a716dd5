// SPDX-License-Identifier: Apache-2.0
// Walks a pixel's lights in blocks: testing is in step, so its cost is one pass over the list; what the
// lanes found differs little between neighbours, so shading it diverges little. Each way of evaluation
// has its own loop and its own sum, in light order: results do not depend on where blocks begin.
// The includer provides uint lightAt(uint k), the k-th light.
#ifndef CND_LIB_LIGHT_WALK
#define CND_LIB_LIGHT_WALK

#include "lib/light_eval.glsl"

const uint WALK_BLOCK = 32u; // lights tested together: bits of a word

// One bit per light of a block, by evaluation.
struct Found {
    uint asPoint, above, near, general;
};

#if HAS_SPHERES
// Sorts a sphere that reaches the point by where it stands to the horizon; no division.
void classifySphere(inout Found found, uint bit, Receiver r, vec3 toLight, float radius)
{
    const float dz = dot(r.p.n, toLight);
    bool above = dz >= radius;
    bool near = false;
    bool asPoint = false;
    if (IS_CONIC) {
        const float d2 = length2(toLight);
        const uint region = conicClass(dz, radius, d2, r.conic.a2);
        near = region == CONIC_NEAR;
        asPoint = HAS_BUDGET && above && radius * radius < r.pointLimit * d2;
        above = region == CONIC_ABOVE;
    }
    found.asPoint |= asPoint ? bit : 0u;
    found.above |= above && !asPoint ? bit : 0u;
    found.near |= near && !asPoint ? bit : 0u;
    found.general |= above || near || asPoint ? 0u : bit;
}
#endif

// `testInfluence`: leave out lights that are beyond their influence (they would add 0).
Found findLights(Receiver r, uint first, uint count, bool testInfluence)
{
    Found found = Found(0u, 0u, 0u, 0u);
    for (uint i = 0u; i < count; ++i) {
        const uint light = lightAt(first + i);
        const vec4 centreReach = lightCentre(light);
        const vec3 toLight = towardsLight(centreReach.xyz, r.p.position);
        float influence2 = uintBitsToFloat(0x7F800000u);
        if (testInfluence)
            influence2 = lightEmission(light).w;
        const uint bit = lightReaches(toLight, r.p.n, centreReach.w, influence2) ? 1u << i : 0u;
#if HAS_SPHERES
        if (IS_SPHERE) {
            classifySphere(found, bit, r, toLight, centreReach.w);
            continue;
        }
#endif
        found.general |= bit;
    }
    return found;
}

// Adds the lights of a block that are evaluated in one way to their sum.
#define SHADE_FOUND(sum, r, first, found, evaluate)                                                \
    for (uint left = found; left != 0u; left &= left - 1u)                                         \
        sum += evaluate(r, lightAt((first) + findLSB(left)))

#endif
