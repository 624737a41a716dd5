// SPDX-License-Identifier: Apache-2.0
#include "render/pass_times.h"

#include <algorithm>
#include <functional>

#include "io/statistics.h"

namespace candelabra::app
{
namespace
{

PassSummary summarise(const std::string& name, std::vector<double> ms)
{
    if (ms.empty())
        return {.name = name};
    const Spread s = spreadOf(std::move(ms));
    return {.name = name, .minMs = s.min, .medianMs = s.median, .p95Ms = s.p95};
}

} // namespace

std::string passName(const char* kernelName)
{
    std::string name = kernelName;
    return name.ends_with(".comp") ? name.substr(0, name.size() - 5) : name;
}

std::vector<PassTime> passesOf(std::span<const CndKernelTime> times, FramePart part)
{
    std::vector<PassTime> out;
    for (const CndKernelTime& time : times)
        out.push_back({.name = passName(time.name), .ms = time.ms, .part = part});
    return out;
}

void PassTimes::add(std::span<const PassTime> frame)
{
    double total = 0;
    for (Pass& pass : passes_)
        pass.ms.push_back(0);
    for (const PassTime& time : frame) {
        auto pass = std::ranges::find(passes_, time.name, &Pass::name);
        if (pass == passes_.end()) {
            passes_.push_back({time.name, time.part, std::vector<double>(totals_.size() + 1)});
            pass = passes_.end() - 1;
        }
        pass->ms.back() += time.ms;
        total += time.ms;
    }
    totals_.push_back(total);
}

std::vector<PassSummary> PassTimes::summary() const
{
    std::vector<PassSummary> out;
    for (const Pass& pass : passes_)
        out.push_back(summarise(pass.name, pass.ms));
    return out;
}

PassSummary PassTimes::total() const
{
    return summarise("total", totals_);
}

double PassTimes::medianMs(FramePart part) const
{
    std::vector<double> sums(totals_.size());
    for (const Pass& pass : passes_)
        if (pass.part == part)
            std::ranges::transform(sums, pass.ms, sums.begin(), std::plus<>());
    return sums.empty() ? 0 : medianOf(std::move(sums));
}

} // namespace candelabra::app
