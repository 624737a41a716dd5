// SPDX-License-Identifier: Apache-2.0
// Adaptive Gauss-Kronrod quadrature of several functions at once, with an error estimate.
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <limits>
#include <numbers>
#include <span>
#include <vector>

namespace candelabra::reference
{

// Integrals of N functions over one interval. `error` usually bounds the error; it is an estimate,
// not a proof.
template <size_t N>
struct Integral {
    std::array<double, N> value{};
    std::array<double, N> error{};
    bool converged = true; // the tolerance was reached
};

namespace detail
{

// The 15-point Kronrod rule and the 7-point Gauss rule inside it (Piessens, de Doncker-Kapenga,
// Ueberhuber and Kahaner 1983: QUADPACK, qk15). Nodes are listed from the end inwards; every second
// one, beginning with the second, is a Gauss node.
inline constexpr std::array<double, 8> kronrodNodes = {
    0.991455371120812639206854697526329, 0.949107912342758524526189684047851,
    0.864864423359769072789712788640926, 0.741531185599394439863864773280788,
    0.586087235467691130294144691258980, 0.405845151377397166906606412076961,
    0.207784955007898467600689403773245, 0};
inline constexpr std::array<double, 8> kronrodWeights = {
    0.022935322010529224963732008058970, 0.063092092629978553290700663189204,
    0.104790010322250183839876322541518, 0.140653259715525918745189590510238,
    0.169004726639267902826583426598550, 0.190350578064785409913256402421014,
    0.204432940075298892414161999234649, 0.209482141084727828012999174891714};
inline constexpr std::array<double, 4> gaussWeights = {
    0.129484966168869693270611432679082, 0.279705391489276667901467771423780,
    0.381830050505118944950369775488975, 0.417959183673469387755102040816327};

template <size_t N>
struct Panel {
    double low, high;
    std::array<double, N> value, error;
};

// Integrates one panel. The error is estimated as QUADPACK does: the difference of the two rules,
// scaled down with the power 3/2 where it is small against the function's deviation from its mean.
template <size_t N, class F>
Panel<N> kronrod(double low, double high, F& f)
{
    const double middle = (low + high) / 2, half = (high - low) / 2;
    std::array<std::array<double, N>, 15> samples;
    samples[7] = f(middle);
    for (size_t i = 0; i < 7; ++i) {
        samples[i] = f(middle - half * kronrodNodes[i]);
        samples[14 - i] = f(middle + half * kronrodNodes[i]);
    }
    Panel<N> panel{low, high, {}, {}};
    for (size_t n = 0; n < N; ++n) {
        double fine = kronrodWeights[7] * samples[7][n], coarse = gaussWeights[3] * samples[7][n];
        for (size_t i = 0; i < 7; ++i) {
            const double pair = samples[i][n] + samples[14 - i][n];
            fine += kronrodWeights[i] * pair;
            if (i % 2 == 1)
                coarse += gaussWeights[i / 2] * pair;
        }
        double deviation = kronrodWeights[7] * std::abs(samples[7][n] - fine / 2);
        for (size_t i = 0; i < 7; ++i)
            deviation += kronrodWeights[i] * (std::abs(samples[i][n] - fine / 2) +
                                              std::abs(samples[14 - i][n] - fine / 2));
        double error = std::abs(fine - coarse);
        if (error > 0 && deviation > 0) {
            const double ratio = 200 * error / deviation;
            error = deviation * std::min(1.0, ratio * std::sqrt(ratio));
        }
        panel.value[n] = fine * half;
        panel.error[n] = error * std::abs(half);
    }
    return panel;
}

// Adds `sign` times the integrals over a panel.
template <size_t N>
void addPanel(Integral<N>& sum, const Panel<N>& panel, double sign = 1)
{
    for (size_t n = 0; n < N; ++n) {
        sum.value[n] += sign * panel.value[n];
        sum.error[n] += sign * panel.error[n];
    }
}

template <size_t Judged, size_t N>
std::array<double, Judged> allowedErrors(const Integral<N>& sum, double relative, double absolute)
{
    double largest = 0;
    for (size_t n = 0; n < Judged; ++n)
        largest = std::max(largest, std::abs(sum.value[n]));
    std::array<double, Judged> allowed;
    for (size_t n = 0; n < Judged; ++n)
        allowed[n] = std::max({relative * std::max(std::abs(sum.value[n]), 1e-3 * largest),
                               absolute, std::numeric_limits<double>::min()});
    return allowed;
}

// Returns the panel with the largest error in units of the allowed one.
template <size_t N, size_t Judged>
size_t worstPanel(std::span<const Panel<N>> panels, const std::array<double, Judged>& allowed)
{
    size_t worst = 0;
    double worstExcess = -1;
    for (size_t i = 0; i < panels.size(); ++i)
        for (size_t n = 0; n < Judged; ++n)
            if (const double excess = panels[i].error[n] / allowed[n]; excess > worstExcess) {
                worstExcess = excess;
                worst = i;
            }
    return worst;
}

} // namespace detail

// Integrates f, which maps a double to std::array<double, N>, from the first to the last of
// `breaks` (increasing; include the points where f is not smooth). The panel with the largest error
// is halved until, for each of the first `Judged` functions, the sum of errors is below `relative`
// times the larger of its own integral and a thousandth of the largest one, or below `absolute`; or
// until there are MaxPanels panels.
template <size_t Judged, size_t MaxPanels, class F>
auto integrate(std::span<const double> breaks, double relative, double absolute, F&& f)
{
    using Array = decltype(f(0.0));
    constexpr size_t N = std::tuple_size_v<Array>;
    static_assert(Judged >= 1 && Judged <= N && MaxPanels >= 2);
    Integral<N> sum;
    std::array<detail::Panel<N>, MaxPanels> panels;
    size_t count = 0;
    const auto add = [&](double low, double high) {
        panels[count] = detail::kronrod<N>(low, high, f);
        detail::addPanel(sum, panels[count++]);
    };
    for (size_t i = 0; i + 1 < breaks.size() && count < MaxPanels; ++i)
        if (breaks[i + 1] > breaks[i])
            add(breaks[i], breaks[i + 1]);
    for (;;) {
        const auto allowed = detail::allowedErrors<Judged>(sum, relative, absolute);
        sum.converged = true;
        for (size_t n = 0; n < Judged; ++n)
            sum.converged = sum.converged && sum.error[n] <= allowed[n];
        if (sum.converged || count + 1 > MaxPanels || count == 0)
            break;
        const size_t worst =
            detail::worstPanel(std::span<const detail::Panel<N>>(panels.data(), count), allowed);
        const double low = panels[worst].low, high = panels[worst].high;
        const double middle = (low + high) / 2;
        if (!(middle > low && middle < high)) // the panel cannot be halved any more
            break;
        detail::addPanel(sum, panels[worst], -1);
        panels[worst] = panels[--count];
        add(low, middle);
        add(middle, high);
    }
    // Subtracting halved panels leaves rounding errors in the sums: sum the final panels again.
    sum.value = {};
    sum.error = {};
    for (size_t i = 0; i < count; ++i)
        detail::addPanel(sum, panels[i]);
    return sum;
}

// Absolute tolerance for the response to a luminance of 1. Slivers so thin above the horizon that
// their edges are rounding errors never reach a relative tolerance.
inline constexpr double negligible = 1e-24;

// The outer of two nested integrals: over the panels between neighbouring breaks whose middle is
// `active`, under one tolerance. f maps a double to N values, of which the first `Judged` decide
// about convergence. Each panel is reparametrised with zero slope at both ends, so that functions
// that start there like a square root (the width of a disc near its rim) become smooth.
template <size_t Judged, class Active, class F>
auto integratePanels(std::span<const double> breaks, double relative, Active&& active, F&& f)
{
    using std::numbers::pi;
    std::vector<std::array<double, 2>> panels;
    std::vector<double> ends = {0};
    for (size_t i = 0; i + 1 < breaks.size(); ++i)
        if (breaks[i + 1] > breaks[i] && active((breaks[i] + breaks[i + 1]) / 2)) {
            panels.push_back({breaks[i], breaks[i + 1]});
            ends.push_back(static_cast<double>(panels.size()));
        }
    return integrate<Judged, 200>(
        std::span<const double>(ends), relative, negligible, [&](double x) {
            const size_t i = std::min(static_cast<size_t>(x), panels.size() - 1);
            const double width = panels[i][1] - panels[i][0];
            const double half = pi / 2 * (x - static_cast<double>(i));
            const double sine = std::sin(half); // gives 1 - cos without cancellation near the start
            auto value = f(panels[i][0] + width * sine * sine);
            for (double& v : value)
                v *= width * pi * sine * std::cos(half);
            return value;
        });
}

} // namespace candelabra::reference
