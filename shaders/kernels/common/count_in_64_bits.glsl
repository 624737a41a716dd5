// SPDX-License-Identifier: Apache-2.0
// Counts in 64 bits.
#extension GL_KHR_shader_subgroup_arithmetic : require

// Adds to a 64-bit counter without 64-bit atomics: the addition that overflows the low word carries.
#define COUNT(counter, n)                                                                          \
    {                                                                                              \
        const uint more = subgroupAdd(n);                                                          \
        if (subgroupElect() && atomicAdd(counter.x, more) + more < more)                           \
            atomicAdd(counter.y, 1u);                                                              \
    }
