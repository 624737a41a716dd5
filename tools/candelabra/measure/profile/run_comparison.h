// SPDX-License-Identifier: Apache-2.0
// Compares the measurements of two sets of runs, A and B: do they differ by more than repeated runs
// of the same program do?
#pragma once

#include <limits>
#include <span>
#include <vector>

namespace candelabra::app
{

// One quantity, such as the time of a pass, measured once in each run of A and of B. Values are >
// 0.
struct RunQuantity {
    std::vector<double> a, b;
};

// The ratio of B to A, of the geometric means over runs, with its confidence interval.
struct RunRatio {
    double ratio = 1, low = 0, high = 0;
    // If A and B did not differ: the probability that any quantity of the comparison seems to
    // differ as much as this one does.
    double p = 1;

    bool isFaster() const { return high < 1; }
    bool isSlower() const { return low > 1; }
};

// The least number of runs of each side for which there is an interval. With fewer, it is too
// likely by chance that the values of A and B do not overlap at all.
constexpr size_t minRuns = 4, minPairedRuns = 6;

// Compares every quantity. All intervals hold together with 95% confidence: of twenty comparisons
// of runs that are alike, one has an interval without 1, however many quantities are compared.
//
// The method is a permutation test. The runs are dealt to A and B in every possible way (with
// `paired`, the two runs of each pair go to different sides) or, if there are more than 20,000, in
// 20,000 random ways, which are always the same. The distribution of
// the largest t statistic of all quantities then shows what chance alone can do (Westfall and Young
// 1993, single step). The test is exact for any distribution of noise that is the same for A and B.
//
// All quantities must have the same numbers of values. With fewer runs than needed, the intervals
// are [0, infinity]. `paired` says that the n-th run of A was made beside the n-th run of B, which
// removes drift from the comparison; A and B must then have the same number of runs.
std::vector<RunRatio> compareRuns(std::span<const RunQuantity> quantities, bool paired);

// Whether B takes longer than A by more than a bound.
enum class Slower { No, Yes, CannotTell };

struct RunDecision {
    Slower slower = Slower::CannotTell;
    RunRatio ratio; // `p` is the probability if the ratio were at the bound
    // The smallest ratio that would be called slower if the times of B all changed by one factor.
    double smallestSeen = std::numeric_limits<double>::infinity();
};

// Decides about one quantity alone: is the ratio of B to A above 1 + `bound`? Yes if its interval
// with 95% confidence is above, No if the interval does not reach higher, else CannotTell. The test
// is that of compareRuns at the bound: it compares B with A times 1 + `bound`. If the true ratio is
// exactly at the bound, Yes and No are each given in one of forty comparisons. If it is lower, Yes
// is rarer, and if it is higher, No is.
RunDecision decideRuns(const RunQuantity& quantity, bool paired, double bound);

} // namespace candelabra::app
