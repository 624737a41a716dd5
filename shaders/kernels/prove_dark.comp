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

// The leaves that a lane has found and whose triangles it has not tested.
shared uint leafQueue[PROOF_LEAVES * PROVE_DARK_GROUP];
#define PROOF_LEAF(i) leafQueue[(i) * PROVE_DARK_GROUP + gl_LocalInvocationIndex]
#include "shading/dark_triangles.glsl"

// The lights of the page, one bit each: those that proofs were tried for, and those that stay.
shared uint triedLights[2], keptLights[2];

// What a lane is to prove, and its place in the mesh that it looks at.
struct Proof {
    vec3 centre;      // of the box, in view space
    float depthError; // bound of depthErrorAt()
    uint ignored;     // as OccluderQuery::ignored
    uint node, end;   // the next node of the mesh, and the number of its nodes
    uint firstNode;
    InstanceProof of;
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
    setInstance(p.of, instance, instance.viewFromLocal, instance.localFromView, p.centre,
                ownSurfaceDistance(p.depthError, abs(p.centre) + p.of.shaft.box, 0.0, mat3(0.0),
                                   vec3(0.0)));
    p.firstNode = instance.firstNode;
    const OccluderNode root = occluderNode(p.firstNode);
    const vec3 way = finiteInverse(instance.localFromView * p.of.shaft.ball);
    const vec3 slack = vec3(BOX_SLACK * norm1(p.of.localCentre));
    const bool counts =
        (instance.flags & shadowView.layers) != 0u && (instance.flags & p.ignored) == 0u &&
        coneTouches(FacetCone(way, way, 1.0), root.low - p.of.localCentre - slack,
                    root.high - p.of.localCentre + slack);
    p.node = 0u;
    p.end = counts ? root.skip : 0u;
}

// Walks on through the mesh until it ends or the queue is full. Returns how many leaves the queue has.
uint findLeaves(inout Proof p)
{
    uint queued = 0u;
    do {
        ++p.of.turns;
        if (p.node < p.end && queued < PROOF_LEAVES) {
            const OccluderNode node = occluderNode(p.firstNode + p.node);
            const bool touches =
                shaftTouchesBox(p.of.local, node.low - p.of.localCentre, node.high - p.of.localCentre);
            if (touches && node.leaf != 0u) {
                PROOF_LEAF(queued) = node.leaf;
                ++queued;
            }
            p.node = touches && node.leaf == 0u ? p.node + 1u : node.skip;
        }
    } while (p.node < p.end && queued < PROOF_LEAVES);
    return queued;
}

// Returns whether the light is proven to be dark. tries: false: the lane only waits for others.
bool isProvenDark(inout Proof p, bool tries)
{
    const mat3 treeFromView = transpose(shadowView.viewFromTree);
    const vec3 from = shadowView.viewInTree + treeFromView * p.centre;
    const vec3 along = finiteInverse(treeFromView * p.of.shaft.ball);
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
                ++p.of.turns;
                if (!inMesh && leafCount(leaf) == 0u && node < end) {
                    const OccluderNode n = occluderNode(shadowView.firstNode + node);
                    const bool touches = coneTouches(way, n.low - from - slack, n.high - from + slack);
                    leaf = touches ? n.leaf : 0u;
                    node = touches && n.leaf == 0u ? node + 1u : n.skip;
                }
            } while (!inMesh && leafCount(leaf) == 0u && node < end && p.of.turns < MOST_PROOF_TURNS);
            if (!inMesh && leafCount(leaf) != 0u) {
                enterInstance(p, leafFirst(leaf));
                leaf = withoutFirst(leaf);
            }
            const uint queued = findLeaves(p);
            uvec2 forward, backward;
            testTriangles(p.of, 0u, queued, forward, backward);
            testEdges(p.of, 0u, forward, backward);
            p.node = p.of.failed ? p.end : p.node;
            dark = p.node >= p.end && isProven(p.of);
            walks = !dark && (p.node < p.end || leafCount(leaf) != 0u || node < end) &&
                    p.of.turns < MOST_PROOF_TURNS;
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
    p.node = p.end = 0u;
    beginProof(p.of);
    const bool inShaft =
        shaftTo(0.5 * (cluster.max - cluster.min), record.lightType, centreRadius.xyz - p.centre,
                centreRadius.w, shape, p.of.shaft);
    const bool tries = isLight && inShaft && (flags & LIGHT_UNSHADOWED) == 0u;
    const bool dark = isProvenDark(p, tries);
    if (tries)
        atomicOr(triedLights[lane / 32u], 1u << (lane & 31u));
    if (isLight && !dark)
        atomicOr(keptLights[lane / 32u], 1u << (lane & 31u));
    barrier();
    writePage(record.page, header, light);
}
