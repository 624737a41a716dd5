// SPDX-License-Identifier: Apache-2.0
#include "surfaces/projection.h"

#include <cmath>
#include <cstring>
#include <string>

#include <glm/common.hpp>
#include <glm/mat3x3.hpp>
#include <glm/mat4x4.hpp>
#include <glm/vector_relational.hpp>

#include "gpu/failure.h"

namespace candelabra::surfaces
{
namespace
{

// In a perspective view, depth is farEnd + slope / distance, with the distance along the view
// direction.
struct DepthOverDistance {
    float farEnd, slope;
};

DepthOverDistance depthOverDistance(const gpu::Projection& p)
{
    return {p.m22 / p.m23, p.m32 / std::abs(p.m23)};
}

// Checks elements 10, 11 and 14 of a perspective projection.
void checkPerspectiveDepth(const gpu::Projection& p)
{
    // w is the distance in every projection in use. So element 11 is 1 or -1, and element 14 is the
    // near plane or a similar length.
    if (std::abs(p.m23) != 1 && std::abs(p.m32) == 1)
        gpu::failArgument("CndCamera: clipFromView is transposed: its columns must follow one "
                          "another, with the 1 or -1 of the last row in element 11");
    const DepthOverDistance depth = depthOverDistance(p);
    if (depth.slope > 0 ? depth.farEnd >= 1 : depth.farEnd <= 0)
        gpu::failArgument("CndCamera: clipFromView gives nothing in front of the eye a depth of "
                          "0..1: the signs of elements 10, 11 and 14 do not fit together");
}

} // namespace

void checkCamera(const CndCamera& camera)
{
    for (const double x : camera.viewFromWorld)
        if (!std::isfinite(x))
            gpu::failArgument("CndCamera: viewFromWorld must be finite");
    glm::dmat4 m;
    std::memcpy(&m, camera.viewFromWorld, sizeof m);
    constexpr double tolerance = 1e-5; // matrices of floats reach 1e-6
    const glm::dvec4 lastRow(m[0][3], m[1][3], m[2][3], m[3][3]);
    if (glm::dvec3(lastRow) != glm::dvec3(0) && glm::dvec3(m[3]) == glm::dvec3(0))
        gpu::failArgument("CndCamera: viewFromWorld is transposed: its columns must follow one "
                          "another, with the translation in elements 12, 13 and 14");
    if (glm::any(
            glm::greaterThan(glm::abs(lastRow - glm::dvec4(0, 0, 0, 1)), glm::dvec4(tolerance))))
        gpu::failArgument("CndCamera: the last row of viewFromWorld (elements 3, 7, 11 and 15) "
                          "must be 0, 0, 0, 1");
    const glm::dmat3 r(m);
    const glm::dmat3 identity = glm::transpose(r) * r;
    for (int c = 0; c < 3; ++c)
        for (int row = 0; row < 3; ++row)
            if (std::abs(identity[c][row] - (c == row)) > tolerance)
                gpu::failArgument("CndCamera: viewFromWorld must be a rotation and a translation");
    if (glm::determinant(r) < 0) // one-sided lights would face the wrong way
        gpu::failArgument(
            "CndCamera: viewFromWorld must not be a reflection: negate its third row, "
            "and the third column of clipFromView");
}

gpu::Projection projectionOf(const float (&m)[16], float clearDepth)
{
    for (const int i : {1, 2, 3, 4, 6, 7})
        if (m[i] != 0)
            gpu::failArgument("CndCamera: clipFromView may only scale and shift x and y (element " +
                              std::to_string(i) +
                              " must be 0); it is the projection alone, not its product with the "
                              "view matrix");
    for (const float x : m)
        if (!std::isfinite(x))
            gpu::failArgument("CndCamera: clipFromView must be finite");
    gpu::Projection p{.m00 = m[0],
                      .m11 = m[5],
                      .m20 = m[8],
                      .m21 = m[9],
                      .m30 = m[12],
                      .m31 = m[13],
                      .m22 = m[10],
                      .m32 = m[14],
                      .m23 = m[11],
                      .m33 = m[15]};
    const bool perspective = p.m23 != 0 && p.m33 == 0 && p.m30 == 0 && p.m31 == 0 && p.m32 != 0;
    const bool orthographic = p.m23 == 0 && p.m33 != 0 && p.m22 != 0;
    if (p.m00 == 0 || p.m11 == 0 || perspective == orthographic)
        gpu::failArgument("CndCamera: clipFromView is neither a perspective nor an orthographic "
                          "projection");
    p.eyeIsPoint = perspective ? 1.0f : 0.0f;
    if (perspective)
        checkPerspectiveDepth(p);
    if (orthographic) {
        // Depth changes by m22 / m33 per metre of z. The eye looks the way in which depth changes
        // from that of the near end to clearDepth.
        const bool depthGrowsWithZ = p.m22 / p.m33 > 0;
        const bool farIsOne = clearDepth == 1;
        p.eye = {0, 0, depthGrowsWithZ == farIsOne ? -1.0f : 1.0f};
    }
    return p;
}

void checkDepthDirection(const char* frameName, const gpu::Projection& p, float clearDepth)
{
    if (p.eyeIsPoint == 0)
        return; // a parallel projection allows both
    const bool reversed = depthOverDistance(p).slope > 0;
    if (reversed && clearDepth == 1)
        gpu::failArgument(std::string(frameName) +
                          ": clearDepth is 1, but camera.clipFromView makes depth fall with "
                          "distance (reversed depth): clear depth to 0, and set clearDepth to 0");
    if (!reversed && clearDepth == 0)
        gpu::failArgument(std::string(frameName) +
                          ": clearDepth is 0, but camera.clipFromView makes depth grow with "
                          "distance: clear depth to 1, and set clearDepth to 1");
}

} // namespace candelabra::surfaces
