// SPDX-License-Identifier: Apache-2.0
// Minimises a function of a few variables without its derivative, by the method of Nelder and Mead
// (1965). It stands here, although NLopt has the same method, because the unit tests use it and
// build without NLopt, and because ltc_table.inc is made with it and must come out the same.
#pragma once

#include <algorithm>
#include <array>
#include <cstddef>
#include <numeric>

namespace candelabra::fit
{

template <size_t N>
struct Minimum {
    std::array<double, N> at{};
    double value = 0;
};

// Starts from a simplex with a corner at `start` and edges of length `step` along the axes. Stops
// after `iterations`, or when the values at all corners agree to a relative 1e-7. Deterministic.
template <size_t N, typename Function>
Minimum<N> minimise(const Function& function, const std::array<double, N>& start, double step,
                    int iterations)
{
    using Point = std::array<double, N>;
    std::array<Minimum<N>, N + 1> corners;
    for (size_t i = 0; i <= N; ++i) {
        Point at = start;
        if (i > 0)
            at[i - 1] += step;
        corners[i] = {at, function(at)};
    }
    const auto less = [](const Minimum<N>& a, const Minimum<N>& b) { return a.value < b.value; };
    for (int iteration = 0; iteration < iterations; ++iteration) {
        std::stable_sort(corners.begin(), corners.end(), less);
        const Minimum<N>& best = corners.front();
        Minimum<N>& worst = corners.back();
        if (worst.value - best.value < 1e-7 * best.value)
            break;
        Point centre{};
        for (size_t i = 0; i < N; ++i)
            for (size_t k = 0; k < N; ++k)
                centre[k] += corners[i].at[k] / double(N);
        const auto along = [&](double t) {
            Point at;
            for (size_t k = 0; k < N; ++k)
                at[k] = centre[k] + t * (worst.at[k] - centre[k]);
            return Minimum<N>{at, function(at)};
        };
        const Minimum<N> reflected = along(-1);
        if (reflected.value < best.value) {
            const Minimum<N> expanded = along(-2);
            worst = expanded.value < reflected.value ? expanded : reflected;
        } else if (reflected.value < corners[N - 1].value) {
            worst = reflected;
        } else {
            const Minimum<N> contracted = along(reflected.value < worst.value ? -0.5 : 0.5);
            if (contracted.value < std::min(reflected.value, worst.value)) {
                worst = contracted;
                continue;
            }
            for (size_t i = 1; i <= N; ++i) {
                for (size_t k = 0; k < N; ++k)
                    corners[i].at[k] = 0.5 * (corners[i].at[k] + best.at[k]);
                corners[i].value = function(corners[i].at);
            }
        }
    }
    return *std::min_element(corners.begin(), corners.end(), less);
}

} // namespace candelabra::fit
