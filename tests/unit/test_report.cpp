// SPDX-License-Identifier: Apache-2.0
// Tests tables, plots, parsing and output files of the program.
#include <cmath>
#include <filesystem>

#include <gtest/gtest.h>

#include "harness/temporary_folder.h"
#include "harness/xml.h"
#include "io/error.h"
#include "io/parse.h"
#include "io/report.h"
#include "io/svg_plot.h"
#include "io/table.h"
#include "render/pass_times.h"

using namespace candelabra;
using namespace candelabra::app;

TEST(Table, AlignsAndRefusesRaggedRows)
{
    Table table({"pass", "ms"});
    table.add({"a", "1.5"});
    table.add({"longer", "12.25"});
    EXPECT_EQ(table.text(), "pass       ms\n"
                            "------  -----\n"
                            "a         1.5\n"
                            "longer  12.25\n");
    EXPECT_THROW(table.add({"one"}), RunError);
}

TEST(Table, ThreeDigits)
{
    const std::pair<double, const char*> cases[] = {
        {0, "0"},           {1234.4, "1234"},   {99.96, "100"},
        {99.9, "99.9"},     {9.996, "10.0"},    {9.99, "9.99"},
        {0.9996, "1.00"},   {0.0512, "0.0512"}, {0.00123, "0.00123"},
        {1e-7, "1.00e-07"}, {2.5e7, "2.50e+07"}};
    for (const auto& [value, text] : cases)
        EXPECT_EQ(threeDigits(value), text) << value;
    EXPECT_EQ(grouped(7), "7");
    EXPECT_EQ(grouped(1000), "1,000");
    EXPECT_EQ(grouped(123456789), "123,456,789");
    EXPECT_EQ(groupedOrThreeDigits(53740.4), "53,740");
    EXPECT_EQ(groupedOrThreeDigits(1234567), "1,234,567");
    EXPECT_EQ(groupedOrThreeDigits(999.6), "1,000");
    EXPECT_EQ(groupedOrThreeDigits(12.34), "12.3");
    EXPECT_EQ(counted(0, "light"), "0 lights");
    EXPECT_EQ(counted(1, "light"), "1 light");
    EXPECT_EQ(counted(1000, "light"), "1,000 lights");
}

TEST(PassTimes, SummariesAreOrderStatistics)
{
    PassTimes times;
    for (int i = 20; i >= 1; --i) { // 1..20 ms in descending order
        const PassTime frame[] = {{"cull", 1}, {"shade", double(i)}};
        times.add(frame);
    }
    const auto passes = times.summary();
    ASSERT_EQ(passes.size(), 2u);
    EXPECT_EQ(passes[1].name, "shade");
    EXPECT_EQ(passes[1].minMs, 1);
    EXPECT_EQ(passes[1].medianMs, 10.5);
    EXPECT_EQ(passes[1].p95Ms, 19); // 19 of 20 frames do not exceed it
    EXPECT_EQ(times.total().minMs, 2);
    EXPECT_EQ(times.frames(), 20u);
}

TEST(PassTimes, PartsAreMediansOfSums)
{
    PassTimes times;
    EXPECT_EQ(times.medianMs(FramePart::Raster), 0);
    for (const double ms : {1.0, 5.0, 3.0}) {
        const PassTime frame[] = {{"raster", 10 * ms, 1, FramePart::Raster},
                                  {"cull", ms, 1, FramePart::Lighting},
                                  {"shade", 9 - ms, 1, FramePart::Lighting},
                                  {"tone_map", 2}};
        times.add(frame);
    }
    EXPECT_EQ(times.medianMs(FramePart::Raster), 30);
    EXPECT_EQ(times.medianMs(FramePart::Lighting), 9);
    EXPECT_EQ(times.medianMs(FramePart::Rest), 2);
}

TEST(PassTimes, PassMissingFromAFrameCountsAsZero)
{
    PassTimes times;
    const PassTime first[] = {{"a", 2}};
    const PassTime second[] = {{"b", 4}};
    times.add(first);
    times.add(second);
    const auto passes = times.summary();
    ASSERT_EQ(passes.size(), 2u);
    EXPECT_EQ(passes[0].medianMs, 1);
    EXPECT_EQ(passes[1].medianMs, 2);
    EXPECT_EQ(times.total().medianMs, 3);
    EXPECT_EQ(passName("shade_tiles.comp"), "shade_tiles");
}

TEST(Parse, WholeStringsOnly)
{
    EXPECT_EQ(parseUnsigned("42"), 42u);
    for (const char* bad : {"", "-1", "4294967296", "12x", " 1", "+1", "1.0"})
        EXPECT_FALSE(parseUnsigned(bad)) << bad;
    EXPECT_EQ(parseNumber("-1.5e2"), -150.0);
    EXPECT_EQ(parseNumber("+2"), 2.0);
    for (const char* bad : {"", "nan", "inf", "1,", "1e999", "0x10", "+-1"})
        EXPECT_FALSE(parseNumber(bad)) << bad;
    EXPECT_EQ(parseNumbers("1,2.5,-3")->size(), 3u);
    for (const char* bad : {"", "1,,2", "1,2,", "a"})
        EXPECT_FALSE(parseNumbers(bad)) << bad;
    EXPECT_EQ(parseSize("1280x720")->height, 720u);
    for (const char* bad : {"1280", "0x5", "5x0", "x", "1x2x3", "-1x2", "1 x2"})
        EXPECT_FALSE(parseSize(bad)) << bad;
}

TEST(SvgPlot, SlopeOneIsDrawnAsSlopeOne)
{
    // Two decades in x and in y on a log-log plot: equal steps between points.
    const std::string svg =
        logLogPlot({"t", "s", "x", "y"}, {{"series", {{10, 1}, {100, 10}, {1000, 100}}}});
    double x[3], y[3];
    size_t at = 0;
    for (int i = 0; i < 3; ++i) {
        at = svg.find("<circle", at + 1);
        ASSERT_NE(at, std::string::npos);
        ASSERT_EQ(std::sscanf(svg.c_str() + at, "<circle cx=\"%lf\" cy=\"%lf\"", &x[i], &y[i]), 2);
    }
    EXPECT_GT(x[1], x[0]);
    EXPECT_LT(y[1], y[0]); // the y axis of SVG points down
    EXPECT_NEAR(x[2] - x[1], x[1] - x[0], 0.2);
    EXPECT_NEAR(y[2] - y[1], y[1] - y[0], 0.2);
}

TEST(SvgPlot, SeriesWithoutMarkersAreDashedLines)
{
    const auto svg = [](bool marked) {
        return logLogPlot({}, {{"line", {{1, 5}, {9, 5}}, false, true, marked}});
    };
    EXPECT_NE(svg(true).find("<circle"), std::string::npos);
    EXPECT_EQ(svg(true).find("stroke-dasharray"), std::string::npos);
    EXPECT_EQ(svg(false).find("<circle"), std::string::npos);
    EXPECT_NE(svg(false).find("stroke-dasharray"), std::string::npos);
}

TEST(SvgPlot, SurvivesHardInput)
{
    const std::string svg = logLogPlot(
        {"a < b & c", "", "x", "y"},
        {{"\"q\"", {{1, 5}}}, {"none", {{0, 1}, {1, NAN}, {-1, INFINITY}}}, {"empty", {}}});
    EXPECT_NE(svg.find("a &lt; b &amp; c"), std::string::npos);
    EXPECT_NE(svg.find("&quot;q&quot;"), std::string::npos);
    EXPECT_EQ(svg.find("nan"), std::string::npos);
    EXPECT_EQ(svg.find("inf"), std::string::npos);
    EXPECT_NE(logLogPlot({}, {}).find("no measurement"), std::string::npos);
}

class FileTest : public ::testing::Test, protected test::TemporaryFolder
{
};

TEST_F(FileTest, TextAppearsWholeAndLeavesNothingElse)
{
    writeText(path("a.txt"), "one");
    writeText(path("a.txt"), "two\n");
    EXPECT_EQ(text("a.txt"), "two\n");
    size_t files = 0;
    for ([[maybe_unused]] const auto& entry : std::filesystem::directory_iterator(path()))
        ++files;
    EXPECT_EQ(files, 1u);
    EXPECT_THROW(writeText(path("missing/a.txt"), "x"), RunError);
}

TEST_F(FileTest, PlotsAreWellFormed)
{
    const std::string hard = "a < b & \"c\" > 'd' ]]> \xc2\xb5";
    const std::vector<PlotSeries> series = {
        {hard, {{1, 5}, {2, 7}}}, {"none", {{0, 1}, {1, NAN}}}, {"alone", {{3, 3}}, true, false}};
    for (const std::string& svg :
         {logLogPlot({hard, hard, hard, hard}, series), logLogPlot({}, {})}) {
        writeText(path("plot.svg"), svg);
        EXPECT_EQ(test::xmlFault(path("plot.svg")), "");
    }
    writeText(path("plot.svg"), "<svg><a></svg>");
    EXPECT_NE(test::xmlFault(path("plot.svg")), ""); // the check is able to fail
}

TEST_F(FileTest, UnwritablePlacesAreFoundBeforeTheWork)
{
    EXPECT_NO_THROW(requireWritable("-o", path("a.png")));
    EXPECT_NO_THROW(requireWritable("--json", "-"));
    EXPECT_THROW(requireWritable("-o", path()), UsageError);
    EXPECT_THROW(requireWritable("-o", path("missing/a.png")), UsageError);
    EXPECT_THROW(requireWritable("-o", ""), UsageError);
    EXPECT_THROW(requireWritable("--json", "/dev/null"), UsageError); // would be replaced by a file
}

TEST(Report, CommandLineCanBePastedBack)
{
    const char* argv[] = {"bin/candelabra", "render", "my scene.glb", "it's"};
    EXPECT_EQ(commandLine(4, argv), "candelabra render 'my scene.glb' 'it'\\''s'");
}
