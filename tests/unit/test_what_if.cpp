// SPDX-License-Identifier: Apache-2.0
// Tests what --what-if changes, refuses and says. gpu/test_program.cpp tests what it counts.
#include <cmath>

#include <gtest/gtest.h>

#include "io/error.h"
#include "measure/profile/what_if.h"

namespace candelabra::test
{
namespace
{

using namespace candelabra::app;

// A sphere, a tube, a spot that reaches everywhere, a sun and a directional light.
Scene sceneOfLights()
{
    constexpr float everywhere = INFINITY;
    Scene out;
    out.lights = {
        {.type = CND_LIGHT_SPHERE, .radius = 0.25f, .influenceRadius = 4},
        {.type = CND_LIGHT_TUBE, .radius = 0.125f, .influenceRadius = 2, .axisU = {0.5f, 0, 0}},
        {.type = CND_LIGHT_SPOT, .influenceRadius = everywhere},
        {.type = CND_LIGHT_DISTANT_SPHERE, .radius = 0.25f},
        {.type = CND_LIGHT_DIRECTIONAL}};
    return out;
}

using Lights = std::vector<uint32_t>;

ChangedScene changed(const std::string& text, const Lights& lights)
{
    return changedScene(sceneOfLights(), lights, parseWhatIf(text));
}

std::string refusal(const std::string& text, const Lights& lights = {0, 1, 2, 3, 4})
{
    try {
        changed(text, lights);
    } catch (const UsageError& error) {
        return error.what();
    }
    return "";
}

// A profile of six frames whose shading takes 4 ms, then `b` ms.
Profile profileOf(std::initializer_list<double> b)
{
    const auto seriesOf = [](const std::vector<double>& ms) {
        FrameSeries out{.passes = {{"shade_tiles", ms}}, .gpuMs = ms, .frameMs = ms};
        for (double& frame : out.frameMs)
            frame += 4;
        return out;
    };
    return {.series = {seriesOf(std::vector<double>(6, 4)), seriesOf(b)}};
}

} // namespace

TEST(WhatIf, ChangesTheLightsThatHaveWhatChanges)
{
    const ChangedScene influence = changed("influence=0.5", {1, 0, 2, 3});
    EXPECT_EQ(influence.changed, (Lights{1, 0}));
    EXPECT_EQ(influence.kept, (Lights{2, 3}));
    EXPECT_EQ(influence.scene.lights[0].influenceRadius, 2);
    EXPECT_EQ(influence.scene.lights[1].influenceRadius, 1);
    EXPECT_EQ(influence.scene.lights[1].radius, 0.125f);
    const ChangedScene radius = changed("radius=2", {0, 1, 2, 3, 4});
    EXPECT_EQ(radius.changed, (Lights{0, 1, 3}));
    EXPECT_EQ(radius.kept, (Lights{2, 4}));
    EXPECT_EQ(radius.scene.lights[0].radius, 0.5f);
    EXPECT_EQ(radius.scene.lights[0].influenceRadius, 4);
    EXPECT_EQ(radius.scene.lights[1].radius, 0.25f);
    EXPECT_EQ(radius.scene.lights[1].axisU[0], 1);
    EXPECT_EQ(radius.scene.lights[3].radius, 0.5f);
}

TEST(WhatIf, RemovesLightsWithTheirMotions)
{
    Scene scene = sceneOfLights();
    scene.lightMotions.resize(5);
    for (size_t i = 0; i < 5; ++i)
        scene.lightMotions[i].phase = float(i);
    const ChangedScene off = changedScene(scene, Lights{3, 0, 2}, parseWhatIf("off"));
    EXPECT_EQ(off.changed, (Lights{3, 0, 2}));
    ASSERT_EQ(off.scene.lights.size(), 2u);
    EXPECT_EQ(off.scene.lights[0].type, CND_LIGHT_TUBE);
    EXPECT_EQ(off.scene.lights[1].type, CND_LIGHT_DIRECTIONAL);
    ASSERT_EQ(off.scene.lightMotions.size(), 2u);
    EXPECT_EQ(off.scene.lightMotions[0].phase, 1);
    EXPECT_EQ(off.scene.lightMotions[1].phase, 4);
    EXPECT_EQ(changed("off", {0, 1, 2, 3, 4}).scene.lights.size(), 0u);
}

TEST(WhatIf, RefusesInOneSentence)
{
    for (const char* text : {"reach=0.5", "influence", "influence=", "off=1", "method=", "", "=2"})
        EXPECT_EQ(refusal(text), std::string("--what-if ") + text +
                                     ": give influence=FACTOR, radius=FACTOR, off or method=NAME");
    for (const char* text : {"influence=0", "radius=-1", "radius=x", "influence=1e9"})
        EXPECT_EQ(refusal(text), std::string("--what-if ") + text +
                                     ": the factor must be a number from 0.001 to 1000");
    EXPECT_EQ(refusal("method=phong").rfind("--what-if method \"phong\": choose one of", 0), 0u);
    // The tube is 0.625 m from its centre to its ends.
    EXPECT_EQ(
        refusal("influence=0.25"),
        "--what-if influence=0.25: light 1 would have an influence radius of 0.5 m, which must be "
        "greater than the bounding radius of its emitter, 0.625 m; take a factor above 0.314");
    EXPECT_EQ(refusal("radius=16", {0}),
              "--what-if radius=16: light 0 would have an influence radius of 4 m, which must be "
              "greater than the bounding radius of its emitter, 4 m; take a factor below 15.9");
    EXPECT_EQ(refusal("radius=8", {0, 3}),
              "--what-if radius=8: light 3 would be larger than the sky; take a factor below 3.98");
    EXPECT_EQ(refusal("influence=0.5", {2, 3}),
              "--what-if influence=0.5: lights 2, 3 (2 of 5) have no finite influence radius");
    EXPECT_EQ(refusal("radius=2", {4}), "--what-if radius=2: light 4 (1 of 5) has no size");
    EXPECT_EQ(refusal("off", {}), "--what-if off: there is no light to change");
}

TEST(WhatIf, AnswersInOneSentence)
{
    const WhatIfPairs ten{
        .lights = 4000, .changed = {7, 12, 31, 1, 2, 3, 4, 5, 6, 8}, .a = 2900123, .b = 1240456};
    EXPECT_EQ(
        whatIfText(parseWhatIf("influence=0.5"), ten, profileOf({3, 3, 3, 3, 3, 3})),
        "If lights 7, 12, 31, ... (10 of 4,000) had 0.5 times their influence radii, 1,240,456 "
        "instead of 2,900,123 pairs of light and pixel would be evaluated; shading would take "
        "25.0% less time (25.0% to 25.0%) and the frame 12.5% less time (12.5% to 12.5%).\n");
    EXPECT_EQ(whatIfText(parseWhatIf("radius=2"),
                         {.lights = 5, .changed = {0}, .kept = {4}, .a = 9, .b = 9},
                         profileOf({3, 4, 4, 4, 4, 5})),
              "The change leaves out light 4 (1 of 5), which has no size.\nIf light 0 (1 of 5) "
              "were 2 times as large, the same 9 pairs of light and pixel would be evaluated; "
              "shading would take between 25.0% less and 25.0% more time and the frame between "
              "12.5% less and 12.5% more time.\n");
    EXPECT_EQ(whatIfText(parseWhatIf("off"), {.lights = 2, .changed = {0, 1}, .a = 9},
                         profileOf({0, 0, 0, 0, 0, 0}))
                  .rfind("Without any light, 0 instead of 9 pairs of light and pixel would be "
                         "evaluated; shading would take 100.0% less time (100.0% to 100.0%)",
                         0),
              0u);
    EXPECT_EQ(whatIfText(parseWhatIf("method=karis"), {.lights = 2, .a = 9, .b = 9},
                         profileOf({5, 5, 5, 6, 6, 6})),
              "With --specular karis, the same 9 pairs of light and pixel would be evaluated; "
              "shading would take 37.5% more time (25.0% to 50.0%) and the frame 18.8% more time "
              "(12.5% to 25.0%).\n");
}

} // namespace candelabra::test
