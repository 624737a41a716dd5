// SPDX-License-Identifier: Apache-2.0
// Tests triangles of an instance for a proof that it hides a light (lib/visibility/dark_proof.glsl).
// The includer provides the occluders' bindings, neighbours[], and PROOF_LEAF(i), the leaves that a
// lane has found (OccluderNode::leaf), of which there are at most PROOF_LEAVES.
#ifndef CND_SHADING_DARK_TRIANGLES
#define CND_SHADING_DARK_TRIANGLES

#include "lib/visibility/dark_proof.glsl"
#include "shading/occluder_leaf.glsl"

// The proof that one instance hides a light. Before the first one, call beginProof().
struct InstanceProof {
    Shaft shaft; // in the axes of the view or of the world, relative to the centre of the box
    uint turns;  // of loops, of all instances
    // These members are of the present instance.
    mat3 shaftFromLocal; // linear part of the transform
    vec3 localCentre;    // of the box
    LocalShaft local;
    float ownDistance;
    uint firstTriangle;
    uint crossings; // of the middle way
    bool failed;
};

void beginProof(inout InstanceProof p)
{
    p.turns = p.firstTriangle = p.crossings = 0u;
    p.failed = true;
}

// Begins with an instance. shaftFromLocal, localFromShaft: linear parts of transforms. centre: of the
// box, relative to the eye. ownDistance: bound of that part of ownSurfaceDistance() that depends on no
// instance.
void setInstance(inout InstanceProof p, OccluderInstance instance, mat3 shaftFromLocal,
                 mat3 localFromShaft, vec3 centre, float ownDistance)
{
    const vec3 box = p.shaft.box;
    p.firstTriangle = instance.firstTriangle;
    p.shaftFromLocal = shaftFromLocal;
    p.localCentre = localFromShaft * centre + instance.viewInLocal;
    const vec3 localBox = abs(localFromShaft[0]) * box.x + abs(localFromShaft[1]) * box.y +
                          abs(localFromShaft[2]) * box.z;
    p.ownDistance =
        ownDistance + ownSurfaceDistance(0.0, vec3(0.0), instance.surfaceError, shaftFromLocal,
                                         abs(p.localCentre) + localBox);
    p.local = shaftInSpaceOf(p.shaft, localFromShaft, p.ownDistance);
    p.crossings = 0u;
    p.failed = false;
}

// Returns whether the instance hides the light, after all of its triangles and edges were tested.
bool isProven(InstanceProof p)
{
    return !p.failed && p.crossings != 0u;
}

// Returns whether the triangle, or the edge whose last two corners are one, may touch the shaft. The
// corners are relative to the box.
bool mayTouch(InstanceProof p, vec3 a, vec3 b, vec3 c, ShaftTriangle t)
{
    return shaftTouchesBox(p.local, min(a, min(b, c)), max(a, max(b, c))) &&
           !isBesideShaft(p.shaft, p.ownDistance, t);
}

// Tests the triangles of the leaves first .. end - 1, of which there are at most PROOF_LEAVES. Sets a
// bit for each triangle that touches the shaft and whose plane every way crosses.
void testTriangles(inout InstanceProof p, uint first, uint end, out uvec2 forward,
                   out uvec2 backward)
{
    forward = backward = uvec2(0u);
    uint at = first, leaf = PROOF_LEAF(first), inLeaf = 0u;
    do {
        ++p.turns;
        if (at < end && !p.failed) {
            const OccluderTriangle t = occluderTriangle(p.firstTriangle + leafFirst(leaf));
            const vec3 a = t.corners[0] - p.localCentre, b = t.corners[1] - p.localCentre;
            const vec3 c = t.corners[2] - p.localCentre;
            const ShaftTriangle inView = triangleInView(p.shaftFromLocal, a, b, c);
            const uint side = planeSide(p.shaft, p.ownDistance, inView);
            const bool touches = side != PLANE_BESIDE && mayTouch(p, a, b, c, inView);
            p.failed = touches && side == PLANE_NEAR;
            p.crossings += touches && isCrossed(side) && crossesTriangle(p.shaft, inView) ? 1u : 0u;
            const uint place = OCCLUDER_LEAF_TRIANGLES * (at - first) + inLeaf;
            const uint bit = 1u << (place & 31u);
            const uvec2 one = place < 32u ? uvec2(bit, 0u) : uvec2(0u, bit);
            forward |= touches && side == PLANE_FORWARD ? one : uvec2(0u);
            backward |= touches && side == PLANE_BACKWARD ? one : uvec2(0u);
            leaf = withoutFirst(leaf);
            ++inLeaf;
            if (leafCount(leaf) == 0u) {
                ++at;
                leaf = PROOF_LEAF(min(at, end - 1u));
                inLeaf = 0u;
            }
        }
    } while (at < end && !p.failed);
    p.failed = p.failed || at < end; // the device may have ended the loop early
}

vec3 cornerOf(OccluderTriangle t, uint i)
{
    return i == 0u ? t.corners[0] : i == 1u ? t.corners[1] : t.corners[2];
}

// Returns whether an edge of a triangle may touch the shaft and change the number of crossings.
bool edgeFails(InstanceProof p, uint triangle, uint edge, uint side)
{
    const uint neighbour = neighbours[p.firstTriangle + triangle].edges[edge];
    const uint other = neighbour == NO_NEIGHBOUR ? triangle : neighbour >> 1;
    const OccluderTriangle o = occluderTriangle(p.firstTriangle + other);
    const uint otherSide = planeSide(
        p.shaft, p.ownDistance,
        triangleInView(p.shaftFromLocal, o.corners[0] - p.localCentre, o.corners[1] - p.localCentre,
                       o.corners[2] - p.localCentre));
    const OccluderTriangle t = occluderTriangle(p.firstTriangle + triangle);
    const vec3 from = cornerOf(t, edge) - p.localCentre;
    const vec3 to = cornerOf(t, edge == 2u ? 0u : edge + 1u) - p.localCentre;
    return isOpenEdge(side, neighbour, otherSide) &&
           mayTouch(p, from, to, to, triangleInView(p.shaftFromLocal, from, to, to));
}

// Tests the edges of the triangles in the masks.
void testEdges(inout InstanceProof p, uint first, uvec2 forward, uvec2 backward)
{
    uvec2 left = forward | backward;
    uint edge = 0u;
    do {
        ++p.turns;
        if (left != uvec2(0u) && !p.failed) {
            const bool inFirst = left.x != 0u;
            const uint bit = uint(findLSB(inFirst ? left.x : left.y));
            const uint place = inFirst ? bit : 32u + bit;
            const uint leaf = PROOF_LEAF(first + place / OCCLUDER_LEAF_TRIANGLES);
            const bool isForward = ((inFirst ? forward.x : forward.y) >> bit & 1u) != 0u;
            p.failed = edgeFails(p, leafFirst(leaf) + place % OCCLUDER_LEAF_TRIANGLES, edge,
                                 isForward ? PLANE_FORWARD : PLANE_BACKWARD);
            ++edge;
            if (edge == 3u) {
                edge = 0u;
                left &= inFirst ? uvec2(~(1u << bit), 0xFFFFFFFFu) : uvec2(0u, ~(1u << bit));
            }
        }
    } while (left != uvec2(0u) && !p.failed);
    p.failed = p.failed || left != uvec2(0u);
}

#endif
