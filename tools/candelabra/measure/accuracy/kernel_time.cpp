// SPDX-License-Identifier: Apache-2.0
#include "measure/accuracy/kernel_time.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <numbers>

#include "candelabra_bench_shaders.h"
#include "generate/random.h"
#include "io/statistics.h"
#include "lights/light_limits.h"
#include "lights/light_types.h"
#include "measure/kernels/vectors.h"
#include "scene/polygons.h"

namespace candelabra::app
{
namespace
{

using std::numbers::pi;

glm::dvec3 direction(Random& random, double cosine)
{
    const double azimuth = 2 * pi * double(random.uniform());
    const double sine = std::sqrt(std::max(0.0, 1 - cosine * cosine));
    return {sine * std::cos(azimuth), sine * std::sin(azimuth), cosine};
}

std::vector<gpu::BenchReceiver> receiversOf(const TimingSettings& s)
{
    Random random(s.seed, 100);
    std::vector<gpu::BenchReceiver> out;
    for (uint32_t i = 0; i < s.lanes; ++i) {
        const float roughness = random.uniform(0.1f, 1.0f);
        const double NoV = 0.05 + 0.95 * double(random.uniform());
        out.push_back({.n = {0, 0, 1},
                       .v = glm::vec3(direction(random, NoV)),
                       .perceptualRoughness = roughness});
    }
    return out;
}

// Makes lights of one type for which a case is meant: spheres that cross the horizon (General),
// lights that end 0.05 to 0.95 radii above it (Near), or lights that are higher (Above, and General
// of other types).
std::vector<CndLight> lightsOf(uint32_t type, EvaluationCase c, const TimingSettings& s)
{
    Random random(s.seed, 200 + uint64_t(type) * 8 + uint64_t(c));
    std::vector<CndLight> out;
    for (uint32_t i = 0; i < s.manyLights; ++i) {
        const double sine = 0.05 + 0.25 * double(random.uniform());
        const double u = double(random.uniform());
        double cosine = 2.1 * sine + (1 - 2.1 * sine) * u;
        if (c == EvaluationCase::General && lighting::isSphere(type))
            cosine = sine * (1.8 * u - 0.9);
        else if (c == EvaluationCase::Near)
            cosine = sine * (1.05 + 0.9 * u);
        const double distance = 1 + 4 * double(random.uniform());
        const glm::dvec3 to = direction(random, cosine);
        CndLight light{.type = type, .emission = {1, 1, 1}, .influenceRadius = 1e3f};
        set(light.position, distance * to);
        set(light.direction, -to);
        light.radius = float(type == CND_LIGHT_DISTANT_SPHERE ? sine : sine * distance);
        const glm::dvec3 u1 = glm::normalize(glm::cross(to, glm::dvec3(0.3, 0.5, 0.8)));
        set(light.axisU, sine * distance * u1);
        set(light.axisV, -0.7 * sine * distance * glm::cross(to, u1));
        light.polygon = somePolygon(i);
        if (type == CND_LIGHT_TUBE)
            light.radius *= 0.2f;
        out.push_back(light);
    }
    return out;
}

struct Prepared {
    gpu::Kernel<gpu::BenchParams> kernel;
    gpu::Bindings bindings;
};

class Bench
{
public:
    Bench(const VulkanContext& context, const TimingSettings& settings)
        : context_(context),
          settings_(settings),
          timer_(context.device(), "bench", 1, true),
          receivers_(uploadReceivers(context.device(), receiversOf(settings))),
          output_(gpu::createBuffer(context.device(), "bench sums", settings.lanes * sizeof(float),
                                    VK_BUFFER_USAGE_STORAGE_BUFFER_BIT, gpu::MemoryUse::Device)),
          ltcTable_(uploadLtcTable(context.device()))
    {
    }

    Prepared prepare(const TimedVariant& v)
    {
        const gpu::Device& device = context_.device();
        const auto key = std::pair(v.evaluation.lightType, v.lights);
        if (!lights_.count(key))
            lights_.emplace(
                key, uploadLights(device, lightsOf(v.evaluation.lightType, v.lights, settings_)));
        const bool isRival = v.evaluation.method.rival != Rival::None;
        Prepared out;
        out.kernel = gpu::Kernel<gpu::BenchParams>(
            device,
            isRival ? spirv::time_lights_comp_ltc : ofFamily(spirv::time_lights_comp, v.evaluation),
            {{gpu::SPEC_FOR_CPU, lighting::forCpu(device)},
             {gpu::SPEC_SPECULAR_METHOD, v.evaluation.method.specular},
             {gpu::SPEC_LIGHT_TYPE, v.evaluation.lightType},
             {gpu::SPEC_BENCH_EVALUATION, uint32_t(v.evaluationCase)}});
        out.bindings = out.kernel.createBindings(1);
        writeBindings(out.bindings, lights_.at(key), receivers_, output_,
                      isRival ? &ltcTable_ : nullptr);
        return out;
    }

    double milliseconds(const Prepared& p, const TimedVariant& v, uint32_t lights)
    {
        const gpu::BenchParams params{.count = settings_.lanes,
                                      .lightCount = lights,
                                      .sampleCount = v.evaluation.sampleCount};
        context_.submitAndWait([&](VkCommandBuffer cmd) {
            const gpu::Frame frame{context_.device(), cmd, timer_, 0};
            timer_.begin(cmd, 0);
            p.kernel.dispatch(frame, p.bindings.set(0), params,
                              gpu::divideUp(settings_.lanes, gpu::BENCH_GROUP));
        });
        CndKernelTime times[CND_MAX_KERNEL_TIMES];
        uint32_t count = 0;
        timer_.read(0, times, count);
        return count ? times[0].ms : 0;
    }

private:
    const VulkanContext& context_;
    TimingSettings settings_;
    gpu::Timer timer_;
    gpu::Buffer receivers_, output_, ltcTable_;
    std::map<std::pair<uint32_t, EvaluationCase>, DeviceLights> lights_;
};

} // namespace

const char* caseName(EvaluationCase c)
{
    static constexpr const char* names[] = {"above", "near", "general"};
    return names[uint32_t(c)];
}

std::vector<VariantTime> timeVariants(const VulkanContext& context,
                                      const std::vector<TimedVariant>& variants,
                                      const std::vector<int>& baseline,
                                      const TimingSettings& settings,
                                      const std::function<void()>& onRound)
{
    if (!context.device().limits.timestampComputeAndGraphics)
        return {};
    Bench bench(context, settings);
    std::vector<Prepared> prepared;
    for (const TimedVariant& v : variants) {
        prepared.push_back(bench.prepare(v));
        bench.milliseconds(prepared.back(), v,
                           settings.manyLights); // the first use compiles the kernel
    }
    const double pairs = double(settings.lanes) * (settings.manyLights - settings.fewLights);
    std::vector<std::vector<double>> ns(variants.size());
    for (uint32_t round = 0; round < settings.rounds; ++round) {
        for (size_t i = 0; i < variants.size(); ++i) {
            const double few = bench.milliseconds(prepared[i], variants[i], settings.fewLights);
            const double many = bench.milliseconds(prepared[i], variants[i], settings.manyLights);
            ns[i].push_back((many - few) * 1e6 / pairs);
        }
        onRound();
    }
    std::vector<VariantTime> out;
    for (size_t i = 0; i < variants.size(); ++i) {
        VariantTime t{.medianNs = medianOf(ns[i]),
                      .minNs = *std::ranges::min_element(ns[i]),
                      .roundsNs = ns[i],
                      .noisy = isNoisy(ns[i])};
        if (baseline[i] >= 0 && medianAboveNoise(ns[i]) &&
            medianAboveNoise(ns[size_t(baseline[i])])) {
            const PairedRatio r = pairedRatio(ns[size_t(baseline[i])], ns[i]);
            t.ratio = r.median;
            t.ratioLow = r.low;
            t.ratioHigh = r.high;
        }
        out.push_back(t);
    }
    return out;
}

} // namespace candelabra::app
