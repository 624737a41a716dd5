// SPDX-License-Identifier: Apache-2.0
// The facet of a tube, a cylinder with half spheres at its ends.
#ifndef CND_LIB_VISIBILITY_TUBE_FACET
#define CND_LIB_VISIBILITY_TUBE_FACET

#include "lib/visibility/facet.glsl"

// All of this is in the plane of the receiver, which is the origin, and the tube's axis. The tube is a
// capsule there: everything within `radius` of the line between two points.

float cross2(vec2 a, vec2 b)
{
    return a.x * b.y - a.y * b.x;
}

// Sets the points where the tangents from the origin touch the circle, which the origin is outside of.
// `high` is seen farther towards +x.
void tangentPoints(vec2 centre, float radius, out vec2 high, out vec2 low)
{
    const float d2 = dot(centre, centre);
    const float r = radius * sqrt(max(d2 - radius * radius, 0.0)) / d2;
    const float k = 1.0 - radius * radius / d2;
    const vec2 side = vec2(centre.y, -centre.x);
    high = k * centre + r * side;
    low = k * centre - r * side;
}

// Returns the distance from the origin to a circle in the unit direction c, or `otherwise`.
float distanceToCircle(vec2 c, vec2 centre, float radius, float otherwise)
{
    const float along = dot(c, centre), aside = cross2(c, centre);
    const float h2 = radius * radius - aside * aside;
    const float t = along - sqrt(max(h2, 0.0));
    return h2 > 0.0 && t > 0.0 ? t : otherwise;
}

// Returns the distance from the origin to the capsule in the unit direction c, at most `farthest`.
float distanceToCapsule(vec2 c, vec2 from, vec2 to, float radius, float farthest)
{
    float t = farthest;
    t = min(t, distanceToCircle(c, from, radius, farthest));
    t = min(t, distanceToCircle(c, to, radius, farthest));
    const float size = length(to - from);
    const vec2 along = (to - from) / max(size, 1e-30);
    // The side that the origin is on. Beyond the ends of the side the circles count.
    const float height = cross2(along, -from), slope = cross2(along, c);
    const float side = height < 0.0 ? -radius : radius;
    const float toSide = (side - height) / slope;
    const float place = dot(toSide * c - from, along);
    if (abs(height) > radius && height * slope < 0.0 && place >= 0.0 && place <= size)
        t = min(t, toSide);
    return t;
}

// Returns the point of the line between two points in the unit direction c, or the end next to it.
vec2 pointOfSegment(vec2 c, vec2 from, vec2 to)
{
    const float across = cross2(c, to - from);
    const float share = -cross2(c, from) / across;
    if (abs(across) > 1e-6 * length(to - from))
        return from + clamp(share, 0.0, 1.0) * (to - from);
    return dot(from, from) < dot(to, to) ? from : to;
}

// Returns whether the origin is in the capsule or almost touches it.
bool isInsideCapsule(vec2 from, vec2 to, float radius)
{
    const vec2 way = to - from;
    const float share = clamp(-dot(from, way) / max(dot(way, way), MIN_LENGTH2), 0.0, 1.0);
    return !(length(from + share * way) > 1.0001 * radius);
}

// axis: half of the axis between the centres of both ends, m. The facet spans the outermost tangents in
// the plane of receiver and axis, and is as wide as the tube looks in its middle. Its outline is exact
// if the tube is seen from the side or along its axis.
Facet tubeFacet(uint count, vec3 toLight, vec3 axis, float radius)
{
    // In units of the tube's distance plus size, so that no square overflows.
    const float axisLength = max(length(axis), 1e-30);
    const float scale = 1.0 / max(length(toLight) + axisLength + radius, 1e-30);
    const vec3 d = toLight * scale;
    const float R = radius * scale;
    const float distance = max(length(d), 1e-15);
    const vec3 a = d / distance;
    const vec3 direction = axis / axisLength;
    const vec3 across = cross(direction, a);
    const vec3 w = length(across) < 1e-6 ? anyPerpendicular(a) : normalize(across);
    const vec3 x = cross(a, w); // the axis points to its side
    const vec2 end = axisLength * scale * vec2(dot(direction, x), dot(direction, a));
    const vec2 from = vec2(0.0, distance) - end, to = vec2(0.0, distance) + end;
    vec2 top, bottom, otherTop, otherBottom;
    tangentPoints(to, R, top, bottom);
    tangentPoints(from, R, otherTop, otherBottom);
    top = cross2(top, otherTop) < 0.0 ? otherTop : top;
    bottom = cross2(bottom, otherBottom) > 0.0 ? otherBottom : bottom;

    const vec2 centre = 0.5 * (top + bottom), halfU = 0.5 * (top - bottom);
    const float centreDistance = max(length(centre), 1e-15), lengthU = length(halfU);
    const vec2 c = centre / centreDistance;
    // Differences of float32 have no direction if they are too short.
    const bool isShort = lengthU < MIN_FACET_SIZE * centreDistance;
    const vec2 u = isShort ? vec2(c.y, -c.x) : halfU / lengthU;
    const vec2 middle = pointOfSegment(c, from, to);
    const float l2 = max(dot(middle, middle) - R * R, 1e-4 * R * R);
    const float width = centreDistance * R * inversesqrt(max(l2, MIN_LENGTH2));
    const float roundEnd = clamp(width / max(lengthU, 1e-30), 1e-4, 1.0);
    const float t = distanceToCapsule(c, from, to, R, centreDistance);
    const uvec2 members = isInsideCapsule(from, to, R) ? uvec2(0u) : stadiumPoints(count, roundEnd);
    Facet f = makeFacet(centre.x * x + centre.y * a, u.x * x + u.y * a, lengthU, w, width,
                        FACET_SQUARE, members);
    f.front = FrontSurface(f.front.inverseDistance * scale,
                           centreDistance / max(t, 1e-4 * centreDistance) - 1.0, roundEnd);
    return f;
}

#endif
