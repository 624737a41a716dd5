// SPDX-License-Identifier: Apache-2.0
// A host's shader that writes the G-buffer with the installed functions.
#version 460
#extension GL_GOOGLE_include_directive : require
#include "lib/gbuffer.glsl"

layout(location = 0) in vec3 normalView;
layout(location = 0) out uvec2 normalRoughness;
layout(location = 1) out uvec2 albedo;
layout(location = 2) out uvec2 specular;

void main()
{
    normalRoughness = cndPackNormalRoughnessFull(normalize(normalView), 0.5);
    albedo = cndPackAlbedoFull(vec3(0.8, 0.4, 0.2));
    specular = cndPackSpecularFull(vec3(0.04), 1.0);
}
