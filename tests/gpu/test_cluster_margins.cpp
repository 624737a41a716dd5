// SPDX-License-Identifier: Apache-2.0
// Bounds of clusters must hold their samples wherever another pipeline places them: Vulkan lets
// each pipeline's divisions be off by 2.5 ULP. No driver that we have differs by as much, so a
// probe moves the samples.
#include <cmath>
#include <iostream>
#include <numbers>
#include <random>

#include "candelabra_probes.h"
#include "gpu/lighting_harness.h"
#include "gpu/probe.h"
#include "shared/margins_probe.h"
#include "surfaces/projection.h"

namespace candelabra::test
{
namespace
{

constexpr glm::uvec2 imageSize = {1920, 1080};

std::vector<std::pair<const char*, CndCamera>> cameras()
{
    constexpr double deg = std::numbers::pi / 180, aspect = 16.0 / 9;
    std::vector<std::pair<const char*, CndCamera>> out{{"1 radian", {}}, {"170 degrees", {}},
                                                       {"1 degree", {}}, {"off-centre", {}},
                                                       {"finite", {}},   {"orthographic", {}}};
    setPerspective(out[0].second, 1, aspect, 0.1);
    setPerspective(out[1].second, 170 * deg, aspect, 0.01);
    setPerspective(out[2].second, deg, aspect, 0.1);
    setPerspective(out[3].second, 1, aspect, 0.1);
    out[3].second.clipFromView[8] = 0.9f;
    out[3].second.clipFromView[9] = -3.0f;
    setPerspective(out[4].second, 1, aspect, 0.1, 1000, false);
    setOrthographic(out[5].second, 20, aspect, 0.1, 1000);
    return out;
}

std::vector<gpu::MarginsProbeInput> inputsOf(const CndCamera& camera, float clearDepth,
                                             uint32_t count)
{
    std::mt19937 random(7);
    std::uniform_real_distribution<double> unit(0, 1);
    const gpu::Projection projection = surfaces::projectionOf(camera.clipFromView, clearDepth);
    std::vector<gpu::MarginsProbeInput> inputs(count);
    for (gpu::MarginsProbeInput& in : inputs) {
        in = {.projection = projection,
              .invImageSize = 1.0f / glm::vec2(imageSize),
              .pixel =
                  glm::uvec2(glm::dvec2(imageSize - 8u) * glm::dvec2(unit(random), unit(random))),
              .depth = depthAt(camera, std::pow(10.0, -0.5 + 3 * unit(random))),
              .depthRange = random() % 4 == 0 ? -0.5f : 1e-6f * float(unit(random)),
              .reach = float(std::pow(10.0, -3 + 4 * unit(random))),
              .seed = uint32_t(random())};
    }
    return inputs;
}

using ClusterMargins = ProbeTest;

} // namespace

TEST_F(ClusterMargins, HoldSamplesThatAnotherPipelineMoves)
{
    uint64_t missedIfNotWidened = 0;
    for (const auto& [name, camera] : cameras()) {
        const float clearDepth = std::string_view(name) == "finite" ? 1.0f : 0.0f;
        uint64_t reaching = 0, missed = 0, tooHigh = 0, high = 0;
        for (const gpu::MarginsProbeOutput& out : runProbe<gpu::MarginsProbeOutput>(
                 spirv::cluster_margins_comp, inputsOf(camera, clearDepth, 20000))) {
            reaching += out.reaching;
            missed += out.missed;
            missedIfNotWidened += out.missedIfNotWidened;
            tooHigh += out.tooHigh;
            high += out.high;
        }
        EXPECT_GT(reaching, 200000u) << name;
        EXPECT_EQ(missed, 0u) << name;
        EXPECT_EQ(tooHigh, 0u) << name;
        EXPECT_GT(high, 10000u) << name;
        std::cout << name << ": " << reaching << " lights reach a sample, " << high
                  << " spheres are found to be high\n";
    }
    // Without margins lights are lost, so the probe does move samples out of their bounds.
    EXPECT_GT(missedIfNotWidened, 1000u);
    std::cout << "lost without margins: " << missedIfNotWidened << "\n";
}

} // namespace candelabra::test
