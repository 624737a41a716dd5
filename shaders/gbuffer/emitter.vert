// SPDX-License-Identifier: Apache-2.0
// One quad per visible area light that covers the light's projection. It is perpendicular to the line
// of sight to the bounding sphere, as large as the tangent cone, at unit distance (only directions
// matter). Seen from inside that sphere or from very close it is the whole screen.
#version 460
#extension GL_GOOGLE_include_directive : require
#include "gbuffer/rays.glsl"

layout(constant_id = RASTER_SHAPE) const uint shape = LIGHT_SPHERE;

layout(location = EMITTER_POSITION) in vec4 positionAndRadius;
layout(location = EMITTER_LUMINANCE) in vec3 luminance;
layout(location = EMITTER_AXIS_U) in vec3 axisU;
layout(location = EMITTER_AXIS_V) in vec4 axisVAndTwoSided;
layout(location = EMITTER_CORNERS) in vec4 corners[EMITTER_CORNER_PAIRS];

// view-space centre, radius; distant sphere: direction, sine of its angular radius
layout(location = 0) flat out vec4 outCenter;
layout(location = 1) flat out vec3 outLuminance;
layout(location = 2) flat out vec3 outAxisU; // view space
layout(location = 3) flat out vec4 outAxisV; // view space; w: whether it is two-sided
layout(location = 4) flat out vec4 outCorners[EMITTER_CORNER_PAIRS]; // of a polygon, along its axes

// Angular rounding error of the quad and of pixel rays, with a safety factor of about 50.
const float MARGIN = 1e-5;

// Returns the radius of a sphere around the centre that holds the light: half the longer diagonal of
// the rectangle of its axes, which need not be exactly perpendicular, and its radius.
// (cndEmitterBoundingRadius takes the axes to be perpendicular.)
float boundingRadius()
{
    const vec3 u = (TYPES_WITH_AXIS_U >> shape & 1u) != 0u ? axisU : vec3(0.0);
    const vec3 v = (TYPES_WITH_AXIS_V >> shape & 1u) != 0u ? axisVAndTwoSided.xyz : vec3(0.0);
    const float radius = (TYPES_WITH_RADIUS >> shape & 1u) != 0u ? positionAndRadius.w : 0.0;
    return max(length(u + v), length(u - v)) + radius;
}

// Rasterisation moves every corner to a grid of at least 2^4 steps per pixel, by half a step along x
// and y. So an edge of the quad moves by less than this share of a pixel.
const float GRID = 1.0 / 16.0;

// Returns the longer side of a pixel: at unit distance, or in metres if the view is orthographic.
float pixelSide(bool perspective)
{
    const vec3 alongX = perspective ? frame.rayDirection[1] : frame.rayOrigin[1];
    const vec3 alongY = perspective ? frame.rayDirection[2] : frame.rayOrigin[2];
    const vec2 sides = 2.0 * vec2(length(alongX), length(alongY)) / frame.size; // ndc is 2 wide
    const float depth = perspective ? dot(frame.rayDirection[0], frame.forward) : 1.0;
    return max(sides.x, sides.y) / depth;
}

void main()
{
    const bool distant = (TYPES_WITH_POSITION >> shape & 1u) == 0u;
    const bool perspective = frame.perspective > 0.5;
    const vec3 rotated = frame.viewFromWorld * positionAndRadius.xyz;
    const vec3 center = distant ? rotated : frame.emitterOrigin + rotated;
    outCenter = vec4(center, positionAndRadius.w);
    outLuminance = luminance;
    outAxisU = frame.viewFromWorld * axisU;
    outAxisV = vec4(frame.viewFromWorld * axisVAndTwoSided.xyz, axisVAndTwoSided.w);
    for (uint i = 0u; i < EMITTER_CORNER_PAIRS; ++i)
        outCorners[i] = shape == LIGHT_POLYGON ? corners[i] : vec4(0.0);

    const vec2 corner = vec2(gl_VertexIndex & 1, gl_VertexIndex >> 1) * 2.0 - 1.0;
    const float radius = boundingRadius();
    const vec3 toCenter = distant ? center : center - frame.rayOrigin[0]; // seen from the eye
    const float distanceToCenter = length(toCenter);
    const float sinCone = radius / distanceToCenter;
    const vec3 axis = perspective ? toCenter / distanceToCenter : frame.forward;
    // Duff et al. 2017, "Building an orthonormal basis, revisited".
    const float s = axis.z >= 0.0 ? 1.0 : -1.0;
    const float a = -1.0 / (s + axis.z);
    const float b = axis.x * axis.y * a;
    const vec3 u = vec3(1.0 + s * axis.x * axis.x * a, s * b, -s * axis.x);
    const vec3 v = vec3(b, s + axis.y * axis.y * a, -axis.y);

    const float tanCone = sinCone / sqrt(max(1.0 - sinCone * sinCone, 1e-6));
    // A step of the grid is longer at the edge of the quad, which is seen at an angle.
    const float moved = GRID * pixelSide(perspective) * (perspective ? 1.0 + tanCone * tanCone : 1.0);
    const float halfSide = moved + (perspective ? tanCone * (1.0 + MARGIN) + MARGIN
                                                : radius + MARGIN * (radius + distanceToCenter));
    const vec3 positionView = (perspective ? frame.rayOrigin[0] + axis : center) +
                              halfSide * (corner.x * u + corner.y * v);
    gl_Position = frame.clipFromView * vec4(positionView, 1.0);
    // Larger quads than tan(cone) = 7 lose precision. In orthographic views all rays look at one point
    // of the sky.
    if (perspective ? !(sinCone < 0.99) : distant)
        gl_Position = vec4(corner, 0.0, 1.0);
    // Depth is written per pixel. This value is never clipped at the near or far end, and keeps w away
    // from 0.
    gl_Position.z = gl_Position.w - 1e-3;
}
