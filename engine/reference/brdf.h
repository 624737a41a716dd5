// SPDX-License-Identifier: Apache-2.0
// Isotropic GGX and Lambert in double: the published formulas, with no clamp and no fast path.
// Arguments outside a stated domain (NaN included) throw std::domain_error.
#pragma once

#include <glm/glm.hpp>

namespace candelabra::reference
{

// Lambert: BRDF of a white diffuse surface, 1/sr.
double lambertBrdf();

// Trowbridge and Reitz 1975; Walter et al. 2007, eq. 33. Normal distribution, 1/sr, normalised so
// that the integral of D cos over the hemisphere is 1. 0 for NoH <= 0; 0 < alpha <= 1.
double ggxD(double NoH, double alpha);

// Heitz 2014, eq. 72. Smith auxiliary function of GGX; 0 < cosTheta <= 1.
double smithLambda(double cosTheta, double alpha);

// Heitz 2014, eq. 99, over 4 NoL NoV. Height-correlated masking and shadowing with the microfacet
// denominator; 0 < NoL <= 1, 0 < NoV <= 1.
double smithVisibility(double NoL, double NoV, double alpha);

// Schlick 1994, eq. 15: (1 - VoH)^5; 0 <= VoH <= 1.
double schlickWeight(double VoH);

// D V of the half vector of two unit directions: the specular BRDF with Fresnel 1, 1/sr, and the
// Schlick weight that splits it. NoV is clamped to >= minNoV (below); 0 where NoL <= 0.
struct SpecularBrdf {
    double value = 0;         // D V
    double schlickWeight = 0; // (1 - VoH)^5
};
SpecularBrdf ggxBrdf(const glm::dvec3& normal, const glm::dvec3& toEye, const glm::dvec3& toLight,
                     double alpha);

// The model's one clamp: interpolated and mapped normals can face away from the eye, where Smith is
// undefined. Part of the shading model that is measured, not a numerical aid of the reference.
inline constexpr double minNoV = 1e-4;

} // namespace candelabra::reference
