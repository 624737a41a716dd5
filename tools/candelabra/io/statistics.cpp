// SPDX-License-Identifier: Apache-2.0
#include "io/statistics.h"

#include <algorithm>
#include <cmath>
#include <functional>
#include <numeric>

namespace candelabra::app
{
namespace
{

double middleOf(const std::vector<double>& sorted)
{
    const size_t n = sorted.size();
    return n % 2 ? sorted[n / 2] : (sorted[n / 2 - 1] + sorted[n / 2]) / 2;
}

double nearestRank(const std::vector<double>& sorted, double share)
{
    const size_t at = size_t(std::ceil(share * double(sorted.size())));
    return sorted[std::max<size_t>(at, 1) - 1];
}

// The largest k such that fewer than k of n values lie below the true median with a probability of
// at most 2.5%; 0 if there is none.
size_t intervalRank(size_t n)
{
    double probability = std::pow(0.5, double(n)), below = 0;
    for (size_t k = 0; k < n; ++k) {
        below += probability;
        if (below > 0.025)
            return k;
        probability *= double(n - k) / double(k + 1);
    }
    return 0;
}

} // namespace

double medianOf(std::vector<double> values)
{
    std::ranges::sort(values);
    return middleOf(values);
}

Spread spreadOf(std::vector<double> values)
{
    std::ranges::sort(values);
    const double n = double(values.size());
    const double mean = std::accumulate(values.begin(), values.end(), 0.0) / n;
    double squares = 0;
    for (const double value : values)
        squares += (value - mean) * (value - mean);
    const double deviation = n > 1 ? std::sqrt(squares / (n - 1)) : 0;
    return {.min = values.front(),
            .median = middleOf(values),
            .lowerQuartile = nearestRank(values, 0.25),
            .upperQuartile = nearestRank(values, 0.75),
            .p95 = nearestRank(values, 0.95),
            .p99 = nearestRank(values, 0.99),
            .cv = mean > 0 ? deviation / mean : 0};
}

std::optional<double> medianAboveNoise(const std::vector<double>& values)
{
    const Spread s = spreadOf(values);
    return s.lowerQuartile > 0 ? std::optional(s.median) : std::nullopt;
}

std::vector<double> differences(std::span<const double> a, std::span<const double> b)
{
    std::vector<double> out(a.size());
    std::ranges::transform(a, b, out.begin(), std::minus<>());
    return out;
}

bool isNoisy(const std::vector<double>& values)
{
    if (values.size() < 2)
        return false;
    const Spread s = spreadOf(values);
    return s.upperQuartile - s.lowerQuartile > noisyShare * s.median;
}

PairedRatio pairedRatio(std::span<const double> a, std::span<const double> b)
{
    std::vector<double> ratios;
    for (size_t i = 0; i < a.size(); ++i)
        if (a[i] > 0)
            ratios.push_back(b[i] / a[i]);
    if (ratios.empty())
        return {1, 0, std::numeric_limits<double>::infinity()};
    std::ranges::sort(ratios);
    // For more than 1,000 values 0.5^n may underflow; the binomial distribution of the rank is then
    // close to a normal one.
    const size_t n = ratios.size();
    const size_t k = n <= 1000 ? intervalRank(n)
                               : size_t(double(n) / 2 - 0.98 * std::sqrt(double(n))); // 1.96 / 2
    if (n < minPairs || !k)
        return {middleOf(ratios), 0, std::numeric_limits<double>::infinity()};
    return {middleOf(ratios), ratios[k - 1], ratios[n - k]};
}

} // namespace candelabra::app
