// SPDX-License-Identifier: Apache-2.0
// Whether measurements of two sets of runs differ by more than runs of the same thing do.
#pragma once

#include <span>
#include <vector>

namespace candelabra::app
{

// One quantity, measured once in each run of A and of B; values > 0.
struct RunQuantity {
    std::vector<double> a, b;
};

// B over A, of geometric means.
struct RunRatio {
    double ratio = 1, low = 0, high = 0;
    double p = 1; // chance of any quantity of this comparison seeming as different if none were

    bool isFaster() const { return high < 1; }
    bool isSlower() const { return low > 1; }
};

// Runs of each side that are needed for an interval: with fewer even runs that do not overlap at
// all are too likely by chance.
constexpr size_t minRuns = 4, minPairedRuns = 6;

// All intervals hold together with 95% confidence, so of twenty comparisons of runs that are alike
// one has an interval without 1, however many quantities it has. A permutation test: runs are dealt
// to A and B in every possible way (of more than 20,000 in 20,000 random ones, always the same),
// and the largest t statistic of all quantities tells what chance makes of them (Westfall and Young
// 1993, single step). Exact for any distribution of noise, as long as it is that of both sides.
// Every quantity has as many values; too few of them: interval [0, infinity]. `paired`: the n-th
// run of A was made beside the n-th of B, which takes out what drifts meanwhile; as many of each.
std::vector<RunRatio> compareRuns(std::span<const RunQuantity> quantities, bool paired);

} // namespace candelabra::app
