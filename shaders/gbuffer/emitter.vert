// SPDX-License-Identifier: Apache-2.0
// A quad per sphere light that covers its projection: perpendicular to the line of sight, as large as
// the tangent cone, at unit distance (only directions matter). Seen from inside or from very close it
// is the whole screen.
#version 460
#extension GL_GOOGLE_include_directive : require
#include "gbuffer/rays.glsl"

layout(location = EMITTER_SPHERE) in vec4 sphere; // relative to the light set's origin
layout(location = EMITTER_LUMINANCE) in vec3 luminance;

layout(location = 0) flat out vec4 outSphere; // view space
layout(location = 1) flat out vec3 outLuminance;

// Angular rounding of the quad and of pixel rays, with a margin of about 50.
const float MARGIN = 1e-5;

void main()
{
    const vec3 center = frame.emitterOrigin + frame.viewFromWorld * sphere.xyz;
    const float radius = sphere.w;
    outSphere = vec4(center, radius);
    outLuminance = luminance;

    const vec2 corner = vec2(gl_VertexIndex & 1, gl_VertexIndex >> 1) * 2.0 - 1.0;
    const bool perspective = frame.perspective > 0.5;
    const vec3 toCenter = center - frame.rayOrigin[0]; // from the eye
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
    const float reach = perspective ? tanCone * (1.0 + MARGIN) + MARGIN
                                    : radius + MARGIN * (radius + distanceToCenter);
    const vec3 positionView =
        (perspective ? frame.rayOrigin[0] + axis : center) + reach * (corner.x * u + corner.y * v);
    gl_Position = frame.clipFromView * vec4(positionView, 1.0);
    if (perspective && !(sinCone < 0.99)) // tan(cone) = 7: larger quads lose precision
        gl_Position = vec4(corner, 0.0, 1.0);
    // Depth is written per pixel. This one is never clipped by near or far, but keeps w away from 0.
    gl_Position.z = gl_Position.w - 1e-3;
}
