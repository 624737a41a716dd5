// SPDX-License-Identifier: Apache-2.0
// Shades the front of a transparent ball with all lights of the view.
#version 460
#extension GL_GOOGLE_include_directive : require
#define CND_FORWARD_SET 0
#include "lib/forward.glsl"

layout(push_constant, scalar) uniform Push
{
    vec3 centre;
    float radius;
    vec3 albedo;
    float opacity;
    float F0, F90;
    float perceptualRoughness;
    vec2 invImageSize;
};
layout(location = 0) out vec4 radiance;

void main()
{
    const CndProjection projection = cndForwardView.projection;
    const vec3 ray = normalize(cndViewRay(projection, uvec2(gl_FragCoord.xy), invImageSize));
    const float along = dot(ray, centre);
    const float inside = radius * radius - dot(centre - along * ray, centre - along * ray);
    if (inside <= 0.0)
        discard;
    const vec3 position = (along - sqrt(inside)) * ray;

    CndSurface surface;
    surface.normal = (position - centre) / radius;
    surface.albedo = albedo;
    surface.F0 = vec3(F0);
    surface.specularWeight = F90;
    surface.perceptualRoughness = perceptualRoughness;
    radiance = vec4(opacity * cndLitSurface(surface, position), opacity);
    gl_FragDepth = (projection.m22 * position.z + projection.m32) /
                   (projection.m23 * position.z + projection.m33);
}
