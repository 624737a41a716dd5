// SPDX-License-Identifier: Apache-2.0
// Tests candelabra truth: images, shards and their merging. Nothing here uses Vulkan.
#include <cmath>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <iostream>
#include <string>
#include <vector>

#include <glm/gtc/matrix_transform.hpp>
#include <gtest/gtest.h>

#include "cli.h"
#include "data/path_traced.h"
#include "generate/generators.h"
#include "harness/temporary_folder.h"
#include "io/image.h"
#include "scene/shadow_casters.h"
#include "truth/reference_scene.h"
#include "truth/truth_file.h"
#include "json/scene_json.h"

using namespace candelabra;
using namespace candelabra::app;

namespace
{

constexpr const char* dielectric = R"({"camera": {"position": [0, 0.5, 3],
    "look_at": [0, 0, 0.6476849452607727], "up": [0, 1, 0], "vertical_fov_degrees": 20,
    "aspect": 1},
    "object": {"type": "plane", "point": [0, 0, 0], "normal": [0, 1, 0]},
    "material": {"albedo": [0.2, 0.3, 0.5], "F0": [0.04, 0.04, 0.04], "alpha": 0.1,
                 "metalness": 0},
    "lights": [{"position": [0.5, 1.2, -3], "radius": 0.4, "radiance": [10, 10, 10]}],
    "resolution": [256, 256]})";

class TruthCommand : public testing::Test, protected test::TemporaryFolder
{
protected:
    void SetUp() override { write("scene.json", dielectric); }

    // Returns the exit code; err_ receives what went to stderr.
    int run(std::vector<std::string> arguments)
    {
        arguments.insert(arguments.begin(), {"candelabra", "truth"});
        std::vector<const char*> pointers;
        for (const std::string& argument : arguments)
            pointers.push_back(argument.c_str());
        testing::internal::CaptureStderr();
        const int exitCode = runProgram(static_cast<int>(pointers.size()), pointers.data());
        err_ = testing::internal::GetCapturedStderr();
        return exitCode;
    }
    int runScene(const std::string& output, std::vector<std::string> more)
    {
        more.insert(more.begin(), {path("scene.json"), "-o", path(output), "-q", "--size"});
        return run(more);
    }

    std::string err_;
};

} // namespace

// Tests the whole way from the scene file to pixels against an independent path tracer.
TEST_F(TruthCommand, MatchesThePathTracer)
{
    const Scene scene = loadSceneJson(path("scene.json"));
    const reference::Scene model = toReference(scene, scene.cameras[0], 1, false);
    std::vector<uint32_t> rows;
    for (const auto& pixel : test::dielectricGrazing)
        if (rows.empty() || rows.back() != pixel.row)
            rows.push_back(pixel.row);
    if (rows.size() > 24) // takes half a second on one core
        rows.resize(24);
    const reference::TruthRows truth = reference::renderTruth(model, 256, 256, rows, {});
    double sum = 0, squares = 0;
    int count = 0;
    for (const auto& pixel : test::dielectricGrazing)
        for (size_t i = 0; i < rows.size(); ++i)
            if (rows[i] == pixel.row)
                for (int c = 0; c < 3; ++c) {
                    const double error =
                        truth.pixels[256 * i + pixel.column][c] / pixel.luminance[c] - 1;
                    sum += std::abs(error);
                    squares += error * error;
                    ++count;
                }
    ASSERT_GE(count, 300);
    std::cout << "mean relative error " << sum / count << ", relMSE " << squares / count << " over "
              << count << " values (the path tracer's noise: 0.0052, 2.7e-5)\n";
    EXPECT_LE(sum / count, 0.8 * 0.0052);
    // The sample has only a hundred pixels, and the noise has long tails.
    EXPECT_LE(squares / count, 3 * 0.0052 * 0.0052);
    EXPECT_EQ(truth.unconverged, 0u);
}

TEST_F(TruthCommand, ShardsMergeToTheWholeImage)
{
    ASSERT_EQ(runScene("whole.pfm", {"16x11"}), 0) << err_;
    EXPECT_EQ(err_, "");
    const Image whole = loadPfm(path("whole.pfm"));
    EXPECT_EQ(whole.width, 16u);
    EXPECT_EQ(whole.height, 11u);
    for (const char* shard : {"1/3", "2/3", "3/3"})
        ASSERT_EQ(
            runScene(std::string("part") + shard[0], {"16x11", "--threads", "1", "--shard", shard}),
            0)
            << err_;
    ASSERT_EQ(run({"--merge", path("part3"), path("part1"), path("part2"), "-q", "-o",
                   path("merged.exr")}),
              0)
        << err_;
    EXPECT_EQ(loadExr(path("merged.exr")).pixels, whole.pixels);
    // With more shards than rows, some shards are empty.
    ASSERT_EQ(runScene("empty", {"4x2", "--shard", "3/3"}), 0) << err_;
    EXPECT_TRUE(loadTruthShard(path("empty")).pixels.empty());
}

TEST_F(TruthCommand, MergeRefusesWhatDoesNotBelongTogether)
{
    ASSERT_EQ(runScene("a1", {"8x4", "--shard", "1/2"}), 0);
    ASSERT_EQ(runScene("size2", {"8x6", "--shard", "2/2"}), 0);
    ASSERT_EQ(runScene("count2", {"8x4", "--shard", "2/3"}), 0);
    ASSERT_EQ(runScene("tolerance2", {"8x4", "--shard", "2/2", "--tolerance", "1e-5"}), 0);
    std::string other = dielectric;
    other.replace(other.find("1.2, -3"), 3, "1.3");
    write("scene.json", other);
    ASSERT_EQ(runScene("scene2", {"8x4", "--shard", "2/2"}), 0);
    const auto merge = [&](const std::string& second) {
        return run({"--merge", path("a1"), path(second), "-o", path("out.pfm")});
    };
    for (const char* second : {"size2", "count2", "tolerance2", "scene2", "a1"}) {
        EXPECT_EQ(merge(second), 2) << second;
        EXPECT_NE(err_.find(path(second)), std::string::npos) << err_;
        EXPECT_EQ(std::count(err_.begin(), err_.end(), '\n'), 1) << err_;
    }
    EXPECT_EQ(run({"--merge", path("a1"), "-o", path("out.pfm")}), 2);
    EXPECT_NE(err_.find("shard 2 of 2 is missing"), std::string::npos) << err_;
    // Damage of every kind is detected.
    std::ifstream file(path("a1"), std::ios::binary);
    const std::string good((std::istreambuf_iterator<char>(file)), {});
    for (const size_t at : {size_t(0), good.find('\n') - 5, good.find('\n') + 3, good.size() - 1}) {
        std::string bad = good;
        bad[at] = static_cast<char>(bad[at] ^ 1);
        write("bad", bad);
        EXPECT_THROW(loadTruthShard(path("bad")), ImageError) << at;
    }
    for (const std::string& bad : {good.substr(0, good.size() - 1), good + "x", std::string(),
                                   good.substr(0, 10), std::string(5000, 'a')}) {
        write("bad", bad);
        EXPECT_THROW(loadTruthShard(path("bad")), ImageError) << bad.size();
    }
    EXPECT_FALSE(std::filesystem::exists(path("out.pfm")));
}

// Meshes have a truth. The pixels of --pixels are those of the whole image, the others are NaN, and
// shards of them merge.
TEST_F(TruthCommand, SomePixelsOfMeshesWithShadows)
{
    const auto rooms = [&](const std::string& output, std::vector<std::string> more) {
        more.insert(more.begin(), {"rooms", "--lights", "200", "--size", "16x8", "--lights-visible",
                                   "off", "-q", "-o", path(output)});
        return run(more);
    };
    const std::vector<std::string> some = {"--pixels", "6"};
    const auto with = [&](const std::vector<std::string>& more) {
        std::vector<std::string> all = some;
        all.insert(all.end(), more.begin(), more.end());
        return all;
    };
    ASSERT_EQ(rooms("open.pfm", {"--shadows", "off"}), 0) << err_;
    ASSERT_EQ(rooms("some.pfm", some), 0) << err_;
    EXPECT_EQ(err_, "");
    const Image open = loadPfm(path("open.pfm")), shadowed = loadPfm(path("some.pfm"));
    int computed = 0, darker = 0;
    for (size_t i = 0; i < open.pixels.size(); i += 3)
        if (!std::isnan(shadowed.pixels[i])) {
            ++computed;
            EXPECT_LE(shadowed.pixels[i], open.pixels[i]) << i;
            darker += shadowed.pixels[i] < open.pixels[i];
        }
    EXPECT_EQ(computed, 6);
    EXPECT_GE(darker, 1);
    EXPECT_EQ(rooms("x.hdr", some), 2);
    ASSERT_EQ(rooms("part1", with({"--shard", "1/2"})), 0) << err_;
    ASSERT_EQ(rooms("part2", with({"--shard", "2/2"})), 0) << err_;
    EXPECT_EQ(run({"--merge", path("part1"), path("part2"), "-o", path("merged.hdr")}), 2);
    ASSERT_EQ(run({"--merge", path("part1"), path("part2"), "-q", "-o", path("merged.pfm")}), 0);
    const Image merged = loadPfm(path("merged.pfm"));
    EXPECT_EQ(std::memcmp(merged.pixels.data(), shadowed.pixels.data(),
                          merged.pixels.size() * sizeof(float)),
              0);
    ASSERT_EQ(rooms("other2", with({"--shard", "2/2", "--shadow-seed", "1"})), 0) << err_;
    EXPECT_EQ(run({"--merge", path("part1"), path("other2"), "-o", path("x.pfm")}), 2);
}

TEST_F(TruthCommand, WhatIsLeftOutIsSaid)
{
    Scene scene = generateRooms({.lights = 0});
    EXPECT_TRUE(leftOutByReference(scene).empty());
    EXPECT_TRUE(inexactShadows(scene).empty());
    scene.materials[scene.instances[0].material].alphaMode = AlphaMode::Blend;
    scene.materials[scene.instances[1].material].baseColorTexture.texture = 0;
    scene.environment.emplace();
    EXPECT_EQ(leftOutByReference(scene).size(), 2u);
    EXPECT_EQ(inexactShadows(scene).size(), 1u);
    // The floor is seen, although light passes it.
    const reference::Scene model = toReference(scene, scene.cameras[0], 1, false);
    EXPECT_EQ(model.triangles.size(), 22704u);
    EXPECT_FALSE(model.triangles[0].blocks);
    EXPECT_TRUE(model.triangles[30].blocks);
}

// Mirrored objects keep their front, and an orthographic camera its parallel rays.
TEST_F(TruthCommand, MirroredObjectsAndParallelRays)
{
    Scene scene = generateRooms({.lights = 0});
    scene.instances = {{scene.instances[0].mesh, 0, glm::scale(glm::dmat4(1), {-2, 2, 2})}};
    scene.cameras[0].position = {0.9, 0.9, 5};
    scene.cameras[0].forward = {0, 0, -1};
    scene.cameras[0].up = {0, 1, 0};
    scene.cameras[0].orthographic = true;
    const reference::Scene model = toReference(scene, scene.cameras[0], 1, false);
    const auto hit = tracePixel(model, 1, 1, 0, 0);
    ASSERT_TRUE(hit);
    EXPECT_NEAR(hit->surface.position.z, 1, 1e-12);
    EXPECT_NEAR(hit->surface.normal.z, 1, 1e-12);
    EXPECT_NEAR(hit->surface.toEye.z, 1, 1e-12);
}

// Visible lights are balls that emit light; the surfaces that they light do not change.
TEST_F(TruthCommand, VisibleLightsAreSeen)
{
    std::string facing = dielectric;
    facing.replace(facing.find("[0, 0, 0.6476849452607727]"), 26, "[0.5, 1.2, -3]");
    write("scene.json", facing);
    ASSERT_EQ(runScene("off.pfm", {"3x3"}), 0) << err_;
    ASSERT_EQ(runScene("on.pfm", {"3x3", "--lights-visible", "on"}), 0) << err_;
    const Image off = loadPfm(path("off.pfm")), on = loadPfm(path("on.pfm"));
    EXPECT_EQ(off.pixels[12], 0); // the middle is above the horizon
    EXPECT_EQ(on.pixels[12], 10);
    EXPECT_EQ(on.pixels[0], off.pixels[0]);
}

// Lights that share no layer with the camera are invisible and light nothing.
TEST_F(TruthCommand, LightsOfOtherLayersAreLeftOut)
{
    Scene scene = loadSceneJson(path("scene.json"));
    scene.lights.push_back(scene.lights[0]);
    scene.lights.back().layers = 2;
    Camera camera = scene.cameras[0];
    const auto count = [&](uint32_t layers) {
        camera.layers = layers;
        return toReference(scene, camera, 1, true).lights.size();
    };
    EXPECT_EQ(count(0), 2u);
    EXPECT_EQ(count(1), 1u);
    EXPECT_EQ(count(6), 2u);
}

// Tests rectangles, discs, tubes and distant spheres against the plain meaning of their parameters:
// a camera that looks at a point of the light sees its luminance. A camera that looks just past the
// light's edge, or at the dark back of a one-sided light, does not.
TEST_F(TruthCommand, EveryShapeOfLightIsSeen)
{
    const auto seen = [&](const std::string& light, const char* eye, const char* target) {
        write("shape.json", R"({"camera": {"position": )" + std::string(eye) + R"(, "look_at": )" +
                                target +
                                R"(, "up": [0.1, 1, 0.1], "vertical_fov_degrees": 1, "aspect": 1},
                  "object": {"type": "plane", "point": [0, -9, 0], "normal": [0, 1, 0]},
                  "material": {"albedo": [0, 0, 0], "F0": [0, 0, 0], "specular": false,
                               "alpha": 1, "metalness": 0},
                  "lights": [)" +
                                light + R"(], "background": [0.5, 0.5, 0.5]})");
        EXPECT_EQ(run({path("shape.json"), "-o", path("x.pfm"), "-q", "--size", "1x1",
                       "--lights-visible", "on"}),
                  0)
            << err_;
        return loadPfm(path("x.pfm")).pixels[0];
    };
    const std::string rectangle = R"({"type": "rectangle", "position": [0, 0, 0],
        "axis_u": [1, 0, 0], "axis_v": [0, 2, 0], "luminance": [7, 7, 7])";
    EXPECT_EQ(seen(rectangle + "}", "[0, 0, 5]", "[0.9, 1.9, 0]"), 7);
    EXPECT_NE(seen(rectangle + "}", "[0, 0, 5]", "[1.1, 0, 0]"), 7);
    EXPECT_NE(seen(rectangle + "}", "[0, 0, -5]", "[0, 0, 0]"), 7); // from behind
    EXPECT_EQ(seen(rectangle + R"(, "two_sided": true})", "[0, 0, -5]", "[0, 0, 0]"), 7);
    const std::string disc = R"({"type": "disc", "position": [0, 0, 0], "radius": 1,
        "normal": [0, 0, 1], "luminance": [7, 7, 7]})";
    EXPECT_EQ(seen(disc, "[0, 0, 5]", "[0.7, 0.7, 0]"), 7);
    EXPECT_NE(seen(disc, "[0, 0, 5]", "[0.72, 0.72, 0]"), 7);
    EXPECT_NE(seen(disc, "[0, 0, -5]", "[0, 0, 0]"), 7);
    const std::string tube = R"({"type": "tube", "start": [-2, 0, 0], "end": [2, 0, 0],
        "radius": 0.5, "luminance": [7, 7, 7]})";
    EXPECT_EQ(seen(tube, "[0, 0, 50]", "[1.9, 0.49, 0]"), 7); // its side
    EXPECT_NE(seen(tube, "[0, 0, 50]", "[1.9, 0.52, 0]"), 7);
    EXPECT_EQ(seen(tube, "[0, 0, 50]", "[2.48, 0, 0]"), 7); // its end, which is a hemisphere
    EXPECT_NE(seen(tube, "[0, 0, 50]", "[2.48, 0.3, 0]"), 7);
    EXPECT_EQ(seen(tube, "[9, 0, 0]", "[0, 0, 0]"), 7);  // along the axis
    EXPECT_EQ(seen(tube, "[1, 0, 0]", "[1, 0, -1]"), 7); // from inside
    const std::string sun =
        R"({"type": "distant_sphere", "sin_angular_radius": 0.1, "direction": [0, 0, -1],
        "luminance": [7, 7, 7]})";
    EXPECT_EQ(seen(sun, "[0, 0, 5]", "[0.099, 0, 6]"), 7);
    EXPECT_NE(seen(sun, "[0, 0, 5]", "[0.102, 0, 6]"), 7);
    EXPECT_NE(seen(sun, "[0, 0, 5]", "[0, 0, 4]"), 7);
    EXPECT_EQ(seen(sun + ", " + tube, "[0, 0, 5]", "[0, 0, 0]"), 7);
}

// Conserving lobes reflect less than summed lobes, and energy compensation reflects more.
TEST_F(TruthCommand, LobesShareTheLight)
{
    const auto pixel = [&](std::vector<std::string> more) {
        more.insert(more.begin(), {"1x1"});
        EXPECT_EQ(runScene("lobes.pfm", more), 0) << err_;
        return loadPfm(path("lobes.pfm")).pixels[0];
    };
    const float sum = pixel({}), conserving = pixel({"--lobes", "conserving"});
    EXPECT_EQ(pixel({"--lobes", "sum"}), sum);
    EXPECT_LT(conserving, sum);
    EXPECT_GT(conserving, 0.5f * sum);
    EXPECT_GT(pixel({"--energy-compensation", "on"}), sum);
    EXPECT_EQ(pixel({"--energy-compensation", "off"}), sum);
    EXPECT_EQ(runScene("x.pfm", {"1x1", "--lobes", "both"}), 2);
}

TEST_F(TruthCommand, NothingThatIsReadIsReplaced)
{
    const auto text = [&](const std::string& name) {
        std::ifstream file(path(name), std::ios::binary);
        return std::string((std::istreambuf_iterator<char>(file)), {});
    };
    const std::string before = text("scene.json");
    EXPECT_EQ(runScene("scene.json", {"4x4", "--shard", "1/2"}), 2);
    EXPECT_NE(err_.find("would replace"), std::string::npos) << err_;
    EXPECT_EQ(text("scene.json"), before);
    ASSERT_EQ(runScene("part.pfm", {"4x4", "--shard", "1/1"}), 0) << err_;
    const std::string part = text("part.pfm");
    EXPECT_EQ(run({"--merge", path("part.pfm"), "-o", path("part.pfm")}), 2);
    EXPECT_NE(err_.find("would replace"), std::string::npos) << err_;
    EXPECT_EQ(text("part.pfm"), part);
}

TEST_F(TruthCommand, MergeTakesNoOtherOptions)
{
    ASSERT_EQ(runScene("part", {"4x4", "--shard", "1/1"}), 0) << err_;
    for (const std::vector<std::string>& more : {std::vector<std::string>{"--tolerance", "1e-3"},
                                                 {"--size", "2x2"},
                                                 {"--threads", "1"},
                                                 {"--camera", "0"},
                                                 {"--lights-visible", "on"},
                                                 {"--lobes", "sum"},
                                                 {"--shard", "1/1"},
                                                 {"--shadows", "off"},
                                                 {"--pixels", "1"},
                                                 {"--energy-compensation", "on"}}) {
        std::vector<std::string> arguments = more;
        arguments.insert(arguments.end(), {"-o", path("x.pfm"), "--merge", path("part")});
        EXPECT_EQ(run(arguments), 2) << more[0];
        EXPECT_NE(err_.find(more[0] + " and --merge cannot be combined"), std::string::npos)
            << err_;
    }
    EXPECT_EQ(run({"-q", "-o", path("x.pfm"), "--merge", path("part")}), 0) << err_;
}
