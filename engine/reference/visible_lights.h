// SPDX-License-Identifier: Apache-2.0
// Intersection of view rays with visible lights.
#pragma once

#include <optional>
#include <span>

#include <glm/glm.hpp>

#include "candelabra/candelabra.h"

namespace candelabra::reference
{

struct Ray {
    glm::dvec3 origin{0};
    glm::dvec3 direction{0, 0, -1}; // any length but 0; distances are in multiples of this length
};

// Returns the distance at which the ray first meets the emitter, or leaves it if the origin is
// inside. Flat emitters are visible from their front, and from behind if two-sided. Empty for rays
// that miss and for lights that have no surface at a finite distance: punctual and distant ones.
std::optional<double> intersectLight(const CndLight& light, const glm::dvec3& lightOrigin,
                                     const Ray& ray);

// Returns the luminance (cd/m^2) of the distant sphere in this direction; if several overlap, the
// last one.
std::optional<glm::dvec3> distantLuminance(std::span<const CndLight> lights,
                                           const glm::dvec3& direction);

} // namespace candelabra::reference
