// SPDX-License-Identifier: Apache-2.0
// An exact plane or ball: intersects the ray through the pixel centre and writes the depth of the hit.
// Hits outside the depth range are clipped, as geometry is.
#version 460
#extension GL_GOOGLE_include_directive : require
#include "shared/raster.h"
#include "gbuffer/output.glsl"
#include "gbuffer/rays.glsl"

layout(constant_id = RASTER_SHAPE) const uint shape = 0u;
layout(push_constant, scalar) uniform Push
{
    AnalyticParams params;
};

void main()
{
    const vec2 ndc = pixelNdc(gl_FragCoord.xy);
    vec3 positionView, normal;
    bool hit;
    if (shape == ANALYTIC_PLANE) {
        // height and slope were projected onto the normal in double precision, so nothing cancels in
        // float.
        const float height = params.height.x + ndc.x * params.height.y + ndc.y * params.height.z;
        const float slope = params.slope.x + ndc.x * params.slope.y + ndc.y * params.slope.z;
        const vec3 origin =
            frame.rayOrigin[0] + ndc.x * frame.rayOrigin[1] + ndc.y * frame.rayOrigin[2];
        const vec3 direction =
            frame.rayDirection[0] + ndc.x * frame.rayDirection[1] + ndc.y * frame.rayDirection[2];
        hit = height > 0.0 && slope < 0.0;
        positionView = origin - height / slope * direction;
        normal = params.normalOrCenter;
    } else {
        const Ray ray = pixelRay(ndc);
        const SphereHit sphere =
            intersectSphere(ray, params.normalOrCenter, params.radius, params.power);
        hit = sphere.hit && (sphere.near > 0.0 || frame.perspective < 0.5);
        positionView = ray.origin + sphere.near * ray.direction;
        normal = sphere.normal;
    }
    const float depth = depthOf(positionView);
    if (!(hit && depth >= 0.0 && depth <= 1.0))
        discard;
    gl_FragDepth = depth;
    writeSurface(normal, MaterialSample(params.baseColor, params.metalness,
                                        params.perceptualRoughness, params.dielectricF0,
                                        params.diffuseWeight, params.specularWeight,
                                        params.emission));
}
