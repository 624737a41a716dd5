// SPDX-License-Identifier: Apache-2.0
// Shared by the tests of CND_INFLUENCE_BY_ERROR: a view that renders frame after frame, and its
// display.
#pragma once

#include <algorithm>
#include <cmath>
#include <string>

#include "gpu/lighting_harness.h"
#include "harness/constants.h"
#include "reference/tone_map.h"
#include "shared/influence_data.h"

namespace candelabra::test
{

inline double displayError(const std::vector<glm::vec4>& a, const std::vector<glm::vec4>& b,
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

// Returns the exposure that displays the mean green channel of the lit pixels as middle grey.
inline float exposureFor(const std::vector<glm::vec4>& radiance)
{
    double sum = 0, lit = 0;
    for (const glm::vec4& v : radiance)
        if (v.y > 0) {
            sum += double(v.y);
            ++lit;
        }
    return float(0.18 * lit / sum);
}

inline CpuGBuffer surfaces(bool perspective = true)
{
    CndCamera camera;
    if (perspective)
        setPerspective(camera, 1.0, 1.5, 0.1);
    else
        setOrthographic(camera, 20, 1.5, 0.1, 50);
    return randomGBuffer(96, 64, camera, 0, 11);
}

// Returns a few bright lights and many dim ones.
inline std::vector<CndLight> brightAndDim(const CpuGBuffer& g)
{
    std::vector<CndLight> lights = randomSpheres(g, 120, 12);
    for (size_t i = 10; i < lights.size(); ++i) {
        lights[i].radius = 0.01f;
        for (float& e : lights[i].emission)
            e *= 0.1f;
    }
    return lights;
}

// Returns why a frame skipped a pass; "" if it ran.
inline std::string skipped(const CndLightingStats& stats, const char* pass)
{
    const CndPassPlan* end = stats.passes + stats.passCount;
    const CndPassPlan* p = std::find_if(
        stats.passes, end, [&](const CndPassPlan& x) { return std::string(x.name) == pass; });
    if (p == end) {
        ADD_FAILURE() << "no pass " << pass;
        return "";
    }
    return p->skipped ? p->skipped : "";
}

class InfluenceTest : public LightingTest
{
protected:
    void create(const CpuGBuffer& g, const std::vector<CndLight>& lights)
    {
        own_ = createLighting(
            g, CndLightingDesc{.framesInFlight = 1,
                               .specularMethods = 1u << RunOptions{}.specular,
                               .shading = CND_SHADING_CLUSTERED_BIT | CND_SHADING_BRUTE_BIT,
                               .influenceByError = VK_TRUE});
        set(lights);
        show(g);
    }
    void set(const std::vector<CndLight>& lights) { setLights(own_.lighting, lights); }
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
            EXPECT_EQ(cndRecordLighting(own_.view, cmd, &frame_, &error), CND_SUCCESS)
                << error.message;
        });
        return statsOf(own_.view);
    }
    std::vector<glm::vec4> uncut()
    {
        draw({.rule = CND_INFLUENCE_UNCUT});
        return readRadiance(images_);
    }

    LightingAndView own_;
    Images images_;
    CndLightingFrame frame_{};
    float base_ = 0; // luminance that each pixel has already
};

} // namespace candelabra::test
