// SPDX-License-Identifier: Apache-2.0
// The passes of the light sort, in which a group of lanes works on a run of lights (for GPUs) or
// each lane on its own (for llvmpipe): both must sort as std::stable_sort does.
#include <algorithm>
#include <random>

#include "candelabra_shaders.h"
#include "gpu/kernel.h"
#include "harness/gpu_fixture.h"
#include "shared/light_order_data.h"
#include "shared/lighting_data.h"

namespace candelabra::test
{
namespace
{

constexpr uint32_t passes = 4;
using Keys = std::vector<gpu::LightKey>;

Keys randomKeys(uint32_t count)
{
    std::mt19937 random(count);
    Keys keys(count);
    // One key in eight is one of three, so that some digits of a run are frequent.
    for (uint32_t i = 0; i < count; ++i)
        keys[i] = {uint32_t(random() % 8 ? random() : random() % 3) % (1u << 24), i};
    return keys;
}

class LightOrderTest : public GpuTest
{
protected:
    // Sorts by keys of 24 bits.
    Keys sorted(const Keys& keys, bool lanesTogether);
};

Keys LightOrderTest::sorted(const Keys& keys, bool lanesTogether)
{
    using namespace gpu;
    const auto make = [&](const Spirv& ofGroups, uint32_t step) {
        return Kernel<SortParams>(device(), lanesTogether ? ofGroups : spirv::cpu_sort_lights_comp,
                                  {{SPEC_SORT_STEP, step}});
    };
    const auto count = make(spirv::sort_count_comp, SORT_STEP_COUNT);
    const auto addUp = make(spirv::sort_sums_comp, SORT_STEP_SUMS);
    const Kernel<SortParams> offsets(device(), spirv::sort_offsets_comp);
    const auto scatter = make(spirv::sort_scatter_comp, SORT_STEP_SCATTER);
    SortParams params{.lightCount = uint32_t(keys.size()),
                      .runCount = divideUp(uint32_t(keys.size()), SORT_RUN)};
    const uint32_t sumCount = divideUp(SORT_DIGITS * params.runCount, SORT_SUM);
    const Buffer buffers[] = {upload("keys", keys), upload("other keys", keys)};
    const Buffer counts = readback("counts", SORT_DIGITS * params.runCount * sizeof(uint32_t));
    const Buffer sums = readback("sums", sumCount * sizeof(uint32_t));
    const Bindings sets = offsets.createBindings(2);
    for (uint32_t i : {0u, 1u})
        sets.write(i, {Binding::of(SORT_FROM, buffers[i]), Binding::of(SORT_TO, buffers[1 - i]),
                       Binding::of(SORT_COUNTS, counts), Binding::of(SORT_SUMS, sums)});
    Timer timer(device(), "sort", 1, false);
    context().submitAndWait([&](VkCommandBuffer cmd) {
        timer.begin(cmd, 0);
        const Frame f{device(), cmd, timer, 0};
        // In two rows: many lights have more groups than one row.
        const auto dispatch = [&](const Kernel<SortParams>& kernel, VkDescriptorSet set,
                                  uint32_t shares) {
            const uint32_t groups = lanesTogether ? shares : divideUp(shares, SORT_GROUP);
            kernel.dispatch(f, set, params, divideUp(groups, 2), 2);
            fullBarrier(cmd);
        };
        for (uint32_t pass = 0; pass < passes; ++pass) {
            params.shift = pass * SORT_DIGIT_BITS;
            dispatch(count, sets.set(pass % 2), params.runCount);
            dispatch(addUp, sets.set(pass % 2), sumCount);
            offsets.dispatch(f, sets.set(pass % 2), params, 1);
            fullBarrier(cmd);
            dispatch(scatter, sets.set(pass % 2), params.runCount);
        }
    });
    const auto out = buffers[passes % 2].as<LightKey>();
    return Keys(out.begin(), out.end());
}

} // namespace

TEST_F(LightOrderTest, GroupsAndLanesSortStably)
{
    for (const uint32_t count : {1, 63, 64, 65, 255, 256, 257, 4000, 70001}) {
        Keys expected = randomKeys(count);
        const Keys byGroups = sorted(expected, true), byLanes = sorted(expected, false);
        std::ranges::stable_sort(expected, {}, &gpu::LightKey::key);
        const size_t bytes = count * sizeof(gpu::LightKey);
        EXPECT_EQ(std::memcmp(byGroups.data(), expected.data(), bytes), 0) << count;
        EXPECT_EQ(std::memcmp(byLanes.data(), expected.data(), bytes), 0) << count;
    }
}

} // namespace candelabra::test
