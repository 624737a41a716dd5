// SPDX-License-Identifier: Apache-2.0
// Writes a G-buffer of the layout CND_GBUFFER_FULL, with which the sample compares.
#version 460
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_scalar_block_layout : require
#define SCENE_SET 0
#include "lib/gbuffer.glsl"
#include "scene.glsl"

layout(location = 0) flat in uvec2 id;
layout(location = 1) in vec3 positionMesh;
layout(location = 2) in vec3 normalView;
layout(location = 0) out uvec2 normalRoughness;
layout(location = 1) out uvec2 albedo;
layout(location = 2) out uvec2 specular;

void main()
{
    const Object object = objects[id.x];
    normalRoughness = cndPackNormalRoughnessFull(normalize(normalView), object.perceptualRoughness);
    albedo = cndPackAlbedoFull(albedoAt(object, positionMesh));
    specular = cndPackSpecularFull(vec3(0.04), 1.0);
}
