// SPDX-License-Identifier: Apache-2.0
// Tone mapping curves (exposed linear Rec.709 -> display linear [0, 1]) and the sRGB encoding.
#ifndef CND_LIB_TONE_MAP
#define CND_LIB_TONE_MAP

#include "shared/exposure_data.h"

// A value beyond the white of every curve, whose square is still a finite float.
const float WHITE_BEYOND = 1e15;

// Reinhard, Stark, Shirley, Ferwerda 2002, eq. 3, per channel.
vec3 toneMapReinhard(vec3 c)
{
    return c / (1.0 + c);
}

// Stephen Hill's fit of the ACES RRT and sRGB ODT (2017). The matrices are written in rows, as
// published, hence v * M.
vec3 toneMapAces(vec3 c)
{
    const mat3 rrt = mat3(0.59719, 0.35458, 0.04823, 0.07600, 0.90834, 0.01566, 0.02840, 0.13383,
                          0.83777);
    const mat3 odt = mat3(1.60475, -0.53108, -0.07367, -0.10208, 1.10813, -0.00605, -0.00327,
                          -0.07276, 1.07602);
    const vec3 v = c * rrt;
    const vec3 fit = (v * (v + 0.0245786) - 0.000090537) /
                     (v * (0.983729 * v + 0.4329510) + 0.238081);
    return clamp(fit * odt, 0.0, 1.0);
}

// Khronos PBR Neutral tone mapper specification, 2024. Below 0.8 - F90 it is the identity minus
// Fresnel's share; above, highlights are compressed and desaturated.
vec3 toneMapPbrNeutral(vec3 c)
{
    const float f90 = 0.04;
    const float start = 0.8 - f90;
    const float desaturation = 0.15;
    const float lowest = min(c.r, min(c.g, c.b));
    c -= lowest <= 2.0 * f90 ? lowest - lowest * lowest / (4.0 * f90) : f90;
    const float peak = max(c.r, max(c.g, c.b));
    if (peak <= start)
        return clamp(c, 0.0, 1.0);
    const float span = 1.0 - start;
    const float compressed = 1.0 - span * span / (peak + span - start);
    const float keep = 1.0 / (desaturation * (peak - compressed) + 1.0);
    return clamp(mix(vec3(compressed), c * (compressed / peak), keep), 0.0, 1.0);
}

// Troy Sobotka's AgX, base look, with Benjamin Wrensch's sixth-order fit of its curve (2023); the
// result is linearised with the exponent 2.2 of its display.
vec3 toneMapAgx(vec3 c)
{
    const mat3 inset =
        mat3(0.842479062253094, 0.0423282422610123, 0.0423756549057051, 0.0784335999999992,
             0.878468636469772, 0.0784336, 0.0792237451477643, 0.0791661274605434,
             0.879142973793104);
    const mat3 outset =
        mat3(1.19687900512017, -0.0528968517574562, -0.0529716355144438, -0.0980208811401368,
             1.15190312990417, -0.0980434501171241, -0.0990297440797205, -0.0989611768448433,
             1.15107367264116);
    const float minEv = -12.47393; // log2(0.18) - 10: from 10 stops below middle grey to 6.5 above
    const float maxEv = 4.026069;
    const vec3 ev = clamp(log2(max(inset * c, 1e-10)), minEv, maxEv);
    const vec3 x = (ev - minEv) / (maxEv - minEv);
    vec3 y = vec3(15.5);
    y = y * x - 40.14;
    y = y * x + 31.96;
    y = y * x - 6.868;
    y = y * x + 0.4298;
    y = y * x + 0.1191;
    y = y * x - 0.00232;
    return pow(clamp(outset * y, 0.0, 1.0), vec3(2.2));
}

// Returns the exposed radiance, where NaN and negative channels become 0 and infinity becomes
// WHITE_BEYOND. It tests the bits, because comparisons may be compiled as if there were no NaN.
vec3 expose(vec3 radiance, float exposure)
{
    const uvec3 bits = floatBitsToUint(radiance);
    const vec3 finite = uintBitsToFloat(min(bits, 0x7F7FFFFFu));
    const bvec3 unusable = greaterThan(bits, uvec3(0x7F800000u)); // sign set, or NaN
    return mix(min(finite * exposure, WHITE_BEYOND), vec3(0.0), unusable);
}

// Applies a curve, TONEMAP_*, to a colour that expose() has returned. The colour is multiplied by a
// constant first, so that every curve displays middle grey, 0.18, as 0.18. The constants are the value
// that the curve maps to 0.18, divided by 0.18: 1 / 0.82 for Reinhard, 0.22 / 0.18 for PBR Neutral, and
// found by bisection for the other two (engine/reference/tone_map.cpp).
vec3 toneMap(uint curve, vec3 c)
{
    switch (curve) {
    case TONEMAP_REINHARD:
        return toneMapReinhard(1.2195122 * c);
    case TONEMAP_ACES:
        return toneMapAces(1.4619268 * c);
    case TONEMAP_PBR_NEUTRAL:
        return toneMapPbrNeutral(1.2222222 * c);
    case TONEMAP_AGX:
        return toneMapAgx(0.8084178 * c);
    default:
        return min(c, 1.0);
    }
}

// The sRGB encoding of IEC 61966-2-1. Its power, 1.055 c^(1 / 2.4) - 0.055, is computed as a polynomial
// in the eighth root of c, which is cheaper than pow(). It gives 1 for 1, and is wrong by at most 6e-7,
// or 1.5e-4 of a step of 8 bits, rounding included.
vec3 encodeSrgb(vec3 c)
{
    const vec3 low = 12.92 * c;
    const vec3 s = sqrt(sqrt(sqrt(max(c, 0.0031308))));
    vec3 high = vec3(-0.0341025151);
    high = high * s + 0.313186996;
    high = high * s + 0.909054724;
    high = high * s - 0.16282395;
    high = high * s + 0.0328993162;
    high = high * s - 0.0582145699;
    return mix(high, low, lessThanEqual(c, vec3(0.0031308)));
}

// The inverse of the sRGB encoding.
vec3 decodeSrgb(vec3 encoded)
{
    const vec3 low = encoded / 12.92;
    const vec3 high = pow((max(encoded, 0.04045) + 0.055) / 1.055, vec3(2.4));
    return mix(high, low, lessThanEqual(encoded, vec3(0.04045)));
}

// Random bits for quantize(): the hash function pcg3d (Jarzynski and Olano 2020, "Hash Functions for
// GPU Rendering").
uvec3 ditherNoise(uvec3 v)
{
    v = v * 1664525u + 1013904223u;
    v.x += v.y * v.z;
    v.y += v.z * v.x;
    v.z += v.x * v.y;
    v ^= v >> 16u;
    v.x += v.y * v.z;
    v.y += v.z * v.x;
    v.z += v.x * v.y;
    return v;
}

// Rounds an encoded value in [0, 1] to a step 0..`last`, such as 255, with dither. The noise is
// triangular over two steps, which makes the mean and the variance of the error independent of the
// signal. Within half a step of the ends, where clipping would shift the mean, it is uniform over one
// step, so that black and white stay exact.
vec3 quantize(vec3 encoded, float last, uvec3 random)
{
    const vec3 value = last * encoded;
    const vec3 u = (vec3(random & 0xFFFFu) + 0.5) / 65536.0;
    const vec3 v = (vec3(random >> 16u) + 0.5) / 65536.0;
    const bvec3 atEnd = greaterThan(abs(value - 0.5 * last), vec3(0.5 * last - 0.5));
    const vec3 noise = mix(u + v - 1.0, u - 0.5, atEnd);
    return clamp(floor(value + noise + 0.5), 0.0, last);
}

vec3 quantize(vec3 encoded, float last)
{
    return floor(last * encoded + 0.5);
}

#endif
