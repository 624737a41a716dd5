// SPDX-License-Identifier: Apache-2.0
// Walks a pixel's lights in blocks. First all lanes test the lights of a block in step, at the cost of
// one pass over the list (classify_lights.glsl). Then each lane shades the lights that passed; these
// differ little between neighbours, so the loops diverge little. Each way of evaluation has its own
// loop and its own sum, in the order of the lights, so results do not depend on where blocks begin.
#ifndef CND_SHADING_LIGHT_WALK
#define CND_SHADING_LIGHT_WALK

#include "shading/classify_lights.glsl"
#include "shading/kept_receiver.glsl"
#include "shading/light_eval.glsl"
#ifdef FINDS_SHARES
#include "shading/block_visibility.glsl"
#endif

// Returns the index of the lowest bit that is set.
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

// Adds light to one of the sums of a lane.
void addLight(inout vec3 sum, uint which, vec3 light)
{
    setSum(sum, which, readSum(sum, which) + light);
}

// Sums over lights, one per way of evaluation.
struct Sums {
    vec3 above, near, general;
};

Sums noLight()
{
    Sums sums = Sums(vec3(0.0), vec3(0.0), vec3(0.0));
    setSum(sums.above, SUM_ABOVE, vec3(0.0));
    setSum(sums.general, SUM_GENERAL, vec3(0.0));
    return sums;
}

vec3 total(Sums sums)
{
    sums.above = readSum(sums.above, SUM_ABOVE);
    sums.general = readSum(sums.general, SUM_GENERAL);
    return sums.above + (sums.near + sums.general);
}

// Evaluates the light at a place of the walk. With SHADOWS, the includer provides visibleSharesAt(k),
// or defines FINDS_SHARES; then blocks begin at 0 and have at most SHADOW_BLOCK lights.
#ifdef SHADOWS
#define EVALUATE_AT(evaluate, r, k) evaluate(r, lightAt(k), visibleSharesAt(k))
#else
#define EVALUATE_AT(evaluate, r, k) evaluate(r, lightAt(k))
#endif

// Adds the lights of a block that are evaluated in one way to their sum. The loop tests its condition
// at the end, so that it runs as often as the lane with the most lights needs.
#define SHADE_FOUND(sum, which, r, first, found, evaluate)                                         \
    if (!none(found)) {                                                                            \
        uvec2 left = found;                                                                        \
        do {                                                                                       \
            IF_ANY_LEFT(left)                                                                      \
            addLight(sum, which,                                                                   \
                     EVALUATE_AT(evaluate, readAgain(r), (first) + lowest(left)));                 \
            left = withoutLowest(left);                                                            \
        } while (!none(left));                                                                     \
    }

// Adds the light of a block to the sums. The parameters are those of findLights.
void shadeBlock(inout Sums sums, Receiver r, uint first, uint count, bool testInfluence)
{
    const Found found = findLights(readAgain(r), first, count, testInfluence);
#ifdef FINDS_SHARES
    findShares(readAgain(r), found.above | found.near | found.general);
#endif
#define X(WAY, which, SUM, response)                                                               \
    if (POSSIBLE_##WAY) {                                                                          \
        SHADE_FOUND(sums.which, SUM, r, first, found.which, evaluate_##WAY)                        \
    }
    EVALUATIONS(X)
#undef X
#ifdef LIGHT_FAMILY_ALL
    // All lights of the block are of one type. Each family has its own loop, so that a device that pays
    // for branches that no lane takes pays for them only once per block.
#define X(FAMILY, response)                                                                        \
    if (TYPE_IS_OF(FAMILY_##FAMILY)) {                                                             \
        SHADE_FOUND(sums.general, SUM_GENERAL, r, first, found.general, evaluate_##FAMILY)         \
    }
    GENERAL_RESPONSES(X)
#undef X
#endif
}

#endif
