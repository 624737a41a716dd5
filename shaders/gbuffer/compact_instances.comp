// SPDX-License-Identifier: Apache-2.0
// Writes the ids of the visible instances of each batch and level, densely and in their old order, and
// the instance count of its draw. One lane per chunk and level sums the counts of the batch's chunks
// before it. The result does not depend on scheduling. The host splits batches so that this sum stays
// short.
#version 460
#extension GL_GOOGLE_include_directive : require
#include "shared/raster.h"

layout(local_size_x = COMPACT_INSTANCES_GROUP) in;
layout(push_constant, scalar) uniform Push
{
    CompactInstancesParams params;
};
layout(scalar, binding = COMPACT_INSTANCES_CHUNKS) readonly buffer Chunks
{
    Chunk chunks[];
};
layout(scalar, binding = COMPACT_INSTANCES_BITS) readonly buffer Bits
{
    uvec2 bits[];
};
layout(scalar, binding = COMPACT_INSTANCES_COUNTS) readonly buffer Counts
{
    uint counts[];
};
layout(scalar, binding = COMPACT_INSTANCES_VISIBLE) writeonly buffer Visible
{
    uint visible[];
};
layout(scalar, binding = COMPACT_INSTANCES_COMMANDS) buffer Commands
{
    DrawCommand commands[];
};

void main()
{
    const uint index = gl_GlobalInvocationID.x / MESH_LEVELS;
    const uint level = gl_GlobalInvocationID.x % MESH_LEVELS;
    if (index >= params.chunkCount)
        return;
    const Chunk chunk = chunks[index];
    if (level >= chunk.levelCount)
        return;
    uint count = 0;
    for (uint i = chunk.firstChunk; i < index; ++i)
        count += counts[i * MESH_LEVELS + level];

    const uint command = chunk.firstCommand + level;
    const uint first = commands[command].firstInstance;
    const uvec2 words = bits[index * MESH_LEVELS + level];
    for (uint word = 0; word < 2u; ++word) {
        uint left = words[word];
        while (left != 0u) {
            visible[first + count] = chunk.firstInstance + word * 32u + findLSB(left);
            left &= left - 1u;
            ++count;
        }
    }
    if (index == chunk.lastChunk)
        commands[command].instanceCount = count;
}
