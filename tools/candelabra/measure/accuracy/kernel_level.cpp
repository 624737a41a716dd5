// SPDX-License-Identifier: Apache-2.0
#include "measure/accuracy/kernel_level.h"

#include <algorithm>

#include <fmt/format.h>

#include "io/statistics.h"
#include "io/svg_plot.h"
#include "lights/light_types.h"
#include "measure/kernels/in_double.h"

namespace candelabra::app
{

namespace
{

uint32_t groupsOf(uint32_t lightType, uint32_t groups)
{
    // Truths of other shapes cost fifty times as much.
    return lightType == CND_LIGHT_SPHERE ? groups : std::max(groups / 3, 20u);
}

std::vector<EvaluationCase> casesOf(uint32_t lightType)
{
    if (lighting::isSphere(lightType))
        return {EvaluationCase::Above, EvaluationCase::Near, EvaluationCase::General};
    return {EvaluationCase::Above, EvaluationCase::General};
}

// Progress counts samples; a round of timing weighs as much as these.
constexpr double samplesPerRound = 3000;

void addErrors(const VulkanContext& context, const KernelLevelSettings& s, uint32_t lightType,
               Progress& progress, KernelLevel& out)
{
    SampleSet set = makeSamples(lightType, groupsOf(lightType, s.groups), s.seed);
    progress.doing(std::string("truth: ") + lightTypeName(lightType));
    integrateTruth(set, s.truthTolerance, [&](size_t n) { progress.advance(double(n)); });
    out.samples += set.samples.size();
    out.unconvergedTruths += size_t(std::ranges::count_if(
        set.samples, [](const LightSample& sample) { return !sample.truth.converged; }));
    for (const MeasuredMethod& method : comparedMethods(lightType)) {
        const Evaluation evaluation{
            .lightType = lightType, .method = method, .sampleCount = s.sampleCount};
        const LightEvaluator evaluator(context, evaluation);
        const auto responses = evaluator.evaluate(set.receivers, set.lights);
        std::vector<formula::Response> inDouble;
        if (method.rival == Rival::None)
            inDouble = respondInDouble(evaluation, set.receivers, set.lights);
        KernelPoint point{.lightType = lightType,
                          .method = method,
                          .error = kernelError(set, responses, inDouble),
                          .worst = {},
                          .cases = {}};
        point.worst = describeSample(set, point.error.mirror.all.worst);
        out.points.push_back(std::move(point));
    }
}

// The variants to time, and for each the index of the variant that it is compared with, or -1.
struct Plan {
    std::vector<TimedVariant> variants;
    std::vector<int> baseline;

    int add(TimedVariant variant, int base)
    {
        variants.push_back(std::move(variant));
        baseline.push_back(base);
        return int(variants.size()) - 1;
    }
};

struct CasePlan {
    size_t point, index; // of KernelLevel::points and of its cases
    int both, diffuse;
};

int addEvaluation(Plan& plan, const KernelLevelSettings& s, uint32_t type,
                  const MeasuredMethod& method, EvaluationCase c, int base)
{
    // Only the closed form treats lights near the horizon apart.
    const bool conic = method == CND_SPECULAR_CONIC || method == CND_SPECULAR_CONIC_FULL;
    const EvaluationCase how = c == EvaluationCase::Near && !conic ? EvaluationCase::Above : c;
    return plan.add(
        {.name = {},
         .evaluation = {.lightType = type, .method = method, .sampleCount = s.sampleCount},
         .evaluationCase = how,
         .lights = c},
        base);
}

void addTimes(const VulkanContext& context, const KernelLevelSettings& s, Progress& progress,
              KernelLevel& out)
{
    Plan plan;
    std::vector<CasePlan> plans;
    for (const uint32_t type : s.lightTypes)
        for (const EvaluationCase c : casesOf(type)) {
            const int diffuse = addEvaluation(plan, s, type, CND_SPECULAR_NONE, c, -1);
            const int karis = addEvaluation(plan, s, type, CND_SPECULAR_KARIS, c, -1);
            plan.baseline[size_t(karis)] = karis;
            for (size_t i = 0; i < out.points.size(); ++i) {
                if (out.points[i].lightType != type)
                    continue;
                const MeasuredMethod& method = out.points[i].method;
                const int both = method == CND_SPECULAR_KARIS
                                     ? karis
                                     : addEvaluation(plan, s, type, method, c, karis);
                out.points[i].cases.push_back({.evaluationCase = c, .both = {}});
                plans.push_back({i, out.points[i].cases.size() - 1, both, diffuse});
            }
        }
    progress.doing("timing kernels");
    const std::vector<VariantTime> times =
        timeVariants(context, plan.variants, plan.baseline, s.timing,
                     [&] { progress.advance(samplesPerRound); });
    if (times.empty()) {
        for (KernelPoint& p : out.points)
            p.cases.clear();
        return;
    }
    const auto rounds = [&](int i) -> const std::vector<double>& {
        return times[size_t(i)].roundsNs;
    };
    for (const CasePlan& c : plans) {
        KernelPoint::Case& entry = out.points[c.point].cases[c.index];
        entry.both = times[size_t(c.both)];
        entry.specularNs = medianAboveNoise(differences(rounds(c.both), rounds(c.diffuse)));
    }
}

} // namespace

double kernelLevelSteps(const KernelLevelSettings& s)
{
    double steps = samplesPerRound * s.timing.rounds;
    for (const uint32_t type : s.lightTypes)
        steps += double(groupsOf(type, s.groups)) * samplesPerGroup;
    return steps;
}

KernelLevel measureKernelLevel(const VulkanContext& context, const KernelLevelSettings& settings,
                               Progress& progress)
{
    KernelLevel out;
    for (const uint32_t type : settings.lightTypes)
        addErrors(context, settings, type, progress, out);
    addTimes(context, settings, progress, out);
    return out;
}

namespace
{

std::string percent(double share)
{
    return threeDigits(100 * share);
}

const KernelPoint::Case* caseOf(const KernelPoint& p, EvaluationCase c)
{
    for (const KernelPoint::Case& entry : p.cases)
        if (entry.evaluationCase == c)
            return &entry;
    return nullptr;
}

// What a light well above the horizon costs; null without timestamps.
const KernelPoint::Case* mainCase(const KernelPoint& p)
{
    const KernelPoint::Case* above = caseOf(p, EvaluationCase::Above);
    return above ? above : caseOf(p, EvaluationCase::General);
}

std::string nameOf(const KernelPoint& p)
{
    return fmt::format("{} {}", lightTypeName(p.lightType), methodName(p.method));
}

Table errorTable(const KernelLevel& level)
{
    constexpr const char* meanAndMax = "% mean / p99 / max";
    Table table({"light, method",
                 {"all", meanAndMax},
                 {"above", meanAndMax},
                 {"crossing", meanAndMax},
                 {"F0 0.04: all", meanAndMax},
                 {"formula", meanAndMax},
                 {"float32", meanAndMax},
                 {"scan L1", "%"},
                 {"diffuse max", "%"},
                 {"leak", "%"},
                 "invalid"},
                "Errors in percent of the highest true response over light directions");
    uint32_t type = CND_LIGHT_TYPE_COUNT;
    for (const KernelPoint& p : level.points) {
        if (type != CND_LIGHT_TYPE_COUNT && type != p.lightType)
            table.rule();
        type = p.lightType;
        table.add({nameOf(p), meanP99Max(p.error.mirror.all), meanP99Max(p.error.mirror.above),
                   meanP99Max(p.error.mirror.crossing), meanP99Max(p.error.dielectric.all),
                   p.error.parts ? meanP99Max(p.error.parts->formula.mirror) : "-",
                   p.error.parts ? meanP99Max(p.error.parts->float32.mirror) : "-",
                   percent(p.error.scanL1), threeDigits(100 * p.error.diffuse.all.max),
                   percent(p.error.leak), grouped(p.error.invalid)});
    }
    table.note(fmt::format("{} samples; quadrature missed its tolerance in {}",
                           grouped(level.samples), grouped(level.unconvergedTruths)));
    return table;
}

void addTimeRow(Table& table, const KernelPoint& p)
{
    std::vector<std::string> row{nameOf(p)};
    bool noisy = false;
    for (const auto c : {EvaluationCase::Above, EvaluationCase::Near, EvaluationCase::General}) {
        const KernelPoint::Case* entry = caseOf(p, c);
        noisy |= entry && entry->both.noisy;
        row.push_back(entry ? threeDigits(medianAboveNoise(entry->both.roundsNs)) : "-");
        if (c != EvaluationCase::Near)
            row.push_back(entry ? threeDigits(entry->specularNs) : "-");
        const bool timed = entry && entry->both.ratio > 0;
        row.push_back(timed ? fmt::format("{:.2f}", entry->both.ratio) : "-");
    }
    table.add(row, {.noisy = noisy});
}

Table timeTable(const KernelLevel& level)
{
    Table table({"light, method",
                 {"above", "ns"},
                 {"specular", "ns"},
                 {"/ karis", "paired"},
                 {"near", "ns"},
                 {"/ karis", "paired"},
                 {"general", "ns"},
                 {"specular", "ns"},
                 {"/ karis", "paired"}},
                "Time per (pixel, light), diffuse and specular, on the whole device");
    uint32_t type = CND_LIGHT_TYPE_COUNT;
    for (const KernelPoint& p : level.points) {
        if (p.cases.empty()) {
            table.note("This device has no timestamps: nothing was timed.");
            return table;
        }
        if (type != CND_LIGHT_TYPE_COUNT && type != p.lightType)
            table.rule();
        type = p.lightType;
        addTimeRow(table, p);
    }
    table.note(pairedLegend());
    return table;
}

Json toJson(const VariantTime& t)
{
    return {{"medianNs", t.medianNs},
            {"minNs", t.minNs},
            {"ratioToKaris", t.ratio},
            {"ratioToKarisLow", t.ratioLow},
            {"ratioToKarisHigh", t.ratioHigh}};
}

} // namespace

std::vector<Table> kernelTables(const KernelLevel& level)
{
    return {errorTable(level), timeTable(level)};
}

Json kernelJson(const KernelLevelSettings& s, const KernelLevel& level)
{
    Json points = Json::array();
    for (const KernelPoint& p : level.points) {
        Json times = Json::object();
        for (const KernelPoint::Case& c : p.cases) {
            Json time = toJson(c.both);
            time["specularAloneNs"] = c.specularNs ? Json(*c.specularNs) : Json();
            times[caseName(c.evaluationCase)] = time;
        }
        points.push_back({{"light", lightTypeName(p.lightType)},
                          {"method", methodName(p.method)},
                          {"error", toJson(p.error)},
                          {"worst", p.worst},
                          {"time", times}});
    }
    return {{"groups", s.groups},
            {"seed", s.seed},
            {"samples", level.samples},
            {"truthTolerance", s.truthTolerance},
            {"unconvergedTruths", level.unconvergedTruths},
            {"samplesPerLightOfSampled", s.sampleCount},
            {"timing",
             {{"lanes", s.timing.lanes},
              {"fewLights", s.timing.fewLights},
              {"manyLights", s.timing.manyLights},
              {"rounds", s.timing.rounds}}},
            {"points", points}};
}

std::string kernelPlot(const KernelLevel& level, const DeviceInfo& device)
{
    std::vector<PlotSeries> series;
    for (const KernelPoint& p : level.points) {
        const KernelPoint::Case* time = mainCase(p);
        if (!time || p.lightType == CND_LIGHT_DISTANT_SPHERE) // the same code as spheres
            continue;
        series.push_back({.name = nameOf(p),
                          .points = {{time->both.medianNs, 100 * p.error.mirror.all.mean}},
                          .emphasised = p.lightType == CND_LIGHT_SPHERE});
    }
    return logLogPlot({.title = "Error against time of one light at one pixel",
                       .subtitle = device.name,
                       .xAxis = "ns per (pixel, light), diffuse and specular",
                       .yAxis = "mean error, % of the highest response"},
                      series);
}

} // namespace candelabra::app
