// SPDX-License-Identifier: Apache-2.0
// Writes what stands for a polygon where shadows are found: the smallest rectangle around it, which of
// its points are in the polygon, and the flags of the light. They are written into the words of the
// shapes of corners that hold no corner; polygonFacetShape() reads them.
#version 460
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_samplerless_texture_functions : require
#include "lib/light_shape.glsl"
#include "shared/light_order_data.h"
#include "shared/occluder_data.h"

layout(local_size_x = POLYGON_FACETS_GROUP) in;
layout(push_constant, scalar) uniform Push
{
    PolygonFacetsParams params;
};
layout(scalar, binding = POLYGON_FACETS_RECORDS) readonly buffer Records
{
    LightRecord records[];
};
layout(scalar, binding = POLYGON_FACETS_ORDER) readonly buffer Order
{
    LightKey order[];
};
layout(scalar, binding = POLYGON_FACETS_SHAPES) buffer Shapes
{
    LightShape shapes[];
};
layout(binding = SHADOW_POINTS) uniform utextureBuffer pointTexels;
layout(constant_id = SPEC_VISIBILITY_POINTS) const uint pointCount = 64u;

uvec2 pointTable(uint i)
{
    return texelFetch(pointTexels, int(i)).xy;
}

#include "lib/visibility/enclosing_rectangle.glsl"

void main()
{
    if (gl_GlobalInvocationID.x >= params.count)
        return;
    const uint light = params.firstPolygon + gl_GlobalInvocationID.x;
    const LightShape polygon = shapes[light];
    const uint at = firstCornerShape(polygon);
    // Axes of the plane, and a unit of length.
    const float size = max(length(polygon.axisU), length(polygon.axisV));
    const vec3 u = normalize(polygon.axisU / size), v = normalize(polygon.axisV / size);
    FlatPolygon flatPolygon;
    flatPolygon.count = cornerCount(polygon);
    for (uint i = 0u; i < CORNER_SHAPES; ++i) {
        const vec3 a = shapes[at + i].axisU / size, b = shapes[at + i].axisV / size;
        flatPolygon.corners[2u * i] = vec2(dot(u, a), dot(v, a));
        flatPolygon.corners[2u * i + 1u] = vec2(dot(u, b), dot(v, b));
    }
    const EnclosingRectangle r = enclosingRectangle(flatPolygon);
    const uvec2 members = pointsInside(pointCount, flatPolygon, r);
    const vec3 centre = size * (r.centre.x * u + r.centre.y * v);
    const vec3 halfU = size * (r.halfU.x * u + r.halfU.y * v);
    const vec3 halfV = size * (r.halfV.x * u + r.halfV.y * v);
    shapes[at].radius = centre.x;
    shapes[at + 1u].radius = centre.y;
    shapes[at + 2u].radius = centre.z;
    shapes[at + 3u].radius = halfU.x;
    shapes[at + 4u].radius = halfU.y;
    shapes[at + 5u].radius = halfU.z;
    shapes[at + 6u].radius = halfV.x;
    shapes[at + 3u].flags = floatBitsToUint(halfV.y);
    shapes[at + 4u].flags = floatBitsToUint(halfV.z);
    shapes[at].flags = records[order[light].light].flags;
    shapes[at + 1u].flags = members.x;
    shapes[at + 2u].flags = members.y;
}
