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

// Part of a great circle: angles within halfWidth (<= pi / 2) of the centre.
struct Arc {
    double centre, halfWidth;
};

// What two arcs have in common; empty where that is nothing.
std::optional<Arc> intersect(const Arc& a, const Arc& b);

class Outline
{
public:
    virtual ~Outline() = default;

    // The directions cos(t) p + sin(t) q inside the emitter; p and q are unit and perpendicular.
    virtual std::optional<Arc> arc(const glm::dvec3& p, const glm::dvec3& q) const = 0;

    // Angles t at which the great circles from `pole` through cos(t) x + sin(t) y touch the
    // outline or pass one of its corners; superfluous ones do no harm. The frame's z is the pole.
    virtual std::vector<double> angles(const Frame& pole) const = 0;

    // A direction inside.
    virtual glm::dvec3 centre() const = 0;
};

std::unique_ptr<Outline> capOutline(const SphereCap& cap);

// A convex polygon whose plane does not hold the receiver; corners relative to it, in their order
// around the polygon.
std::unique_ptr<Outline> polygonOutline(std::span<const glm::dvec3> corners);

// A disc, relative to the receiver, whose plane does not hold the receiver.
std::unique_ptr<Outline> discOutline(const glm::dvec3& center, const glm::dvec3& normal,
                                     double radius);

// The convex hull of two spheres of one radius (a capsule), relative to a receiver outside it.
std::unique_ptr<Outline> capsuleOutline(const glm::dvec3& end0, const glm::dvec3& end1,
                                        double radius);

} // namespace candelabra::reference
