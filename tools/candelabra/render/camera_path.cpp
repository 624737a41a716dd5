// SPDX-License-Identifier: Apache-2.0
#include "render/camera_path.h"

#include <algorithm>
#include <numbers>

#include <glm/gtc/matrix_transform.hpp>

namespace candelabra::app
{

Camera cameraAt(const Camera& first, CameraPath path, uint32_t index, uint32_t count)
{
    Camera out = first;
    if (path == CameraPath::Still)
        return out;
    const double share = double(index) / std::max(count, 1u);
    const glm::dmat4 turn =
        glm::rotate(glm::dmat4(1), 2 * std::numbers::pi * share, glm::dvec3(0, 1, 0));
    out.forward = glm::dvec3(turn * glm::dvec4(first.forward, 0));
    out.up = glm::dvec3(turn * glm::dvec4(first.up, 0));
    return out;
}

} // namespace candelabra::app
