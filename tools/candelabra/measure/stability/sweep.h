// SPDX-License-Identifier: Apache-2.0
// Runs the light evaluation that the engine ships on random and adversarial inputs, which the
// device generates itself (shaders/bench/sweep_inputs.comp).
#pragma once

#include <functional>
#include <string>
#include <vector>

#include "measure/kernels/light_kernels.h"

namespace candelabra::app
{

constexpr uint32_t sweepSliceCount = 12;
const char* sliceText(uint32_t slice);

struct SweepCount {
    uint64_t tried = 0, nan = 0, infinite = 0, negative = 0;
    uint64_t above = 0;                // brighter than such a light can be (gpu::SweepCounters)
    std::vector<gpu::SweepRecord> bad; // the first few inputs with an invalid response
    uint64_t invalid() const { return nan + infinite + negative + above; }
};

class Sweep
{
public:
    // `inexactDivision`: with quotients and roots that are as wrong as Vulkan allows.
    Sweep(const VulkanContext& context, const Evaluation& evaluation, uint32_t seed,
          bool inexactDivision = false);

    // Evaluates `configurations` inputs of a slice, from index `first` on, and counts the invalid
    // responses. `onDone` is called with the number of inputs each time some more are done.
    SweepCount count(uint32_t slice, uint32_t first, uint64_t configurations,
                     const std::function<void(uint64_t)>& onDone);
    // Returns the inputs from index `first` on with their responses. Emission is 1, and no window
    // is applied.
    std::vector<gpu::SweepRecord> record(uint32_t slice, uint32_t first, uint32_t configurations);

private:
    void dispatch(const gpu::SweepParams& params, const gpu::Buffer& records);

    const VulkanContext& context_;
    Evaluation evaluation_;
    uint32_t seed_;
    gpu::Kernel<gpu::SweepParams> kernel_;
    gpu::Bindings bindings_;
    gpu::Buffer counters_, bad_;
    gpu::Timer timer_;
};

// Returns the light of a record with its position relative to the shaded point, in float, as the
// shader computes it.
CndLight lightOf(const gpu::SweepRecord& record, uint32_t lightType);
// Describes a record in one line with all its numbers, from which it can be evaluated again.
std::string describeRecord(const gpu::SweepRecord& record);

} // namespace candelabra::app
