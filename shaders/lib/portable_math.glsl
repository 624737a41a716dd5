// SPDX-License-Identifier: Apache-2.0
// Reciprocals, square roots and dot products that have the same bits on every device.
//
// Vulkan lets devices round a division (by 2.5 ULP), an inverse square root (by 2) and a square
// root each in their own way, and leaves open in which order dot() adds and whether fma() rounds
// once or twice. It requires of sums, differences and products that they are rounded correctly, and
// of those that are `precise` that no compiler fuses or reorders them. The functions here use only
// these, and operations on integers and on the bits of floats. (Vulkan does not say whether a
// device rounds to the nearest float or towards zero. All devices that we know round to the
// nearest.)
//
// The magnitudes of what reciprocals and roots are taken of must lie between 2^-100 and 2^100. Farther
// out, devices that flush denormal numbers give other bits than devices that do not, then errors grow,
// and from 0, infinity and NaN come NaN or anything else. The square root of 0 is 0. PortableMath.*
// tests all mantissas.
#ifndef CND_LIB_PORTABLE_MATH
#define CND_LIB_PORTABLE_MATH

// Returns x without the lower half of its significand. The product of two such floats is exact.
float upperHalf(float x)
{
    return uintBitsToFloat(floatBitsToUint(x) & 0xFFFFF000u);
}

// Returns 1 / x, wrong by at most 0.51 ULP; exact for powers of two. x may be negative.
float portableReciprocal(float x)
{
    // Subtracting the bits of x from a constant negates its exponent: wrong by 5.1%.
    precise const float seed = uintBitsToFloat(0x7EF31000u - floatBitsToUint(x));
    // With r = 1 - x y, 1 / x is y / (1 - r) = y (1 + r + r^2 + ...): wrong by 1.3e-4.
    precise const float rest = 1.0 - x * seed;
    precise const float near = seed + seed * (rest + rest * rest);
    // The same again, from two halves of x, so that the products are exact, and their differences
    // from 1 are as good as exact.
    const float y = upperHalf(near);
    const float high = upperHalf(x);
    precise const float low = x - high;
    precise const float exactRest = (1.0 - high * y) - low * y;
    precise const float result = y + y * (exactRest + exactRest * exactRest);
    return result;
}

// Returns y times the root of 1 / (1 - r) = 1 + r / 2 + 3 r^2 / 8 + ...: with r = 1 - x y^2 this is
// nearer to the inverse root of x than y is.
float nearerInverseSqrt(float y, float r)
{
    precise const float result = y + y * (r * (0.5 + 0.375 * r));
    return result;
}

// Returns 1 / sqrt(x), wrong by less than 1 ULP. x must not be negative.
float portableInverseSqrt(float x)
{
    // Subtracting half the bits of x from a constant halves and negates its exponent: wrong by 3.4%.
    precise const float seed = uintBitsToFloat(0x5F375000u - (floatBitsToUint(x) >> 1));
    precise const float rest = 1.0 - x * (seed * seed);
    const float y =
        upperHalf(nearerInverseSqrt(seed, rest));      // wrong by 1e-4, and by the lower half
    precise const float closeRest = 1.0 - x * (y * y); // only the outer product is rounded
    return nearerInverseSqrt(y, closeRest);
}

// Returns sqrt(x), wrong by at most 0.75 ULP. x may be 0, but not negative.
float portableSqrt(float x)
{
    const float inverse = portableInverseSqrt(max(x, 1e-37));
    precise const float root = x * inverse;
    precise const float result = root + 0.5 * inverse * (x - root * root);
    return result;
}

float portableDot(vec3 a, vec3 b)
{
    precise const float sum = a.x * b.x + a.y * b.y + a.z * b.z;
    return sum;
}

// Returns v / |v|.
vec3 portableNormalize(vec3 v)
{
    precise const vec3 unit = v * portableInverseSqrt(portableDot(v, v));
    return unit;
}

#endif
