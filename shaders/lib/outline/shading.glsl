// SPDX-License-Identifier: Apache-2.0
// The responses that follow from the integrals along an outline.
#ifndef CND_LIB_OUTLINE_SHADING
#define CND_LIB_OUTLINE_SHADING

#include "lib/outline/bands.glsl"
#include "lib/outline/thin.glsl"

// How the directions to a whole light, without regard to the horizon, spread around the direction to
// its centre.
struct OutlineExtent {
    // The mean of the two principal variances over their geometric mean, minus 1: 0 for a light that
    // appears round, 0.25 for one that appears twice as long as wide.
    float elongation;
    // The mean of the two principal variances minus their geometric mean, in rad^2.
    float excess;
    // Variance of n . l, and its covariance with the displacement perpendicular to lc and to the normal
    // (along the cross product of the normal and lc).
    float heightVariance, slant;
};

// Variance of a light's points along an axis, over the squared half axis: 1/3 for a rectangle, 1/4 for
// a disc.
const float AXIS_VARIANCE = 0.3;
const float MAX_ELONGATION = 1000.0; // that of flat lights seen from the side has no bound

// Replaces CONIC_LIGHT_SPREAD, that of a disc, in bands, over which N . L is spread more evenly.
const float BAND_SPREAD = 0.26;

// Returns the extent of a light with the half axes u and v and the radius sqrt(r2) in all directions.
// With u' and v' for the parts perpendicular to lc, the covariance of its directions is
//   AXIS_VARIANCE (u' u'^T + v' v'^T + r2) / distance^2.
// The divisor limits it for lights that are closer than they are wide.
OutlineExtent extentOf(Outline k, vec3 u, vec3 v, float r2)
{
    const float axes2 = length2(u) + length2(v) + 2.0 * r2;
    const float inv = inversesqrt(max(k.distance * k.distance + AXIS_VARIANCE * axes2, MIN_LENGTH2));
    const vec3 a = inv * (u - dot(k.lc, u) * k.lc), b = inv * (v - dot(k.lc, v) * k.lc);
    const float round2 = inv * inv * r2;
    const float sum = length2(a) + length2(b);
    const float area = dot(k.lc, cross(a, b));
    const float product = max(area * area + round2 * (sum + round2), 1e-30);
    const float mean = 0.5 * sum + round2;
    const float across2 = dot(k.lc.xy, k.lc.xy);
    const vec2 aside = inversesqrt(max(across2, MIN_LENGTH2)) * vec2(-k.lc.y, k.lc.x);
    OutlineExtent o;
    o.elongation = clamp(mean * inversesqrt(product) - 1.0, 0.0, MAX_ELONGATION);
    o.excess = max(AXIS_VARIANCE * (mean - sqrt(product)), 0.0);
    o.heightVariance = AXIS_VARIANCE * (a.z * a.z + b.z * b.z + round2 * across2);
    o.slant = AXIS_VARIANCE * (a.z * dot(aside, a.xy) + b.z * dot(aside, b.xy));
    return o;
}

// A band of a light (bands.glsl), or a whole light.
struct OutlineBand {
    vec3 f, Phi;     // sums of outline.glsl, without their factor 2 pi
    float low, high; // lowest and highest N . L
    float cut;       // 0 for a whole light, 1 for the bands of a light that crosses the horizon
};

// Returns N . L over a band. The mean of the directions is along f. For a cap of directions |f| is
// the squared sine of its half angle, and the length of the mean is 1 - (1 - cos) / 2. For small lights
// the second term is half the variance of their directions, and for a given |f|, which is the area,
// that grows with the elongation. A light that fills the hemisphere is round.
CapHeights bandHeights(OutlineBand band, OutlineExtent extent)
{
    CapHeights z;
    z.high = clamp(band.high, 0.0, 1.0);
    z.low = clamp(band.low, 0.0, z.high);
    const vec3 unit = unitDirection(band.f);
    const float cosine2 = max(1.0 - dot(band.f, unit), 0.0);
    // No light is shortened more than a hemisphere. The elongation of large lights nearby exceeds that.
    const float shorter =
        min(0.5 - 0.5 * sqrt(cosine2) + extent.excess * cosine2, 0.5);
    z.mean = clamp(unit.z * (1.0 - shorter), z.low, z.high);
    return z;
}

// Returns N . L over the emitter as wide lobes see it. `azimuth`: unit vector along the mean direction
// in the plane of the surface.
LightHeights outlineLightHeights(ConicPoint p, Outline k, OutlineExtent extent, CapHeights z,
                                 OutlineBand band, vec2 azimuth)
{
    const HeightNodes nodes = heightNodes(z, mix(CONIC_LIGHT_SPREAD, BAND_SPREAD, band.cut));
    // Directions of a slanting light that are higher than the mean are displaced aside, on average by
    // the covariance over the variance of n . l (linear regression). The divisor is at least the
    // squared distance of the nodes from the mean, so that no node is displaced beyond the light.
    const float spread = z.mean - nodes.low;
    const float perHeight = extent.slant / max(max(extent.heightVariance, spread * spread), 1e-20);
    const vec2 v = k.v.x * vec2(azimuth.x, -azimuth.y); // along the azimuth and aside
    const float lowAside = perHeight * (nodes.low - z.mean);
    const float highAside = perHeight * (nodes.high - z.mean);
    return weighHeights(p, z, nodes, squaredReach(v, nodes.low, lowAside),
                        squaredReach(v, nodes.high, highAside));
}

// An outline that is complete. It and the response are two steps, because what the second one reads of
// the receiver need not occupy registers during the first one.
struct WalkedOutline {
    Outline k;
    OutlineExtent extent;
    bool seen;  // the receiver sees a side that emits
    float most; // upper bound of the form factor
    float dim;  // share of the response that remains, less than 1 if the light was widened (thin.glsl)
};

// Returns the elongation of a band, which differs from that of the whole light. A band is taken for a
// parallelogram with two horizontal sides and the area pi |f|.
float bandElongation(OutlineBand band, OutlineExtent extent, CapHeights z)
{
    const float height = max(0.5 * (z.high - z.low), 1e-6);
    const float width = 0.25 * PI * sqrt(length2(band.f)) / height;
    const float slope = extent.slant / max(extent.heightVariance, 1e-20);
    const float axes2 = height * height * (1.0 + slope * slope) + width * width;
    const float elongation =
        min(axes2 / max(2.0 * height * width, 1e-30) - 1.0, MAX_ELONGATION);
    return mix(extent.elongation, max(elongation, 0.0), band.cut);
}

// Returns the specular response to a band.
vec2 bandResponse(ConicPoint p, Outline k, OutlineExtent extent, OutlineBand band)
{
    const CapHeights z = bandHeights(band, extent);
    // A light around the normal has no azimuth. The eye's direction is then taken as aside.
    const vec2 aside = unitDirection(vec3(band.f.xy, 0.0)).xy;
    const vec2 azimuth = dot(aside, aside) > 0.0 ? aside : vec2(0.0, 1.0);
    // No half vector that reflects the eye to a direction above the horizon has a longer slope than
    // `longest`. Slivers may exceed it by rounding.
    const vec2 slope = k.alpha / max(band.Phi.z, SMALLEST_ANGLE) * band.Phi.xy;
    const float longest = (1.0 + k.v.x) / k.v.y;
    const float slope2 = max(dot(slope, slope), MIN_LENGTH2);
    const vec2 limited = slope * min(1.0, longest * inversesqrt(slope2));
    ConicRegion region;
    region.integral = saturate(band.Phi.z);
    region.av = k.v.x * limited.x;
    region.x2 = dot(limited, limited);
    region.mu = max(k.v.y + region.av, MIN_CONIC_MU);
    const LightHeights asSeen = outlineLightHeights(p, k, extent, z, band, azimuth);
    // A light that fills much of the hemisphere is round, as in bandHeights.
    const float elongation =
        bandElongation(band, extent, z) * max(1.0 - sqrt(length2(band.f)), 0.0);
    return shadeTwoNodes(p, region, asSeen, elongation);
}

// Returns the response to an outline.
LightResponse outlineResponse(ConicPoint p, WalkedOutline walked)
{
    const Outline k = walked.k;
    LightResponse o;
    o.formFactor = saturate((0.5 * INV_PI) * (k.diffuse.z + k.lowerDiffuse.z));
    o.specular = vec2(0.0);
    if (k.needs.lobe) {
        const float scale = 0.5 * INV_PI;
        const bool hasLower = hasLowerBand(k);
        const float lowerHigh = sqrt(dot(k.tilt, k.tilt));
        const float cut = hasLower ? saturate(1.0 - k.lowerLow / lowerHigh) : 0.0;
        OutlineBand band = OutlineBand(scale * k.diffuse, scale * k.specular, k.low,
                                       k.inside ? 1.0 : k.high, cut);
        uint bands = hasLower ? 2u : 1u;
        do {
            o.specular += bandResponse(p, k, walked.extent, band);
            band = OutlineBand(scale * k.lowerDiffuse, scale * k.lowerSpecular, k.lowerLow,
                               lowerHigh, cut);
            --bands;
        } while (bands > 0u);
        o.specular = min(o.specular, vec2(1.0));
    }
    if (walked.most < 1.0) {
        const float limit = min(walked.most / max(o.formFactor, MIN_LENGTH2), 1.0);
        o.formFactor *= limit;
        o.specular *= limit;
    }
    const float scale = walked.seen ? walked.dim : 0.0;
    return LightResponse(scale * o.formFactor, scale * o.specular);
}

#endif
