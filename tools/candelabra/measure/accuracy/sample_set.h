// SPDX-License-Identifier: Apache-2.0
// The stratified set of shaded points and lights on which methods are compared, with the truth.
#pragma once

#include <cstdint>
#include <functional>
#include <vector>

#include "candelabra/candelabra.h"
#include "reference/response.h"
#include "shared/bench.h"

namespace candelabra::app
{

enum class Horizon { Above, Crossing, Below };

struct LightSample {
    uint32_t group = 0;
    bool scan = false; // one of the group's scan through the plane of incidence
    Horizon horizon = Horizon::Above;
    reference::LightResponse truth;
};

// Element i of the three arrays belongs together; samples of a group are consecutive. Receivers are
// at the origin with the normal +z; lights emit 1 without a window.
struct SampleSet {
    uint32_t lightType = CND_LIGHT_SPHERE;
    uint32_t groups = 0;
    std::vector<gpu::BenchReceiver> receivers;
    std::vector<CndLight> lights;
    std::vector<LightSample> samples;

    double alphaOf(size_t i) const; // as the shader computes it from the perceptual roughness
};

constexpr uint32_t samplesPerGroup = 26 + 14 + 49;

// Factors of lights that are smaller or thinner than those of the usual set.
struct LightScale {
    double size = 1;      // of every length
    double thickness = 1; // in addition, of the shorter side or of a body's radius
};

// A group is one roughness (perceptual, stratified on [0.045, 1]), one view angle (uniform 0 to
// 88.85 degrees) and one emitter size (half angle s, log-uniform: spheres 0.1 to 80 degrees, other
// shapes 1 to 60), seen from 89 directions: 26 around the mirror direction at angles with the
// half-Cauchy distribution of scale s + 2 alpha, 14 with n . l uniform on [-sin s, 1], and 49
// evenly spaced in the plane of incidence, up to 3 (s + 2 alpha) from the mirror direction where
// that lies within the visible range. Shapes other than spheres keep their tilt to the direction in
// a group. The same seed gives the same set.
SampleSet makeSamples(uint32_t lightType, uint32_t groups, uint64_t seed, LightScale scale = {});

// Fills in the truth, to the relative tolerance, on every core. `onDone` hears how many more are
// done.
void integrateTruth(SampleSet& set, double relative, const std::function<void(size_t)>& onDone);

// The place of a light relative to the horizon of a receiver at the origin with the normal +z.
Horizon horizonOf(const CndLight& light);

} // namespace candelabra::app
