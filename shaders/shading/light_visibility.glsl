// SPDX-License-Identifier: Apache-2.0
// The visible shares of a light at a point, between the occluders of the frame. Before this file, the
// includer provides lightCentre(), lightShapes[], the bindings of the occluders, shadowView, and what
// occluder_walk.glsl asks for. With CANDELABRA_VISIBLE_POINTS the host finds the points that are seen,
// and the includer also provides lightIds[].
#ifndef CND_SHADING_LIGHT_VISIBILITY
#define CND_SHADING_LIGHT_VISIBILITY

#include "lib/light_shape.glsl"
#include "lib/visibility/light_facet.glsl"
#include "lib/visibility/visible_shares.glsl"
#include "shading/light_type.glsl"
#ifdef CANDELABRA_VISIBLE_POINTS
#include "lib/visibility/triangle_points.glsl"
#include "lib/visibility_query.glsl"
#include "shading/point_count.glsl"
#else
#include "shading/occluder_walk.glsl"
#endif

// What stands for a light where shadows are found (lightFacet).
struct FacetShape {
    vec3 centre;      // relative to the light's, in view space, m
    LightShape shape; // flags: as in LightRecord
    uvec2 members;    // the points that belong to the light
};

// polygon_facets has written the facet of a polygon between its corners.
FacetShape polygonFacetShape(LightShape polygon)
{
    const uint at = firstCornerShape(polygon);
    FacetShape f;
    f.centre =
        vec3(lightShapes[at].radius, lightShapes[at + 1u].radius, lightShapes[at + 2u].radius);
    f.shape.axisU =
        vec3(lightShapes[at + 3u].radius, lightShapes[at + 4u].radius, lightShapes[at + 5u].radius);
    f.shape.axisV = vec3(lightShapes[at + 6u].radius, uintBitsToFloat(lightShapes[at + 3u].flags),
                         uintBitsToFloat(lightShapes[at + 4u].flags));
    f.shape.radius = 0.0;
    f.members = uvec2(lightShapes[at + 1u].flags, lightShapes[at + 2u].flags);
    f.shape.flags = lightShapes[at].flags;
    return f;
}

FacetShape facetShape(uint light)
{
    const LightShape shape = lightShapes[light];
    if (lightType == LIGHT_POLYGON)
        return polygonFacetShape(shape);
    return FacetShape(vec3(0.0), shape, uvec2(0xFFFFFFFFu));
}

// Tells whether a light reaches a point, as far as rounding lets two kernels agree.
bool reachesPoint(uint light, ShadingPoint p)
{
    const vec4 centreRadius = lightCentre(light);
    const vec3 toLight = towardsLight(centreRadius.xyz, p.position);
    return dot(p.n, toLight) > -centreRadius.w && dot(toLight, toLight) < lightEmission(light).w;
}

Facet facetAt(uint light, vec3 position)
{
    const FacetShape given = facetShape(light);
    const vec4 centreRadius = lightCentre(light);
    Facet f = lightFacet(pointCount, lightType,
                         towardsLight(centreRadius.xyz + given.centre, position), centreRadius.w,
                         given.shape, shadowView.viewFromTree);
    const bool shadowed = (given.shape.flags & LIGHT_UNSHADOWED) == 0u;
    f.members = shadowed ? f.members & given.members : uvec2(0u);
    return f;
}

#ifdef CANDELABRA_VISIBLE_POINTS
uvec2 pointsSeen(uint light, ShadingPoint p, float depthError, uint unshadowedBy, bool asks,
                 out bool isFinished)
{
    isFinished = true;
    VisibilityQuery q;
    q.light = lightIds[light];
    q.type = lightType;
    q.position = p.position;
    q.normal = p.n;
    q.ownDistance = ownSurfaceDistance(depthError, p.position, 0.0, mat3(1.0), p.position);
    q.unshadowedBy = unshadowedBy;
    q.facet = facetAt(light, p.position);
    q.points = q.facet.members;
    q.count = pointCount;
    uvec2 seen = uvec2(0u);
    if (asks && !isEmpty(q.points))
        seen = candelabraVisiblePoints(q);
    return seen;
}
#else
Facet facetOf(OccluderQuery q)
{
    return facetAt(q.light, q.position);
}

uvec2 pointsSeen(uint light, ShadingPoint p, float depthError, uint unshadowedBy, bool asks,
                 out bool isFinished)
{
    OccluderQuery q;
    q.light = light;
    q.position = p.position;
    q.depthError = depthError;
    q.layers = shadowView.layers;
    q.ignored = unshadowedBy << OCCLUDER_LAYERS_SHIFT;
    const TreeSpace tree =
        TreeSpace(shadowView.viewFromTree, shadowView.viewInTree, shadowView.firstNode);
    return visiblePoints(q, tree, asks, isFinished);
}
#endif

// Returns the visible shares of both lobes (shared/occluder_data.h).
// asks: false: the lane only waits for others, and the result is SHARES_UNASKED.
// depthError: of the point along its view ray, m (ownSurfaceDistance).
// isFinished: as of visiblePoints().
uint lightVisibility(uint light, ShadingPoint p, float depthError, bool asks, out bool isFinished)
{
    const uint flags = facetShape(light).shape.flags;
    const uint by = flags >> LIGHT_UNSHADOWED_BY_SHIFT & ((1u << OCCLUDER_LAYER_COUNT) - 1u);
    const bool shadowed = (flags & LIGHT_UNSHADOWED) == 0u;
    const uvec2 lit = pointsSeen(light, p, depthError, by, asks && shadowed, isFinished);
    if (!asks)
        return SHARES_UNASKED;
    const Facet facet = facetAt(light, p.position);
    const uvec2 shares = uvec2(visibleShares(facet, pointCount, lit, p) * SHARE_UNIT + 0.5);
    return shares.x | shares.y << 16;
}

#endif
