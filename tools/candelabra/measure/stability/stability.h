// SPDX-License-Identifier: Apache-2.0
// Measures the numerical stability of the shader functions that the engine ships: whether any input
// gives an invalid response, how far the formulas are from quadrature on such inputs, and whether
// the response jumps. tests/gpu/test_sweep.cpp measures, on the inputs of the same sweep, how far
// float32 is from the same formulas in double precision (tools/formula).
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "io/report.h"
#include "io/table.h"
#include "measure/stability/sweep.h"

namespace candelabra::app
{

struct StabilitySettings {
    uint64_t configurations =
        20'000'000; // in all; distributed over light types, methods and slices
    uint32_t quadratureSamples = 100'000; // in all; distributed over light types and methods
    uint32_t sweeps = 200;                // per check of continuity
    uint32_t seed = 1;
    // The light types and the specular methods that are measured. An empty list stands for all.
    std::vector<uint32_t> lightTypes;
    std::vector<CndSpecularMethod> methods;
    uint32_t sampleCount = 4; // samples per light of the sampled method
    // True: quotients and roots are as inexact as Vulkan allows (inexact_division.h). Continuity is
    // not checked then, because such responses jump from float to float.
    bool inexactDivision = false;
};

// The counts of the sweep of one slice of the inputs with one evaluation.
struct SweptSlice {
    Evaluation evaluation;
    uint32_t slice;
    SweepCount count;
};

// The approximate response, with F = 1, to a light of half angle asin(s) on the mirror axis: L1 L2
// / sqrt((1 + L1^2) (1 + L2^2)) with L1 = s / 2 alpha and L2 = L1 / NoV. Errors are divided by it.
double onAxisResponse(double s, double alpha, double NoV);

// The errors of a formula against quadrature, relative to onAxisResponse, for eyes at least 1.1
// degrees above the horizon. Inputs in which receiver and emitter touch are compared for spheres
// only, and not at the sphere's centre, because the other shapes have no common definition there.
struct QuadratureCheck {
    Evaluation evaluation;
    size_t samples = 0;
    double mean = 0, p99 = 0, max = 0;
    double bar = 0; // the largest `max` allowed; 0: none, the method is a known approximation
    double diffuseMax = 0; // the largest error of the form factor, relative to the squared ratio of
                           // the emitter's bounding radius to its distance, which is at most 1
    std::string worst;     // slice and inputs of the largest error
    // True responses above the bound that responses are compared with, which would refute its
    // proof.
    size_t truthsAboveBound = 0;
    bool overBar() const { return truthsAboveBound > 0 || (bar > 0 && !(max <= bar)); }
};

// The largest jump of the response with F = 1 that remains after bisection down to neighbouring
// floats, relative to the response to the light in the mirror direction, facing the receiver.
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
    bool overBar() const; // whether any of `quadrature` is over its bar
};

Stability measureStability(const VulkanContext& context, const StabilitySettings& settings,
                           bool showProgress);

std::vector<ContinuityCheck> checkContinuity(const VulkanContext& context,
                                             const Evaluation& evaluation, uint32_t sweeps,
                                             uint64_t seed);

// The last table lists the jumps, and is long. It is left out if continuity was not checked.
std::vector<Table> stabilityTables(const Stability& stability);
Json stabilityJson(const StabilitySettings& settings, const Stability& stability);

} // namespace candelabra::app
