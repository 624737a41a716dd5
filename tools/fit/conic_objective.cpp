// SPDX-License-Identifier: Apache-2.0
#include "fit/conic_objective.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>

#include "measure/kernels/in_double.h"

namespace candelabra::fit
{
namespace
{

constexpr double truthTolerance = 1e-5; // relative
constexpr double dielectricF0 = 0.04;

double dielectricResponse(double a, double b)
{
    return dielectricF0 * (a - b) + b;
}

// The figures, in percent, of errors given as fractions. Reorders the errors.
ErrorFigures figures(std::vector<double>& errors)
{
    if (errors.empty())
        return {};
    const double count = double(errors.size());
    const double mean = std::accumulate(errors.begin(), errors.end(), 0.0) / count;
    const double squares =
        std::inner_product(errors.begin(), errors.end(), errors.begin(), 0.0) / count;
    const auto p99 = errors.begin() + (long(std::ceil(0.99 * count)) - 1); // nearest rank
    std::nth_element(errors.begin(), p99, errors.end());
    return {.mean = 100 * mean,
            .rms = 100 * std::sqrt(squares),
            .p99 = 100 * *p99,
            .largest = 100 * *std::max_element(p99, errors.end())};
}

double weigh(const ErrorFigures& f)
{
    return 20 * f.mean + f.p99 + f.largest / 3;
}

void appendGroup(app::SampleSet& to, const app::SampleSet& from, uint32_t group)
{
    const uint32_t newGroup = to.groups++;
    for (size_t i = 0; i < from.samples.size(); ++i)
        if (from.samples[i].group == group) {
            to.receivers.push_back(from.receivers[i]);
            to.lights.push_back(from.lights[i]);
            to.samples.push_back(from.samples[i]);
            to.samples.back().group = newGroup;
        }
}

} // namespace

std::span<const ConicConstant> conicConstants()
{
    // At 1 the slope variance has a pole where the light takes in the whole lobe.
    const auto limit = [](double ConicConstants::*value) {
        return value == &ConicConstants::CONIC_TAIL ? 1 : std::numeric_limits<double>::infinity();
    };
#define X(name, value, meaning)                                                                    \
    {#name, meaning, &ConicConstants::name, gpu::name, limit(&ConicConstants::name)},
    static const ConicConstant constants[] = {CND_CONIC_FITTED(X)};
#undef X
    return constants;
}

ConicObjective::ConicObjective(app::SampleSet set)
    : set_(std::move(set)),
      lights_(app::prepareLights(set_.lights)),
      mirrorPeak_(set_.groups),
      dielectricPeak_(set_.groups)
{
    for (const app::LightSample& s : set_.samples) {
        double& mirror = mirrorPeak_[s.group];
        double& dielectric = dielectricPeak_[s.group];
        mirror = std::max(mirror, s.truth.a);
        dielectric = std::max(dielectric, dielectricResponse(s.truth.a, s.truth.b));
    }
    for (uint32_t i = 0; i < set_.samples.size(); ++i)
        if (set_.samples[i].horizon != app::Horizon::Below &&
            mirrorPeak_[set_.samples[i].group] > 0)
            counted_.push_back(i);
}

ConicObjective::Error ConicObjective::error(size_t i, const formula::Settings& settings) const
{
    const app::LightSample& s = set_.samples[i];
    const formula::Response response =
        formula::respond(settings, app::receiverInDouble(set_.receivers[i]),
                         app::lightInDouble(CND_LIGHT_SPHERE, lights_, uint32_t(i)));
    const double dielectric =
        dielectricResponse(response.a, response.b) - dielectricResponse(s.truth.a, s.truth.b);
    const double mirror = std::abs(response.a - s.truth.a) / mirrorPeak_[s.group];
    const double other = std::abs(dielectric) / dielectricPeak_[s.group];
    constexpr double infinity = std::numeric_limits<double>::infinity(); // NaN cannot be sorted
    return {std::isnan(mirror) ? infinity : mirror, std::isnan(other) ? infinity : other};
}

ConicResiduals ConicObjective::residuals(const ConicConstants& constants) const
{
    const auto ofMethod = [&](CndSpecularMethod method) {
        const formula::Settings settings{.method = method, .constants = constants};
        std::vector<double> mirror, mirrorAbove, dielectric, dielectricAbove;
        for (const uint32_t i : counted_) {
            const Error e = error(i, settings);
            mirror.push_back(e.mirror);
            dielectric.push_back(e.dielectric);
            if (set_.samples[i].horizon == app::Horizon::Above) {
                mirrorAbove.push_back(e.mirror);
                dielectricAbove.push_back(e.dielectric);
            }
        }
        return MethodFigures{{figures(mirror), figures(mirrorAbove)},
                             {figures(dielectric), figures(dielectricAbove)}};
    };
    return {ofMethod(CND_SPECULAR_CONIC), ofMethod(CND_SPECULAR_CONIC_FULL)};
}

double ConicObjective::cost(const ConicConstants& constants) const
{
    for (const ConicConstant& c : conicConstants())
        if (!(constants.*c.value >= 0 && constants.*c.value < c.limit))
            return std::numeric_limits<double>::infinity();
    const ConicResiduals r = residuals(constants);
    double sum = 0;
    for (const MethodFigures* method : {&r.conic, &r.conicFull})
        sum += weigh(method->mirror.all) + weigh(method->dielectric.all) / 4;
    return std::isfinite(sum) ? sum : std::numeric_limits<double>::infinity();
}

std::vector<uint32_t> ConicObjective::worstGroups(const ConicConstants& constants,
                                                  size_t count) const
{
    const formula::Settings settings{.method = CND_SPECULAR_CONIC, .constants = constants};
    std::vector<double> worst(set_.groups);
    for (const uint32_t i : counted_) {
        double& w = worst[set_.samples[i].group];
        w = std::max(w, error(i, settings).mirror);
    }
    std::vector<uint32_t> groups(set_.groups);
    std::iota(groups.begin(), groups.end(), 0u);
    std::stable_sort(groups.begin(), groups.end(),
                     [&](uint32_t a, uint32_t b) { return worst[a] > worst[b]; });
    groups.resize(std::min(count, groups.size()));
    return groups;
}

app::SampleSet drawSamples(uint32_t groups, uint64_t seed)
{
    app::SampleSet set = app::makeSamples(CND_LIGHT_SPHERE, groups, seed);
    app::integrateTruth(set, truthTolerance, [](size_t) {});
    return set;
}

app::SampleSet drawTrainingSamples(const TrainingSize& size)
{
    app::SampleSet training = drawSamples(size.groups, size.seed);
    const ConicObjective others(drawSamples(size.others, size.seed + 1));
    for (const uint32_t group : others.worstGroups({}, size.hard))
        appendGroup(training, others.set(), group);
    return training;
}

app::SampleSet drawCheckSamples()
{
    return drawSamples(60, 14);
}

} // namespace candelabra::fit
