// SPDX-License-Identifier: Apache-2.0
// Error against time of every method for every light type, on explicit receivers and lights.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "io/progress.h"
#include "io/table.h"
#include "measure/accuracy/kernel_error.h"
#include "measure/accuracy/kernel_time.h"
#include "scene/light_types.h"

namespace candelabra::app
{

struct KernelLevelSettings {
    std::vector<uint32_t> lightTypes = areaLightTypes();
    uint32_t groups = 300; // of spheres; other types have a third, at least 20
    uint64_t seed = 1;
    double truthTolerance = 1e-6;
    uint32_t sampleCount = 16; // of the sampled method, for time and error
    TimingSettings timing;
};

// One method for one light type.
struct KernelPoint {
    uint32_t lightType;
    MeasuredMethod method;
    KernelError error;
    std::string worst; // what is special about the worst sample with F = 1
    struct Case {
        EvaluationCase evaluationCase;
        VariantTime both; // diffuse and specular; ratio: to karis
        // Both less diffuse alone; none if that is below the noise.
        std::optional<double> specularNs;
    };
    std::vector<Case> cases; // empty without timestamps
};

struct KernelLevel {
    std::vector<KernelPoint> points;
    size_t unconvergedTruths = 0; // samples whose quadrature did not reach the tolerance
    size_t samples = 0;
};

double kernelLevelSteps(const KernelLevelSettings& settings);
KernelLevel measureKernelLevel(const VulkanContext& context, const KernelLevelSettings& settings,
                               Progress& progress);

std::vector<Table> kernelTables(const KernelLevel& level);
Json kernelJson(const KernelLevelSettings& settings, const KernelLevel& level);
// Mean error against nanoseconds, above the horizon; one series per light type.
std::string kernelPlot(const KernelLevel& level, const DeviceInfo& device);

} // namespace candelabra::app
