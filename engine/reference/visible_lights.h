// SPDX-License-Identifier: Apache-2.0
// Lights that an eye looks at.
#pragma once

#include <optional>
#include <span>

#include <glm/glm.hpp>

#include "candelabra/candelabra.h"

namespace candelabra::reference
{

struct Ray {
    glm::dvec3 origin{0};
    glm::dvec3 direction{0, 0, -1}; // any length but 0; distances are in multiples of it
};

// How far away the ray meets the emitter: the first time, or where it leaves a sphere or tube that
// holds its origin. Rectangles and discs are seen from their front, from behind when two-sided.
// Empty for rays that miss, and for lights without a surface at a distance: point, spot,
// directional, distant sphere.
std::optional<double> intersectLight(const CndLight& light, const glm::dvec3& lightOrigin,
                                     const Ray& ray);

// Luminance (cd/m^2) of the distant sphere in this direction, the last one of several.
std::optional<glm::dvec3> distantLuminance(std::span<const CndLight> lights,
                                           const glm::dvec3& direction);

} // namespace candelabra::reference
