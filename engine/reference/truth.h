// SPDX-License-Identifier: Apache-2.0
// The truth that every approximation is measured against: the luminance that a light of the public
// interface sends from a surface point to the eye, integrated in double precision to a requested
// tolerance.
#pragma once

#include "candelabra/candelabra.h"
#include "reference/response.h"

namespace candelabra::reference
{

// Returns the directions in which a sphere is seen. A receiver inside it sees the hemisphere around
// the direction of the centre, which continues what it sees from the surface (the form factor there
// is (1 + c) / 2; the physical value would jump to 1). At the very centre there is no direction, so
// the cap is empty.
SphereCap sphereCap(const glm::dvec3& toCenter, double radius);

// Returns the response to a cap of directions: the specular lobe by integration over half-vector
// slopes (slope_domain.h), the form factor in closed form. Used for spheres and distant spheres.
LightResponse truthOfCap(const SurfacePoint& surface, double alpha, const SphereCap& cap,
                         double relative);

// Returns the response to an area light of luminance 1, whatever its emission; without the window.
// truth.cpp says, type by type, what a receiver inside an emitter, in its plane or at its back
// sees. With alpha = 0 the specular lobe is left out (a = b = 0). Punctual and unknown types throw
// std::invalid_argument.
LightResponse truthResponse(const SurfacePoint& surface, double alpha, const CndLight& light,
                            const glm::dvec3& lightOrigin, double relative);

struct Truth {
    glm::dvec3 luminance{0};
    bool converged = true; // the tolerance was reached
    // Area lights: what the response's a, b and f add to the luminance, which is their sum.
    glm::dvec3 a{0}, b{0}, f{0};
};

// Returns the luminance (cd/m^2 per channel) that `light` sends from the surface to the eye: direct
// light without shadows, the window included, the material's own emission not included:
//     L W (albedo f + gain (F0 (a - b) + F90 b))
// to the given relative tolerance (1e-3..1e-9). Point, spot and directional lights have closed
// forms: outgoingLuminance (light.h).
Truth truthLuminance(const SurfacePoint& surface, const Material& material, const CndLight& light,
                     const glm::dvec3& lightOrigin, double relative);

} // namespace candelabra::reference
