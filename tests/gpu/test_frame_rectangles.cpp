// SPDX-License-Identifier: Apache-2.0
// A frame may be a rectangle inside its images (CndLightingFrame::x and y). It has the bits of the
// same frame in images of its own, and leaves everything else in its images alone.
#include <algorithm>
#include <cstring>

#include "gpu/environment_harness.h"

namespace candelabra::test
{
namespace
{

// Puts the pixels of `g` into those of a larger G-buffer.
CpuGBuffer inside(const CpuGBuffer& g, uint32_t x0, uint32_t y0)
{
    CpuGBuffer out = randomGBuffer(101, 75, 6);
    out.camera = g.camera;
    const auto put = [&](auto CpuGBuffer::*pixels) {
        for (uint32_t y = 0; y < g.height; ++y)
            std::copy_n((g.*pixels).begin() + y * g.width, g.width,
                        (out.*pixels).begin() + (y0 + y) * out.width + x0);
    };
    put(&CpuGBuffer::normalRoughness);
    put(&CpuGBuffer::albedo);
    put(&CpuGBuffer::specular);
    put(&CpuGBuffer::depth);
    return out;
}

class FrameRectangles : public EnvironmentTest
{
protected:
    static constexpr uint32_t width = 64, height = 48;
    static constexpr VkImageAspectFlags colour = VK_IMAGE_ASPECT_COLOR_BIT;

    // Where a frame is drawn: surfaces of a whole image or of a part of it, and images of results.
    struct Place {
        uint32_t x, y;
        CpuGBuffer g;
        Images images;
        std::vector<gpu::Image> results; // layout GENERAL; all zero before a frame
    };

    Place placeOf(const CpuGBuffer& g, uint32_t x, uint32_t y)
    {
        Place place{x, y, g, uploadImages(g), {}};
        for (const VkFormat format : {VK_FORMAT_R32G32B32A32_SFLOAT, VK_FORMAT_R32G32B32A32_SFLOAT,
                                      VK_FORMAT_R8G8B8A8_UNORM})
            place.results.push_back(gpu::createImage(device(), "result", format, g.width, g.height,
                                                     VK_IMAGE_USAGE_STORAGE_BIT |
                                                         VK_IMAGE_USAGE_TRANSFER_SRC_BIT |
                                                         VK_IMAGE_USAGE_TRANSFER_DST_BIT,
                                                     colour));
        return place;
    }
    void clear(VkCommandBuffer cmd, const Place& place)
    {
        const VkClearColorValue zero{};
        const VkImageSubresourceRange all{colour, 0, 1, 0, 1};
        for (const gpu::Image& image : place.results) {
            transition(cmd, image.image.get(), colour, VK_IMAGE_LAYOUT_UNDEFINED,
                       VK_IMAGE_LAYOUT_GENERAL);
            vkCmdClearColorImage(cmd, image.image.get(), VK_IMAGE_LAYOUT_GENERAL, &zero, 1, &all);
        }
        clearRadiance(cmd, place.images);
    }
    template <typename Frame>
    static Frame frameAt(const Place& place)
    {
        Frame frame = surfaceFrame<Frame>(place.g, place.images);
        frame.x = place.x;
        frame.y = place.y;
        frame.width = width;
        frame.height = height;
        return frame;
    }

    std::vector<std::byte> read(const gpu::Image& image, uint32_t bytes) const
    {
        return readImage(image, colour, VK_IMAGE_LAYOUT_GENERAL, bytes);
    }
    // Expects that an image of parts_ holds what that of own_ holds, and 0 elsewhere.
    void expectSame(const char* what, const gpu::Image& own, const gpu::Image& part,
                    uint32_t bytes) const
    {
        const std::vector<std::byte> expected = read(own, bytes), found = read(part, bytes);
        std::vector<std::byte> all(found.size());
        const size_t row = width * bytes;
        for (uint32_t y = 0; y < height; ++y)
            std::copy_n(expected.begin() + ptrdiff_t(y * row), row,
                        all.begin() + ptrdiff_t(((part_.y + y) * part_.g.width + part_.x) * bytes));
        EXPECT_NE(expected, std::vector<std::byte>(expected.size())) << what << " is empty";
        EXPECT_TRUE(found == all) << what;
    }
    void expectSameRadiance() const
    {
        expectSame("radiance", own_.images.radiance, part_.images.radiance, sizeof(glm::vec4));
    }
    // Draws a frame of the module in both places. `change` completes the frame.
    template <typename Change>
    void draw(const LightingAndView& module, const Place& place, Change&& change,
              bool clears = true)
    {
        CndLightingFrame frame = frameAt<CndLightingFrame>(place);
        change(frame);
        context().submitAndWait([&](VkCommandBuffer cmd) {
            if (clears)
                clear(cmd, place);
            CndError error{};
            EXPECT_EQ(cndRecordLighting(module.view, cmd, &frame, &error), CND_SUCCESS)
                << error.message;
        });
    }
    // Draws a sky, which setSky() has set, and what it lights.
    void drawEnvironment(const Place& place)
    {
        CndEnvironmentFrame frame = frameAt<CndEnvironmentFrame>(place);
        frame.scale = 1;
        frame.background = VK_TRUE;
        frame.worldFromEnvironment[0] = frame.worldFromEnvironment[4] =
            frame.worldFromEnvironment[8] = 1;
        context().submitAndWait([&](VkCommandBuffer cmd) {
            clear(cmd, place);
            CndError error{};
            EXPECT_EQ(cndRecordEnvironment(environment_, cmd, &frame, &error), CND_SUCCESS)
                << error.message;
        });
    }
    void setSky(double luminance)
    {
        setImage(
            imageOf([&](const glm::dvec3& d) { return luminance * (2 + d.x + 0.5 * d.y); }, 16),
            64);
    }

    // Creates a module for frames in both places, with spheres, and with rectangles if `desc` names
    // them. Without a specular lobe its pipelines take half as long, if `desc` names no method.
    LightingAndView createModule(CndLightingDesc desc)
    {
        desc.framesInFlight = 1;
        if (!desc.specularMethods)
            desc.specularMethods = 1u << CND_SPECULAR_NONE;
        const LightingAndView module = createLighting(part_.g, desc);
        std::vector<CndLight> lights = randomSpheres(own_.g, 40, 7);
        if (desc.lightTypes) {
            const std::vector<CndLight> rectangles = lightsOf(CND_LIGHT_RECTANGLE, own_.g, 10, 8);
            lights.insert(lights.end(), rectangles.begin(), rectangles.end());
        }
        setLights(module.lighting, lights);
        return module;
    }

    void SetUp() override
    {
        EnvironmentTest::SetUp();
        if (IsSkipped() || HasFatalFailure())
            return;
        const CpuGBuffer g = randomGBuffer(width, height, 5);
        own_ = placeOf(g, 0, 0);
        part_ = placeOf(inside(g, 19, 13), 19, 13);
    }
    void TearDown() override
    {
        own_ = {};
        part_ = {};
        EnvironmentTest::TearDown();
    }

    Place own_, part_;
};

void addOccluder(CndLighting lighting)
{
    CndError error{};
    constexpr float corners[] = {-9, -6, -8.5f, 9, -6, -8.5f, 0, 9, -8.5f};
    const CndOccluderMesh mesh{.positions = corners, .vertexCount = 3, .triangleCount = 1};
    CndOccluderInstance instance{.worldFromMesh = {1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0}};
    CndOccluderId id = 0;
    EXPECT_EQ(cndAddOccluderMeshes(lighting, 1, &mesh, &instance.mesh, &error), CND_SUCCESS);
    EXPECT_EQ(cndAddOccluders(lighting, 1, &instance, &id, &error), CND_SUCCESS) << error.message;
}

} // namespace

TEST_F(FrameRectangles, OfLightingHaveTheBitsOfWholeImages)
{
    const LightingAndView module =
        createModule({.shading = CND_SHADING_CLUSTERED_BIT | CND_SHADING_COUNT_PAIRS_BIT,
                      .shadows = {.points = 32}});
    addOccluder(module.lighting);
    for (const Place* place : {&own_, &part_}) {
        draw(module, *place, [&](CndLightingFrame& frame) {
            frame.countPairs = VK_TRUE;
            frame.pairImage = place->results[0].view.get();
            frame.shadowImage = place->results[1].view.get();
        });
        const CndLightingStats stats = statsOf(module.view);
        EXPECT_GT(stats.partlyLitPairs + stats.darkPairs, 0u);
        const CndLightingFrame frame = frameAt<CndLightingFrame>(*place);
        const CndSurfaceOverlay overlay{.structSize = sizeof overlay,
                                        .quantity = CND_SURFACE_ALL,
                                        .image = place->results[2].view.get()};
        context().submitAndWait([&](VkCommandBuffer cmd) {
            CndError error{};
            EXPECT_EQ(cndRecordSurfaceOverlay(module.view, cmd, &frame, &overlay, &error),
                      CND_SUCCESS)
                << error.message;
        });
    }
    expectSameRadiance();
    expectSame("pairs", own_.results[0], part_.results[0], sizeof(glm::vec4));
    expectSame("shadows", own_.results[1], part_.results[1], sizeof(glm::vec4));
    expectSame("overlay", own_.results[2], part_.results[2], 4);

    CndLightingFrame frame = frameAt<CndLightingFrame>(part_);
    frame.x = 16384 - width + 1;
    expectRefused(module.view, frame,
                  "CndLightingFrame: the rectangle of 64x48 pixels at (16321, 13) ends outside "
                  "16384x16384");
}

// Influence by error reads the radiance and the depth of pixels that it measures. Each `maxError`
// that differs from the one before begins anew.
TEST_F(FrameRectangles, OfInfluenceByErrorHaveTheBitsOfWholeImages)
{
    const LightingAndView module =
        createModule({.shading = CND_SHADING_CLUSTERED_BIT, .influenceByError = VK_TRUE});
    setSky(100);
    const auto drawWith = [&](const Place& place, float maxError) {
        drawEnvironment(place); // so bright that lights are cut sooner
        draw(
            module, place,
            [&](CndLightingFrame& frame) {
                frame.influence = {.rule = CND_INFLUENCE_BY_ERROR,
                                   .maxError = maxError,
                                   .exposure = 1e-2f,
                                   .toneMap = CND_TONEMAP_NONE};
            },
            false);
        return statsOf(module.view).cutBelow;
    };
    const float own = drawWith(own_, 0.02f);
    drawWith(part_, 0.5f);
    EXPECT_EQ(drawWith(part_, 0.02f), own);
    EXPECT_GT(own, 0);
    expectSameRadiance();
}

// The depth that project_depth computes begins at the corner of an image of the view.
TEST_F(FrameRectangles, OfLinearDepthHaveTheBitsOfWholeImages)
{
    const LightingAndView module =
        createModule({.specularMethods = 1u << CND_SPECULAR_KARIS,
                      .shading = CND_SHADING_BRUTE_BIT,
                      .gbuffer = {.depthKind = CND_DEPTH_LINEAR, .depthUnit = 20},
                      .lightTypes = 1u << CND_LIGHT_RECTANGLE});
    for (const Place* place : {&own_, &part_})
        draw(module, *place, [](CndLightingFrame& frame) { frame.culling = CND_CULLING_BRUTE; });
    expectSameRadiance();
}

TEST_F(FrameRectangles, OfTheEnvironmentHaveTheBitsOfWholeImages)
{
    setSky(1);
    drawEnvironment(own_);
    drawEnvironment(part_);
    expectSameRadiance();

    CndEnvironmentFrame frame = frameAt<CndEnvironmentFrame>(part_);
    frame.worldFromEnvironment[0] = frame.worldFromEnvironment[4] = frame.worldFromEnvironment[8] =
        1;
    frame.y = UINT32_MAX;
    CndError error{};
    context().submitAndWait([&](VkCommandBuffer cmd) {
        EXPECT_EQ(cndRecordEnvironment(environment_, cmd, &frame, &error),
                  CND_ERROR_INVALID_ARGUMENT);
    });
    EXPECT_STREQ(
        error.message,
        "CndEnvironmentFrame: the rectangle of 64x48 pixels at (19, 4294967295) ends outside "
        "16384x16384");
}

} // namespace candelabra::test
