// SPDX-License-Identifier: Apache-2.0
// Errors of the closed form for lights that are far thinner than long, or far smaller than distant.
// The terms of their outlines cancel (shaders/lib/outline), so rounding shows here first.
#pragma once

#include <cstdint>
#include <vector>

#include "io/progress.h"
#include "io/table.h"
#include "measure/accuracy/kernel_error.h"

namespace candelabra::app
{

struct ThinLightSettings {
    uint32_t groups = 50;
    uint64_t seed = 1;
    double truthTolerance = 1e-6;
};

struct ThinLightPoint {
    uint32_t lightType;
    LightScale scale;
    KernelError error;
};

double thinLightSteps(const ThinLightSettings& settings);
// Tubes, rectangles and polygons of the usual set, with one of both factors at 1, 1e-1 ... 1e-5.
std::vector<ThinLightPoint> measureThinLights(const VulkanContext& context,
                                              const ThinLightSettings& settings,
                                              Progress& progress);

Table thinLightTable(const std::vector<ThinLightPoint>& points);
Json thinLightJson(const ThinLightSettings& settings, const std::vector<ThinLightPoint>& points);

} // namespace candelabra::app
