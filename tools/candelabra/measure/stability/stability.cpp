// SPDX-License-Identifier: Apache-2.0
#include "measure/stability/stability.h"

#include <algorithm>
#include <cmath>

#include <fmt/format.h>

#include "io/progress.h"
#include "measure/kernels/parallel.h"
#include "reference/truth.h"
#include "reference/vectors.h"
#include "render/setting_names.h"
#include "scene/light_types.h"
#include "shading/light_family.h"

namespace candelabra::app
{

namespace
{

std::vector<Evaluation> evaluations(const StabilitySettings& s)
{
    std::vector<Evaluation> out;
    for (uint32_t type = 0; type < CND_LIGHT_TYPE_COUNT; ++type)
        for (const CndSpecularMethod method : methodsOf(type))
            out.push_back({.lightType = type, .method = method, .sampleCount = s.sampleCount});
    const auto unwanted = [](const auto& wanted, auto value) {
        return !wanted.empty() && std::ranges::find(wanted, value) == wanted.end();
    };
    std::erase_if(out, [&](const Evaluation& e) {
        return unwanted(s.lightTypes, e.lightType) || unwanted(s.methods, e.method.specular);
    });
    return out;
}

bool hasQuadrature(const Evaluation& e)
{
    // A few random samples of the sampled method say nothing about the formula.
    return !cndIsPunctual(e.lightType) && e.method != CND_SPECULAR_SAMPLED;
}

bool isClosedForm(const Evaluation& e)
{
    return lighting::isClosedForm(e.method.specular) && !cndIsPunctual(e.lightType);
}

bool hasContinuity(const Evaluation& e)
{
    return (lighting::isSphere(e.lightType) || isClosedForm(e)) && hasQuadrature(e);
}

// The slices whose lights have a size and a position that float32 resolves.
constexpr uint32_t quadratureSlices[] = {gpu::SWEEP_ANYTHING,      gpu::SWEEP_CONTACT,
                                         gpu::SWEEP_ALIGNED,       gpu::SWEEP_TANGENT,
                                         gpu::SWEEP_EXTREME_ALPHA, gpu::SWEEP_EDGE};

struct Compared {
    double error = 0, diffuse = 0;
    bool counted = false;
    bool truthAboveBound = false;
};

Compared compareWithTruth(const gpu::SweepRecord& r, const Evaluation& evaluation)
{
    const reference::SurfacePoint surface{glm::dvec3(0), glm::normalize(glm::dvec3(r.n)),
                                          glm::normalize(glm::dvec3(r.v))};
    const double NoV = glm::dot(surface.normal, surface.toEye);
    constexpr double minNoV = 0.02; // below this NoV the conic methods tilt the view
    if (NoV < minNoV)
        return {};
    const float rounded = r.perceptualRoughness * r.perceptualRoughness;
    const double alpha = std::max(double(rounded), double(gpu::MIN_ALPHA));
    const CndLight light = lightOf(r, evaluation.lightType);
    const glm::dvec3 to = reference::vec3(light.position);
    const bool distant = cndIsDistant(evaluation.lightType);
    if (!distant && !(glm::length(to) > 0))
        return {};
    // If the plane of a flat light passes so close, rounding decides whether a receiver sees it.
    const glm::dvec3 u(r.shape.axisU), v(r.shape.axisV);
    if (cndLightFields(evaluation.lightType) & CND_LIGHT_FIELD_TWO_SIDED_BIT) {
        const glm::dvec3 facing = glm::length(v) > 0 ? glm::cross(u, v) : u;
        if (std::abs(glm::dot(to, facing)) < 1e-5 * glm::length(facing) * double(r.centreRadius.w))
            return {};
    }
    const reference::LightResponse truth =
        reference::truthResponse(surface, alpha, light, glm::dvec3(0), 1e-6);
    const double distance = distant ? 1 : std::max(glm::length(to), 1e-30);
    const double s = std::min(double(r.centreRadius.w) / distance, 1.0);
    return {std::abs(double(r.response.y) - truth.a) / onAxisResponse(s, alpha, NoV),
            std::abs(double(r.response.x) - truth.f) / (s * s), true,
            truth.a > 1.001 * double(r.bound) + 1e-9};
}

QuadratureCheck checkQuadrature(Sweep& sweep, const Evaluation& evaluation, uint32_t samples,
                                const std::function<void(size_t)>& onDone)
{
    QuadratureCheck out{.evaluation = evaluation,
                        .bar = isClosedForm(evaluation) ? double(gpu::SWEEP_CLOSED_FORM_ERROR) : 0,
                        .worst = {}};
    std::vector<uint32_t> slices;
    for (const uint32_t slice : quadratureSlices)
        if (slice != gpu::SWEEP_CONTACT || evaluation.lightType == CND_LIGHT_SPHERE)
            slices.push_back(slice);
    std::vector<double> errors;
    for (size_t k = 0; k < slices.size(); ++k) {
        const size_t target = samples * (k + 1) / slices.size();
        uint32_t drawn = 0;
        while (errors.size() < target) { // some configurations cannot be compared
            const auto count = uint32_t(target - errors.size());
            const auto records = sweep.record(slices[k], drawn, count);
            drawn += count;
            std::vector<Compared> compared(records.size());
            parallelFor(
                records.size(),
                [&](size_t i) { compared[i] = compareWithTruth(records[i], evaluation); },
                [](size_t) {});
            const size_t before = errors.size();
            for (size_t i = 0; i < records.size(); ++i) {
                if (!compared[i].counted)
                    continue;
                errors.push_back(compared[i].error);
                out.truthsAboveBound += compared[i].truthAboveBound;
                out.diffuseMax = std::max(out.diffuseMax, compared[i].diffuse);
                if (!(compared[i].error <= out.max)) { // NaN counts as the worst error
                    out.max = compared[i].error;
                    out.worst =
                        fmt::format("{}; {}", sliceText(slices[k]), describeRecord(records[i]));
                }
            }
            onDone(errors.size() - before);
        }
    }
    out.samples = errors.size();
    if (errors.empty())
        return out;
    std::ranges::sort(errors);
    for (const double e : errors)
        out.mean += e / double(errors.size());
    out.p99 = errors[size_t(std::ceil(0.99 * double(errors.size()))) - 1];
    return out;
}

// In the progress bar a quadrature counts as many steps as so many configurations.
constexpr double stepsPerTruth = 2000;

} // namespace

double onAxisResponse(double s, double alpha, double NoV)
{
    const double l1 = s / (2 * alpha), l2 = l1 / NoV;
    return l1 * l2 / std::sqrt((1 + l1 * l1) * (1 + l2 * l2));
}

uint64_t Stability::tried() const
{
    uint64_t sum = 0;
    for (const SweptSlice& s : slices)
        sum += s.count.tried;
    return sum;
}

uint64_t Stability::invalid() const
{
    uint64_t sum = 0;
    for (const SweptSlice& s : slices)
        sum += s.count.invalid();
    return sum;
}

bool Stability::overBar() const
{
    return std::ranges::any_of(quadrature, &QuadratureCheck::overBar);
}

Stability measureStability(const VulkanContext& context, const StabilitySettings& settings,
                           bool showProgress)
{
    Progress progress(double(settings.configurations) + stepsPerTruth * settings.quadratureSamples,
                      showProgress);
    Stability out;
    const std::vector<Evaluation> all = evaluations(settings);
    const auto measurable = size_t(std::ranges::count_if(all, hasQuadrature));
    const uint64_t each =
        std::max<uint64_t>((settings.configurations + all.size() * sweepSliceCount - 1) /
                               (all.size() * sweepSliceCount),
                           1);
    const auto truths =
        uint32_t((settings.quadratureSamples + measurable - 1) / measurable); // rounded up
    for (const Evaluation& evaluation : all) {
        progress.doing(fmt::format("{} {}", lightTypeName(evaluation.lightType),
                                   methodName(evaluation.method)));
        Sweep sweep(context, evaluation, settings.seed, settings.inexactDivision);
        for (uint32_t slice = 0; slice < sweepSliceCount; ++slice)
            out.slices.push_back({evaluation, slice, sweep.count(slice, 0, each, [&](uint64_t n) {
                                      progress.advance(double(n));
                                  })});
        if (hasQuadrature(evaluation))
            out.quadrature.push_back(checkQuadrature(sweep, evaluation, truths, [&](size_t n) {
                progress.advance(stepsPerTruth * double(n));
            }));
        if (hasContinuity(evaluation) && !settings.inexactDivision)
            for (ContinuityCheck& check :
                 checkContinuity(context, evaluation, settings.sweeps, settings.seed))
                out.continuity.push_back(std::move(check));
    }
    return out;
}

namespace
{

std::string nameOf(const Evaluation& e)
{
    return fmt::format("{} {}", lightTypeName(e.lightType), methodName(e.method));
}

Table countTable(const Stability& stability)
{
    Table table({"inputs", "tried", "NaN", "infinite", "negative", "above the bound"},
                fmt::format("Responses to {} inputs, {} of them invalid",
                            grouped(stability.tried()), grouped(stability.invalid())));
    for (uint32_t slice = 0; slice < sweepSliceCount; ++slice) {
        SweepCount sum;
        for (const SweptSlice& s : stability.slices)
            if (s.slice == slice) {
                sum.tried += s.count.tried;
                sum.nan += s.count.nan;
                sum.infinite += s.count.infinite;
                sum.negative += s.count.negative;
                sum.above += s.count.above;
            }
        table.add({sliceText(slice), grouped(sum.tried), grouped(sum.nan), grouped(sum.infinite),
                   grouped(sum.negative), grouped(sum.above)});
    }
    return table;
}

Table quadratureTable(const Stability& stability)
{
    Table table(
        {"light, method",
         "samples",
         {"mean", "%"},
         {"p99", "%"},
         {"max", "%"},
         {"bar", "%"},
         "diffuse max"},
        "Formula against quadrature on such inputs, F = 1, relative to the response on the mirror "
        "axis");
    for (const QuadratureCheck& q : stability.quadrature)
        table.add({nameOf(q.evaluation), grouped(q.samples), threeDigits(100 * q.mean),
                   threeDigits(100 * q.p99), threeDigits(100 * q.max),
                   q.bar > 0 ? threeDigits(100 * q.bar) : "-", threeDigits(q.diffuseMax)});
    return table;
}

Table continuityTable(const Stability& stability)
{
    Table table({"light, method", Column::words("through"), "largest jump / peak"}, "Continuity");
    for (const ContinuityCheck& c : stability.continuity)
        table.add({nameOf(c.evaluation), c.through, threeDigits(c.jump)});
    return table;
}

// A sentence about every kind of input with invalid responses.
void noteBadResponses(const Stability& stability, Table& table)
{
    for (const SweptSlice& s : stability.slices)
        if (s.count.invalid())
            table.note(fmt::format(
                "Invalid responses of {}, {}: {} NaN, {} infinite, {} negative, {} above the bound "
                "of {}{}",
                nameOf(s.evaluation), sliceText(s.slice), s.count.nan, s.count.infinite,
                s.count.negative, s.count.above, s.count.tried,
                s.count.bad.empty() ? "" : "; " + describeRecord(s.count.bad[0])));
}

void noteOverBar(const Stability& stability, Table& table)
{
    for (const QuadratureCheck& q : stability.quadrature)
        if (q.overBar())
            table.note(fmt::format(
                "Over the bar: {}: {}% at {}; {} true responses above their bound",
                nameOf(q.evaluation), threeDigits(100 * q.max), q.worst, q.truthsAboveBound));
}

} // namespace

std::vector<Table> stabilityTables(const Stability& stability)
{
    std::vector<Table> out{countTable(stability), quadratureTable(stability)};
    noteBadResponses(stability, out[0]);
    noteOverBar(stability, out[1]);
    if (!stability.continuity.empty())
        out.push_back(continuityTable(stability));
    return out;
}

Json stabilityJson(const StabilitySettings& settings, const Stability& stability)
{
    Json slices = Json::array(), quadrature = Json::array(), continuity = Json::array();
    for (const SweptSlice& s : stability.slices) {
        Json bad = Json::array();
        for (const gpu::SweepRecord& r : s.count.bad)
            bad.push_back(describeRecord(r));
        slices.push_back({{"evaluation", nameOf(s.evaluation)},
                          {"inputs", sliceText(s.slice)},
                          {"tried", s.count.tried},
                          {"nan", s.count.nan},
                          {"infinite", s.count.infinite},
                          {"negative", s.count.negative},
                          {"aboveBound", s.count.above},
                          {"bad", bad}});
    }
    for (const QuadratureCheck& q : stability.quadrature)
        quadrature.push_back({{"evaluation", nameOf(q.evaluation)},
                              {"samples", q.samples},
                              {"meanPercent", 100 * q.mean},
                              {"p99Percent", 100 * q.p99},
                              {"maxPercent", 100 * q.max},
                              {"barPercent", 100 * q.bar},
                              {"diffuseMax", q.diffuseMax},
                              {"truthsAboveBound", q.truthsAboveBound},
                              {"worst", q.worst}});
    for (const ContinuityCheck& c : stability.continuity)
        continuity.push_back({{"evaluation", nameOf(c.evaluation)},
                              {"through", c.through},
                              {"jumpOverPeak", c.jump},
                              {"worst", c.worst}});
    return {{"seed", settings.seed},
            {"inexactDivision", settings.inexactDivision},
            {"configurations", stability.tried()},
            {"invalid", stability.invalid()},
            {"slices", slices},
            {"formulaAgainstQuadrature", quadrature},
            {"continuity", continuity}};
}

} // namespace candelabra::app
