// SPDX-License-Identifier: Apache-2.0
// Walks a pixel's lights in blocks: testing is in step, so its cost is one pass over the list; what the
// lanes found differs little between neighbours, so shading it diverges little. Each way of evaluation
// has its own loop and its own sum, in light order: results do not depend on where blocks begin.
// The includer provides uint lightAt(uint k), the k-th light.
#ifndef CND_LIB_LIGHT_WALK
#define CND_LIB_LIGHT_WALK

#include "lib/light_eval.glsl"

const uint WALK_BLOCK = 64u; // lights tested together: bits of two words

// One bit per light of a block, by evaluation.
struct Found {
    uvec2 asPoint, above, near, general;
};

#if HAS_SPHERES
// Sorts a sphere that reaches the point by where it stands to the horizon; no division.
void classifySphere(inout Found found, uvec2 bit, Receiver r, vec3 toLight, float radius)
{
    const float dz = dot(r.p.n, toLight);
    bool above = dz >= radius;
    bool near = false;
    bool asPoint = false;
    if (IS_CONIC) {
        const float d2 = length2(toLight);
        const uint region = conicClass(dz, radius, d2, r.conic.a2);
        asPoint = HAS_BUDGET && above && radius * radius < r.pointLimit * d2;
        above = region == CONIC_ABOVE || (above && r.oneNode);
        near = region == CONIC_NEAR && !above;
    }
    found.asPoint |= asPoint ? bit : uvec2(0u);
    found.above |= above && !asPoint ? bit : uvec2(0u);
    found.near |= near && !asPoint ? bit : uvec2(0u);
    found.general |= above || near || asPoint ? uvec2(0u) : bit;
}
#endif

// `testInfluence`: leave out lights that are beyond their influence (they would add 0).
Found findLights(Receiver r, uint first, uint count, bool testInfluence)
{
    Found found = Found(uvec2(0u), uvec2(0u), uvec2(0u), uvec2(0u));
    for (uint i = 0u; i < count; ++i) {
        const uint light = lightAt(first + i);
        const vec4 centreReach = lightCentre(light);
        const vec3 toLight = towardsLight(centreReach.xyz, r.p.position);
        float influence2 = uintBitsToFloat(0x7F800000u);
        if (testInfluence)
            influence2 = lightEmission(light).w;
        const uint inWord = 1u << (i & 31u);
        uvec2 bit = i < 32u ? uvec2(inWord, 0u) : uvec2(0u, inWord);
        bit = lightReaches(toLight, r.p.n, centreReach.w, influence2) ? bit : uvec2(0u);
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

// Index of the lowest bit, and the bits without it.
uint lowest(uvec2 bits)
{
    return bits.x != 0u ? findLSB(bits.x) : 32u + findLSB(bits.y);
}

uvec2 withoutLowest(uvec2 bits)
{
    return uvec2(bits.x & (bits.x - 1u), bits.x != 0u ? bits.y : bits.y & (bits.y - 1u));
}

bool none(uvec2 bits)
{
    return (bits.x | bits.y) == 0u;
}

// Adds the lights of a block that are evaluated in one way to their sum. With the condition at the
// end a loop runs as often as the lane with the most lights needs; at the front, once more on some
// devices.
#define SHADE_FOUND(sum, r, first, found, evaluate)                                                \
    if (!none(found)) {                                                                            \
        uvec2 left = found;                                                                        \
        do {                                                                                       \
            sum += evaluate(r, lightAt((first) + lowest(left)));                                   \
            left = withoutLowest(left);                                                            \
        } while (!none(left));                                                                     \
    }

#endif
