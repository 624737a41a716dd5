// SPDX-License-Identifier: Apache-2.0
// The response to a convex polygon of unit luminance.
#include "lib/lights/rectangle_facing.glsl"
#include "lib/outline/rectangle.glsl"
#include "lib/specular/representative.glsl"
#include "lib/specular/sampled.glsl"
#include "shading/by_outline.glsl"

// A polygon as a receiver sees it. The loops over its corners read them from the array of shapes one by
// one: an array of eight corners would not fit into the registers of GPUs.
struct Polygon {
    vec3 toCentre; // from the receiver
    vec3 axisU, axisV;
    float scale; // factor of the corners
    float boundingRadius;
    uint firstShape, count; // of the corners
    bool twoSided;
};

// Returns a corner relative to the centre, in world coordinates.
vec3 cornerOf(Polygon polygon, uint i)
{
    const LightShape pair = lightShapes[polygon.firstShape + (i >> 1u)];
    return polygon.scale * ((i & 1u) == 0u ? pair.axisU : pair.axisV);
}

// Returns a corner of the widened polygon, in the coordinates of the receiver's frame. `wider` points
// along the shorter axis. Its squared length is the factor by which the polygon is widened, minus 1.
vec3 frameCorner(Receiver r, Polygon polygon, uint i, vec3 wider)
{
    const vec3 corner = cornerOf(polygon, i);
    return toFrame(r.frame, corner + dot(corner, wider) * wider);
}

// Returns the outline of the polygon.
WalkedOutline polygonOutline(Receiver r, Polygon polygon, OutlineNeeds needs)
{
    const vec3 normal = cross(polygon.axisU, polygon.axisV);
    const vec3 centre = toFrame(r.frame, polygon.toCentre);
    const bool uIsLonger = length2(polygon.axisU) >= length2(polygon.axisV);
    const vec3 longer = uIsLonger ? polygon.axisU : polygon.axisV;
    const vec3 shorter = uIsLonger ? polygon.axisV : polygon.axisU;
    // Corners are widened by their component along the shorter axis. It has an error of about 6e-8 of
    // their distance, so a larger factor would turn the polygon visibly.
    const float factor = min(widening(r.conic.alpha, polygon.toCentre, longer, shorter), 1e4);
    const vec3 wider = sqrt((factor - 1.0) / max(length2(shorter), MIN_LENGTH2)) * shorter;
    const float size2 = polygon.boundingRadius * polygon.boundingRadius;
    // Stretching shortens what is along the normal, at most to nothing.
    const float height = dot(r.p.n, normal) * inversesqrt(max(length2(normal), MIN_LENGTH2));
    Outline k = beginOutline(r.conic, r.frame, polygon.toCentre, centre,
                             size2 * (0.5 + 0.5 * height * height), needs);
    const OutlineExtent extent =
        extentOf(k, toFrame(r.frame, longer), toFrame(r.frame, factor * shorter), 0.0);
    // The corners are counterclockwise around the side that emits, so a receiver that sees this side
    // looks at them against the sense of the outline.
    const bool front = dot(normal, polygon.toCentre) < 0.0;
    const float most = abs(dot(r.p.n, polygon.axisU)) + abs(dot(r.p.n, polygon.axisV));
    const bool below = centre.z + most <= 0.0; // before it is widened
    const bool seen =
        seesFlatLight(polygon.toCentre, normal, polygon.boundingRadius, polygon.twoSided) && !below;
    vec3 from = frameCorner(r, polygon, front ? 0u : polygon.count - 1u, wider);
    OutlinePoint last = pointAt(k, from);
    bool walks = true;
    do {
        uint i = 0u;
        if (walks) { // a lane that is done may run once more (lens.glsl)
            do {
                if (i < polygon.count) {
                    const uint next = front ? polygon.count - 1u - i : i;
                    addEdgeTo(k, from, last, frameCorner(r, polygon, next, wider));
                }
                ++i;
            } while (i < polygon.count);
            walks = beginUpperBand(k);
        }
    } while (walks);
    return WalkedOutline(k, extent, seen, 1.0, 1.0 / (1.0 + length2(wider)));
}

// Returns the response at the polygon's point nearest to where the mirror ray meets its plane. As for a
// rectangle, the lobe is narrowed by the extents along both axes.
vec2 representativePolygon(ShadingPoint p, Polygon polygon)
{
    if (!facesRectangle(polygon.toCentre, polygon.axisU, polygon.axisV, polygon.twoSided))
        return vec2(0.0);
    const vec3 u = polygon.axisU * inversesqrt(max(length2(polygon.axisU), MIN_LENGTH2));
    const vec3 v = polygon.axisV * inversesqrt(max(length2(polygon.axisV), MIN_LENGTH2));
    const vec3 normal = cross(u, v);
    const vec3 hit = mirrorHit(p, polygon.toCentre, normal);
    vec3 nearest = hit;
    float nearest2 = 0.0; // squared distance of `nearest` from `hit`, if that is outside
    float area = 0.0;
    vec2 extent = vec2(0.0);
    bool inside = true;
    vec3 from = cornerOf(polygon, polygon.count - 1u);
    for (uint i = 0u; i < polygon.count; ++i) {
        const vec3 to = cornerOf(polygon, i);
        const vec3 edge = to - from;
        const float t =
            clamp(dot(hit - from, edge) / max(length2(edge), MIN_LENGTH2), 0.0, 1.0);
        const vec3 onEdge = from + t * edge;
        const float distance2 = length2(hit - onEdge);
        if (i == 0u || distance2 < nearest2) {
            nearest = onEdge;
            nearest2 = distance2;
        }
        inside = inside && dot(cross(edge, hit - from), normal) >= 0.0;
        area += 0.5 * dot(cross(from, to), normal);
        extent = max(extent, abs(vec2(dot(u, to), dot(v, to))));
        from = to;
    }
    const float invD = inversesqrt(max(length2(polygon.toCentre), MIN_LENGTH2));
    // The area of a polygon without width may be rounded below 0.
    const float solidAngle =
        planarSolidAngle(polygon.toCentre, normal, max(area, 0.0), dot(extent, extent));
    return representativeResponse(p, polygon.toCentre + (inside ? hit : nearest), solidAngle,
                                  narrowing(p, extent.x, invD) * narrowing(p, extent.y, invD));
}

// The samples are uniform on the polygon. The triangles between its first corner and the other edges
// are chosen in proportion to their areas.
vec2 sampledPolygon(ShadingPoint p, Polygon polygon, uint count, uint seed)
{
    if (!facesRectangle(polygon.toCentre, polygon.axisU, polygon.axisV, polygon.twoSided))
        return vec2(0.0);
    const vec3 apex = cornerOf(polygon, 0u);
    vec3 areaNormal = vec3(0.0); // its length is twice the area
    for (uint k = 2u; k < polygon.count; ++k)
        areaNormal += cross(cornerOf(polygon, k - 1u) - apex, cornerOf(polygon, k) - apex);
    const float area = length(areaNormal);
    const float facing = abs(dot(areaNormal, polygon.toCentre));
    vec2 sum = vec2(0.0);
    for (uint i = 0u; i < count; ++i) {
        const vec2 x = lowDiscrepancy(i, seed);
        float left = x.x * area; // area between the start of the present triangle and the sample
        float part = 0.0;        // area of the present triangle
        vec3 a = vec3(0.0), b = vec3(0.0);
        for (uint k = 2u; k < polygon.count; ++k) {
            a = cornerOf(polygon, k - 1u) - apex;
            b = cornerOf(polygon, k) - apex;
            part = length(cross(a, b));
            if (left <= part)
                break;
            left -= part;
        }
        const float along = min(left / max(part, 1e-30), 1.0);
        const vec3 point =
            polygon.toCentre + apex + sqrt(x.y) * mix(a, b, along);
        sum += elementResponse(p, point, facing, 0.5);
    }
    return sum / float(max(count, 1u));
}

LightResponse polygonWithNeeds(Receiver r, Light given, OutlineNeeds needs)
{
    float scale;
    const Light light = atUnitDistance(given, scale);
    const LightShape shape = lightShapes[light.index];
    const Polygon polygon =
        Polygon(light.toLight, scale * shape.axisU, scale * shape.axisV, scale, light.boundingRadius,
                firstCornerShape(shape), cornerCount(shape), isTwoSided(shape));
    const WalkedOutline walked = polygonOutline(r, polygon, needs);
    LightResponse response = outlineResponse(readAgain(r).conic, walked);
    if (specularMethod == SPECULAR_SAMPLED)
        response.specular = sampledPolygon(r.p, polygon, r.sampleCount, lightSeed(r, light.index));
    else if (!BY_OUTLINE && specularMethod != SPECULAR_NONE)
        response.specular = representativePolygon(r.p, polygon);
    return response;
}

OUTLINE_CLASSES(polygon)
