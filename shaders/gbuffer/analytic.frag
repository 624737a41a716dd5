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
        precise const float height =
            params.height.x + ndc.x * params.height.y + ndc.y * params.height.z;
        precise const float slope =
            params.slope.x + ndc.x * params.slope.y + ndc.y * params.slope.z;
        precise const float t = -height * portableReciprocal(slope);
        hit = height > 0.0 && slope < 0.0;
        positionView = pointAt(affineInNdc(frame.rayOrigin, ndc),
                               affineInNdc(frame.rayDirection, ndc), t);
        normal = params.normalOrCenter;
    } else {
        const Ray ray = pixelRay(ndc);
        const SphereHit sphere =
            intersectSphere(ray, params.normalOrCenter, params.radius, params.power);
        hit = sphere.hit && (sphere.near > 0.0 || frame.perspective < 0.5);
        positionView = pointAt(ray.origin, ray.direction, sphere.near);
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
