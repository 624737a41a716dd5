// SPDX-License-Identifier: Apache-2.0
// The visible shares of a light at a point, between the occluders of the frame. Before this file,
// the includer provides lightCentre(), lightShapes[], the bindings of the occluders, shadowView,
// and what occluder_walk.glsl asks for. With CANDELABRA_VISIBLE_POINTS the host finds the points
// that are seen, and the includer also provides lightIds[].
#ifndef CND_SHADING_LIGHT_VISIBILITY
#define CND_SHADING_LIGHT_VISIBILITY

#include "lib/visibility/light_facet.glsl"
#include "lib/visibility/visible_shares.glsl"
#include "shading/facet_shape.glsl"
#include "shading/light_type.glsl"
#ifdef CANDELABRA_VISIBLE_POINTS
#include "lib/visibility/triangle_points.glsl"
#include "lib/visibility_query.glsl"
#include "shading/point_count.glsl"
#else
#include "shading/occluder_walk.glsl"
#endif

// Tells whether a light reaches a point, as far as rounding lets two kernels agree.
bool reachesPoint(uint light, ShadingPoint p)
{
    const vec4 centreRadius = lightCentre(light);
    const vec3 toLight = towardsLight(centreRadius.xyz, p.position);
    return dot(p.n, toLight) > -centreRadius.w && dot(toLight, toLight) < lightEmission(light).w;
}

Facet facetAt(uint light, vec3 position)
{
    const FacetShape given = facetShape(light, lightType);
    const vec4 centreRadius = lightCentre(light);
    Facet f =
        lightFacet(pointCount, lightType, towardsLight(centreRadius.xyz + given.centre, position),
                   centreRadius.w, given.shape, shadowView.viewFromTree);
    const bool shadowed = (given.shape.flags & LIGHT_UNSHADOWED) == 0u;
    f.members = shadowed ? f.members & given.members : uvec2(0u);
    return f;
}

#ifdef CANDELABRA_VISIBLE_POINTS
uvec2 pointsSeen(uint light, ShadingPoint p, float depthError, bool asks, out bool isFinished)
{
    isFinished = true;
    VisibilityQuery q;
    q.light = lightIds[light];
    q.type = lightType;
    q.position = p.position;
    q.normal = p.n;
    q.ownDistance = ownSurfaceDistance(depthError, p.position, 0.0, mat3(1.0), p.position);
    const uint flags = facetShape(light, lightType).shape.flags;
    q.unshadowedBy = ignoredLayers(flags) >> OCCLUDER_LAYERS_SHIFT;
    q.facet = facetAt(light, p.position);
    q.points = q.facet.members;
    q.count = pointCount;
    uvec2 seen = uvec2(0u);
    if (asks && (flags & LIGHT_UNSHADOWED) == 0u && !isEmpty(q.points))
        seen = candelabraVisiblePoints(q);
    return seen;
}
#else
Facet facetOf(OccluderQuery q)
{
    return facetAt(q.light, q.position);
}

OccluderQuery occluderQuery(uint light, ShadingPoint p, float depthError)
{
    OccluderQuery q;
    q.light = light;
    q.position = p.position;
    q.depthError = depthError;
    q.layers = shadowView.layers;
    q.ignored = ignoredLayers(facetShape(light, lightType).shape.flags);
    return q;
}

TreeSpace treeSpace()
{
    return TreeSpace(shadowView.viewFromTree, shadowView.viewInTree, shadowView.firstNode);
}

uvec2 pointsSeen(uint light, ShadingPoint p, float depthError, bool asks, out bool isFinished)
{
    const bool shadowed = (facetShape(light, lightType).shape.flags & LIGHT_UNSHADOWED) == 0u;
    return visiblePoints(occluderQuery(light, p, depthError), treeSpace(), asks && shadowed,
                         isFinished);
}
#endif

// Returns the visible shares of both lobes (shared/occluder_data.h). seen: the points that the
// point sees; others than the facet's are ignored.
uint sharesOfPoints(uint light, ShadingPoint p, uvec2 seen)
{
    const Facet facet = facetAt(light, p.position);
    const uvec2 shares = uvec2(visibleShares(facet, pointCount, seen, p) * SHARE_UNIT + 0.5);
    return shares.x | shares.y << 16;
}

// The same by a walk through all occluders.
// asks: false: the lane only waits for others, and the result is SHARES_UNASKED.
// depthError: of the point along its view ray, m (ownSurfaceDistance).
// isFinished: as of visiblePoints().
uint lightVisibility(uint light, ShadingPoint p, float depthError, bool asks, out bool isFinished)
{
    const uvec2 seen = pointsSeen(light, p, depthError, asks, isFinished);
    return asks ? sharesOfPoints(light, p, seen) : SHARES_UNASKED;
}

#endif
