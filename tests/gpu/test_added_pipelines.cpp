// SPDX-License-Identifier: Apache-2.0
// Tests that a module gets further pipelines while it is in use (cndAddLightingPipelines).
#include <atomic>
#include <span>
#include <string_view>
#include <thread>

#include "candelabra/compiler.hpp"
#include "gpu/kernel.h"
#include "gpu/lighting_harness.h"

namespace candelabra::test
{
namespace
{

constexpr uint32_t conic = 1u << CND_SPECULAR_CONIC;

// Returns the kernels whose names do not begin with `without`.
std::vector<CndKernelCode> kernelsOf(const CompiledKernels& compiled, std::string_view without)
{
    const CndHostKernels all = compiled.hostKernels();
    std::vector<CndKernelCode> out;
    for (const CndKernelCode& code : std::span(all.kernels, all.count))
        if (!std::string_view(code.name).starts_with(without))
            out.push_back(code);
    return out;
}

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
    void create(bool diffuseOnlyTiles = false, const CndHostKernels& hostKernels = {})
    {
        auto created = Lighting::create(deviceDesc(), {.framesInFlight = 2,
                                                       .specularMethods = conic,
                                                       .shading = CND_SHADING_CLUSTERED_BIT,
                                                       .diffuseOnlyTiles = diffuseOnlyTiles,
                                                       .hostKernels = hostKernels});
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
                 {{.specular = CND_SPECULAR_POINT},
                  CND_SHADING_CLUSTERED_BIT,
                  "specularMethod 3 is not among CndLightingDesc::specularMethods"}};
    for (const auto& c : cases) {
        EXPECT_NE(refusal(c.options).find(c.sentence), std::string::npos) << refusal(c.options);
        ASSERT_TRUE(lighting_.addPipelines(
            {.specularMethods = 1u << c.options.specular, .shading = c.shading}));
        EXPECT_EQ(refusal(c.options), "");
        EXPECT_EQ(refusal(plain), "");
    }
}

// KARIS has a smaller value than the method of creation.
TEST_F(AddedPipelines, LeaveTheDefaultMethodAsItWas)
{
    create();
    ASSERT_TRUE(lighting_.addPipelines({.specularMethods = 1u << CND_SPECULAR_KARIS}));
    const auto drawn = [&](CndSpecularMethod method) {
        RunOptions options{.specular = method};
        options.lighting = lighting_.get();
        return run(g_, spheres_, options).radiance;
    };
    EXPECT_TRUE(sameBits(drawn(CND_SPECULAR_DEFAULT), drawn(CND_SPECULAR_CONIC)));
    EXPECT_FALSE(sameBits(drawn(CND_SPECULAR_DEFAULT), drawn(CND_SPECULAR_KARIS)));
}

TEST_F(AddedPipelines, DrawTheBitsOfANewModule)
{
    create(true);
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
                                           .diffuseOnlyTiles = true});
}

// One thread adds pipelines, another one records frames and sets lights of a type that is new.
TEST_F(AddedPipelines, WhileFramesAreRecorded)
{
    create();
    ASSERT_TRUE(lighting_.setLights(spheres_, {0, 0, 0}));
    std::atomic<bool> ended = false;
    std::string failure;
    std::vector<CndLight> lights = spheres_;
    std::jthread maker([&] {
        for (const CndSpecularMethod method : {CND_SPECULAR_KARIS, CND_SPECULAR_NONE})
            if (const auto added = lighting_.addPipelines(
                    {.lightTypes = 1u << CND_LIGHT_POINT, .specularMethods = 1u << method});
                !added)
                failure = added.error().message;
        ended = true;
    });
    uint32_t frames = 0;
    for (; !ended || frames < 2; ++frames) {
        EXPECT_EQ(refusal({.specular = CND_SPECULAR_CONIC}), "");
        if (frames == 0) {
            lights.push_back(lightsOf(CND_LIGHT_SPOT, g_, 1, 9).front());
            EXPECT_TRUE(lighting_.setLights(lights, {0, 0, 0}));
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

TEST_F(AddedPipelines, WrongArgumentsAreRefused)
{
    create();
    ASSERT_TRUE(lighting_.setLights(spheres_, {0, 0, 0}));
    constexpr uint32_t size = sizeof(CndLightingPipelines);
    const CndLightingPipelines good{.structSize = size, .specularMethods = conic};
    const struct {
        CndLighting lighting;
        CndLightingPipelines pipelines;
        const char* sentence;
    } cases[] = {
        {lighting_.get(), {.structSize = size - 4}, "CndLightingPipelines: structSize is "},
        {lighting_.get(),
         {.structSize = size, .lightTypes = 1u << CND_LIGHT_TYPE_COUNT},
         "CndLightingPipelines: lightTypes has bits beyond the last CndLightType"},
        {lighting_.get(),
         {.structSize = size, .specularMethods = 1u << CND_SPECULAR_METHOD_COUNT},
         "CndLightingPipelines: specularMethods"},
        {lighting_.get(),
         {.structSize = size, .shading = CND_SHADING_COUNT_PAIRS_BIT << 1},
         "CndLightingPipelines: shading has bits beyond CndShadingBits"},
        {nullptr, good, "cndAddLightingPipelines"}};
    CndError error{};
    for (const auto& c : cases) {
        EXPECT_EQ(cndAddLightingPipelines(c.lighting, &c.pipelines, &error),
                  CND_ERROR_INVALID_ARGUMENT);
        EXPECT_NE(std::string(error.message).find(c.sentence), std::string::npos) << error.message;
    }
    EXPECT_EQ(cndAddLightingPipelines(lighting_.get(), nullptr, &error),
              CND_ERROR_INVALID_ARGUMENT);
    EXPECT_EQ(refusal({.specular = CND_SPECULAR_CONIC}), "");
}

TEST_F(AddedPipelines, AModuleThatCouldDrawNothingIsRefused)
{
    const auto created = Lighting::create(
        deviceDesc(), {.framesInFlight = 2, .shading = CND_SHADING_COUNT_PAIRS_BIT});
    ASSERT_FALSE(created);
    EXPECT_STREQ(created.error().message,
                 "CndLightingDesc: shading needs CND_SHADING_CLUSTERED_BIT or "
                 "CND_SHADING_BRUTE_BIT, or no frame could be drawn");
}

// The host has compiled no kernels of brute force, and none of rectangles.
TEST_F(AddedPipelines, ARefusedCallLeavesNoTraceForOthers)
{
    auto compiled = CompiledKernels::create(
        {.functions = CND_HOST_VISIBILITY_BIT,
         .source = "float candelabraVisibility(CndShadowQuery q) { return 1.0; }",
         .lightTypes = 1u << CND_LIGHT_SPHERE | 1u << CND_LIGHT_TUBE,
         .specularMethods = conic | 1u << CND_SPECULAR_KARIS});
    ASSERT_TRUE(compiled) << compiled.error().message;
    const std::vector<CndKernelCode> kernels = kernelsOf(compiled.value(), "shade_brute");
    create(false, {uint32_t(kernels.size()), kernels.data(), VK_NULL_HANDLE});

    const auto brute = lighting_.addPipelines({.lightTypes = 1u << CND_LIGHT_TUBE,
                                               .specularMethods = conic,
                                               .shading = CND_SHADING_BRUTE_BIT});
    ASSERT_FALSE(brute);
    EXPECT_NE(std::string(brute.error().message).find("kernel shade_brute:"), std::string::npos)
        << brute.error().message;
    std::vector<CndLight> lights = spheres_;
    lights.push_back(lightsOf(CND_LIGHT_TUBE, g_, 1, 2).front());
    const auto set = lighting_.setLights(lights, {0, 0, 0});
    EXPECT_TRUE(set) << set.error().message;

    std::vector<CndLight> more = lights;
    for (const CndLightType type : {CND_LIGHT_POINT, CND_LIGHT_RECTANGLE})
        more.push_back(lightsOf(type, g_, 1, 3).front());
    EXPECT_FALSE(lighting_.setLights(more, {0, 0, 0}));
    const auto karis = lighting_.addPipelines(
        {.specularMethods = 1u << CND_SPECULAR_KARIS, .shading = CND_SHADING_CLUSTERED_BIT});
    EXPECT_TRUE(karis) << karis.error().message;
    for (const CndSpecularMethod method : {CND_SPECULAR_CONIC, CND_SPECULAR_KARIS})
        EXPECT_EQ(refusal({.specular = method}), "");
}

// Only the kernels of karis spheres use the host's descriptor set.
TEST_F(AddedPipelines, FramesNeedTheHostsSetOnceTheCallHasSucceeded)
{
    constexpr uint32_t karis = 1u << CND_SPECULAR_KARIS;
    const auto compiled = [](uint32_t method, const char* source) {
        return CompiledKernels::create({.functions = CND_HOST_VISIBILITY_BIT,
                                        .source = source,
                                        .lightTypes = 1u << CND_LIGHT_SPHERE,
                                        .specularMethods = method});
    };
    auto plain = compiled(conic, "float candelabraVisibility(CndShadowQuery q) { return 1.0; }");
    auto bound = compiled(karis, R"(
layout(scalar, set = 1, binding = 0) readonly buffer Shadows { float shadows[]; };
float candelabraVisibility(CndShadowQuery q) { return shadows[0]; }
)");
    ASSERT_TRUE(plain && bound);
    std::vector<CndKernelCode> kernels = kernelsOf(plain.value(), "shade_brute");
    for (const CndKernelCode& code : kernelsOf(bound.value(), "shade_brute"))
        kernels.push_back(code);
    const gpu::Bindings set(device(), "shadows", {{0, VK_DESCRIPTOR_TYPE_STORAGE_BUFFER, 1}},
                            VK_SHADER_STAGE_COMPUTE_BIT, 1);
    create(false, {uint32_t(kernels.size()), kernels.data(), set.layout()});
    ASSERT_TRUE(lighting_.setLights(spheres_, {0, 0, 0}));
    const RunOptions plainFrame{.specular = CND_SPECULAR_CONIC};
    EXPECT_EQ(refusal(plainFrame), "");
    // The pipelines of light lists are made before those of brute force, which there are none of.
    EXPECT_FALSE(lighting_.addPipelines(
        {.specularMethods = karis, .shading = CND_SHADING_CLUSTERED_BIT | CND_SHADING_BRUTE_BIT}));
    EXPECT_EQ(refusal(plainFrame), "");
    ASSERT_TRUE(
        lighting_.addPipelines({.specularMethods = karis, .shading = CND_SHADING_CLUSTERED_BIT}));
    EXPECT_NE(refusal(plainFrame).find("hostSet is null"), std::string::npos);
}

} // namespace candelabra::test
