// SPDX-License-Identifier: Apache-2.0
// Tests that the committed benchmark results satisfy the schemas, and that violations are found.
// The commands themselves are run at small sizes in tests/gpu.
#include <filesystem>

#include <gtest/gtest.h>

#include "harness/json_schema.h"
#include "harness/paths.h"

namespace candelabra::test
{

namespace
{

nlohmann::json committedResults(const std::string& name)
{
    return nlohmann::json::parse(
        std::ifstream(sourcePath("tools/bench/results/" + name + "llvmpipe-mesa-22.3.6.json")));
}

} // namespace

TEST(Schemas, CommittedResultsAreValid)
{
    const struct {
        const char *schema, *results;
    } cases[] = {{"stress", ""},
                 {"bench_accuracy", "accuracy-"},
                 {"bench_culling", "culling-"},
                 {"bench_skip", "skip-"},
                 {"bench_stability", "stability-"}};
    for (const auto& [name, file] : cases) {
        const JsonSchema schema(std::string(name) + ".schema.json");
        nlohmann::json json = committedResults(file);
        json["schema"] = schema.name(); // results from before the schemas do not name theirs
        EXPECT_EQ(schema.fault(json), "") << name;
        json.erase("provenance");
        EXPECT_NE(schema.fault(json), "") << name;
    }
}

TEST(Schemas, SayNothingThatIsNotChecked)
{
    int schemas = 0;
    for (const auto& file :
         std::filesystem::directory_iterator(sourcePath("tools/candelabra/schemas"))) {
        EXPECT_EQ(JsonSchema(file.path().filename()).unknownKeyword(), "") << file.path();
        ++schemas;
    }
    EXPECT_GE(schemas, 10);
}

TEST(Schemas, FiguresHaveBounds)
{
    const JsonSchema schema("render.schema.json");
    const auto faultOf = [&](double maxError) {
        return schema.faultOfPart({{"maxError", maxError},
                                   {"largestError", 0},
                                   {"meanError", 0},
                                   {"cutBelowLux", 0},
                                   {"bruteForceMs", 0}},
                                  "#/properties/influence");
    };
    EXPECT_EQ(faultOf(0.5), "");
    EXPECT_EQ(faultOf(1), "");
    EXPECT_NE(faultOf(1.5), "");
    EXPECT_NE(faultOf(0), "");
}

TEST(Schemas, ReportsHoldTheFiguresOfTheirCommands)
{
    const JsonSchema schema("report.schema.json");
    nlohmann::json report{{"schema", schema.name()},
                          {"provenance", committedResults("skip-")["provenance"]}};
    for (const char* part : {"accuracy", "culling", "skip", "stability"}) {
        report[part] = committedResults(std::string(part) + "-");
        report[part].erase("provenance");
        report[part].erase("schema");
    }
    EXPECT_EQ(schema.fault(report), "");
    report["culling"]["points"][0]["tiles"] = -1;
    EXPECT_NE(schema.fault(report).find("tiles"), std::string::npos) << schema.fault(report);
}

} // namespace candelabra::test
