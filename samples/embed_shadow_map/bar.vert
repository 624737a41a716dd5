// SPDX-License-Identifier: Apache-2.0
// A bar of the window frame, as two triangles, seen from the lamp.
#version 460
layout(push_constant) uniform Parameters
{
    mat4 clipFromWorld;
    vec4 bar; // smallest x and y, largest x and y, metres
    float z;
};

void main()
{
    const vec2 corner = vec2(gl_VertexIndex & 1, gl_VertexIndex >> 1);
    gl_Position = clipFromWorld * vec4(mix(bar.xy, bar.zw, corner), z, 1.0);
}
