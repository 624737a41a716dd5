// SPDX-License-Identifier: Apache-2.0
// Reads a G-buffer of any layout. The layout is a specialisation constant, so that code for other
// layouts is compiled away. The includer defines GBUFFER_NORMALS_ONLY if it reads nothing else. With
// CANDELABRA_READ_SURFACE the host defines candelabraReadSurface() for the custom layout. Pixels are
// those of the frame; texels are those of the host's images.
#extension GL_EXT_samplerless_texture_functions : require
#include "shared/host_gbuffer_data.h"
#include "kernels/common/frame_params.glsl"
#include "kernels/common/gbuffer_code.glsl"
#include "lib/gbuffer.glsl"

const uint gbufferLayout = gbufferCode & GBUFFER_LAYOUT_MASK;
const uint normalEncoding = (gbufferCode >> GBUFFER_NORMAL_SHIFT) & GBUFFER_NORMAL_MASK;
const bool normalsOfWorld = ((gbufferCode >> GBUFFER_WORLD_SHIFT) & 1u) != 0u;
const uint roughnessKind = (gbufferCode >> GBUFFER_ROUGHNESS_KIND_SHIFT) & GBUFFER_ROUGHNESS_KIND_MASK;
const bool specularColour = ((gbufferCode >> GBUFFER_SPECULAR_COLOUR_SHIFT) & 1u) != 0u;
const uint roughnessChannel = (gbufferCode >> GBUFFER_ROUGHNESS_SHIFT) & GBUFFER_CHANNEL_MASK;
const uint metalnessChannel = (gbufferCode >> GBUFFER_METALNESS_SHIFT) & GBUFFER_CHANNEL_MASK;
const uint f90Channel = (gbufferCode >> GBUFFER_F90_SHIFT) & GBUFFER_CHANNEL_MASK;

layout(binding = GBUFFER_PACKED_NORMAL) uniform utexture2D packedNormalImage;
layout(binding = GBUFFER_NORMAL) uniform texture2D normalImage;

// Returns the normal that the host stored, in its space and with any length.
vec3 storedNormal(vec4 texel)
{
    if (normalEncoding == GBUFFER_NORMAL_OCTAHEDRAL_UNORM)
        return decodeOctahedral(2.0 * texel.xy - 1.0);
    if (normalEncoding == GBUFFER_NORMAL_OCTAHEDRAL_SNORM)
        return decodeOctahedral(texel.xy);
    return normalEncoding == GBUFFER_NORMAL_UNORM ? 2.0 * texel.xyz - 1.0 : texel.xyz;
}

// Returns the normalised normal, or +z if it has no usable length.
vec3 unitNormal(vec3 n)
{
    const float length2 = dot(n, n);
    // The condition is false for NaN. The limits avoid denormals and infinity in the square root.
    return length2 > 1e-12 && length2 < 1e12 ? normalize(n) : vec3(0.0, 0.0, 1.0);
}

// Returns the unit normal in view space. It is computed as `precise`, so that every kernel gets the
// same bits.
vec3 hostNormal(vec4 texel)
{
    precise vec3 n = storedNormal(texel);
    if (normalsOfWorld) {
        const mat3 m = frameParams.viewFromWorld;
        precise vec3 turned = m[0] * n.x + m[1] * n.y + m[2] * n.z;
        n = turned;
    }
    return unitNormal(n);
}

#ifdef CANDELABRA_READ_SURFACE
// The host's function may read gbufferView.viewFromWorld and gbufferView.firstTexel, with its prefix
// (candelabra/compiler.h).
#define gbufferView frameParams

Surface candelabraReadSurface(ivec2 texel);

Surface customSurface(ivec2 texel)
{
    Surface s = candelabraReadSurface(texel);
    precise const vec3 n = s.normal;
    s.normal = unitNormal(n);
    s.perceptualRoughness = clamp(s.perceptualRoughness, 0.0, 1.0);
    return s;
}
#endif

vec3 readNormal(uvec2 pixel)
{
    const ivec2 texel = texelOf(pixel);
#ifdef CANDELABRA_READ_SURFACE
    if (gbufferLayout == GBUFFER_LAYOUT_CUSTOM)
        return customSurface(texel).normal;
#endif
    if (gbufferLayout == GBUFFER_LAYOUT_HOST)
        return hostNormal(texelFetch(normalImage, texel, 0));
    return unpackNormal(gbufferLayout, texelFetch(packedNormalImage, texel, 0).xy);
}

#ifndef GBUFFER_NORMALS_ONLY

layout(binding = GBUFFER_PACKED_ALBEDO) uniform utexture2D packedAlbedoImage;
layout(binding = GBUFFER_PACKED_SPECULAR) uniform utexture2D packedSpecularImage;
layout(binding = GBUFFER_ALBEDO) uniform texture2D albedoImage;
layout(binding = GBUFFER_SPECULAR) uniform texture2D specularImage;

struct HostTexels {
    vec4 normal, albedo, specular;
};

HostTexels readHostTexels(ivec2 texel)
{
    return HostTexels(texelFetch(normalImage, texel, 0), texelFetch(albedoImage, texel, 0),
                      texelFetch(specularImage, texel, 0));
}

float channelOf(HostTexels t, uint channel)
{
    const uint image = (channel - 1u) >> 2;
    const vec4 texel = image == 0u ? t.normal : image == 1u ? t.albedo : t.specular;
    return texel[(channel - 1u) & 3u];
}

// Returns the perceptual roughness that the host stored, which may be out of range.
float storedRoughness(HostTexels t)
{
    if (roughnessChannel == 0u)
        return frameParams.constantRoughness;
    const float stored = channelOf(t, roughnessChannel);
    if (roughnessKind == GBUFFER_ROUGHNESS_ALPHA)
        return stored < 0.0 ? stored : sqrt(stored);
    return roughnessKind == GBUFFER_ROUGHNESS_SMOOTHNESS ? 1.0 - stored : stored;
}

Surface hostSurface(HostTexels t)
{
    Surface s;
    s.normal = hostNormal(t.normal);
    s.perceptualRoughness = clamp(storedRoughness(t), 0.0, 1.0);
    if (specularColour) {
        s.albedo = t.albedo.rgb;
        s.F0 = t.specular.rgb;
        s.specularWeight = f90Channel == 0u ? 1.0 : channelOf(t, f90Channel);
        return s;
    }
    const float metalness =
        metalnessChannel == 0u ? frameParams.constantMetalness : channelOf(t, metalnessChannel);
    s.albedo = t.albedo.rgb * (1.0 - metalness);
    s.F0 = mix(vec3(frameParams.dielectricF0), t.albedo.rgb, metalness);
    s.specularWeight = 1.0;
    return s;
}

Surface readSurface(uvec2 pixel)
{
    const ivec2 texel = texelOf(pixel);
#ifdef CANDELABRA_READ_SURFACE
    if (gbufferLayout == GBUFFER_LAYOUT_CUSTOM)
        return customSurface(texel);
#endif
    if (gbufferLayout == GBUFFER_LAYOUT_HOST)
        return hostSurface(readHostTexels(texel));
    const uvec2 packedNormal = texelFetch(packedNormalImage, texel, 0).xy;
    if (gbufferLayout == GBUFFER_LAYOUT_COMPACT)
        return unpackGBufferCompact(packedNormal.x, texelFetch(albedoImage, texel, 0));
    return unpackGBufferFull(packedNormal, texelFetch(packedAlbedoImage, texel, 0).xy,
                             texelFetch(packedSpecularImage, texel, 0).xy);
}

#endif
