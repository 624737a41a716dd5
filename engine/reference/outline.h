// SPDX-License-Identifier: Apache-2.0
// Emitters as sets of directions. All of them are convex: a great circle meets each in one arc.
#pragma once

#include <memory>
#include <optional>
#include <span>
#include <vector>

#include <glm/glm.hpp>

#include "reference/response.h"

namespace candelabra::reference
{

// Part of a great circle: all angles within halfWidth (<= pi / 2) of the centre.
struct Arc {
    double centre, halfWidth;
};

// Returns the intersection of two arcs; empty if there is none.
std::optional<Arc> intersect(const Arc& a, const Arc& b);

class Outline
{
public:
    virtual ~Outline() = default;

    // Returns which directions cos(t) p + sin(t) q are inside the emitter; p and q are unit and
    // perpendicular.
    virtual std::optional<Arc> arc(const glm::dvec3& p, const glm::dvec3& q) const = 0;

    // Returns angles t at which the great circles from `pole` through cos(t) x + sin(t) y touch the
    // outline or pass one of its corners; additional angles do no harm. The pole is the frame's z.
    virtual std::vector<double> angles(const Frame& pole) const = 0;

    // Returns a direction inside.
    virtual glm::dvec3 centre() const = 0;
};

std::unique_ptr<Outline> capOutline(const SphereCap& cap);

// The outline of a convex polygon whose plane does not contain the receiver. The corners are
// relative to the receiver and in order around the polygon.
std::unique_ptr<Outline> polygonOutline(std::span<const glm::dvec3> corners);

// The outline of a disc, relative to the receiver, whose plane does not contain the receiver.
std::unique_ptr<Outline> discOutline(const glm::dvec3& center, const glm::dvec3& normal,
                                     double radius);

// The outline of the convex hull of two spheres of one radius (a capsule), relative to a receiver
// outside it.
std::unique_ptr<Outline> capsuleOutline(const glm::dvec3& end0, const glm::dvec3& end1,
                                        double radius);

} // namespace candelabra::reference
