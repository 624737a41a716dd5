// SPDX-License-Identifier: Apache-2.0
// A position as two floats per coordinate, in which it reaches the device.
#pragma once

#include <glm/vec3.hpp>

namespace candelabra::gpu
{

// A position as the sum of two floats, x = hi + lo, with a relative error of 2^-48.
struct DoubleSingle {
    glm::vec3 hi, lo;
    explicit DoubleSingle(const glm::dvec3& x)
        : hi(x), lo(remainder(x.x), remainder(x.y), remainder(x.z))
    {
    }

private:
    // Returns the part of x that a float loses. g++ 12.2 vectorises double(float(x)) of
    // neighbouring members to x, so that the result would be 0 (-O2, x86-64); volatile keeps the
    // rounding.
    static float remainder(double x)
    {
        const volatile float kept = float(x);
        return float(x - double(kept));
    }
};

} // namespace candelabra::gpu
