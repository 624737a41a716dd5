// SPDX-License-Identifier: Apache-2.0
// Runs a probe kernel (shaders/probes), which applies shipping shader functions to an array of
// inputs.
#pragma once

#include <algorithm>
#include <cmath>
#include <numbers>
#include <random>
#include <span>

#include <glm/vec3.hpp>

#include "gpu/kernel.h"
#include "harness/gpu_fixture.h"
#include "shared/probes.h"

namespace candelabra::test
{

class ProbeTest : public GpuTest
{
protected:
    double uniform(double low, double high)
    {
        return low + (high - low) * double(random_()) / 4294967296.0;
    }
    // Returns a unit vector in a random direction around the z axis.
    glm::dvec3 direction(double cosine)
    {
        const double azimuth = uniform(0, 2 * std::numbers::pi);
        const double sine = std::sqrt(std::max(0.0, 1 - cosine * cosine));
        return {sine * std::cos(azimuth), sine * std::sin(azimuth), cosine};
    }

    // Returns one output per input. The probe binds PROBE_INPUT, PROBE_OUTPUT and `more`, and takes
    // ProbeParams.
    template <typename Output, typename Input>
    std::vector<Output> runProbe(const gpu::Spirv& probe, const std::vector<Input>& inputs,
                                 std::initializer_list<gpu::SpecConstant> constants = {},
                                 std::span<const gpu::Binding> more = {})
    {
        const uint32_t count = uint32_t(inputs.size());
        const gpu::Buffer in = upload("probe inputs", inputs);
        const gpu::Buffer out = readback("probe outputs", count * sizeof(Output));
        const gpu::Kernel<gpu::ProbeParams> kernel(device(), probe, constants);
        const gpu::Bindings bindings = kernel.createBindings(1);
        const auto input = gpu::Binding::of(gpu::PROBE_INPUT, in);
        const auto output = gpu::Binding::of(gpu::PROBE_OUTPUT, out);
        bindings.write(0, {input, output}, more);
        gpu::Timer timer(device(), "probe", 1, false);
        context().submitAndWait([&](VkCommandBuffer cmd) {
            timer.begin(cmd, 0);
            kernel.dispatch(gpu::Frame{device(), cmd, timer, 0}, bindings.set(0), {count},
                            gpu::divideUp(count, gpu::PROBE_GROUP));
            fullBarrier(cmd);
        });
        const auto values = out.as<Output>();
        return {values.begin(), values.begin() + long(count)};
    }

    std::mt19937 random_;
};

} // namespace candelabra::test
