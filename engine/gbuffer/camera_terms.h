// SPDX-License-Identifier: Apache-2.0
// Everything that the raster pass derives from a CndCamera, computed in double precision.
#pragma once

#include <array>

#include <glm/mat3x3.hpp>
#include <glm/mat4x4.hpp>
#include <glm/vec3.hpp>

#include "candelabra/candelabra.h"
#include "shared/raster.h"

namespace candelabra::gbuffer
{

struct CameraTerms {
    // Accepts any perspective or orthographic clipFromView; `clearDepth` (0 or 1) is the depth of
    // the far end.
    CameraTerms(const CndCamera& camera, float clearDepth);

    glm::mat4 clipFromView;
    glm::dmat3 viewFromWorld; // the rotation alone
    glm::dvec3 position;      // origin of view space in world space
    bool perspective;
    bool reversedDepth;
    bool mirrored; // the image is mirrored, which reverses windings
    // The view-space ray through a point of the screen, affine in ndc: [0] + ndc.x [1] + ndc.y [2].
    std::array<glm::dvec3, 3> rayOrigin, rayDirection;
    glm::dvec3 forward; // unit, view space
    // Planes of the clip volume, relative to `position`, in world axes: a point p is inside where
    // dot(xyz, p - position) + w >= 0. Normals have unit length; a plane at infinity is (0, 0, 0,
    // 1).
    std::array<glm::dvec4, 6> planes;

    // The pixels that a length of 1 m across the viewing direction has at most in an image of that
    // size; with a perspective camera 1 m ahead.
    double pixelScale(uint32_t width, uint32_t height) const;

    // Returns a rectangle that holds every pixel which shows a part of the ball, in an image of
    // width x height pixels. It is at most three pixels larger than needed at each side. If all of
    // the ball is behind the camera, the rectangle is empty. If the ball reaches the camera's plane
    // (the plane through the eye, parallel to the image) or comes very close to it, the rectangle
    // is the whole image. `center` (m) is in view space; `radius` is in m.
    VkRect2D pixelsOfBall(const glm::dvec3& center, double radius, uint32_t width,
                          uint32_t height) const;

    glm::dvec3 viewFrom(const glm::dvec3& world) const
    {
        return viewFromWorld * (world - position);
    }
};

} // namespace candelabra::gbuffer
