// SPDX-License-Identifier: Apache-2.0
// Intersection of rays with the shapes of area lights, in view space.
#ifndef CND_GBUFFER_EMITTER_SHAPES
#define CND_GBUFFER_EMITTER_SHAPES

#include "gbuffer/rays.glsl"

struct EmitterHit {
    bool hit;
    float near, far; // distances along the ray; in perspective a negative one is behind the camera
    vec3 normal; // at distance `near`, facing against the ray; its length is arbitrary (writeSurface)
};

EmitterHit intersectBall(Ray ray, vec3 center, float radius)
{
    const float distanceToCenter = length(center - frame.rayOrigin[0]); // from the eye
    const float power = (distanceToCenter - radius) * (distanceToCenter + radius);
    const SphereHit s = intersectSphere(ray, center, radius, power);
    return EmitterHit(s.hit, s.near, s.far, s.normal);
}

// The tube is the union of a cylinder and a ball at either end; a ray enters a union where it first
// enters one of its parts. It can enter the cylinder only through its side, because the flat ends are
// inside the balls.
EmitterHit intersectTube(Ray ray, vec3 center, vec3 halfAxis, float radius)
{
    const EmitterHit a = intersectBall(ray, center - halfAxis, radius);
    const EmitterHit b = intersectBall(ray, center + halfAxis, radius);
    EmitterHit tube = a;
    if (!a.hit || (b.hit && b.near < a.near))
        tube.near = b.near, tube.normal = b.normal;
    if (!a.hit || (b.hit && b.far > a.far))
        tube.far = b.far;
    tube.hit = a.hit || b.hit;

    // Projected across the axis the cylinder is a circle; the rest is as in intersectSphere.
    const float halfLength = length(halfAxis);
    const vec3 axis = halfAxis / halfLength;
    const vec3 toCenter = center - ray.origin;
    const vec3 flatDirection = ray.direction - dot(ray.direction, axis) * axis;
    const vec3 flatToCenter = toCenter - dot(toCenter, axis) * axis;
    const float speed2 = dot(flatDirection, flatDirection);
    // the ray is parallel to the axis: it enters by one ball and leaves by the other
    if (!(speed2 > 1e-10))
        return tube;
    const float along = dot(flatToCenter, flatDirection) / speed2;
    const vec3 across = flatToCenter - along * flatDirection;
    const float distanceToAxis = length(across);
    if (!(distanceToAxis <= radius))
        return tube;
    const float halfChord = sqrt((radius - distanceToAxis) * (radius + distanceToAxis) / speed2);
    const float distanceToSide = length(flatToCenter);
    const float power = (distanceToSide - radius) * (distanceToSide + radius);
    const float far = along + halfChord;
    const float near = along > 0.0 ? power / (speed2 * far) : along - halfChord;
    if (abs(dot(near * ray.direction - toCenter, axis)) <= halfLength &&
        !(tube.hit && tube.near <= near)) {
        tube.near = near;
        tube.normal = normalize(near * flatDirection - flatToCenter);
        tube.far = tube.hit ? max(tube.far, near) : near;
        tube.hit = true;
    }
    if (tube.hit && abs(dot(far * ray.direction - toCenter, axis)) <= halfLength)
        tube.far = max(tube.far, far);
    return tube;
}

// Intersects a ray with a plane light, which is visible from its front, or from both sides.
EmitterHit intersectFlat(Ray ray, vec3 center, vec3 normal, bool twoSided)
{
    const float slope = dot(ray.direction, normal);
    EmitterHit plane;
    plane.hit = slope < 0.0 || (twoSided && slope > 0.0);
    plane.near = plane.far = dot(center - ray.origin, normal) / slope;
    plane.normal = slope < 0.0 ? normal : -normal;
    return plane;
}

EmitterHit intersectDisc(Ray ray, vec3 center, vec3 normal, float radius, bool twoSided)
{
    EmitterHit disc = intersectFlat(ray, center, normal, twoSided);
    const vec3 fromCenter = disc.near * ray.direction - (center - ray.origin);
    disc.hit = disc.hit && length(fromCenter) <= radius;
    return disc;
}

// Intersects the parallelogram center + a axisU + b axisV with a and b within +-1.
EmitterHit intersectRectangle(Ray ray, vec3 center, vec3 axisU, vec3 axisV, bool twoSided)
{
    const float lengthU = length(axisU), lengthV = length(axisV);
    const vec3 u = axisU / lengthU, v = axisV / lengthV;
    // its length differs from 1 by the square of the deviation of u and v from a right angle
    const vec3 across = cross(u, v);
    EmitterHit rectangle = intersectFlat(ray, center, normalize(across), twoSided);
    const vec3 fromCenter = rectangle.near * ray.direction - (center - ray.origin);
    const float area = dot(across, across);
    const bool inU = abs(dot(cross(v, across), fromCenter)) <= lengthU * area;
    const bool inV = abs(dot(cross(across, u), fromCenter)) <= lengthV * area;
    rectangle.hit = rectangle.hit && inU && inV;
    return rectangle;
}

vec2 emitterCorner(vec4 pairs[EMITTER_CORNER_PAIRS], uint i)
{
    return (i & 1u) == 0u ? pairs[i >> 1u].xy : pairs[i >> 1u].zw;
}

// Intersects the convex polygon with the corners center + a axisU + b axisV. Where the last corner is
// repeated, the edge has no length and every point passes its test.
EmitterHit intersectPolygon(Ray ray, vec3 center, vec3 axisU, vec3 axisV,
                            vec4 pairs[EMITTER_CORNER_PAIRS], bool twoSided)
{
    const float lengthU = length(axisU), lengthV = length(axisV);
    const vec3 u = axisU / lengthU, v = axisV / lengthV;
    const vec3 across = cross(u, v); // as in intersectRectangle
    EmitterHit polygon = intersectFlat(ray, center, normalize(across), twoSided);
    const vec3 fromCenter = polygon.near * ray.direction - (center - ray.origin);
    const float area = dot(across, across);
    const vec2 at = vec2(dot(cross(v, across), fromCenter), dot(cross(across, u), fromCenter)) /
                    (area * vec2(lengthU, lengthV));
    vec2 from = emitterCorner(pairs, MAX_CORNERS - 1u);
    for (uint i = 0u; i < MAX_CORNERS; ++i) {
        const vec2 to = emitterCorner(pairs, i);
        const vec2 edge = to - from;
        polygon.hit = polygon.hit && edge.x * (at.y - from.y) >= edge.y * (at.x - from.x);
        from = to;
    }
    return polygon;
}

// Intersects a ray with the emitter of a light of any type that has a position. `type` is LIGHT_*,
// the other parameters are the members of EmitterRecord and EmitterCorners.
EmitterHit intersectEmitter(Ray ray, uint type, vec3 center, float radius, vec3 axisU, vec3 axisV,
                            bool twoSided, vec4 corners[EMITTER_CORNER_PAIRS])
{
    if (type == LIGHT_TUBE)
        return intersectTube(ray, center, axisU, radius);
    if (type == LIGHT_RECTANGLE)
        return intersectRectangle(ray, center, axisU, axisV, twoSided);
    if (type == LIGHT_DISC)
        return intersectDisc(ray, center, axisU, radius, twoSided);
    if (type == LIGHT_POLYGON)
        return intersectPolygon(ray, center, axisU, axisV, corners, twoSided);
    return intersectBall(ray, center, radius);
}

#endif
