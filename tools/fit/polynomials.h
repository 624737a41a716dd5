// SPDX-License-Identifier: Apache-2.0
// Linear minimax approximation, and the two polynomials of the closed form of sphere lights that
// are such approximations (shaders/shared/conic_constants.h).
#pragma once

#include <functional>
#include <string>
#include <vector>

namespace candelabra::fit
{

using Function = std::function<double(double)>;

// An approximation of a function target(x) by the sum of coefficients[i] basis[i](x).
struct Minimax {
    std::vector<double> coefficients;
    double largestError = 0; // absolute, over the interval
};

// Finds the coefficients whose largest error on [low, high] is least, by the exchange algorithm of
// Remez on 4,001 points. The algorithm is right if the basis is a Chebyshev system inside the
// interval, as powers are: then the error of the best approximation reaches its largest size, with
// alternating signs, at one point more than there are functions. Deterministic.
Minimax minimax(const std::vector<Function>& basis, const Function& target, double low,
                double high);

// The errors of one of the polynomials, and the best polynomial of the same form.
struct PolynomialFit {
    std::string name;
    double committedError = 0; // largest error of the coefficients that the shaders have
    Minimax best;              // it has only the coefficients that are not given by conditions
};
PolynomialFit fitArcTangent();
PolynomialFit fitCircleSegment();

} // namespace candelabra::fit
