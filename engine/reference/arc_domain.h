// SPDX-License-Identifier: Apache-2.0
// The GGX lobe and the irradiance of lights of constant luminance, integrated along the outlines of
// the lights.
#pragma once

#include <span>

#include <glm/glm.hpp>

#include "candelabra/candelabra.h"
#include "reference/response.h"

namespace candelabra::reference
{

// Integrals over the directions l to a light that are above the horizon. n is the surface's normal
// and h the half vector of l and of the direction to the eye.
struct LobeIntegral {
    double integral = 0;      // of D (n . h) dw_h: the lobe without shadowing and Fresnel, 0..1
    glm::dvec3 meanSlope{0};  // the mean of h_t / (n . h), weighted alike; h_t is tangential
    glm::dvec3 irradiance{0}; // 1 / pi times the integral of l: n . irradiance is the form factor
    bool converged = true;    // every arc reached the tolerance of 1e-12
};

// Each function below uses Stokes' theorem. The half vector m = l + v is not normalised; with the
// normal as z, w = (m_x, m_y, alpha m_z). D (n . h) dw_h is the cosine-weighted measure of
// directions of w, so `integral` is the component along the normal of
//     Phi = 1 / pi integral of w / |w| over the directions of w
//         = 1 / (2 pi) closed integral of (w x dw) / |w|^2,
// which runs along the outline, with the light on the left as seen from the receiver, and along the
// horizon between the points at which the outline goes below it and comes back. The irradiance is
// the same with l in place of w. So a double integral becomes a sum of integrals along arcs, each
// by adaptive quadrature to 1e-12: a few microseconds per light. Shapes and coordinates are not
// those of the other two integrators (direction_domain.h, emitter_domain.h). Eyes below minNoV are
// raised, as there. 0 < alpha <= 1.

// A convex planar polygon; the corners are relative to the receiver and in order around the
// polygon, either way round. A receiver in its plane gets 0.
LobeIntegral arcDomainPolygon(const SurfacePoint& surface, double alpha,
                              std::span<const glm::dvec3> corners);

// A disc around `center` (relative to the receiver). A receiver in its plane gets 0.
LobeIntegral arcDomainDisc(const SurfacePoint& surface, double alpha, const glm::dvec3& center,
                           const glm::dvec3& normal, double radius);

// The convex hull of two spheres of one radius around end0 and end1, relative to a receiver outside
// it.
LobeIntegral arcDomainCapsule(const SurfacePoint& surface, double alpha, const glm::dvec3& end0,
                              const glm::dvec3& end1, double radius);

LobeIntegral arcDomainCap(const SurfacePoint& surface, double alpha, const SphereCap& cap);

// Any area light of the public interface. What receivers inside a body, in the plane or at the back
// of a flat light see is as for truthResponse (truth.h). Punctual and unknown types throw
// std::invalid_argument.
LobeIntegral arcDomainLight(const SurfacePoint& surface, double alpha, const CndLight& light,
                            const glm::dvec3& lightOrigin);

} // namespace candelabra::reference
