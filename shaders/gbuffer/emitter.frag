// SPDX-License-Identifier: Apache-2.0
// A visible sphere light, ray-cast at the pixel centre. In perspective the near plane does not cut
// lights: one that holds the camera, or is very close, has its luminance along every ray that meets it.
#version 460
#extension GL_GOOGLE_include_directive : require
#include "gbuffer/output.glsl"
#include "gbuffer/rays.glsl"

layout(location = 0) flat in vec4 inSphere; // view space
layout(location = 1) flat in vec3 inLuminance;

void main()
{
    const Ray ray = pixelRay(pixelNdc(gl_FragCoord.xy));
    const float distanceToCenter = length(inSphere.xyz - frame.rayOrigin[0]); // of the eye
    const float power = (distanceToCenter - inSphere.w) * (distanceToCenter + inSphere.w);
    const SphereHit sphere = intersectSphere(ray, inSphere.xyz, inSphere.w, power);
    const bool perspective = frame.perspective > 0.5;
    const bool inside = perspective && sphere.near <= 0.0;
    const float farDepth = depthOf(ray.origin + sphere.far * ray.direction);
    float depth = inside ? farDepth : depthOf(ray.origin + sphere.near * ray.direction);
    const bool reversed = frame.nearDepth > 0.5;
    depth = reversed ? min(depth, 1.0) : max(depth, 0.0);
    const bool inFront = perspective ? sphere.far > 0.0
                                     : (reversed ? farDepth <= 1.0 : farDepth >= 0.0);
    if (!(sphere.hit && inFront && depth >= 0.0 && depth <= 1.0))
        discard;
    gl_FragDepth = depth;
    writeEmitter(sphere.normal, inLuminance);
}
