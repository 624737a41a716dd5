// SPDX-License-Identifier: Apache-2.0
// Whatever bytes a loader gets, it returns a scene that satisfies its invariants, or fails with one
// sentence. Meant to run under the address and undefined-behaviour sanitizers.
#include <gtest/gtest.h>

#include "harness/full_tests.h"
#include "load/load.h"
#include "scene/scene_error.h"
#include "unit/broken_scene_cases.h"
#include "unit/scene_invariants.h"

namespace candelabra::test
{

namespace
{

using namespace candelabra::app;

// Returns what is wrong with the message; empty if it is one sentence about `file` that contains
// `element`.
std::string unfitMessage(const std::string& message, const std::string& file,
                         const std::string& element)
{
    if (message.find(file + ": ") != 0)
        return "does not begin with the file: " + message;
    for (const char c : message)
        if (c < 0x20 || c > 0x7e)
            return "is not one line of plain text: " + message;
    if (message.size() > file.size() + 400)
        return "is too long: " + message;
    if (message.find(element, file.size()) == std::string::npos)
        return "does not mention \"" + element + "\": " + message;
    return "";
}

// A broken file is refused, or loaded with a warning that names the element.
void expectRefusedOrWarned(const TemporaryFolder& folder, const BrokenCase& broken)
{
    const std::string file = folder.write(broken.file, broken.bytes);
    try {
        const Scene scene = loadScene(file, {});
        EXPECT_EQ(brokenInvariant(scene), "") << broken.name;
        ASSERT_TRUE(broken.isRepaired) << broken.name << " (" << broken.file << "): was loaded";
        ASSERT_FALSE(scene.warnings.empty()) << broken.name;
        EXPECT_LE(scene.warnings.size(), 2u) << broken.name << ": " << scene.warnings.back();
        EXPECT_EQ(unfitMessage(scene.warnings[0], file, broken.element), "") << broken.name;
    } catch (const SceneError& e) {
        EXPECT_EQ(unfitMessage(e.what(), file, broken.element), "") << broken.name;
        EXPECT_FALSE(broken.isRepaired) << e.what();
    } catch (const std::exception& e) {
        ADD_FAILURE() << broken.name << " (" << broken.file << "): " << e.what();
    }
}

TEST(BrokenScenes, TheScenesTheyAreMadeFromAreFine)
{
    const TemporaryFolder folder;
    for (const std::string& file : {folder.write("scene.gltf", completeGltf().text()),
                                    folder.write("scene.glb", completeGltf().glb()),
                                    folder.write("scene.json", completeSceneJson())}) {
        const Scene scene = loadScene(file, {});
        EXPECT_EQ(brokenInvariant(scene), "") << file;
        EXPECT_FALSE(scene.lights.empty()) << file;
        EXPECT_TRUE(scene.warnings.empty()) << scene.warnings.at(0);
    }
}

TEST(BrokenScenes, AreMany)
{
    EXPECT_GE(brokenGltfCases().size(), 200u);
    EXPECT_GE(brokenContainerCases().size(), 50u);
    EXPECT_GE(brokenSceneJsonCases().size(), 20u);
}

TEST(BrokenScenes, GltfContent)
{
    const TemporaryFolder folder;
    for (const BrokenCase& broken : brokenGltfCases())
        expectRefusedOrWarned(folder, broken);
}

TEST(BrokenScenes, Containers)
{
    const TemporaryFolder folder;
    for (const BrokenCase& broken : brokenContainerCases())
        expectRefusedOrWarned(folder, broken);
}

TEST(BrokenScenes, SceneDescriptions)
{
    const TemporaryFolder folder;
    for (const BrokenCase& broken : brokenSceneJsonCases())
        expectRefusedOrWarned(folder, broken);
}

TEST(BrokenScenes, WhatIsNoFile)
{
    const TemporaryFolder folder;
    const auto message = [](const std::string& scene) {
        try {
            loadScene(scene, {});
        } catch (const SceneError& e) {
            return std::string(e.what());
        }
        return std::string("no error");
    };
    folder.write("folder.gltf/x", std::string("x"));
    EXPECT_EQ(unfitMessage(message(folder.path("folder.gltf")), folder.path("folder.gltf"),
                           "is a folder"),
              "");
    EXPECT_EQ(unfitMessage(message(folder.path("none.glb")), folder.path("none.glb"),
                           "cannot be opened: No such file"),
              "");
    EXPECT_EQ(unfitMessage(message("/dev/null"), "/dev/null", "is not a regular file"), "");
    EXPECT_EQ(message("barn"),
              "unknown scene \"barn\": use hall, field, fence, rooms, showcase, or the path of "
              "a .gltf, .glb or .json file");
    EXPECT_EQ(
        message(""),
        "unknown scene \"\": use hall, field, fence, rooms, showcase, or the path of a .gltf, "
        ".glb or .json file");
    const std::string text = folder.write("notes.txt", std::string("a scene"));
    EXPECT_EQ(unfitMessage(message(text), text, "is neither glTF"), "");
}

// Accessors without a buffer view take no bytes in the file, and a triangle strip turns each vertex
// into three corners.
TEST(BrokenScenes, FewBytesCannotFillTheMemory)
{
    GltfBuilder b = triangleScene();
    const int positions = b.accessor(-1, componentFloat, "VEC3", size_t{1} << 24);
    b.rootNode({{"mesh", b.mesh({{"attributes", {{"POSITION", positions}}}, {"mode", 5}})}});
    const std::string text = b.text();
    expectRefusedOrWarned(TemporaryFolder(),
                          {"zeros", "scene.gltf", Bytes(text.begin(), text.end()),
                           "meshes[1].primitives[0]: brings the scene above 33554432 "
                           "vertices"});
}

// --- random damage from fixed seeds

// splitmix64 (Steele, Lea and Flood 2014), which gives the same numbers on every platform.
class Random
{
public:
    explicit Random(uint64_t seed) : state_(seed) {}
    uint64_t below(uint64_t n) { return next() % n; }

private:
    uint64_t next()
    {
        uint64_t z = (state_ += 0x9e3779b97f4a7c15);
        z = (z ^ (z >> 30)) * 0xbf58476d1ce4e5b9;
        z = (z ^ (z >> 27)) * 0x94d049bb133111eb;
        return z ^ (z >> 31);
    }
    uint64_t state_;
};

struct Outcome {
    int loaded = 0;
    int refused = 0;
};

void tryToLoad(const TemporaryFolder& folder, const std::string& name, const Bytes& bytes,
               Outcome& outcome)
{
    const std::string file = folder.write(name, bytes);
    try {
        const Scene scene = loadScene(file, {});
        ++outcome.loaded;
        EXPECT_EQ(brokenInvariant(scene), "");
    } catch (const SceneError& e) {
        ++outcome.refused;
        EXPECT_EQ(unfitMessage(e.what(), file, ""), "");
    }
}

// How many of `all` random files are tried: with the sanitizers, which take ten times as long, a
// quarter of them unless --full is given.
int tried(int all)
{
    return sanitized && !fullTests() ? all / 4 : all;
}

Bytes damaged(Bytes bytes, Random& random)
{
    const uint64_t count = 1 + random.below(4);
    for (uint64_t i = 0; i < count && !bytes.empty(); ++i) {
        const size_t at = random.below(bytes.size());
        const auto from = bytes.begin() + static_cast<ptrdiff_t>(at);
        const auto length =
            static_cast<ptrdiff_t>(std::min<uint64_t>(random.below(9), bytes.size() - at));
        switch (random.below(5)) {
        case 0:
            bytes[at] = static_cast<uint8_t>(bytes[at] ^ (1u << random.below(8)));
            break;
        case 1:
            bytes[at] = static_cast<uint8_t>(random.below(256));
            break;
        case 2:
            bytes.erase(from, from + length);
            break;
        case 3: {
            const Bytes copy(from, from + length);
            bytes.insert(from, copy.begin(), copy.end());
            break;
        }
        default: // replaces digits by digits, which keeps the JSON valid and changes numbers
            for (size_t k = at; k < bytes.size(); ++k)
                if (bytes[k] >= '0' && bytes[k] <= '9') {
                    bytes[k] = static_cast<uint8_t>('0' + random.below(10));
                    break;
                }
        }
    }
    return bytes;
}

TEST(BrokenScenes, RandomBytes)
{
    const TemporaryFolder folder;
    const std::string gltf = completeGltf().text(), scene = completeSceneJson();
    const std::pair<const char*, Bytes> files[] = {
        {"scene.gltf", Bytes(gltf.begin(), gltf.end())},
        {"scene.glb", completeGltf().glb()},
        {"scene.json", Bytes(scene.begin(), scene.end())}};
    Random random(1);
    for (const auto& [name, bytes] : files) {
        Outcome outcome;
        for (int i = 0; i < tried(700) && !testing::Test::HasFailure(); ++i) {
            SCOPED_TRACE(std::string(name) + ", damage " + std::to_string(i));
            tryToLoad(folder, name, damaged(bytes, random), outcome);
        }
        EXPECT_GT(outcome.refused, tried(100)) << name;
        EXPECT_GT(outcome.loaded, tried(10)) << name; // some damage must leave the scene loadable
    }
}

// Puts another value at a random place of the JSON: this passes the parser and gets deep into the
// loader.
TEST(BrokenScenes, RandomValues)
{
    const Json values = Json::parse(R"([null, true, -1, 0, 1, 2, 3, 7, 255, 65536, 4294967295,
        4294967296, 18446744073709551615, -9223372036854775808, 0.5, -0.0, 1e-300, 1e39, 1e300, "",
        "VEC2", "VEC4", "SCALAR", "sphere", "..", [], [0], [1, 2, 3], [0, 0, 0, 0], {},
        {"index": 0}, 5120, 5121, 5123, 5125, 5126])");
    const TemporaryFolder folder;
    Random random(2);
    const std::pair<const char*, Json> files[] = {
        {"scene.gltf", Json::parse(completeGltf().text())},
        {"scene.json", Json::parse(completeSceneJson())}};
    for (const auto& [name, valid] : files) {
        const Json flat = valid.flatten();
        std::vector<std::string> pointers;
        for (const auto& entry : flat.items())
            pointers.push_back(entry.key());
        Outcome outcome;
        for (int i = 0; i < tried(1500) && !testing::Test::HasFailure(); ++i) {
            Json json = valid;
            for (uint64_t k = 0; k < 1 + random.below(3); ++k) {
                Json::json_pointer pointer(pointers[random.below(pointers.size())]);
                for (uint64_t up = random.below(4); up > 2 && !pointer.empty(); --up)
                    pointer.pop_back();
                try {
                    json.at(pointer) = values[random.below(values.size())];
                } catch (const Json::exception&) {
                    // an earlier change removed this place
                }
            }
            const std::string text = json.dump();
            SCOPED_TRACE(std::string(name) + ", value " + std::to_string(i));
            tryToLoad(folder, name, Bytes(text.begin(), text.end()), outcome);
        }
        EXPECT_GT(outcome.refused, tried(200)) << name;
        EXPECT_GT(outcome.loaded, tried(50)) << name;
    }
}

} // namespace

} // namespace candelabra::test
