// SPDX-License-Identifier: Apache-2.0
// Specular response to a cap of constant luminance, integrated over half-vector slopes.
#pragma once

#include "reference/response.h"

namespace candelabra::reference
{

// Returns a and b (response.h; f stays 0) of the cap's part above the horizon, by nested adaptive
// quadrature in half-vector slope space: m = (x, y, 1) with the normal as z,
//     a = 1 / NoV integral p22(x, y) dot(v, m) G2 dx dy,    p22 = alpha^2 / (pi (alpha^2 + r^2)^2)
// (Walter et al. 2007, eq. 14 and 20; Heitz 2014, eq. 72 to 99). In this space the cap is a conic
// and the horizon a circle around the origin, so every ray from the origin has intervals with exact
// ends. The substitution r = alpha tan u along a ray turns the lobe into sin u cos u, so no lobe
// width is special. `relative` is the requested relative tolerance; 1e-4 costs about 20 us, 1e-8
// about 100 us. The cap's sin2 is limited to maxSpecularSin2. 0 < alpha <= 1.
LightResponse slopeDomainSpecular(const SurfacePoint& surface, double alpha, const SphereCap& cap,
                                  double relative);

} // namespace candelabra::reference
