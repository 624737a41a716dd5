// SPDX-License-Identifier: Apache-2.0
// Statistics of repeated measurements on a machine that does other things as well. GSL, which has
// medians and percentiles, is not used: its licence, the GPL, would become that of the program.
#pragma once

#include <limits>
#include <optional>
#include <span>
#include <vector>

namespace candelabra::app
{

struct Spread {
    double min = 0, median = 0;
    double lowerQuartile = 0, upperQuartile = 0; // by nearest rank
    // Percentiles by nearest rank: the smallest value that 95% or 99% of the values do not exceed.
    double p95 = 0, p99 = 0;
    double cv = 0; // coefficient of variation: standard deviation over mean; 0 for one value
};

// `values` must not be empty.
double medianOf(std::vector<double> values);
Spread spreadOf(std::vector<double> values);

// Returns the median of times that were measured as differences, unless a quarter of them or more
// are not positive: then the time is below the noise. `values` must not be empty.
std::optional<double> medianAboveNoise(const std::vector<double>& values);
// a - b, element by element. Both must have the same number of values.
std::vector<double> differences(std::span<const double> a, std::span<const double> b);

// Measurements are called noisy if the middle half of them, from the lower to the upper quartile,
// spans more than this share of their median.
constexpr double noisyShare = 0.05;
bool isNoisy(const std::vector<double>& values);

// The median of the ratios b / a of paired measurements, and an interval that holds the true median
// with at least 95% confidence, whatever the distribution (order statistics; Conover 1999, section
// 3.2). The interval is [0, infinity] if there are fewer than minPairs values.
struct PairedRatio {
    double median = 0, low = 0, high = 0;

    bool isKnown() const { return low > 0 || high < std::numeric_limits<double>::infinity(); }
    bool isFaster() const { return high < 1; }
    bool isSlower() const { return low > 1; }
};

// The least number of values for which there is an interval.
constexpr size_t minPairs = 6;

// `a` and `b` must have the same number of values. Pairs with an `a` of 0 are left out. With fewer
// than minPairs left, the interval is [0, infinity].
PairedRatio pairedRatio(std::span<const double> a, std::span<const double> b);

} // namespace candelabra::app
