// SPDX-License-Identifier: Apache-2.0
#include "surfaces/camera.h"

#include <cmath>
#include <cstring>
#include <string>

#include <glm/mat3x3.hpp>
#include <glm/mat4x4.hpp>

#include "gpu/failure.h"

namespace candelabra::surfaces
{

void checkCamera(const CndCamera& camera)
{
    for (const double x : camera.viewFromWorld)
        if (!std::isfinite(x))
            gpu::failArgument("CndCamera: viewFromWorld must be finite");
    glm::dmat4 m;
    std::memcpy(&m, camera.viewFromWorld, sizeof m);
    const glm::dmat3 r(m);
    const glm::dmat3 identity = glm::transpose(r) * r;
    for (int c = 0; c < 3; ++c)
        for (int row = 0; row < 3; ++row)
            if (std::abs(identity[c][row] - (c == row)) > 1e-5) // matrices of floats reach 1e-6
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
                              std::to_string(i) + " must be 0)");
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
    if (orthographic) {
        // Depth changes by m22 / m33 per metre of z. The eye looks the way in which depth changes
        // from that of the near end to clearDepth.
        const bool depthGrowsWithZ = p.m22 / p.m33 > 0;
        const bool farIsOne = clearDepth == 1;
        p.eye = {0, 0, depthGrowsWithZ == farIsOne ? -1.0f : 1.0f};
    }
    return p;
}

} // namespace candelabra::surfaces
