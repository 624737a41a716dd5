// SPDX-License-Identifier: Apache-2.0
// The truth that every approximation is measured against: what a light of the public interface
// sends from a surface point to the eye, integrated in double to a requested tolerance.
#pragma once

#include "candelabra/candelabra.h"
#include "reference/response.h"

namespace candelabra::reference
{

// The directions in which a sphere is seen. A receiver inside it sees the half sphere around the
// centre, which continues what it sees from the surface (the form factor is (1 + c) / 2 there; the
// physical value would jump to 1); the very centre has no direction and gets an empty cap.
SphereCap sphereCap(const glm::dvec3& toCenter, double radius);

// Response to a cap of directions: specular in half-vector slopes (slope_domain.h), the form factor
// in closed form. This serves spheres and distant spheres.
LightResponse truthOfCap(const SurfacePoint& surface, double alpha, const SphereCap& cap,
                         double relative);

// Response to an area light of luminance 1, whatever its emission; no window:
//   sphere          sphereCap; its form factor in the very centre is that of c = 0.
//   distant sphere  the cap of sine `radius` around the opposite of `direction`.
//   tube            inside it, or at its surface: the half sphere towards the nearest point of its
//                   segment, continuous like the sphere; on the segment, like the sphere's centre.
//   rectangle, disc nothing from behind unless twoSided, and nothing to receivers in its plane.
// Area lights are integrated over light directions (direction_domain.h). The specular lobe is left
// out (a = b = 0) with alpha = 0. Punctual and unknown types throw std::invalid_argument.
LightResponse truthResponse(const SurfacePoint& surface, double alpha, const CndLight& light,
                            const glm::dvec3& lightOrigin, double relative);

struct Truth {
    glm::dvec3 luminance{0};
    bool converged = true; // the tolerance was reached
};

// Luminance (cd/m^2 per channel) that `light` sends from the surface to the eye: direct light, no
// shadows, the window included, the material's own emission not included:
//     L W (albedo f + gain (F0 (a - b) + F90 b))
// to the relative tolerance given (1e-3..1e-9). Point, spot and directional lights have closed
// forms: outgoingLuminance (light.h).
Truth truthLuminance(const SurfacePoint& surface, const Material& material, const CndLight& light,
                     const glm::dvec3& lightOrigin, double relative);

} // namespace candelabra::reference
