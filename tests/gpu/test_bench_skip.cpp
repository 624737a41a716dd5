// SPDX-License-Identifier: Apache-2.0
// Checks in small frames of the benchmark that no skipped pass changes the image.
#include "harness/full_tests.h"
#include "harness/gpu_fixture.h"
#include "measure/skip.h"

using namespace candelabra;
using namespace candelabra::app;

namespace
{

class BenchSkip : public test::GpuTest
{
};

} // namespace

TEST_F(BenchSkip, ImagesAreThoseOfFramesThatSkipNothing)
{
    const bool full = test::fullTests();
    const SkipSettings settings{.size = full ? PixelSize{200, 120} : PixelSize{100, 60},
                                .lights = full ? 300u : 150u,
                                .rounds = full ? 2u : 1u,
                                .pointRounds = 1};
    Progress progress(1, false);
    const std::vector<SkipRow> rows = measureSkips(context(), settings, progress);
    ASSERT_EQ(rows.size(), 12u);
    for (const SkipRow& row : rows) {
        EXPECT_LE(row.difference, row.bound) << row.name;
        EXPECT_EQ(row.with.frames(), row.without.frames()) << row.name;
        EXPECT_GT(row.without.total().medianMs, 0) << row.name;
    }
    EXPECT_EQ(rows[0].with.total().medianMs, 0); // the row without lights
    EXPECT_TRUE(skipFailures(rows).empty());
    const auto json = nlohmann::json::parse(skipJson(settings, rows).dump());
    EXPECT_EQ(json["skips"].size(), rows.size());
    EXPECT_NE(skipTable(rows).text().find("manual exposure"), std::string::npos);

    std::vector<SkipRow> wrong = rows;
    wrong[0].difference = 1e-3;
    EXPECT_EQ(skipFailures(wrong).size(), 1u);
}
