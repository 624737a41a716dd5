// SPDX-License-Identifier: Apache-2.0
// Measures what one evaluation of a light costs on the device, without everything else in the
// kernel.
#pragma once

#include <functional>
#include <string>
#include <vector>

#include "measure/kernels/light_kernels.h"

namespace candelabra::app
{

enum class EvaluationCase : uint32_t {
    Above = gpu::EVALUATE_ABOVE,
    Near = gpu::EVALUATE_NEAR,
    General = gpu::EVALUATE_GENERAL
};
const char* caseName(EvaluationCase c);

struct TimedVariant {
    std::string name;
    Evaluation evaluation;
    EvaluationCase evaluationCase = EvaluationCase::Above;
    EvaluationCase lights = evaluationCase; // the case whose lights are evaluated
};

struct VariantTime {
    // Per (pixel, light), with the whole device at work. Noise can make them negative.
    double medianNs = 0, minNs = 0;
    std::vector<double> roundsNs; // of every round
    // The median ratio to the variant's baseline in the same round; 0 without a baseline, and if
    // either time is below the noise.
    double ratio = 0;
    // An interval that holds the true median of that ratio (io/statistics.h).
    double ratioLow = 0, ratioHigh = 0;
    bool noisy = false; // the rounds' times are
};

struct TimingSettings {
    uint32_t lanes = 1u << 16;
    uint32_t fewLights = 8, manyLights = 40;
    uint32_t rounds = 15;
    uint64_t seed = 1;
};

// Every round runs every variant once with few and once with many lights. The cost of an evaluation
// is the difference of the two times divided by (manyLights - fewLights) * lanes. `baseline[i]` is
// the index of the variant that variant i is compared with, round by round, or -1. Returns nothing
// if the device has no timestamps. `onRound` is called after each round.
std::vector<VariantTime> timeVariants(const VulkanContext& context,
                                      const std::vector<TimedVariant>& variants,
                                      const std::vector<int>& baseline,
                                      const TimingSettings& settings,
                                      const std::function<void()>& onRound);

} // namespace candelabra::app
