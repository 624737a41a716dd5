// SPDX-License-Identifier: Apache-2.0
// One shading point and its material. In double precision.
#pragma once

#include <glm/glm.hpp>

namespace candelabra::reference
{

struct SurfacePoint {
    glm::dvec3 position{0};     // metres, in the space of the lights
    glm::dvec3 normal{0, 1, 0}; // unit
    glm::dvec3 toEye{0, 1, 0};  // unit, away from the surface
};

struct Material {
    glm::dvec3 diffuseAlbedo{0}; // 0..1, already scaled by 1 - metalness
    glm::dvec3 f0{0};            // Schlick reflectance at normal incidence, 0..1
    double specularWeight = 0;   // Schlick F90, 0..1; with f0 = 0 it removes the specular lobe
    double alpha = 1;            // GGX width, 0 < alpha <= 1; a lower limit is up to the caller
    glm::dvec3 emission{0};      // cd/m^2
    glm::dvec3 specularGain{1};  // factor on the specular lobe (joining.h)
};

} // namespace candelabra::reference
