// SPDX-License-Identifier: Apache-2.0
// Proofs that an occluder hides all of a light from all receivers in a box (DECISIONS 82). The light's
// emitter is in a ball. The shaft is the union of all ways from the box to the ball. If the number of
// triangles of a mesh that a way crosses is the same for all ways, and one way crosses one, then all
// do. The number changes only where ways pass the end of the surface or its silhouette (Laine et al.
// 2005, "Soft Shadow Volumes for Ray Tracing"):
// - A plane that has the box on one side and the ball on the other is crossed by every way, in one
//   direction. Its triangle is FORWARD or BACKWARD, by this direction and that of its corners.
// - A triangle is BESIDE if no way reaches its plane, so no way reaches its edges either.
// - The plane of any other triangle is NEAR. If the triangle touches the shaft, there is no proof:
//   receivers may be on the triangle, for which it then is their own surface.
// - An edge between two triangles with one direction does not change the number. An edge between two
//   with different directions or of one that has no neighbour may, so it must not touch the shaft.
// All is relative to the centre of the box, in view space and in metres, with margins for rounding,
// also for that of masks (triangle_points.glsl).
#ifndef CND_LIB_VISIBILITY_DARK_PROOF
#define CND_LIB_VISIBILITY_DARK_PROOF

#include "lib/visibility/box_tests.glsl"
#include "lib/visibility/triangle_points.glsl"
#include "shared/occluder_data.h"

struct Shaft {
    vec3 box;     // half of its size
    vec3 ball;    // its centre
    float radius; // of the ball
    float slack;  // bound of rounding, as a share of distances from the box
};

const uint PLANE_BESIDE = 0u;
const uint PLANE_NEAR = 1u;
const uint PLANE_FORWARD = 2u;
const uint PLANE_BACKWARD = 3u;

// Bound of the rounding of masks (PLANE_SLACK), which sum three products, of transforms, and here.
const float PROOF_SLACK = 4.0 * PLANE_SLACK;

// How far the front surface of a tube's facet is from the tube's centre, in bounding radii (1.992 was
// found): it is parallel to the facet, also if the tube is seen from its end.
const float FRONT_OF_TUBE = 2.0;

// Returns the least sine of the angle at which receivers in the box see a flat light. normal: the cross
// product of unit vectors along its half axes. farthest: bound of its distance.
float leastSlope(vec3 box, vec3 toLight, vec3 normal, float farthest)
{
    return max(abs(dot(normal, toLight)) - dot(abs(normal), box), 0.0) / farthest;
}

// Sets the shaft from a box to the ball that holds the facets of a light (light_facet.glsl) for all
// receivers in the box. The ball also holds the end of each way, where occluders do not count
// (FrontSurface). Returns false if there is no proof, because some receiver is too near to the light.
// toLight: from the centre of the box to that of the light; shape: that of the light, also of polygons.
bool shaftTo(vec3 box, uint type, vec3 toLight, float boundingRadius, LightShape shape, out Shaft s)
{
    const float nearest = length(max(abs(toLight) - box, vec3(0.0)));
    const float farthest = length(toLight) + length(box) + boundingRadius;
    float slope = 1.0, radius = boundingRadius;
    if (type == LIGHT_DISC || type == LIGHT_RECTANGLE || type == LIGHT_POLYGON) {
        const vec3 normal =
            type == LIGHT_DISC
                ? shape.axisU
                : cross(shape.axisU / length(shape.axisU), shape.axisV / length(shape.axisV));
        slope = leastSlope(box, toLight, normal, farthest);
        radius *= SHEARED_RADIUS;
    }
    if (type == LIGHT_TUBE) {
        radius = FRONT_OF_TUBE * boundingRadius;
        slope = shape.radius / (2.0 * boundingRadius); // half of the least one
    }
    radius += farthest * (FRONT_SLACK + 2.0 * MIN_FACET_SIZE);
    // Facets are seen at half of MIN_FACET_SLOPE or more, but for rounding.
    s = Shaft(box, toLight, radius, PROOF_SLACK / max(slope, 0.25 * MIN_FACET_SLOPE));
    return nearest > radius;
}

// A triangle of an instance.
struct ShaftTriangle {
    vec3 a;
    vec3 b;
    vec3 c;
    float reach; // bound of the distances of its corners
};

// a, b, c: the corners minus the centre of the box, in the mesh's space. viewFromLocal: linear part.
ShaftTriangle triangleInView(mat3 viewFromLocal, vec3 a, vec3 b, vec3 c)
{
    const vec3 lengths =
        vec3(length(viewFromLocal[0]), length(viewFromLocal[1]), length(viewFromLocal[2]));
    return ShaftTriangle(viewFromLocal * a, viewFromLocal * b, viewFromLocal * c,
                         dot(lengths, max(abs(a), max(abs(b), abs(c)))));
}

// Returns where the plane of a triangle is, PLANE_*. ownDistance: ownSurfaceDistance() of receivers in
// the box.
uint planeSide(Shaft s, float ownDistance, ShaftTriangle t)
{
    const vec3 ab = t.b - t.a, ac = t.c - t.a;
    const vec3 n = cross(ab, ac);
    const float size = length(n);
    // The normal of a small triangle is not known well.
    const float unsure = s.slack * (size + t.reach * (length(ab) + length(ac)));
    const float atBox = -dot(n, t.a), atBall = dot(n, s.ball - t.a);
    const float ofBox = dot(abs(n), s.box) + size * ownDistance + unsure * (t.reach + length(s.box));
    const float ofBall =
        size * (s.radius + ownDistance) + unsure * (t.reach + length(s.ball) + s.radius);
    // Written so that NaN is near.
    const bool boxAhead = atBox > ofBox, boxBehind = atBox < -ofBox;
    const bool ballAhead = atBall > ofBall, ballBehind = atBall < -ofBall;
    return (boxAhead && ballAhead) || (boxBehind && ballBehind) ? PLANE_BESIDE
           : boxBehind && ballAhead                             ? PLANE_FORWARD
           : boxAhead && ballBehind                             ? PLANE_BACKWARD
                                                                : PLANE_NEAR;
}

bool isCrossed(uint side)
{
    return side == PLANE_FORWARD || side == PLANE_BACKWARD;
}

// Returns whether ways that pass an edge of a triangle may cross another number of triangles. side: of
// the triangle, which is crossed; neighbour: as in OccluderNeighbours; otherSide: of that triangle.
bool isOpenEdge(uint side, uint neighbour, uint otherSide)
{
    const bool turned = (neighbour & 1u) != 0u;
    return neighbour == NO_NEIGHBOUR || otherSide == PLANE_NEAR ||
           (isCrossed(otherSide) && (side != otherSide) != turned);
}

// Returns whether the way from the centre of the box to that of the ball, which crosses the triangle's
// plane, crosses the triangle.
bool crossesTriangle(Shaft s, ShaftTriangle t)
{
    const float ab = dot(cross(t.a, t.b), s.ball), bc = dot(cross(t.b, t.c), s.ball);
    const float ca = dot(cross(t.c, t.a), s.ball);
    return (ab >= 0.0 && bc >= 0.0 && ca >= 0.0) || (ab <= 0.0 && bc <= 0.0 && ca <= 0.0);
}

// A shaft as the way of a box that grows: at the share t of the way, it reaches from t low - box to
// t high + box.
struct LocalShaft {
    FacetCone cone;
    vec3 box;
    float slack;
};

// localFromView: linear part of the transform to the mesh's space.
LocalShaft shaftInSpaceOf(Shaft s, mat3 localFromView, float ownDistance)
{
    const vec3 size = s.box + ownDistance;
    vec3 box = abs(localFromView[0]) * size.x + abs(localFromView[1]) * size.y +
               abs(localFromView[2]) * size.z;
    const vec3 ball = localFromView * s.ball;
    vec3 radius = (s.radius + ownDistance) *
                  vec3(length(vec3(localFromView[0].x, localFromView[1].x, localFromView[2].x)),
                       length(vec3(localFromView[0].y, localFromView[1].y, localFromView[2].y)),
                       length(vec3(localFromView[0].z, localFromView[1].z, localFromView[2].z)));
    const vec3 sums = abs(localFromView[0] * s.ball.x) + abs(localFromView[1] * s.ball.y) +
                      abs(localFromView[2] * s.ball.z);
    const vec3 rounding = s.slack * (box + radius + sums);
    box += rounding;
    radius += rounding;
    const FacetCone cone =
        FacetCone(finiteInverse(ball - radius + box), finiteInverse(ball + radius - box), 1.0);
    return LocalShaft(cone, box, s.slack);
}

// Returns whether a box, relative to the centre of the box of receivers in the mesh's space, may touch
// the shaft.
bool shaftTouchesBox(LocalShaft s, vec3 low, vec3 high)
{
    const vec3 margin = s.box + s.slack * max(abs(low), abs(high));
    return coneTouches(s.cone, low - margin, high + margin);
}

// Returns whether a plane across the direction d separates the corners of a triangle from the shaft.
bool isBesideAlong(Shaft s, float ownDistance, ShaftTriangle t, vec3 d)
{
    const float corners = min(dot(d, t.a), min(dot(d, t.b), dot(d, t.c)));
    const float size = length(d);
    const float shaft = max(dot(abs(d), s.box), dot(d, s.ball) + size * s.radius);
    return corners > shaft + size * (ownDistance + s.slack * t.reach);
}

// Returns the point of the line from a to b that is nearest to the origin.
vec3 nearestOnLine(vec3 a, vec3 b)
{
    const vec3 way = b - a;
    return a + clamp(-dot(a, way) / max(dot(way, way), 1e-30), 0.0, 1.0) * way;
}

// Returns the shorter of two vectors.
vec3 shorterOf(vec3 a, vec3 b)
{
    return dot(a, a) < dot(b, b) ? a : b;
}

// Returns whether a triangle, or an edge whose last two corners are one, is known to be beside the
// shaft. Tries planes along the axis of the shaft and tilted so that they touch both box and ball.
bool isBesideShaft(Shaft s, float ownDistance, ShaftTriangle t)
{
    const float distance = length(s.ball);
    const vec3 axis = s.ball / distance;
    const vec3 a = t.a - dot(t.a, axis) * axis, b = t.b - dot(t.b, axis) * axis;
    const vec3 c = t.c - dot(t.c, axis) * axis;
    const vec3 aside =
        shorterOf(nearestOnLine(a, b), shorterOf(nearestOnLine(b, c), nearestOnLine(c, a)));
    const vec3 d = aside / max(length(aside), 1e-30);
    const float tilt = (dot(abs(d), s.box) - s.radius) / distance;
    return isBesideAlong(s, ownDistance, t, d) || isBesideAlong(s, ownDistance, t, d + tilt * axis);
}

#endif
