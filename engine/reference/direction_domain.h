// SPDX-License-Identifier: Apache-2.0
// Response to an emitter of constant luminance, integrated over light directions.
#pragma once

#include "reference/outline.h"

namespace candelabra::reference
{

// a and b (response.h) of the outline's part above the horizon, by nested adaptive quadrature of
// the BRDF of brdf.h in polar coordinates around the mirror direction. Every half circle from there
// meets outline and horizon in one exact interval. Along it tan(theta / 2) = w tan u with the
// lobe's width w makes narrow lobes smooth. `relative`: requested relative tolerance. alpha >=
// 1e-4: the BRDF from unit vectors has no more digits.
LightResponse directionDomainSpecular(const SurfacePoint& surface, double alpha,
                                      const Outline& outline, double relative);

// Form factor 1 / pi integral of NoL above the horizon (f and fError), in polar coordinates around
// the outline's centre: closed form along each half circle, adaptive quadrature across them.
LightResponse directionDomainDiffuse(const glm::dvec3& normal, const Outline& outline,
                                     double relative);

} // namespace candelabra::reference
