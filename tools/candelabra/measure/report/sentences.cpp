// SPDX-License-Identifier: Apache-2.0
#include "measure/report/sentences.h"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <utility>

#include <fmt/format.h>

#include "render/vulkan_instance.h"
#include "scene/light_types.h"

namespace candelabra::app
{
namespace
{

std::string times(double ratio)
{
    return ratio >= 10 ? fmt::format("{:.0f}", ratio) : fmt::format("{:.2f}", ratio);
}

// The median with its interval, or what is missing for one.
std::string bracketed(const MedianInterval& v)
{
    if (!v.isKnown())
        return fmt::format("{} [too few repeats for an interval]", times(v.median));
    return fmt::format("{} [{}, {}]", times(v.median), times(v.low), times(v.high));
}

// Returns a word for the engine beside another way that takes `ratio` times as long.
std::string verdictWord(const PairedRatio& ratio)
{
    if (!ratio.isFaster() && !ratio.isSlower())
        return "not measurably different from it";
    return ratio.isSlower() ? "faster than it" : "slower than it";
}

bool hasInterval(const CullingPoint& p, const std::string& other)
{
    return p.toEngine(other).isKnown();
}

// The configuration with the most lights in which brute force was drawn, with an interval if any.
const CullingPoint* brutePoint(const std::vector<CullingPoint>& points)
{
    const CullingPoint* out = nullptr;
    for (const CullingPoint& p : points) {
        if (!p.of(bruteName).times.frames())
            continue;
        const auto rank = [](const CullingPoint& q) {
            return std::pair(hasInterval(q, bruteName), q.lights);
        };
        if (!out || rank(p) > rank(*out))
            out = &p;
    }
    return out;
}

const KernelPoint* find(const KernelLevel& level, uint32_t type, const MeasuredMethod& method)
{
    for (const KernelPoint& p : level.points)
        if (p.lightType == type && p.method == method)
            return &p;
    return nullptr;
}

// Returns the cell of the table of errors: the mean over all directions, with the margin within
// which it lies with 95% confidence if the means of groups of similar samples are normally
// distributed.
std::string meanPercent(const KernelError& error)
{
    const std::vector<double>& means = error.groupMeans;
    const double n = double(means.size());
    const double mean = std::accumulate(means.begin(), means.end(), 0.0) / std::max(n, 1.0);
    double squares = 0;
    for (const double x : means)
        squares += (x - mean) * (x - mean);
    std::string out = threeDigits(100 * error.mirror.all.mean) + "%";
    if (means.size() > 1)
        out += fmt::format(" \u00b1 {}", threeDigits(196 * std::sqrt(squares / (n * (n - 1)))));
    return out;
}

// Returns how many times as large the mean errors of a method are as those of conic, for the light
// types for which both were measured: "24.8 to 71.2". Returns nothing if there is none.
std::string timesTheError(const KernelLevel& level, const MeasuredMethod& method)
{
    double least = INFINITY, most = 0;
    for (const KernelPoint& own : level.points) {
        const KernelPoint* other = find(level, own.lightType, method);
        if (own.method != CND_SPECULAR_CONIC || !other || own.error.mirror.all.mean <= 0)
            continue;
        const double times = other->error.mirror.all.mean / own.error.mirror.all.mean;
        least = std::min(least, times);
        most = std::max(most, times);
    }
    if (most <= 0)
        return "";
    const std::string from = threeDigits(least), to = threeDigits(most);
    return from == to ? to : from + " to " + to;
}

// The FLIP of every scene that was drawn with a method, in the order of the scenes.
std::vector<double> flipsOf(const std::vector<ImageScene>& scenes, const MeasuredMethod& method)
{
    std::vector<double> out;
    for (const ImageScene& scene : scenes)
        for (const ImagePoint& p : scene.points)
            if (p.method == method)
                out.push_back(p.error.flip);
    return out;
}

// The driver without a text in brackets that the name of the device has too.
std::string driverText(const DeviceInfo& device)
{
    const size_t bracket = device.driver.find(" (");
    if (bracket == std::string::npos || !device.driver.ends_with(")"))
        return device.driver;
    const std::string inside =
        device.driver.substr(bracket + 2, device.driver.size() - bracket - 3);
    return device.name.find(inside) == std::string::npos ? device.driver
                                                         : device.driver.substr(0, bracket);
}

} // namespace

double largestShare(uint64_t invalid, uint64_t tried)
{
    if (!tried)
        return 1;
    // The mean at which at most `invalid` events have a probability of 5%.
    double low = double(invalid), high = double(invalid) + 10 + 4 * std::sqrt(double(invalid));
    for (int step = 0; step < 60; ++step) {
        const double mean = (low + high) / 2;
        double logarithm = -mean, sum = 0;
        for (uint64_t k = 0; k <= invalid; ++k) {
            sum += std::exp(logarithm);
            logarithm += std::log(mean / double(k + 1));
        }
        (sum > 0.05 ? low : high) = mean;
    }
    return std::min(high / double(tried), 1.0);
}

std::string runSentence(const RunFacts& f)
{
    const bool cpu = f.device.type == VK_PHYSICAL_DEVICE_TYPE_CPU;
    return fmt::format(
        "Device: Candelabra {} (commit {}) was measured on {}{} with the driver {}; {}{} took "
        "{:.0f} s by the clock and {:.0f} s of processor time, and square brackets hold 95% "
        "confidence intervals of medians over repeats.",
        f.version, f.commit, cpu ? "a CPU and no GPU, " : "",
        cpu ? f.device.name : fmt::format("{} ({})", f.device.name, deviceTypeName(f.device.type)),
        driverText(f.device),
        cpu ? "errors are the same on any device up to rounding, ratios of times hint at what a "
              "GPU would show, and times in milliseconds do not; "
            : "",
        counted(f.parts, "part"), f.wallSeconds, f.processorSeconds);
}

std::string speedSentence(const std::vector<CullingPoint>& points)
{
    if (points.empty())
        return "Speed: the part \"culling\" was not measured in this run.";
    std::string out = "Speed: ";
    if (const CullingPoint* p = brutePoint(points)) {
        const PairedRatio r = p->toEngine(bruteName);
        const Spread s = spreadOf(p->of(engineName).times.totals());
        out +=
            fmt::format("to light one frame ({}) takes {} ms (half of the frames: {} to {}), and "
                        "brute force takes {} times as long{}; ",
                        p->title(), threeDigits(s.median), threeDigits(s.lowerQuartile),
                        threeDigits(s.upperQuartile), bracketed(r),
                        r.isKnown() ? ", so Candelabra is " + verdictWord(r) : "");
    } else {
        out += "brute force took too long to be drawn; ";
    }
    size_t faster = 0, slower = 0;
    for (const CullingPoint& p : points) {
        const PairedRatio r = p.toEngine(p.bestBaseline().name);
        faster += r.isSlower();
        slower += r.isKnown() && r.isFaster();
    }
    const CullingPoint& most = *std::max_element(
        points.begin(), points.end(),
        [](const CullingPoint& a, const CullingPoint& b) { return a.lights < b.lights; });
    const PairedRatio r = most.toEngine(most.bestBaseline().name);
    return out +
           fmt::format("against the best other way of culling it is faster in {} of {}, slower in "
                       "{} and not measurably different in {}, and with the most lights ({}) that "
                       "way ({}) takes {} times as long.",
                       faster, counted(points.size(), "configuration"), slower,
                       points.size() - faster - slower, most.title(), most.bestBaseline().name,
                       bracketed(r));
}

std::string accuracySentence(const KernelLevel& level, const std::vector<ImageScene>& scenes)
{
    std::string types;
    for (uint32_t type = 0; type < CND_LIGHT_TYPE_COUNT; ++type)
        if (const KernelPoint* own = find(level, type, CND_SPECULAR_CONIC))
            types += fmt::format("{}{} {}", types.empty() ? "" : ", ",
                                 lightTypeName(CndLightType(type)), meanPercent(own->error));
    if (types.empty())
        return "Accuracy: the part \"accuracy\" was not measured in this run.";
    std::string out = "Accuracy: the mean error of the formula (conic) against the truth, in "
                      "percent of the brightest reflection of such a light, is by the shape of the "
                      "light: " +
                      types;
    const std::pair<const char*, MeasuredMethod> others[] = {{"LTC", Rival::Ltc},
                                                             {"karis", CND_SPECULAR_KARIS}};
    for (const auto& [name, method] : others)
        if (const std::string times = timesTheError(level, method); !times.empty())
            out += fmt::format("; that of {} is {} times as large", name, times);
    const std::vector<double> conic = flipsOf(scenes, CND_SPECULAR_CONIC);
    if (conic.empty())
        return out + ".";
    const auto [low, high] = std::minmax_element(conic.begin(), conic.end());
    out += fmt::format("; in {} of whole images the visible difference to the truth (FLIP) is "
                       "{:.4f} to {:.4f}",
                       counted(conic.size(), "scene"), *low, *high);
    for (const auto& [name, method] : others)
        if (const std::vector<double> flips = flipsOf(scenes, method); !flips.empty()) {
            const auto [least, most] = std::minmax_element(flips.begin(), flips.end());
            out += fmt::format(", with {} {:.4f} to {:.4f}", name, *least, *most);
        }
    return out + ".";
}

std::string stabilitySentence(const Stability& s)
{
    if (!s.tried())
        return "Stability: the part \"stability\" was not measured in this run.";
    std::string out = fmt::format(
        "Stability: of {} random and adversarial inputs {} gave a response that is no number, "
        "infinite, negative or impossibly bright (if all were random, that would be at most {} in "
        "a million with 95% confidence)",
        grouped(s.tried()), s.invalid() ? grouped(s.invalid()) : "none",
        threeDigits(1e6 * largestShare(s.invalid(), s.tried())));
    const QuadratureCheck* worst = nullptr;
    const auto size = [](const QuadratureCheck& q) { return std::isnan(q.max) ? INFINITY : q.max; };
    for (const QuadratureCheck& q : s.quadrature)
        if (q.bar > 0 && (!worst || size(q) > size(*worst)))
            worst = &q;
    if (worst)
        out += fmt::format(
            "; on hard inputs the formulas differ from quadrature by at most {}% of the "
            "response on the mirror axis ({}), which {} the limit of {}%",
            threeDigits(100 * worst->max), lightTypeName(worst->evaluation.lightType),
            worst->max <= worst->bar ? "is within" : "EXCEEDS", threeDigits(100 * worst->bar));
    double jump = 0;
    for (const ContinuityCheck& c : s.continuity)
        jump = std::max(jump, c.jump);
    if (!s.continuity.empty())
        out +=
            fmt::format("; between neighbouring inputs the light jumps by at most {}% of its peak",
                        threeDigits(100 * jump));
    return out + ".";
}

} // namespace candelabra::app
