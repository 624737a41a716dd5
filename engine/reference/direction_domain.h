// SPDX-License-Identifier: Apache-2.0
// Response to an emitter of constant luminance, integrated over the directions to the light.
#pragma once

#include "reference/outline.h"

namespace candelabra::reference
{

// Returns a and b (response.h) of the outline's part above the horizon. Nested adaptive quadrature
// of the BRDF of brdf.h, in polar coordinates around the mirror direction: every half circle from
// there meets outline and horizon in one interval with exact ends. The substitution tan(theta / 2)
// = w tan u along it, with the lobe's width w, keeps narrow lobes smooth. `relative` is the
// requested relative tolerance. alpha >= 1e-4, because the BRDF computed from unit vectors has no
// more digits.
LightResponse directionDomainSpecular(const SurfacePoint& surface, double alpha,
                                      const Outline& outline, double relative);

// Returns the form factor, 1 / pi times the integral of NoL above the horizon, as f and fError. In
// polar coordinates around the outline's centre: closed form along each half circle, adaptive
// quadrature across them.
LightResponse directionDomainDiffuse(const glm::dvec3& normal, const Outline& outline,
                                     double relative);

} // namespace candelabra::reference
