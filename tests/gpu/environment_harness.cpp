// SPDX-License-Identifier: Apache-2.0
#include "gpu/environment_harness.h"
#include "gpu/fill_image.h"

#include <cmath>
#include <numbers>

namespace candelabra::test
{

EnvironmentImage imageOf(const Sky& sky, uint32_t width)
{
    EnvironmentImage image{.width = width, .height = width / 2};
    for (uint32_t y = 0; y < image.height; ++y)
        for (uint32_t x = 0; x < width; ++x) {
            const double theta = std::numbers::pi * (y + 0.5) / image.height;
            const double phi = 2 * std::numbers::pi * (x + 0.5) / width; // from +z towards -x
            const double s = std::sin(theta);
            const float value =
                float(sky({-s * std::sin(phi), std::cos(theta), s * std::cos(phi)}));
            image.pixels.push_back({value, value, value, 1});
        }
    return image;
}

void EnvironmentTest::TearDown()
{
    cndDestroyEnvironment(environment_);
    environment_ = nullptr;
    LightingTest::TearDown();
}

void EnvironmentTest::createEnvironment(CndEnvironmentDesc desc)
{
    cndDestroyEnvironment(environment_);
    environment_ = nullptr;
    desc.structSize = sizeof desc;
    desc.framesInFlight = 2;
    desc.timestamps = VK_TRUE;
    CndError error{};
    EXPECT_EQ(cndCreateEnvironment(&deviceDesc(), &desc, &environment_, &error), CND_SUCCESS)
        << error.message;
}

void EnvironmentTest::setImage(const EnvironmentImage& source, uint32_t cubeSize,
                               const CndGBufferDesc* gbuffer, const CndHostKernels* custom,
                               CndGBufferLayout customLayout)
{
    CndEnvironmentDesc desc{.cubeSize = cubeSize};
    if (gbuffer) {
        desc.gbufferLayout = CND_GBUFFER_HOST;
        desc.gbuffer = *gbuffer;
    }
    if (custom) {
        desc.gbufferLayout = customLayout;
        desc.hostKernels = *custom;
    }
    createEnvironment(desc);
    ASSERT_TRUE(environment_);
    CndError error{};
    const gpu::Image image = gpu::createImage(
        device(), "sky", VK_FORMAT_R32G32B32A32_SFLOAT, source.width, source.height,
        VK_IMAGE_USAGE_SAMPLED_BIT | VK_IMAGE_USAGE_TRANSFER_DST_BIT, VK_IMAGE_ASPECT_COLOR_BIT);
    const gpu::Buffer data = upload("sky data", source.pixels);
    context().submitAndWait([&](VkCommandBuffer cmd) {
        fillImage(cmd, data, image.image.get(), source.width, source.height);
        const CndEnvironmentMap map{.structSize = sizeof map,
                                    .width = source.width,
                                    .height = source.height,
                                    .equirectangular = image.view.get()};
        EXPECT_EQ(cndRecordEnvironmentMap(environment_, cmd, &map, &error), CND_SUCCESS)
            << error.message;
    });
}

CndEnvironmentFrame EnvironmentTest::environmentFrame(const CpuGBuffer& g, const Images& images,
                                                      const EnvironmentOptions& options) const
{
    CndEnvironmentFrame frame = surfaceFrame<CndEnvironmentFrame>(g, images);
    frame.scale = options.scale;
    frame.background = options.background;
    frame.lobes = options.lobes;
    frame.energyCompensation = options.energyCompensation;
    for (int i = 0; i < 9; ++i)
        frame.worldFromEnvironment[i] = float(options.worldFromEnvironment[i / 3][i % 3]);
    return frame;
}

std::vector<glm::vec4> EnvironmentTest::shade(const CpuGBuffer& g,
                                              const EnvironmentOptions& options)
{
    const Images images = uploadImages(g);
    const CndEnvironmentFrame frame = environmentFrame(g, images, options);
    CndError error{};
    context().submitAndWait([&](VkCommandBuffer cmd) {
        VkClearColorValue before{};
        std::fill_n(before.float32, 4, options.radianceBefore);
        const VkImageSubresourceRange all{VK_IMAGE_ASPECT_COLOR_BIT, 0, 1, 0, 1};
        vkCmdClearColorImage(cmd, images.radiance.image.get(), VK_IMAGE_LAYOUT_GENERAL, &before, 1,
                             &all);
        fullBarrier(cmd);
        EXPECT_EQ(cndRecordEnvironment(environment_, cmd, &frame, &error), CND_SUCCESS)
            << error.message;
    });
    return readRadiance(images);
}

} // namespace candelabra::test
