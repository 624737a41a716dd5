// SPDX-License-Identifier: Apache-2.0
// Lights that are cut by an error change no pixel of the display by more, against all light by
// brute force; their history neither jumps nor differs between runs; and without it nothing
// changes.
#include <algorithm>
#include <cmath>
#include <limits>

#include "commands/influence_check.h"
#include "gpu/lighting_harness.h"
#include "reference/tone_map.h"
#include "render/camera.h"
#include "scene/load.h"
#include "shared/influence.h"

namespace candelabra::test
{
namespace
{

constexpr float infinity = std::numeric_limits<float>::infinity();

double displayError(const std::vector<glm::vec4>& a, const std::vector<glm::vec4>& b,
                    const CndInfluence& influence)
{
    double largest = 0;
    for (size_t i = 0; i < a.size(); ++i) {
        const auto linear = [&](const glm::vec4& radiance) {
            return reference::toneMap(influence.toneMap,
                                      double(influence.exposure) * glm::dvec3(radiance));
        };
        const glm::dvec3 x = linear(a[i]), y = linear(b[i]);
        for (int c = 0; c < 3; ++c) {
            EXPECT_TRUE(std::isfinite(a[i][c])) << i;
            largest = std::max(largest,
                               std::abs(reference::srgbEncode(x[c]) - reference::srgbEncode(y[c])));
        }
    }
    return largest;
}

// With which the mean luminance of the lit pixels is middle grey.
float exposureFor(const std::vector<glm::vec4>& radiance)
{
    double sum = 0, lit = 0;
    for (const glm::vec4& v : radiance)
        if (v.y > 0) {
            sum += double(v.y);
            ++lit;
        }
    return float(0.18 * lit / sum);
}

CpuGBuffer surfaces(bool perspective = true)
{
    CndCamera camera;
    if (perspective)
        setPerspective(camera, 1.0, 1.5, 0.1);
    else
        setOrthographic(camera, 20, 1.5, 0.1, 50);
    return randomGBuffer(96, 64, camera, 0, 11);
}

// Few bright lights and many dim ones.
std::vector<CndLight> brightAndDim(const CpuGBuffer& g)
{
    std::vector<CndLight> lights = randomSpheres(g, 120, 12);
    for (size_t i = 10; i < lights.size(); ++i) {
        lights[i].radius = 0.01f;
        for (float& e : lights[i].emission)
            e *= 0.1f;
    }
    return lights;
}

class InfluenceTest : public LightingTest
{
protected:
    void TearDown() override
    {
        cndDestroyLightingView(view_);
        cndDestroyLighting(lighting_);
        LightingTest::TearDown();
    }
    void create(const CpuGBuffer& g, const std::vector<CndLight>& lights)
    {
        CndError error{};
        const CndLightingDesc desc{.structSize = sizeof desc,
                                   .framesInFlight = 1,
                                   .specularMethods = 1u << RunOptions{}.specular,
                                   .influenceByError = VK_TRUE};
        ASSERT_EQ(cndCreateLighting(&deviceDesc(), &desc, &lighting_, &error), CND_SUCCESS)
            << error.message;
        const CndLightingViewDesc viewDesc{sizeof viewDesc, g.width, g.height, 0};
        ASSERT_EQ(cndCreateLightingView(lighting_, &viewDesc, &view_, &error), CND_SUCCESS)
            << error.message;
        const CndLightSet set{
            .structSize = sizeof set, .count = uint32_t(lights.size()), .lights = lights.data()};
        ASSERT_EQ(cndSetLights(lighting_, &set, &error), CND_SUCCESS) << error.message;
        show(g);
    }
    void show(const CpuGBuffer& g)
    {
        images_ = uploadImages(g);
        frame_ = frameOf(g, images_, {});
    }
    CndLightingStats draw(const CndInfluence& influence, bool unchanged = false)
    {
        CndError error{};
        frame_.influence = influence;
        frame_.surfacesUnchanged = unchanged;
        context().submitAndWait([&](VkCommandBuffer cmd) {
            const VkClearColorValue value{{base_, base_, base_, 0}};
            const VkImageSubresourceRange all{VK_IMAGE_ASPECT_COLOR_BIT, 0, 1, 0, 1};
            vkCmdClearColorImage(cmd, images_.radiance.image.get(), VK_IMAGE_LAYOUT_GENERAL, &value,
                                 1, &all);
            fullBarrier(cmd);
            EXPECT_EQ(cndRecordLighting(view_, cmd, &frame_, &error), CND_SUCCESS) << error.message;
        });
        CndLightingStats stats{.structSize = sizeof stats};
        EXPECT_EQ(cndGetLightingStats(view_, 0, &stats), CND_SUCCESS);
        return stats;
    }
    std::vector<glm::vec4> uncut()
    {
        draw({.rule = CND_INFLUENCE_UNCUT});
        return readRadiance(images_);
    }

    CndLighting lighting_{};
    CndLightingView view_{};
    Images images_;
    CndLightingFrame frame_{};
    float base_ = 0; // luminance that is there already
};

// Whole frames of the generated scenes.
TEST_F(InfluenceTest, ScenesStayWithinTheError)
{
    using namespace app;
    for (const char* name : {"hall", "field"}) {
        const Scene scene = loadScene(name, {.lights = 150});
        Renderer renderer(context(), scene,
                          {.size = {128, 72},
                           .framesInFlight = 1,
                           .specularMethods = 1u << CND_SPECULAR_CONIC,
                           .influenceByError = true});
        for (const bool manual : {false, true})
            for (const float levels : {0.5f, 8.0f}) {
                FrameOptions options{
                    .camera = selectCamera(scene, ""),
                    .influence = {.rule = CND_INFLUENCE_BY_ERROR, .maxError = levels / 255}};
                cndDefaultExposureSettings(&options.exposure);
                options.exposure.manual = manual;
                options.exposure.manualEv100 = 5;
                for (int i = 0; i < 2; ++i)
                    context().submitAndWait(
                        [&](VkCommandBuffer cmd) { renderer.record(cmd, 0, options); });
                const InfluenceCheck check = checkInfluence(context(), renderer, options,
                                                            renderer.stats(0), scene.lights.size());
                EXPECT_LE(check.largest, check.bound) << name << " " << influenceText(check);
                if (levels > 1) {
                    EXPECT_GT(check.cutBelow, 0) << name;
                    EXPECT_GT(check.largest, 0) << name;
                }
                RecordProperty(std::string(name) + (manual ? "_manual_" : "_auto_") +
                                   std::to_string(int(2 * levels)),
                               influenceText(check));
            }
    }
}

// Every type, under both projections.
TEST_F(InfluenceTest, EveryTypeStaysWithinTheError)
{
    const CpuGBuffer first = surfaces();
    std::vector<CndLight> lights;
    for (uint32_t type = 0; type < CND_LIGHT_TYPE_COUNT; ++type) {
        const bool distant = type == CND_LIGHT_DIRECTIONAL || type == CND_LIGHT_DISTANT_SPHERE;
        for (CndLight light : lightsOf(CndLightType(type), first, distant ? 2 : 15, 20 + type)) {
            for (float& e : light.emission)
                e *= distant ? 0.01f : 1;
            lights.push_back(light);
        }
    }
    create(first, lights);
    for (const bool perspective : {true, false}) {
        if (!perspective)
            show(surfaces(false));
        frame_.culling = CND_CULLING_BRUTE;
        const std::vector<glm::vec4> truth = uncut();
        frame_.culling = CND_CULLING_CLUSTERED;
        // Another error: a history of its own.
        const CndInfluence influence{.rule = CND_INFLUENCE_BY_ERROR,
                                     .maxError = (perspective ? 8.0f : 9.0f) / 255,
                                     .exposure = exposureFor(truth),
                                     .toneMap =
                                         perspective ? CND_TONEMAP_PBR_NEUTRAL : CND_TONEMAP_AGX};
        EXPECT_GT(draw(influence).cutBelow, 0) << perspective;
        const double error = displayError(readRadiance(images_), truth, influence);
        EXPECT_LE(error, double(influence.maxError)) << perspective;
        EXPECT_GT(error, 0) << perspective;
    }
}

TEST_F(InfluenceTest, WhatIsNotAskedForChangesNothing)
{
    const CpuGBuffer g = surfaces();
    std::vector<CndLight> lights = brightAndDim(g);
    create(g, lights);
    const CndLightingStats given = draw({});
    EXPECT_EQ(given.cutBelow, 0);
    EXPECT_TRUE(sameBits(readRadiance(images_), run(g, lights).radiance));

    // Uncut lights are those with an infinite radius, by brute force as well; and so are lights of
    // frames whose exposure is not known.
    const std::vector<glm::vec4> everywhere = uncut();
    for (CndLight& light : lights)
        light.influenceRadius = infinity;
    EXPECT_LE(maxRelativeDifference(everywhere, run(g, lights).radiance), 1e-5);
    EXPECT_EQ(draw({.rule = CND_INFLUENCE_BY_ERROR, .maxError = 0.5f}).cutBelow, 0);
    EXPECT_TRUE(sameBits(readRadiance(images_), everywhere));
    frame_.culling = CND_CULLING_BRUTE;
    draw({.rule = CND_INFLUENCE_BY_ERROR, .maxError = 0.5f, .exposure = 1});
    EXPECT_LE(maxRelativeDifference(readRadiance(images_), everywhere), 1e-5);
}

TEST_F(InfluenceTest, HistoriesRepeatAndNeitherJumpNorFlicker)
{
    const CpuGBuffer g = surfaces();
    create(g, brightAndDim(g));
    CndInfluence influence{
        .rule = CND_INFLUENCE_BY_ERROR, .maxError = 8.0f / 255, .exposure = exposureFor(uncut())};
    std::vector<float> cuts; // exposed illuminance
    const auto frames = [&](bool white, uint32_t count) {
        base_ = white ? 2 / influence.exposure : 0;
        for (uint32_t i = 0; i < count; ++i)
            cuts.push_back(draw(influence).cutBelow * influence.exposure);
    };
    frames(true, gpu::INFLUENCE_PERIOD); // where no light can be seen
    for (size_t i = 1; i < cuts.size(); ++i)
        EXPECT_LE(cuts[i], cuts[i - 1]) << i;
    const float settled = cuts.back();
    EXPECT_GT(settled, 0);
    // A moment in which less may be missing: cut less at once, and for a whole period.
    const std::vector<glm::vec4> before = readRadiance(images_);
    frames(false, 1);
    const float fallen = cuts.back();
    EXPECT_LT(fallen, settled);
    frames(true, gpu::INFLUENCE_PERIOD - 1);
    EXPECT_EQ(cuts.back(), fallen);
    frames(true, gpu::INFLUENCE_PERIOD + 45);
    EXPECT_EQ(cuts.back(), settled);
    for (size_t i = gpu::INFLUENCE_PERIOD + 1; i < cuts.size(); ++i)
        EXPECT_LE(cuts[i], cuts[i - 1] * 1.415f) << i;
    EXPECT_TRUE(sameBits(readRadiance(images_), before));

    // Another error begins anew, and so does the first: the same bits.
    base_ = 0;
    influence.maxError *= 2;
    draw(influence);
    influence.maxError /= 2;
    EXPECT_GT(draw(influence).cutBelow, 0);
    const std::vector<glm::vec4> first = readRadiance(images_);
    EXPECT_TRUE(sameBits(run(g, brightAndDim(g), {.influence = influence}).radiance, first));
}

TEST_F(InfluenceTest, ListsAreKeptWithTheirRadii)
{
    const CpuGBuffer g = surfaces();
    create(g, brightAndDim(g));
    const CndInfluence influence{
        .rule = CND_INFLUENCE_BY_ERROR, .maxError = 8.0f / 255, .exposure = exposureFor(uncut())};
    const auto skips = [](const CndLightingStats& stats, const char* pass) {
        const CndPassPlan* p =
            std::find_if(stats.passes, stats.passes + stats.passCount,
                         [&](const CndPassPlan& x) { return std::string(x.name) == pass; });
        return std::string(p->skipped ? p->skipped : "");
    };
    const CndLightingStats made = draw(influence);
    const std::vector<glm::vec4> image = readRadiance(images_);
    EXPECT_EQ(skips(made, "measure_influence"), "");
    // The measurement goes on.
    const CndLightingStats again = draw(influence, true);
    EXPECT_EQ(skips(again, "measure_influence"), "");
    EXPECT_EQ(skips(again, "cluster_lists"), "");
    EXPECT_EQ(again.cutBelow, made.cutBelow);
    EXPECT_TRUE(sameBits(readRadiance(images_), image));
    EXPECT_EQ(skips(draw({}, true), "cluster_lists"), "");
    EXPECT_EQ(skips(draw({}, true), "measure_influence"), "not asked for");
}

TEST_F(InfluenceTest, WhatCannotBeMeasuredIsRefused)
{
    const CpuGBuffer g = surfaces();
    create(g, {});
    CndError error{};
    const CndInfluence good{.rule = CND_INFLUENCE_BY_ERROR, .maxError = 0.5f, .exposure = 1};
    const auto refused = [&](CndInfluence influence, const char* field) {
        frame_.influence = influence;
        context().submitAndWait([&](VkCommandBuffer cmd) {
            EXPECT_EQ(cndRecordLighting(view_, cmd, &frame_, &error), CND_ERROR_INVALID_ARGUMENT);
        });
        EXPECT_NE(std::string(error.message).find(field), std::string::npos) << error.message;
    };
    CndInfluence bad = good;
    bad.rule = CndInfluenceRule(3);
    refused(bad, "influence.rule");
    for (const float e : {0.0f, -1.0f, 1.5f, std::nanf("")}) {
        bad = good;
        bad.maxError = e;
        refused(bad, "influence.maxError");
    }
    for (const float e : {-1.0f, infinity, std::nanf("")}) {
        bad = good;
        bad.exposure = e;
        refused(bad, "influence.exposure");
    }
    bad = good;
    bad.toneMap = CND_TONEMAP_COUNT;
    refused(bad, "influence.toneMap");

    const auto [lighting, view] = createLighting(g, 1);
    frame_.influence = good;
    context().submitAndWait([&](VkCommandBuffer cmd) {
        EXPECT_EQ(cndRecordLighting(view, cmd, &frame_, &error), CND_ERROR_INVALID_ARGUMENT);
    });
    EXPECT_NE(std::string(error.message).find("influenceByError"), std::string::npos);
    cndDestroyLightingView(view);
    cndDestroyLighting(lighting);
}

} // namespace
} // namespace candelabra::test
