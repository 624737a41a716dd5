// SPDX-License-Identifier: Apache-2.0
// A wall two metres in front of the eye that fills the picture.
#version 460

void main()
{
    const vec2 corner = vec2(gl_VertexIndex & 1, gl_VertexIndex >> 1) * 4.0 - 1.0;
    gl_Position = vec4(corner, 0.1, 2.0); // reversed depth: near plane / distance
    gl_Position.xy *= gl_Position.w;
}
