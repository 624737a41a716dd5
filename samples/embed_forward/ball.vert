// SPDX-License-Identifier: Apache-2.0
// A triangle that covers the whole frame; the fragment shader finds the ball.
#version 460

void main()
{
    const vec2 corner = vec2(gl_VertexIndex & 1, gl_VertexIndex >> 1);
    gl_Position = vec4(4.0 * corner - 1.0, 0.5, 1.0);
}
