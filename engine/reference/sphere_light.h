// SPDX-License-Identifier: Apache-2.0
// A sphere of constant luminance over a Lambert + GGX surface.
#pragma once

#include <glm/glm.hpp>

#include "reference/surface.h"

namespace candelabra::reference
{

// Form factor F = E / (pi L) of a sphere with angular radius asin(s) whose centre is at the angle
// acos(c) to the normal, without the part below the horizon. Exact: the closed form of Lagarde and
// de Rousiers 2014, section 4.7.2 (after Snyder 1996), rearranged so that double precision keeps
// its full relative accuracy (about 1e-14 of s^3) for small s too. -1 <= c <= 1, 0 <= s <= 1;
// otherwise throws std::domain_error. For s = 1 it is (1 + c) / 2, which is also used for a
// receiver inside the sphere: it is continuous at the sphere's surface, where the physical value
// jumps to 1.
double sphereFormFactor(double c, double s);

// Share of a light's illuminance that its window passes at `distance` metres: (1 - (d/r)^4)^2 for
// d < r, 0 for d >= r, 1 for r = infinity. Lagarde and de Rousiers 2014, eq. 26.
double lightWindow(double distance, double influenceRadius);

// Specular response to a sphere of luminance 1: `a` with Fresnel 1, `b` with Fresnel (1 - VoH)^5.
// Outgoing luminance is L (F0 (a - b) + F90 b).
struct SpecularResponse {
    double a = 0;
    double b = 0;
};

// Karis 2013, "Real Shading in Unreal Engine 4", area lights: the specular response of the point of
// the sphere next to the mirror ray, with the energy of the widened lobe alpha' = min(alpha + R /
// 2d, 1). The mirror direction is 2 NoV n - v, where NoV is clamped to minNoV as everywhere in the
// model (brdf.h), so it is a unit vector only if the eye is above the horizon. The response is 0 if
// the representative point lies at or below the horizon, or at the shading point itself, where it
// has no direction (receiver inside the sphere, mirror ray at a right angle to the centre).
SpecularResponse karisSphereSpecular(const SurfacePoint& surface, double alpha,
                                     const glm::dvec3& center, double radius);

// Returns the form factor of the sphere at a surface point; a receiver exactly at the centre uses c
// = 0.
double sphereDiffuse(const SurfacePoint& surface, const glm::dvec3& center, double radius);

} // namespace candelabra::reference
