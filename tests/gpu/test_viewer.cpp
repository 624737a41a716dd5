// SPDX-License-Identifier: Apache-2.0
// Tests the viewer under Xvfb, with keys and mouse driven by xdotool.
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <sstream>

#include <gtest/gtest.h>
#include <stb_image.h>
#include <sys/wait.h>
#include <unistd.h>

#include "harness/paths.h"
#include "load/load.h"

namespace
{

struct Shot {
    int width = 0, height = 0;
    double left = 0, right = 0; // means of the halves of the image, 0..255

    double mean() const { return (left + right) / 2; }
};

Shot readShot(const std::filesystem::path& path)
{
    Shot out;
    int channels = 0;
    unsigned char* pixels = stbi_load(path.c_str(), &out.width, &out.height, &channels, 3);
    if (!pixels)
        return out;
    for (int y = 0; y < out.height; ++y)
        for (int x = 0; x < out.width; ++x)
            for (int c = 0; c < 3; ++c)
                (x < out.width / 2 ? out.left : out.right) += pixels[(y * out.width + x) * 3 + c];
    stbi_image_free(pixels);
    out.left /= out.width / 2 * out.height * 3.0;
    out.right /= (out.width - out.width / 2) * out.height * 3.0;
    return out;
}

std::string textOf(const std::filesystem::path& path)
{
    std::stringstream content;
    content << std::ifstream(path).rdbuf();
    return content.str();
}

TEST(Viewer, IsDrivenByKeysAndMouse)
{
    using namespace candelabra::test;
    for (const char* tool : {"xvfb-run", "xdotool"})
        ASSERT_EQ(std::system((std::string("command -v ") + tool + " >/dev/null").c_str()), 0)
            << tool << " is not installed (tools/setup installs it)";
    const std::filesystem::path dir =
        std::filesystem::temp_directory_path() / ("candelabra_viewer_" + std::to_string(getpid()));
    std::filesystem::create_directories(dir);
    const std::string command = "cd '" + dir.string() + "' && PROGRAM=" + programWord() +
                                " xvfb-run -a bash " + shellWord(dataPath("viewer_session.sh")) +
                                " >out.txt 2>err.txt";
    const int status = std::system(command.c_str());
    const std::string err = textOf(dir / "err.txt");
    // A validation message, also one about leaked objects, makes the exit code 1.
    EXPECT_EQ(WIFEXITED(status) ? WEXITSTATUS(status) : -1, 0) << err;

    Shot shots[9];
    for (int i = 1; i <= 8; ++i)
        shots[i] = readShot(dir / ("candelabra-00" + std::to_string(i) + ".png"));
    EXPECT_EQ(shots[1].width, 320);
    EXPECT_EQ(shots[1].height, 200);
    EXPECT_GT(shots[1].mean(), 5);
    EXPECT_GT(shots[2].mean(), shots[1].mean() + 1); // with fixed exposure one more light is
                                                     // brighter
    EXPECT_NEAR(shots[3].mean(), shots[1].mean(), 0.1);
    EXPECT_GT(std::abs(shots[4].left - shots[1].left) + std::abs(shots[4].right - shots[1].right),
              0.1);
    EXPECT_NEAR(shots[6].mean(), shots[5].mean(), 0.5); // brute force shows the same as clusters
    EXPECT_EQ(shots[8].width, 260);
    EXPECT_EQ(shots[8].height, 180);

    // A pixel was picked: it shows a surface, and the sum of its lights is the pixel.
    const size_t at = err.find("pixel 130,150 at (");
    ASSERT_NE(at, std::string::npos) << err;
    const size_t differs = err.find("the sum differs by ", at);
    ASSERT_NE(differs, std::string::npos) << err;
    const std::string pixel = err.substr(err.find("the pixel: ", at) + 11);
    EXPECT_LE(std::stod(err.substr(differs + 19)), 1e-5 * std::stod(pixel)) << err;

    // A scene was saved: the hall with its lights as they are now, which can be loaded and
    // rendered.
    using namespace candelabra;
    const std::string saved = (dir / "candelabra-010.json").string();
    const app::Scene scene = app::loadScene(saved, {}),
                     hall = app::loadScene("hall", {.lights = 80});
    EXPECT_EQ(scene.lights.size(), hall.lights.size());
    EXPECT_EQ(scene.instances.size(), hall.instances.size());
    EXPECT_NE(scene.cameras[0].position, hall.cameras[0].position);
    if (!HasFailure())
        std::filesystem::remove_all(dir);
}

} // namespace
