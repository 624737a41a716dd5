// SPDX-License-Identifier: Apache-2.0
// The responses that follow from the integrals along an outline.
#ifndef CND_LIB_OUTLINE_SHADING
#define CND_LIB_OUTLINE_SHADING

#include "lib/outline/outline.glsl"

struct OutlineResponse {
    float formFactor; // E / (pi L), 0..1
    vec2 specular;    // with F = 1 and with F = (1 - VoH)^5; 0 without a lobe
};

// Returns a / |a|, or 0 for a = 0. The squares of the components of a may be too small for a float.
vec3 unitDirection(vec3 a)
{
    const vec3 b = a / max(max(abs(a.x), abs(a.y)), max(abs(a.z), SMALLEST_ANGLE));
    return b * inversesqrt(max(length2(b), MIN_LENGTH2));
}

// Returns N . L over the emitter. Its mean is that of a cap of directions with the same vector
// irradiance: for a cap |f| is the squared sine of its half angle.
CapHeights outlineHeights(Outline k, vec3 f)
{
    CapHeights z;
    z.high = k.inside ? 1.0 : clamp(k.high, 0.0, 1.0);
    z.low = clamp(k.low, 0.0, z.high);
    const vec3 unit = unitDirection(f);
    const float cosine = sqrt(max(1.0 - dot(f, unit), 0.0));
    z.mean = clamp(0.5 * unit.z * (1.0 + cosine), z.low, z.high);
    return z;
}

// Returns the response to an outline that is complete.
OutlineResponse outlineResponse(ConicPoint p, Outline k)
{
    OutlineResponse o;
    const vec3 f = (0.5 * INV_PI) * k.diffuse;
    o.formFactor = saturate(f.z);
    o.specular = vec2(0.0);
    if (k.needs.lobe) {
        const CapHeights z = outlineHeights(k, f);
        const float v1 = k.v.x * unitDirection(vec3(f.xy, 0.0)).x;
        const vec3 Phi = (0.5 * INV_PI) * k.specular;
        // No half vector that reflects the eye to a direction above the horizon has a longer slope than
        // `longest`. Slivers may exceed it by rounding.
        const vec2 slope = k.alpha / max(Phi.z, SMALLEST_ANGLE) * Phi.xy;
        const float longest = (1.0 + k.v.x) / k.v.y;
        const float slope2 = max(dot(slope, slope), MIN_LENGTH2);
        const vec2 limited = slope * min(1.0, longest * inversesqrt(slope2));
        ConicRegion region;
        region.integral = saturate(Phi.z);
        region.av = k.v.x * limited.x;
        region.x2 = dot(limited, limited);
        region.mu = max(k.v.y + region.av, MIN_CONIC_MU);
        o.specular = shadeTwoNodes(p, region, lightHeights(p, z, v1));
    }
    return o;
}

#endif
