// SPDX-License-Identifier: Apache-2.0
#include "lights/light_order.h"

#include <algorithm>
#include <bit>
#include <cmath>

#include "candelabra_shaders.h"
#include "shared/lighting_data.h"

namespace candelabra::lighting
{
namespace
{

using gpu::divideUp;

// Bits of the Morton code per axis. With the bits of type and size a key has 24 or 30 bits, which
// are sorted in 4 or 5 passes. Up to `coarseLights` lights the coarser grid is used, which has at
// least four cells per light.
constexpr uint32_t coarseAxisBits = 6, fineAxisBits = 8;
constexpr uint32_t coarseLights = 65536;

constexpr VkBufferUsageFlags storageUse = VK_BUFFER_USAGE_STORAGE_BUFFER_BIT;

uint32_t sumCount(uint32_t runs)
{
    return divideUp(gpu::SORT_DIGITS * runs, gpu::SORT_SUM);
}

} // namespace

LightOrder::LightOrder(const gpu::Device& device)
    : device_(&device),
      lanesTogether_(!device.lanesAreCpuVector),
      lightKeys_(device, spirv::light_keys_comp),
      count_(device, lanesTogether_ ? spirv::sort_count_comp : spirv::cpu_sort_lights_comp,
             {{gpu::SPEC_SORT_STEP, gpu::SORT_STEP_COUNT}}),
      sums_(device, lanesTogether_ ? spirv::sort_sums_comp : spirv::cpu_sort_lights_comp,
            {{gpu::SPEC_SORT_STEP, gpu::SORT_STEP_SUMS}}),
      offsets_(device, spirv::sort_offsets_comp),
      scatter_(device, lanesTogether_ ? spirv::sort_scatter_comp : spirv::cpu_sort_lights_comp,
               {{gpu::SPEC_SORT_STEP, gpu::SORT_STEP_SCATTER}})
{
}

LightOrder::State LightOrder::createState(uint32_t capacity, const gpu::Buffer& records) const
{
    const auto make = [&](const char* name, VkDeviceSize bytes, gpu::MemoryUse use) {
        return gpu::createBuffer(*device_, name, bytes, storageUse, use);
    };
    using enum gpu::MemoryUse;
    const uint32_t runs = divideUp(capacity, gpu::SORT_RUN);
    State s;
    s.keys[0] = make("light keys", capacity * sizeof(gpu::LightKey), Device);
    s.keys[1] = make("other light keys", capacity * sizeof(gpu::LightKey), Scratch);
    s.counts =
        make("sort counts", VkDeviceSize(gpu::SORT_DIGITS) * runs * sizeof(uint32_t), Scratch);
    s.sums = make("sort sums", sumCount(runs) * sizeof(uint32_t), Scratch);
    s.makeKeys = lightKeys_.createBindings(2);
    s.sort = offsets_.createBindings(2);
    using gpu::Binding;
    for (uint32_t i : {0u, 1u}) {
        s.makeKeys.write(i, {Binding::of(gpu::LIGHT_KEYS_RECORDS, records),
                             Binding::of(gpu::LIGHT_KEYS_KEYS, s.keys[i])});
        s.sort.write(
            i, {Binding::of(gpu::SORT_FROM, s.keys[i]), Binding::of(gpu::SORT_TO, s.keys[1 - i]),
                Binding::of(gpu::SORT_COUNTS, s.counts), Binding::of(gpu::SORT_SUMS, s.sums)});
    }
    return s;
}

void LightOrder::record(const gpu::Frame& frame, const State& s, const LightTypeCounts& counts,
                        const LightExtent& extent) const noexcept
{
    uint32_t lightCount = 0, types = 0;
    for (uint32_t type = 0; type < CND_LIGHT_TYPE_COUNT; ++type) {
        lightCount += counts[type];
        types |= uint32_t(counts[type] != 0) << type;
    }
    const uint32_t typeBits =
        std::max<uint32_t>(3, std::bit_width(uint32_t(std::popcount(types)) - 1));
    gpu::Timer untimed; // the whole sort is one row of the timer, stamped at its end
    const gpu::Frame f{frame.device, frame.cmd, untimed, frame.slot};
    const uint32_t axisBits = lightCount <= coarseLights ? coarseAxisBits : fineAxisBits;
    const uint32_t keyBits = typeBits + gpu::ORDER_SIZE_BITS + 3 * axisBits;
    const uint32_t passes = divideUp(keyBits, gpu::SORT_DIGIT_BITS);
    int exponent = 0;
    std::frexp(extent.size, &exponent);
    uint32_t from = passes % 2; // with this start the last pass writes keys[0]
    lightKeys_.dispatch(f, s.makeKeys.set(from),
                        {.low = {extent.low[0], extent.low[1], extent.low[2]},
                         .cellsPerMetre = float(1u << axisBits) / extent.size,
                         .lightCount = lightCount,
                         .axisBits = axisBits,
                         .largestExponent = exponent,
                         .types = types},
                        divideUp(lightCount, gpu::SORT_GROUP));
    gpu::SortParams params{.lightCount = lightCount,
                           .runCount = divideUp(lightCount, gpu::SORT_RUN)};
    // Dispatches groups for as many runs, or sums.
    const auto dispatch = [&](const gpu::Kernel<gpu::SortParams>& kernel, uint32_t count) {
        kernel.dispatchInRows(f, s.sort.set(from), params,
                              lanesTogether_ ? count : divideUp(count, gpu::SORT_GROUP));
    };
    for (uint32_t pass = 0; pass < passes; ++pass, from = 1 - from) {
        params.shift = pass * gpu::SORT_DIGIT_BITS;
        f.barrier();
        dispatch(count_, params.runCount);
        f.barrier();
        dispatch(sums_, sumCount(params.runCount));
        f.barrier();
        offsets_.dispatch(f, s.sort.set(from), params, 1);
        f.barrier();
        dispatch(scatter_, params.runCount);
    }
    f.barrier();
    frame.timer.stamp(frame.cmd, "light_order");
}

} // namespace candelabra::lighting
