// SPDX-License-Identifier: Apache-2.0
// Walks a pixel's lights in blocks. First all lanes test the lights of a block in step, at the cost of
// one pass over the list. Then each lane shades the lights that passed; these differ little between
// neighbours, so the loops diverge little. Each way of evaluation has its own loop and its own sum, in
// the order of the lights, so results do not depend on where blocks begin.
//
// The includer provides uint lightAt(uint k), which returns the k-th light, and defines COUNTS_DIFFER
// if blocks of one subgroup may be of different sizes and lightAt or lightCentre reads a storage buffer
// or shared memory. It may define READS_AHEAD as a constant that tells whether the lights of several
// tests are read at once. GPUs gain from that, because a test waits long for its light, but little
// longer for several. It may define TILE_HEIGHT, a constant that holds the height of the
// pixel's tile: ANY_HEIGHT or another (shared/lighting_data.h).
#ifndef CND_SHADING_LIGHT_WALK
#define CND_SHADING_LIGHT_WALK

#include "shading/kept_receiver.glsl"
#include "shading/light_eval.glsl"

const uint WALK_BLOCK = 64u; // lights of a block, which are the bits of two words

// Whether spheres may be evaluated as across the horizon, and as near it. Only the closed form has an
// evaluation for those near it. llvmpipe runs the body of a loop once even if no light needs it, so a
// loop that is not needed is left out.
#ifndef TILE_HEIGHT
#define TILE_HEIGHT ANY_HEIGHT
#endif
const bool ACROSS_IS_POSSIBLE = TILE_HEIGHT == ANY_HEIGHT;
#ifdef LIGHT_FAMILY_CONIC
const bool NEAR_IS_POSSIBLE = TILE_HEIGHT != ALL_ABOVE;
#else
const bool NEAR_IS_POSSIBLE = ACROSS_IS_POSSIBLE;
#endif

// A sphere is evaluated as above the horizon if its centre is at least so many of its radii above it.
#ifdef LIGHT_FAMILY_CONIC
const float SPHERE_ABOVE_FROM = ABOVE_FROM;
#else
const float SPHERE_ABOVE_FROM = 1.0;
#endif

// The lights of a block that are to be evaluated in each way, one bit per light.
struct Found {
    uvec2 above, near, general;
};

// Results of the tests for half a block. `reaching` holds the lights that reach the point. The other
// masks may also hold lights that do not reach it, and a light may be in several of them.
struct FoundWord {
    uint reaching, above, near;
};

#ifdef HAS_OUTLINES
// Lights have no lower band (lib/outline/bands.glsl) if their height is at least this times their
// radius. (h - r) / (h + r) >= BAND_HEIGHT leads to 1.5. It takes a little more, because the ends of a
// light are at different distances.
const float ABOVE_BANDS = 1.6;

// Tells whether no arc of a light's outline needs to be cut (lib/outline/lens.glsl), and no piece of a
// disc's rim needs to be halved. All w = A (v + l) of the light are within a ball around A (v + c),
// where c is the direction to its centre, whose squared radius is at most R^2 / (d^2 - R^2). So the
// angle between any two of them is limited, and an arc turns little more than its ends are apart.
bool isUncut(Receiver r, vec3 toLight, float height, float d2, float radius2)
{
    precise const float d = sqrt(d2);
    const float vl = invariantDot(r.conic.v, toLight);
    precise const float normal = r.conic.NoV * d + height;
    // |A (v + c)|^2 d^2
    precise const float w2 = 2.0 * d * (d + vl) - r.conic.oneMinusA2 * normal * normal;
    precise const float limit = 0.5 * (1.0 - CUT_ONCE) * w2 * (d2 - radius2);
    precise const float size = radius2 * d2;
    return size < limit;
}
#endif

// While some lanes of a subgroup are in a loop, SwiftShader also runs its body for those that have left
// it, with reads of storage buffers and shared memory that give 0. What they compute replaces the value
// with which they left, unless it is assigned under a condition that is false in them
// (tools/bench/RESULTS.md, decision 42). So such a loop asks for its condition in its body too, if
// lanes may leave it one by one.
#ifdef COUNTS_DIFFER
#define IF_COUNTS_DIFFER(condition) if (condition)
#else
#define IF_COUNTS_DIFFER(condition)
#endif

#ifndef READS_AHEAD
#define READS_AHEAD false
#endif
// findWord reads the lights of TESTS_AT_ONCE tests before it makes these tests. With eight instead of
// four, an H100 takes longer, and the kernel needs a third more registers on Navi 21
// (engine/DECISIONS.md, 38). MOST_TESTS_AT_ONCE is the size of the array that holds these lights. It
// must not depend on a specialisation constant.
const uint MOST_TESTS_AT_ONCE = 4u;
const uint TESTS_AT_ONCE = READS_AHEAD ? MOST_TESTS_AT_ONCE : 1u;

// TestedLight holds the values of a light that testLight needs. They are read before it is called.
struct TestedLight {
    vec4 centreRadius;
    float influence2; // squared influence radius
};

// testLight tests whether and in which way a light is to be evaluated, and sets `bit` in the masks of
// `found` that apply. Spheres are sorted by their position relative to the horizon, without a division
// and with few comparisons, because this runs for every light of a list. What is compared is computed
// as `precise`, so that all pipelines sort a light into the same class as far as they read the same
// surface: the evaluations differ by more than rounding.
void testLight(inout FoundWord found, Receiver r, TestedLight light, uint bit, bool testInfluence)
{
    precise const vec3 toLight = towardsLight(light.centreRadius.xyz, r.p.position);
    const float radius = light.centreRadius.w;
    const float height = invariantDot(r.p.n, toLight);
    const float d2 = invariantDot(toLight, toLight);
    bool reaches = height > -radius;
    if (testInfluence)
        reaches = reaches && d2 < light.influence2;
    found.reaching |= reaches ? bit : 0u;
#ifdef HAS_SPHERES
    precise const float aboveFrom = SPHERE_ABOVE_FROM * radius;
    found.above |= height >= aboveFrom ? bit : 0u;
#endif
#if defined(HAS_OUTLINES) && !defined(LIGHT_FAMILY_ALL)
    const bool easy = !BY_OUTLINE || isUncut(r, toLight, height, d2, radius * radius);
    precise const float aboveFrom = (BY_OUTLINE ? ABOVE_BANDS : 1.0) * radius;
    found.above |= height >= aboveFrom && easy ? bit : 0u;
#endif
#ifdef LIGHT_FAMILY_CONIC
    // For a point inside the sphere the cap is limited as in makeSphereCap. At the centre both sides of
    // the comparisons are 0. Spheres with (R / d)^2 below `smallCap` are not clipped.
    precise const float smallCap = SMALL_CAP * r.conic.a2;
    precise const float radius2 = min(radius * radius, MAX_SPECULAR_S2 * d2);
    precise const float height2 = height * abs(height);
    precise const float smallCap2 = smallCap * d2;
    found.near |= height2 > radius2 || radius2 < smallCap2 ? bit : 0u;
#endif
}

// Tests the lights first .. first + count - 1, where count is at most 32. `testInfluence`: leave out
// lights whose sphere of influence does not hold the point (they would add 0).
FoundWord findWord(Receiver r, uint first, uint count, bool testInfluence)
{
    FoundWord found = FoundWord(0u, 0u, 0u);
    const uint end = first + count;
    uint bit = 1u;
    uint k = first;
    do {
        IF_COUNTS_DIFFER(k < end) {
            TestedLight lights[MOST_TESTS_AT_ONCE];
            for (uint i = 0u; i < TESTS_AT_ONCE; ++i) {
                const uint light = lightAt(READS_AHEAD && k + i >= end ? first : k + i);
                lights[i] =
                    TestedLight(lightCentre(light), testInfluence ? lightEmission(light).w : 0.0);
            }
            for (uint i = 0u; i < TESTS_AT_ONCE; ++i)
                testLight(found, r, lights[i], k + i < end ? bit << i : 0u, testInfluence);
        }
        bit <<= TESTS_AT_ONCE;
        k += TESTS_AT_ONCE;
    } while (k < end);
    return found;
}

// Tests up to WALK_BLOCK lights. Even if count is 0, lightAt(first) must be valid.
Found findLights(Receiver r, uint first, uint count, bool testInfluence)
{
    const FoundWord low = findWord(r, first, min(count, 32u), testInfluence);
    FoundWord high = FoundWord(0u, 0u, 0u);
    if (count > 32u)
        high = findWord(r, first + 32u, count - 32u, testInfluence);
    const uvec2 reaching = count == 0u ? uvec2(0u) : uvec2(low.reaching, high.reaching);
    Found found;
    // Where a way of evaluation is not possible, the lights that are left belong to the way before it.
    found.above = reaching;
    if (NEAR_IS_POSSIBLE)
        found.above &= uvec2(low.above, high.above);
#ifdef LIGHT_FAMILY_ALL
    if (FAMILY_OF_TYPE[lightType] != FAMILY_SPHERE) {
        found.above = uvec2(0u);
        found.near = uvec2(0u);
        found.general = reaching;
        return found;
    }
#endif
    const uvec2 closer = reaching & ~found.above;
    found.near = closer;
    if (ACROSS_IS_POSSIBLE)
        found.near &= uvec2(low.near, high.near);
    found.general = closer & ~found.near;
    return found;
}

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

// Adds the lights of a block that are evaluated in one way to their sum. The loop tests its condition
// at the end, so that it runs as often as the lane with the most lights needs. With the condition at
// the front some devices run it once more. Outlines have loops whose count differs between lanes; if
// such a loop is within another, llvmpipe (Mesa 22.3) runs a lane that is done once more, which must
// then add nothing. With a shadow term, whose id is read from a storage buffer, SwiftShader needs the
// condition too (see IF_COUNTS_DIFFER).
#if defined(HAS_OUTLINES) || defined(CANDELABRA_VISIBILITY)
#define IF_ANY_LEFT(left) if (!none(left))
#else
#define IF_ANY_LEFT(left)
#endif
#define SHADE_FOUND(sum, which, r, first, found, evaluate)                                         \
    if (!none(found)) {                                                                            \
        uvec2 left = found;                                                                        \
        do {                                                                                       \
            IF_ANY_LEFT(left)                                                                      \
            addLight(sum, which, evaluate(readAgain(r), lightAt((first) + lowest(left))));         \
            left = withoutLowest(left);                                                            \
        } while (!none(left));                                                                     \
    }

// Adds light to one of the sums of a lane.
void addLight(inout vec3 sum, uint which, vec3 light)
{
    setSum(sum, which, readSum(sum, which) + light);
}

#define IF(condition, bits) ((condition) ? (bits) : uvec2(0u))

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

// Adds the light of a block to the sums. The parameters are those of findLights.
void shadeBlock(inout Sums sums, Receiver r, uint first, uint count, bool testInfluence)
{
    const Found found = findLights(readAgain(r), first, count, testInfluence);
#ifdef HAS_ABOVE
    SHADE_FOUND(sums.above, SUM_ABOVE, r, first, found.above, evaluateAbove)
#endif
#ifdef LIGHT_FAMILY_CONIC
    if (NEAR_IS_POSSIBLE) {
        SHADE_FOUND(sums.near, SUM_GENERAL, r, first, found.near, evaluateNear)
    }
#endif
#ifdef LIGHT_FAMILY_ALL
    // All lights of the block are of one type. Each family has its own loop, so that a device that pays
    // for branches that no lane takes pays for them only once per block.
    const uint family = FAMILY_OF_TYPE[lightType];
#define X(FAMILY, response)                                                                        \
    SHADE_FOUND(sums.general, SUM_GENERAL, r, first,                                               \
                IF(family == FAMILY_##FAMILY, found.general), evaluate_##FAMILY)
    GENERAL_RESPONSES(X)
#undef X
#else
    if (ACROSS_IS_POSSIBLE) {
        SHADE_FOUND(sums.general, SUM_GENERAL, r, first, found.general, evaluateGeneral)
    }
#endif
}

#endif
