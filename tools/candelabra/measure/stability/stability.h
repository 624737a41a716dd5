// SPDX-License-Identifier: Apache-2.0
// Numerical stability of the shipping shader functions: no invalid response to any input, how far
// the formulas are from quadrature on such inputs, and no jumps. How far float32 is from the same
// formulas in double, on the inputs of this sweep, is the business of tests/gpu/test_sweep.cpp: the
// double transcriptions live there.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "io/progress.h"
#include "io/report.h"
#include "measure/stability/sweep.h"

namespace candelabra::app
{

struct StabilitySettings {
    uint64_t configurations = 20'000'000; // shared by all light types, methods and slices
    uint32_t quadratureSamples = 100'000; // counted; shared by light types and methods
    uint32_t sweeps = 200;                // of every continuity check
    uint32_t seed = 1;
    uint32_t sampleCount = 4; // of the sampled method
};

struct SweptSlice {
    Evaluation evaluation;
    uint32_t slice;
    SweepCount count;
};

// Response, F = 1, to a light of half angle asin(s) on the mirror axis, about: L1 L2 / sqrt((1 +
// L1^2) (1 + L2^2)) with L1 = s / 2 alpha, L2 = L1 / NoV. What errors are relative to.
double onAxisResponse(double s, double alpha, double NoV);

// Formula against quadrature for eyes at least 1.1 degrees above the horizon, relative to
// onAxisResponse. Where receiver and emitter touch, spheres only, and not from their very centre:
// the others have no common definition there.
struct QuadratureCheck {
    Evaluation evaluation;
    size_t samples = 0;
    double mean = 0, p99 = 0, max = 0;
    double bar = 0;        // what `max` must stay below; 0: a known approximation, has none
    double diffuseMax = 0; // of the form factor, relative to (reach / distance)^2, at most 1
    std::string worst;     // slice and inputs
    bool overBar() const { return bar > 0 && !(max <= bar); }
};

// Largest jump of the response with F = 1 that remains after bisection down to neighbouring floats,
// relative to onAxisResponse.
struct ContinuityCheck {
    Evaluation evaluation;
    std::string through;
    double jump = 0;
    std::string worst;
};

struct Stability {
    std::vector<SweptSlice> slices;
    std::vector<QuadratureCheck> quadrature;
    std::vector<ContinuityCheck> continuity;

    uint64_t tried() const;
    uint64_t invalid() const;
    bool overBar() const; // any of `quadrature`
};

double stabilitySteps(const StabilitySettings& settings);
Stability measureStability(const VulkanContext& context, const StabilitySettings& settings,
                           Progress& progress);

std::vector<ContinuityCheck> checkContinuity(const VulkanContext& context,
                                             const Evaluation& evaluation, uint32_t sweeps,
                                             uint64_t seed);

std::string stabilityTables(const Stability& stability);
Json stabilityJson(const StabilitySettings& settings, const Stability& stability);

} // namespace candelabra::app
