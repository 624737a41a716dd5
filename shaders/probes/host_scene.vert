// SPDX-License-Identifier: Apache-2.0
// Draws the walls of the scene that tests draw into G-buffers of hosts, one per instance. With FULL it
// goes with the fragment shader for the layout FULL, which needs no position.
#version 460
#extension GL_GOOGLE_include_directive : require
#include "shared/host_scene.h"

layout(scalar, binding = HOST_SCENE_BINDING) readonly buffer Scene
{
    HostScene scene;
};
#ifndef FULL
layout(location = 0) out vec3 positionWorld;
#endif
layout(location = 1) flat out uint wallIndex;

void main()
{
    const vec2 corners[6] = vec2[6](vec2(0.0, 0.0), vec2(1.0, 0.0), vec2(1.0, 1.0), vec2(0.0, 0.0),
                                    vec2(1.0, 1.0), vec2(0.0, 1.0));
    const vec2 at = corners[gl_VertexIndex];
    const HostSceneWall wall = scene.walls[gl_InstanceIndex];
    const vec3 position = wall.corner + at.x * wall.edgeU + at.y * wall.edgeV;
    wallIndex = gl_InstanceIndex;
    gl_Position = scene.clipFromWorld * vec4(position, 1.0);
#ifndef FULL
    positionWorld = position;
#endif
}
