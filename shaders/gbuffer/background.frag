// SPDX-License-Identifier: Apache-2.0
// The background, drawn where the depth is clear, which it leaves so.
#version 460
#extension GL_GOOGLE_include_directive : require
#include "gbuffer/output.glsl"
#include "gbuffer/rays.glsl"

layout(push_constant, scalar) uniform Push
{
    BackgroundParams params;
};

void main()
{
    gl_FragDepth = farDepth();
    writeBackground(params.luminance);
}
