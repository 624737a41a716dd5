// SPDX-License-Identifier: Apache-2.0
// Tests the built program as a user runs it: files, exit codes, the window under Xvfb.
#include <chrono>
#include <cmath>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <numbers>
#include <regex>
#include <set>
#include <span>
#include <sstream>

#include <nlohmann/json.hpp>
#include <stb_image.h>
#include <sys/wait.h>

#include "commands/options.h"
#include "harness/full_tests.h"
#include "harness/gpu_fixture.h"
#include "harness/json_keys.h"
#include "harness/paths.h"
#include "harness/temporary_folder.h"
#include "harness/xml.h"
#include "io/error.h"
#include "io/image.h"
#include "io/table.h"
#include "render/renderer.h"

using namespace candelabra;

namespace
{

class ProgramTest : public test::GpuTest, protected test::TemporaryFolder
{
protected:
    struct Outcome {
        int exitCode;
        std::string out, err;
    };
    // Runs a command line through a shell; `before` is put in front of the program. Where tests run
    // without validation, "--validate" at the end is left out.
    Outcome run(std::string arguments, const std::string& before = "") const
    {
        const char* device = std::getenv("CANDELABRA_TEST_DEVICE");
        constexpr std::string_view validate = " --validate";
        if (!test::validates() && arguments.ends_with(validate))
            arguments.erase(arguments.size() - validate.size());
        const std::string command =
            "cd '" + path() + "' && " + before + " " + test::programWord() + " " + arguments +
            (device && arguments.rfind("devices", 0) ? " --device '" + std::string(device) + "'"
                                                     : "") +
            " >out.txt 2>err.txt";
        const int status = std::system(command.c_str());
        return {WIFEXITED(status) ? WEXITSTATUS(status) : -1, text("out.txt"), text("err.txt")};
    }
};

struct Png {
    int width = 0, height = 0;
    double mean = 0;
    int distinct = 0; // number of different values of the red channel
};

Png readPng(const std::string& path)
{
    Png out;
    int channels = 0;
    stbi_uc* pixels = stbi_load(path.c_str(), &out.width, &out.height, &channels, 3);
    if (!pixels)
        return out;
    std::array<bool, 256> seen{};
    const size_t count = size_t(out.width) * out.height;
    for (size_t i = 0; i < count; ++i) {
        out.mean += pixels[3 * i] / double(count);
        seen[pixels[3 * i]] = true;
    }
    out.distinct = int(std::count(seen.begin(), seen.end(), true));
    stbi_image_free(pixels);
    return out;
}

} // namespace

TEST_F(ProgramTest, HeatMapsComeWithTheirFigures)
{
    const Outcome outcome = run("render hall --lights 40 --size 96x54 --shadows off "
                                "--debug evaluated -o a.png -o a.exr");
    ASSERT_EQ(outcome.exitCode, 0) << outcome.err;
    EXPECT_TRUE(std::regex_search(
        outcome.out, std::regex("A pixel with a surface evaluates or waits for [0-9.]+ lights on "
                                "average; 99% of them have at most [0-9]+; the most are [0-9]+, at "
                                "[0-9]+,[0-9]+\\.\n")))
        << outcome.out;
    EXPECT_NE(outcome.err.find("a.exr; it has the radiance"), std::string::npos) << outcome.err;
}

TEST_F(ProgramTest, RenderWritesImagesAndFigures)
{
    const Outcome outcome =
        run("render hall --lights 150 --size 96x54 --frames 3 --moving --shadows off -q "
            "-o a.png -o a.exr -o a.pfm --pick 48,40 --json - --validate");
    ASSERT_EQ(outcome.exitCode, 0) << outcome.err;
    EXPECT_EQ(outcome.err, "");
    const auto json = nlohmann::json::parse(outcome.out);
    EXPECT_EQ(test::keyFaults(json, "render"), "");
    EXPECT_EQ(json["scene"]["lights"], 150);
    EXPECT_EQ(json["image"]["widthPixels"], 96);
    EXPECT_EQ(json["scene"]["lobes"], "conserving");
    EXPECT_EQ(json["scene"]["energyCompensation"], false);
    EXPECT_TRUE(json["scene"]["environment"].is_null());
    EXPECT_EQ(json["gpuTime"]["frames"], 3);
    EXPECT_EQ(json["warmUpFrames"], 1);
    EXPECT_GT(json["gpuTime"]["total"]["medianMs"], 0.0);
    EXPECT_GT(json["lighting"]["evaluatedPairs"], 0);
    EXPECT_GE(json["lighting"]["listedPairs"], json["lighting"]["insidePairs"]);
    EXPECT_EQ(json["exposure"]["invalidPixels"], 0);

    const Png png = readPng(path("a.png"));
    EXPECT_EQ(png.width, 96);
    EXPECT_EQ(png.height, 54);
    EXPECT_GT(png.mean, 20);
    EXPECT_LT(png.mean, 235);
    EXPECT_GT(png.distinct, 50);
    EXPECT_EQ(app::loadExr(path("a.exr")).pixels, app::loadPfm(path("a.pfm")).pixels);
}

TEST_F(ProgramTest, CullingAndFrameCountDoNotChangeTheImage)
{
    const std::string start = "render hall --lights 150 --size 96x54 --aa 1 -q -o ";
    ASSERT_EQ(run(start + "a.pfm").exitCode, 0);
    ASSERT_EQ(run(start + "b.pfm --culling brute").exitCode, 0);
    ASSERT_EQ(run(start + "c.pfm --frames 3").exitCode, 0);
    const auto a = app::loadPfm(path("a.pfm")).pixels, b = app::loadPfm(path("b.pfm")).pixels;
    double largest = 0, difference = 0;
    ASSERT_EQ(a.size(), b.size());
    for (size_t i = 0; i < a.size(); ++i) {
        largest = std::max(largest, double(a[i]));
        difference = std::max(difference, std::abs(double(a[i]) - double(b[i])));
    }
    EXPECT_GT(largest, 0);
    EXPECT_LE(difference, 1e-6 * largest);
    EXPECT_EQ(a, app::loadPfm(path("c.pfm")).pixels);
}

// A wall is between most lights of rooms and most of what they light without shadows.
TEST_F(ProgramTest, ShadowsTakeLightAway)
{
    const std::string start = "render rooms --lights 200 --size 64x36 --aa 1 -o ";
    const Outcome off = run(start + "a.pfm --shadows off --validate");
    ASSERT_EQ(off.exitCode, 0) << off.err;
    const Outcome on =
        run(start + "b.pfm --shadows 64 --json b.json --explain --pick 32,25 --validate");
    ASSERT_EQ(on.exitCode, 0) << on.err;
    EXPECT_NE(on.out.find(" lights reach a pixel. It asks for "), std::string::npos) << on.out;
    const auto json = nlohmann::json::parse(text("b.json"));
    EXPECT_EQ(json["settings"]["shadows"], "64");
    EXPECT_EQ(test::keyFaults(json["lighting"]["shadows"], "render-shadows"), "");
    EXPECT_NE(on.out.find("hidden most by"), std::string::npos) << on.out;
    int hidden = 0, seen = 0; // lights at the picked pixel
    for (const auto& light : json["pick"]["lights"]) {
        const auto& shadows = light["shadows"];
        EXPECT_EQ(test::keyFaults(shadows, "render-pick-shadows"),
                  shadows["occluders"].empty() ? "-render-pick-shadows.occluders[]: name share\n"
                                               : "");
        hidden += shadows["visibleDiffuse"] == 0.0;
        seen += shadows["visibleDiffuse"] == 1.0;
        EXPECT_EQ(light["radiance"][1] == 0.0, shadows["visibleDiffuse"] == 0.0) << light;
    }
    EXPECT_GT(hidden, 0);
    EXPECT_GT(seen, 0);
    const auto a = app::loadPfm(path("a.pfm")).pixels, b = app::loadPfm(path("b.pfm")).pixels;
    double all = 0, kept = 0;
    ASSERT_EQ(a.size(), b.size());
    for (size_t i = 0; i < a.size(); ++i) {
        EXPECT_LE(b[i], a[i] * 1.001f + 1e-6f) << i;
        all += double(a[i]);
        kept += double(b[i]);
    }
    EXPECT_GT(kept, 0.5 * all);
    EXPECT_LT(kept, 0.95 * all);
}

// They are there unless they take long on a CPU.
TEST_F(ProgramTest, ShadowsAreTheDefaultWhereTheyAreFast)
{
    const std::string small = "render rooms --lights 200 --size 64x36 --aa 1 -o ";
    const Outcome fast = run(small + "a.pfm --json a.json");
    ASSERT_EQ(fast.exitCode, 0) << fast.err;
    EXPECT_EQ(fast.err.find("shadows are off"), std::string::npos) << fast.err;
    EXPECT_EQ(nlohmann::json::parse(text("a.json"))["settings"]["shadows"], "64");
    ASSERT_EQ(run(small + "b.pfm --shadows 64").exitCode, 0);
    EXPECT_EQ(app::loadPfm(path("a.pfm")).pixels, app::loadPfm(path("b.pfm")).pixels);
    if (context().info().type != VK_PHYSICAL_DEVICE_TYPE_CPU)
        return;
    const std::string large = "render hall --size 640x360 --aa 1 --json c.json";
    const Outcome slow = run(large);
    ASSERT_EQ(slow.exitCode, 0) << slow.err;
    EXPECT_NE(slow.err.find("shadows are off, because a picture would take about "),
              std::string::npos)
        << slow.err;
    EXPECT_EQ(nlohmann::json::parse(text("c.json"))["settings"]["shadows"], "off");
    const Outcome chosen = run(large + " --shadows off");
    ASSERT_EQ(chosen.exitCode, 0) << chosen.err;
    EXPECT_EQ(chosen.err.find("shadows are off"), std::string::npos) << chosen.err;
}

TEST_F(ProgramTest, HeatMapOfShadowsNeedsShadows)
{
    const std::string start = "render rooms --lights 40 --size 128x72 -o c.png --debug shadow ";
    const Outcome without = run(start + "--shadows off");
    EXPECT_EQ(without.exitCode, 2);
    EXPECT_NE(without.err.find("--debug shadow: there are no shadows; add --shadows 64"),
              std::string::npos)
        << without.err;
    const Outcome with = run(start + "--validate");
    ASSERT_EQ(with.exitCode, 0) << with.err;
    EXPECT_GT(readPng(path("c.png")).distinct, 10); // mixed colours
}

// Several samples give the same bits in every run, keep the light of the picture, and change its
// edges. Pictures of CPU devices have one unless more are asked for, those of GPUs 16.
TEST_F(ProgramTest, SamplesSmoothEdges)
{
    const std::string start = "render hall --lights 150 --size 48x27 --shadows off -q -o ";
    const bool isGpu = context().info().type != VK_PHYSICAL_DEVICE_TYPE_CPU;
    ASSERT_EQ(run(start + "a.png").exitCode, 0);
    ASSERT_EQ(run(start + "f.png -o f.pfm --edge-filter").exitCode, 0); // auto: one sample
    if (isGpu) {
        ASSERT_EQ(run(start + "b.png --aa 16").exitCode, 0);
    }
    EXPECT_EQ(text("a.png"), text(isGpu ? "b.png" : "f.png"));
    const Outcome sampled = run(start + "c.png -o c.pfm --aa 4 --json c.json --validate");
    ASSERT_EQ(sampled.exitCode, 0) << sampled.err;
    ASSERT_EQ(run(start + "d.png -o d.pfm --aa 4").exitCode, 0);
    EXPECT_EQ(text("c.png"), text("d.png"));
    EXPECT_EQ(text("c.pfm"), text("d.pfm"));
    EXPECT_NE(text("a.png"), text("c.png"));
    EXPECT_NEAR(readPng(path("a.png")).mean, readPng(path("c.png")).mean, 15);
    ASSERT_EQ(run(start + "e.png -o e.pfm --aa 1").exitCode, 0);
    EXPECT_NE(text("e.png"), text("f.png"));
    EXPECT_EQ(text("e.pfm"), text("f.pfm"));
    const auto json = nlohmann::json::parse(text("c.json"));
    EXPECT_EQ(json["samplesPerFrame"], 4);
    EXPECT_EQ(json["gpuTime"]["frames"], 1);
    EXPECT_EQ(json["exposure"]["invalidPixels"], 0);
}

TEST_F(ProgramTest, BloomIsOfPicturesAlone)
{
    const std::string start = "render hall --lights 150 --size 49x27 --aa 2 --shadows off -q -o ";
    ASSERT_EQ(run(start + "a.png -o a.pfm").exitCode, 0);
    ASSERT_EQ(run(start + "b.png -o b.pfm --bloom 0").exitCode, 0);
    const Outcome bloomed = run(start + "c.png -o c.pfm --bloom 0.1 --json c.json --validate");
    ASSERT_EQ(bloomed.exitCode, 0) << bloomed.err;
    EXPECT_EQ(text("a.png"), text("b.png"));
    EXPECT_NE(text("a.png"), text("c.png"));
    EXPECT_EQ(text("a.pfm"), text("c.pfm"));
    const auto json = nlohmann::json::parse(text("c.json"));
    EXPECT_NEAR(json["settings"]["bloom"], 0.1, 1e-6);
}

// A white floor gets the illuminance that is printed, and that follows from the image alone.
TEST_F(ProgramTest, FloorsGetTheIlluminanceThatIsPrinted)
{
    const struct {
        uint32_t width, row;
    } texels[] = {{64, 15}, {256, 40}, {1024, 1}, {64, 0}, {1024, 180}, {1024, 250}};
    for (const auto& [width, row] : std::span(texels).first(test::fullTests() ? 6 : 3)) {
        app::Image image{.width = width, .height = width / 2, .channels = 3, .pixels = {}};
        image.pixels.assign(size_t(width) * image.height * 3, 0);
        const size_t texel = 3 * (size_t(row) * width + width / 3);
        std::fill_n(&image.pixels[texel], 3, 1e7f);
        app::savePfm(path("sky.pfm"), image);
        const Outcome outcome =
            run("render " + test::shellWord(test::dataPath("matte_floor.gltf")) +
                " --environment sky.pfm --size 8x8 -o o.pfm" + (width == 64 ? " --validate" : ""));
        ASSERT_EQ(outcome.exitCode, 0) << outcome.err;
        const auto squaredSine = [&](double y) {
            return std::pow(std::sin(std::numbers::pi * y / image.height), 2);
        };
        const double lux =
            1e7 * std::numbers::pi / width * (squaredSine(row + 1.0) - squaredSine(row));
        const std::string said = outcome.out + outcome.err, before = "environment sky.pfm: ";
        ASSERT_NE(said.find(before), std::string::npos) << said;
        const double printed = std::stod(said.substr(said.find(before) + before.size()));
        EXPECT_NEAR(printed, lux, 0.006 * lux) << said; // three digits
        const double elevation = 90 - 180 * (row + 0.5) / image.height;
        const double facing = lux / std::sin(elevation * std::numbers::pi / 180);
        const std::vector<float> floor = app::loadPfm(path("o.pfm")).pixels;
        for (const float radiance : floor)
            ASSERT_NEAR(double(radiance) * std::numbers::pi / 0.5, lux,
                        1e-3 * (elevation < 10 ? facing : lux))
                << width << " " << row;
    }
}

// The camera turns, the lights move and the exposure adapts, so that no two pictures are equal.
TEST_F(ProgramTest, SequencesWriteEveryFrame)
{
    const Outcome outcome = run("render hall --lights 20 --size 32x18 --frames 4 --path turn "
                                "--fps 4 --moving --aa 2 -o f.%02d.png -o f.%02d.pfm --validate");
    ASSERT_EQ(outcome.exitCode, 0) << outcome.err;
    std::set<std::string> pictures;
    for (int i = 0; i < 4; ++i)
        for (const char* extension : {".png", ".pfm"}) {
            const std::string name = "f.0" + std::to_string(i) + extension;
            EXPECT_GT(text(name).size(), 100u) << name;
            pictures.insert(text(name));
        }
    EXPECT_EQ(pictures.size(), 8u);
}

// At noon and at night: a card of albedo 0.18 that fills the picture is displayed as middle grey,
// 118 of 255, and the log says which EV100 that took.
TEST_F(ProgramTest, AGreyCardIsMiddleGreyAndTheExposureIsPrinted)
{
    const auto writeCard = [&](double illuminance) {
        std::ofstream(path("card.json"))
            << R"({"camera": {"position": [0, 0, 2], "look_at": [0, 0, 0], "up": [0, 1, 0],
                   "vertical_fov_degrees": 40},
                   "object": {"type": "plane", "point": [0, 0, 0], "normal": [0, 0, 1]},
                   "material": {"albedo": [0.18, 0.18, 0.18], "specular": false,
                                "perceptual_roughness": 1},
                   "lights": [{"type": "directional", "direction": [0, 0, -1], "illuminance": [)"
            << illuminance << "," << illuminance << "," << illuminance << "]}]}";
    };
    struct Case {
        double illuminance; // lx
        const char* options;
    };
    for (const Case& c : {Case{100'000, ""},
                          {100'000, " --metering average --tonemap aces"},
                          {1, " --tonemap agx"},
                          {1, " --tonemap reinhard --exposure -1.126"}}) {
        writeCard(c.illuminance);
        const Outcome outcome =
            run(std::string("render card.json --shadows off --size 48x27 -o card.png") + c.options);
        ASSERT_EQ(outcome.exitCode, 0) << outcome.err;
        // 0.02 EV is 0.7 of 255 here, and dithering keeps the mean.
        EXPECT_NEAR(readPng(path("card.png")).mean, 117.6, 0.9) << c.illuminance << c.options;
        const size_t at = outcome.err.find("EV100 ");
        ASSERT_NE(at, std::string::npos) << outcome.err;
        const double ev = std::log2(0.18 * c.illuminance / 3.14159265 * 100 / 12.5);
        EXPECT_NEAR(std::stod(outcome.err.substr(at + 6)), ev, 0.02) << c.options;
    }
}

TEST_F(ProgramTest, EnvironmentFilesLightTheScene)
{
    app::Image sky{.width = 32, .height = 16, .channels = 3};
    sky.pixels.assign(32 * 16 * 3, 50.0f);
    app::saveHdr(path("sky.hdr"), sky);
    std::ofstream(path("floor.json"))
        << R"({"camera": {"position": [0, 1, 0], "look_at": [0, 1, -1], "up": [0, 1, 0],
               "vertical_fov_degrees": 40},
               "object": {"type": "plane", "point": [0, 0, 0], "normal": [0, 1, 0]},
               "material": {"albedo": [0.5, 0.5, 0.5], "perceptual_roughness": 0.5},
               "lights": []})";
    const std::string start = "render floor.json --size 64x36 --default-light off -q -o ";
    const Outcome idle = run(start + "dark.pfm --environment-scale 2");
    ASSERT_EQ(idle.exitCode, 0) << idle.err;
    EXPECT_NE(idle.err.find("--environment-scale has no effect"), std::string::npos) << idle.err;
    const Outcome lit = run(start + "lit.pfm --environment sky.hdr --environment-scale 2 "
                                    "--environment-rotation 30 --lobes sum "
                                    "--energy-compensation on --json lit.json --validate");
    ASSERT_EQ(lit.exitCode, 0) << lit.err;
    const auto dark = app::loadPfm(path("dark.pfm")).pixels,
               bright = app::loadPfm(path("lit.pfm")).pixels;
    double most = 0, gained = 0;
    for (size_t i = 0; i < dark.size(); ++i) {
        most = std::max(most, double(bright[i]) - dark[i]);
        gained += (bright[i] - dark[i]) / double(dark.size());
    }
    // In uniform surroundings the background shows their luminance, and nothing reflects more than
    // that.
    EXPECT_NEAR(most, 100, 0.5);
    EXPECT_GT(gained, 5);

    const auto scene = nlohmann::json::parse(text("lit.json"))["scene"];
    EXPECT_EQ(scene["lobes"], "sum");
    EXPECT_EQ(scene["energyCompensation"], true);
    EXPECT_EQ(test::keyFaults(scene["environment"], "render-environment"), "");
    EXPECT_EQ(scene["environment"]["file"], "sky.hdr");
    EXPECT_EQ(scene["environment"]["scale"], 2);
    EXPECT_NEAR(scene["environment"]["rotationRadians"], 0.5235988, 1e-6);
}

TEST_F(ProgramTest, StressWritesEverythingItPromises)
{
    const Outcome outcome =
        run("stress --lights 50,200 --size 64x36 --frames 2 --warm-up 0.1 --out o --json s.json "
            "--validate");
    ASSERT_EQ(outcome.exitCode, 0) << outcome.err;
    for (const char* word : {"shade_tiles", "p95 ms", "entries per tile", "identical", "Try next",
                             "\nat 200 sphere lights: ", " lights per pixel, no shadows, on "})
        EXPECT_NE(outcome.out.find(word), std::string::npos) << word;
    const auto json = nlohmann::json::parse(text("s.json"));
    EXPECT_EQ(test::keyFaults(json, "stress"), "");
    EXPECT_EQ(json["warmUpSeconds"], 0.1);
    ASSERT_EQ(json["points"].size(), 2u);
    for (const auto& point : json["points"]) {
        EXPECT_EQ(point["gpuTime"]["frames"], 2);
        EXPECT_LE(point["bruteForce"]["maxDifferenceOverMaxRadiance"], 1e-6);
        EXPECT_EQ(point["bruteForce"]["pixelsCompared"], 64 * 36);
        EXPECT_GT(point["bruteForce"]["shadingMs"], 0.0);
        EXPECT_EQ(point["twoRunsIdentical"], true);
    }
    EXPECT_GT(readPng(path("o/hall_50.png")).mean, 5);
    EXPECT_EQ(readPng(path("o/hall_200.png")).width, 64);
    EXPECT_NE(text("o/stress.svg").find("shade_tiles"), std::string::npos);
    EXPECT_EQ(test::xmlFault(path("o/stress.svg")), "");
}

TEST_F(ProgramTest, StressFindsHowManyLightsAFrameRateCarries)
{
    const std::string start = "stress field --size 32x18 --frames 2 --out o --json s.json --fps ";
    const Outcome none = run(start + "100000 --validate");
    ASSERT_EQ(none.exitCode, 0) << none.err;
    EXPECT_NE(none.out.find("not even one light at 100000 frames/s (field, 32x18, "),
              std::string::npos)
        << none.out;
    auto json = nlohmann::json::parse(text("s.json"));
    EXPECT_EQ(test::keyFaults(json["search"], "stress-search"), "");
    EXPECT_TRUE(json["search"]["lights"].is_null());
    EXPECT_EQ(json["points"][0]["lights"], 1);
    EXPECT_TRUE(json["points"][0]["image"].is_null());
    EXPECT_NE(text("o/stress.svg").find("100000 frames/s"), std::string::npos);
    EXPECT_EQ(test::xmlFault(path("o/stress.svg")), "");

    // A machine that is not busy carries some lights at this rate.
    const Outcome some = run(start + "40");
    ASSERT_EQ(some.exitCode, 0) << some.err;
    json = nlohmann::json::parse(text("s.json"));
    EXPECT_TRUE(some.out.ends_with(json["sentence"].get<std::string>() + "\n")) << some.out;
    const auto& lights = json["search"]["lights"];
    for (const auto& point : json["points"]) {
        const double ms = point["gpuTime"]["total"]["medianMs"];
        if (point["lights"] == lights) {
            EXPECT_LE(ms, 25);
        } else if (lights.is_null() || point["lights"] > lights) {
            EXPECT_GT(ms, 25) << point["lights"];
        }
    }
}

TEST_F(ProgramTest, StressMeasuresNoLightsAndNeedNotCheck)
{
    const Outcome outcome =
        run("stress --lights 0,20 --size 64x36 --frames 1 --check none --out o --validate");
    ASSERT_EQ(outcome.exitCode, 0) << outcome.err;
    EXPECT_NE(outcome.out.find("not compared"), std::string::npos) << outcome.out;
    const auto json = nlohmann::json::parse(text("o/stress.json"));
    EXPECT_EQ(json["points"][0]["lights"], 0);
    EXPECT_TRUE(json["points"][1]["twoRunsIdentical"].is_null());
    EXPECT_EQ(readPng(path("o/hall_0.png")).width, 64);
    EXPECT_EQ(test::xmlFault(path("o/stress.svg")), "");
}

// A pass that has a time did not skip its recording.
TEST_F(ProgramTest, ExplainDoesNotDenyTheTimes)
{
    const Outcome outcome = run("render hall --lights 20 --size 16x9 --explain");
    ASSERT_EQ(outcome.exitCode, 0) << outcome.err;
    EXPECT_NE(outcome.out.find("shade_unlisted       recorded, found nothing to do: every cluster"),
              std::string::npos)
        << outcome.out;
    EXPECT_NE(outcome.out.find("shade_brute          skipped: lights are culled"),
              std::string::npos)
        << outcome.out;
}

TEST_F(ProgramTest, ProfileTimesEveryPass)
{
    const Outcome outcome = run("profile hall --lights 100 --size 64x36 --frames 8 --path turn "
                                "--moving --light-costs 5 --csv f.csv --json p.json --validate");
    ASSERT_EQ(outcome.exitCode, 0) << outcome.err;
    EXPECT_NE(outcome.out.find("shade_tiles"), std::string::npos) << outcome.out;
    const auto json = nlohmann::json::parse(text("p.json"));
    EXPECT_EQ(test::keyFaults(json, "profile"), "");
    EXPECT_EQ(json["lightCosts"]["lights"].size(), 5u);
    ASSERT_EQ(json["variants"].size(), 1u);
    const auto& time = json["variants"][0]["time"];
    EXPECT_EQ(time["frames"], 8);
    double largest = 0;
    for (const auto& pass : time["passes"]) {
        EXPECT_LE(pass["minMs"], pass["medianMs"]) << pass;
        EXPECT_LE(pass["p95Ms"], pass["p99Ms"]) << pass;
        largest = std::max(largest, double(pass["medianMs"]));
    }
    EXPECT_GT(largest, 0);
    EXPECT_LE(largest, time["gpu"]["medianMs"]);
    EXPECT_LE(time["gpu"]["minMs"], time["frame"]["minMs"]);
    EXPECT_GT(time["record"]["medianMs"], 0);
    const std::string csv = text("f.csv");
    EXPECT_EQ(csv.rfind("variant,frame,", 0), 0u);
    EXPECT_EQ(std::count(csv.begin(), csv.end(), '\n'), 1 + 8);
}

// With several frames in flight the time of a frame is that between the ends of two frames, so the
// times of all frames add up to no more than the program ran.
TEST_F(ProgramTest, ProfileKeepsFramesInFlight)
{
    const auto start = std::chrono::steady_clock::now();
    const Outcome outcome =
        run("profile hall --lights 60 --size 64x36 --frames 12 --frames-in-flight 3 --warm-up 0.3 "
            "--moving -q --csv f.csv --json p.json --validate");
    const std::chrono::duration<double, std::milli> took = std::chrono::steady_clock::now() - start;
    ASSERT_EQ(outcome.exitCode, 0) << outcome.err;
    const auto json = nlohmann::json::parse(text("p.json"));
    EXPECT_EQ(json["framesInFlight"], 3);
    EXPECT_EQ(json["warmUp"]["secondsAtLeast"], 0.3);
    EXPECT_EQ(json["variants"][0]["time"]["frames"], 12);
    std::istringstream csv(text("f.csv"));
    std::string line;
    std::getline(csv, line);
    EXPECT_TRUE(line.ends_with(",frame")) << line;
    double sum = 0;
    for (int i = 0; i < 12; ++i) {
        ASSERT_TRUE(std::getline(csv, line));
        sum += std::stod(line.substr(line.rfind(',') + 1));
    }
    EXPECT_GT(sum, 0);
    EXPECT_LT(sum, took.count() - 300);
}

TEST_F(ProgramTest, ProfileKnowsWhatTimestampsCost)
{
    const Outcome outcome = run("profile hall --lights 100 --size 64x36 --frames 6 --moving -q "
                                "--json p.json --validate");
    ASSERT_EQ(outcome.exitCode, 0) << outcome.err;
    const auto variant = nlohmann::json::parse(text("p.json"))["variants"][0];
    EXPECT_GT(variant["time"]["upload"]["medianMs"], 0);
    EXPECT_GT(variant["overhead"]["stampMs"], 0);
    EXPECT_GE(variant["overhead"]["stamps"], variant["time"]["passes"].size());
    // Hardly anything happens between the modules, and the cost of a timestamp is an estimate.
    EXPECT_GT(variant["overhead"]["passesOverGpuSpan"], 0.5);
    EXPECT_LT(variant["overhead"]["passesOverGpuSpan"], 1.05);
}

TEST_F(ProgramTest, ProfileTellsADifferenceFromNone)
{
    const Outcome outcome = run("profile hall --lights 300 --size 64x36 --frames 10 -q --json - "
                                "--ab '' '--specular sampled --samples 256'");
    ASSERT_EQ(outcome.exitCode, 0) << outcome.err;
    const auto json = nlohmann::json::parse(outcome.out);
    EXPECT_EQ(test::keyFaults(json["comparison"], "profile-comparison"), "");
    EXPECT_EQ(json["variants"][0]["settings"]["specular"], "conic");
    EXPECT_EQ(json["variants"][1]["settings"]["specular"], "sampled");
    bool found = false;
    for (const auto& row : json["comparison"]) {
        EXPECT_LE(row["low"], row["ratio"]) << row;
        if (row["name"] != "shade_tiles")
            continue;
        found = true;
        EXPECT_EQ(row["verdict"], "slower") << row;
        EXPECT_GT(row["low"], 2.0) << row;
    }
    EXPECT_TRUE(found);
}

// A profile of a file that really has the change counts as many pairs as were predicted.
TEST_F(ProgramTest, ProfilePredictsPairsExactly)
{
    const std::string profile = " --size 96x64 --light-costs 3 -q --json - --frames ";
    auto scene = nlohmann::json::parse(std::ifstream(test::dataPath("every_light.json")));
    auto lights = nlohmann::json::array(); // of three types, because each needs pipelines
    for (auto& light : scene["lights"]) {
        const std::string type = light.value("type", "sphere");
        if (type == "sphere" || type == "point")
            light["influence_radius"] = 6;
        if (type == "sphere" || type == "point" || type == "directional")
            lights.push_back(light);
    }
    scene["lights"] = lights;
    write("before.json", scene.dump());
    const auto predicted = [&](const std::string& change) {
        const Outcome outcome = run("profile before.json --what-if " + change + profile + "6");
        EXPECT_EQ(outcome.exitCode, 0) << outcome.err;
        return nlohmann::json::parse(outcome.out);
    };
    const auto measuredPairs = [&](const nlohmann::json& after) {
        write("after.json", after.dump());
        const Outcome outcome = run("profile after.json" + profile + "1");
        EXPECT_EQ(outcome.exitCode, 0) << outcome.err;
        return nlohmann::json::parse(outcome.out)["lightCosts"]["pairs"].get<double>();
    };
    const auto json = predicted("influence=0.5");
    EXPECT_EQ(test::keyFaults(json["whatIf"], "profile-what-if"), "");
    const auto& answer = json["whatIf"];
    EXPECT_EQ(json["lightCosts"]["pairs"], answer["aPairs"]);
    ASSERT_GE(answer["changedLights"].size(), 2u) << answer;
    ASSERT_GE(answer["keptLights"].size(), 1u) << answer;
    EXPECT_GT(answer["shading"]["ratio"], 0) << answer;
    auto narrow = scene, fewer = scene;
    for (const size_t light : answer["changedLights"]) {
        auto& radius = narrow["lights"][light]["influence_radius"];
        radius = 0.5 * radius.get<double>();
    }
    EXPECT_LT(answer["bPairs"], answer["aPairs"]);
    EXPECT_EQ(measuredPairs(narrow), answer["bPairs"]);

    const auto off = predicted("off")["whatIf"];
    std::set<size_t, std::greater<>> removed(off["changedLights"].begin(),
                                             off["changedLights"].end());
    ASSERT_EQ(removed.size(), 3u);
    for (const size_t light : removed)
        fewer["lights"].erase(light);
    EXPECT_EQ(measuredPairs(fewer), off["bPairs"]);
    EXPECT_LT(off["bPairs"], answer["bPairs"]);
}

TEST_F(ProgramTest, ProfiledRunsCollectAndCompare)
{
    for (int i = 0; i < 2; ++i)
        ASSERT_EQ(run("profile hall --lights 50 --size 32x18 --frames 2 -q --json r.json --append")
                      .exitCode,
                  0);
    ASSERT_EQ(nlohmann::json::parse(text("r.json")).size(), 2u);
    // Not run(), because compare does not take a device.
    const std::string compare = "cd '" + path() + "' && " + test::programWord() +
                                " compare r.json r.json >out.txt 2>err.txt";
    ASSERT_EQ(WEXITSTATUS(std::system(compare.c_str())), app::exitCannotTell) << text("err.txt");
    EXPECT_NE(text("out.txt").find("shade_tiles"), std::string::npos) << text("out.txt");
    EXPECT_EQ(text("out.txt").find("Cannot tell whether B is slower: an interval needs 4 runs of "
                                   "each, and A has 2 and B 2.\n"),
              0u)
        << text("out.txt");
}

TEST_F(ProgramTest, PicturesOfTheSameSceneAreTheSame)
{
    const std::string render = "render hall --lights 20 --size 32x18 --shadows off -q ";
    ASSERT_EQ(run(render + "-o a.png -o a.exr").exitCode, 0);
    ASSERT_EQ(run(render + "-o b.png -o b.exr --seed 2").exitCode, 0);
    // Not run(), because diff does not take a device.
    const auto diff = [&](const std::string& arguments) {
        const std::string command = "cd '" + path() + "' && " + test::programWord() + " diff " +
                                    arguments + " >out.txt 2>err.txt";
        return WEXITSTATUS(std::system(command.c_str()));
    };
    EXPECT_EQ(diff("a.exr a.exr"), 0) << text("err.txt");
    for (const char* both : {"a.exr b.exr", "a.png b.png"}) {
        EXPECT_EQ(diff(std::string(both) + " -o heat.png"), app::exitBeyond) << text("err.txt");
        EXPECT_EQ(text("out.txt").find("Different: "), 0u) << text("out.txt");
        EXPECT_GT(readPng(path("heat.png")).distinct, 20);
    }
    EXPECT_EQ(diff("a.exr b.exr --max-relmse 1e6"), 0) << text("out.txt");
}

TEST_F(ProgramTest, BenchSkipComparesFramesOfTheSameImage)
{
    const Outcome outcome = run("bench skip --lights 60 --size 64x36 --rounds 2 --json s.json "
                                "-q --validate");
    ASSERT_EQ(outcome.exitCode, 0) << outcome.err;
    EXPECT_NE(outcome.out.find("lists made again"), std::string::npos) << outcome.out;
    const auto json = nlohmann::json::parse(text("s.json"));
    EXPECT_EQ(test::keyFaults(json, "bench-skip"), "");
    ASSERT_EQ(json["skips"].size(), 3u);
    EXPECT_EQ(json["skips"][1]["withMs"], 0.0); // the whole image is kept
    for (const auto& row : json["skips"])
        EXPECT_GT(row["withoutMs"], 0.0) << row;
}

TEST_F(ProgramTest, BenchVisibilityComparesShadowsWithRays)
{
    const Outcome outcome = run("bench visibility rooms --lights 40 --size 64x36 --rounds 1 "
                                "--pixels 30 --json v.json --pictures --out v -q --validate");
    ASSERT_EQ(outcome.exitCode, 0) << outcome.err;
    EXPECT_NE(outcome.out.find("256 random rays"), std::string::npos) << outcome.out;
    const auto json = nlohmann::json::parse(text("v.json"));
    EXPECT_EQ(test::keyFaults(json, "bench-visibility"), "");
    const auto& pairs = json["pairs"];
    EXPECT_GT(pairs["dark"], 0);
    EXPECT_GT(pairs["lit"], 0);
    EXPECT_EQ(pairs["asked"].get<int64_t>(), pairs["lit"].get<int64_t>() +
                                                 pairs["partlyLit"].get<int64_t>() +
                                                 pairs["dark"].get<int64_t>());
    EXPECT_GT(json["pixelsCompared"], 2);
    EXPECT_EQ(json["leaks"], 0);
    const auto& errors = json["errors"]; // of the engine, without shadows, and of rays
    ASSERT_EQ(errors.size(), 8u);
    EXPECT_LT(errors[0]["ofPixel"]["meanPercent"], 2.0);
    EXPECT_GT(errors[1]["ofPixel"]["meanPercent"], 5.0);
    EXPECT_GT(errors[0]["pairVisibilityMs"], 0.0);
    EXPECT_EQ(errors[1]["pairVisibilityMs"], 0.0);
    EXPECT_GT(errors[2]["pairVisibilityMs"], 0.0);
    EXPECT_GT(errors[7]["pairVisibilityMs"], 255 * errors[3]["pairVisibilityMs"].get<double>());
    size_t compared = 0;
    const app::Image truth = app::loadPfm(path("v/truth.pfm"));
    const app::Image unshadowed = app::loadPfm(path("v/no-shadows.pfm"));
    for (size_t i = 0; i < truth.pixels.size(); ++i) {
        compared += !std::isnan(truth.pixels[i]);
        EXPECT_FALSE(truth.pixels[i] > 1.001f * unshadowed.pixels[i]) << i;
    }
    EXPECT_EQ(compared, 3u * 30);
    // Shadows only take light away.
    for (const auto& e : errors) {
        EXPECT_LT(e["ofUnshadowed"]["meanPercent"], e["ofPixel"]["meanPercent"]) << e;
        EXPECT_LE(e["ofUnshadowed"]["p99Percent"], e["ofPixel"]["p99Percent"]) << e;
    }
}

TEST_F(ProgramTest, ReportIsOnePageThatNeedsNothingElse)
{
    const Outcome outcome = run("report --parts profile --lights 60 --size 64x36 "
                                "--frames 2 --out r -q --validate");
    ASSERT_EQ(outcome.exitCode, 0) << outcome.err;
    EXPECT_EQ(test::xmlFault(path("r/index.html")), "");
    const std::string page = text("r/index.html");
    for (const char* wanted :
         {"candelabra profile hall --lights 60", "shade_tiles", "data:image/png;base64,",
          "How fast is a frame?", "hall, 60 lights, 64x36: lighting takes"})
        EXPECT_NE(page.find(wanted), std::string::npos) << wanted;
    EXPECT_EQ(page.find("://"), std::string::npos);
    const auto json = nlohmann::json::parse(text("r/report.json"));
    EXPECT_EQ(test::keyFaults(json, "report"), "");
    EXPECT_GT(json["profile"]["time"]["gpu"]["medianMs"], 0);
    EXPECT_EQ(run("report --parts profile,colour --out r").exitCode, 2);
    EXPECT_EQ(run("report --parts profile,profile --out r").exitCode, 2);
    EXPECT_EQ(run("report --committed missing --out r").exitCode, 2);
}

// Whenever the program is terminated, it leaves complete files or none, and no temporary file.
TEST_F(ProgramTest, SignalsLeaveNoPartsOfFiles)
{
    int ended = 0;
    for (int i = 0; i < 8; ++i) {
        const std::string before =
            "timeout -s " + std::string(i % 2 ? "INT " : "TERM ") + std::to_string(0.15 * (i + 1));
        const Outcome outcome = run("render hall --lights 50 --size 512x512 --frames 4 -q -o s.exr "
                                    "-o s.pfm --json s.json",
                                    before);
        ended += outcome.exitCode == 124;
        for (const auto& file : std::filesystem::directory_iterator(path())) {
            const std::string name = file.path().filename().string();
            EXPECT_TRUE(name == "out.txt" || name == "err.txt" || name == "s.exr" ||
                        name == "s.pfm" || name == "s.json")
                << name;
            if (name == "s.exr") {
                EXPECT_EQ(app::loadExr(path(name)).width, 512u);
            } else if (name == "s.pfm") {
                EXPECT_EQ(app::loadPfm(path(name)).width, 512u);
            } else if (name == "s.json") {
                EXPECT_TRUE(nlohmann::json::accept(text(name)));
            }
        }
    }
    EXPECT_GE(ended, 1);
}

TEST_F(ProgramTest, DevicesListsTheOneUnderTest)
{
    const Outcome outcome = run("devices --json");
    ASSERT_EQ(outcome.exitCode, 0) << outcome.err;
    const auto json = nlohmann::json::parse(outcome.out);
    EXPECT_EQ(test::keyFaults(json, "devices"), "");
    bool found = false;
    for (const auto& device : json["devices"])
        found |= device["name"] == context().info().name && device["missing"] == "";
    EXPECT_TRUE(found) << outcome.out;
}

TEST_F(ProgramTest, MoreLightsThanTheDeviceHasRoomForAreRefused)
{
    const uint64_t most = app::maxLightsOf(context().info());
    ASSERT_GE(most, (1u << 27) / 64); // the smallest storage buffer that Vulkan allows, divided by
                                      // the size of a light's record
    if (most >= app::maxLights)
        return; // every count that --lights accepts fits
    for (const char* command : {"render hall -o a.png", "stress --out o"}) {
        const Outcome outcome = run(std::string(command) + " --lights " + std::to_string(most + 1));
        EXPECT_EQ(outcome.exitCode, 2) << command;
        EXPECT_NE(outcome.err.find("at most " + app::grouped(most) + " lights"), std::string::npos)
            << outcome.err;
        EXPECT_EQ(std::count(outcome.err.begin(), outcome.err.end(), '\n'), 1) << outcome.err;
    }
}

TEST_F(ProgramTest, UnknownDeviceIsRefused)
{
    for (const char* wanted : {"99", "no-such-device"}) {
        const std::string command = "cd '" + path() + "' && " + test::programWord() +
                                    " render hall -o a.png --device " + wanted + " 2>err.txt";
        const int status = std::system(command.c_str());
        EXPECT_EQ(WEXITSTATUS(status), 2) << wanted;
        EXPECT_EQ(text("err.txt").rfind("candelabra: --device ", 0), 0u) << text("err.txt");
    }
}

TEST_F(ProgramTest, WindowShowsTheSceneAndItsPanel)
{
    if (std::system("command -v xvfb-run >/dev/null") != 0)
        FAIL() << "xvfb-run is not installed (tools/setup installs it)";
    const Outcome panel = run("view hall --lights 40 --size 480x320 --frames 3 --moving "
                              "--screenshot panel.png --validate",
                              "xvfb-run -a");
    ASSERT_EQ(panel.exitCode, 0) << panel.err;
    const Outcome bare = run("view hall --lights 40 --size 480x320 --frames 3 --moving "
                             "--screenshot bare.png --no-overlay --validate",
                             "xvfb-run -a");
    ASSERT_EQ(bare.exitCode, 0) << bare.err;
    const Png with = readPng(path("panel.png")), without = readPng(path("bare.png"));
    EXPECT_EQ(with.width, 480);
    EXPECT_EQ(with.height, 320);
    EXPECT_GT(without.mean, 20);
    EXPECT_GT(without.distinct, 50);
    EXPECT_GT(std::abs(with.mean - without.mean), 1); // the panel darkens a third of the window
}
