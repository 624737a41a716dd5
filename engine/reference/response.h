// SPDX-License-Identifier: Apache-2.0
// The integrators of area lights share this: their result, and directions of the eye.
#pragma once

#include <algorithm>
#include <cmath>

#include <glm/glm.hpp>

#include "reference/brdf.h"
#include "reference/surface.h"

namespace candelabra::reference
{

// Response of a surface to a light of luminance 1: f is the form factor E / pi, a is the specular
// lobe with Fresnel 1, b is the specular lobe with Fresnel (1 - VoH)^5. Outgoing luminance is L
// (albedo f + F0 (a - b) + F90 b). The errors are the quadrature's own estimates, 0 for closed
// forms.
struct LightResponse {
    double a = 0, b = 0, f = 0;
    double aError = 0, bError = 0, fError = 0;
    bool converged = true; // the requested tolerance was reached
};

// A cap of directions: all directions l with dot(l, axis) >= sqrt(1 - sin2).
struct SphereCap {
    glm::dvec3 axis{0, 1, 0}; // unit
    double sin2 = 0;          // squared sine of the half angle, 0..1

    double cosine() const { return std::sqrt(std::max(0.0, 1 - sin2)); }
    double sine() const { return std::sqrt(sin2); }
};

// The widest cap that the specular lobe uses, 89.4 degrees; receivers on or inside a sphere use it.
inline constexpr double maxSpecularSin2 = 0.9999;

// Returns the surface with its eye raised to NoV >= minNoV (brdf.h) in its own plane of incidence,
// which keeps toEye a unit vector: Smith's function is undefined below the horizon. Analytic
// objects never need it.
inline SurfacePoint liftEye(SurfacePoint surface)
{
    const double NoV = glm::dot(surface.normal, surface.toEye);
    if (NoV >= minNoV)
        return surface;
    const glm::dvec3 tangential = surface.toEye - NoV * surface.normal;
    surface.toEye =
        minNoV * surface.normal + std::sqrt(1 - minNoV * minNoV) * glm::normalize(tangential);
    return surface;
}

// A right-handed frame around the unit vector `z`. x lies in the plane of z and `hint` unless they
// are parallel.
struct Frame {
    glm::dvec3 x, y, z;
};
inline Frame frameAround(const glm::dvec3& z, const glm::dvec3& hint)
{
    glm::dvec3 x = hint - glm::dot(hint, z) * z;
    if (!(glm::dot(x, x) > 1e-24)) {
        const glm::dvec3 helper = std::abs(z.x) < 0.5 ? glm::dvec3(1, 0, 0) : glm::dvec3(0, 1, 0);
        x = helper - glm::dot(helper, z) * z;
    }
    x = glm::normalize(x - glm::dot(x, z) * z);
    return {x, glm::cross(z, x), z};
}

} // namespace candelabra::reference
