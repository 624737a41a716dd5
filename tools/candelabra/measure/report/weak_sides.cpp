// SPDX-License-Identifier: Apache-2.0
#include "measure/report/weak_sides.h"

#include <algorithm>

#include <fmt/format.h>

#include "scene/light_types.h"

namespace candelabra::app
{
namespace
{

// The least and the greatest of some ratios.
std::string rangeOf(const std::vector<double>& ratios)
{
    const auto [low, high] = std::minmax_element(ratios.begin(), ratios.end());
    const std::string from = fmt::format("{:.2f}", *low), to = fmt::format("{:.2f}", *high);
    return from == to ? to : from + " to " + to;
}

const char* placeText(EvaluationCase where)
{
    switch (where) {
    case EvaluationCase::Above:
        return "above the horizon of the surface";
    case EvaluationCase::Near:
        return "near the horizon of the surface";
    case EvaluationCase::General:
        break;
    }
    return "across the horizon of the surface";
}

std::string slowestEvaluation(const KernelLevel& level)
{
    const KernelPoint* worst = nullptr;
    const KernelPoint::Case* slowest = nullptr;
    for (const KernelPoint& p : level.points)
        for (const KernelPoint::Case& c : p.cases)
            if (p.method == CND_SPECULAR_CONIC &&
                (!slowest || c.both.ratio > slowest->both.ratio)) {
                worst = &p;
                slowest = &c;
            }
    if (!worst || slowest->both.ratio <= 1)
        return "";
    const VariantTime& t = slowest->both;
    const MedianInterval interval{t.ratio, t.ratioLow, t.ratioHigh};
    return fmt::format(
        "one evaluation by conic takes up to {:.2f}{} times as long as by karis (a {} {})", t.ratio,
        interval.isKnown() ? fmt::format(" [{:.2f}, {:.2f}]", t.ratioLow, t.ratioHigh)
                           : " [too few repeats for an interval]",
        lightTypeName(worst->lightType), placeText(slowest->evaluationCase));
}

std::string slowerImages(const std::vector<ImageScene>& scenes)
{
    std::vector<double> ratios;
    for (const ImageScene& scene : scenes)
        for (const ImagePoint& p : scene.points)
            if (p.method == CND_SPECULAR_CONIC && p.time.ratio > 1)
                ratios.push_back(p.time.ratio);
    return ratios.empty()
               ? ""
               : fmt::format("the lighting of whole images takes {} times as long as "
                             "with karis in {} of {}",
                             rangeOf(ratios), ratios.size(), counted(scenes.size(), "scene"));
}

// The point of the method conic whose error is largest.
template <typename Error>
const KernelPoint* worstConic(const KernelLevel& level, Error error)
{
    const KernelPoint* worst = nullptr;
    for (const KernelPoint& p : level.points)
        if (p.method == CND_SPECULAR_CONIC && (!worst || error(p) > error(*worst)))
            worst = &p;
    return worst;
}

std::string largestErrors(const KernelLevel& level)
{
    const auto ofMirror = [](const KernelPoint& p) { return p.error.mirror.all.max; };
    const auto ofPlastic = [](const KernelPoint& p) { return p.error.dielectric.all.max; };
    const KernelPoint* mirror = worstConic(level, ofMirror);
    const KernelPoint* plastic = worstConic(level, ofPlastic);
    return mirror && plastic
               ? fmt::format("the largest error of conic is {}% of the brightest reflection on "
                             "perfect metals (F = 1, {}) and {}% on plastic (F0 0.04, {})",
                             threeDigits(100 * ofMirror(*mirror)), lightTypeName(mirror->lightType),
                             threeDigits(100 * ofPlastic(*plastic)),
                             lightTypeName(plastic->lightType))
               : "";
}

// The scenes in which another way of lighting looks more like the truth.
std::string worseImages(const std::vector<ImageScene>& scenes)
{
    std::string out;
    for (const ImageScene& scene : scenes) {
        const auto flip = [&](const MeasuredMethod& method) {
            for (const ImagePoint& p : scene.points)
                if (p.method == method)
                    return p.error.flip;
            return 1.0;
        };
        const double own = flip(CND_SPECULAR_CONIC),
                     other = std::min(flip(CND_SPECULAR_KARIS), flip(Rival::Ltc));
        if (other < own)
            out += fmt::format("{}the image \"{}\" differs more from the truth (FLIP {:.4f}) than "
                               "by karis or LTC ({:.4f})",
                               out.empty() ? "" : "; ", scene.name, own, other);
    }
    return out;
}

std::string dearerCulling(const std::vector<CullingPoint>& points)
{
    std::vector<double> ratios;
    for (const CullingPoint& p : points)
        if (const double other = p.of(froxelsName).cullingMs();
            other > 0 && p.of(engineName).cullingMs() > other)
            ratios.push_back(p.of(engineName).cullingMs() / other);
    return ratios.empty() ? ""
                          : fmt::format("finding the lights of the pixels takes {} times as long "
                                        "as by froxels in {} of {} (the evaluations that this "
                                        "saves are counted in the times above)",
                                        rangeOf(ratios), ratios.size(),
                                        counted(points.size(), "configuration"));
}

// Returns the cases where Candelabra is not shown to be faster than the best other way of culling.
std::string notFaster(const std::vector<CullingPoint>& points)
{
    std::string out;
    for (const CullingPoint& p : points) {
        const PairedRatio r = p.toEngine(p.bestBaseline().name);
        if (r.isSlower())
            continue;
        const bool slower = r.isKnown() && r.isFaster();
        out += fmt::format("{}in {} Candelabra is {} than {}", out.empty() ? "" : "; ", p.title(),
                           slower ? "slower" : "not measurably faster", p.bestBaseline().name);
        out += r.isKnown() ? fmt::format(", which takes {:.2f} [{:.2f}, {:.2f}] times as long",
                                         r.median, r.low, r.high)
                           : " (too few repeats for an interval)";
    }
    return out;
}

} // namespace

std::string weaknessSentence(const WeakSideFacts& f)
{
    if (f.kernels.points.empty() && f.culling.empty())
        return "Weak sides: neither the part \"accuracy\" nor \"culling\" was measured in this "
               "run.";
    std::vector<std::string> weak{slowestEvaluation(f.kernels), slowerImages(f.scenes),
                                  dearerCulling(f.culling),     notFaster(f.culling),
                                  largestErrors(f.kernels),     worseImages(f.scenes)};
    std::erase(weak, "");
    return weak.empty() ? "Weak sides: this run shows none."
                        : fmt::format("Weak sides: {}.", fmt::join(weak, "; "));
}

} // namespace candelabra::app
