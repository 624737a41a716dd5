// SPDX-License-Identifier: Apache-2.0
// Vectors as the benchmarks make them.
#pragma once

#include <cmath>

#include <glm/glm.hpp>

namespace candelabra::app
{

// The unit vector at `angle` from the z axis. `azimuth` is counted from the x axis towards the y
// axis.
inline glm::dvec3 polar(double angle, double azimuth)
{
    return {std::sin(angle) * std::cos(azimuth), std::sin(angle) * std::sin(azimuth),
            std::cos(angle)};
}

inline void set(float (&out)[3], const glm::dvec3& v)
{
    out[0] = float(v.x);
    out[1] = float(v.y);
    out[2] = float(v.z);
}

} // namespace candelabra::app
