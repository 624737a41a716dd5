// SPDX-License-Identifier: Apache-2.0
// Errors of one method on a sample set.
#pragma once

#include <span>
#include <string>
#include <vector>

#include "io/report.h"
#include "measure/accuracy/sample_set.h"
#include "measure/kernels/light_kernels.h"

namespace candelabra::app
{

// Of absolute errors relative to the highest true response of their group, as a fraction.
struct ErrorStatistics {
    size_t count = 0;
    double mean = 0, p95 = 0, p99 = 0, max = 0;
    size_t worst = 0; // index of the sample
};

struct HorizonStatistics {
    ErrorStatistics all, above, crossing; // all: both; samples below the horizon are not in it
};

struct KernelError {
    HorizonStatistics mirror;     // F = 1
    HorizonStatistics dielectric; // F0 = 0.04
    HorizonStatistics diffuse;    // of the form factor
    // Relative L1 over the scan through the plane of incidence, mean over the groups.
    double scanL1 = 0;
    double leak = 0;    // largest response to a light wholly below the horizon, relative likewise
    size_t invalid = 0; // NaN, infinite or negative responses; not in the statistics
};

// `responses`: of every sample of the set.
KernelError kernelError(const SampleSet& set, std::span<const gpu::BenchResponse> responses);

Json toJson(const KernelError& error);
// What is special about a sample, in words.
std::string describeSample(const SampleSet& set, size_t i);

} // namespace candelabra::app
