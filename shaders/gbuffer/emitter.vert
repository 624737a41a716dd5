// SPDX-License-Identifier: Apache-2.0
// One quad per visible area light that covers the light's projection. Compiled with BALL for spheres,
// distant ones too, and without for all other shapes, because llvmpipe interpolates unused varyings as
// well.
#version 460
#extension GL_GOOGLE_include_directive : require
#include "gbuffer/emitter_quad.glsl"

layout(constant_id = RASTER_SHAPE) const uint shape = LIGHT_SPHERE;

layout(location = EMITTER_POSITION) in vec4 positionAndRadius;
layout(location = EMITTER_LUMINANCE) in vec3 luminance;
layout(location = EMITTER_AXIS_U) in vec3 axisU;
layout(location = EMITTER_AXIS_V) in vec4 axisVAndTwoSided;
#ifndef BALL
layout(location = EMITTER_CORNERS) in vec4 corners[EMITTER_CORNER_PAIRS];
#endif

// view-space centre, radius; distant sphere: direction, sine of its angular radius
layout(location = 0) flat out vec4 outCenter;
layout(location = 1) flat out vec3 outLuminance;
#ifndef BALL
layout(location = 2) flat out vec3 outAxisU; // view space
layout(location = 3) flat out vec4 outAxisV; // view space; w: whether it is two-sided
layout(location = 4) flat out vec4 outCorners[EMITTER_CORNER_PAIRS]; // of a polygon, along its axes
#endif

void main()
{
    const vec3 center = emitterCenter(shape, positionAndRadius.xyz);
    outCenter = vec4(center, positionAndRadius.w);
    outLuminance = luminance;
#ifndef BALL
    outAxisU = frame.viewFromWorld * axisU;
    outAxisV = vec4(frame.viewFromWorld * axisVAndTwoSided.xyz, axisVAndTwoSided.w);
    for (uint i = 0u; i < EMITTER_CORNER_PAIRS; ++i)
        outCorners[i] = shape == LIGHT_POLYGON ? corners[i] : vec4(0.0);
#endif

    const vec2 corner = vec2(gl_VertexIndex & 1, gl_VertexIndex >> 1) * 2.0 - 1.0;
    const EmitterQuad quad =
        emitterQuad(shape, center,
                    emitterBoundingRadius(shape, axisU, axisVAndTwoSided.xyz, positionAndRadius.w));
    gl_Position = frame.clipFromView * vec4(quadCorner(quad, corner), 1.0);
    if (quad.fillsScreen)
        gl_Position = vec4(corner, 0.0, 1.0);
    // Depth is written per pixel. This value is never clipped at the near or far end, and keeps w away
    // from 0.
    gl_Position.z = gl_Position.w - 1e-3;
}
