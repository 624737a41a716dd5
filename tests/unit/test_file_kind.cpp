// SPDX-License-Identifier: Apache-2.0
// Tests what is said of files that are no scenes, and that the example files are scenes.
#include <filesystem>
#include <string>

#include <gtest/gtest.h>

#include "generate/examples.h"
#include "harness/temporary_folder.h"
#include "io/image_file.h"
#include "load/load.h"
#include "scene/file_kind.h"
#include "scene/scene_error.h"

using namespace candelabra::app;

namespace
{

class FileKind : public testing::Test, protected candelabra::test::TemporaryFolder
{
protected:
    // Returns why loadScene refuses a file.
    std::string refusal(const std::string& name) const
    {
        try {
            loadScene(path(name), {});
        } catch (const SceneError& error) {
            return error.what();
        }
        return "";
    }
};

} // namespace

TEST_F(FileKind, FilesOfOtherKindsAreSaidAsWhatTheyAre)
{
    using namespace std::string_literals;
    const struct {
        std::string name, bytes, said;
    } cases[] = {
        {"picture.glb", "\x89PNG\r\n\x1a\n0000", "is a PNG image, not a scene"},
        {"photo.gltf", "\xff\xd8\xff\xe0", "is a JPEG image, not a scene"},
        {"sky.hdr", "#?RADIANCE\n", "is a Radiance HDR image, not a scene; --environment"},
        {"sky.exr", "v/1\x01", "is an OpenEXR image, not a scene; --environment"},
        {"house.usd", "PXR-USDC\0\0"s, "is a USD scene; export it as glTF 2.0 (.glb)"},
        {"house.usda", "#usda 1.0\n", "is a USD scene; export it"},
        {"house.usdz", "PK\x03\x04", "is a USD scene; export it"},
        {"house.zip", "PK\x03\x04", "is a ZIP archive; unpack it"},
        {"house.blend", "\x28\xb5\x2f\xfd", "is a Blender file; export it"},
        {"house.fbx", "Kaydara FBX Binary", "is an FBX scene; export it"},
        {"house.obj", "v 0 0 0\n", "is a Wavefront mesh; export it"},
        {"house.dae", "<?xml version", "is a COLLADA scene; export it"},
        {"page.glb", "<!DOCTYPE html>", "is XML or a web page, not a scene"},
        {"pointer.glb", "version https://git-lfs.github.com/spec/v1\n", "\"git lfs pull\""},
        {"noise.glb", "noise", "is not glTF: it begins with neither"},
        {"binary.json", "glTF\x02\0\0\0"s, "is binary glTF, whose name must end in .glb"},
    };
    for (const auto& [name, bytes, said] : cases) {
        write(name, bytes);
        const std::string sentence = refusal(name);
        EXPECT_EQ(
            sentence.rfind(path(name) + ": " + said.substr(0, said[0] == '"' ? 0 : said.size()), 0),
            0u)
            << sentence;
        EXPECT_NE(sentence.find(said), std::string::npos) << sentence;
    }
}

TEST_F(FileKind, FoldersAreSaidWithTheScenesInThem)
{
    EXPECT_NE(refusal("").find("is a folder, not a file; it holds no .gltf, .glb or .json file"),
              std::string::npos)
        << refusal("");
    write("b.GLB", "x");
    write("a.gltf", "x");
    write("readme.txt", "x");
    EXPECT_NE(refusal("").find("is a folder, not a file; it holds a.gltf, b.GLB"),
              std::string::npos)
        << refusal("");
}

TEST_F(FileKind, ScenesAreNoOtherKind)
{
    EXPECT_EQ(otherFileKind("a.glb", "glTF\x02"), "");
    EXPECT_EQ(otherFileKind("a.gltf", " \n {\"asset\""), "");
    EXPECT_EQ(otherFileKind("a.gltf", "\xef\xbb\xbf{\"asset\""), "");
    EXPECT_EQ(otherFileKind("a.json", "{}"), "");
    EXPECT_EQ(otherFileKind("a", "{}"), "");
    EXPECT_EQ(otherFileKind("a.glb", ""), ""); // the reader says that it is empty
}

TEST_F(FileKind, ExampleFilesAreScenes)
{
    writeFileAtomically(path("scene.glb"), exampleGltf());
    const Scene gltf = loadScene(path("scene.glb"), {});
    EXPECT_EQ(gltf.warnings, std::vector<std::string>());
    EXPECT_EQ(gltf.instances.size(), 4u);
    ASSERT_EQ(gltf.lights.size(), 2u);
    EXPECT_EQ(gltf.lights[0].type, uint32_t(CND_LIGHT_SPHERE));
    EXPECT_EQ(gltf.lights[1].type, uint32_t(CND_LIGHT_SPOT));
    EXPECT_NEAR(gltf.lights[1].direction[1], -1, 1e-6);
    EXPECT_EQ(gltf.cameras.at(0).name, "front");

    write("scene.json", exampleSceneJson());
    const Scene jsonScene = loadScene(path("scene.json"), {});
    EXPECT_EQ(jsonScene.analyticObjects.size(), 4u);
    EXPECT_EQ(jsonScene.lights.size(), 3u);

    const Image sky = exampleSky();
    saveHdr(path("sky.hdr"), sky);
    EXPECT_EQ(loadHdr(path("sky.hdr")).width, sky.width);
}

// Root may write everywhere but into the folders of the kernel.
TEST_F(FileKind, RefusalsToWriteAreFoundWithoutWriting)
{
    EXPECT_EQ(writeRefusal(path("new.png")), "");
    EXPECT_TRUE(std::filesystem::is_empty(path()));
    EXPECT_NE(writeRefusal("/proc/new.png"), "");
    EXPECT_NE(writeRefusal(path("no/such/new.png")), "");
}
