// SPDX-License-Identifier: Apache-2.0
// One triangle that covers the screen. The scissor limits the triangle to the pixels near a ball.
#version 460

void main()
{
    const vec2 corner = vec2(gl_VertexIndex & 1, gl_VertexIndex >> 1);
    // any depth will do: the fragment shader writes its own
    gl_Position = vec4(corner * 4.0 - 1.0, 0.5, 1.0);
}
