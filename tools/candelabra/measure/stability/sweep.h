// SPDX-License-Identifier: Apache-2.0
// The shipping shader evaluation under random and adversarial inputs that the device makes itself
// (shaders/bench/sweep_inputs.comp).
#pragma once

#include <functional>
#include <string>
#include <vector>

#include "measure/kernels/light_kernels.h"

namespace candelabra::app
{

constexpr uint32_t sweepSliceCount = 10;
const char* sliceText(uint32_t slice);

struct SweepCount {
    uint64_t tried = 0, nan = 0, infinite = 0, negative = 0;
    std::vector<gpu::SweepRecord> bad; // the first few
    uint64_t invalid() const { return nan + infinite + negative; }
};

class Sweep
{
public:
    Sweep(const VulkanContext& context, const Evaluation& evaluation, uint32_t seed);

    // `configurations` inputs of a slice, from index `first` on. `onDone` hears how many more.
    SweepCount count(uint32_t slice, uint32_t first, uint64_t configurations,
                     const std::function<void(uint64_t)>& onDone);
    // Inputs from index `first` on with what came out, emission 1, no window.
    std::vector<gpu::SweepRecord> record(uint32_t slice, uint32_t first, uint32_t configurations);

private:
    void dispatch(const gpu::Kernel<gpu::SweepParams>& kernel, const gpu::SweepParams& params,
                  const gpu::Buffer& records);

    const VulkanContext& context_;
    Evaluation evaluation_;
    uint32_t seed_;
    gpu::Kernel<gpu::SweepParams> counting_, recording_;
    gpu::Bindings bindings_;
    gpu::Buffer counters_, bad_, ltcTable_;
    gpu::Timer timer_;
};

// The light of a record relative to its shaded point, as the shader subtracts them.
CndLight lightOf(const gpu::SweepRecord& record, uint32_t lightType);
// One line with every number, enough to evaluate it again.
std::string describeRecord(const gpu::SweepRecord& record);

} // namespace candelabra::app
