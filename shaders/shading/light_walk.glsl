// SPDX-License-Identifier: Apache-2.0
// Walks a pixel's lights in blocks: testing is in step, so its cost is one pass over the list; what the
// lanes found differs little between neighbours, so shading it diverges little. Each way of evaluation
// has its own loop and its own sum, in light order: results do not depend on where blocks begin.
// The includer provides uint lightAt(uint k), the k-th light.
#ifndef CND_SHADING_LIGHT_WALK
#define CND_SHADING_LIGHT_WALK

#include "shading/light_eval.glsl"

const uint WALK_BLOCK = 64u; // lights tested together: bits of two words

// One bit per light of a block, by evaluation.
struct Found {
    uvec2 asPoint, above, near, general;
};

// The same for half a block, raw: `reaching` holds all lights that reach the point; the others may also
// hold lights that do not, and lights of those before them.
struct FoundWord {
    uint reaching, asPoint, above, near;
};

// Lights first .. first + count - 1, 1..32 of them. Spheres are sorted by where they stand to the
// horizon: no division, and one comparison each, because this runs for every light of a list.
// `testInfluence`: leave out lights that are beyond their influence (they would add 0).
FoundWord findWord(Receiver r, uint first, uint count, bool testInfluence)
{
    FoundWord found = FoundWord(0u, 0u, 0u, 0u);
    uint bit = 1u;
    uint k = first;
    do {
        const uint light = lightAt(k);
        const vec4 centreRadius = lightCentre(light);
        const vec3 toLight = towardsLight(centreRadius.xyz, r.p.position);
        const float radius = centreRadius.w;
        const float height = dot(r.p.n, toLight);
        const float d2 = length2(toLight);
        bool reaches = height > -radius;
        if (testInfluence)
            reaches = reaches && d2 < lightEmission(light).w;
        found.reaching |= reaches ? bit : 0u;
#ifdef HAS_SPHERES
        found.above |= height >= r.aboveFrom * radius ? bit : 0u;
#endif
#ifdef LIGHT_FAMILY_CONIC
        // Inside a sphere its cap is that of makeSphereCap; in its very centre all of this is 0.
        const float radius2 = min(radius * radius, MAX_SPECULAR_S2 * d2);
        const bool whole = height * abs(height) > radius2;
        found.near |= whole || radius2 < r.smallCap * d2 ? bit : 0u;
        if (HAS_BUDGET)
            found.asPoint |= height >= 2.0 * radius && radius2 < r.pointLimit * d2 ? bit : 0u;
#endif
        bit <<= 1u;
        ++k;
    } while (k < first + count);
    return found;
}

// Up to WALK_BLOCK lights; without any, `first` still is one that can be read.
Found findLights(Receiver r, uint first, uint count, bool testInfluence)
{
    const FoundWord low = findWord(r, first, min(count, 32u), testInfluence);
    FoundWord high = FoundWord(0u, 0u, 0u, 0u);
    if (count > 32u)
        high = findWord(r, first + 32u, count - 32u, testInfluence);
    const uvec2 reaching = count == 0u ? uvec2(0u) : uvec2(low.reaching, high.reaching);
    Found found;
    found.asPoint = uvec2(low.asPoint, high.asPoint) & reaching;
    found.above = uvec2(low.above, high.above) & reaching & ~found.asPoint;
#ifdef LIGHT_FAMILY_ALL
    if (FAMILY_OF_TYPE[lightType] != FAMILY_SPHERE) {
        found.above = uvec2(0u);
        found.near = uvec2(0u);
        found.general = reaching;
        return found;
    }
#endif
    const uvec2 closer = reaching & ~(found.asPoint | found.above);
    found.near = uvec2(low.near, high.near) & closer;
    found.general = closer & ~found.near;
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

#define IF(condition, bits) ((condition) ? (bits) : uvec2(0u))

// What lights add, by evaluation.
struct Sums {
    vec3 asPoint, above, near, general;
};

Sums noLight()
{
    return Sums(vec3(0.0), vec3(0.0), vec3(0.0), vec3(0.0));
}

vec3 total(Sums sums)
{
    return (sums.asPoint + sums.above) + (sums.near + sums.general);
}

// `first` and `count` as of findLights.
void shadeBlock(inout Sums sums, Receiver r, uint first, uint count, bool testInfluence)
{
    const Found found = findLights(r, first, count, testInfluence);
#ifdef LIGHT_FAMILY_CONIC
    if (HAS_BUDGET) {
        SHADE_FOUND(sums.asPoint, r, first, found.asPoint, evaluateAsPoint)
    }
    SHADE_FOUND(sums.near, r, first, found.near, evaluateNear)
#endif
#ifdef HAS_SPHERES
    SHADE_FOUND(sums.above, r, first, found.above, evaluateAbove)
#endif
#ifdef LIGHT_FAMILY_ALL
    // The block is of one type. A loop each: what a device pays for branches that it does not take, it
    // pays once for a block.
    const uint family = FAMILY_OF_TYPE[lightType];
#define X(FAMILY, response)                                                                        \
    SHADE_FOUND(sums.general, r, first, IF(family == FAMILY_##FAMILY, found.general),              \
                evaluate_##FAMILY)
    GENERAL_RESPONSES(X)
#undef X
#else
    SHADE_FOUND(sums.general, r, first, found.general, evaluateGeneral)
#endif
}

#endif
