// SPDX-License-Identifier: Apache-2.0
// The errors of one specular method on a sample set.
#pragma once

#include <optional>
#include <span>
#include <string>

#include "formula/formula.h"
#include "io/report.h"
#include "measure/accuracy/sample_set.h"
#include "measure/kernels/light_kernels.h"

namespace candelabra::app
{

// Statistics of absolute errors, each divided by the highest true response of its group.
struct ErrorStatistics {
    size_t count = 0;
    double mean = 0, p95 = 0, p99 = 0, max = 0;
    size_t worst = 0; // index of the sample
};

struct HorizonStatistics {
    // Above the horizon, across it, and both. Samples below the horizon are not included.
    ErrorStatistics all, above, crossing;
};

// Statistics over the samples that are not below the horizon: with F = 1, with F0 = 0.04, and of
// the form factor.
struct LobeStatistics {
    ErrorStatistics mirror, dielectric, diffuse;
};

// The two parts of an error: that of the formula, which is computed in double precision, against
// the truth; and what float32 adds, the difference between the shader's response and the formula.
struct ErrorParts {
    LobeStatistics formula, float32;
};

struct KernelError {
    HorizonStatistics mirror; // F = 1
    // The standard error of the mean of `mirror.all`, from the scatter between groups, because
    // samples of one group are similar. 0: there are fewer than two groups.
    double groupStandardError = 0;
    HorizonStatistics dielectric; // F0 = 0.04
    HorizonStatistics diffuse;    // errors of the form factor
    // The relative L1 error over the scan through the plane of incidence, averaged over the groups.
    double scanL1 = 0;
    // The largest response to a light wholly below the horizon, divided by the highest true
    // response of its group.
    double leak = 0;
    size_t invalid = 0; // responses that are NaN, infinite or negative, which no statistic includes
    std::optional<ErrorParts> parts; // competing methods have none
};

// `responses` holds the shader's response to every sample of the set; `inDouble` is empty, or holds
// what it would be without rounding.
KernelError kernelError(const SampleSet& set, std::span<const gpu::BenchResponse> responses,
                        std::span<const formula::Response> inDouble = {});

Json toJson(const KernelError& error);
// Returns "mean / p99 / largest" in percent, or "-" without samples.
std::string meanP99Max(const ErrorStatistics& s);
// Describes in words what is special about a sample.
std::string describeSample(const SampleSet& set, size_t i);

} // namespace candelabra::app
