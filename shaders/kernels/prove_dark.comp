// SPDX-License-Identifier: Apache-2.0
// Removes lights from the lists of blocks that occluders hide from all samples of the block's cluster,
// so that no tile or slice of it gets them (lib/visibility/dark_proof.glsl). A group takes a page of a
// list, and each lane a light. The way from the centre of the box of the samples to the light leads
// through the tree over instances. Each instance that it may cross is tested by a walk through the mesh
// with the shaft, until one is proven to hide the light. A proof that fails or takes too long changes
// nothing but time.
#version 460
#extension GL_GOOGLE_include_directive : require
#extension GL_KHR_shader_subgroup_vote : require
#include "kernels/common/frame_params.glsl"
#include "kernels/common/light_stream.glsl"
#include "kernels/common/page_header.glsl"
#include "lib/projection.glsl"
#include "shading/occluder_buffers.glsl"
#include "shading/occluder_leaf.glsl"
#include "lib/visibility/dark_proof.glsl"

layout(local_size_x = PROVE_DARK_GROUP) in;
layout(scalar, binding = PROVE_DARK_SHAPES) readonly buffer Shapes
{
    LightShape lightShapes[];
};
#include "shading/facet_shape.glsl"
layout(scalar, binding = PROVE_DARK_CLUSTERS) readonly buffer Clusters
{
    Cluster clusters[];
};
layout(scalar, binding = PROVE_DARK_ENTRIES) buffer Entries
{
    uint entries[];
};
layout(scalar, binding = PROVE_DARK_RECORDS) readonly buffer Records
{
    WorkList asked;
    ProofRecord records[];
};
layout(scalar, binding = PROVE_DARK_COUNTERS) buffer Counters
{
    ShadowCounters counters;
};
layout(scalar, binding = PROVE_DARK_NEIGHBOURS) readonly buffer Neighbours
{
    OccluderNeighbours neighbours[];
};

// Turns of loops after which a lane gives up.
const uint MOST_PROOF_TURNS = 2048u;

// The leaves that a lane has found and whose triangles it has not tested. A mask of their triangles has
// two words.
const uint PROOF_LEAVES = 16u;
shared uint leafQueue[PROOF_LEAVES * PROVE_DARK_GROUP];
#define QUEUED_LEAF(i) leafQueue[(i) * PROVE_DARK_GROUP + gl_LocalInvocationIndex]

// The lights of the page, one bit each: those that proofs were tried for, and those that stay.
shared uint triedLights[2], keptLights[2];

// What a lane is to prove, and the instance that it looks at.
struct Proof {
    Shaft shaft;
    vec3 centre;      // of the box, in view space
    float depthError; // bound of depthErrorAt()
    uint ignored;     // as OccluderQuery::ignored
    uint turns;
    uint node, end; // the next node of the mesh, and the number of its nodes
    uint firstNode, firstTriangle;
    mat3 viewFromLocal;
    vec3 localCentre; // of the box
    LocalShaft local;
    float ownDistance;
    uint crossings; // of the middle way
    bool failed;
};

// Returns a bound of the error of depths (depthErrorAt) along the rays of samples between two corners.
float depthErrorWithin(Projection m, vec3 low, vec3 high)
{
    float error = 0.0;
    for (uint i = 0u; i < 2u; ++i) {
        const float z = i == 0u ? low.z : high.z;
        const float depth = (m.m22 * z + m.m32) / (m.m23 * z + m.m33);
        const float step = max(shadowView.depthStep, abs(depth) * 2.384185791015625e-7 /* 2^-22 */);
        error = max(error, max(abs(viewZ(m, depth + step) - z), abs(viewZ(m, depth - step) - z)));
    }
    const float nearest = max(max(low.z, -high.z), 1e-30);
    const float aside = length(max(abs(low.xy), abs(high.xy)));
    return m.eyeIsPoint != 0.0 ? error * (1.0 + aside / nearest) : error;
}

// Sets the place in a mesh's tree to its root, or to its end if the instance does not count or the
// middle way is beside its box.
void enterInstance(inout Proof p, uint at)
{
    const OccluderInstance instance = occluderInstance(at);
    const mat3 m = instance.localFromView;
    const vec3 box = p.shaft.box;
    p.firstNode = instance.firstNode;
    p.firstTriangle = instance.firstTriangle;
    p.viewFromLocal = instance.viewFromLocal;
    p.localCentre = m * p.centre + instance.viewInLocal;
    const vec3 localBox = abs(m[0]) * box.x + abs(m[1]) * box.y + abs(m[2]) * box.z;
    p.ownDistance = ownSurfaceDistance(p.depthError, abs(p.centre) + box, instance.surfaceError,
                                       p.viewFromLocal, abs(p.localCentre) + localBox);
    p.local = shaftInSpaceOf(p.shaft, m, p.ownDistance);
    const OccluderNode root = occluderNode(p.firstNode);
    const vec3 way = finiteInverse(m * p.shaft.ball);
    const vec3 slack = vec3(BOX_SLACK * norm1(p.localCentre));
    const bool counts =
        (instance.flags & shadowView.layers) != 0u && (instance.flags & p.ignored) == 0u &&
        coneTouches(FacetCone(way, way, 1.0), root.low - p.localCentre - slack,
                    root.high - p.localCentre + slack);
    p.node = 0u;
    p.end = counts ? root.skip : 0u;
    p.crossings = 0u;
    p.failed = false;
}

// Walks on through the mesh until it ends or the queue is full. Returns how many leaves the queue has.
uint findLeaves(inout Proof p)
{
    uint queued = 0u;
    do {
        ++p.turns;
        if (p.node < p.end && queued < PROOF_LEAVES) {
            const OccluderNode node = occluderNode(p.firstNode + p.node);
            const bool touches =
                shaftTouchesBox(p.local, node.low - p.localCentre, node.high - p.localCentre);
            if (touches && node.leaf != 0u) {
                QUEUED_LEAF(queued) = node.leaf;
                ++queued;
            }
            p.node = touches && node.leaf == 0u ? p.node + 1u : node.skip;
        }
    } while (p.node < p.end && queued < PROOF_LEAVES);
    return queued;
}

// Returns whether the triangle, or the edge whose last two corners are one, may touch the shaft. The
// corners are relative to the box.
bool mayTouch(Proof p, vec3 a, vec3 b, vec3 c, ShaftTriangle t)
{
    return shaftTouchesBox(p.local, min(a, min(b, c)), max(a, max(b, c))) &&
           !isBesideShaft(p.shaft, p.ownDistance, t);
}

// Tests the triangles of the leaves in the queue. Sets a bit for each triangle that touches the shaft
// and whose plane every way crosses.
void testTriangles(inout Proof p, uint queued, out uvec2 forward, out uvec2 backward)
{
    forward = backward = uvec2(0u);
    uint at = 0u, leaf = QUEUED_LEAF(0u), inLeaf = 0u;
    do {
        ++p.turns;
        if (at < queued && !p.failed) {
            const OccluderTriangle t = occluderTriangle(p.firstTriangle + leafFirst(leaf));
            const vec3 a = t.corners[0] - p.localCentre, b = t.corners[1] - p.localCentre;
            const vec3 c = t.corners[2] - p.localCentre;
            const ShaftTriangle inView = triangleInView(p.viewFromLocal, a, b, c);
            const uint side = planeSide(p.shaft, p.ownDistance, inView);
            const bool touches = side != PLANE_BESIDE && mayTouch(p, a, b, c, inView);
            p.failed = touches && side == PLANE_NEAR;
            p.crossings += touches && isCrossed(side) && crossesTriangle(p.shaft, inView) ? 1u : 0u;
            const uint place = OCCLUDER_LEAF_TRIANGLES * at + inLeaf, bit = 1u << (place & 31u);
            const uvec2 one = place < 32u ? uvec2(bit, 0u) : uvec2(0u, bit);
            forward |= touches && side == PLANE_FORWARD ? one : uvec2(0u);
            backward |= touches && side == PLANE_BACKWARD ? one : uvec2(0u);
            leaf = withoutFirst(leaf);
            ++inLeaf;
            if (leafCount(leaf) == 0u) {
                ++at;
                leaf = QUEUED_LEAF(min(at, PROOF_LEAVES - 1u));
                inLeaf = 0u;
            }
        }
    } while (at < queued && !p.failed);
    p.failed = p.failed || at < queued; // the device may have ended the loop early
}

vec3 cornerOf(OccluderTriangle t, uint i)
{
    return i == 0u ? t.corners[0] : i == 1u ? t.corners[1] : t.corners[2];
}

// Returns whether an edge of a triangle may touch the shaft and change the number of crossings. Of two
// triangles the one with the lower index tests their edge.
bool edgeFails(Proof p, uint triangle, uint edge, uint side)
{
    const uint neighbour = neighbours[p.firstTriangle + triangle].edges[edge];
    const bool alone = neighbour == NO_NEIGHBOUR;
    const uint other = alone ? triangle : neighbour >> 1;
    const OccluderTriangle o = occluderTriangle(p.firstTriangle + other);
    const uint otherSide = planeSide(
        p.shaft, p.ownDistance,
        triangleInView(p.viewFromLocal, o.corners[0] - p.localCentre, o.corners[1] - p.localCentre,
                       o.corners[2] - p.localCentre));
    const OccluderTriangle t = occluderTriangle(p.firstTriangle + triangle);
    const vec3 from = cornerOf(t, edge) - p.localCentre;
    const vec3 to = cornerOf(t, edge == 2u ? 0u : edge + 1u) - p.localCentre;
    return (alone || other > triangle) && isOpenEdge(side, neighbour, otherSide) &&
           mayTouch(p, from, to, to, triangleInView(p.viewFromLocal, from, to, to));
}

// Tests the edges of the triangles in the masks.
void testEdges(inout Proof p, uvec2 forward, uvec2 backward)
{
    uvec2 left = forward | backward;
    uint edge = 0u;
    do {
        ++p.turns;
        if (left != uvec2(0u) && !p.failed) {
            const bool inFirst = left.x != 0u;
            const uint bit = uint(findLSB(inFirst ? left.x : left.y));
            const uint place = inFirst ? bit : 32u + bit;
            const uint leaf = QUEUED_LEAF(place / OCCLUDER_LEAF_TRIANGLES);
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

// Returns whether the light is proven to be dark. tries: false: the lane only waits for others.
bool isProvenDark(inout Proof p, bool tries)
{
    const mat3 treeFromView = transpose(shadowView.viewFromTree);
    const vec3 from = shadowView.viewInTree + treeFromView * p.centre;
    const vec3 along = finiteInverse(treeFromView * p.shaft.ball);
    const FacetCone way = FacetCone(along, along, 1.0);
    const vec3 slack = vec3(BOX_SLACK * (1.0 + norm1(from)));
    const uint end = occluderNode(shadowView.firstNode).skip;
    uint node = 0u, leaf = 0u;
    bool dark = false, walks = tries;
    // This loop may not differ between lanes: llvmpipe would lose leaves. The loops inside it may.
    do {
        if (walks) {
            const bool inMesh = p.node < p.end;
            do {
                ++p.turns;
                if (!inMesh && leafCount(leaf) == 0u && node < end) {
                    const OccluderNode n = occluderNode(shadowView.firstNode + node);
                    const bool touches = coneTouches(way, n.low - from - slack, n.high - from + slack);
                    leaf = touches ? n.leaf : 0u;
                    node = touches && n.leaf == 0u ? node + 1u : n.skip;
                }
            } while (!inMesh && leafCount(leaf) == 0u && node < end && p.turns < MOST_PROOF_TURNS);
            if (!inMesh && leafCount(leaf) != 0u) {
                enterInstance(p, leafFirst(leaf));
                leaf = withoutFirst(leaf);
            }
            const uint queued = findLeaves(p);
            uvec2 forward, backward;
            testTriangles(p, queued, forward, backward);
            testEdges(p, forward, backward);
            p.node = p.failed ? p.end : p.node;
            dark = p.node >= p.end && !p.failed && p.crossings != 0u;
            walks = !dark && (p.node < p.end || leafCount(leaf) != 0u || node < end) &&
                    p.turns < MOST_PROOF_TURNS;
        }
    } while (subgroupAny(walks));
    return dark;
}

// Writes the lights that stay to the beginning of the page, in their order.
void writePage(uint page, uint header, uint light)
{
    const uint lane = gl_LocalInvocationIndex;
    const uvec2 kept = uvec2(keptLights[0], keptLights[1]);
    const uint before = lane < 32u ? uint(bitCount(kept.x & ((1u << lane) - 1u)))
                                   : uint(bitCount(kept.x)) +
                                         uint(bitCount(kept.y & ((1u << (lane - 32u)) - 1u)));
    if (((lane < 32u ? kept.x : kept.y) >> (lane & 31u) & 1u) != 0u)
        entries[page * PAGE_WORDS + 1u + before] = light;
    if (lane != 0u)
        return;
    const uint count = uint(bitCount(kept.x) + bitCount(kept.y));
    const uint all = lightsOfPage(header);
    entries[page * PAGE_WORDS] = pageHeader(count, pageAfter(header));
    atomicAdd(counters.triedProofs, uint(bitCount(triedLights[0]) + bitCount(triedLights[1])));
    atomicAdd(counters.wonProofs, all - count);
}

void main()
{
    const uint at = gl_WorkGroupID.y * PROOF_ROW + gl_WorkGroupID.x;
    if (at >= min(asked.count, uint(records.length())))
        return;
    const ProofRecord record = records[at];
    const uint lane = gl_LocalInvocationIndex;
    if (lane < 2u)
        triedLights[lane] = keptLights[lane] = 0u;
    barrier();
    const uint header = entries[record.page * PAGE_WORDS];
    const bool isLight = lane < lightsOfPage(header);
    const uint light = entries[record.page * PAGE_WORDS + 1u + (isLight ? lane : 0u)];
    const vec4 centreRadius = lightCentre(light);
    const LightShape shape = lightShapes[light];
    const uint flags = facetShape(light, record.lightType).shape.flags;
    const Cluster cluster = clusters[record.cluster];
    Proof p;
    p.centre = 0.5 * (cluster.min + cluster.max);
    p.depthError = depthErrorWithin(frameParams.projection, cluster.min, cluster.max);
    p.ignored = ignoredLayers(flags);
    p.turns = p.node = p.end = p.crossings = 0u;
    p.failed = false;
    const bool inShaft =
        shaftTo(0.5 * (cluster.max - cluster.min), record.lightType, centreRadius.xyz - p.centre,
                centreRadius.w, shape, p.shaft);
    const bool tries = isLight && inShaft && (flags & LIGHT_UNSHADOWED) == 0u;
    const bool dark = isProvenDark(p, tries);
    if (tries)
        atomicOr(triedLights[lane / 32u], 1u << (lane & 31u));
    if (isLight && !dark)
        atomicOr(keptLights[lane / 32u], 1u << (lane & 31u));
    barrier();
    writePage(record.page, header, light);
}
