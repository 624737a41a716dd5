// SPDX-License-Identifier: Apache-2.0
// Lists, for each pair of cluster and light that asks, the triangles that may shadow samples of the
// cluster, so that pixels test these alone. Pairs with many triangles get no list, and their pixels
// walk through the trees. A pair needs no slot if it has no triangles, or if those of one instance are
// proven to hide the light (lib/visibility/dark_proof.glsl). If there is no slot for another pair, the
// cluster's pixels walk the light tree.
#version 460
#extension GL_GOOGLE_include_directive : require
#extension GL_KHR_shader_subgroup_arithmetic : require
#extension GL_KHR_shader_subgroup_ballot : require
#extension GL_KHR_shader_subgroup_vote : require
#include "shared/occluder_data.h"

layout(local_size_x = LIST_OCCLUDERS_GROUP) in;
layout(push_constant, scalar) uniform Push
{
    ListOccludersParams params;
};
layout(scalar, binding = SHADE_SHAPES) readonly buffer LightShapes
{
    LightShape lightShapes[];
};
layout(scalar, binding = LIST_OCCLUDERS_BOUNDS) readonly buffer Bounds
{
    SampleBounds bounds[];
};
layout(scalar, binding = SHADE_COUNTERS) buffer ShadowCounterBuffer
{
    ShadowCounters shadowCounters;
};
layout(scalar, binding = LIST_OCCLUDERS_COUNTERS) buffer Counters
{
    LightingCounters counters;
};
layout(scalar, binding = LIST_OCCLUDERS_NEIGHBOURS) readonly buffer Neighbours
{
    OccluderNeighbours neighbours[];
};
layout(scalar, binding = SHADE_TILES) buffer Tiles
{
    TileClusters tiles[];
};
layout(scalar, binding = SHADE_LISTS) buffer Lists
{
    uint lists[];
};
layout(scalar, binding = LIST_OCCLUDERS_UNLISTED) buffer Unlisted
{
    WorkList unlisted[TILE_WORK_LISTS];
    uint unlistedTiles[];
};
#define ASKED_PAIRS LIST_OCCLUDERS_ASKED
#define ASKED_ACCESS
#include "kernels/common/asked_pairs.glsl"
#include "kernels/common/light_stream.glsl"
#include "kernels/common/append_unlisted.glsl"
#include "shading/facet_shape.glsl"
#include "shading/occluder_buffers.glsl"
#include "shading/occluder_leaf.glsl"
// It needs pointTable() of the buffers.
#include "lib/visibility/shaft.glsl"

// Items of a pair, at most (DECISIONS 81).
const uint MAX_ITEMS = 32u;
// Node steps of a lane, at most, so that all loops stay below the 65,535 turns of llvmpipe.
const uint MAX_TURNS = 4096u;
const float MAX_ROUNDING = 4e-3; // of the light coordinates of pairs that are listed (roundingOf)
shared uint foundItems[MAX_ITEMS * LIST_OCCLUDERS_GROUP];
#define FOUND_ITEM(i) foundItems[(i)*LIST_OCCLUDERS_GROUP + gl_LocalInvocationIndex]
#define PROOF_LEAF(i) FOUND_ITEM(i)
#include "shading/dark_triangles.glsl"

// A walk through the trees with the shaft of a pair.
struct ShaftWalk {
    ClusterShaft shaft;   // in the space of the tree that the walk is in
    bool inMesh;          // false: in the tree over instances
    uint node, end;       // the next node, and the number of nodes
    uint nextOfInstances; // the next node of the tree over instances while the walk is in a mesh
    uint firstNode, firstTriangle; // of the tree
    uint instance;
    uint instances, triangles; // that were found and have not been visited, as OccluderNode::leaf
    uint kept;                 // triangles of the present leaf that count, as OccluderNode::leaf
    uint items;                // that were found
    uint listed;               // the last instance among them
};

// Tells whether the next step is to the next node of the tree.
bool isAtNode(ShaftWalk w)
{
    return w.node < w.end && leafCount(w.triangles) == 0u &&
           (w.inMesh || leafCount(w.instances) == 0u);
}

bool isAtEnd(ShaftWalk w)
{
    return !w.inMesh && w.node >= w.end && leafCount(w.instances) == 0u;
}

// Enters the next instance that was found or, if there is none, returns to the tree over instances.
void changeTree(inout ShaftWalk w, ShaftEnds ends, uint layers, uint ignored)
{
    if (!w.inMesh)
        w.nextOfInstances = w.node;
    w.inMesh = leafCount(w.instances) != 0u;
    mat3 localFromTree = mat3(1.0);
    vec3 translation = shadowView.viewInTree;
    float anisotropy = 3.0;
    bool counts = true;
    w.node = w.nextOfInstances;
    w.firstNode = shadowView.firstNode;
    if (w.inMesh) {
        w.instance = leafFirst(w.instances);
        w.instances = withoutFirst(w.instances);
        const OccluderInstance instance = occluderInstance(w.instance);
        counts = (instance.flags & layers) != 0u && (instance.flags & ignored) == 0u;
        w.firstNode = instance.firstNode;
        w.firstTriangle = instance.firstTriangle;
        w.node = 0u;
        localFromTree = instance.localFromView * shadowView.viewFromTree;
        translation = instance.viewInLocal;
        const mat3 back = instance.viewFromLocal;
        anisotropy = sqrt(
            (length2(localFromTree[0]) + length2(localFromTree[1]) + length2(localFromTree[2])) *
            (length2(back[0]) + length2(back[1]) + length2(back[2])));
    }
    const OccluderNode root = occluderNode(w.firstNode);
    w.end = root.skip;
    if (!counts)
        w.node = w.end;
    w.shaft = shaftIn(ends, localFromTree, translation, anisotropy, root.low, root.high);
}

// Also counts items that there is no room for.
void addItem(inout ShaftWalk w, uint item)
{
    if (w.items < MAX_ITEMS)
        FOUND_ITEM(w.items) = item;
    ++w.items;
}

// Tests a triangle. After the last one of a leaf, those that count become an item.
void visitTriangle(inout ShaftWalk w, ShaftEnds ends)
{
    const uint at = leafFirst(w.triangles);
    w.triangles = withoutFirst(w.triangles);
    const OccluderTriangle t = occluderTriangle(w.firstTriangle + at);
    const vec3 a = t.corners[0], b = t.corners[1], c = t.corners[2];
    bool counts = shaftTouches(w.shaft, min(a, min(b, c)), max(a, max(b, c)));
    if (counts) {
        const OccluderInstance instance = occluderInstance(w.instance);
        counts =
            !isBehindAll(w.shaft, ends, instance.surfaceError, instance.localFromView, a, b, c);
    }
    if (counts) {
        const uint first = leafCount(w.kept) == 0u ? at : leafFirst(w.kept);
        w.kept = (first << OCCLUDER_LEAF_SHIFT) + (at + 1u - first);
    }
    if (leafCount(w.triangles) == 0u && leafCount(w.kept) != 0u) {
        if (w.instance != w.listed)
            addItem(w, ITEM_IS_INSTANCE | w.instance);
        addItem(w, w.kept);
        w.listed = w.instance;
        w.kept = 0u;
    }
}

void visitNode(inout ShaftWalk w)
{
    const OccluderNode node = occluderNode(w.firstNode + w.node);
    const bool touches = shaftTouches(w.shaft, node.low, node.high);
    if (touches && node.leaf != 0u) {
        if (w.inMesh)
            w.triangles = node.leaf;
        else
            w.instances = node.leaf;
    }
    w.node = touches && node.leaf == 0u ? w.node + 1u : node.skip;
}

// Finds the items of a pair. Returns false if they are too many to list. walks: false: the lane
// only waits for others.
bool findItems(ShaftEnds ends, uint layers, uint ignored, bool walks, out uint count)
{
    ShaftWalk w;
    w.inMesh = true; // at the end of a mesh: the first turn goes to the tree over instances
    w.node = w.end = w.nextOfInstances = 0u;
    w.firstNode = w.firstTriangle = w.instance = 0u;
    w.instances = w.triangles = w.kept = w.items = 0u;
    w.listed = ITEM_IS_INSTANCE; // no instance has this index
    uint turns = 0u;
    bool left = walks;
    do { // This loop ends in all lanes at once: llvmpipe would lose nodes if lanes left it one by one.
        do {
            if (left && isAtNode(w))
                visitNode(w);
            ++turns;
        } while (left && isAtNode(w) && turns < MAX_TURNS);
        turns = subgroupMax(turns);
        do {
            if (left && leafCount(w.triangles) != 0u)
                visitTriangle(w, ends);
        } while (left && leafCount(w.triangles) != 0u);
        if (left && (w.inMesh ? w.node >= w.end : leafCount(w.instances) != 0u))
            changeTree(w, ends, layers, ignored);
        left = left && !isAtEnd(w) && w.items <= MAX_ITEMS;
    } while (subgroupAny(left) && turns < MAX_TURNS);
    count = w.items;
    return !left && w.items <= MAX_ITEMS;
}

// Sets the end of the shaft at the light. Returns false if the pairs of the light are not listed,
// because samples are near it, or light coordinates are not precise.
bool reachesLight(uint light, FacetShape given, inout ShaftEnds ends)
{
    const vec4 centreRadius = lightCentre(light);
    const vec3 axisU = given.shape.axisU, axisV = given.shape.axisV;
    ends.ball = (centreRadius.xyz + given.centre) * shadowView.viewFromTree;
    ends.radius = centreRadius.w;
    if (params.lightType == LIGHT_POLYGON)
        ends.radius = sqrt(length2(axisU) + length2(axisV));
    const vec2 distances = distancesFrom(ends, ends.ball);
    const float size = max(ends.radius, distances.x * MIN_FACET_SIZE);
    float u = 1.0, v = 1.0, sine = 1.0, distanceRatio = distances.x / size;
    bool isFar = distanceRatio > 1.05;
    if (params.lightType == LIGHT_SPHERE)
        distanceRatio = sqrt(max(distanceRatio * distanceRatio - 1.0, 1e-4));
    else if (params.lightType == LIGHT_DISC)
        sine = lowestSine(ends, axisU * shadowView.viewFromTree);
    else if (params.lightType == LIGHT_RECTANGLE || params.lightType == LIGHT_POLYGON) {
        u = length(axisU);
        v = length(axisV);
        sine = lowestSine(ends, normalize(cross(axisU / u, axisV / v)) * shadowView.viewFromTree);
    } else if (params.lightType == LIGHT_TUBE) {
        // From its ends, a tube's facet is seen as flat as the tube is thin.
        isFar = distanceRatio > 2.0;
        u = length(axisU) + given.shape.radius;
        v = given.shape.radius;
        sine = 0.5 * v / u;
        ends.radius *= 2.0;
    }
    if (params.lightType == LIGHT_DISC || params.lightType == LIGHT_RECTANGLE ||
        params.lightType == LIGHT_POLYGON)
        ends.radius *= SHEARED_RADIUS;
    ends.radius += 2.0 * MIN_FACET_SIZE * distances.y;
    const float least = distances.x * MIN_FACET_SIZE; // length of the facet's half axes
    ends.rounding = facetRounding(max(u, least), max(v, least), sine, distanceRatio);
    return isFar && ends.rounding < MAX_ROUNDING;
}

// Returns whether the triangles of one instance in the list hide the light from all samples. The other
// triangles of the instance have the light and all samples on one side, or are beside the shaft. So no
// way crosses their edges with triangles of the list, or planeSide() finds these edges open. The ball
// is that of the list. tries: false: the lane only waits for others.
bool isProvenDark(uint light, FacetShape given, float ownDistance, ShaftEnds ends, uint count,
                  bool tries)
{
    const mat3 treeFromView = transpose(shadowView.viewFromTree);
    LightShape shape = given.shape;
    shape.axisU = treeFromView * shape.axisU;
    shape.axisV = treeFromView * shape.axisV;
    const bool isPolygon = params.lightType == LIGHT_POLYGON; // its facet is a rectangle
    const float radius = isPolygon ? sqrt(length2(shape.axisU) + length2(shape.axisV))
                                   : lightCentre(light).w;
    InstanceProof p;
    beginProof(p);
    const bool inShaft = shaftTo(ends.halfBox, isPolygon ? LIGHT_RECTANGLE : params.lightType,
                                 ends.ball - ends.middle, radius, shape, p.shaft);
    uint at = 0u;
    bool dark = false, left = tries && inShaft && count != 0u;
    do { // This loop ends in all lanes at once, as in findItems().
        if (left) {
            const OccluderInstance o = occluderInstance(FOUND_ITEM(at) & ~ITEM_IS_INSTANCE);
            const uint first = at + 1u;
            do
                ++at;
            while (at < count && (FOUND_ITEM(at) & ITEM_IS_INSTANCE) == 0u);
            setInstance(p, o, treeFromView * o.viewFromLocal,
                        o.localFromView * shadowView.viewFromTree, ends.middle,
                        ownDistance);
            uvec2 forward, backward;
            p.failed = at - first > PROOF_LEAVES;
            testTriangles(p, first, at, forward, backward);
            p.failed = p.failed || p.crossings == 0u;
            testEdges(p, first, forward, backward);
            dark = isProven(p);
            left = !dark && at < count;
        }
    } while (subgroupAny(left));
    return dark;
}

// Adds n of each lane to a counter. Returns the value before, plus n of the lanes before this one.
#define TAKE_PLACES(counter, n, place)                                                             \
    {                                                                                              \
        const uint before = subgroupExclusiveAdd(n), all = subgroupAdd(n);                         \
        uint firstOfAll = 0u;                                                                      \
        if (subgroupElect() && all != 0u)                                                          \
            firstOfAll = atomicAdd(counter, all);                                                  \
        place = subgroupBroadcastFirst(firstOfAll) + before;                                       \
    }

void writeItems(uint first, uint count)
{
    for (uint i = 0u; i < count; ++i)
        askedWords[placeOfItem(first + i)] = FOUND_ITEM(i);
}

// Counts a pair of a kind, if it is of the kind.
void countKind(uint kind, bool isOfKind)
{
    const uint all = subgroupAdd(isOfKind ? 1u : 0u);
    if (subgroupElect() && all != 0u)
        atomicAdd(shadowCounters.kinds[kind], all);
}

// Appends the slot to those of a kind, if it is of the kind.
void appendTo(uint kind, bool isOfKind, uint slot)
{
    countKind(kind, isOfKind);
    uint place;
    TAKE_PLACES(asked.kinds[kind].count, isOfKind ? 1u : 0u, place)
    if (isOfKind) {
        askedWords[placeOfSlot(kind, place)] = slot;
        if (place % ASK_ROW == 0u)
            atomicAdd(asked.kinds[kind].groupsY, 1u);
    }
}

// Takes a slot for the pair, if it needs one. Returns false if there is none.
bool takeSlot(AskRecord ask, bool needs, out uint slot)
{
    TAKE_PLACES(asked.slots, needs ? 1u : 0u, slot)
    const bool has = needs && slot < params.capacity;
    const uint taken = subgroupAdd(has ? 1u : 0u), missing = subgroupAdd(needs && !has ? 1u : 0u);
    if (subgroupElect()) {
        if (taken != 0u)
            atomicAdd(shadowCounters.slots, taken);
        if (missing != 0u)
            atomicAdd(shadowCounters.missingSlots, missing);
    }
    if (needs && !has && atomicExchange(lists[ask.cluster], LIST_UNLISTED) != LIST_UNLISTED)
        appendUnlisted(ask.tile);
    return has;
}

// Gives the pair its place among those of its kind. count: how many items the pair has; 0: they are
// not known.
void writePair(uint pair, AskRecord ask, bool exists, bool isLit, bool isDark, uint count)
{
    const bool needsSlot = exists && !isLit && !isDark;
    uint slot, first;
    const bool hasSlot = takeSlot(ask, needsSlot, slot);
    const uint wanted = hasSlot ? count : 0u;
    TAKE_PLACES(asked.items, wanted, first)
    const bool isListed = wanted != 0u && first + wanted <= ITEMS_PER_SLOT * params.capacity &&
                          first < 1u << (32u - ITEM_COUNT_BITS);
    if (isListed)
        writeItems(first, wanted);
    if (hasSlot) {
        askedWords[placeOfRecord(slot)] = pair;
        askedWords[placeOfRecord(slot) + 1u] = (first << ITEM_COUNT_BITS) + wanted;
    }
    if (exists)
        askedWords[placeOfPair(pair) + PAIR_SLOT] = isLit ? SLOT_LIT : isDark ? SLOT_DARK : slot;
    appendTo(PAIRS_WALKED, hasSlot && !isListed, slot);
    appendTo(PAIRS_LISTED, isListed, slot);
    countKind(PAIRS_LIT, isLit);
    countKind(PAIRS_DARK, isDark);
}

void main()
{
    const uint pair = asked.first + gl_WorkGroupID.y * ASK_ROW +
                      gl_WorkGroupID.x * LIST_OCCLUDERS_GROUP + gl_LocalInvocationIndex;
    const bool exists = pair < asked.written;
    const AskRecord ask = askRecord(exists ? pair : asked.first);
    const FacetShape given = facetShape(ask.light, params.lightType);
    const SampleBounds samples = bounds[ask.cluster];
    ShaftEnds ends;
    ends.middle = 0.5 * (samples.low + samples.high);
    ends.halfBox = 0.5 * (samples.high - samples.low) + BOX_SLACK * abs(ends.middle);
    ends.ownDistance = samples.ownDistance;
    const bool reaches = reachesLight(ask.light, given, ends);
    const bool fromHost = params.fromHost != 0u;
    const bool unshadowed = !fromHost && (given.shape.flags & LIGHT_UNSHADOWED) != 0u;
    const bool searches = exists && reaches && !fromHost && !unshadowed;
    uint count;
    const bool found =
        findItems(ends, shadowView.layers, ignoredLayers(given.shape.flags), searches, count);
    const bool isKnown = searches && found;
    const bool isLit = exists && (unshadowed || (isKnown && count == 0u));
    const bool isDark =
        isProvenDark(ask.light, given, samples.largestOwnDistance, ends, count, isKnown);
    writePair(pair, ask, exists, isLit, isDark, isKnown ? count : 0u);
}
