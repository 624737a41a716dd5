// SPDX-License-Identifier: Apache-2.0
// Makes the keys that lights are sorted by: type, class of influence radius, position along a Morton
// curve. Lights of one type share a shader; similar sizes and positions make tight boxes in the light
// tree.
#version 460
#extension GL_GOOGLE_include_directive : require
#include "shared/light_order_data.h"
#include "shared/lighting_data.h"

layout(local_size_x = SORT_GROUP) in;
layout(push_constant, scalar) uniform Push
{
    LightKeysParams params;
};
layout(scalar, binding = LIGHT_KEYS_RECORDS) readonly buffer Records
{
    LightRecord records[];
};
layout(scalar, binding = LIGHT_KEYS_KEYS) writeonly buffer Keys
{
    LightKey keys[];
};

// Puts two zero bits after each of the low 10 bits.
uint spread(uint x)
{
    x = (x | (x << 16)) & 0x030000FFu;
    x = (x | (x << 8)) & 0x0300F00Fu;
    x = (x | (x << 4)) & 0x030C30C3u;
    return (x | (x << 2)) & 0x09249249u;
}

uint morton(vec3 position)
{
    const float cells = float(1u << params.axisBits);
    const uvec3 cell =
        uvec3(clamp((position - params.low) * params.cellsPerMetre, vec3(0.0), vec3(cells - 1.0)));
    return spread(cell.x) | spread(cell.y) << 1 | spread(cell.z) << 2;
}

// Returns the class of an influence radius. A class spans two octaves; the last one holds all larger
// radii.
uint sizeClass(float influenceRadius)
{
    const int exponent = int(floatBitsToUint(influenceRadius) >> 23) - 127;
    const int last = (1 << ORDER_SIZE_BITS) - 1;
    return uint(clamp(last - 1 + ((exponent - params.largestExponent) >> 1), 0, last));
}

void main()
{
    const uint i = gl_GlobalInvocationID.x;
    if (i >= params.lightCount)
        return;
    const uint type = records[i].flags & LIGHT_TYPE_MASK;
    const uint typeRank = uint(bitCount(params.types & ((1u << type) - 1u)));
    const uint size = sizeClass(records[i].influenceRadius);
    const uint place = morton(records[i].position);
    const uint key = ((typeRank << ORDER_SIZE_BITS) | size) << (3u * params.axisBits) | place;
    keys[i] = LightKey(key, i);
}
