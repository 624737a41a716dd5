// SPDX-License-Identifier: Apache-2.0
// Tests of CND_INFLUENCE_BY_ERROR: cut lights change no pixel of the display by more than the
// error, compared with brute force under all light. Nothing is measured that should not be, and
// other rules are unaffected.
#include <algorithm>

#include "gpu/influence_harness.h"
#include "harness/paths.h"
#include "load/load.h"
#include "measure/frame/influence_check.h"
#include "render/camera.h"
#include "shared/raster.h"

namespace candelabra::test
{
namespace
{

// Whole frames of two generated scenes.
TEST_F(InfluenceTest, ScenesStayWithinTheError)
{
    using namespace app;
    for (const char* name : {"hall", "field"}) {
        Scene scene = loadScene(name, {.lights = 150});
        // On some devices fewer instances than the field has fit in a texel buffer.
        scene.instances.resize(std::min<size_t>(
            scene.instances.size(), device().limits.maxTexelBufferElements / gpu::INSTANCE_TEXELS));
        Renderer renderer(context(), scene,
                          {.size = {96, 54},
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
                const FrameStats last = renderer.stats(0);
                for (const char* pass : {"measure_influence", "cut_lights"})
                    EXPECT_EQ(skipped(last.lighting, pass), "") << name;
                const InfluenceCheck check =
                    checkInfluence(context(), renderer, options, last, scene.lights.size());
                EXPECT_LE(check.largest, check.bound) << name << " " << influenceText(check);
                // Some light is cut, and the cut has an effect.
                EXPECT_GT(check.cutBelow, 0) << name << " " << levels;
                EXPECT_GT(check.largest, 0) << name << " " << levels;
                RecordProperty(std::string(name) + (manual ? "_manual_" : "_auto_") +
                                   std::to_string(int(2 * levels)),
                               influenceText(check));
            }
    }
}

// If lamps add little to the existing light, their lists are short.
TEST_F(InfluenceTest, LampsByDayEndWhereTheDisplayDoesNotTell)
{
    using namespace app;
    const Scene scene = loadScene(dataPath("noon.json"), {.lights = 1000});
    Renderer renderer(context(), scene,
                      {.size = {64, 36},
                       .framesInFlight = 1,
                       .specularMethods = 1u << CND_SPECULAR_CONIC,
                       .influenceByError = true});
    FrameOptions options{.camera = selectCamera(scene, ""),
                         .influence = {.rule = CND_INFLUENCE_BY_ERROR, .maxError = 2.0f / 255}};
    cndDefaultExposureSettings(&options.exposure);
    // A darker picture than the default, in which the display shows less of the lamps.
    options.exposure.middleGrey = 0.0852f;
    const auto entries = [&](CndInfluenceRule rule) {
        options.influence.rule = rule;
        for (int i = 0; i < 2; ++i)
            context().submitAndWait([&](VkCommandBuffer cmd) { renderer.record(cmd, 0, options); });
        return renderer.stats(0).lighting.listEntries;
    };
    const uint32_t all = entries(CND_INFLUENCE_UNCUT);
    EXPECT_LT(entries(CND_INFLUENCE_BY_ERROR), all / 3);
    const InfluenceCheck check =
        checkInfluence(context(), renderer, options, renderer.stats(0), scene.lights.size());
    EXPECT_LE(check.largest, check.bound) << influenceText(check);
}

// Lights of every type, with both kinds of projection.
TEST_F(InfluenceTest, EveryTypeStaysWithinTheError)
{
    const CpuGBuffer first = surfaces();
    std::vector<CndLight> lights;
    for (uint32_t type = 0; type < CND_LIGHT_TYPE_COUNT; ++type) {
        const bool distant = cndIsDistant(type);
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
        // Another maxError starts a history of its own.
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

    // Uncut lights equal lights with an infinite radius, also by brute force. So do lights of
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

// Lights of other layers are not measured, and a frame whose layers contain no light does nothing.
TEST_F(InfluenceTest, LayersAreMeasuredAlone)
{
    const CpuGBuffer g = surfaces();
    std::vector<CndLight> shown = brightAndDim(g);
    for (CndLight& light : shown)
        light.layers = 1;
    create(g, shown);
    const CndInfluence influence{
        .rule = CND_INFLUENCE_BY_ERROR, .maxError = 8.0f / 255, .exposure = exposureFor(uncut())};
    const CndLightingStats alone = draw(influence);
    EXPECT_GT(alone.cutBelow, 0);
    const std::vector<glm::vec4> expected = readRadiance(images_);
    // The copies are at the same places, which keeps the order, and so many that lanes take their
    // lights in blocks.
    std::vector<CndLight> all;
    for (const CndLight& light : shown) {
        all.insert(all.end(), 14, light);
        for (size_t i = all.size() - 13; i < all.size(); ++i) {
            all[i].layers = 2;
            all[i].emission[1] += 1000;
        }
        all.back().type = CND_LIGHT_TUBE;
        all.back().radius = 0.005f;
        all.back().axisU[0] = 0.001f;
    }
    set(all);
    frame_.layers = 1;
    CndInfluence other = influence;
    other.maxError *= 2;
    draw(other); // starts a history of its own for what follows
    EXPECT_EQ(draw(influence).cutBelow, alone.cutBelow);
    EXPECT_TRUE(sameBits(readRadiance(images_), expected));
    for (const CndInfluenceRule rule : {CND_INFLUENCE_UNCUT, CND_INFLUENCE_BY_ERROR}) {
        other.rule = rule;
        frame_.layers = 4;
        const CndLightingStats none = draw(other);
        EXPECT_EQ(skipped(none, "shade_tiles"), "no light of the view's layers") << rule;
        EXPECT_EQ(none.cutBelow, 0) << rule;
    }
}

// Given radii must have no effect where they do not apply, not even on which tiles are split.
TEST_F(InfluenceTest, GivenRadiiChangeNothing)
{
    const CpuGBuffer g = surfaces();
    std::vector<CndLight> lights = brightAndDim(g);
    create(g, lights);
    const CndInfluence influence{
        .rule = CND_INFLUENCE_BY_ERROR, .maxError = 8.0f / 255, .exposure = exposureFor(uncut())};
    std::vector<std::vector<glm::vec4>> images;
    for (const float radius : {0.1f, 1000.0f}) {
        for (CndLight& light : lights) {
            light.radius = 0.01f;
            light.influenceRadius = radius;
        }
        set(lights);
        EXPECT_EQ(draw({}).splitTileCount > 0, radius < 1);
        for (const CndInfluenceRule rule : {CND_INFLUENCE_UNCUT, CND_INFLUENCE_BY_ERROR}) {
            CndInfluence other = influence;
            other.rule = rule;
            EXPECT_EQ(draw(other).splitTileCount, 0u) << radius << " " << rule;
            images.push_back(readRadiance(images_));
        }
    }
    EXPECT_TRUE(sameBits(images[2], images[0]));
    EXPECT_TRUE(sameBits(images[3], images[1]));
}

TEST_F(InfluenceTest, WhatCannotBeMeasuredIsRefused)
{
    const CpuGBuffer g = surfaces();
    create(g, {});
    CndError error{};
    const CndInfluence good{.rule = CND_INFLUENCE_BY_ERROR, .maxError = 0.5f, .exposure = 1};
    const auto refused = [&](CndInfluence influence, const char* field) {
        frame_.influence = influence;
        expectRefused(own_.view, frame_, field);
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

    frame_.influence = good;
    expectRefused(createLighting(g, 1).view, frame_, "influenceByError");

    // Host kernels contain no kernel that measures.
    const CndKernelCode kernel{};
    const CndLightingDesc desc{.structSize = sizeof desc,
                               .framesInFlight = 1,
                               .hostKernels = {.count = 1, .kernels = &kernel},
                               .influenceByError = VK_TRUE};
    CndLighting none{};
    EXPECT_EQ(cndCreateLighting(&deviceDesc(), &desc, &none, &error), CND_ERROR_INVALID_ARGUMENT);
    EXPECT_NE(std::string(error.message).find("influenceByError"), std::string::npos)
        << error.message;
}

} // namespace
} // namespace candelabra::test
