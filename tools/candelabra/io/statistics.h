// SPDX-License-Identifier: Apache-2.0
// What can be said of repeated measurements on a machine that does other things too.
#pragma once

#include <span>
#include <vector>

namespace candelabra::app
{

struct Spread {
    double min = 0, median = 0;
    double p95 = 0, p99 = 0; // nearest rank: the smallest value that so many do not exceed
    double cv = 0; // coefficient of variation: standard deviation over mean; 0 for one value
};

// Of both: `values` may not be empty.
double medianOf(std::vector<double> values);
Spread spreadOf(std::vector<double> values);

// Of paired measurements: median of b / a, and an interval that holds the true median with at least
// 95% confidence, whatever the distribution (order statistics; Conover 1999, section 3.2).
struct PairedRatio {
    double median = 0, low = 0, high = 0;

    bool isFaster() const { return high < 1; }
    bool isSlower() const { return low > 1; }
};

// Pairs that are needed for an interval at all.
constexpr size_t minPairs = 6;

// As many of each, at least minPairs; pairs with an `a` of 0 say nothing and are left out, and with
// fewer than minPairs left the interval is [0, infinity].
PairedRatio pairedRatio(std::span<const double> a, std::span<const double> b);

} // namespace candelabra::app
