// SPDX-License-Identifier: Apache-2.0
// Tests which lights of a block reach a pixel, and in which way each is to be evaluated
// (light_families.glsl). The includer provides uint lightAt(uint k), which returns the k-th light. It
// may define MAY_READ_AHEAD as true, so that the lights of several tests are read at once. GPUs gain
// from that, because a test waits long for its light, but little longer for several.
#ifndef CND_SHADING_CLASSIFY_LIGHTS
#define CND_SHADING_CLASSIFY_LIGHTS

#include "shading/light.glsl"
#include "shading/light_families.glsl"
#include "shading/software_drivers.glsl"

const uint WALK_BLOCK = 64u; // lights of a block, which are the bits of two words

// Whether the height of the tile allows lights of a way.
const bool POSSIBLE_ABOVE = true;
const bool POSSIBLE_GENERAL = tileHeight == ANY_HEIGHT;
const bool POSSIBLE_NEAR = HAS_CLOSED_SPHERES ? tileHeight != ALL_ABOVE : POSSIBLE_GENERAL;

// A sphere is evaluated as above the horizon if its centre is at least so many of its radii above it.
const float SPHERE_ABOVE_FROM = HAS_CLOSED_SPHERES ? ABOVE_FROM : 1.0;

// The lights of a block that are to be evaluated in each way, one bit per light.
struct Found {
    uvec2 above, near, general;
};

// Results of the tests for half a block. `reaching` holds the lights that reach the point. The other
// masks may also hold lights that do not reach it, and a light may be in several of them.
struct FoundWord {
    uint reaching, above, near;
};

// Lights have no lower band (lib/outline/bands.glsl) if their height is at least this times their
// radius. (h - r) / (h + r) >= BAND_HEIGHT means h >= 1.5 r. The limit is a little higher, because the
// ends of a light are at different distances.
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

// Tells whether a sphere that is not above the horizon is evaluated by the closed form as near it.
bool isNear(Receiver r, float radius, float height, float d2)
{
    // For a point inside the sphere the cap is limited as in makeSphereCap. At the centre both sides of
    // the comparisons are 0. Spheres with (R / d)^2 below `smallCap` are not clipped.
    precise const float smallCap = SMALL_CAP * r.conic.a2;
    precise const float radius2 = min(radius * radius, MAX_SPECULAR_S2 * d2);
    precise const float height2 = height * abs(height);
    precise const float smallCap2 = smallCap * d2;
    return height2 > radius2 || radius2 < smallCap2;
}

#ifndef MAY_READ_AHEAD
#define MAY_READ_AHEAD false
#endif
// findWord reads the lights of TESTS_AT_ONCE tests before it makes these tests. With eight instead of
// four, an H100 takes longer, and the kernel needs a third more registers on Navi 21
// (engine/DECISIONS.md, 38). MOST_TESTS_AT_ONCE is the size of the array that holds these lights. It
// must not depend on a specialisation constant.
const uint MOST_TESTS_AT_ONCE = 4u;
const bool READS_AHEAD = MAY_READ_AHEAD && !forCpu;
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
    if (HAS_SPHERES) {
        precise const float aboveFrom = SPHERE_ABOVE_FROM * radius;
        found.above |= height >= aboveFrom ? bit : 0u;
    } else if (HAS_OUTLINES) {
        const bool easy = !BY_OUTLINE || isUncut(r, toLight, height, d2, radius * radius);
        precise const float aboveFrom = (BY_OUTLINE ? ABOVE_BANDS : 1.0) * radius;
        found.above |= height >= aboveFrom && easy ? bit : 0u;
    }
    if (HAS_CLOSED_SPHERES)
        found.near |= isNear(r, radius, height, d2) ? bit : 0u;
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
    if (POSSIBLE_NEAR)
        found.above &= uvec2(low.above, high.above);
    if (HAS_ALL_FAMILIES && !TYPE_IS_OF(FAMILY_SPHERE))
        return Found(uvec2(0u), uvec2(0u), reaching);
    const uvec2 closer = reaching & ~found.above;
    found.near = closer;
    if (POSSIBLE_GENERAL)
        found.near &= uvec2(low.near, high.near);
    found.general = closer & ~found.near;
    return found;
}

#endif
