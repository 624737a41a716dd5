// SPDX-License-Identifier: Apache-2.0
// Prefix sums over the lanes of a group (Hillis and Steele 1986). Include it after the layout of the
// group.
#ifndef CND_COMMON_GROUP_SUMS
#define CND_COMMON_GROUP_SUMS

shared uint prefixes[gl_WorkGroupSize.x];

// Writes the inclusive prefix sums of the lanes' values to `prefixes`. All lanes must call it.
void addPrefixes(uint value)
{
    const uint lane = gl_LocalInvocationIndex;
    prefixes[lane] = value;
    barrier();
    for (uint reach = 1u; reach < gl_WorkGroupSize.x; reach *= 2u) {
        const uint left = lane >= reach ? prefixes[lane - reach] : 0u;
        barrier();
        prefixes[lane] += left;
        barrier();
    }
}

#endif
