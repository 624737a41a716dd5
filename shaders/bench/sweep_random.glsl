// SPDX-License-Identifier: Apache-2.0
// Random numbers for sweep_inputs.comp. They are counter-based, so that an index determines a
// configuration.
#ifndef CND_BENCH_SWEEP_RANDOM
#define CND_BENCH_SWEEP_RANDOM

#include "lib/math.glsl"

uint sweepState;

// The PCG hash of Jarzynski and Olano 2020, "Hash functions for GPU rendering".
uint sweepHash(uint x)
{
    const uint state = x * 747796405u + 2891336453u;
    const uint word = ((state >> ((state >> 28u) + 4u)) ^ state) * 277803737u;
    return (word >> 22u) ^ word;
}

void seedSweep(uint seed, uint slice, uint index)
{
    sweepState = sweepHash(index ^ sweepHash(slice ^ sweepHash(seed)));
}

uint randomBits()
{
    sweepState = sweepHash(sweepState + 0x9E3779B9u);
    return sweepState;
}

// Returns a number in [0, 1]; both ends can occur.
float random01()
{
    return float(randomBits() >> 8u) * (1.0 / 16777215.0);
}

float randomRange(float low, float high)
{
    return mix(low, high, random01());
}

float randomLog10(float low, float high)
{
    return pow(10.0, randomRange(low, high));
}

bool chance(float probability)
{
    return random01() < probability;
}

uint randomBelow(uint count)
{
    return (randomBits() >> 4u) % count;
}

float randomSign()
{
    return chance(0.5) ? 1.0 : -1.0;
}

// Directions are normalised, because sin() and cos() may be wrong by 2^-11 on some devices, and the
// G-buffer holds unit normals.

vec3 randomDirection()
{
    const float z = randomRange(-1.0, 1.0);
    const float angle = 2.0 * PI * random01();
    const float r = sqrt(max(1.0 - z * z, 0.0));
    return normalize(vec3(r * cos(angle), r * sin(angle), z));
}

// Returns zero, about an ulp, or a little more: a difference between equal or nearly equal values.
float hair()
{
    const uint which = randomBelow(4u);
    const float low = which == 1u ? -7.5 : -6.0;
    const float high = which == 3u ? -1.0 : -5.0;
    return which == 0u ? 0.0 : randomSign() * randomLog10(low, high);
}

vec3 besides(vec3 direction)
{
    return normalize(direction + hair() * randomDirection());
}

// Returns a direction with this cosine to n, at a random azimuth.
vec3 directionAt(vec3 n, float cosine)
{
    const vec3 any = abs(n.z) < 0.9 ? vec3(0.0, 0.0, 1.0) : vec3(1.0, 0.0, 0.0);
    const vec3 u = normalize(cross(n, any));
    const vec3 w = cross(n, u);
    const float angle = 2.0 * PI * random01();
    const float c = clamp(cosine, -1.0, 1.0);
    const float s = sqrt(max(1.0 - c * c, 0.0));
    return normalize(c * n + s * (cos(angle) * u + sin(angle) * w));
}

#endif
