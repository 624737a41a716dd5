// SPDX-License-Identifier: Apache-2.0
// Writes the metallic-roughness material of a mesh (glTF 2.0, section 3.9 and appendix B) to the
// G-buffer. Shading normals that face away from the viewer are written unchanged: bending them here
// would hide the fault from the lighting, which clamps NoV.
#version 460
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_samplerless_texture_functions : require
#include "gbuffer/output.glsl"

layout(constant_id = RASTER_DETAILED) const bool detailed = false;
layout(constant_id = RASTER_MASKED) const bool masked = false;

layout(binding = MESH_MATERIALS) uniform textureBuffer materials;
layout(binding = MESH_TEXTURES) uniform sampler2D baseColorTexture;
layout(binding = MESH_TEXTURES + 1u) uniform sampler2D metallicRoughnessTexture;
layout(binding = MESH_TEXTURES + 2u) uniform sampler2D normalTexture;
layout(binding = MESH_TEXTURES + 3u) uniform sampler2D emissiveTexture;

layout(location = 0) in vec3 inNormal;
layout(location = 1) flat in uint inMaterial;
layout(location = 2) in vec4 inTangent;
layout(location = 3) in vec4 inUv;
layout(location = 4) in vec4 inColor;

vec4 materialTexel(uint texel)
{
    return texelFetch(materials, int(inMaterial * MATERIAL_TEXELS + texel));
}

vec2 textureUv(uint slot)
{
    const vec4 u = materialTexel(MATERIAL_PLAIN_TEXELS + 2u * slot);
    const vec4 v = materialTexel(MATERIAL_PLAIN_TEXELS + 2u * slot + 1u);
    const vec3 uv = vec3(u.w > 0.5 ? inUv.zw : inUv.xy, 1.0);
    return vec2(dot(u.xyz, uv), dot(v.xyz, uv));
}

// glTF 2.0, 3.7.2.1: bitangent = cross(normal, tangent) * handedness, none of them renormalised after
// interpolation (Mikkelsen's convention).
vec3 perturbedNormal(float normalScale)
{
    const vec3 texel = texture(normalTexture, textureUv(TEXTURE_NORMAL)).xyz * 2.0 - 1.0;
    const vec3 bitangent = cross(inNormal, inTangent.xyz) * inTangent.w;
    return texel.x * normalScale * inTangent.xyz + texel.y * normalScale * bitangent +
           texel.z * inNormal;
}

void main()
{
    const vec4 base = materialTexel(0u);
    const vec4 rough = materialTexel(1u);
    const vec4 dielectric = materialTexel(2u);
    const vec4 emission = materialTexel(3u);
    MaterialSample m = MaterialSample(base.rgb, rough.x, rough.y, dielectric.rgb, dielectric.w,
                                      emission.w, emission.rgb);
    vec3 normal = inNormal;
    if (detailed) {
        const vec4 color = texture(baseColorTexture, textureUv(TEXTURE_BASE_COLOR)) * inColor;
        const vec4 texel = texture(metallicRoughnessTexture, textureUv(TEXTURE_METALLIC_ROUGHNESS));
        m.emission *= texture(emissiveTexture, textureUv(TEXTURE_EMISSIVE)).rgb;
        m.baseColor *= color.rgb;
        m.perceptualRoughness *= texel.g;
        m.metalness *= texel.b;
        normal = perturbedNormal(rough.z);
        if (masked && color.a * base.a < rough.w)
            discard;
    }
    // A normal that has vanished (opposite vertex normals) is replaced by +z, which packs to finite
    // values. 1e-38 is close to the smallest normal float.
    const float squaredLength = dot(normal, normal);
    normal = squaredLength > 1e-38 ? normal * inversesqrt(squaredLength) : vec3(0.0, 0.0, 1.0);
    writeSurface(gl_FrontFacing ? normal : -normal, m);
}
