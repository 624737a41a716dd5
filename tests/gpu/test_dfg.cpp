// SPDX-License-Identifier: Apache-2.0
// Tests the directional albedo table against double-precision quadrature, and the lobes joined with
// it in uniform surroundings.
#include <cmath>
#include <iostream>
#include <random>

#include "candelabra_probes.h"
#include "gpu/probe.h"
#include "reference/albedo.h"
#include "shared/dfg_probe.h"
#include "tables/dfg_table.h"

namespace candelabra::test
{
namespace
{

class Dfg : public ProbeTest
{
protected:
    // Fills a table and looks up all inputs.
    std::vector<gpu::DfgProbeOutput> lookUp(const std::vector<gpu::DfgProbeInput>& inputs)
    {
        const uint32_t count = uint32_t(inputs.size());
        const gpu::Buffer in = upload("probe inputs", inputs);
        const gpu::Buffer out = readback("probe outputs", count * sizeof(gpu::DfgProbeOutput));
        const gpu::Kernel<gpu::ProbeParams> kernel(device(), spirv::dfg_comp);
        const gpu::Bindings bindings = kernel.createBindings(1);
        tables::DfgTable table(device());
        bindings.write(0, {gpu::Binding::of(gpu::PROBE_INPUT, in),
                           gpu::Binding::of(gpu::PROBE_OUTPUT, out),
                           gpu::Binding::ofTexels(gpu::PROBE_TABLE, table.buffer())});
        gpu::Timer timer(device(), "probe", 1, false);
        context().submitAndWait([&](VkCommandBuffer cmd) {
            timer.begin(cmd, 0);
            const gpu::Frame frame{device(), cmd, timer, 0};
            table.recordFill(frame);
            frame.barrier();
            kernel.dispatch(frame, bindings.set(0), {count},
                            gpu::divideUp(count, gpu::PROBE_GROUP));
            fullBarrier(cmd);
        });
        const auto values = out.as<gpu::DfgProbeOutput>();
        return {values.begin(), values.begin() + long(count)};
    }
};

// Returns the share of uniform surroundings that the joined lobes reflect, summed as shading sums
// them; the table's own albedo is taken as exact.
double furnace(const gpu::DfgProbeOutput& o)
{
    const glm::vec2 s = o.directionalAlbedo;
    return double(o.albedo) + double(o.F0) * (double(s.x) - s.y) + double(o.F90) * s.y;
}

} // namespace

TEST_F(Dfg, MatchesDoubleQuadrature)
{
    std::mt19937 random(7);
    const auto uniform = [&] { return double(random()) / 4294967296.0; };
    std::vector<gpu::DfgProbeInput> inputs;
    for (int i = 0; i < 600; ++i) {
        const double alpha = std::pow(10.0, std::log10(0.002) * uniform());
        // A third anywhere, a third concentrated at grazing angles, a third around NoV = alpha.
        const double NoV = i % 3 == 0   ? uniform()
                           : i % 3 == 1 ? std::pow(uniform(), 4)
                                        : alpha * std::pow(4.0, 2 * uniform() - 1);
        inputs.push_back({.NoV = float(std::clamp(NoV, 1e-4, 1.0)), .alpha = float(alpha)});
    }
    for (const float NoV : {1e-4f, 1.0f})
        for (const float alpha : {0.002f, 0.04f, 1.0f})
            inputs.push_back({.NoV = NoV, .alpha = alpha});
    const auto outputs = lookUp(inputs);
    double worst = 0, sum = 0;
    size_t worstAt = 0;
    for (size_t i = 0; i < inputs.size(); ++i) {
        const double NoV = std::clamp(double(inputs[i].NoV), 1e-4, 1.0);
        const reference::DirectionalAlbedo expected =
            reference::specularAlbedo(NoV, std::clamp(double(inputs[i].alpha), 0.002, 1.0), 1e-5);
        const glm::vec2 albedo = outputs[i].directionalAlbedo;
        const double error =
            std::max(std::abs(albedo.x - expected.a), std::abs(albedo.y - expected.b));
        sum += error;
        if (!(error <= worst)) {
            worst = error;
            worstAt = i;
        }
    }
    std::cout << "directional albedo: largest error " << worst << " at alpha "
              << inputs[worstAt].alpha << " NoV " << inputs[worstAt].NoV << ", mean "
              << sum / double(inputs.size()) << "\n";
    EXPECT_LE(worst, gpu::DFG_ERROR);
}

TEST_F(Dfg, JoinedLobesAreAWhiteFurnace)
{
    std::vector<gpu::DfgProbeInput> metals, dielectrics, sums;
    for (const float alpha : {0.04f, 0.1f, 0.3f, 0.6f, 1.0f})
        for (const float NoV : {0.01f, 0.05f, 0.2f, 0.5f, 0.8f, 1.0f}) {
            metals.push_back({NoV, alpha, 0, 1, 1, gpu::LOBES_CONSERVING, 1});
            for (const gpu::uint compensation : {0u, 1u})
                dielectrics.push_back(
                    {NoV, alpha, 1, 0.04f, 1, gpu::LOBES_CONSERVING, compensation});
            sums.push_back({NoV, alpha, 1, 0.04f, 1, gpu::LOBES_SUM, 0});
        }
    double worst = 0;
    for (const auto& inputs : {metals, dielectrics})
        for (const gpu::DfgProbeOutput& o : lookUp(inputs)) {
            worst = std::max(worst, std::abs(furnace(o) - 1));
            EXPECT_LE(furnace(o), 1 + 1e-3);
        }
    std::cout << "white furnace of the joined lobes: largest difference to 1 is " << worst << "\n";
    EXPECT_LE(worst, 1e-5);
    // Summed lobes leave the diffuse lobe unchanged.
    const auto summed = lookUp(sums);
    for (const gpu::DfgProbeOutput& o : summed) {
        EXPECT_EQ(o.albedo, 1);
        EXPECT_EQ(o.F0, 0.04f);
        EXPECT_EQ(o.F90, 1);
        EXPECT_GT(furnace(o), 1);
    }
}

// For any material in [0, 1] and any view the reflected share is never above 1 and never negative,
// and without a lobe nothing is reflected.
TEST_F(Dfg, NoMaterialReflectsMoreThanThereIs)
{
    std::vector<gpu::DfgProbeInput> inputs;
    for (const float alpha : {0.0f, 0.002f, 0.0447f, 0.5f, 1.0f})
        for (const float NoV : {0.0f, 1e-4f, 1e-3f, 0.03f, 0.4f, 1.0f})
            for (const float F0 : {0.0f, 0.04f, 0.5f, 1.0f})
                for (const float F90 : {0.0f, 0.5f, 1.0f})
                    for (const float albedo : {0.0f, 0.5f, 1.0f})
                        for (const gpu::uint compensation : {0u, 1u})
                            inputs.push_back(
                                {NoV, alpha, albedo, F0, F90, gpu::LOBES_CONSERVING, compensation});
    const auto outputs = lookUp(inputs);
    double most = 0;
    for (size_t i = 0; i < inputs.size(); ++i) {
        const double total = furnace(outputs[i]);
        ASSERT_TRUE(total >= 0 && outputs[i].albedo >= 0) << i;
        most = std::max(most, total);
        if (inputs[i].F0 == 0 && inputs[i].F90 == 0) {
            EXPECT_EQ(outputs[i].albedo, inputs[i].albedo);
        }
    }
    std::cout << "most that any material reflects: " << most << "\n";
    EXPECT_LE(most, 1 + 1e-3);
}

} // namespace candelabra::test
