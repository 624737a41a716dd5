// SPDX-License-Identifier: Apache-2.0
// A hand-made host of the environment module: takes an image and returns the radiance of one frame.
#pragma once

#include <functional>
#include <vector>

#include "gpu/lighting_harness.h"

namespace candelabra::test
{

// An equirectangular image, rows from the top.
struct EnvironmentImage {
    uint32_t width = 0, height = 0;
    std::vector<glm::vec4> pixels;
};

// Luminance, grey, that arrives from a unit direction of the environment's space.
using Sky = std::function<double(const glm::dvec3& direction)>;

// Samples `sky` at the centre of every pixel.
EnvironmentImage imageOf(const Sky& sky, uint32_t width);

struct EnvironmentOptions {
    uint32_t cubeSize = 0;
    glm::dmat3 worldFromEnvironment{1};
    float scale = 1;
    bool background = false;
    CndLobeJoining lobes = CND_LOBES_CONSERVING;
    bool energyCompensation = false;
    float radianceBefore = 0; // initial radiance of every pixel and channel
};

class EnvironmentTest : public LightingTest
{
protected:
    void TearDown() override;
    // Prepares the environment of `image`, which is kept until the next call. Surfaces will use
    // CND_GBUFFER_HOST if `gbuffer` is given, `customLayout` if `custom` is given, else
    // CND_GBUFFER_FULL.
    void setImage(const EnvironmentImage& image, uint32_t cubeSize = 0,
                  const CndGBufferDesc* gbuffer = nullptr, const CndHostKernels* custom = nullptr,
                  CndGBufferLayout customLayout = CND_GBUFFER_CUSTOM);
    // Replaces the object by one that has prepared nothing. Size, frames in flight and timestamps
    // are filled in.
    void createEnvironment(CndEnvironmentDesc desc);
    std::vector<glm::vec4> shade(const CpuGBuffer& g, const EnvironmentOptions& options = {});
    CndEnvironmentFrame environmentFrame(const CpuGBuffer& g, const Images& images,
                                         const EnvironmentOptions& options) const;
    // Returns why tests that compare what the environment reflects cannot pass on this driver, or
    // null. SwiftShader reads black beyond the edges of a cube's faces in compute shaders: it fills
    // the texels there for draws only. A white environment then reflects down to 0.82 of its light.
    const char* whyNoReflections() const
    {
        return context().info().driver.starts_with("SwiftShader")
                   ? "SwiftShader does not filter across the edges of cube maps in compute shaders"
                   : nullptr;
    }
    CndEnvironment environment_ = nullptr;
};

} // namespace candelabra::test
