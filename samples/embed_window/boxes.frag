// SPDX-License-Identifier: Apache-2.0
// Writes the host's own G-buffer: world-space normals, base colour, roughness and metalness.
#version 460
layout(push_constant) uniform Push
{
    mat4 clipFromWorld;
    vec4 centre;
    vec4 halfSize;
    vec4 baseColour;
};
layout(location = 0) in vec3 normalWorld;
layout(location = 0) out vec4 outNormal;
layout(location = 1) out vec4 outBaseColour;
layout(location = 2) out vec2 outRoughnessMetalness;

void main()
{
    outNormal = vec4(0.5 + 0.5 * normalWorld, 0.0);
    outBaseColour = vec4(baseColour.rgb, 1.0);
    outRoughnessMetalness = vec2(centre.w, halfSize.w);
}
