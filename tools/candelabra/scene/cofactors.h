// SPDX-License-Identifier: Apache-2.0
// The matrix by which a linear transform changes normals and areas.
#pragma once

#include <glm/glm.hpp>

namespace candelabra::app
{

// Returns the matrix of cofactors: the inverse transpose of m times its determinant, which exists
// without an inverse too. For all vectors a and b, cross(m a, m b) is cofactors(m) cross(a, b). So
// it transforms a normal times the area of its surface.
inline glm::dmat3 cofactors(const glm::dmat3& m)
{
    return {glm::cross(m[1], m[2]), glm::cross(m[2], m[0]), glm::cross(m[0], m[1])};
}

} // namespace candelabra::app
