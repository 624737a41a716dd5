// SPDX-License-Identifier: Apache-2.0
#include "measure/accuracy/kernel_level.h"

#include <algorithm>

#include "lights/light_types.h"
#include "scene/light_types.h"

namespace candelabra::app
{
namespace
{

uint32_t groupsOf(uint32_t lightType, uint32_t groups)
{
    // Truths of other shapes cost fifty times as much.
    return lightType == CND_LIGHT_SPHERE ? groups : std::max(groups / 3, 20u);
}

std::vector<EvaluationClass> classesOf(uint32_t lightType)
{
    if (lighting::isSphere(lightType))
        return {EvaluationClass::Above, EvaluationClass::Near, EvaluationClass::General};
    return {EvaluationClass::General};
}

// Progress counts samples; a round of timing weighs as much as these.
constexpr double stepsPerRound = 3000;

void addErrors(const VulkanContext& context, const KernelLevelSettings& s, uint32_t lightType,
               Progress& progress, KernelLevel& out)
{
    SampleSet set = makeSamples(lightType, groupsOf(lightType, s.groups), s.seed);
    progress.doing(std::string("truth: ") + lightTypeName(lightType));
    integrateTruth(set, s.truthTolerance, [&](size_t n) { progress.advance(double(n)); });
    out.samples += set.samples.size();
    out.unconvergedTruths +=
        size_t(std::count_if(set.samples.begin(), set.samples.end(),
                             [](const LightSample& sample) { return !sample.truth.converged; }));
    for (const CndSpecularMethod method : methodsOf(lightType)) {
        const LightEvaluator evaluator(
            context, {.lightType = lightType, .method = method, .sampleCount = s.sampleCount});
        const auto responses = evaluator.evaluate(set.receivers, set.lights);
        KernelPoint point{.lightType = lightType,
                          .method = method,
                          .error = kernelError(set, responses),
                          .worst = {},
                          .classes = {}};
        point.worst = describeSample(set, point.error.mirror.all.worst);
        out.points.push_back(std::move(point));
    }
}

// The variants to time, and which point and class each belongs to.
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

struct ClassPlan {
    size_t point, index; // of KernelLevel::points and of its classes
    int both, diffuse;
};

int addEvaluation(Plan& plan, const KernelLevelSettings& s, uint32_t type, CndSpecularMethod method,
                  EvaluationClass c, int base)
{
    // Only the closed form treats lights near the horizon apart.
    const bool conic = method == CND_SPECULAR_CONIC || method == CND_SPECULAR_CONIC_FULL;
    const EvaluationClass how = c == EvaluationClass::Near && !conic ? EvaluationClass::Above : c;
    return plan.add(
        {.name = {},
         .evaluation = {.lightType = type, .method = method, .sampleCount = s.sampleCount},
         .evaluationClass = how,
         .lights = c},
        base);
}

void addTimes(const VulkanContext& context, const KernelLevelSettings& s, Progress& progress,
              KernelLevel& out)
{
    Plan plan;
    std::vector<ClassPlan> classes;
    for (const uint32_t type : s.lightTypes)
        for (const EvaluationClass c : classesOf(type)) {
            const int diffuse = addEvaluation(plan, s, type, CND_SPECULAR_NONE, c, -1);
            const int karis = addEvaluation(plan, s, type, CND_SPECULAR_KARIS, c, -1);
            plan.baseline[size_t(karis)] = karis;
            for (size_t i = 0; i < out.points.size(); ++i) {
                if (out.points[i].lightType != type)
                    continue;
                const CndSpecularMethod method = out.points[i].method;
                const int both = method == CND_SPECULAR_KARIS
                                     ? karis
                                     : addEvaluation(plan, s, type, method, c, karis);
                out.points[i].classes.push_back({.evaluationClass = c, .both = {}});
                classes.push_back({i, out.points[i].classes.size() - 1, both, diffuse});
            }
        }
    const auto addForm = [&](uint32_t form, EvaluationClass lights) {
        return plan.add({.name = {},
                         .evaluation = {.method = CND_SPECULAR_NONE},
                         .evaluationClass = lights,
                         .formFactor = true,
                         .form = form},
                        -1);
    };
    const int loop = addForm(gpu::BENCH_FORM_FACTOR_NONE, EvaluationClass::General);
    const int robust = addForm(gpu::BENCH_FORM_FACTOR_ROBUST, EvaluationClass::General);
    const int naive = addForm(gpu::BENCH_FORM_FACTOR_NAIVE, EvaluationClass::General);
    const int naiveAbove = addForm(gpu::BENCH_FORM_FACTOR_NAIVE, EvaluationClass::Above);
    const int asPoint =
        plan.add({.name = {},
                  .evaluation = {.method = CND_SPECULAR_CONIC, .errorBudget = 0.01f},
                  .evaluationClass = EvaluationClass::Point},
                 -1);
    progress.doing("timing kernels");
    const std::vector<VariantTime> times = timeVariants(
        context, plan.variants, plan.baseline, s.timing, [&] { progress.advance(stepsPerRound); });
    if (times.empty()) {
        for (KernelPoint& p : out.points)
            p.classes.clear();
        return;
    }
    for (const ClassPlan& c : classes) {
        KernelPoint::Class& entry = out.points[c.point].classes[c.index];
        entry.both = times[size_t(c.both)];
        entry.specularNs = entry.both.medianNs - times[size_t(c.diffuse)].medianNs;
    }
    const auto ns = [&](int i) { return times[size_t(i)].medianNs; };
    out.formFactor = {ns(robust) - ns(loop), ns(naive) - ns(loop), ns(naiveAbove) - ns(loop)};
    out.pointBudgetNs = ns(asPoint);
}

} // namespace

double kernelLevelSteps(const KernelLevelSettings& s)
{
    double steps = stepsPerRound * s.timing.rounds;
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

} // namespace candelabra::app
