// SPDX-License-Identifier: Apache-2.0
#include "measure/light_search.h"

#include <algorithm>
#include <cmath>
#include <map>

namespace candelabra::app
{
namespace
{

// The time that the next number aims at, as a share of the time that a frame may take.
constexpr double aimedShare = (1 + filledShare) / 2;
// How much more and fewer lights are tried until some are too slow, and others are fast enough.
constexpr uint32_t growth = 4, shrinkage = 32;
constexpr double finest = 1.01; // the smallest ratio of two numbers that is worth a measurement

struct Bracket {
    std::optional<LightTime> fast, slow; // neighbours
};

// The largest number that is fast enough divides the others, because a time may be too long by
// chance, but hardly too short.
Bracket bracketOf(std::span<const LightTime> tried, double ms)
{
    Bracket out;
    for (const LightTime& t : tried) {
        if (t.ms <= ms) {
            out.fast = t;
            out.slow.reset();
        } else if (!out.slow) {
            out.slow = t;
        }
    }
    return out;
}

// Interpolates between the logarithms.
double between(const LightTime& a, const LightTime& b, double ms)
{
    const double part = std::log(ms / a.ms) / std::log(b.ms / a.ms);
    return a.lights * std::pow(double(b.lights) / a.lights, part);
}

class Search
{
public:
    explicit Search(const LightSearchRange& range) : range_(range) {}

    std::span<const LightTime> tried() const { return tried_; }
    // The number to measure next, if any.
    std::optional<uint32_t> next() const
    {
        const auto [fast, slow] = bracketOf(tried_, range_.ms);
        if (tried_.empty())
            return range_.start;
        if (slow && isDoubtful(fast, *slow))
            return slow->lights;
        if (!slow)
            return other(std::min(uint64_t(growth) * fast->lights, uint64_t(range_.most)));
        if (!fast)
            return other(impossible_ ? uint32_t(std::sqrt(double(impossible_) * slow->lights))
                                     : std::max(slow->lights / shrinkage, 1u));
        if (fast->ms >= filledShare * range_.ms)
            return {};
        return inside(*fast, *slow);
    }
    void add(uint32_t lights, std::optional<double> ms)
    {
        if (!ms) {
            impossible_ = lights;
            return;
        }
        ++measured_[lights];
        const auto at = std::ranges::lower_bound(tried_, lights, {}, &LightTime::lights);
        if (at != tried_.end() && at->lights == lights) {
            at->ms = std::min(at->ms, *ms);
        } else {
            tried_.insert(at, {lights, *ms});
        }
        const bool fast = *ms <= range_.ms;
        sameSide_ = fast == lastFast_ ? sameSide_ + 1 : 1;
        lastFast_ = fast;
    }

private:
    // A time that is too long was perhaps disturbed, unless it is far too long, or close to a
    // shorter one that it agrees with: time grows by no more than the number of lights. Such a
    // number is measured again once, because it ends the search for larger ones, and a second time
    // if the disturbance lasted so long that it disagrees with later measurements.
    bool isDoubtful(const std::optional<LightTime>& fast, const LightTime& slow) const
    {
        const uint32_t times = measured_.at(slow.lights);
        if (slow.ms > 2 * range_.ms)
            return false;
        if (!fast)
            return slow.lights == 1 && times < 2;
        const double step = double(slow.lights) / fast->lights;
        return step > 2 ? times < 2 : slow.ms / fast->ms > step && times < 3;
    }
    // Returns `lights` unless it was tried.
    std::optional<uint32_t> other(uint64_t lights) const
    {
        const bool known =
            lights <= impossible_ || std::ranges::count(tried_, lights, &LightTime::lights);
        return known ? std::nullopt : std::optional(uint32_t(lights));
    }
    // A round number between two others, if they are not nearly the same.
    std::optional<uint32_t> inside(const LightTime& fast, const LightTime& slow) const
    {
        const double least = std::max(finest * fast.lights, fast.lights + 1.0);
        if (least >= slow.lights)
            return {};
        // If only one end of the bracket moves, halving is faster than interpolation.
        const double wanted = sameSide_ > 2 ? std::sqrt(double(fast.lights) * slow.lights)
                                            : between(fast, slow, aimedShare * range_.ms);
        for (int digits = 2; digits <= 9; ++digits)
            if (const uint32_t n = roundedDown(std::max(wanted, least), digits);
                n > fast.lights && n < slow.lights)
                return n;
        return {};
    }

    LightSearchRange range_;
    std::vector<LightTime> tried_;          // ascending
    std::map<uint32_t, uint32_t> measured_; // how often, by lights
    uint32_t impossible_ = 0;               // no scene has so few lights
    bool lastFast_ = false;
    int sameSide_ = 0; // how many measurements in a row were all fast enough, or all too slow
};

} // namespace

uint32_t roundedDown(double value, int digits)
{
    if (value < 1)
        return 0;
    const double unit = std::pow(10.0, std::max(std::floor(std::log10(value)) - digits + 1, 0.0));
    return uint32_t(std::floor(value / unit * (1 + 1e-12)) * unit);
}

LightSearch searchLights(const LightSearchRange& range,
                         const std::function<std::optional<double>(uint32_t)>& msOf)
{
    Search search(range);
    for (uint32_t i = 0; i < maxSearched; ++i) {
        const std::optional<uint32_t> lights = search.next();
        if (!lights)
            break;
        search.add(*lights, msOf(*lights));
    }
    LightSearch out{.tried = {search.tried().begin(), search.tried().end()}};
    if (const auto fast = bracketOf(out.tried, range.ms).fast) {
        out.lights = fast->lights;
        out.isMost = fast->lights == range.most;
    }
    return out;
}

std::optional<uint32_t> lightsWithin(std::span<const LightTime> tried, double ms)
{
    const auto [fast, slow] = bracketOf(tried, ms);
    if (!fast || !slow)
        return {};
    return uint32_t(between(*fast, *slow, ms));
}

} // namespace candelabra::app
