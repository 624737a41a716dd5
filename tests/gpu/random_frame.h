// SPDX-License-Identifier: Apache-2.0
// A RandomFrame has any camera, size, depth convention and lights. Its seed decides them.
#pragma once

#include <cmath>
#include <cstdint>
#include <limits>
#include <random>
#include <vector>

#include "gpu/lighting_harness.h"

namespace candelabra::test
{

class RandomFrame
{
public:
    explicit RandomFrame(uint32_t seed) : random_(seed), seed_(seed) {}

    CpuGBuffer gbuffer()
    {
        const uint32_t width = 1 + uint32_t(uniform(0, 150)), height = 1 + uint32_t(uniform(0, 90));
        const double aspect = double(width) / height;
        CndCamera camera;
        const bool reversed = chance(0.7);
        const double near = std::pow(10, uniform(-3, 0));
        if (chance(0.2))
            setOrthographic(camera, uniform(1, 40), aspect, near, 100, reversed);
        else
            setPerspective(camera, uniform(0.02, 2.9), aspect, near, chance(0.5) ? 100 : 0,
                           reversed);
        return randomGBuffer(width, height, camera, reversed ? 0.0f : 1.0f, seed_);
    }
    std::vector<CndLight> lights(const CpuGBuffer& g)
    {
        auto lights = randomSpheres(g, uint32_t(std::pow(10, uniform(0, 3.3))), seed_);
        for (CndLight& light : lights) {
            // Some lights are tiny or huge, around the camera, or uncut.
            if (chance(0.1))
                light.radius *= float(std::pow(10, uniform(-4, 1)));
            light.influenceRadius = float(light.radius * std::pow(10, uniform(0.01, 2)));
            if (chance(0.02))
                light.influenceRadius = std::numeric_limits<float>::infinity();
            if (chance(0.02))
                light.position[0] = light.position[1] = light.position[2] = 0;
        }
        return lights;
    }

private:
    double uniform(double low, double high)
    {
        return low + (high - low) * double(random_()) / 4294967296.0;
    }
    bool chance(double p) { return uniform(0, 1) < p; }

    std::mt19937 random_;
    uint32_t seed_;
};

} // namespace candelabra::test
