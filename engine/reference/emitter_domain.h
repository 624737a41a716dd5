// SPDX-License-Identifier: Apache-2.0
// Response to area lights that have a position, integrated over the emitter's surface. It is a
// second implementation to check direction_domain.h and slope_domain.h, with which it shares
// neither outlines nor Jacobians.
#pragma once

#include "candelabra/candelabra.h"
#include "reference/response.h"

namespace candelabra::reference
{

// Returns a, b and f of an area light whose emitter does not contain the receiver. Distant and
// punctual lights throw std::invalid_argument. Nested adaptive quadrature over rows of a rectangle
// or disc, or over the visible parts of cylinders and hemispheres; each row is cut exactly at the
// horizon. Without the window. Meant for tests: it is slow for lobes much narrower than the
// emitter.
LightResponse emitterDomainResponse(const SurfacePoint& surface, double alpha,
                                    const CndLight& light, const glm::dvec3& lightOrigin,
                                    double relative);

} // namespace candelabra::reference
