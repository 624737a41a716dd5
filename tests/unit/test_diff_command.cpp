// SPDX-License-Identifier: Apache-2.0
// Tests candelabra diff on pictures whose differences are known. Nothing here uses Vulkan.
#include <algorithm>
#include <cmath>
#include <limits>

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include "harness/json_keys.h"
#include "harness/run_program.h"
#include "harness/temporary_folder.h"
#include "io/error.h"
#include "io/image.h"
#include "measure/accuracy/picture_difference.h"

using namespace candelabra::app;
using candelabra::test::ProgramOutcome;
using candelabra::test::runWith;
using nlohmann::json;

namespace
{

constexpr float infinity = std::numeric_limits<float>::infinity();

class DiffCommand : public testing::Test, protected candelabra::test::TemporaryFolder
{
protected:
    // A picture of 8 x 4 pixels of radiance 2.
    static Image plain() { return {8, 4, 3, std::vector<float>(8 * 4 * 3, 2.0f)}; }
    std::string save(const std::string& name, const Image& image) const
    {
        saveImageByExtension(path(name), image);
        return path(name);
    }
    std::string savePicture(const std::string& name, uint8_t value, uint32_t width = 8) const
    {
        savePng(path(name), width, 4, std::vector<uint8_t>(size_t{width} * 4 * 3, value));
        return path(name);
    }
    static ProgramOutcome diff(std::vector<std::string> arguments)
    {
        std::vector<const char*> pointers{"diff"};
        for (const std::string& argument : arguments)
            pointers.push_back(argument.c_str());
        return runWith(pointers);
    }
    static void refused(const std::vector<std::string>& arguments, const std::string& sentence)
    {
        const ProgramOutcome outcome = diff(arguments);
        EXPECT_EQ(outcome.exitCode, exitUsage) << sentence;
        EXPECT_NE(outcome.err.find(sentence), std::string::npos) << outcome.err;
        EXPECT_EQ(std::count(outcome.err.begin(), outcome.err.end(), '\n'), 1) << outcome.err;
    }
};

} // namespace

TEST_F(DiffCommand, EqualPicturesAreTheSameInEveryFormat)
{
    const std::string exr = save("a.exr", plain());
    for (const std::string& other :
         {save("b.exr", plain()), save("b.pfm", plain()), save("b.hdr", plain())}) {
        const ProgramOutcome outcome = diff({exr, other});
        EXPECT_EQ(outcome.exitCode, exitOk) << outcome.err;
        EXPECT_TRUE(outcome.out.starts_with("The same, bit for bit:")) << outcome.out;
    }
    const Image grey{8, 4, 1, std::vector<float>(8 * 4, 2.0f)};
    EXPECT_EQ(diff({exr, save("grey.pfm", grey)}).exitCode, exitOk);
    EXPECT_EQ(diff({savePicture("a.png", 7), savePicture("b.png", 7)}).exitCode, exitOk);

    Image zero = plain(), negative = plain();
    zero.pixels[5] = 0.0f;
    negative.pixels[5] = -0.0f;
    const ProgramOutcome signs = diff({save("zero.exr", zero), save("negative.exr", negative)});
    EXPECT_EQ(signs.exitCode, exitOk);
    EXPECT_TRUE(signs.out.starts_with("The same: ")) << signs.out;
}

// One value of 96 is 1% too large: relMSE is 0.02^2 / (4 + 0.01 * 4) / 96.
TEST_F(DiffCommand, FiguresAndExitCodeOfAKnownDifference)
{
    Image a = plain();
    a.pixels[(2 * 8 + 5) * 3 + 1] = 2.02f;
    const std::string fileA = save("a.exr", a), fileB = save("b.exr", plain());
    const ProgramOutcome outcome = diff({fileA, fileB, "--json", "-"});
    EXPECT_EQ(outcome.exitCode, exitBeyond) << outcome.err;
    const json out = json::parse(outcome.out);
    EXPECT_EQ(candelabra::test::keyFaults(out, "diff"), "");
    const double error = 0.02 / std::sqrt(4.04);
    EXPECT_NEAR(out["relMse"], error * error / 96, 1e-9);
    EXPECT_NEAR(out["meanRel"], error / 96, 1e-7);
    EXPECT_NEAR(out["p99Rel"], error, 1e-6); // by nearest rank the largest of 96 values
    EXPECT_EQ(out["differingPixels"], 1);
    EXPECT_EQ(out["largest"]["x"], 5);
    EXPECT_EQ(out["largest"]["y"], 2);
    EXPECT_EQ(out["largest"]["channel"], "green");
    EXPECT_NEAR(out["largest"]["a"], 2.02, 1e-6);
    EXPECT_EQ(out["largest"]["b"], 2);
    EXPECT_GT(out["flip"], 0);

    EXPECT_EQ(diff({fileA, fileB, "--max-relmse", "1.1e-6"}).exitCode, exitOk);
    const ProgramOutcome strict = diff({fileA, fileB, "--max-relmse", "1e-6"});
    EXPECT_EQ(strict.exitCode, exitBeyond);
    EXPECT_TRUE(strict.out.starts_with("Different: 1 of 32 pixels (3.12%) differ; relMSE is "))
        << strict.out;
    EXPECT_NE(strict.out.find("above 1e-06 (--max-relmse)"), std::string::npos) << strict.out;
}

TEST_F(DiffCommand, PngIsComparedAsDisplayed)
{
    const ProgramOutcome outcome =
        diff({savePicture("a.png", 100), savePicture("b.png", 200), "--json", "-"});
    EXPECT_EQ(outcome.exitCode, exitBeyond);
    const json out = json::parse(outcome.out);
    EXPECT_EQ(out["values"], "display");
    EXPECT_NEAR(out["relMse"], 0.25 / 1.01, 1e-6);
    EXPECT_NEAR(out["largest"]["a"], 100 / 255.0, 1e-6);
    EXPECT_GT(out["flip"], 0.1);
}

TEST_F(DiffCommand, NanIsDifferentUnlessBothHaveIt)
{
    Image a = plain(), b = plain();
    for (Image* image : {&a, &b})
        image->pixels[0] = NAN;
    const std::string both = save("both.pfm", a);
    EXPECT_EQ(diff({both, save("b.exr", b)}).exitCode, exitOk);
    a.pixels[9] = infinity;
    a.pixels[40] = 2.2f;
    const std::string one = save("one.exr", a);
    for (const bool swapped : {false, true}) {
        const ProgramOutcome outcome =
            diff({swapped ? both : one, swapped ? one : both, "--max-relmse", "1e30"});
        EXPECT_EQ(outcome.exitCode, exitBeyond);
        EXPECT_TRUE(outcome.out.starts_with("Different: 2 of 32 pixels (6.25%) differ, and 1 of "
                                            "them because they are NaN or infinite"))
            << outcome.out;
    }
    const json out = json::parse(diff({one, both, "--json", "-"}).out);
    EXPECT_EQ(out["notFinite"]["aPixels"], 2);
    EXPECT_EQ(out["notFinite"]["bPixels"], 1);
    EXPECT_NEAR(out["meanRel"], 0.2 / std::sqrt(4.04) / 90, 1e-6); // of the other 30 pixels

    Image nan = plain();
    nan.pixels.assign(nan.pixels.size(), NAN);
    const ProgramOutcome none = diff({save("nan.exr", nan), save("plain.exr", plain())});
    EXPECT_EQ(none.exitCode, exitBeyond);
    EXPECT_NE(none.out.find("32 of 32 pixels (100%)"), std::string::npos) << none.out;
}

TEST_F(DiffCommand, TheMapHasAllErrorsAndALegend)
{
    const std::vector<float> errors{0, 1e-5f, 0.01f, 5, NAN, 0};
    const Legend map = errorMap(errors, 3, 2);
    EXPECT_GT(map.width, 100u); // room for the legend
    EXPECT_GT(map.height, 10u);
    EXPECT_EQ(map.pixels[0], packed(glm::vec3(0)));
    EXPECT_EQ(map.pixels[1], packed(viridis(0)));
    EXPECT_EQ(map.pixels[2], packed(viridis(0.5f)));
    EXPECT_EQ(map.pixels[map.width], packed(viridis(1)));
    EXPECT_EQ(map.pixels[map.width + 1], packed(glm::vec3(1)));
    const auto legend = map.pixels.begin() + 2 * long(map.width);
    EXPECT_NE(std::find(legend, map.pixels.end(), packed(viridis(1))), map.pixels.end());

    Image a = plain();
    a.pixels[3] = 9;
    const std::string heat = path("heat.png");
    EXPECT_EQ(diff({save("a.exr", a), save("b.exr", plain()), "-o", heat}).exitCode, exitBeyond);
    const DisplayImage written = loadPng(heat);
    EXPECT_EQ(packed(written.pixels[0]), packed(glm::vec3(0)));
    EXPECT_EQ(packed(written.pixels[1]), packed(viridis(1)));
}

TEST_F(DiffCommand, RefusesWhatIsNotComparable)
{
    const std::string png = savePicture("a.png", 7), wide = savePicture("wide.png", 7, 9);
    const std::string exr = save("a.exr", plain()), broken = write("broken.pfm", "text");
    refused({png, exr}, "a.png holds values of a display and " + exr + " linear radiance");
    refused({exr, png}, "a.png holds values of a display and " + exr + " linear radiance");
    refused({png, wide}, "a.png has 8x4 pixels and " + wide + " 9x4");
    refused({png, path("none.png")}, "none.png");
    refused({exr, broken}, "broken.pfm: is not a PFM file");
    refused({exr, "run.json"}, "candelabra compare compares profiled runs");
    refused({exr, "a.jpg"}, "a.jpg: a picture is a .png, .exr, .hdr or .pfm");
    refused({png, png, "-o", "heat.exr"}, "-o heat.exr");
    refused({png, png, "-o", png}, "would replace");
    refused({png, png, "--max-relmse", "-1"}, "--max-relmse");
    refused({png}, "see: candelabra help diff");
}
