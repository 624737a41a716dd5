// SPDX-License-Identifier: Apache-2.0
// Which triangles may hide points of a light from the samples of a cluster: those that touch the shaft
// from the box of the samples to a ball around the light. In the walk of a sample (box_tests.glsl), no
// other triangle hides a point.
#ifndef CND_LIB_VISIBILITY_SHAFT
#define CND_LIB_VISIBILITY_SHAFT

#include "lib/visibility/box_tests.glsl"
#include "lib/visibility/triangle_points.glsl"

// Samples in a box, and a ball that holds all points of the facets that the samples see.
struct ShaftEnds {
    vec3 middle; // of the box, m
    vec3 halfBox;
    vec3 ball; // its centre
    float radius;
    float rounding;    // at least roundingOf() for each sample, in spaces that are only rotated
    float ownDistance; // SampleBounds::ownDistance
};

// A shaft in the space of a tree.
struct ClusterShaft {
    vec3 low; // of the samples
    vec3 high;
    vec3 ball;
    FacetCone cone; // at t, from t (low side of the ball - low) to t (high side - high)
    float slack;    // by which boxes are widened
    float rounding; // as ShaftEnds::rounding, in this space
    vec3 error;     // bound of the rounding of positions, per axis
};

// Returns the lowest and the highest distance of a sample from a point.
vec2 distancesFrom(ShaftEnds s, vec3 point)
{
    const vec3 aside = abs(point - s.middle);
    return vec2(length(max(aside - s.halfBox, vec3(0.0))), length(aside + s.halfBox));
}

// Returns a bound of roundingOf() for facets with half axes of these lengths that are seen at this sine
// of the elevation. distanceRatio: lowest distance over the longer half axis.
float facetRounding(float lengthU, float lengthV, float sine, float distanceRatio)
{
    const float ratio = max(lengthU, lengthV) / min(lengthU, lengthV);
    return COORDINATE_SLACK * (4.0 + ratio + 2.0 / distanceRatio) / sine;
}

// Returns the lowest sine of the elevation at which the samples see the facet of a flat light. normal:
// unit.
float lowestSine(ShaftEnds s, vec3 normal)
{
    const float height = abs(dot(normal, s.ball - s.middle)) - dot(abs(normal), s.halfBox);
    return max(height / distancesFrom(s, s.ball).y, 0.5 * MIN_FACET_SLOPE);
}

// Returns the largest distance of a point from the samples on each axis.
vec3 farthestAlong(ClusterShaft s, vec3 point)
{
    return max(abs(point - s.low), abs(point - s.high));
}

// localFromTree, translation: the transform from the space of s.
// anisotropy: product of the Frobenius norms of both directions of the transform, at least 3.
// rootLow, rootHigh: box of the tree.
ClusterShaft shaftIn(ShaftEnds s, mat3 localFromTree, vec3 translation, float anisotropy,
                     vec3 rootLow, vec3 rootHigh)
{
    const mat3 sizes = mat3(abs(localFromTree[0]), abs(localFromTree[1]), abs(localFromTree[2]));
    const vec3 middle = localFromTree * s.middle + translation;
    const vec3 halfBox = sizes * s.halfBox;
    ClusterShaft shaft;
    shaft.low = middle - halfBox;
    shaft.high = middle + halfBox;
    shaft.ball = localFromTree * s.ball + translation;
    const vec3 extent =
        s.radius * sqrt(localFromTree[0] * localFromTree[0] + localFromTree[1] * localFromTree[1] +
                        localFromTree[2] * localFromTree[2]);
    shaft.cone = FacetCone(finiteInverse(shaft.ball - extent - shaft.low),
                           finiteInverse(shaft.ball + extent - shaft.high), 1.0);
    const vec3 farthest = max(farthestAlong(shaft, rootLow), farthestAlong(shaft, rootHigh));
    const vec3 summed = sizes * (abs(s.middle) + s.halfBox) + abs(translation);
    shaft.rounding = s.rounding * anisotropy;
    shaft.slack = 2.0 * BOX_SLACK * (1.0 + norm1(summed)) + shaft.rounding * norm1(farthest);
    shaft.error = EDGE_SLACK * (abs(translation) + halfBox);
    return shaft;
}

bool shaftTouches(ClusterShaft s, vec3 boxMin, vec3 boxMax)
{
    return coneTouches(s.cone, (boxMin - s.high) - s.slack, (boxMax - s.low) + s.slack);
}

// Returns whether the plane of a triangle has the ball and all samples on one side, so that it hides
// nothing. Samples on the other side do not count if the plane is so near that they take it for their
// own surface. localFromView: linear part of the transform.
bool isBehindAll(ClusterShaft s, ShaftEnds ends, float surfaceError, mat3 localFromView, vec3 a, vec3 b,
                 vec3 c)
{
    const vec3 ab = b - a, ac = c - a;
    const vec3 n = cross(ab, ac);
    const vec3 nError = EDGE_SLACK * (abs(ab.yzx * ac.zxy) + abs(ab.zxy * ac.yzx) + abs(n));
    const float inView = length(n * localFromView); // how steep dot(n, x) is in view space
    if (!(inView > 1e-15)) // its square is near the smallest floats
        return false;
    const vec3 toBall = s.ball - a, toSamples = 0.5 * (s.low + s.high) - a;
    const vec3 halfBox = 0.5 * (s.high - s.low);
    const vec3 farthest = max(farthestAlong(s, a), max(farthestAlong(s, b), farthestAlong(s, c)));
    const float atBall = dot(n, toBall);
    const float ballError = dot(nError, abs(toBall)) +
                            dot(abs(n), 2.0 * (s.error + EDGE_SLACK * abs(s.ball))) +
                            s.rounding * norm1(n) * norm1(farthest);
    if (!(abs(atBall) > ends.radius * inView + ballError))
        return false;
    const float side = atBall < 0.0 ? -1.0 : 1.0;
    const float lowest = side * dot(n, toSamples) - dot(abs(n), halfBox);
    const float error = dot(nError, abs(toSamples) + halfBox) + dot(abs(n), s.error);
    return lowest - error >= -(ends.ownDistance + surfaceError) * inView;
}

#endif
