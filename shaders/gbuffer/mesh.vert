// SPDX-License-Identifier: Apache-2.0
// Draws instanced triangle meshes. View-space positions are computed from a difference of double-single
// positions, so they are as precise 1000 km from the world's origin as at the origin.
#version 460
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_samplerless_texture_functions : require
#include "lib/camera_relative.glsl"
#include "gbuffer/mesh_varyings.glsl"
#include "gbuffer/material_record.glsl"
#include "lib/gbuffer.glsl"
#include "shared/raster.h"

layout(push_constant, scalar) uniform Push
{
    MeshParams params;
};
layout(binding = MESH_INSTANCES) uniform textureBuffer instances;

layout(location = MESH_POSITION) in vec3 position; // object space
layout(location = MESH_NORMAL_IN) in vec3 normal;
#ifdef SAMPLED
layout(location = MESH_TANGENT) in vec4 tangent; // w: handedness
layout(location = MESH_UV) in vec4 uv; // both uv sets
#endif
#ifndef CONSTANT
layout(location = MESH_COLOR) in vec4 color;
#endif
layout(location = MESH_INSTANCE) in uint instance;

// Normalises a vector; a zero vector stays zero.
vec3 safeNormalize(vec3 v)
{
    return v * inversesqrt(max(dot(v, v), 1e-38)); // 1e-38 is close to the smallest normal float
}

void main()
{
    const int texel = int(instance * INSTANCE_TEXELS);
    const vec4 x = texelFetch(instances, texel);
    const vec4 y = texelFetch(instances, texel + 1);
    const vec4 z = texelFetch(instances, texel + 2);
    const vec4 last = texelFetch(instances, texel + 3);
    const uint material = uint(last.w);

    const mat3 worldFromObject = mat3(x.xyz, y.xyz, z.xyz);
    const vec3 origin = cameraRelative(vec3(x.w, y.w, z.w), last.xyz, params.cameraHi, params.cameraLo);
    const vec3 positionView = params.viewFromWorld * (origin + worldFromObject * position);
    gl_Position = params.clipFromView * vec4(positionView, 1.0);

    // Normals transform by the inverse transpose, which is cofactors / determinant. Only the sign of
    // the determinant (mirrored instances) matters for the direction.
    const mat3 cofactors = mat3(cross(y.xyz, z.xyz), cross(z.xyz, x.xyz), cross(x.xyz, y.xyz));
    const float handedness = dot(x.xyz, cofactors[0]) < 0.0 ? -1.0 : 1.0;
    varyingNormal = params.viewFromWorld * safeNormalize(handedness * (cofactors * normal));
#ifdef SAMPLED
    const vec3 tangentWorld = safeNormalize(worldFromObject * tangent.xyz);
    varyingTangent = vec4(params.viewFromWorld * tangentWorld, tangent.w * handedness);
    varyingUv = uv;
    varyingColor = color;
    varyingMaterial = uvec3(material, instance, params.coverageFrame);
#else
    MaterialSample m = plainMaterial(material);
#ifdef COLORED
    m.baseColor *= color.rgb;
    varyingAlbedo = diffuseAlbedo(m);
    varyingSpecular = packSpecularFull(normalReflectance(m), m.specularWeight);
#else
    varyingAlbedoSpecular = uvec4(packAlbedoFull(diffuseAlbedo(m)),
                                  packSpecularFull(normalReflectance(m), m.specularWeight));
#endif
    varyingMaterial = uvec3(material, packRoughnessFull(m.perceptualRoughness));
#endif
}
