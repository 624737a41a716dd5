// SPDX-License-Identifier: Apache-2.0
#version 460
layout(push_constant) uniform Push
{
    mat4 clipFromWorld;
    mat3x4 worldFromMesh; // its columns are the rows of the transform
    vec4 albedo;
};
layout(location = 0) in vec3 position;
layout(location = 1) in vec3 normal;
layout(location = 0) out vec3 normalWorld;

void main()
{
    normalWorld = normalize(vec4(normal, 0.0) * worldFromMesh); // an axis of the box
    gl_Position = clipFromWorld * vec4(vec4(position, 1.0) * worldFromMesh, 1.0);
}
