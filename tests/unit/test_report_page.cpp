// SPDX-License-Identifier: Apache-2.0
// Tests the page of `candelabra report`: tables, sentences, terms and comparisons, on made-up
// results.

#include <fmt/format.h>
#include <gtest/gtest.h>

#include "harness/temporary_folder.h"
#include "harness/xml.h"
#include "io/html_page.h"
#include "measure/report/committed.h"
#include "measure/report/glossary.h"
#include "measure/report/report_page.h"
#include "measure/report/sentences.h"
#include "measure/report/weak_sides.h"

using namespace candelabra;
using namespace candelabra::app;

namespace
{

Contender contender(const char* name, const std::vector<double>& frames)
{
    Contender out{.name = name};
    for (const double ms : frames) {
        const PassTime pass{"shade_tiles", ms};
        out.times.add({&pass, 1});
    }
    return out;
}

// Candelabra takes about 10 ms, froxels `froxels` times as long.
CullingPoint point(double froxels, uint32_t lights = 4000)
{
    std::vector<double> engine, other, tiles, brute;
    for (int i = 0; i < 7; ++i) {
        engine.push_back(10 + 0.01 * i);
        other.push_back(froxels * (10 + 0.02 * i));
        tiles.push_back(40);
        brute.push_back(200);
    }
    CullingPoint out{
        .scene = "hall", .size = {480, 270}, .lights = lights, .overlaps = 8, .contenders = {}};
    out.contenders = {contender(engineName, engine), contender(tilesName, tiles),
                      contender(froxelsName, other), contender(bruteName, brute),
                      contender(floorName, engine)};
    return out;
}

KernelPoint kernelPoint(uint32_t type, const MeasuredMethod& method, double error)
{
    KernelPoint out{
        .lightType = type, .method = method, .error = {}, .worst = "alpha 0.5", .cases = {}};
    for (int i = 0; i < 10; ++i)
        out.error.groupMeans.push_back(error * (1 + 0.1 * i));
    out.error.mirror.all = {.count = 890, .mean = 1.45 * error, .max = 20 * error};
    out.cases.push_back(
        {.evaluationCase = EvaluationCase::Above,
         .both = {.medianNs = 3, .roundsNs = {3, 3}, .ratio = 2, .ratioLow = 1.9, .ratioHigh = 2.1},
         .specularNs = {}});
    return out;
}

KernelLevel kernels(double conic, double karis, double ltc)
{
    KernelLevel out;
    for (const uint32_t type : {CND_LIGHT_SPHERE, CND_LIGHT_DISC}) {
        out.points.push_back(kernelPoint(type, CND_SPECULAR_CONIC, conic));
        out.points.push_back(kernelPoint(type, CND_SPECULAR_KARIS, karis));
        out.points.push_back(kernelPoint(type, Rival::Ltc, ltc));
    }
    return out;
}

Stability stability(uint64_t invalid, double error)
{
    Stability out;
    SweptSlice slice{.evaluation = {}, .slice = 0, .count = {}};
    slice.count.tried = 1'000'000;
    slice.count.nan = invalid;
    out.slices.push_back(slice);
    out.quadrature.push_back({.evaluation = {}, .samples = 100, .max = error, .bar = 0.3});
    return out;
}

bool has(const std::string& text, const std::string& part)
{
    return text.find(part) != std::string::npos;
}

std::string page(double froxels)
{
    const std::vector<CullingPoint> points{point(froxels), point(froxels, 16000)};
    ReportPage out{
        .title = "a < b & c",
        .about = "About area lights.",
        .sentences = {speedSentence(points), accuracySentence(kernels(0.01, 0.1, 0.3), {})},
        .notes = {"a note < b"},
        .sections = {}};
    const DisplayImage image{2, 1, {{0, 0, 0}, {1, 1, 1}}};
    const std::vector<WipeChoice> choices{{"one", "truth", figure(image, "truth", "one")},
                                          {"two", "conic", figure(image, "conic", "two")},
                                          {"three", "flip", figure(image, "flip", "three")}};
    out.sections.push_back({.id = "culling",
                            .title = "Culling & <more>",
                            .intro = "Lists per froxel and tiles.",
                            .html = wipe(choices, 0, 1) + plotBox("<svg/>", "plot"),
                            .tables = cullingTables(points),
                            .command = "candelabra bench culling < a & b"});
    return htmlOf(out);
}

class ReportPageTest : public ::testing::Test, protected test::TemporaryFolder
{
};

} // namespace

TEST(ReportTable, HasUnitsMarksAndMeaningsInTextAndHtml)
{
    Table table({{"way", "", "How."}, {"time", "ms", "How long."}, Column::words("which", "")},
                "A < B");
    table.add({"quiet", "1.5", "x"}, {.key = "first"});
    table.rule();
    table.add({"loud", "12.25", "longer"}, {.noisy = true, .key = "second"});
    EXPECT_EQ(table.text().substr(0, table.text().find(noisyLegend())),
              "A < B\n"
              "way     time ms  which\n"
              "------  -------  ------\n"
              "quiet       1.5  x\n"
              "------  -------  ------\n"
              "loud ~    12.25  longer\n");
    EXPECT_FALSE(has(table.text(), contradictionLegend()));
    const std::vector<std::string> keys{"first"};
    table.markContradictions(keys);
    EXPECT_TRUE(has(table.text(), "quiet !"));
    EXPECT_TRUE(has(table.text(), contradictionLegend()));
    const std::string html = table.html();
    EXPECT_TRUE(has(html, "<caption>A &lt; B</caption>"));
    EXPECT_TRUE(has(html, "time<br/><small>ms</small>"));
    EXPECT_TRUE(has(html, "<th scope=\"row\">loud ~</th><td>12.25</td><td class=\"words\">"));
    EXPECT_TRUE(has(html, "<dt>time ms</dt><dd>How long.</dd>"));
    EXPECT_TRUE(has(html, "<tr class=\"ruled\">"));
    EXPECT_TRUE(has(html, contradictionLegend()));
}

TEST(ReportTable, NoisyMeansASpreadOfTheMiddleHalf)
{
    EXPECT_FALSE(isNoisy({100, 101, 102, 103, 104}));
    EXPECT_TRUE(isNoisy({100, 101, 110, 120, 121}));
    EXPECT_FALSE(isNoisy({100, 100, 100, 100, 500})); // one outlier is no noise of most
    EXPECT_FALSE(isNoisy({7}));
}

TEST(ReportSentences, SpeedSaysFasterOnlyWhereTheIntervalDoes)
{
    const std::string faster = speedSentence({point(1.5)});
    EXPECT_TRUE(has(faster, "brute force takes 20 [20, 20] times as long, so Candelabra is faster"))
        << faster;
    EXPECT_TRUE(has(faster, "faster in 1 of 1 configuration, slower in 0")) << faster;
    const std::string slower = speedSentence({point(0.5)});
    EXPECT_TRUE(has(slower, "faster in 0 of 1 configuration, slower in 1")) << slower;
    const std::string even = speedSentence({point(1)});
    EXPECT_TRUE(has(even, "not measurably different in 1")) << even;
    EXPECT_TRUE(has(speedSentence({}), "not measured"));
    CullingPoint few = point(2);
    for (Contender& c : few.contenders)
        c = contender(c.name.c_str(), {10, 10});
    EXPECT_TRUE(has(speedSentence({few}), "too few repeats")) << speedSentence({few});
}

// The ratio and its interval are of the same quotient.
TEST(ReportTable, CullingHasTheRatioWithinItsInterval)
{
    const std::string text = textOf(cullingTables({point(2)})); // froxels take twice as long
    EXPECT_TRUE(has(text, "95% interval")) << text;
    EXPECT_TRUE(has(text, " 0.50  0.50 .. 0.50 ")) << text;
    CullingPoint few = point(2);
    for (Contender& c : few.contenders)
        c = contender(c.name.c_str(),
                      c.name == froxelsName ? std::vector{20.0} : std::vector{10.0});
    EXPECT_FALSE(has(textOf(cullingTables({few})), ".."));
}

TEST(ReportTable, TimesThatNoiseHidesHaveNoNumber)
{
    KernelLevel level = kernels(0.01, 0.1, 0.3);
    level.points[0].cases[0].both = {.medianNs = -24.2, .roundsNs = {-24.2, -30, 5}};
    const std::string text = kernelTables(level)[1].text();
    EXPECT_TRUE(has(text, "below noise")) << text;
    EXPECT_FALSE(has(text, "-24.2")) << text;
}

TEST(ReportSentences, WhatWasDrawnOnceHasNoInterval)
{
    CullingPoint once = point(2);
    once.contenders[3] = contender(bruteName, {200});
    const PairedRatio r = once.toEngine(bruteName);
    EXPECT_NEAR(r.median, 200 / 10.03, 1e-9);
    EXPECT_FALSE(r.isKnown());
    EXPECT_TRUE(has(speedSentence({once}), "[too few repeats for an interval] times as long; "));
    EXPECT_TRUE(once.toEngine(froxelsName).isKnown());
}

TEST(ReportSentences, DeviceSaysWhatACpuMeansAndRepeatsNothing)
{
    RunFacts facts{.device = {.name = "llvmpipe (LLVM 15.0.6, 256 bits)",
                              .driver = "llvmpipe Mesa 22.3.6 (LLVM 15.0.6)"},
                   .version = "1",
                   .commit = "abc",
                   .parts = 2,
                   .wallSeconds = 3,
                   .processorSeconds = 4};
    facts.device.type = VK_PHYSICAL_DEVICE_TYPE_CPU;
    const std::string cpu = runSentence(facts);
    EXPECT_TRUE(has(cpu, "a CPU and no GPU, llvmpipe (LLVM 15.0.6, 256 bits) with the driver "
                         "llvmpipe Mesa 22.3.6; "))
        << cpu;
    facts.device = {.name = "A card", .driver = "a driver (570.1)"};
    facts.device.type = VK_PHYSICAL_DEVICE_TYPE_DISCRETE_GPU;
    const std::string gpu = runSentence(facts);
    EXPECT_TRUE(has(gpu, "A card (discrete GPU) with the driver a driver (570.1); 2 parts")) << gpu;
    EXPECT_FALSE(has(gpu, "CPU"));
}

// The sentence has the means of the table of errors, and what they are divided by each other.
TEST(ReportSentences, AccuracyHasTheMeansOfTheTable)
{
    const KernelLevel level = kernels(0.01, 0.1, 0.3);
    const std::string text = accuracySentence(level, {});
    EXPECT_TRUE(has(text, "sphere 1.45% \u00b1 ")) << text;
    EXPECT_TRUE(has(text, "that of LTC is 30.0 times as large")) << text;
    EXPECT_TRUE(has(text, "that of karis is 10.0 times as large")) << text;
    EXPECT_TRUE(has(text, ", disc 1.45%")) << text;
    EXPECT_TRUE(has(textOf(kernelTables(level)), "1.45 / ")) << textOf(kernelTables(level));
    EXPECT_TRUE(has(accuracySentence({}, {}), "not measured"));
    ImageScene scene{.name = "s", .about = {}, .truth = {}, .points = {}};
    scene.points.push_back({.method = CND_SPECULAR_CONIC, .error = {.flip = 0.0125}});
    scene.points.push_back({.method = Rival::Ltc, .error = {.flip = 0.25}});
    EXPECT_TRUE(has(accuracySentence(level, {scene}),
                    "(FLIP) is 0.0125 to 0.0125, with LTC 0.2500 to 0.2500."));
}

TEST(ReportSentences, WeakSidesAreTheWorstOfTheRun)
{
    WeakSideFacts facts{
        .kernels = kernels(0.01, 0.1, 0.3), .scenes = {}, .culling = {point(2), point(0.8, 1000)}};
    KernelPoint& disc = facts.kernels.points[3]; // conic
    disc.error.mirror.all.max = 0.777;
    disc.cases.push_back(
        {.evaluationCase = EvaluationCase::General,
         .both = {.roundsNs = {1}, .ratio = 3.5, .ratioLow = 3.4, .ratioHigh = 3.6},
         .specularNs = {}});
    facts.kernels.points[0].error.dielectric.all.max = 0.888;
    const std::string text = weaknessSentence(facts);
    EXPECT_TRUE(has(text, "up to 3.50 [3.40, 3.60] times as long as by karis (a disc across"))
        << text;
    EXPECT_TRUE(has(text, "77.7% of the brightest reflection on perfect metals (F = 1, disc) and "
                          "88.8% on plastic (F0 0.04, sphere)"))
        << text;
    EXPECT_TRUE(has(text, "1,000 lights Candelabra is slower than froxels")) << text;
    EXPECT_FALSE(has(text, "4,000 lights")) << text; // Candelabra is faster there
    EXPECT_TRUE(has(weaknessSentence({}), "was measured"));
}

TEST(ReportSentences, StabilityCountsAndBounds)
{
    const std::string good = stabilitySentence(stability(0, 0.1));
    EXPECT_TRUE(has(good, "of 1,000,000 random and adversarial inputs none gave")) << good;
    EXPECT_TRUE(has(good, "at most 3.00 in a million")) << good;
    EXPECT_TRUE(has(good, "is within the limit of 30.0%")) << good;
    const std::string bad = stabilitySentence(stability(2, 0.5));
    EXPECT_TRUE(has(bad, "inputs 2 gave")) << bad;
    EXPECT_TRUE(has(bad, "at most 6.30 in a million")) << bad; // the tabulated Poisson bound
    EXPECT_TRUE(has(bad, "EXCEEDS the limit of 30.0%")) << bad;
    EXPECT_TRUE(has(stabilitySentence({}), "not measured"));
}

TEST(ReportGlossary, IsSortedAndFindsWholeWordsOnce)
{
    for (size_t i = 1; i < glossary().size(); ++i) {
        const auto lower = [](std::string text) {
            for (char& c : text)
                c = char(std::tolower(static_cast<unsigned char>(c)));
            return text;
        };
        EXPECT_LT(lower(glossary()[i - 1].name), lower(glossary()[i].name));
    }
    TermFinder finder;
    EXPECT_TRUE(finder.firstIn("conical floorboards, alphabet").empty());
    ASSERT_EQ(finder.firstIn("sphere ltc, relMSE").size(), 2u);
    EXPECT_TRUE(finder.firstIn("LTC and relMSE").empty());
    EXPECT_EQ(finder.all().size(), 2u);
}

TEST_F(ReportPageTest, IsWellFormedAndTheSameForTheSameResults)
{
    const std::string text = page(1.5);
    write("page.html", text);
    EXPECT_EQ(test::xmlFault(path("page.html")), "");
    EXPECT_EQ(text, page(1.5));
    EXPECT_NE(text, page(0.5));
}

TEST_F(ReportPageTest, EveryTableScrollsAndEveryPictureHasWords)
{
    const std::string text = page(1.5);
    size_t tables = 0;
    for (size_t at = text.find("<table"); at != std::string::npos;
         at = text.find("<table", at + 1)) {
        ++tables;
        const size_t box = text.rfind("<div", at);
        EXPECT_TRUE(text.substr(box, at - box).starts_with("<div class=\"scroll\""));
    }
    EXPECT_EQ(tables, 2u);
    EXPECT_FALSE(has(text, "<pre"));
    for (size_t at = text.find("<img"); at != std::string::npos; at = text.find("<img", at + 1))
        EXPECT_TRUE(has(text.substr(at, text.find("/>", at) - at), "alt="));
}

TEST_F(ReportPageTest, TermsAreExplainedBeforeTheSectionsAndLinked)
{
    const std::string text = page(1.5);
    EXPECT_LT(text.find("id=\"term-brute-force\""), text.find("id=\"culling\""));
    EXPECT_GT(text.find("id=\"term-tiles\""), text.find("id=\"culling\""));
    EXPECT_TRUE(has(text, "<a href=\"#term-tiles\">"));
    EXPECT_FALSE(has(text, "term-relMSE")); // the page does not use it
}

TEST_F(ReportPageTest, LongTablesAreFoldedAndTermsExplainedOnce)
{
    ReportPage page{.title = {}, .about = {}, .sentences = {}, .notes = {}, .sections = {}};
    Table shown({{"first", ""}}, "Shown"), hidden({{"relMSE", ""}}, "Hidden");
    page.sections.push_back({.id = "one",
                             .title = {},
                             .intro = {},
                             .html = {},
                             .tables = {shown},
                             .command = {},
                             .details = {hidden}});
    const std::string text = htmlOf(page);
    EXPECT_LT(text.find("<caption>Shown"), text.find("<details>"));
    EXPECT_LT(text.find("<details><summary>Table: Hidden"), text.find("<caption>Hidden"));
    EXPECT_TRUE(has(text, "<a href=\"#term-relMSE\">relMSE</a>"));
    EXPECT_EQ(text.find("The mean over all pixels"), text.rfind("The mean over all pixels"));
    EXPECT_TRUE(has(text, "The mean over all pixels"));
}

TEST(ReportCommitted, OnlyWhatIsFarFromTheIntervalContradicts)
{
    const auto figure = [](double low, double high) {
        return ReportedFigure{"key", {(low + high) / 2, low, high}};
    };
    EXPECT_FALSE(contradicts(figure(0.9, 1.1), 1.3)); // 0.2 beyond, of 0.325 allowed
    EXPECT_TRUE(contradicts(figure(0.9, 1.1), 1.6));
    EXPECT_TRUE(contradicts(figure(0.9, 1.1), 0.6));
    EXPECT_FALSE(contradicts(figure(0.02, 0.04), 0.0)); // a ratio near 0
    EXPECT_FALSE(contradicts({"key", {1, 0, std::numeric_limits<double>::infinity()}}, 9));
    ReportedFigure error = figure(0.002, 0.004);
    error.allowance = 0;
    EXPECT_TRUE(contradicts(error, 0.01));
}

TEST_F(ReportPageTest, RowsThatContradictTheCommittedResultsAreFlagged)
{
    const DeviceInfo device{.name = "a device", .driver = "a driver"};
    const auto document = [](const char* driver, double ratio, uint32_t width = 480) {
        return fmt::format(
            "# device: a device\n# driver: {}\n"
            "scene,widthPixels,heightPixels,lights,overlaps,ratioToBestBaseline,bestBaseline\n"
            "hall,{},270,4000,8,{},\"tiles, or froxels\"\n",
            driver, width, ratio);
    };
    EXPECT_FALSE(readCommitted(path("missing"), device));
    write("culling-broken.csv", "# device: a device\n# driver: a driver\nscene,lights\nhall\n");
    write("culling-columns.csv", "# device: a device\n# driver: a driver\nscene\nhall\n");
    write("culling-head.csv", "scene\nhall\n");
    write("culling-word.csv", document("a driver", 3) + "hall,480,270,4000,8,much,froxels\n");
    write("culling-other.csv", document("another driver", 3));
    EXPECT_TRUE(readCommitted(path(), device)->figures.empty());
    write("culling-this.csv", document("a driver", 0.66));
    const std::vector<CullingPoint> points{point(1.5)};
    Comparison same = compareWithCommitted(figuresOf(points), *readCommitted(path(), device));
    EXPECT_EQ(same.compared, 1u);
    EXPECT_TRUE(same.contradictions.empty());
    write("culling-this.csv", document("a driver", 1.5));
    Comparison other = compareWithCommitted(figuresOf(points), *readCommitted(path(), device));
    ASSERT_EQ(other.contradictions.size(), 1u);
    EXPECT_TRUE(other.omission.empty());
    write("culling-this.csv", document("a driver", 1.5, 1280));
    const Comparison larger =
        compareWithCommitted(figuresOf(points), *readCommitted(path(), device));
    EXPECT_EQ(larger.compared, 0u);
    EXPECT_TRUE(larger.contradictions.empty());
    EXPECT_TRUE(has(larger.omission, "1280x270 there, 480x270 here")) << larger.omission;
    ReportPage page{.title = {}, .about = {}, .sentences = {}, .notes = {}, .sections = {}};
    page.sections.push_back({.id = "culling",
                             .title = {},
                             .intro = {},
                             .html = {},
                             .tables = cullingTables(points),
                             .command = {}});
    EXPECT_FALSE(has(htmlOf(page), contradictionLegend()));
    page.markContradictions(other.contradictions);
    EXPECT_TRUE(has(htmlOf(page), "4,000 lights !</th>"));
}

// The files that the project commits are understood: each kind gives figures.
TEST(ReportCommitted, ReadsTheCommittedResults)
{
    const DeviceInfo device{.name = "llvmpipe (LLVM 15.0.6, 256 bits)",
                            .driver = "llvmpipe Mesa 22.3.6 (LLVM 15.0.6)"};
    const auto committed = readCommitted(test::sourcePath("tools/bench/results"), device);
    ASSERT_TRUE(committed);
    EXPECT_EQ(committed->files.size(), 3u);
    for (const std::string& key : {cullingKey("hall", 4000, 8), kernelTimeKey("sphere", "conic"),
                                   kernelErrorKey("rectangle", "ltc")})
        EXPECT_TRUE(committed->figures.contains(key)) << key;
}
