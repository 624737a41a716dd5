// SPDX-License-Identifier: Apache-2.0
// Response to rectangles, discs and tubes, integrated over the emitter's surface: the second
// opinion on direction_domain.h, with which it shares neither outlines nor Jacobians.
#pragma once

#include "candelabra/candelabra.h"
#include "reference/response.h"

namespace candelabra::reference
{

// a, b and f of a light of type rectangle, disc or tube (others throw std::invalid_argument) whose
// surface is not at the receiver: nested adaptive quadrature over rows of the rectangle or disc, or
// over the visible parts of the tube's cylinder and hemispheres, each row cut exactly at the
// horizon. No window. Meant for tests: lobes much narrower than the emitter cost it dearly.
LightResponse emitterDomainResponse(const SurfacePoint& surface, double alpha,
                                    const CndLight& light, const glm::dvec3& lightOrigin,
                                    double relative);

} // namespace candelabra::reference
