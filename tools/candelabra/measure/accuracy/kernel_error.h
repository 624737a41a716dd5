// SPDX-License-Identifier: Apache-2.0
// The errors of one specular method on a sample set.
#pragma once

#include <span>
#include <string>
#include <vector>

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

struct KernelError {
    HorizonStatistics mirror; // F = 1
    // The mean of `mirror.all` of each group that has such samples. Samples of one group are alike,
    // so an interval of the error is one over groups.
    std::vector<double> groupMeans;
    HorizonStatistics dielectric; // F0 = 0.04
    HorizonStatistics diffuse;    // errors of the form factor
    // The relative L1 error over the scan through the plane of incidence, averaged over the groups.
    double scanL1 = 0;
    // The largest response to a light wholly below the horizon, divided by the highest true
    // response of its group.
    double leak = 0;
    size_t invalid = 0; // responses that are NaN, infinite or negative, which no statistic includes
};

// `responses` holds the shader's response to every sample of the set.
KernelError kernelError(const SampleSet& set, std::span<const gpu::BenchResponse> responses);

Json toJson(const KernelError& error);
// Returns "mean / p99 / largest" in percent, or "-" without samples.
std::string meanP99Max(const ErrorStatistics& s);
// Describes in words what is special about a sample.
std::string describeSample(const SampleSet& set, size_t i);

} // namespace candelabra::app
