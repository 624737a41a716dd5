// SPDX-License-Identifier: Apache-2.0
// The handles of the selected light, by which the mouse moves it. It needs no window.
#pragma once

#include <optional>
#include <vector>

#include "viewer/light_shape.h"

namespace candelabra::app
{

struct LightHandles {
    // A handle is a mask of the axes along which it moves the light: bit 0 is x, 1 is y, 2 is z.
    // One axis is a line, two are a square in their plane.
    static constexpr uint32_t all[] = {1, 2, 4, 3, 5, 6};

    glm::dvec3 centre{0}; // the light, metres in world space
    double length = 1;    // of the lines, metres

    // The line from end to end, or the corners of the square, the first one again at the end.
    std::vector<glm::dvec3> outlineOf(uint32_t handle) const;
    // Returns the handle at a place of the picture, or at most `slack` pixels beside its line.
    // Squares come first, because the lines are longer.
    std::optional<uint32_t> at(const Projection& view, glm::dvec2 place, double slack) const;
    // Returns the point on the line or plane of a handle that a place of the picture shows. There
    // is none if it would be behind the camera. There is none either if the camera looks almost
    // along the line or plane, because one pixel then shows a great part of the line or plane.
    std::optional<glm::dvec3> pointOn(uint32_t handle, const Projection& view,
                                      glm::dvec2 place) const;
};

} // namespace candelabra::app
