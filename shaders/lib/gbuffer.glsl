// SPDX-License-Identifier: Apache-2.0
// Packing and unpacking of both G-buffer layouts. A host that fills the G-buffer itself includes this
// file. The widths in bits and the error bounds are in shared/gbuffer.h.
#ifndef CND_LIB_GBUFFER_GLSL
#define CND_LIB_GBUFFER_GLSL

#include "shared/gbuffer.h"

struct Surface {
    vec3 normal;      // unit, view space
    vec3 albedo;      // diffuse, 0..1, already scaled by 1 - metalness
    vec3 F0;          // Fresnel reflectance at normal incidence, 0..1
    float specularWeight;      // Schlick's F90, 0..1; 0: no specular lobe
    float perceptualRoughness; // 0..1; alpha is its square
};

// Maps a direction onto [-1, 1]^2 by way of an octahedron (Meyer et al. 2010, "On floating-point normal
// vectors"). `n` must not be zero; it need not be normalised.
vec2 encodeOctahedral(vec3 n)
{
    const vec2 p = n.xy / (abs(n.x) + abs(n.y) + abs(n.z));
    const vec2 s = vec2(p.x >= 0.0 ? 1.0 : -1.0, p.y >= 0.0 ? 1.0 : -1.0);
    return n.z >= 0.0 ? p : (1.0 - abs(p.yx)) * s;
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
    const ivec2 k = ivec2(round(clamp(encodeOctahedral(n), -1.0, 1.0) * scale));
    return uvec2(k) & ((1u << bits) - 1u);
}

vec3 dequantizeOctahedral(uvec2 codes, uint bits)
{
    const float scale = float((1u << (bits - 1u)) - 1u);
    const int unused = int(32u - bits);
    const ivec2 k = (ivec2(codes) << unused) >> unused; // sign extension
    return decodeOctahedral(vec2(k) / scale);
}

// Angle error <= NORMAL_ERROR_FULL, roughness error <= ROUGHNESS_ERROR_FULL.
uvec2 packNormalRoughnessFull(vec3 normal, float perceptualRoughness)
{
    const uint roughness = uint(round(clamp(perceptualRoughness, 0.0, 1.0) * 65535.0));
    const uvec2 codes = quantizeOctahedral(normal, NORMAL_BITS_FULL);
    return codes | uvec2(roughness << 24, (roughness >> 8) << 24);
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
    return dequantizeOctahedral(normalRoughness & 0xFFFFFFu, NORMAL_BITS_FULL);
}

Surface unpackGBufferFull(uvec2 normalRoughness, vec4 albedo, vec4 specular)
{
    Surface s;
    s.normal = dequantizeOctahedral(normalRoughness & 0xFFFFFFu, NORMAL_BITS_FULL);
    s.perceptualRoughness =
        float((normalRoughness.x >> 24) | ((normalRoughness.y >> 24) << 8)) / 65535.0;
    s.albedo = albedo.rgb;
    s.F0 = specular.rgb;
    s.specularWeight = specular.a;
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
