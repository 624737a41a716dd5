// SPDX-License-Identifier: Apache-2.0
// Packing and unpacking of both G-buffer layouts. A host that fills the G-buffer itself includes this
// file. The widths in bits and the error bounds are in shared/gbuffer_data.h.
#ifndef CND_LIB_GBUFFER_GLSL
#define CND_LIB_GBUFFER_GLSL

#include "lib/portable_math.glsl"
#include "lib/surface.glsl"
#include "shared/gbuffer_data.h"

// Maps a direction onto [-1, 1]^2 by way of an octahedron (Meyer et al. 2010, "On floating-point normal
// vectors"). The same bits on every device. The length of `n` may be anything from 2^-99 to 2^99.
vec2 encodeOctahedral(vec3 n)
{
    precise const float sum = abs(n.x) + abs(n.y) + abs(n.z);
    precise const vec2 p = n.xy * portableReciprocal(sum);
    const vec2 s = vec2(p.x >= 0.0 ? 1.0 : -1.0, p.y >= 0.0 ? 1.0 : -1.0);
    precise const vec2 folded = (1.0 - abs(p.yx)) * s;
    return n.z >= 0.0 ? p : folded;
}

vec3 decodeOctahedral(vec2 p)
{
    vec3 n = vec3(p, 1.0 - abs(p.x) - abs(p.y));
    const float fold = max(-n.z, 0.0);
    n.x += n.x >= 0.0 ? -fold : fold;
    n.y += n.y >= 0.0 ? -fold : fold;
    return normalize(n);
}

uvec2 quantizeOctahedral(vec3 n, uint bits)
{
    const float scale = float((1u << (bits - 1u)) - 1u);
    precise const vec2 scaled = clamp(encodeOctahedral(n), -1.0, 1.0) * scale;
    const ivec2 k = ivec2(roundEven(scaled));
    return uvec2(k) & ((1u << bits) - 1u);
}

vec3 dequantizeOctahedral(uvec2 codes, uint bits)
{
    const float scale = float((1u << (bits - 1u)) - 1u);
    const int unused = int(32u - bits);
    const ivec2 k = (ivec2(codes) << unused) >> unused; // sign extension
    return decodeOctahedral(vec2(k) / scale);
}

// Returns the nearest unit floats (shared/gbuffer_data.h) with `mantissa` bits of mantissa. Values out
// of range are clamped, and NaN becomes 0.
uvec3 encodeUnitFloats(vec3 x, uint mantissa)
{
    const vec3 inRange = mix(vec3(0.0), min(x, 1.0), greaterThan(x, vec3(0.0)));
    const uint dropped = 23u - mantissa; // of the bits of a float's mantissa
    const uvec3 normal =
        (floatBitsToUint(inRange) - (119u << 23) + (1u << (dropped - 1u))) >> dropped;
    const uvec3 denormal = uvec3(roundEven(inRange * float(1u << (mantissa + 7u))));
    const uvec3 code = mix(normal, denormal, lessThan(inRange, vec3(UNIT_FLOAT_NORMAL)));
    return max(code, 1u) - 1u;
}

vec3 decodeUnitFloats(uvec3 codes, uint mantissa)
{
    const uvec3 bits = (codes + min(codes, 1u)) << (23u - mantissa);
    // The subtraction is exact.
    return mix(uintBitsToFloat(bits + (119u << 23)),
               uintBitsToFloat(bits + (120u << 23)) - UNIT_FLOAT_NORMAL,
               lessThan(bits, uvec3(1u << 23)));
}

// Returns the roughness in the bits that it has beside the normal.
uvec2 packRoughnessFull(float perceptualRoughness)
{
    const uint roughness = encodeUnitFloats(vec3(perceptualRoughness), ROUGHNESS_MANTISSA).x;
    return uvec2(roughness << 23, (roughness >> 9) << 23);
}

// Angle error <= NORMAL_ERROR_FULL, relative roughness error <= ROUGHNESS_ERROR_FULL.
uvec2 packNormalRoughnessFull(vec3 normal, float perceptualRoughness)
{
    return quantizeOctahedral(normal, NORMAL_BITS_FULL) | packRoughnessFull(perceptualRoughness);
}

uvec2 packColourFull(vec3 colour)
{
    const uvec3 codes = encodeUnitFloats(colour, COLOUR_MANTISSA);
    return uvec2(codes.r | codes.b << 21, codes.g | (codes.b >> 11) << 21);
}

vec3 unpackColourFull(uvec2 texel)
{
    const uvec3 codes = uvec3(texel & 0x1FFFFFu, texel.x >> 21 | ((texel.y >> 21) & 0x3FFu) << 11);
    return decodeUnitFloats(codes, COLOUR_MANTISSA);
}

// Relative error <= COLOUR_ERROR_FULL.
uvec2 packAlbedoFull(vec3 albedo)
{
    return packColourFull(albedo);
}

// Relative error of F0 <= COLOUR_ERROR_FULL if the specular weight is 1. Otherwise it is
// <= COLOUR_ERROR_FULL_SHORT, and the error of the specular weight <= F90_ERROR_FULL.
uvec2 packSpecularFull(vec3 F0, float specularWeight)
{
    if (specularWeight >= 1.0)
        return packColourFull(F0) | uvec2(0u, 1u << 31);
    const uvec3 codes = encodeUnitFloats(F0, COLOUR_MANTISSA_SHORT);
    const float weight = specularWeight > 0.0 ? specularWeight : 0.0; // not NaN
    const uint f90 = uint(roundEven(weight * float((1u << F90_BITS) - 1u)));
    return uvec2(codes.r | codes.g << 16, codes.b | f90 << 16);
}

// Angle error <= NORMAL_ERROR_COMPACT, roughness error <= ROUGHNESS_ERROR_COMPACT.
uint packNormalRoughnessCompact(vec3 normal, float perceptualRoughness)
{
    const uint roughness = uint(round(clamp(perceptualRoughness, 0.0, 1.0) * 255.0));
    const uvec2 codes = quantizeOctahedral(normal, NORMAL_BITS_COMPACT);
    return codes.x | (codes.y << NORMAL_BITS_COMPACT) | (roughness << 24);
}

// Returns the normal of either layout.
vec3 unpackNormal(uint layout_, uvec2 normalRoughness)
{
    if (layout_ == GBUFFER_LAYOUT_COMPACT)
        return dequantizeOctahedral(uvec2(normalRoughness.x,
                                          normalRoughness.x >> NORMAL_BITS_COMPACT) & 0xFFFu,
                                    NORMAL_BITS_COMPACT);
    return dequantizeOctahedral(normalRoughness & 0x7FFFFFu, NORMAL_BITS_FULL);
}

Surface unpackGBufferFull(uvec2 normalRoughness, uvec2 albedo, uvec2 specular)
{
    Surface s;
    s.normal = dequantizeOctahedral(normalRoughness & 0x7FFFFFu, NORMAL_BITS_FULL);
    const uint roughness = normalRoughness.x >> 23 | (normalRoughness.y >> 23) << 9;
    s.perceptualRoughness = decodeUnitFloats(uvec3(roughness), ROUGHNESS_MANTISSA).x;
    s.albedo = unpackColourFull(albedo);
    const bool isWhole = (specular.y >> 31) != 0u; // F90 is 1
    const uvec3 shortCodes = uvec3(specular.x & 0xFFFFu, specular.x >> 16, specular.y & 0xFFFFu);
    s.F0 = isWhole ? unpackColourFull(specular)
                   : decodeUnitFloats(shortCodes, COLOUR_MANTISSA_SHORT);
    s.specularWeight =
        isWhole ? 1.0 : float(specular.y >> 16) / float((1u << F90_BITS) - 1u);
    return s;
}

Surface unpackGBufferCompact(uint normalRoughness, vec4 albedo)
{
    Surface s;
    const uvec2 codes = uvec2(normalRoughness, normalRoughness >> NORMAL_BITS_COMPACT) & 0xFFFu;
    const float lit = codes.x == NORMAL_ROUGHNESS_UNLIT_COMPACT ? 0.0 : 1.0;
    s.normal = dequantizeOctahedral(codes, NORMAL_BITS_COMPACT);
    s.perceptualRoughness = float(normalRoughness >> 24) / 255.0;
    s.albedo = albedo.rgb * (1.0 - albedo.a) * lit;
    s.F0 = mix(vec3(DIELECTRIC_F0), albedo.rgb, albedo.a) * lit;
    s.specularWeight = lit;
    return s;
}

#endif
