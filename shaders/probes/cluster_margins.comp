// SPDX-License-Identifier: Apache-2.0
// Test-only: makes the bounds of some samples, moves the samples by as much as Vulkan allows two
// pipelines to differ, places lights that just reach the moved samples, and counts the lights that the
// tests of the bounds leave out. It also makes spheres just too large for a height above the horizon,
// and a little smaller, and counts those that have this height by the bounds.
#version 460
#extension GL_GOOGLE_include_directive : require
#include "shared/margins_probe.h"
#include "lib/cluster_margins.glsl"
#include "lib/cluster_test.glsl"
#include "lib/math.glsl"
#include "lib/projection.glsl"
#include "lib/specular/sampled.glsl"

layout(local_size_x = PROBE_GROUP) in;
layout(push_constant, scalar) uniform Push
{
    ProbeParams params;
};
layout(scalar, binding = PROBE_INPUT) readonly buffer Input
{
    MarginsProbeInput inputs[];
};
layout(scalar, binding = PROBE_OUTPUT) writeonly buffer Output
{
    MarginsProbeOutput outputs[];
};

const uint SAMPLES = 4u;
const uint LIGHTS = 64u;
const int DIVISION_ULPS = 5; // between two quotients that are off by 2.5 ULP each

uint randomState;

float random01()
{
    randomState = pcgHash(randomState);
    return float(randomState >> 8) / 16777216.0;
}

vec3 randomDirection()
{
    const vec3 v = vec3(random01(), random01(), random01()) * 2.0 - 1.0;
    return v / max(length(v), 1e-3);
}

// Returns a number that differs from x by up to this many ULP.
float nearby(float x, int ulps)
{
    const int by = int(round((random01() * 2.0 - 1.0) * float(ulps)));
    return abs(x) < 1e-30 ? x : uintBitsToFloat(uint(int(floatBitsToUint(x)) + by));
}

// viewPosition() with divisions that are less precise.
vec3 movedPosition(Projection m, uvec2 pixel, vec2 invImageSize, float depth)
{
    precise const float z =
        nearby((m.m32 - depth * m.m33) / (depth * m.m23 - m.m22), DIVISION_ULPS);
    precise const float w = m.m23 * z + m.m33;
    precise const vec2 ndc = vec2(2u * pixel + 1u) * invImageSize - 1.0;
    return vec3(nearby((ndc.x * w - m.m20 * z - m.m30) / m.m00, DIVISION_ULPS),
                nearby((ndc.y * w - m.m21 * z - m.m31) / m.m11, DIVISION_ULPS), z);
}

// Adds a sample to a cluster as tile_clusters does.
void addTo(inout Cluster c, vec3 p, vec3 n)
{
    c.axis = c.min.x > c.max.x ? n : c.axis;
    c.min = min(c.min, p);
    c.max = max(c.max, p);
    c.slabMin = min(c.slabMin, dot(c.axis, p));
    c.slabMax = max(c.slabMax, dot(c.axis, p));
    c.minCos = min(c.minCos, dot(c.axis, n));
    const float ahead = dot(p, c.ray), aside = length(cross(p, c.ray));
    c.slope = max(c.slope, aside < MAX_SLOPE * ahead ? aside / ahead : MAX_SLOPE);
}

// Tells whether the bounds say that a sphere is at least `radii`, 1 or ABOVE_FROM, of its radii above
// all horizons.
bool isHigh(Cluster c, vec3 centre, float radius, float r2, float radii)
{
    const uint height = heightOfSphere(makeClusterBounds(c), centre, radius, r2);
    return height == ALL_ABOVE || (radii == 1.0 && height == NONE_ACROSS);
}

bool touches(Cluster c, vec3 centre, float radius, float r2)
{
    const ClusterBounds bounds = makeClusterBounds(c);
    return lightTouches(bounds, centre, radius, r2) &&
           boxTouches(bounds, influenceBox(centre, r2));
}

void main()
{
    const uint i = gl_GlobalInvocationID.x;
    if (i >= params.count)
        return;
    const MarginsProbeInput probe = inputs[i];
    randomState = probe.seed;
    const vec3 ray = normalize(viewRay(probe.projection, probe.pixel, probe.invImageSize));
    Cluster cluster = Cluster(vec3(UNBOUNDED), 0u, vec3(-UNBOUNDED), 0u, vec3(0.0), UNBOUNDED,
                              -UNBOUNDED, 1.0, 0u, ray, 0.0);
    const vec3 axis = randomDirection();
    const float bend = i % 2u == 0u ? 0.01 : 0.0; // the bounds of a flat cluster are the tightest
    vec3 moved[SAMPLES], normals[SAMPLES];
    for (uint k = 0u; k < SAMPLES; ++k) {
        const uvec2 pixel = probe.pixel + uvec2(8.0 * vec2(random01(), random01()));
        const float depth = probe.depth * (1.0 + probe.depthRange * random01());
        const vec3 n = normalize(axis + bend * randomDirection());
        normals[k] = n * nearby(1.0, 8);
        addTo(cluster, viewPosition(probe.projection, pixel, probe.invImageSize, depth), n);
        moved[k] = movedPosition(probe.projection, pixel, probe.invImageSize, depth);
    }
    const Cluster widened = withMargins(cluster, probe.projection);
    cluster = probe.projection.eyeIsPoint == 0.0 ? withoutCone(cluster) : cluster;
    MarginsProbeOutput result = MarginsProbeOutput(0u, 0u, 0u, 0u, 0u);
    for (uint k = 0u; k < LIGHTS; ++k) {
        const uint at = k % SAMPLES;
        // Lights straight above the sample, along an axis, anywhere, and at the horizon of the sample,
        // at the end of their reach.
        vec3 towards = k % 8u == 2u ? normals[at] : randomDirection();
        if (k % 3u == 0u)
            towards = vec3(equal(uvec3(k / 3u % 3u), uvec3(0u, 1u, 2u))) * sign(towards);
        if (k % 3u == 1u)
            towards = normalize(towards - normals[at] * dot(towards, normals[at])) + 1e-7 * normals[at];
        const float r = probe.reach * (0.01 + random01());
        const float radius = 0.1 * r * random01();
        // Without `precise` a compiler may find that the difference is what was added.
        precise const vec3 centre = moved[at] + towards * r * (1.0 - 4e-7 * random01());
        precise const vec3 toLight = centre - moved[at];
        const float r2 = r * r;
        if (length2(toLight) < r2 && dot(normals[at], toLight) > -radius) {
            ++result.reaching;
            result.missed += touches(widened, centre, radius, r2) ? 0u : 1u;
            result.missedIfNotWidened += touches(cluster, centre, radius, r2) ? 0u : 1u;
        }
        const float above = invariantDot(normals[at], toLight);
        if (length2(toLight) < r2 && above > 0.0) {
            const float radii = k % 2u == 0u ? 1.0 : ABOVE_FROM;
            const float fitting = above / radii;
            const float tooLarge = fitting * (1.0 + 3e-7 + 1e-6 * random01());
            result.tooHigh += isHigh(widened, centre, tooLarge, r2, radii) ? 1u : 0u;
            result.high += isHigh(widened, centre, 0.99 * fitting, r2, radii) ? 1u : 0u;
        }
    }
    outputs[i] = result;
}
