// SPDX-License-Identifier: Apache-2.0
// A hand-made host of the exposure module: takes pictures and returns statistics and display
// images.
#pragma once

#include <cstdint>
#include <random>
#include <vector>

#include "harness/gpu_fixture.h"

namespace candelabra::test
{

// Radiance on the CPU: four floats per pixel, rows from the top.
struct Picture {
    uint32_t width = 0, height = 0;
    std::vector<float> rgba;
};

Picture flatPicture(uint32_t width, uint32_t height, float value);
Picture greyPicture(uint32_t width, uint32_t height, const std::vector<float>& values);

// Log-uniform in 1e-10..1e10; a fifth are special values: bin edges and their neighbours,
// denormals, zeros, negative values, infinities, NaN.
float wildValue(std::mt19937& random);
Picture wildPicture(uint32_t width, uint32_t height, uint32_t seed);

double uniform(std::mt19937& random); // [0, 1)

// Automatic exposure, all pixels weighted equally, no dithering.
CndExposureSettings plainSettings();
CndExposureSettings manualSettings(float ev100, CndToneMap curve);

class ExposureTest : public GpuTest
{
protected:
    static constexpr uint32_t slotCount = 3;

    void SetUp() override;
    void TearDown() override;

    gpu::Image toDevice(const Picture& picture) const;               // in SHADER_READ_ONLY_OPTIMAL
    gpu::Image createDisplay(uint32_t width, uint32_t height) const; // in GENERAL
    CndExposureFrame frameOf(const gpu::Image& radiance, const CndExposureSettings& settings) const;
    void record(VkCommandBuffer cmd, const CndExposureFrame& frame) const;
    // Records the frame, submits it and waits.
    CndExposureStats run(const CndExposureFrame& frame) const;
    CndExposureStats stats(uint32_t slot) const;
    // Measures a single frame with `reset`.
    CndExposureStats measure(const Picture& picture, const CndExposureSettings& settings) const;
    // Returns the display image, four bytes per pixel.
    std::vector<uint8_t> display(const Picture& picture, const CndExposureSettings& settings,
                                 uint32_t seed = 0) const;

    CndExposure exposure_ = nullptr;
};

} // namespace candelabra::test
