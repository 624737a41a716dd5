// SPDX-License-Identifier: Apache-2.0
#version 460
layout(push_constant) uniform Push
{
    mat4 clipFromWorld;
    mat3x4 worldFromMesh;
    vec4 albedo;
};
layout(location = 0) in vec3 normalWorld;
layout(location = 0) out vec4 outNormal;
layout(location = 1) out vec4 outAlbedo;
layout(location = 2) out vec4 emission; // into the radiance image

void main()
{
    outNormal = vec4(normalWorld, 0.0);
    outAlbedo = albedo;
    emission = vec4(0.0);
}
