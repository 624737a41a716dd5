// SPDX-License-Identifier: Apache-2.0
// Outgoing luminance of one surface point under one light of the public interface. In double
// precision.
#pragma once

#include <glm/glm.hpp>

#include "candelabra/candelabra.h"
#include "reference/surface.h"

namespace candelabra::reference
{

// Returns the luminance (cd/m^2 per channel) that `light` sends from the surface to the eye: direct
// light without shadows, the window included, the material's own emission not included. Models, by
// type:
//   sphere:      L W (albedo F + F0 (a - b) + F90 b)                  (sphere_light.h)
//   point, spot: E = I(direction) / d^2 W NoL; E (albedo / pi + D V (F0 (1 - p) + F90 p)),
//                p = (1 - VoH)^5. A spot's intensity is its axial intensity times t^2,
//                t = clamp((cos theta - cos outer) / (cos inner - cos outer), 0, 1)
//                (glTF KHR_lights_punctual, inner and outer cone angles), with squared sines of
//                half angles in place of cosines: cos x = 1 - 2 sin^2(x / 2).
//   directional: E = emission NoL, no window.
// A receiver exactly at the position of a punctual light gets no light, because there is no
// direction. CND_SPECULAR_NONE leaves the specular lobe out for every type. The light must satisfy
// the ranges in candelabra.h; an unknown type throws std::invalid_argument.
glm::dvec3 outgoingLuminance(const SurfacePoint& surface, const Material& material,
                             const CndLight& light, const glm::dvec3& lightOrigin,
                             CndSpecularMethod specularMethod);

// Returns the spot factor t^2 above for the angle theta between the axis and a direction.
// `halfSine2` is sin^2(theta / 2), a quarter of the squared distance of these two unit vectors.
double spotAttenuation(double halfSine2, double innerConeAngle, double outerConeAngle);

} // namespace candelabra::reference
