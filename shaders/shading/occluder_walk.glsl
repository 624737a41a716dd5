// SPDX-License-Identifier: Apache-2.0
// Finds which points of a light's facet (lib/visibility) a receiver sees: it walks through the tree
// over the instances of occluders, and through the trees of the meshes that the light's cone touches.
// The lanes of a subgroup walk together, and visit what one of them needs. Lanes that walked alone
// would be in different meshes, and would wait for each other.
// The includer defines occluderInstance(), occluderNode() and occluderTriangle(), which read an
// element of an array (shared/occluder_data.h), and facetOf().
#ifndef CND_SHADING_OCCLUDER_WALK
#define CND_SHADING_OCCLUDER_WALK

#extension GL_KHR_shader_subgroup_arithmetic : require
#extension GL_KHR_shader_subgroup_vote : require
#include "lib/visibility/box_tests.glsl"
#include "lib/visibility/triangle_points.glsl"
#include "shading/occluder_leaf.glsl"
#include "shading/point_count.glsl"

// mostWalkTurns: some devices silently end loops after so many turns, which they count over all loops
// of an invocation (DECISIONS 12), less those that are left for other loops; 0: no limit. Hosts'
// shaders have no such constant.
#ifdef LIGHT_FAMILY_ALL
#define mostWalkTurns shadowView.walkTurns
#else
layout(constant_id = SPEC_WALK_TURNS) const uint mostWalkTurns = 0u;
#endif

uint walkTurns = 0u; // of all walks of this invocation

// What a walk is asked for.
struct OccluderQuery {
    uint light;       // for facetOf()
    vec3 position;    // of the receiver in view space, m
    float depthError; // of the receiver along its view ray, m (ownSurfaceDistance)
    uint layers;      // of the frame, as in OccluderRecord::flags
    uint ignored;     // the occluder layers that do not shadow the light, as in OccluderRecord::flags
};

// Returns the facet of the light. A walk calls it for every instance that it enters, because a facet
// would occupy too many registers meanwhile.
Facet facetOf(OccluderQuery q);

// The space of the tree over instances: the world, relative to an origin.
struct TreeSpace {
    mat3 viewFromTree;
    vec3 viewInTree; // position of the origin of view space
    uint firstNode;
};

// A receiver and a light's cone in the space of a tree.
struct WalkSpace {
    LightCoordinates coordinates;
    FacetCone whole;   // cone of all points
    FacetCone cone;    // in meshes: cone of the points that the mesh may hide
    vec3 position;     // of the receiver
    float slack;       // by which boxes are widened
    float ownDistance; // ownSurfaceDistance(), in meshes only
};

// A walk. It is either in the tree over instances or in the tree of a mesh.
struct OccluderWalk {
    // These members differ between lanes.
    uvec2 lit;  // points that no triangle has hidden so far
    bool walks; // false: the rest of the tree hides nothing from the lane
    uint shape; // of the facet
    FrontSurface front;
    WalkSpace space;
    // These members are the same in all lanes that walk together.
    bool inMesh;
    uint node, end;       // the next node of the tree, and the number of its nodes
    uint nextOfInstances; // the next node of the tree over instances while the walk is in a mesh
    uint instance;        // the instance that the walk is in
    uint firstNode, firstTriangle; // the first ones of its mesh
    uint leaf; // instances that were found and have not been entered: as OccluderNode::leaf
};

// The walk before its first step: at the end of a mesh.
OccluderWalk walkFromRoot()
{
    OccluderWalk w;
    w.lit = uvec2(0xFFFFFFFFu);
    w.walks = true;
    w.inMesh = true;
    w.node = w.end = 0u;
    w.nextOfInstances = 0u;
    w.leaf = 0u;
    w.instance = w.firstNode = w.firstTriangle = 0u;
    return w;
}

// Returns the points that are still lit and that triangles in the box of a node may hide.
uvec2 litPointsIn(OccluderWalk w, OccluderNode node)
{
    return w.lit & boxPoints(pointCount, w.shape, w.front, w.space.coordinates,
                             (node.low - w.space.position) - w.space.slack,
                             (node.high - w.space.position) + w.space.slack);
}

void setFacet(inout OccluderWalk w, Facet f)
{
    w.lit &= f.members;
    w.shape = f.shape;
    w.front = f.front;
}

// Sets what tests of triangles need in the space of a tree. vectors: those of the facet there.
void setSpace(inout WalkSpace s, Facet f, FacetVectors vectors, OccluderNode root,
              mat3 viewFromLocal, vec3 position)
{
    s.coordinates = inSpaceOf(lightCoordinates(f), viewFromLocal);
    s.position = position;
    const vec3 farthest = max(abs(root.low - position), abs(root.high - position));
    s.slack = BOX_SLACK * (1.0 + norm1(position)) +
              roundingOf(vectors, s.coordinates) * norm1(farthest);
    s.whole = facetCone(f, vectors, ALL_POINTS);
}

// Enters the space of a tree. In a mesh, the cone holds only the points that the mesh may hide; if it
// hides none, the lane does not walk in it.
void enterSpace(inout OccluderWalk w, OccluderQuery q, mat3 viewFromLocal, mat3 localFromView,
                vec3 position)
{
    const Facet f = facetOf(q);
    const FacetVectors vectors = facetVectors(f, localFromView);
    setFacet(w, f);
    const OccluderNode root = occluderNode(w.firstNode);
    w.end = root.skip;
    setSpace(w.space, f, vectors, root, viewFromLocal, position);
    const uvec2 points = isEmpty(w.lit) ? uvec2(0u) : litPointsIn(w, root);
    w.walks = !isEmpty(points);
    w.space.cone = w.space.whole;
    if (w.inMesh && w.walks)
        w.space.cone = facetCone(f, vectors, pointBounds(pointCount, f.shape, points));
}

// Sets the instance whose triangles are tested. Returns the position of the receiver there.
vec3 setInstance(inout OccluderWalk w, OccluderQuery q, uint at, OccluderInstance instance)
{
    w.instance = at;
    w.firstNode = instance.firstNode;
    w.firstTriangle = instance.firstTriangle;
    const vec3 position = instance.localFromView * q.position + instance.viewInLocal;
    w.space.ownDistance = ownSurfaceDistance(q.depthError, q.position, instance.surfaceError,
                                             instance.viewFromLocal, position);
    return position;
}

// Enters the first instance of the leaf or, if the leaf is empty, returns to the tree over instances.
// asks: false: the lane only waits for others.
void changeTree(inout OccluderWalk w, OccluderQuery q, TreeSpace tree, bool asks)
{
    if (!w.inMesh)
        w.nextOfInstances = w.node;
    w.inMesh = leafCount(w.leaf) != 0u;
    mat3 viewFromLocal = tree.viewFromTree, localFromView = transpose(tree.viewFromTree);
    vec3 position = tree.viewInTree + localFromView * q.position;
    w.node = w.nextOfInstances;
    w.firstNode = tree.firstNode;
    w.space.ownDistance = 0.0;
    bool counts = asks;
    if (w.inMesh) {
        const OccluderInstance instance = occluderInstance(leafFirst(w.leaf));
        position = setInstance(w, q, leafFirst(w.leaf), instance);
        w.leaf = withoutFirst(w.leaf);
        counts = asks && (instance.flags & q.layers) != 0u && (instance.flags & q.ignored) == 0u;
        w.node = 0u;
        viewFromLocal = instance.viewFromLocal;
        localFromView = instance.localFromView;
    }
    enterSpace(w, q, viewFromLocal, localFromView, position);
    w.walks = w.walks && counts;
    if (!subgroupAny(w.walks))
        w.node = w.end;
}

// Returns whether a cone touches a box in the space of the walk.
bool boxIsInCone(OccluderWalk w, FacetCone cone, vec3 low, vec3 high)
{
    return coneTouches(cone, (low - w.space.position) - w.space.slack,
                       (high - w.space.position) + w.space.slack);
}

// A triangle hides nothing if its own box is beside the cone of all points. Otherwise rounding would
// decide which triangles the walk leaves out.
uvec2 pointsHiddenBy(OccluderWalk w, uint triangle, inout uint turns)
{
    const OccluderTriangle t = occluderTriangle(w.firstTriangle + triangle);
    if (!boxIsInCone(w, w.space.whole, min(t.corners[0], min(t.corners[1], t.corners[2])),
                     max(t.corners[0], max(t.corners[1], t.corners[2]))))
        return uvec2(0u);
    return trianglePoints(pointCount, w.shape, w.front, w.space.coordinates,
                          occluderInstance(w.instance).localFromView,
                          t.corners[0] - w.space.position, t.corners[1] - w.space.position,
                          t.corners[2] - w.space.position, w.space.ownDistance, w.lit, turns);
}

// Returns how many turns the device counts, if it limits loops: the lanes that run together take the
// turns of the slowest one in each loop.
uint turnsOfAll(uint turns)
{
    return mostWalkTurns != 0u ? subgroupMax(turns) : turns;
}

bool mayWalk()
{
    return mostWalkTurns == 0u || walkTurns < mostWalkTurns;
}

// Walks on to the next leaf with triangles or instances that may hide points of a lane. Returns it as
// OccluderNode::leaf. 0: the tree has ended, or the lanes may not walk on.
uint nextLeaf(inout OccluderWalk w)
{
    uint leaf = 0u;
    OccluderNode node;
    do {
        do {
            ++walkTurns;
            // At the end of the tree, its root leads there: other nodes may be of a removed mesh.
            node = occluderNode(w.firstNode + (w.node < w.end ? w.node : 0u));
            const bool touches = w.walks && boxIsInCone(w, w.space.cone, node.low, node.high);
            const bool visits = w.node < w.end && subgroupAny(touches);
            leaf = visits ? node.leaf : 0u;
            w.node = visits && leaf == 0u ? w.node + 1u : node.skip;
        } while (leaf == 0u && w.node < w.end && mayWalk());
        ++walkTurns;
        if (!subgroupAny(w.walks && !isEmpty(litPointsIn(w, node))))
            leaf = 0u;
    } while (leaf == 0u && w.node < w.end && mayWalk());
    return leaf;
}

// Tests the triangles of a leaf. 0: there are none.
void testLeaf(inout OccluderWalk w, uint leaf)
{
    do {
        uint points = 0u;
        if (leafCount(leaf) != 0u) {
            if (w.walks)
                w.lit &= ~pointsHiddenBy(w, leafFirst(leaf), points);
            leaf = withoutFirst(leaf);
        }
        walkTurns += 3u + turnsOfAll(points); // loops over no points take a turn, too
    } while (leafCount(leaf) != 0u);
    w.walks = w.walks && !isEmpty(w.lit);
}

// Returns the points of the facet that the receiver sees. asks: false: the lane only waits for others.
// isFinished: false: the device ends loops too early, and occluders may be missing.
uvec2 visiblePoints(OccluderQuery q, TreeSpace tree, bool asks, out bool isFinished)
{
    OccluderWalk w = walkFromRoot();
    bool isDone = false;
    while (!isDone && mayWalk()) {
        if (w.inMesh ? w.node >= w.end : leafCount(w.leaf) != 0u)
            changeTree(w, q, tree, asks);
        bool isLit;
        do {
            const uint leaf = nextLeaf(w);
            testLeaf(w, w.inMesh ? leaf : 0u);
            if (!w.inMesh)
                w.leaf = leaf;
            isLit = subgroupAny(asks && !isEmpty(w.lit));
            ++walkTurns;
        } while (isLit && w.inMesh && w.node < w.end && mayWalk());
        isDone = !isLit || (!w.inMesh && w.node >= w.end && leafCount(w.leaf) == 0u);
        ++walkTurns;
    }
    isFinished = !asks || isDone || isEmpty(w.lit);
    return w.lit;
}

#endif
