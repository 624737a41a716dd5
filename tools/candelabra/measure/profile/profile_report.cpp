// SPDX-License-Identifier: Apache-2.0
// What `candelabra profile` says of the times it took.
#include <algorithm>

#include <fmt/format.h>

#include "io/statistics.h"
#include "io/table.h"
#include "measure/profile/profile_frames.h"

namespace candelabra::app
{
namespace
{

bool hasTime(const std::vector<double>& ms)
{
    return std::any_of(ms.begin(), ms.end(), [](double t) { return t > 0; });
}

std::string percent(double share)
{
    return fmt::format("{:.1f}%", 100 * share);
}

const std::vector<double>* timesOf(const FrameSeries& series, const std::string& pass)
{
    for (const FrameSeries::Pass& p : series.passes)
        if (p.name == pass)
            return &p.ms;
    return nullptr;
}

Json spreadJson(const Spread& s)
{
    return {{"minMs", s.min},
            {"medianMs", s.median},
            {"p95Ms", s.p95},
            {"p99Ms", s.p99},
            {"coefficientOfVariation", s.cv}};
}

// Calls `row(name, a's times, b's times)` for every pass of either and for the whole.
template <typename Row>
void forBoth(const FrameSeries& a, const FrameSeries& b, Row&& row)
{
    const std::vector<double> none(a.gpuMs.size());
    for (const FrameSeries::Pass& pass : a.passes) {
        const std::vector<double>* other = timesOf(b, pass.name);
        row(pass.name, pass.ms, other ? *other : none);
    }
    for (const FrameSeries::Pass& pass : b.passes)
        if (!timesOf(a, pass.name))
            row(pass.name, none, pass.ms);
    for (const WholeTime& whole : wholeTimes)
        if (hasTime(a.*whole.ms) || hasTime(b.*whole.ms))
            row(whole.name, a.*whole.ms, b.*whole.ms);
}

const char* verdict(const PairedRatio& ratio)
{
    return ratio.isFaster() ? "faster" : ratio.isSlower() ? "slower" : "cannot tell";
}

} // namespace

std::string seriesTable(const FrameSeries& series)
{
    Table table({"GPU pass", "min ms", "median ms", "p95 ms", "p99 ms", "variation", "share"});
    const double gpu = medianOf(series.gpuMs);
    const auto add = [&](const std::string& name, const std::vector<double>& ms, bool ofGpu) {
        const Spread s = spreadOf(ms);
        table.add({name, threeDigits(s.min), threeDigits(s.median), threeDigits(s.p95),
                   threeDigits(s.p99), percent(s.cv),
                   ofGpu && gpu > 0 ? percent(s.median / gpu) : ""});
    };
    for (const FrameSeries::Pass& pass : series.passes)
        add(pass.name, pass.ms, true);
    table.rule();
    for (const WholeTime& whole : wholeTimes)
        if (hasTime(series.*whole.ms))
            add(whole.name, series.*whole.ms, false);
    return table.text();
}

std::string overheadText(const FrameSeries& series, double stampMs)
{
    const ProfilingOverhead o = overheadOf(series, stampMs);
    if (!(o.passes > 0))
        return "The device has no timestamps.\n";
    return fmt::format("Passes add up to {} of the time from the frame's first stamp to its last.\n"
                       "Timing takes {} of it: {} stamps of {} ms a frame, left out above.\n",
                       percent(o.passes), percent(o.share), o.stamps, threeDigits(stampMs));
}

std::string comparisonTable(const FrameSeries& a, const FrameSeries& b)
{
    Table table({"GPU pass", "A median ms", "B median ms", "B / A", "95% interval", "B is"});
    forBoth(a, b, [&](const std::string& name, const auto& aMs, const auto& bMs) {
        const PairedRatio r = pairedRatio(aMs, bMs);
        const double aMedian = medianOf(aMs), bMedian = medianOf(bMs);
        const bool both = aMedian > 0 && bMedian > 0;
        table.add({name, threeDigits(aMedian), threeDigits(bMedian),
                   both ? fmt::format("{:.3f}", r.median) : "-",
                   both ? fmt::format("{:.3f} .. {:.3f}", r.low, r.high) : "-",
                   both ? verdict(r) : "-"});
    });
    return table.text();
}

Json toJson(const FrameSeries& series)
{
    Json passes = Json::array();
    for (const FrameSeries::Pass& pass : series.passes) {
        Json one{{"name", pass.name}};
        one.update(spreadJson(spreadOf(pass.ms)));
        passes.push_back(one);
    }
    Json out{{"frames", series.gpuMs.size()}, {"passes", passes}};
    for (const WholeTime& whole : wholeTimes)
        out[whole.key] = spreadJson(spreadOf(series.*whole.ms));
    return out;
}

Json overheadJson(const FrameSeries& series, double stampMs)
{
    const ProfilingOverhead o = overheadOf(series, stampMs);
    return {{"stampMs", stampMs},
            {"stamps", o.stamps},
            {"shareOfGpuSpan", o.share},
            {"passesOverGpuSpan", o.passes},
            {"subtracted", true}};
}

Json comparisonJson(const FrameSeries& a, const FrameSeries& b)
{
    Json out = Json::array();
    forBoth(a, b, [&](const std::string& name, const auto& aMs, const auto& bMs) {
        const PairedRatio r = pairedRatio(aMs, bMs);
        out.push_back({{"name", name},
                       {"aMedianMs", medianOf(aMs)},
                       {"bMedianMs", medianOf(bMs)},
                       {"ratio", r.median},
                       {"low", r.low},
                       {"high", r.high},
                       {"confidence", 0.95},
                       {"verdict", verdict(r)}});
    });
    return out;
}

std::string toCsv(const std::vector<std::string>& names, const std::vector<FrameSeries>& series)
{
    std::vector<std::string> passes;
    for (const FrameSeries& s : series)
        for (const FrameSeries::Pass& pass : s.passes)
            if (std::find(passes.begin(), passes.end(), pass.name) == passes.end())
                passes.push_back(pass.name);
    std::string out = "variant,frame";
    for (const std::string& pass : passes)
        out += "," + pass;
    for (const WholeTime& whole : wholeTimes)
        out += fmt::format(",{}", whole.key);
    out += "\n";
    for (size_t v = 0; v < series.size(); ++v)
        for (size_t i = 0; i < series[v].gpuMs.size(); ++i) {
            out += fmt::format("{},{}", names[v], i);
            for (const std::string& pass : passes) {
                const std::vector<double>* ms = timesOf(series[v], pass);
                out += fmt::format(",{:.6f}", ms ? (*ms)[i] : 0.0);
            }
            for (const WholeTime& whole : wholeTimes)
                out += fmt::format(",{:.6f}", (series[v].*whole.ms)[i]);
            out += "\n";
        }
    return out;
}

} // namespace candelabra::app
