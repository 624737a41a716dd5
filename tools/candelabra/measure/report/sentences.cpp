// SPDX-License-Identifier: Apache-2.0
#include "measure/report/sentences.h"

#include <algorithm>
#include <cmath>

#include <fmt/format.h>

#include "render/vulkan_instance.h"
#include "scene/light_types.h"
#include "shading/light_family.h"

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

std::string percentBracketed(const std::vector<double>& shares)
{
    const MedianInterval v = medianInterval(shares);
    if (!v.isKnown())
        return fmt::format("{}% [too few groups for an interval]", threeDigits(100 * v.median));
    return fmt::format("{}% [{}, {}]", threeDigits(100 * v.median), threeDigits(100 * v.low),
                       threeDigits(100 * v.high));
}

// How the engine compares with another way that takes `ratio` times as long.
std::string verdict(const PairedRatio& ratio)
{
    if (!ratio.isKnown() || (!ratio.isFaster() && !ratio.isSlower()))
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

// The means of the groups of all light types that are no spheres.
std::vector<double> otherGroups(const KernelLevel& level, const MeasuredMethod& method)
{
    std::vector<double> out;
    for (const KernelPoint& p : level.points)
        if (!lighting::isSphere(p.lightType) && p.method == method)
            out.insert(out.end(), p.error.groupMeans.begin(), p.error.groupMeans.end());
    return out;
}

std::string threeMethods(const std::vector<double>& conic, const std::vector<double>& karis,
                         const std::vector<double>& ltc)
{
    std::string out = percentBracketed(conic) + " of the highest response";
    if (!karis.empty())
        out += fmt::format(", the representative point (karis) by {}", percentBracketed(karis));
    if (!ltc.empty())
        out += fmt::format(", LTC by {}", percentBracketed(ltc));
    const bool byKaris = ltc.empty() || (!karis.empty() && medianOf(karis) <= medianOf(ltc));
    const std::vector<double>& rival = byKaris ? karis : ltc;
    if (!rival.empty() && medianOf(conic) > 0) {
        const double ratio = medianOf(rival) / medianOf(conic);
        out += fmt::format(" (conic is {} times {} than {})",
                           threeDigits(ratio >= 1 ? ratio : 1 / ratio),
                           ratio >= 1 ? "closer to the truth" : "farther from the truth",
                           byKaris ? "karis" : "LTC");
    }
    return out;
}

struct SceneFlip {
    std::string scene;
    double flip = 0, karisFlip = 0;
};

std::vector<SceneFlip> sceneErrors(const std::vector<ImageScene>& scenes)
{
    std::vector<SceneFlip> out;
    for (const ImageScene& scene : scenes) {
        SceneFlip error{.scene = scene.name};
        for (const ImagePoint& p : scene.points) {
            if (p.method == CND_SPECULAR_CONIC)
                error.flip = p.error.flip;
            if (p.method == CND_SPECULAR_KARIS)
                error.karisFlip = p.error.flip;
        }
        out.push_back(error);
    }
    return out;
}

std::string slowestEvaluation(const KernelLevel& level)
{
    const KernelPoint* worst = nullptr;
    for (const KernelPoint& p : level.points)
        if (p.method == CND_SPECULAR_CONIC && mainClass(p) &&
            (!worst || mainClass(p)->both.ratio > mainClass(*worst)->both.ratio))
            worst = &p;
    if (!worst)
        return "";
    const VariantTime& t = mainClass(*worst)->both;
    return fmt::format("one conic evaluation takes up to {} times as long as one with the "
                       "representative point ({})",
                       bracketed({t.ratio, t.ratioLow, t.ratioHigh}),
                       lightTypeName(worst->lightType));
}

std::string largestError(const KernelLevel& level)
{
    const KernelPoint* worst = nullptr;
    for (const KernelPoint& p : level.points)
        if (p.method == CND_SPECULAR_CONIC &&
            (!worst || p.error.mirror.all.max > worst->error.mirror.all.max))
            worst = &p;
    return worst
               ? fmt::format("the largest error of the closed form in {} directions is {}% of the "
                             "highest response ({}; {})",
                             grouped(worst->error.mirror.all.count),
                             threeDigits(100 * worst->error.mirror.all.max),
                             lightTypeName(worst->lightType), worst->worst)
               : "";
}

std::string weakestCulling(const std::vector<CullingPoint>& points)
{
    const CullingPoint* worst = nullptr;
    const auto ratio = [](const CullingPoint& p) {
        return p.toEngine(p.bestBaseline().name).median;
    };
    for (const CullingPoint& p : points)
        if (!worst || ratio(p) < ratio(*worst))
            worst = &p;
    if (!worst)
        return "";
    const PairedRatio r = worst->toEngine(worst->bestBaseline().name);
    return fmt::format("where Candelabra is weakest ({}), the best other way of culling ({}) takes "
                       "{} times as long, so Candelabra is {}",
                       worst->title(), worst->bestBaseline().name, bracketed(r), verdict(r));
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
    return fmt::format("Candelabra {} (commit {}) was measured on {} ({}) with the driver {}: {} "
                       "took {:.0f} s by the clock and {:.0f} s of processor time, and square "
                       "brackets hold 95% confidence intervals of medians, over repeats for times "
                       "and over combinations of surface and light for errors.",
                       f.version, f.commit, f.device.name, deviceTypeName(f.device.type),
                       f.device.driver, counted(f.parts, "part"), f.wallSeconds,
                       f.processorSeconds);
}

std::string speedSentence(const std::vector<CullingPoint>& points)
{
    if (points.empty())
        return "Speed: the part \"culling\" was not measured in this run.";
    std::string out = "Speed: ";
    if (const CullingPoint* p = brutePoint(points)) {
        const PairedRatio r = p->toEngine(bruteName);
        const Spread s = spreadOf(p->of(engineName).times.totals());
        out += fmt::format("lighting {} takes {} ms a frame (quartiles {} to {}) and brute force "
                           "takes {} times as long, so Candelabra is {}; ",
                           p->title(), threeDigits(s.median), threeDigits(s.lowerQuartile),
                           threeDigits(s.upperQuartile), bracketed(r), verdict(r));
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
    const auto groups = [&](const MeasuredMethod& method) {
        const KernelPoint* p = find(level, CND_LIGHT_SPHERE, method);
        return p ? p->error.groupMeans : std::vector<double>();
    };
    const std::vector<double> sphere = groups(CND_SPECULAR_CONIC),
                              other = otherGroups(level, CND_SPECULAR_CONIC);
    if (sphere.empty() && other.empty())
        return "Accuracy: the part \"accuracy\" was not measured in this run.";
    std::string out = "Accuracy against the double-precision truth: ";
    if (!sphere.empty())
        out += fmt::format("for one sphere light the closed form (conic) is typically off by {}",
                           threeMethods(sphere, groups(CND_SPECULAR_KARIS), groups(Rival::Ltc)));
    if (!other.empty())
        out += fmt::format("{}for area lights of other shapes by {}", sphere.empty() ? "" : "; ",
                           threeMethods(other, otherGroups(level, CND_SPECULAR_KARIS),
                                        otherGroups(level, Rival::Ltc)));
    if (const std::vector<SceneFlip> errors = sceneErrors(scenes); !errors.empty()) {
        std::vector<double> flips, karis;
        for (const SceneFlip& e : errors) {
            flips.push_back(e.flip);
            karis.push_back(e.karisFlip);
        }
        const auto [low, high] = std::minmax_element(flips.begin(), flips.end());
        out += fmt::format("; in {} of whole images the visible difference FLIP to the truth is "
                           "{:.4f} (median; {:.4f} to {:.4f}), with karis {:.4f}",
                           counted(errors.size(), "scene"), medianOf(flips), *low, *high,
                           medianOf(karis));
    }
    return out + ".";
}

std::string weaknessSentence(const KernelLevel& level, const std::vector<ImageScene>& scenes,
                             const std::vector<CullingPoint>& points)
{
    std::vector<std::string> facts{slowestEvaluation(level), largestError(level)};
    if (const std::vector<SceneFlip> errors = sceneErrors(scenes); !errors.empty()) {
        const SceneFlip& worst = *std::max_element(
            errors.begin(), errors.end(),
            [](const SceneFlip& a, const SceneFlip& b) { return a.flip < b.flip; });
        facts.push_back(fmt::format(
            "the worst image of the closed form is \"{}\" (FLIP {:.4f}, {} {:.4f} with karis)",
            worst.scene, worst.flip,
            worst.flip < worst.karisFlip ? "better than" : "not better than", worst.karisFlip));
    }
    facts.push_back(weakestCulling(points));
    std::erase(facts, "");
    if (facts.empty())
        return "Weak sides: neither the part \"accuracy\" nor \"culling\" was measured in this "
               "run.";
    std::string out = "Weak sides: ";
    for (size_t i = 0; i < facts.size(); ++i)
        out += (i ? "; " : "") + facts[i];
    return out + ".";
}

std::string stabilitySentence(const Stability& s)
{
    if (!s.tried())
        return "Stability: the part \"stability\" was not measured in this run.";
    std::string out = fmt::format(
        "Stability: of {} random and adversarial inputs {} gave a response that is no number, "
        "infinite, negative or impossibly bright (95% confidence: at most {} in a million)",
        grouped(s.tried()), s.invalid() ? grouped(s.invalid()) : "none",
        threeDigits(1e6 * largestShare(s.invalid(), s.tried())));
    const QuadratureCheck* worst = nullptr;
    const auto size = [](const QuadratureCheck& q) { return std::isnan(q.max) ? INFINITY : q.max; };
    for (const QuadratureCheck& q : s.quadrature)
        if (q.bar > 0 && (!worst || size(q) > size(*worst)))
            worst = &q;
    if (worst)
        out += fmt::format(
            "; the closed forms differ from quadrature by at most {}% of the "
            "response on the mirror axis ({}), which {} the allowed {}%",
            threeDigits(100 * worst->max), lightTypeName(worst->evaluation.lightType),
            worst->max <= worst->bar ? "is within" : "EXCEEDS", threeDigits(100 * worst->bar));
    double jump = 0;
    for (const ContinuityCheck& c : s.continuity)
        jump = std::max(jump, c.jump);
    if (!s.continuity.empty())
        out += fmt::format("; the largest jump between neighbouring inputs is {:.1e} of the peak",
                           jump);
    return out + ".";
}

} // namespace candelabra::app
