// SPDX-License-Identifier: Apache-2.0
// Radii of influence from an error bound (shared/influence_data.h): which pixels are measured, and
// which bin a light belongs to.
#ifndef CND_LIB_INFLUENCE
#define CND_LIB_INFLUENCE

#include "shared/influence_data.h"
#include "shared/lighting_data.h"
#include "lib/math.glsl"

// Returns the bits 0, 2, 4 ... of x as one number.
uint evenBits(uint x)
{
    x &= 0x55555555u;
    x = (x | x >> 1u) & 0x33333333u;
    x = (x | x >> 2u) & 0x0F0F0F0Fu;
    x = (x | x >> 4u) & 0x00FF00FFu;
    return (x | x >> 8u) & 0xFFFFu;
}

// Returns the pixel of a square that is measured in a turn. It may lie outside the image. Each pixel of
// the square has one of spacing^2 turns, and 4^k turns in a row measure one pixel in each of the 4^k
// equal parts of the square. Squares begin with different pixels.
uvec2 influencePixel(InfluenceFrame f, uint sampleIndex, uint turn)
{
    const uvec2 square = uvec2(sampleIndex % f.samples.x, sampleIndex / f.samples.x);
    const uint bits = 2u * uint(findLSB(f.spacing));
    const uint part = bitfieldReverse(turn) >> (32u - bits);
    uint start = square.x * 0x9E3779B9u ^ square.y * 0x85EBCA6Bu;
    start ^= start >> 15u;
    start = start * 0x2C1B3C6Du >> 8u;
    const uint at = part ^ (start & ((1u << bits) - 1u));
    return square * f.spacing + uvec2(evenBits(at), evenBits(at >> 1u));
}

// Returns the number of the present frame in its history. Only the first frame has the number 0, even
// when the number overflows.
uint influenceFrame(InfluenceFrame f, InfluenceState previous)
{
    return previous.owner == f.owner ? max(previous.frame + 1u, 1u) : 0u;
}

// Returns the turn to measure. The first frame of a history has one turn per round, later frames have
// one turn each.
uint influenceTurn(InfluenceFrame f, InfluenceState previous, uint round)
{
    const uint frame = influenceFrame(f, previous);
    return frame == 0u ? round : f.rounds + frame - 1u;
}

// Returns the largest intensity in cd, over all directions and in the strongest channel, of a light
// that has a position. `emission` is CndLight::emission. Types that are not named here get the
// intensity of a sphere of the bounding radius, which no convex emitter exceeds.
float peakIntensity(uint type, vec3 emission, float boundingRadius, LightShape shape)
{
    const float e = max(emission.x, max(emission.y, emission.z));
    const float disc = PI * boundingRadius * boundingRadius;
    switch (type) {
    case LIGHT_POINT:
    case LIGHT_SPOT:
        return e;
    case LIGHT_TUBE:
        return e * shape.radius * (4.0 * length(shape.axisU) + PI * shape.radius);
    case LIGHT_RECTANGLE:
        return e * 4.0 * length(shape.axisU) * length(shape.axisV);
    case LIGHT_POLYGON: // in the rectangle of its axes
        return e * min(4.0 * length(shape.axisU) * length(shape.axisV), disc);
    default:
        return e * disc;
    }
}

// Returns the bin of a light with this exposed illuminance.
uint influenceBin(float exposedIlluminance)
{
    const float octaves = log2(clamp(exposedIlluminance, 1e-30, 1e30)) - INFLUENCE_FINEST;
    const float bin = float(INFLUENCE_COARSE_BINS) + (octaves < 0.0 ? 0.5 : 2.0) * octaves;
    return uint(clamp(bin, 0.0, float(INFLUENCE_BINS - 1u)));
}

// Returns the exposed illuminance at which a cut > 0 ends the lights.
float influenceThreshold(uint cut)
{
    const float bins = float(cut) - float(INFLUENCE_COARSE_BINS);
    return exp2((bins < 0.0 ? 2.0 : 0.5) * bins + INFLUENCE_FINEST);
}

#endif
