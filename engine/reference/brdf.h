// SPDX-License-Identifier: Apache-2.0
// Isotropic GGX and Lambert BRDFs in double precision: the published formulas, without clamps or
// fast paths. Arguments outside a stated domain (NaN included) throw std::domain_error.
#pragma once

#include <glm/glm.hpp>

namespace candelabra::reference
{

// BRDF of a white Lambertian surface, 1/sr.
double lambertBrdf();

// GGX normal distribution, 1/sr (Trowbridge and Reitz 1975; Walter et al. 2007, eq. 33), normalised
// so that the integral of D cos over the hemisphere is 1. 0 for NoH <= 0; 0 < alpha <= 1.
double ggxD(double NoH, double alpha);

// Smith's auxiliary function Lambda of GGX (Heitz 2014, eq. 72); 0 < cosTheta <= 1.
double smithLambda(double cosTheta, double alpha);

// Height-correlated masking and shadowing (Heitz 2014, eq. 99) divided by the microfacet
// denominator 4 NoL NoV; 0 < NoL <= 1, 0 < NoV <= 1.
double smithVisibility(double NoL, double NoV, double alpha);

// Weight of F90 in Schlick's Fresnel term (Schlick 1994, eq. 15): (1 - VoH)^5; 0 <= VoH <= 1.
double schlickWeight(double VoH);

// The specular BRDF with Fresnel 1 for two unit directions, D V of their half vector, 1/sr, and the
// Schlick weight that splits it into F0 and F90. NoV is clamped to minNoV (below) or more. Both
// members are 0 where NoL <= 0.
struct SpecularBrdf {
    double value = 0;         // D V
    double schlickWeight = 0; // (1 - VoH)^5
};
SpecularBrdf ggxBrdf(const glm::dvec3& normal, const glm::dvec3& toEye, const glm::dvec3& toLight,
                     double alpha);

// The only clamp of the shading model: interpolated and mapped normals can face away from the eye,
// where Smith's function is undefined. It is part of the model that is measured, not a numerical
// aid of the reference.
inline constexpr double minNoV = 1e-4;

} // namespace candelabra::reference
