// SPDX-License-Identifier: Apache-2.0
#include "fit/polynomials.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "shared/conic_constants.h"

namespace candelabra::fit
{
namespace
{

constexpr double pi = std::numbers::pi;
constexpr int gridSteps = 4000;

// Solves the linear equations a x = b by Gaussian elimination with row pivots. a[row] is a row of
// the square matrix.
std::vector<double> solve(std::vector<std::vector<double>> a, std::vector<double> b)
{
    const size_t n = b.size();
    for (size_t column = 0; column < n; ++column) {
        size_t pivot = column;
        for (size_t row = column + 1; row < n; ++row)
            if (std::abs(a[row][column]) > std::abs(a[pivot][column]))
                pivot = row;
        std::swap(a[column], a[pivot]);
        std::swap(b[column], b[pivot]);
        for (size_t row = column + 1; row < n; ++row) {
            const double factor = a[row][column] / a[column][column];
            for (size_t k = column; k < n; ++k)
                a[row][k] -= factor * a[column][k];
            b[row] -= factor * b[column];
        }
    }
    for (size_t row = n; row-- > 0;) {
        for (size_t k = row + 1; k < n; ++k)
            b[row] -= a[row][k] * b[k];
        b[row] /= a[row][row];
    }
    return b;
}

double largestOnGrid(double low, double high, const Function& error)
{
    double largest = 0;
    for (int i = 0; i <= gridSteps; ++i)
        largest = std::max(largest, std::abs(error(low + (high - low) * i / gridSteps)));
    return largest;
}

// Returns the points of largest error: one for each interval in which the error keeps its sign.
std::vector<double> extrema(double low, double high, const Function& error)
{
    std::vector<double> points;
    double largest = 0, last = 0;
    for (int i = 0; i <= gridSteps; ++i) {
        const double x = low + (high - low) * i / gridSteps;
        const double e = error(x);
        if (e == 0)
            continue;
        if (points.empty() || std::signbit(e) != std::signbit(last)) {
            points.push_back(x);
            largest = 0;
        }
        if (std::abs(e) > largest) {
            largest = std::abs(e);
            points.back() = x;
        }
        last = e;
    }
    return points;
}

} // namespace

Minimax minimax(const std::vector<Function>& basis, const Function& target, double low, double high)
{
    const size_t n = basis.size();
    std::vector<double> points(n + 1);
    for (size_t i = 0; i <= n; ++i) // inside the interval: a basis may vanish at its ends
        points[i] =
            low + (high - low) * 0.5 * (1 - std::cos(pi * (double(i) + 0.5) / double(n + 1)));
    Minimax best{{}, INFINITY};
    for (int iteration = 0; iteration < 50; ++iteration) {
        std::vector<std::vector<double>> a(n + 1, std::vector<double>(n + 1));
        std::vector<double> b(n + 1);
        for (size_t i = 0; i <= n; ++i) {
            for (size_t k = 0; k < n; ++k)
                a[i][k] = basis[k](points[i]);
            a[i][n] =
                i % 2 ? -1
                      : 1; // coefficient of the error, whose sign alternates from point to point
            b[i] = target(points[i]);
        }
        Minimax now{solve(std::move(a), std::move(b)), 0};
        now.coefficients.resize(n);
        const Function error = [&](double x) {
            double sum = -target(x);
            for (size_t k = 0; k < n; ++k)
                sum += now.coefficients[k] * basis[k](x);
            return sum;
        };
        now.largestError = largestOnGrid(low, high, error);
        if (!(now.largestError < best.largestError * (1 - 1e-9)))
            break;
        best = now;
        points = extrema(low, high, error);
        while (points.size() > n + 1) // removing an end keeps the signs alternating
            points.erase(std::abs(error(points.front())) < std::abs(error(points.back()))
                             ? points.begin()
                             : points.end() - 1);
        if (points.size() < n + 1)
            break;
    }
    return best;
}

PolynomialFit fitArcTangent()
{
    const std::vector<double> committed = {-double(gpu::CONIC_ATAN_T3),  gpu::CONIC_ATAN_T5,
                                           -double(gpu::CONIC_ATAN_T7),  gpu::CONIC_ATAN_T9,
                                           -double(gpu::CONIC_ATAN_T11), gpu::CONIC_ATAN_T13,
                                           -double(gpu::CONIC_ATAN_T15)};
    std::vector<Function> powers;
    for (size_t i = 0; i < committed.size(); ++i)
        powers.push_back([i](double t) { return std::pow(t, double(2 * i + 3)); });
    const Function tail = [](double t) { return std::atan(t) - t; };
    return {.name = "arc tangent",
            .committedError = largestOnGrid(0, 1,
                                            [&](double t) {
                                                double sum = -tail(t);
                                                for (size_t i = 0; i < powers.size(); ++i)
                                                    sum += committed[i] * powers[i](t);
                                                return sum;
                                            }),
            .best = minimax(powers, tail, 0, 1)};
}

PolynomialFit fitCircleSegment()
{
    // The part of a circle of radius 1 below the chord at x = 2 u - 1, over the whole area.
    const Function area = [](double u) {
        const double x = 2 * u - 1;
        return (std::acos(-x) + x * std::sqrt(std::max(0.0, 1 - x * x))) / pi;
    };
    const auto form = [](double u, double c0, double c1, double c2) {
        return u * std::sqrt(u) * (c0 - u * (c1 + c2 * u));
    };
    const double start = 16 / (3 * pi);
    return {.name = "circle segment",
            .committedError = largestOnGrid(0, 1,
                                            [&](double u) {
                                                return form(u, gpu::CONIC_SEGMENT,
                                                            gpu::CONIC_SEGMENT_U,
                                                            gpu::CONIC_SEGMENT_U2) -
                                                       area(u);
                                            }),
            // With c1 = start - 1 - c2 the polynomial is 1 at u = 1. What remains is linear in c2.
            .best = minimax(
                {[&](double u) { return form(u, 0, -1, 1); }},
                [&](double u) { return area(u) - form(u, start, start - 1, 0); }, 0, 1)};
}

} // namespace candelabra::fit
