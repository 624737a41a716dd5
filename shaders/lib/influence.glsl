// SPDX-License-Identifier: Apache-2.0
// Radii of influence from an error: where it is measured, and by what lights are told apart.
#ifndef CND_LIB_INFLUENCE
#define CND_LIB_INFLUENCE

#include "shared/influence.h"
#include "shared/lighting.h"
#include "lib/math.glsl"

uint evenBits(uint x)
{
    x &= 0x55555555u;
    x = (x | x >> 1u) & 0x33333333u;
    x = (x | x >> 2u) & 0x0F0F0F0Fu;
    x = (x | x >> 4u) & 0x00FF00FFu;
    return (x | x >> 8u) & 0xFFFFu;
}

// The pixel of a square whose turn it is; may be outside the image. Each has one of spacing^2 turns,
// and 4^k of them visit as many different parts. Squares begin with different pixels.
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

// The frame of the history that is at hand; 0 once only.
uint influenceFrame(InfluenceFrame f, InfluenceState previous)
{
    return previous.owner == f.owner ? max(previous.frame + 1u, 1u) : 0u;
}

// Whose turn it is: those of the first frame are its rounds.
uint influenceTurn(InfluenceFrame f, InfluenceState previous, uint round)
{
    const uint frame = influenceFrame(f, previous);
    return frame == 0u ? round : f.rounds + frame - 1u;
}

// Largest intensity in cd, in any direction and of the strongest channel, of a light that has a
// position. `emission` is CndLight::emission. Types that are not named here get the intensity of a
// sphere of the bounding radius, which no convex emitter exceeds.
float peakIntensity(uint type, vec3 emission, float boundingRadius, LightShape shape)
{
    const float e = max(emission.x, max(emission.y, emission.z));
    switch (type) {
    case LIGHT_POINT:
    case LIGHT_SPOT:
        return e;
    case LIGHT_TUBE:
        return e * shape.radius * (4.0 * length(shape.axisU) + PI * shape.radius);
    case LIGHT_RECTANGLE:
        return e * 4.0 * length(shape.axisU) * length(shape.axisV);
    default:
        return e * (PI * boundingRadius * boundingRadius);
    }
}

// The bin of a light whose exposed illuminance this is.
uint influenceBin(float exposedIlluminance)
{
    const float octaves = log2(max(exposedIlluminance, 1e-30)) - INFLUENCE_FINEST;
    const float bin = float(INFLUENCE_COARSE_BINS) + (octaves < 0.0 ? 0.5 : 2.0) * octaves;
    return uint(clamp(bin, 0.0, float(INFLUENCE_BINS - 1u)));
}

// Exposed illuminance that cut b > 0 cuts at.
float influenceThreshold(uint cut)
{
    const float bins = float(cut) - float(INFLUENCE_COARSE_BINS);
    return exp2((bins < 0.0 ? 2.0 : 0.5) * bins + INFLUENCE_FINEST);
}

#endif
