// SPDX-License-Identifier: Apache-2.0
// Checks in small frames of the benchmark that no skipped pass changes the image.
#include "harness/full_tests.h"
#include "harness/gpu_fixture.h"
#include "harness/json_schema.h"
#include "measure/skip.h"

using namespace candelabra;
using namespace candelabra::app;

namespace
{

class BenchSkip : public test::GpuTest
{
protected:
    // Checks every row in frames of the specular method, and returns the rows.
    std::vector<SkipRow> rowsOf(CndSpecularMethod specular)
    {
        settings_.specular = specular;
        Progress progress(1, false);
        std::vector<SkipRow> rows = measureSkips(context(), settings_, progress);
        EXPECT_EQ(rows.size(), 12u);
        for (const SkipRow& row : rows) {
            EXPECT_LE(row.difference, row.bound) << row.name;
            EXPECT_EQ(row.with.frames(), row.without.frames()) << row.name;
            EXPECT_GT(row.without.total().medianMs, 0) << row.name;
        }
        return rows;
    }

    SkipSettings settings_{.size = {200, 120}, .lights = 300, .rounds = 2, .pointRounds = 1};
};

} // namespace

TEST_F(BenchSkip, ImagesAreThoseOfFramesThatSkipNothing)
{
    // Without a GPU, creating the pipelines of the thirty lighting modules takes most of the time,
    // and this method's take the least.
    const std::vector<SkipRow> rows = rowsOf(CND_SPECULAR_KARIS);
    ASSERT_FALSE(rows.empty());
    EXPECT_EQ(rows[0].with.total().medianMs, 0); // the row without lights
    EXPECT_TRUE(skipFailures(rows).empty());
    const auto json = nlohmann::json::parse(skipJson(settings_, rows).dump());
    EXPECT_EQ(json["skips"].size(), rows.size());
    EXPECT_EQ(test::schemaFaults(json["skips"], "bench_skip.schema.json", "#/properties/skips"),
              "");
    EXPECT_NE(skipTable(rows).find("manual exposure"), std::string::npos);

    std::vector<SkipRow> wrong = rows;
    wrong[0].difference = 1e-3;
    EXPECT_EQ(skipFailures(wrong).size(), 1u);
}

// The specular method of the committed results.
TEST_F(BenchSkip, ImagesAreThoseOfFramesThatSkipNothingWithTheSlopeConic)
{
    if (!test::fullTests())
        GTEST_SKIP() << "too slow without a GPU; tools/test --full runs it";
    EXPECT_TRUE(skipFailures(rowsOf(CND_SPECULAR_CONIC)).empty());
}
