// SPDX-License-Identifier: Apache-2.0
// Directional albedo: how much of uniform surroundings of luminance 1 a lobe reflects. In double
// precision.
#pragma once

namespace candelabra::reference
{

// Directional albedo of the GGX lobe with F = 1 (`a`) and with F = (1 - VoH)^5 (`b`); with
// Schlick's Fresnel the lobe reflects F0 (a - b) + F90 b. Computed by quadrature over the
// microfacet normals (Walter et al. 2007, eq. 20 with its Jacobian), refined until two rules agree
// to `tolerance`. 0.002 <= alpha <= 1 and 1e-4 <= NoV <= 1; otherwise throws std::domain_error.
// Throws std::runtime_error if the quadrature does not converge.
struct DirectionalAlbedo {
    double a = 0;
    double b = 0;
};
DirectionalAlbedo specularAlbedo(double NoV, double alpha, double tolerance = 1e-6);

// Returns the integral of NoL / pi (1 - VoH)^5 over the hemisphere: what glTF's mix(diffuse,
// specular, F(VoH)) takes from a white diffuse lobe with F0 = 0, F90 = 1. 0 < NoV <= 1.
double schlickShareOfDiffuse(double NoV);

} // namespace candelabra::reference
