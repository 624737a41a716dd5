// SPDX-License-Identifier: Apache-2.0
// One lobe of the specular BRDF (isotropic GGX, height-correlated Smith, F = 1, cosine included)
// and how far a linearly transformed cosine is from it.
#pragma once

#include <array>
#include <initializer_list>
#include <vector>

#include <glm/glm.hpp>

namespace candelabra::fit
{

// Heitz, Dupuy, Hill and Neubelt 2016: a clamped cosine whose directions went through a linear map.
// The maps used here leave the horizon where it is, so that nothing leaks through it and the lobe's
// integral is exactly its magnitude: in the frame x (in the plane of incidence, perpendicular to
// the mirror direction), y (across it), m (the mirror direction), a direction l becomes
//   (sharpnessX / alpha) l.x + shift l.m,   (sharpnessY / alpha) l.y,   l.n.
// Written so, all three vary slowly over roughness and view direction.
struct LtcShape {
    double sharpnessX = 0.5, sharpnessY = 0.5; // > 0
    double shift = 0;
};

class LtcLobe
{
public:
    // 0.002 <= alpha <= 1, 0 < NoV <= 1, 0 <= F0 <= 1. Makes a few thousand deterministic
    // directions.
    LtcLobe(double alpha, double NoV, double F0);

    // The lobe's integral over the hemisphere.
    double albedo() const { return albedo_; }

    // Errors of a shape relative to the highest response to a light of the same size, over lights
    // from a point to a cap of half angle 70 degrees, densest around the mirror direction.
    struct Error {
        double cost = 0; // mean of the errors to the power 1.5: what is minimised
        double mean = 0, largest = 0;
    };
    Error error(const LtcShape& shape) const;

    // The shape of least cost found from `start`, in one descent per first `step`.
    LtcShape fitted(const LtcShape& start, std::initializer_list<double> steps) const;

private:
    struct Direction {
        glm::dvec3 l;          // in the frame of LtcShape
        double response = 0;   // of the lobe to a light in that direction, per steradian
        double solidAngle = 0; // this direction stands for, when integrating
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
    std::vector<Direction> lattice_; // integrates over the hemisphere, denser in the lobe
    std::vector<Direction> points_;  // lights too small to matter
    double pointPeak_ = 0;
    double pointShare_ = 0; // of the lights of all sizes, those that points_ stand for
    std::vector<Cap> caps_;
};

} // namespace candelabra::fit
