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

// target(x) is approximated by the sum of coefficients[i] basis[i](x).
struct Minimax {
    std::vector<double> coefficients;
    double largestError = 0; // absolute, over the interval
};

// The coefficients with the least largest error on [low, high], by the exchange algorithm of Remez
// on 4,001 points. The basis should be a Chebyshev system inside the interval, as powers are: then
// the best error takes its largest size with alternating signs once more often than there are
// functions. Deterministic.
Minimax minimax(const std::vector<Function>& basis, const Function& target, double low,
                double high);

// One of the polynomials: what the shaders have, and the best of the same form.
struct PolynomialFit {
    std::string name;
    double committedError = 0; // largest, of the shaders' coefficients
    Minimax best;              // free coefficients only
};
PolynomialFit fitArcTangent();
PolynomialFit fitCircleSegment();

} // namespace candelabra::fit
