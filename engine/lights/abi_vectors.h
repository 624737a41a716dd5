// SPDX-License-Identifier: Apache-2.0
// Vectors of the C ABI in double precision.
#pragma once

#include <glm/vec3.hpp>

namespace candelabra::lighting
{

// Returns a vector of the C ABI in double precision.
inline glm::dvec3 dvec3From(const float (&v)[3])
{
    return {v[0], v[1], v[2]};
}

inline void setFloats(float (&out)[3], const glm::dvec3& v)
{
    for (int i = 0; i < 3; ++i)
        out[i] = float(v[i]);
}

} // namespace candelabra::lighting
