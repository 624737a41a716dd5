// SPDX-License-Identifier: Apache-2.0
// One lobe of the specular BRDF (isotropic GGX, height-correlated Smith, Schlick's Fresnel with
// F90 = 1, cosine included) and how far a linearly transformed cosine is from it.
#pragma once

#include <array>
#include <initializer_list>
#include <vector>

#include <glm/glm.hpp>

namespace candelabra::fit
{

// A linearly transformed cosine (Heitz, Dupuy, Hill and Neubelt 2016): a clamped cosine whose
// directions were transformed by a linear map. In the frame x (in the plane of incidence,
// perpendicular to the mirror direction), y (across the plane), m (the mirror direction), the
// inverse map turns a direction l into
//   (sharpnessX / alpha) l.x + shift l.m,   (sharpnessY / alpha) l.y,   l.n.
// The third coordinate keeps the horizon in place, so no light leaks through it and the integral of
// the lobe is exactly its magnitude. The three parameters vary slowly with roughness and view.
struct LtcShape {
    double sharpnessX = 0.5, sharpnessY = 0.5; // > 0
    double shift = 0;
};

class LtcLobe
{
public:
    // 0.002 <= alpha <= 1, 0 < NoV <= 1, 0 <= F0 <= 1. Computes the lobe in a few thousand
    // directions, which follow from the arguments alone.
    LtcLobe(double alpha, double NoV, double F0);

    // The lobe's integral over the hemisphere.
    double albedo() const { return albedo_; }

    // Errors of a shape, relative to the highest response to a light of the same size. They are
    // over lights from a point to a cap of half angle 70 degrees, most of them near the mirror
    // direction.
    struct Error {
        double cost = 0; // mean of (error to the power 1.5), which the fit minimises
        double mean = 0, largest = 0;
    };
    Error error(const LtcShape& shape) const;

    // Returns the shape of least cost that is found from `start`. For each of `steps` one search is
    // made, whose simplex has edges of that length; each begins where the one before ended.
    LtcShape fitted(const LtcShape& start, std::initializer_list<double> steps) const;

private:
    struct Direction {
        glm::dvec3 l;          // in the frame of LtcShape
        double response = 0;   // response of the lobe to a light in that direction, per steradian
        double solidAngle = 0; // solid angle that the direction represents in integrals
    };
    struct Cap {
        std::vector<uint32_t> inside; // indices into lattice_
        double peak = 0;              // highest response to a cap of this size, anywhere
    };
    Direction direction(const glm::dvec3& l, double solidAngle) const; // l relative to the normal
    void makeLattice();
    void makePoints();
    void makeCaps(double halfAngle);
    double capResponse(const glm::dvec3& centre, double cosHalfAngle) const;
    double evaluate(const LtcShape& shape, const glm::dvec3& l) const;

    double alpha_, NoV_, F0_;
    glm::dvec3 eye_, x_, mirror_; // relative to the normal (0, 0, 1)
    double albedo_ = 0;
    std::vector<Direction>
        lattice_; // directions to integrate over the hemisphere with; denser in the lobe
    std::vector<Direction>
        points_; // directions of lights that are so small that they act as points
    double pointPeak_ = 0;
    double pointShare_ = 0; // share of the lights of all sizes that points_ represent
    std::vector<Cap> caps_;
};

} // namespace candelabra::fit
