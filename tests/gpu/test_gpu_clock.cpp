// SPDX-License-Identifier: Apache-2.0
// Tests the mapping of the device's timestamps to the CPU's clock.
#include "harness/gpu_fixture.h"
#include "measure/profile/gpu_clock.h"

using namespace candelabra;
using namespace candelabra::app;

namespace
{

class GpuClockTest : public test::GpuTest
{
};

} // namespace

TEST_F(GpuClockTest, StampsLieBetweenSubmissionAndTheEndOfWaiting)
{
    ASSERT_GT(context().timestampValidBits(), 0u);
    FrameStamps stamps(context().device(), context().timestampValidBits(), 1, 1);
    for (const bool byExtension : {true, false}) {
        GpuClock clock(context(), byExtension);
        EXPECT_GT(clock.stampMs(), 0);
        EXPECT_LT(clock.stampMs(), 100);
        for (int i = 0; i < 5; ++i) {
            const CpuClock::time_point before = CpuClock::now();
            context().submitAndWait([&](VkCommandBuffer cmd) {
                stamps.begin(cmd, 0);
                stamps.stamp(cmd, 0);
            });
            const CpuClock::time_point after = CpuClock::now();
            clock.calibrate();
            const FrameStamps::Times times = stamps.read(0);
            ASSERT_EQ(times.endsMs.size(), 1u);
            const std::chrono::duration<double, std::milli> unsure(clock.uncertaintyMs());
            EXPECT_GE(clock.cpuTime(times.startMs) + unsure, before) << clock.method();
            EXPECT_LE(clock.cpuTime(times.startMs + times.endsMs[0]), after + unsure)
                << clock.method();
        }
    }
}
