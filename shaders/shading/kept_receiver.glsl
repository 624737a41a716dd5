// SPDX-License-Identifier: Apache-2.0
// What a lane keeps in shared memory while it evaluates lights by their outlines: its surface and its
// sums of light. The evaluation needs most of the registers that a lane may have, and these values are
// needed only before and after it. If its lanes may keep them, the includer defines KEPT_LANES, the
// number of lanes of a group, and LANES_OF_RECEIVER, the number of consecutive lanes that have one
// receiver.
#ifndef CND_SHADING_KEPT_RECEIVER
#define CND_SHADING_KEPT_RECEIVER

#include "shading/light_type.glsl"
#include "shading/receiver.glsl"
#include "shading/software_drivers.glsl"

// The sums of a lane, by the way in which lights are evaluated (light_families.glsl). The way NEAR,
// which only spheres have, names SUM_GENERAL, but nothing is kept for spheres.
const uint SUM_ABOVE = 0u;
const uint SUM_GENERAL = 1u;

#ifdef KEPT_LANES
#extension GL_KHR_shader_subgroup_basic : require

const bool MAY_KEEP_RECEIVERS = HAS_OUTLINES && !forCpu;
const bool KEEPS_RECEIVERS = MAY_KEEP_RECEIVERS && BY_OUTLINE;
const uint KEPT_RECEIVERS = KEPT_LANES / LANES_OF_RECEIVER;

// The places of values among the words of a receiver.
const uint KEPT_POSITION = 0u;
const uint KEPT_N = 3u;
const uint KEPT_V = 6u;
const uint KEPT_ALPHA = 9u;
const uint KEPT_ALBEDO = 10u;
const uint KEPT_F0 = 13u;
const uint KEPT_F90 = 16u;
const uint KEPT_SUMS = 19u; // three words each
const uint KEPT_WORDS = 25u;

// Words of neighbouring lanes are neighbours, so that lanes never use the same bank of memory.
shared float keptWords[MAY_KEEP_RECEIVERS ? KEPT_WORDS * KEPT_RECEIVERS : 1u];
shared uint keptLights[MAY_KEEP_RECEIVERS ? KEPT_LANES : 1u];

uint placeOf(uint word)
{
    return word * KEPT_RECEIVERS + gl_LocalInvocationIndex / LANES_OF_RECEIVER;
}

void keepVector(uint word, vec3 a)
{
    keptWords[placeOf(word)] = a.x;
    keptWords[placeOf(word + 1u)] = a.y;
    keptWords[placeOf(word + 2u)] = a.z;
}

vec3 keptVector(uint word)
{
    return vec3(keptWords[placeOf(word)], keptWords[placeOf(word + 1u)],
                keptWords[placeOf(word + 2u)]);
}

// Keeps a receiver for readAgain().
void keep(Receiver r)
{
    if (!KEEPS_RECEIVERS)
        return;
    keepVector(KEPT_POSITION, r.p.position);
    keepVector(KEPT_N, r.p.n);
    keepVector(KEPT_V, r.p.v);
    keptWords[placeOf(KEPT_ALPHA)] = r.p.alpha;
    keepVector(KEPT_ALBEDO, r.p.albedo);
    keepVector(KEPT_F0, r.p.F0);
    keepVector(KEPT_F90, r.p.F90);
}

// Returns the receiver that this lane keeps, or `given` if lanes keep none. Values that come from it
// occupy no registers before the call. The barrier makes compilers read memory in its place, where they
// would otherwise use the values that were written or read before.
Receiver readAgain(Receiver given)
{
    if (!KEEPS_RECEIVERS)
        return given;
    subgroupMemoryBarrierShared();
    Receiver r = given;
    r.p.position = keptVector(KEPT_POSITION);
    r.p.n = keptVector(KEPT_N);
    r.p.v = keptVector(KEPT_V);
    r.p.alpha = keptWords[placeOf(KEPT_ALPHA)];
    deriveTerms(r.p);
    r.p.albedo = keptVector(KEPT_ALBEDO);
    r.p.F0 = keptVector(KEPT_F0);
    r.p.F90 = keptVector(KEPT_F90);
    r.conic = makeConicPoint(r.p);
    r.frame = makeOutlineFrame(r.conic);
    return r;
}

// Keeps the index of the light that this lane evaluates.
void keepLight(uint index)
{
    if (KEEPS_RECEIVERS)
        keptLights[gl_LocalInvocationIndex] = index;
}

// Returns the index that this lane keeps, or `given` if lanes keep none. What is read of the light with
// it is read again, and occupies no registers before.
uint lightAgain(uint given)
{
    if (!KEEPS_RECEIVERS)
        return given;
    subgroupMemoryBarrierShared();
    return keptLights[gl_LocalInvocationIndex];
}

void setSum(inout vec3 sum, uint which, vec3 light)
{
    if (KEEPS_RECEIVERS)
        keepVector(KEPT_SUMS + 3u * which, light);
    else
        sum = light;
}

vec3 readSum(vec3 sum, uint which)
{
    return KEEPS_RECEIVERS ? keptVector(KEPT_SUMS + 3u * which) : sum;
}

#else
const bool KEEPS_RECEIVERS = false;

void keep(Receiver r)
{
}

Receiver readAgain(Receiver given)
{
    return given;
}

void keepLight(uint index)
{
}

uint lightAgain(uint given)
{
    return given;
}

void setSum(inout vec3 sum, uint which, vec3 light)
{
    sum = light;
}

vec3 readSum(vec3 sum, uint which)
{
    return sum;
}
#endif

#endif
