// SPDX-License-Identifier: Apache-2.0
#include "measure/accuracy/kernel_error.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include <fmt/format.h>

#include "candelabra/glm.hpp"
#include "io/table.h"

namespace candelabra::app
{
namespace
{

constexpr double dielectricF0 = 0.04;

struct Error {
    double value;
    size_t sample;
};

ErrorStatistics statistics(std::vector<Error> errors)
{
    ErrorStatistics out{.count = errors.size()};
    if (errors.empty())
        return out;
    std::ranges::sort(errors, {}, &Error::value);
    for (const Error& e : errors)
        out.mean += e.value / double(errors.size());
    const auto rank = [&](double share) { // the nearest rank
        return errors[size_t(std::ceil(share * double(errors.size()))) - 1].value;
    };
    out.p95 = rank(0.95);
    out.p99 = rank(0.99);
    out.max = errors.back().value;
    out.worst = errors.back().sample;
    return out;
}

// A true response, a shader's, or that of a formula.
struct Values {
    double f, a, b;
};
using Quantity = double (*)(const Values&);

double mirrorOf(const Values& r)
{
    return r.a;
}

double dielectricOf(const Values& r)
{
    return dielectricF0 * (r.a - r.b) + r.b;
}

double diffuseOf(const Values& r)
{
    return r.f;
}

template <typename Responses>
std::vector<Values> valuesOf(const Responses& responses)
{
    std::vector<Values> out;
    for (const auto& r : responses)
        out.push_back({double(r.f), double(r.a), double(r.b)});
    return out;
}

std::vector<Values> truthsOf(const SampleSet& set)
{
    std::vector<Values> out;
    for (const LightSample& s : set.samples)
        out.push_back({s.truth.f, s.truth.a, s.truth.b});
    return out;
}

std::vector<double> peaks(const SampleSet& set, Quantity quantity)
{
    std::vector<double> out(set.groups, 0.0);
    for (const LightSample& s : set.samples) {
        const double value = quantity({s.truth.f, s.truth.a, s.truth.b});
        out[s.group] = std::max(out[s.group], value);
    }
    return out;
}

template <typename Response>
bool isValid(const Response& r)
{
    const auto good = [](double x) { return std::isfinite(x) && x >= 0; };
    return good(r.f) && good(r.a) && good(r.b);
}

HorizonStatistics horizonStatistics(const SampleSet& set, std::span<const Values> values,
                                    std::span<const Values> expected, Quantity quantity)
{
    const std::vector<double> peak = peaks(set, quantity);
    std::vector<Error> all, above, crossing;
    for (size_t i = 0; i < set.samples.size(); ++i) {
        const LightSample& s = set.samples[i];
        if (s.horizon == Horizon::Below || !isValid(values[i]) || !(peak[s.group] > 0))
            continue;
        const double difference = quantity(values[i]) - quantity(expected[i]);
        const Error e{std::abs(difference) / peak[s.group], i};
        all.push_back(e);
        (s.horizon == Horizon::Above ? above : crossing).push_back(e);
    }
    return {statistics(std::move(all)), statistics(std::move(above)),
            statistics(std::move(crossing))};
}

LobeStatistics compareLobes(const SampleSet& set, std::span<const Values> values,
                            std::span<const Values> expected)
{
    return {horizonStatistics(set, values, expected, mirrorOf).all,
            horizonStatistics(set, values, expected, dielectricOf).all,
            horizonStatistics(set, values, expected, diffuseOf).all};
}

double scanL1(const SampleSet& set, std::span<const gpu::BenchResponse> responses)
{
    std::vector<double> error(set.groups, 0.0), sum(set.groups, 0.0);
    for (size_t i = 0; i < set.samples.size(); ++i)
        if (set.samples[i].scan && isValid(responses[i])) {
            error[set.samples[i].group] += std::abs(responses[i].a - set.samples[i].truth.a);
            sum[set.samples[i].group] += set.samples[i].truth.a;
        }
    double mean = 0;
    for (uint32_t g = 0; g < set.groups; ++g)
        mean += sum[g] > 0 ? error[g] / sum[g] / set.groups : 0;
    return mean;
}

double groupStandardError(const SampleSet& set, std::span<const gpu::BenchResponse> responses)
{
    const std::vector<double> peak = peaks(set, mirrorOf);
    std::vector<double> sums(set.groups), counts(set.groups);
    for (size_t i = 0; i < set.samples.size(); ++i) {
        const LightSample& s = set.samples[i];
        if (s.horizon == Horizon::Below || !isValid(responses[i]) || !(peak[s.group] > 0))
            continue;
        sums[s.group] += std::abs(double(responses[i].a) - s.truth.a) / peak[s.group];
        counts[s.group] += 1;
    }
    double n = 0, sum = 0, squares = 0;
    for (uint32_t g = 0; g < set.groups; ++g)
        if (counts[g] > 0) {
            const double mean = sums[g] / counts[g];
            n += 1;
            sum += mean;
            squares += mean * mean;
        }
    return n > 1 ? std::sqrt(std::max(squares - sum * sum / n, 0.0) / (n * (n - 1))) : 0;
}

Json toJson(const ErrorStatistics& s)
{
    return {{"samples", s.count},
            {"meanPercent", 100 * s.mean},
            {"p95Percent", 100 * s.p95},
            {"p99Percent", 100 * s.p99},
            {"maxPercent", 100 * s.max}};
}

Json toJson(const HorizonStatistics& s)
{
    return {{"all", toJson(s.all)}, {"above", toJson(s.above)}, {"crossing", toJson(s.crossing)}};
}

Json toJson(const LobeStatistics& s)
{
    return {{"fresnel1", toJson(s.mirror)},
            {"F0_0.04", toJson(s.dielectric)},
            {"formFactor", toJson(s.diffuse)}};
}

} // namespace

KernelError kernelError(const SampleSet& set, std::span<const gpu::BenchResponse> responses,
                        std::span<const formula::Response> inDouble)
{
    const std::vector<Values> values = valuesOf(responses), truths = truthsOf(set);
    KernelError out{.mirror = horizonStatistics(set, values, truths, mirrorOf),
                    .groupStandardError = groupStandardError(set, responses),
                    .dielectric = horizonStatistics(set, values, truths, dielectricOf),
                    .diffuse = horizonStatistics(set, values, truths, diffuseOf),
                    .scanL1 = scanL1(set, responses),
                    .parts = {}};
    if (!inDouble.empty()) {
        const std::vector<Values> formulas = valuesOf(inDouble);
        out.parts = {compareLobes(set, formulas, truths), compareLobes(set, values, formulas)};
    }
    const std::vector<double> peak = peaks(set, mirrorOf);
    for (size_t i = 0; i < set.samples.size(); ++i) {
        out.invalid += !isValid(responses[i]);
        if (set.samples[i].horizon == Horizon::Below && peak[set.samples[i].group] > 0)
            out.leak = std::max(out.leak, double(responses[i].a) / peak[set.samples[i].group]);
    }
    return out;
}

std::string meanP99Max(const ErrorStatistics& s)
{
    return s.count ? fmt::format("{} / {} / {}", threeDigits(100 * s.mean),
                                 threeDigits(100 * s.p99), threeDigits(100 * s.max))
                   : "-";
}

Json toJson(const KernelError& e)
{
    Json out{{"fresnel1", toJson(e.mirror)},
             {"F0_0.04", toJson(e.dielectric)},
             {"formFactor", toJson(e.diffuse)},
             {"scanRelativeL1Percent", 100 * e.scanL1},
             {"leakFromBelowPercent", 100 * e.leak},
             {"invalid", e.invalid},
             {"groupStandardErrorPercent", 100 * e.groupStandardError}};
    if (e.parts) {
        out["formulaAgainstTruth"] = toJson(e.parts->formula);
        out["float32AgainstFormula"] = toJson(e.parts->float32);
    }
    return out;
}

std::string describeSample(const SampleSet& set, size_t i)
{
    const CndLight& light = set.lights[i];
    const gpu::BenchReceiver& r = set.receivers[i];
    const bool distant = cndIsDistant(light.type);
    const glm::dvec3 to =
        distant ? -glm::dvec3(toGlm(light.direction)) : glm::dvec3(toGlm(light.position));
    constexpr double degrees = 180 / std::numbers::pi;
    const double distance = glm::length(to);
    const double s = std::min(double(light.radius) / distance, 1.0);
    const glm::dvec3 mirrored(-r.v.x, -r.v.y, r.v.z);
    return fmt::format("alpha {:.4f}, view {:.1f} deg, light {:.1f} deg from the normal and {:.1f} "
                       "from the mirror "
                       "direction, half angle {:.2f} deg",
                       set.alphaOf(i), std::acos(std::clamp(double(r.v.z), -1.0, 1.0)) * degrees,
                       std::acos(std::clamp(to.z / distance, -1.0, 1.0)) * degrees,
                       std::acos(std::clamp(glm::dot(to / distance, mirrored), -1.0, 1.0)) *
                           degrees,
                       std::asin(s) * degrees);
}

} // namespace candelabra::app
