// SPDX-License-Identifier: Apache-2.0
// Tests the command line: what is refused, with which message and exit code. Nothing here uses
// Vulkan.
#include <algorithm>
#include <cctype>
#include <memory>
#include <optional>
#include <sstream>
#include <string>
#include <vector>

#include <gtest/gtest.h>
#include <spdlog/sinks/ostream_sink.h>
#include <spdlog/spdlog.h>

#include "commands/help.h"
#include "commands/messages.h"
#include "commands/options.h"
#include "generate/generators.h"
#include "harness/run_program.h"
#include "io/error.h"
#include "io/suggestion.h"
#include "measure/frame/brute_check.h"
#include "measure/frame/pick.h"
#include "render/setting_names.h"

using namespace candelabra::app;
using candelabra::test::runWith;
using Outcome = candelabra::test::ProgramOutcome;

TEST(Cli, ProfileRefusesWhatItCannotCompare)
{
    const auto refused = [](std::vector<const char*> arguments, const std::string& sentence) {
        arguments.insert(arguments.begin(), {"profile", "hall"});
        const Outcome outcome = runWith(arguments);
        EXPECT_EQ(outcome.exitCode, exitUsage);
        EXPECT_NE(outcome.err.find(sentence), std::string::npos) << outcome.err;
    };
    refused({"--path", "x"}, "--path \"x\"");
    refused({"--frames", "0"}, "--frames \"0\"");
    refused({"--frames", "5", "--ab", "", ""}, "--ab needs at least 6");
    refused({"--ab", "--specular foo", ""}, "--ab \"--specular foo\": --specular \"foo\"");
    refused({"--ab", "", "--size 8x8"}, "--ab \"--size 8x8\": size, camera");
    refused({"--ab", "", "--frob"}, "--ab \"--frob\"");
    refused({"--ab", ""}, "--ab");
    refused({"--json", "p", "--csv", "p"}, "--csv writes there");
    refused({"--warm-up", "-1"}, "--warm-up \"-1\"");
    refused({"--frames-in-flight", "9"}, "--frames-in-flight \"9\"");
    refused({"--append"}, "--append: needs --json");
    refused({"--append", "--json", "p", "--ab", "", ""}, "--append: --ab compares by itself");
    refused({"--append", "--json", "p", "--what-if", "off"}, "--append: --what-if compares");
    refused({"--what-if", "reach=0.5"},
            "--what-if reach=0.5: give influence=FACTOR, radius=FACTOR, off or method=NAME");
    refused({"--what-if", "off", "--ab", "", ""}, "--what-if: cannot be combined with --ab");
    refused({"--what-if", "off", "--culling", "brute"}, "--what-if: cannot be combined with");
    refused({"--what-if", "off", "--influence", "uncut"}, "--what-if: needs the given influence");
    refused({"--what-if", "off", "--frames", "5"}, "--what-if needs at least 6");
}

TEST(Cli, RefusesInOneSentenceThatNamesTheArgument)
{
    const struct {
        std::vector<const char*> arguments;
        const char* named;
    } cases[] = {
        {{}, "no command is given; choose from render"},
        {{"bench"}, "no command of bench is given; choose from accuracy"},
        {{"render", "hall", "--lights"}, "--lights: its value is missing"},
        {{"render", "hall", "--seed", "1", "--seed", "2"},
         "--seed: is given 2 times, but may be given once"},
        {{"render"}, "no scene is given"},
        {{"render", "hall"}, "-o"},
        {{"render", "hall", "-o", "x.bmp"}, ".png"},
        {{"render", "hall", "-o", "no/such/dir/x.png"}, "no/such/dir"},
        {{"render", "hall", "-o", "x.png", "--tonemap", "filmic"}, "aces"},
        {{"render", "hall", "-o", "x.png", "--specular", "phong"}, "karis"},
        {{"render", "hall", "-o", "x.png", "--culling", "none"}, "clustered"},
        {{"render", "hall", "-o", "x.png", "--gbuffer", "thin"}, "compact"},
        {{"render", "no_such_file.glb", "-o", "x.png"}, "no_such_file.glb"},
        {{"render", "hall", "extra", "-o", "x.png"}, "\"extra\" is not expected here"},
        {{"render", "hall", "-o", "x.png", "--environment", "sky.png"}, ".hdr"},
        {{"render", "hall", "-o", "x.png", "--lobes", "both"}, "conserving"},
        {{"view", "hall", "--frames", "2", "--screenshot", "x.jpg"}, ".png"},
        {{"truth", "scene.json", "-o", "x.png"}, ".exr"},
        {{"truth", "no_such_scene.json", "-o", "x.exr"}, "no_such_scene.json"},
        {{"render", "hall", "-o", "x.png", "--camera", ""}, "--camera"},
        {{"stress", "--lights", "10,20,10"}, "10 is listed twice"},
        {{"stress", "--fps", "0"}, "--fps \"0\": must be a number from 0.01 to 100000"},
        {{"stress", "--fps", "60", "--lights", "9"}, "--fps: cannot be combined with --lights"},
        {{"stress", "--fps", "60", "--check", "none"}, "--fps: cannot be combined with --check"},
        {{"view", "hall", "--seed="}, "--seed="},
    };
    for (const auto& [arguments, named] : cases) {
        const Outcome outcome = runWith(arguments);
        const std::string typed = arguments.empty() ? "nothing" : arguments.back();
        EXPECT_EQ(outcome.exitCode, exitUsage) << typed << ": " << outcome.err;
        EXPECT_EQ(outcome.out, "") << typed;
        EXPECT_EQ(outcome.err.rfind("candelabra: ", 0), 0u) << outcome.err;
        EXPECT_EQ(std::count(outcome.err.begin(), outcome.err.end(), '\n'), 1) << outcome.err;
        EXPECT_NE(outcome.err.find(named), std::string::npos) << typed << ": " << outcome.err;
    }
}

TEST(Cli, MessagesOfTheParserBecomeSentences)
{
    const struct {
        std::vector<const char*> arguments;
        const char* sentence;
    } cases[] = {
        {{"render"}, "no scene is given"},
        {{"render", "hall", "extra", "-o", "x.png"}, "\"extra\" is not expected here"},
        {{"render", "hall", "4", "5", "-o", "x.png"}, "\"4\" and \"5\" are not expected here"},
        {{"render", "hall", "-o", "x.png", "--explain=no"}, "--explain: takes no value"},
        {{"profile", "hall", "--ab", "x"}, "--ab: needs 2 values"},
        {{"profile", "hall", "--ab", "--lights 4", ""}, "\"--lights\" and \"4\" are not expected"},
        {{"compare", "a"}, "compare: give results"},
        {{"compare", "a.json", "b.PNG"}, "b.PNG is a picture; candelabra diff compares pictures"},
    };
    for (const auto& [arguments, sentence] : cases) {
        const Outcome outcome = runWith(arguments);
        EXPECT_EQ(outcome.exitCode, exitUsage) << sentence;
        EXPECT_NE(outcome.err.find(sentence), std::string::npos) << outcome.err;
        for (const char* word : {"argument", "required", "Could not", "requires"})
            EXPECT_EQ(outcome.err.find(word), std::string::npos) << outcome.err;
    }
}

TEST(Cli, HelpHasExamplesAtEveryLevel)
{
    for (const std::vector<const char*>& arguments : {std::vector<const char*>{"--help"},
                                                      {"render", "--help"},
                                                      {"stress", "--help"},
                                                      {"view", "--help"},
                                                      {"devices", "--help"}}) {
        const Outcome outcome = runWith(arguments);
        EXPECT_EQ(outcome.exitCode, exitOk);
        EXPECT_NE(outcome.out.find("Examples:\n  candelabra "), std::string::npos) << arguments[0];
        EXPECT_EQ(outcome.err, "");
    }
}

TEST(Cli, SaysWhatWasProbablyMeant)
{
    const struct {
        std::vector<const char*> arguments;
        const char* said;
    } cases[] = {
        {{"rendr"}, "did you mean render?"},
        {{"help", "rendr"}, "did you mean render?"},
        {{"help", "bench", "cull"}, "\"cull\" is no command of bench; did you mean"},
        {{"render", "hal", "-o", "x.png"}, "did you mean hall?"},
        {{"render", "hall", "--light", "100", "-o", "x.png"}, "did you mean --lights?"},
        {{"render", "--light=100", "hall", "-o", "x.png"}, "--light: render has no such option"},
        {{"render", "hall", "-lights", "9", "-o", "x.png"}, "did you mean --lights?"},
        {{"render", "hall", "--frobnicate", "-o", "x.png"}, "--frobnicate: render has no such"},
    };
    for (const auto& [arguments, said] : cases) {
        const Outcome outcome = runWith(arguments);
        EXPECT_EQ(outcome.exitCode, exitUsage);
        EXPECT_EQ(std::count(outcome.err.begin(), outcome.err.end(), '\n'), 1) << outcome.err;
        EXPECT_NE(outcome.err.find(said), std::string::npos) << outcome.err;
    }
}

TEST(Cli, HelpIsACommandToo)
{
    EXPECT_EQ(runWith({"help"}).out, runWith({"--help"}).out);
    EXPECT_EQ(runWith({"help", "render"}).out, runWith({"render", "--help"}).out);
    EXPECT_EQ(runWith({"help", "bench", "culling"}).out,
              runWith({"bench", "culling", "--help"}).out);
    EXPECT_EQ(runWith({"-q", "help", "render"}).out, runWith({"render", "--help"}).out);
    EXPECT_NE(runWith({"help", "render"}).out.find("--lights"), std::string::npos);
    EXPECT_NE(runWith({"help"}).out.find("help "), std::string::npos); // is listed itself
}

TEST(Cli, SharedOptionsAreNamedByCommandsAndExplainedOnce)
{
    const std::string render = runWith({"help", "render"}).out;
    const std::string explained = runWith({"help", "options"}).out;
    EXPECT_EQ(runWith({"options"}).out, explained);
    for (const char* option : {"--seed S", "--camera NAME", "--shadows NAME=auto", "--device"}) {
        EXPECT_NE(render.find(option), std::string::npos) << option;
        EXPECT_NE(explained.find(option), std::string::npos) << option;
    }
    EXPECT_NE(runWith({"help", "profile"}).out.find("--shadows NAME=off"), std::string::npos);
    const char* const seed = "random numbers"; // from the description of --seed
    EXPECT_EQ(render.find(seed), std::string::npos);
    EXPECT_NE(explained.find(seed), std::string::npos);
    // Only render has --edge-filter, so it explains it.
    EXPECT_NE(render.find("smooth the edges"), std::string::npos);
}

TEST(Cli, HelpIsWrappedToItsWidth)
{
    CLI::App app("eight words that cannot stand on one line", "candelabra");
    app.formatter(std::make_shared<HelpFormatter>(60, SharedOptions::Named));
    bool flag = false;
    app.add_flag("--name", flag, "some words that need more than the rest of one line of text");
    app.add_flag("--a-name-as-long-as-the-column", flag, "beside");
    EXPECT_EQ(app.help(), "eight words that cannot stand on one line\n\n"
                          "Usage: candelabra [OPTIONS]\n\n"
                          "Options:\n"
                          "  -h,--help                 Print this help message and exit\n"
                          "  --name                    some words that need more than\n"
                          "                            the rest of one line of text\n"
                          "  --a-name-as-long-as-the-column\n"
                          "                            beside\n\n");
    std::istringstream lines(runWith({"help", "options"}).out);
    for (std::string line; std::getline(lines, line);)
        EXPECT_LE(line.size(), terminalWidth()) << line;
}

TEST(Cli, ClosestWordsAreNearEnough)
{
    const std::vector<std::string> known{"--lights", "--lights-visible", "--lod", "--size"};
    EXPECT_EQ(closestWord("--light", known), "--lights");
    EXPECT_EQ(closestWord("-LIGHTS", known), "--lights");
    EXPECT_EQ(closestWord("--szie", known), "--size"); // neighbours exchanged
    EXPECT_EQ(closestWord("--si", known), "--size");   // the beginning of one word
    EXPECT_EQ(closestWord("--l", known), "");
    EXPECT_EQ(closestWord("--color", known), "");
    EXPECT_EQ(closestWord("-x", known), "");
    EXPECT_EQ(closestWord("", known), "");
    EXPECT_EQ(didYouMean("--lodd", known), "; did you mean --lod?");
    EXPECT_EQ(didYouMean("--nothing-like-it", known), "");
}

TEST(Cli, VersionIsTheLibrarys)
{
    const Outcome outcome = runWith({"--version"});
    EXPECT_EQ(outcome.exitCode, exitOk);
    EXPECT_EQ(outcome.out.rfind("candelabra " + std::to_string(CND_VERSION_MAJOR) + ".", 0), 0u)
        << outcome.out;
}

TEST(Cli, HelpNamesTheCamerasOfGeneratedScenes)
{
    std::string help = runWith({"options"}).out;
    help.erase(std::unique(help.begin(), help.end(),
                           [](char a, char b) { return std::isspace(a) && std::isspace(b); }),
               help.end());
    std::replace(help.begin(), help.end(), '\n', ' ');
    const auto expectNames = [&](const std::string& name, const Scene& scene) {
        std::string names = name + ":";
        for (const Camera& camera : scene.cameras)
            names += (names.back() == ':' ? " " : ", ") + camera.name;
        EXPECT_NE(help.find(names), std::string::npos) << names;
    };
    expectNames("hall", generateHall({.lights = 0}));
    expectNames("field", generateField({.lights = 0}));
    expectNames("fence", generateFence({.lights = 0}));
    expectNames("rooms", generateRooms({.lights = 0}));
    expectNames("showcase", generateShowcase({}));
}

// Checks the output of warnOfIdleOptions, as the user sees it.
TEST(Options, IdleOnesAreNamed)
{
    const auto warnings = [](const std::string& scene, std::optional<uint32_t> lights) {
        const auto before = spdlog::default_logger();
        std::ostringstream out;
        spdlog::set_default_logger(std::make_shared<spdlog::logger>(
            "test", std::make_shared<spdlog::sinks::ostream_sink_st>(out)));
        SceneArguments arguments;
        arguments.scene = scene;
        arguments.seed = "2";
        arguments.overlaps = "3";
        arguments.punctualRadius = "0.1";
        arguments.sunRadius = "0.01";
        arguments.emissiveLights = true;
        arguments.moving = true;
        arguments.warnOfIdleOptions(lights);
        spdlog::set_default_logger(before);
        return out.str();
    };
    const auto named = [](const std::string& text) {
        std::string out;
        for (const char* option : {"--seed", "--overlaps", "--moving", "--punctual-radius",
                                   "--sun-radius", "--emissive-lights"})
            if (text.find(std::string(option) + " has no effect") != std::string::npos)
                out += std::string(option) + " ";
        return out;
    };
    EXPECT_EQ(named(warnings("hall", std::nullopt)),
              "--punctual-radius --sun-radius --emissive-lights ");
    EXPECT_EQ(named(warnings("showcase", std::nullopt)),
              "--seed --overlaps --punctual-radius --sun-radius --emissive-lights ");
    EXPECT_EQ(named(warnings("a.glb", std::nullopt)), "--seed --overlaps --moving ");
    EXPECT_EQ(named(warnings("a.glb", 5)), "");
    EXPECT_EQ(named(warnings("a.json", 5)), "--punctual-radius --sun-radius --emissive-lights ");
}

TEST(Options, InfluenceErrorsAreSharesOfTheDisplay)
{
    FrameArguments arguments;
    EXPECT_EQ(arguments.influenceRule().rule, CND_INFLUENCE_GIVEN);
    arguments.influence = "uncut";
    EXPECT_EQ(arguments.influenceRule().rule, CND_INFLUENCE_UNCUT);
    arguments.influence = "given";
    for (const auto& [text, error] :
         {std::pair{"0.5/255", 0.5f / 255}, {"1", 1.0f}, {"2e-3", 2e-3f}}) {
        arguments.influenceError = text;
        EXPECT_EQ(arguments.influenceRule().rule, CND_INFLUENCE_BY_ERROR) << text;
        EXPECT_FLOAT_EQ(arguments.influenceRule().maxError, error) << text;
    }
    for (const char* text : {"0", "-1", "1.01", "2/1", "1/0", "0/0", "/255", "1/", "1/2/3", "x",
                             "nan", "inf", "1e-60", "0.5/-255"}) {
        arguments.influenceError = text;
        EXPECT_THROW(arguments.influenceRule(), UsageError) << text;
    }
    arguments.influenceError = "0.5/255";
    arguments.culling = "brute";
    EXPECT_THROW(arguments.influenceRule(), UsageError);
    arguments.culling = "clustered";
    arguments.influence = "uncut";
    EXPECT_THROW(arguments.influenceRule(), UsageError);
}

// A method that the engine no longer has is refused, and the message names a replacement.
TEST(Options, TransformedCosinesAreRefusedWithASentence)
{
    FrameArguments arguments;
    arguments.specular = "ltc";
    try {
        arguments.specularMethod();
        FAIL();
    } catch (const UsageError& error) {
        EXPECT_STREQ(error.what(),
                     "--specular \"ltc\": only \"candelabra bench accuracy\" still evaluates "
                     "linearly transformed cosines; conic replaces them");
    }
    arguments.specular = "conic";
    EXPECT_EQ(arguments.specularMethod(), CND_SPECULAR_CONIC);
}

// The key that changes the method in the viewer reaches every method.
TEST(Options, EveryMethodFollowsAnother)
{
    CndSpecularMethod method = CND_SPECULAR_NONE;
    for (const Choice<CndSpecularMethod>& choice : specularChoices) {
        EXPECT_EQ(method, choice.value);
        method = nextSpecular(method);
    }
    EXPECT_EQ(method, CND_SPECULAR_NONE);
}

// render --pick refuses frames in which lights cannot be drawn alone; the viewer says so.
TEST(Options, PixelsArePickedWhereLightsCanBeDrawnAlone)
{
    EXPECT_EQ(pickRefusal({.shadows = 32}), "");
    for (const Choice<CndSpecularMethod>& method : specularChoices)
        for (const CndInfluenceRule rule :
             {CND_INFLUENCE_GIVEN, CND_INFLUENCE_UNCUT, CND_INFLUENCE_BY_ERROR}) {
            const std::string refusal =
                pickRefusal({.specular = method.value, .influence = {.rule = rule}});
            EXPECT_EQ(refusal.find("samples") != std::string::npos,
                      method.value == CND_SPECULAR_SAMPLED);
            EXPECT_EQ(refusal.empty(),
                      method.value != CND_SPECULAR_SAMPLED && rule == CND_INFLUENCE_GIVEN)
                << refusal;
        }
}

TEST(Options, ImageSizeComesFromTheOptionTheSceneOrTheCamera)
{
    FrameArguments arguments;
    Scene scene;
    Camera camera;
    const auto size = [&] {
        const PixelSize s = arguments.pixelSize(scene, camera);
        return std::pair(s.width, s.height);
    };
    EXPECT_EQ(size(), std::pair(1280u, 720u));
    camera.aspect = 1.0; // square pixels
    EXPECT_EQ(size(), std::pair(720u, 720u));
    scene.resolution = {256, 128};
    EXPECT_EQ(size(), std::pair(256u, 128u));
    arguments.size = "17x3";
    EXPECT_EQ(size(), std::pair(17u, 3u));
    arguments.size = "20000x3";
    EXPECT_THROW(size(), UsageError);
}

namespace
{

// The sample has at most `pairs` (pixel, light) pairs or, if that is more, minSampledTiles tiles.
// It has at least half as many pairs unless the image has no more pixels, because tiles at the
// border may be cut.
void expectSampleWithinBudget(size_t pixels, size_t imagePixels, uint64_t lights, uint64_t pairs)
{
    constexpr uint64_t tilePixels = sampledTile * sampledTile;
    const uint64_t budget = std::max(pairs, minSampledTiles * tilePixels * lights);
    EXPECT_LE(pixels * lights, budget) << lights;
    EXPECT_GE(pixels * lights, std::min<uint64_t>(imagePixels * lights, budget / 2)) << lights;
}

} // namespace

// Every pixel is in at most one rectangle, and no rectangle extends outside the image.
TEST(Messages, AutomaticExposureSaysWhenItReachesAnEnd)
{
    CndExposureSettings settings{};
    cndDefaultExposureSettings(&settings);
    const auto text = [&](float ev100) {
        return exposureText(settings, Scene{}, false, {.adaptedEv100 = ev100});
    };
    EXPECT_EQ(text(3), "exposed at EV100 3.00 (automatic), middle grey 0.18");
    EXPECT_NE(text(settings.minEv100)
                  .find("-6 is the lower limit of automatic exposure, so the picture may be too "
                        "dark: --compensation EV above 0 or "
                        "--exposure EV below -6 brightens it"),
              std::string::npos);
    EXPECT_NE(text(settings.maxEv100)
                  .find("18 is the upper limit of automatic exposure, so the picture may be too "
                        "bright: --compensation EV below 0 "
                        "or --exposure EV above 18 darkens it"),
              std::string::npos);
    settings.manual = VK_TRUE; // as for the studio
    EXPECT_EQ(text(-6).find("limit"), std::string::npos);
}

TEST(BruteCheck, RectanglesCoverTheImageOnceOrSampleIt)
{
    for (const PixelSize size : {PixelSize{1, 1}, {17, 3}, {641, 359}, {1280, 720}})
        for (const uint64_t lights : {uint64_t(1), uint64_t(4000), uint64_t(16384), uint64_t(16385),
                                      uint64_t(100'000), uint64_t(1'000'000), uint64_t(maxLights)})
            for (const CheckExtent extent :
                 {CheckExtent::Auto, CheckExtent::Sampled, CheckExtent::Full}) {
                SCOPED_TRACE(testing::Message() << size.width << "x" << size.height);
                std::vector<uint8_t> covered(size_t(size.width) * size.height);
                for (const VkRect2D& r : checkRects(size, lights, extent))
                    for (uint32_t y = 0; y < r.extent.height; ++y)
                        for (uint32_t x = 0; x < r.extent.width; ++x) {
                            const uint32_t px = r.offset.x + x, py = r.offset.y + y;
                            ASSERT_LT(px, size.width);
                            ASSERT_LT(py, size.height);
                            ++covered[size_t(py) * size.width + px];
                        }
                EXPECT_EQ(*std::max_element(covered.begin(), covered.end()), 1);
                const size_t count = size_t(std::count(covered.begin(), covered.end(), 1));
                if (extent == CheckExtent::Sampled)
                    expectSampleWithinBudget(count, covered.size(), lights, quickSampledPairs);
                else if (extent == CheckExtent::Full || lights <= 16384)
                    EXPECT_EQ(count, covered.size());
                else
                    expectSampleWithinBudget(count, covered.size(), lights, sampledPairs);
            }
    EXPECT_TRUE(checkRects({64, 64}, 100, CheckExtent::None).empty());
}
