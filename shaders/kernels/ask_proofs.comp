// SPDX-License-Identifier: Apache-2.0
// Makes a record of each page in the lists of blocks, for prove_dark.
#version 460
#extension GL_GOOGLE_include_directive : require
#include "kernels/common/page_header.glsl"
#include "shared/occluder_data.h"

layout(local_size_x = ASK_PROOFS_GROUP) in;
layout(push_constant, scalar) uniform Push
{
    AskProofsParams params;
};
layout(scalar, binding = ASK_PROOFS_CLUSTERS) readonly buffer Clusters
{
    Cluster clusters[];
};
layout(scalar, binding = ASK_PROOFS_LISTS) readonly buffer Lists
{
    uint lists[];
};
layout(scalar, binding = ASK_PROOFS_ENTRIES) readonly buffer Entries
{
    uint entries[];
};
layout(scalar, binding = ASK_PROOFS_RECORDS) buffer Records
{
    WorkList asked;
    ProofRecord records[];
};

void main()
{
    const uint group = gl_WorkGroupID.y * gl_NumWorkGroups.x + gl_WorkGroupID.x;
    const uint i = group * ASK_PROOFS_GROUP + gl_LocalInvocationIndex;
    if (i >= params.clusterCount)
        return;
    const uint cluster = params.firstCluster + i;
    if (clusters[cluster].min.x > clusters[cluster].max.x) // it has no list
        return;
    uint page = lists[cluster];
    if (page == LIST_UNLISTED || page == LIST_LONG)
        return;
    while (page != LIST_EMPTY) { // which is also the page after the last one
        const uint at = atomicAdd(asked.count, 1u);
        if (at < params.capacity) {
            records[at] = ProofRecord(page, cluster, params.lightType);
            atomicMax(asked.groupsY, at / PROOF_ROW + 1u);
        }
        page = pageAfter(entries[page * PAGE_WORDS]);
    }
}
