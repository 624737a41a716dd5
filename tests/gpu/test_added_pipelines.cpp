// SPDX-License-Identifier: Apache-2.0
// Tests that a module gets further pipelines while it is in use (cndAddLightingPipelines).
#include <atomic>
#include <thread>

#include "candelabra/candelabra.hpp"
#include "gpu/lighting_harness.h"

namespace candelabra::test
{
namespace
{

constexpr uint32_t conic = 1u << CND_SPECULAR_CONIC;

class AddedPipelines : public LightingTest
{
protected:
    void TearDown() override
    {
        view_ = {};
        lighting_ = {};
        images_ = {};
        LightingTest::TearDown();
    }
    // Creates a lighting for conic frames with light lists alone, which lives until the test ends.
    void create(uint32_t materialClasses = 0)
    {
        auto created = Lighting::create(deviceDesc(), {.framesInFlight = 2,
                                                       .specularMethods = conic,
                                                       .shading = CND_SHADING_CLUSTERED_BIT,
                                                       .materialClasses = materialClasses});
        ASSERT_TRUE(created) << created.error().message;
        lighting_ = std::move(created.value());
        auto view = lighting_.createView({.maxWidth = g_.width, .maxHeight = g_.height});
        ASSERT_TRUE(view) << view.error().message;
        view_ = std::move(view.value());
        images_ = uploadImages(g_);
    }
    // Records a frame and returns why it was refused, or nothing.
    std::string refusal(const RunOptions& options)
    {
        std::string out;
        context().submitAndWait([&](VkCommandBuffer cmd) {
            clearRadiance(cmd, images_);
            if (const auto recorded = view_.record(cmd, frameOf(g_, images_, options)); !recorded)
                out = recorded.error().message;
        });
        return out;
    }
    // Draws with the lighting of the test, and with one that was created for these options.
    void expectTheBitsOfANewModule(const std::vector<CndLight>& lights, RunOptions options)
    {
        const std::vector<glm::vec4> wanted = run(g_, lights, options).radiance;
        options.lighting = lighting_.get();
        EXPECT_TRUE(sameBits(run(g_, lights, options).radiance, wanted));
    }

    CpuGBuffer g_ = randomGBuffer(48, 32, 5);
    std::vector<CndLight> spheres_ = randomSpheres(g_, 60, 5);
    Images images_;
    Lighting lighting_;
    LightingView view_;
};

} // namespace

TEST_F(AddedPipelines, FramesAskForNothingElseBefore)
{
    create();
    ASSERT_TRUE(lighting_.setLights(spheres_, {0, 0, 0}));
    const RunOptions plain{.specular = CND_SPECULAR_CONIC};
    EXPECT_EQ(refusal(plain), "");
    const struct {
        RunOptions options;
        uint32_t shading;
        const char* sentence;
    } cases[] = {{{.specular = CND_SPECULAR_CONIC, .culling = CND_CULLING_BRUTE},
                  CND_SHADING_BRUTE_BIT,
                  "culling BRUTE needs CND_SHADING_BRUTE_BIT in CndLightingDesc::shading, or "
                  "cndAddLightingPipelines for specularMethod 5"},
                 {{.specular = CND_SPECULAR_CONIC, .countPairs = true},
                  CND_SHADING_COUNT_PAIRS_BIT,
                  "countPairs needs CND_SHADING_COUNT_PAIRS_BIT"},
                 {{.specular = CND_SPECULAR_CONIC, .errorBudget = 0.01f},
                  CND_SHADING_ERROR_BUDGET_BIT,
                  "errorBudget needs CND_SHADING_ERROR_BUDGET_BIT"},
                 {{.specular = CND_SPECULAR_POINT},
                  CND_SHADING_CLUSTERED_BIT,
                  "specularMethod 2 is not among CndLightingDesc::specularMethods"}};
    for (const auto& c : cases) {
        EXPECT_NE(refusal(c.options).find(c.sentence), std::string::npos) << refusal(c.options);
        ASSERT_TRUE(lighting_.addPipelines(
            {.specularMethods = 1u << c.options.specular, .shading = c.shading}));
        EXPECT_EQ(refusal(c.options), "");
        EXPECT_EQ(refusal(plain), "");
    }
    // What was added one by one works together.
    EXPECT_EQ(refusal({.specular = CND_SPECULAR_CONIC, .countPairs = true, .errorBudget = 0.1f}),
              "");
    EXPECT_EQ(
        refusal(
            {.specular = CND_SPECULAR_CONIC, .culling = CND_CULLING_BRUTE, .errorBudget = 0.1f}),
        "");
    // An error budget needs no pipelines of methods that ignore it.
    EXPECT_EQ(refusal({.specular = CND_SPECULAR_POINT, .errorBudget = 0.1f}), "");
}

TEST_F(AddedPipelines, DrawTheBitsOfANewModule)
{
    create(CND_MATERIAL_DIFFUSE_ONLY);
    std::vector<CndLight> lights = lightsOf(CND_LIGHT_SPOT, g_, 20, 7);
    ASSERT_TRUE(lighting_.setLights(lights, {0, 0, 0})); // a type that is new before a method is
    ASSERT_TRUE(lighting_.addPipelines(
        {.lightTypes = 1u << CND_LIGHT_POINT, .specularMethods = 1u << CND_SPECULAR_KARIS}));
    for (const auto& more : {spheres_, lightsOf(CND_LIGHT_POINT, g_, 20, 8)})
        lights.insert(lights.end(), more.begin(), more.end());
    for (const CndCulling culling : {CND_CULLING_CLUSTERED, CND_CULLING_BRUTE})
        expectTheBitsOfANewModule(lights, {.specular = CND_SPECULAR_KARIS,
                                           .culling = culling,
                                           .countPairs = true,
                                           .materialClasses = CND_MATERIAL_DIFFUSE_ONLY});
}

// One thread adds pipelines, another one records frames and sets lights of a type that is new.
TEST_F(AddedPipelines, WhileFramesAreRecorded)
{
    create();
    ASSERT_TRUE(lighting_.setLights(spheres_, {0, 0, 0}));
    std::atomic<bool> ended = false;
    std::string failure;
    std::thread maker([&] {
        for (const CndSpecularMethod method : {CND_SPECULAR_KARIS, CND_SPECULAR_NONE})
            if (const auto added = lighting_.addPipelines(
                    {.lightTypes = 1u << CND_LIGHT_POINT, .specularMethods = 1u << method});
                !added)
                failure = added.error().message;
        ended = true;
    });
    std::vector<CndLight> lights = spheres_;
    uint32_t frames = 0;
    for (; !ended || frames < 2; ++frames) {
        EXPECT_EQ(refusal({.specular = CND_SPECULAR_CONIC}), "");
        if (frames == 0) {
            lights.push_back(lightsOf(CND_LIGHT_SPOT, g_, 1, 9).front());
            ASSERT_TRUE(lighting_.setLights(lights, {0, 0, 0}));
        }
    }
    maker.join();
    EXPECT_EQ(failure, "");
    for (const CndLight& light : lightsOf(CND_LIGHT_POINT, g_, 10, 10))
        lights.push_back(light);
    for (const CndSpecularMethod method :
         {CND_SPECULAR_CONIC, CND_SPECULAR_KARIS, CND_SPECULAR_NONE})
        expectTheBitsOfANewModule(lights, {.specular = method});
}

} // namespace candelabra::test
