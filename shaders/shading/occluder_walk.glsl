// SPDX-License-Identifier: Apache-2.0
// Finds which points of a light's facet (lib/visibility) a receiver sees: it walks through the tree
// over the instances of occluders, and through the trees of the meshes that the light's cone touches.
// The includer defines occluderInstance(), occluderNode() and occluderTriangle(), which read an
// element of an array (shared/occluder_data.h), and facetOf(). A kernel defines QUEUE_LANES, the
// number of lanes of a group, if lanes may keep queues in shared memory.
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

const uint ROUND_TURNS = 1024u; // at most, of the loop in a round of a walk that finds leaves
uint walkTurns = 0u; // of all walks of this invocation

// The leaves that a lane has found and whose triangles it has not tested.
const uint LEAF_QUEUE = 16u;
#ifdef QUEUE_LANES
shared uint leafQueue[LEAF_QUEUE * QUEUE_LANES];
#define QUEUED_LEAF(i) leafQueue[(i) * QUEUE_LANES + gl_LocalInvocationIndex]
#else
uint leafQueue[LEAF_QUEUE];
#define QUEUED_LEAF(i) leafQueue[i]
#endif

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
    uvec2 lit; // points that no triangle has hidden so far
    bool inMesh;
    uint node, end;           // the next node of the tree, and the number of its nodes
    uint nextOfInstances;     // the next node of the tree over instances while the walk is in a mesh
    uint instance;            // that the walk is in
    uint firstNode, firstTriangle; // of its mesh
    uint leaf; // instances that were found and have not been entered: as OccluderNode::leaf
    uint shape; // of the facet
    FrontSurface front;
    WalkSpace space;
};

// The walk before its first step: at the end of a mesh.
OccluderWalk walkFromRoot()
{
    OccluderWalk w;
    w.lit = uvec2(0xFFFFFFFFu);
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

// Sets what depends on the space of the tree that the walk has come to. In a mesh, the cone holds only
// the points that the mesh may hide; if it hides none, the walk is at its end.
void enterSpace(inout OccluderWalk w, OccluderQuery q, mat3 viewFromLocal, mat3 localFromView,
                vec3 position)
{
    const Facet f = facetOf(q);
    const FacetVectors vectors = facetVectors(f, localFromView);
    w.lit &= f.members;
    w.shape = f.shape;
    w.front = f.front;
    w.space.coordinates = inSpaceOf(lightCoordinates(f), viewFromLocal);
    w.space.position = position;
    const OccluderNode root = occluderNode(w.firstNode);
    w.end = root.skip;
    const vec3 farthest = max(abs(root.low - position), abs(root.high - position));
    w.space.slack = BOX_SLACK * (1.0 + norm1(position)) +
                    roundingOf(vectors, w.space.coordinates) * norm1(farthest);
    const uvec2 points = isEmpty(w.lit) ? uvec2(0u) : litPointsIn(w, root);
    if (isEmpty(points))
        w.node = w.end;
    w.space.whole = facetCone(f, vectors, ALL_POINTS);
    w.space.cone = facetCone(f, vectors,
                             w.inMesh && !isEmpty(points) ? pointBounds(pointCount, f.shape, points)
                                                          : ALL_POINTS);
}

// Enters the first instance of the leaf or, if the leaf is empty, returns to the tree over instances.
// An instance that does not count has no nodes.
void changeTree(inout OccluderWalk w, OccluderQuery q, TreeSpace tree)
{
    if (!w.inMesh)
        w.nextOfInstances = w.node;
    w.inMesh = leafCount(w.leaf) != 0u;
    mat3 viewFromLocal = tree.viewFromTree, localFromView = transpose(tree.viewFromTree);
    vec3 position = tree.viewInTree + localFromView * q.position;
    w.node = w.nextOfInstances;
    w.firstNode = tree.firstNode;
    w.space.ownDistance = 0.0;
    bool counts = true;
    if (w.inMesh) {
        w.instance = leafFirst(w.leaf);
        w.leaf = withoutFirst(w.leaf);
        const OccluderInstance instance = occluderInstance(w.instance);
        w.firstNode = instance.firstNode;
        w.firstTriangle = instance.firstTriangle;
        counts = (instance.flags & q.layers) != 0u && (instance.flags & q.ignored) == 0u;
        w.node = 0u;
        viewFromLocal = instance.viewFromLocal;
        localFromView = instance.localFromView;
        position = localFromView * q.position + instance.viewInLocal;
        w.space.ownDistance = ownSurfaceDistance(q.depthError, q.position, instance.surfaceError,
                                                 viewFromLocal, position);
    }
    enterSpace(w, q, viewFromLocal, localFromView, position);
    if (!counts)
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

// Walks on until the tree ends, the queue is full, or a leaf with instances is found that may hide
// points. Returns how many leaves are in the queue.
uint findLeaves(inout OccluderWalk w, inout uint turns)
{
    uint queued = 0u;
    bool found = false, walks;
    OccluderNode node;
    do { // This loop ends in all lanes at once (visiblePoints).
        do {
            ++turns;
            if (w.node < w.end && queued < LEAF_QUEUE && !found) {
                node = occluderNode(w.firstNode + w.node);
                const bool touches = boxIsInCone(w, w.space.cone, node.low, node.high);
                const bool isLeaf = touches && node.leaf != 0u;
                if (isLeaf && w.inMesh) {
                    QUEUED_LEAF(queued) = node.leaf;
                    ++queued;
                }
                found = isLeaf && !w.inMesh;
                w.node = touches && !isLeaf ? w.node + 1u : node.skip;
            }
        } while (w.node < w.end && queued < LEAF_QUEUE && !found && turns < ROUND_TURNS);
        turns = turnsOfAll(turns) + 1u;
        found = found && !isEmpty(litPointsIn(w, node));
        walks = w.node < w.end && queued < LEAF_QUEUE && !found && turns < ROUND_TURNS;
    } while (subgroupAny(walks));
    if (found)
        w.leaf = node.leaf;
    return queued;
}

// Tests the triangles of the leaves in the queue.
void testLeaves(inout OccluderWalk w, uint queued, inout uint turns)
{
    uint at = 0u;
    uint leaf = QUEUED_LEAF(0u);
    do {
        turns = turnsOfAll(turns) + 1u;
        if (at < queued && !isEmpty(w.lit)) {
            w.lit &= ~pointsHiddenBy(w, leafFirst(leaf), turns);
            leaf = withoutFirst(leaf);
            if (leafCount(leaf) == 0u) {
                ++at;
                leaf = QUEUED_LEAF(min(at, LEAF_QUEUE - 1u));
            }
        }
    } while (at < queued && !isEmpty(w.lit));
}

// Returns the points of the facet that the receiver sees. asks: false: the lane only waits for others.
// isFinished: false: the device ends loops too early, and occluders may be missing.
uvec2 visiblePoints(OccluderQuery q, TreeSpace tree, bool asks, out bool isFinished)
{
    OccluderWalk w = walkFromRoot();
    const bool mayWalk = mostWalkTurns == 0u || walkTurns < mostWalkTurns;
    bool walks = asks && mayWalk;
    // This loop may not differ between lanes, nor may the outer loop of findLeaves(): llvmpipe would
    // lose leaves. The loops inside them may.
    do {
        uint turns = 1u;
        if (walks) {
            const bool found = leafCount(w.leaf) != 0u;
            if (w.inMesh ? w.node >= w.end : found)
                changeTree(w, q, tree);
            const uint queued = findLeaves(w, turns);
            if (queued != 0u)
                testLeaves(w, queued, turns);
            const bool isDone = !w.inMesh && w.node >= w.end && leafCount(w.leaf) == 0u;
            walks = !isEmpty(w.lit) && !isDone;
        }
        walkTurns += turnsOfAll(turns);
    } while (subgroupAny(walks) && (mostWalkTurns == 0u || walkTurns < mostWalkTurns));
    isFinished = !asks || (mayWalk && !walks);
    return w.lit;
}

#endif
