// SPDX-License-Identifier: Apache-2.0
// A visible area light, ray-cast at the pixel centre. In perspective views the near plane does not cut
// lights: one that contains the camera, or is very close to it, shows its luminance along every ray
// that meets it. Distant spheres lie behind everything: they are drawn where depth is clear, and leave
// it clear.
#version 460
#extension GL_GOOGLE_include_directive : require
#include "gbuffer/emitter_shapes.glsl"
#include "gbuffer/output.glsl"
#include "gbuffer/rays.glsl"

layout(constant_id = RASTER_SHAPE) const uint shape = LIGHT_SPHERE;

// view-space centre, radius; distant sphere: direction, sine of its angular radius
layout(location = 0) flat in vec4 inCenter;
layout(location = 1) flat in vec3 inLuminance;
#ifndef BALL
layout(location = 2) flat in vec3 inAxisU; // view space
layout(location = 3) flat in vec4 inAxisV; // view space; w: whether it is two-sided
layout(location = 4) flat in vec4 inCorners[EMITTER_CORNER_PAIRS]; // of a polygon, along its axes
#endif

EmitterHit intersect(Ray ray)
{
#ifdef BALL
    return intersectBall(ray, inCenter.xyz, inCenter.w);
#else
    return intersectEmitter(ray, shape, inCenter.xyz, inCenter.w, inAxisU, inAxisV.xyz,
                            inAxisV.w > 0.5, inCorners);
#endif
}

void main()
{
    const Ray ray = pixelRay(pixelNdc(gl_FragCoord.xy));
    const bool reversed = frame.nearDepth > 0.5;
    if (shape == LIGHT_DISTANT_SPHERE) {
        const bool inDisc = length(cross(ray.direction, inCenter.xyz)) <= inCenter.w;
        if (!(inDisc && dot(ray.direction, inCenter.xyz) > 0.0))
            discard;
        gl_FragDepth = farDepth();
        writeEmitter(-inCenter.xyz, inLuminance);
        return;
    }
    const EmitterHit hit = intersect(ray);
    const bool perspective = frame.perspective > 0.5;
    const bool inside = perspective && hit.near <= 0.0;
    const float farDepth = depthOf(ray.origin + hit.far * ray.direction);
    float depth = inside ? farDepth : depthOf(ray.origin + hit.near * ray.direction);
    depth = reversed ? min(depth, 1.0) : max(depth, 0.0);
    const bool inFront = perspective ? hit.far > 0.0
                                     : (reversed ? farDepth <= 1.0 : farDepth >= 0.0);
    if (!(hit.hit && inFront && depth >= 0.0 && depth <= 1.0))
        discard;
    gl_FragDepth = depth;
    writeEmitter(hit.normal, inLuminance);
}
