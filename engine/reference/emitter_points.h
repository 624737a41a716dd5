// SPDX-License-Identifier: Apache-2.0
// Points of a light's emitter, as a receiver sees them.
#pragma once

#include <optional>
#include <vector>

#include <glm/glm.hpp>

#include "candelabra/candelabra.h"
#include "reference/occluders.h"
#include "reference/response.h"

namespace candelabra::reference
{

struct EmitterPoint {
    glm::dvec3 direction{0}; // unit, from the receiver
    double distance = 0;     // infinite for distant lights
    // Points per solid angle, 1/sr, if the emitter has one point in all. 0: the receiver does not
    // see this point, because the emitter itself hides it.
    double density = 0;
};

// The emitter of a light, relative to a receiver that receives light from it (truth.h).
class EmitterPoints
{
public:
    EmitterPoints(const CndLight& light, const glm::dvec3& lightOrigin, const glm::dvec3& receiver);

    // Tells whether the receiver is inside the emitter, which then has no points.
    bool contain() const { return contain_; }
    bool isPoint() const; // punctual: all points are the same
    // Returns a point for (u, v) in [0, 1)^2. Evenly distributed numbers give points evenly
    // distributed over the solid angle of a sphere, over the area of other shapes. The density of
    // punctual lights is 1.
    EmitterPoint at(double u, double v) const;
    // Returns the point that is seen in this unit direction. Punctual lights have none.
    std::optional<EmitterPoint> along(const glm::dvec3& direction) const;
    Shaft shaft() const;

private:
    EmitterPoint onCap(const glm::dvec3& direction) const;
    EmitterPoint onSurface(const glm::dvec3& point) const;
    glm::dvec3 surfacePoint(double u, double v) const;

    const CndLight& light_;
    glm::dvec3 lightOrigin_, receiver_;
    glm::dvec3 toCenter_{0};
    bool contain_ = false;
    SphereCap cap_;
    double capHeight_ = 0; // 1 - cosine of the cap's half angle
    glm::dvec3 normal_{0}; // of flat lights, unit
    double area_ = 0;
    std::vector<glm::dvec3> corners_; // of polygons, relative to the receiver
};

} // namespace candelabra::reference
