// SPDX-License-Identifier: Apache-2.0
// Vectors of the public interface in double precision.
#pragma once

#include <glm/glm.hpp>

namespace candelabra::reference
{

inline glm::dvec3 vec3(const float (&values)[3])
{
    return {values[0], values[1], values[2]};
}

} // namespace candelabra::reference
