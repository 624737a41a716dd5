// SPDX-License-Identifier: Apache-2.0
#version 460
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_scalar_block_layout : require
#define SCENE_SET 0
#include "scene.glsl"

layout(location = 0) flat out uvec2 id; // of the object, and of the triangle among all triangles
// Only the plain G-buffer needs these.
layout(location = 1) out vec3 positionMesh;
layout(location = 2) out vec3 normalView;

void main()
{
    const Object object = objects[gl_InstanceIndex];
    const Vertex v = vertices[indices[gl_VertexIndex]];
    id = uvec2(gl_InstanceIndex, gl_VertexIndex / 3);
    positionMesh = v.position;
    normalView = viewFromWorld * (mat3(object.worldFromMesh) * v.normal);
    gl_Position = clipFromWorld * vec4(object.worldFromMesh * vec4(v.position, 1.0), 1.0);
}
