// SPDX-License-Identifier: Apache-2.0
// Writes the metallic-roughness material of a mesh (glTF 2.0, section 3.9 and appendix B) to the
// G-buffer. Shading normals that face away from the viewer are written unchanged: bending them here
// would hide the fault from the lighting, which clamps NoV.
#version 460
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_samplerless_texture_functions : require
#include "gbuffer/coverage.glsl"
#include "gbuffer/mesh_varyings.glsl"
#include "gbuffer/material_record.glsl"
#include "gbuffer/output.glsl"

#ifdef SAMPLED
layout(constant_id = RASTER_TEXTURES) const uint textures = 0u;
layout(constant_id = RASTER_COVERAGE) const uint coverage = COVERAGE_FULL;
layout(constant_id = RASTER_UNLIT) const bool unlit = false;
const bool hasBaseColor = (textures >> TEXTURE_BASE_COLOR & 1u) != 0u;
const bool hasMetallicRoughness = (textures >> TEXTURE_METALLIC_ROUGHNESS & 1u) != 0u;
const bool hasNormal = (textures >> TEXTURE_NORMAL & 1u) != 0u;
const bool hasEmissive = (textures >> TEXTURE_EMISSIVE & 1u) != 0u;

layout(binding = MESH_TEXTURES) uniform sampler2D baseColorTexture;
layout(binding = MESH_TEXTURES + 1u) uniform sampler2D metallicRoughnessTexture;
layout(binding = MESH_TEXTURES + 2u) uniform sampler2D normalTexture;
layout(binding = MESH_TEXTURES + 3u) uniform sampler2D emissiveTexture;

vec2 textureUv(uint slot)
{
    const vec4 u = materialTexel(varyingMaterial.x, MATERIAL_PLAIN_TEXELS + 2u * slot);
    const vec4 v = materialTexel(varyingMaterial.x, MATERIAL_PLAIN_TEXELS + 2u * slot + 1u);
    const vec3 uv = vec3(u.w > 0.5 ? varyingUv.zw : varyingUv.xy, 1.0);
    return vec2(dot(u.xyz, uv), dot(v.xyz, uv));
}

// glTF 2.0, 3.7.2.1: bitangent = cross(normal, tangent) * handedness, none of them renormalised after
// interpolation (Mikkelsen's convention).
vec3 perturbedNormal(float normalScale)
{
    const vec3 texel = texture(normalTexture, textureUv(TEXTURE_NORMAL)).xyz * 2.0 - 1.0;
    const vec3 bitangent = cross(varyingNormal, varyingTangent.xyz) * varyingTangent.w;
    return texel.x * normalScale * varyingTangent.xyz + texel.y * normalScale * bitangent +
           texel.z * varyingNormal;
}

// Returns the normal before it is normalised.
vec3 meshNormal()
{
    return hasNormal ? perturbedNormal(materialTexel(varyingMaterial.x, 1u).z) : varyingNormal;
}

// Returns whether a surface of that coverage is drawn at this pixel. The front and the back of a mesh
// are two layers.
bool isCovered(float alpha)
{
    if (coverage == COVERAGE_MASKED)
        return alpha >= materialTexel(varyingMaterial.x, 1u).w;
    if (coverage == COVERAGE_DITHERED)
        return alpha > coverageThreshold(uvec2(gl_FragCoord.xy), varyingMaterial.z,
                                         2u * varyingMaterial.y + (gl_FrontFacing ? 1u : 0u));
    return true;
}

// Writes the material with its textures, or discards the fragment.
void writeMaterial(vec3 normal)
{
    MaterialSample m = plainMaterial(varyingMaterial.x);
    vec4 color = varyingColor;
    if (hasBaseColor)
        color *= texture(baseColorTexture, textureUv(TEXTURE_BASE_COLOR));
    m.baseColor *= color.rgb;
    if (hasMetallicRoughness) {
        const vec4 texel = texture(metallicRoughnessTexture, textureUv(TEXTURE_METALLIC_ROUGHNESS));
        m.perceptualRoughness *= texel.g;
        m.metalness *= texel.b;
    }
    if (hasEmissive)
        m.emission *= texture(emissiveTexture, textureUv(TEXTURE_EMISSIVE)).rgb;
    if (!isCovered(color.a * materialTexel(varyingMaterial.x, 0u).a))
        discard;
#ifdef EMISSIVE
    if (unlit) {
        writeEmitter(normal, m.emission * color.rgb);
        return;
    }
#endif
    writeSurface(normal, m);
}
#else
vec3 meshNormal()
{
    return varyingNormal;
}

// Writes the material that the vertex shader has packed.
void writeMaterial(vec3 normal)
{
    outNormalRoughness = quantizeOctahedral(normal, NORMAL_BITS_FULL) | varyingMaterial.yz;
#ifdef COLORED
    outAlbedo = packAlbedoFull(varyingAlbedo);
    outSpecular = varyingSpecular;
#else
    outAlbedo = varyingAlbedoSpecular.xy;
    outSpecular = varyingAlbedoSpecular.zw;
#endif
#ifdef EMISSIVE
    outRadiance = vec4(materialTexel(varyingMaterial.x, 3u).rgb, 1.0);
#endif
}
#endif

void main()
{
    // A normal that has vanished (opposite vertex normals) is replaced by +z, which packs to finite
    // values. 1e-38 is close to the smallest normal float.
    vec3 normal = meshNormal();
    const float squaredLength = dot(normal, normal);
    normal = squaredLength > 1e-38 ? normal * inversesqrt(squaredLength) : vec3(0.0, 0.0, 1.0);
    writeMaterial(gl_FrontFacing ? normal : -normal);
}
