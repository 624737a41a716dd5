// SPDX-License-Identifier: Apache-2.0
// Tests how the viewer loads scenes while its window is open.
#include <chrono>
#include <cstdio>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <sstream>
#include <thread>

#include <gtest/gtest.h>
#include <unistd.h>

#include "harness/gpu_fixture.h"
#include "harness/paths.h"
#include "io/error.h"
#include "load/load.h"
#include "render/pipeline_watch.h"
#include "scene/scene_error.h"
#include "viewer/scene_loader.h"

namespace
{

using namespace candelabra;

std::string contentOf(const std::filesystem::path& path)
{
    std::stringstream content;
    content << std::ifstream(path, std::ios::binary).rdbuf();
    return content.str();
}

TEST(ViewerLoading, FailsOrEndsWithoutMessages)
{
    using namespace candelabra::test;
    const std::filesystem::path dir = std::filesystem::temp_directory_path() /
                                      ("candelabra_viewer_loading_" + std::to_string(getpid()));
    std::filesystem::create_directories(dir);
    const std::string command = "cd '" + dir.string() + "' && PROGRAM=" + programWord() +
                                " xvfb-run -a bash " + shellWord(dataPath("viewer_loading.sh")) +
                                " >out.txt";
    EXPECT_EQ(std::system(command.c_str()), 0);
    // Exit codes. Validation messages would make them 1.
    EXPECT_EQ(contentOf(dir / "out.txt"), "picture 1: 0\n"
                                          "picture 2: 0\n"
                                          "missing, with a number of frames: 2\n"
                                          "missing, until closed: 2\n"
                                          "closed while loading: 0\n")
        << contentOf(dir / "err.txt") << contentOf(dir / "closed.txt");
    EXPECT_NE(contentOf(dir / "missing.txt").find("missing.glb"), std::string::npos);
    // The scene is never shown if the window is closed before.
    EXPECT_EQ(contentOf(dir / "closed.txt").find("F2 lists"), std::string::npos);
    const std::string picture = contentOf(dir / "1.png");
    EXPECT_FALSE(picture.empty());
    EXPECT_TRUE(picture == contentOf(dir / "2.png")); // same frames, same bits
    if (!HasFailure())
        std::filesystem::remove_all(dir);
}

class SceneLoading : public test::GpuTest
{
protected:
    static app::SceneRequest request(const std::string& scene, uint32_t lights)
    {
        return {.scene = scene,
                .options = {.lights = lights},
                .renderer = {.specularMethods = 1u << CND_SPECULAR_CONIC},
                .view = [](const app::Scene& loaded) {
                    return app::SceneView{loaded.cameras.front(), {64, 48}};
                }};
    }
    // A device on which the engine's pipelines can be watched.
    static app::VulkanContext watchedContext()
    {
        const char* wanted = std::getenv("CANDELABRA_TEST_DEVICE");
        return app::VulkanContext(
            {.device = wanted ? wanted : "",
             .validation = test::validates() ? app::Validation::On : app::Validation::Off,
             .engineFunctions = app::watchedFunctions});
    }
    // Waits for the scene, and throws what loading has thrown.
    static std::unique_ptr<app::LoadedScene> finish(app::SceneLoader& loader)
    {
        while (loader.busy()) {
            if (auto loaded = loader.take())
                return loaded;
            std::this_thread::sleep_for(std::chrono::milliseconds(1));
        }
        return nullptr;
    }
};

TEST_F(SceneLoading, GivesTheSceneThatWasWantedLast)
{
    app::SceneLoader loader(context());
    EXPECT_EQ(loader.take(), nullptr);
    loader.start(request("hall", 20));
    loader.start(request("no such scene", 20));
    loader.start(request("fence", 30));
    const auto loaded = finish(loader);
    ASSERT_NE(loaded, nullptr);
    EXPECT_EQ(loaded->request.scene, "fence");
    EXPECT_EQ(loaded->source.scene, "fence");
    EXPECT_EQ(loaded->renderer->size().width, 64u);
    EXPECT_FALSE(loader.busy());
}

TEST_F(SceneLoading, ReportsAFailureAndCanGoOn)
{
    app::SceneLoader loader(context());
    loader.start(request("no such scene", 20));
    EXPECT_THROW(finish(loader), app::SceneError);
    EXPECT_FALSE(loader.busy());
    app::SceneRequest unseen = request("hall", 20);
    unseen.view = [](const app::Scene&) -> app::SceneView { throw app::UsageError("no camera"); };
    loader.start(std::move(unseen));
    EXPECT_THROW(finish(loader), app::UsageError);
    loader.start(request("hall", 20));
    const auto loaded = finish(loader);
    ASSERT_NE(loaded, nullptr);
    EXPECT_EQ(loaded->scene.lights.size(), 20u);
}

// The number of pipelines is known before the first one is made.
TEST_F(SceneLoading, SaysHowManyShadersThereAre)
{
    app::VulkanContext own = watchedContext();
    for (const char* name : {"hall", "fence"}) {
        app::Scene scene = app::loadScene(name, {.lights = 5});
        scene.environment.emplace().radiance = {
            .width = 2, .height = 1, .channels = 1, .pixels = {1, 2}};
        app::Job job;
        app::makeRenderer(own, scene,
                          {.size = {64, 48}, .specularMethods = 1u << CND_SPECULAR_CONIC}, 0, job);
        unsigned made = 0, all = 0;
        EXPECT_EQ(
            std::sscanf(job.state().doing.c_str(), "Compiling shaders: %u of %u", &made, &all), 2)
            << job.state().doing;
        EXPECT_GT(all, 10u);
        EXPECT_EQ(made, all) << name;
    }
    own.destroyDevice();
    EXPECT_TRUE(own.instance().messages().take().empty());
}

// The window is closed while a scene is loaded: no object of Vulkan is left.
TEST_F(SceneLoading, EndsInTheMiddle)
{
    app::VulkanContext own = watchedContext();
    {
        app::SceneLoader loader(own);
        loader.start(request("hall", 20));
        while (!loader.state().doing.starts_with("Compiling shaders: 3"))
            std::this_thread::sleep_for(std::chrono::milliseconds(1));
    }
    own.destroyDevice();
    const auto messages = own.instance().messages().take();
    EXPECT_TRUE(messages.empty()) << messages.front().text;
}

} // namespace
