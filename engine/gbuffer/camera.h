// SPDX-License-Identifier: Apache-2.0
// Everything the raster pass derives from a CndCamera, in double.
#pragma once

#include <array>

#include <glm/mat3x3.hpp>
#include <glm/mat4x4.hpp>
#include <glm/vec3.hpp>

#include "candelabra/candelabra.h"
#include "shared/raster.h"

namespace candelabra::gbuffer
{

// A position as two floats: x = hi + lo to 2^-48 relative.
struct DoubleSingle {
    glm::vec3 hi, lo;
    explicit DoubleSingle(const glm::dvec3& x);
};

struct CameraTerms {
    // Any perspective or orthographic clipFromView whose depth is `clearDepth` (0 or 1) far away.
    CameraTerms(const CndCamera& camera, float clearDepth);

    glm::mat4 clipFromView;
    glm::dmat3 viewFromWorld; // rotation
    glm::dvec3 position;      // world, of the view space's origin
    bool perspective;
    bool reversedDepth;
    bool mirrored; // the image is a mirror image: windings are turned round
    // Ray through a point of the screen, view space, affine in ndc: [0] + x [1] + y [2].
    std::array<glm::dvec3, 3> rayOrigin, rayDirection;
    glm::dvec3 forward; // unit, view space
    // Clip volume around `position`, world axes: inside where dot(xyz, p - position) + w >= 0. Unit
    // normals; a plane at infinity is (0, 0, 0, 1).
    std::array<glm::dvec4, 6> planes;

    glm::dvec3 viewFrom(const glm::dvec3& world) const
    {
        return viewFromWorld * (world - position);
    }
};

} // namespace candelabra::gbuffer
