// SPDX-License-Identifier: Apache-2.0
// Floats as integers of the same order, so that minima of floats can be taken by integer atomics.
#ifndef CND_LIB_ORDERED_BITS
#define CND_LIB_ORDERED_BITS

// Returns an integer that is ordered like the float, which must not be NaN; -0 comes before 0.
uint orderedBits(float x)
{
    const uint bits = floatBitsToUint(x);
    return (bits & 0x80000000u) != 0u ? ~bits : bits | 0x80000000u;
}

// Inverts orderedBits().
float floatOfOrdered(uint ordered)
{
    return uintBitsToFloat((ordered & 0x80000000u) != 0u ? ordered & 0x7FFFFFFFu : ~ordered);
}

#endif
