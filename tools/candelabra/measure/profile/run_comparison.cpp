// SPDX-License-Identifier: Apache-2.0
#include "measure/profile/run_comparison.h"

#include <algorithm>
#include <cmath>
#include <functional>
#include <random>

namespace candelabra::app
{
namespace
{

constexpr double infinity = std::numeric_limits<double>::infinity();
constexpr size_t mostDeals = 20'000;

struct Effect {
    double mean = 0;  // mean logarithm of the ratio of B to A
    double error = 0; // standard error of `mean`

    double t() const
    {
        if (mean == 0)
            return 0;
        return error > 0 ? std::abs(mean) / error : infinity;
    }
};

struct Sums {
    double n = 0, sum = 0, squares = 0;

    void add(double x)
    {
        ++n;
        sum += x;
        squares += x * x;
    }
    double mean() const { return sum / n; }
    // The sum of squared deviations from the mean; rounding does not make it negative.
    double deviations() const { return std::max(squares - sum * sum / n, 0.0); }
};

// One way to deal the runs to A and B. Unpaired, element i says whether run i of all goes to B.
// Paired, it says whether the two runs of pair i change sides.
using Deal = std::vector<char>;

// `values` holds logarithms: unpaired of the values of all runs, paired of the ratios of the pairs.
Effect effectOf(const std::vector<double>& values, const Deal& deal, bool paired)
{
    Sums a, b;
    for (size_t i = 0; i < values.size(); ++i)
        if (paired)
            b.add(deal[i] ? -values[i] : values[i]);
        else
            (deal[i] ? b : a).add(values[i]);
    if (paired)
        return {b.mean(), std::sqrt(b.deviations() / (b.n - 1) / b.n)};
    const double variance = (a.deviations() + b.deviations()) / (a.n + b.n - 2);
    return {b.mean() - a.mean(), std::sqrt(variance * (1 / a.n + 1 / b.n))};
}

// The number of different deals, at most mostDeals + 1. Unpaired, `a` and `b` are the numbers of
// runs; paired, `b` is the number of pairs.
size_t dealCount(size_t a, size_t b, bool paired)
{
    double count = 1;
    for (size_t i = 1; i <= b && count <= mostDeals; ++i)
        count *= paired ? 2 : double(a + i) / double(i);
    return size_t(std::min(count + 0.5, double(mostDeals) + 1));
}

// Calls `use` with every deal or, if there are too many, with `real` and random ones.
void forDeals(const Deal& real, bool paired, size_t a, const std::function<void(const Deal&)>& use)
{
    Deal deal = real;
    const size_t n = deal.size();
    if (dealCount(a, paired ? n : n - a, paired) <= mostDeals) {
        if (paired)
            for (uint32_t bits = 0; bits < 1u << n; ++bits) {
                for (size_t i = 0; i < n; ++i)
                    deal[i] = char(bits >> i & 1);
                use(deal);
            }
        else
            do
                use(deal);
            while (
                std::next_permutation(deal.begin(), deal.end())); // `real` is sorted: the first one
        return;
    }
    std::mt19937_64 random(1);
    use(deal);
    for (size_t k = 1; k < mostDeals; ++k) {
        // std::shuffle would give different deals with different standard libraries.
        for (size_t i = n; i-- > 1;)
            std::swap(deal[i], deal[size_t(random() % (i + 1))]);
        if (paired)
            for (size_t i = 0; i < n; ++i)
                deal[i] = char(random() & 1);
        use(deal);
    }
}

} // namespace

std::vector<RunRatio> compareRuns(std::span<const RunQuantity> quantities, bool paired)
{
    if (quantities.empty())
        return {};
    const size_t countA = quantities[0].a.size(), countB = quantities[0].b.size();
    std::vector<std::vector<double>> values;
    for (const RunQuantity& q : quantities) {
        std::vector<double>& v = values.emplace_back();
        for (size_t i = 0; i < countA; ++i)
            v.push_back(paired ? std::log(q.b[i] / q.a[i]) : std::log(q.a[i]));
        for (size_t i = 0; i < countB && !paired; ++i)
            v.push_back(std::log(q.b[i]));
    }
    Deal real(values[0].size());
    if (!paired)
        std::fill(real.begin() + std::ptrdiff_t(countA), real.end(), 1);
    const bool enough = paired ? countA >= minPairedRuns : std::min(countA, countB) >= minRuns;

    std::vector<double> largest;
    if (enough)
        forDeals(real, paired, countA, [&](const Deal& deal) {
            double most = 0;
            for (const std::vector<double>& v : values)
                most = std::max(most, effectOf(v, deal, paired).t());
            largest.push_back(most);
        });
    std::ranges::sort(largest, std::greater<>());
    // At most one deal of twenty exceeds this t statistic.
    const double limit = enough ? largest[largest.size() / 20] : infinity;

    std::vector<RunRatio> out;
    for (size_t i = 0; i < values.size(); ++i) {
        const Effect effect = effectOf(values[i], real, paired);
        // A deal with the same sums, but added in another order, must not count as less different.
        constexpr double rounding = 1e-9;
        const double t = effect.t() * (1 - rounding);
        const auto asLarge = std::ranges::find_if(largest, [&](double other) { return other < t; });
        const double half = !enough            ? infinity
                            : effect.error > 0 ? limit * effect.error * (1 + rounding)
                                               : 0;
        out.push_back(
            {.ratio = std::exp(effect.mean),
             .low = std::exp(effect.mean - half),
             .high = std::exp(effect.mean + half),
             .p = enough ? double(asLarge - largest.begin()) / double(largest.size()) : 1});
    }
    return out;
}

namespace
{

// Returns the quantity with the values of one side multiplied.
RunQuantity scaled(RunQuantity quantity, std::vector<double> RunQuantity::*side, double factor)
{
    for (double& x : quantity.*side)
        x *= factor;
    return quantity;
}

// Returns the smallest ratio that would be called slower if only the values of B all changed by the
// same factor. `now` is the ratio of the quantity. Bisects, because the limit of the test depends
// on the ratio too.
double smallestSlower(const RunQuantity& quantity, bool paired, const RunRatio& now)
{
    const auto isSlower = [&](double ratio) {
        const RunQuantity changed = scaled(quantity, &RunQuantity::b, ratio / now.ratio);
        return compareRuns({&changed, 1}, paired)[0].isSlower();
    };
    double low = 1, high = now.high / now.ratio;
    if (high <= low || std::isinf(high))
        return high;
    while (!isSlower(high))
        high *= high;
    for (int step = 0; step < 20; ++step) {
        const double middle = std::sqrt(low * high);
        (isSlower(middle) ? high : low) = middle;
    }
    return high;
}

} // namespace

RunDecision decideRuns(const RunQuantity& quantity, bool paired, double bound)
{
    const RunQuantity atBound = scaled(quantity, &RunQuantity::a, 1 + bound);
    RunDecision out{.ratio = compareRuns({&atBound, 1}, paired)[0]};
    RunRatio& r = out.ratio;
    out.slower = r.isSlower() ? Slower::Yes : r.high <= 1 ? Slower::No : Slower::CannotTell;
    out.smallestSeen = (1 + bound) * smallestSlower(atBound, paired, r);
    for (double* x : {&r.ratio, &r.low, &r.high})
        *x *= 1 + bound;
    return out;
}

} // namespace candelabra::app
