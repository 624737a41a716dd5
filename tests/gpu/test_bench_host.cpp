// SPDX-License-Identifier: Apache-2.0
// Tests that bench host times every call, and what it writes.
#include "harness/gpu_fixture.h"
#include "harness/json_keys.h"
#include "measure/host/host.h"

using namespace candelabra;

namespace
{

class BenchHost : public test::GpuTest
{
};

} // namespace

TEST_F(BenchHost, TimesEveryCallForEveryNumberOfLights)
{
    const app::HostSettings settings{.lights = {1, 41}, .rounds = 2};
    app::Progress progress(1, false);
    const auto points = app::measureHost(context(), settings, progress);
    ASSERT_EQ(points.size(), 2u);
    const std::vector<std::string> names{"move", "set all", "update all", "update half"};
    for (const app::HostPoint& point : points) {
        ASSERT_EQ(point.calls.size(), names.size());
        for (size_t i = 0; i < names.size(); ++i) {
            const app::HostCall& call = point.calls[i];
            EXPECT_EQ(call.name, names[i]);
            EXPECT_EQ(call.written, i == 3 ? (point.lights + 1) / 2 : point.lights);
            EXPECT_EQ(call.ms.size(), 2u);
            EXPECT_EQ(call.memcpyMs.size(), 2u);
            EXPECT_EQ(call.recordingMs.size(), i == 0 ? 0u : 2u);
        }
    }
    const app::Json json = app::hostJson(settings, points);
    EXPECT_EQ(test::keyFaults(json["points"], "bench-host-points"), "");
    EXPECT_NE(app::hostTable(points).find("41, update half"), std::string::npos);
}
