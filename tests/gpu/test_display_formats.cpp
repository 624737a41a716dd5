// SPDX-License-Identifier: Apache-2.0
// Tests the formats of display images that hosts may choose, radiance that stays in layout GENERAL,
// and an sRGB image that is written through a view without sRGB.
#include "gpu/exposure_harness.h"

#include <cmath>

#include "reference/eye_adaptation.h"
#include "reference/tone_map.h"

namespace candelabra::test
{
namespace
{

// Colours from black to beyond white.
Picture ramps()
{
    constexpr uint32_t width = 90, height = 40;
    std::mt19937 random(9);
    Picture p{width, height, {}};
    for (size_t i = 0; i < size_t(width) * height; ++i) {
        for (int c = 0; c < 3; ++c)
            p.rgba.push_back(float(1.3 * uniform(random)));
        p.rgba.push_back(1);
    }
    return p;
}

// An image that is created for a format with sRGB and viewed without it.
struct MutableImage {
    gpu::Memory memory;
    gpu::Handle<VkImage> image;
    gpu::Handle<VkImageView> view;
};

MutableImage createSrgb(const gpu::Device& device, uint32_t width, uint32_t height)
{
    MutableImage out;
    const VkImageCreateInfo info{
        .sType = VK_STRUCTURE_TYPE_IMAGE_CREATE_INFO,
        .flags = VK_IMAGE_CREATE_MUTABLE_FORMAT_BIT | VK_IMAGE_CREATE_EXTENDED_USAGE_BIT,
        .imageType = VK_IMAGE_TYPE_2D,
        .format = VK_FORMAT_R8G8B8A8_SRGB,
        .extent = {width, height, 1},
        .mipLevels = 1,
        .arrayLayers = 1,
        .samples = VK_SAMPLE_COUNT_1_BIT,
        .tiling = VK_IMAGE_TILING_OPTIMAL,
        .usage = VK_IMAGE_USAGE_STORAGE_BIT | VK_IMAGE_USAGE_TRANSFER_SRC_BIT};
    VkImage image{};
    gpu::check(vkCreateImage(device.handle, &info, nullptr, &image), "creating an sRGB image");
    out.image = {device, image};
    CndMemoryRequest request{.kind = CND_MEMORY_IMAGE, .image = image, .name = "sRGB display"};
    vkGetImageMemoryRequirements(device.handle, image, &request.requirements);
    out.memory = {device, request};
    gpu::check(vkBindImageMemory(device.handle, image, out.memory.get(), out.memory.offset()),
               "binding the memory of an sRGB image");
    const VkImageViewCreateInfo view{.sType = VK_STRUCTURE_TYPE_IMAGE_VIEW_CREATE_INFO,
                                     .image = image,
                                     .viewType = VK_IMAGE_VIEW_TYPE_2D,
                                     .format = VK_FORMAT_R8G8B8A8_UNORM,
                                     .subresourceRange = {VK_IMAGE_ASPECT_COLOR_BIT, 0, 1, 0, 1}};
    VkImageView handle{};
    gpu::check(vkCreateImageView(device.handle, &view, nullptr, &handle),
               "creating a view without sRGB");
    out.view = {device, handle};
    return out;
}

class DisplayFormats : public ExposureTest
{
protected:
    // Returns the texels of a display image of this format that shows the picture.
    std::vector<uint32_t> show(VkFormat format, const Picture& picture,
                               const CndExposureSettings& settings)
    {
        const gpu::Image target = gpu::createImage(
            device(), "display of another format", format, picture.width, picture.height,
            VK_IMAGE_USAGE_STORAGE_BIT | VK_IMAGE_USAGE_TRANSFER_SRC_BIT,
            VK_IMAGE_ASPECT_COLOR_BIT);
        return show(format, picture, settings, target.image.get(), target.view.get());
    }
    std::vector<uint32_t> show(VkFormat format, const Picture& picture,
                               const CndExposureSettings& settings, VkImage image, VkImageView view)
    {
        const gpu::Image radiance = toDevice(picture);
        const CndExposureDesc desc{
            .structSize = sizeof desc, .framesInFlight = 1, .displayFormat = format};
        CndExposure exposure{};
        CndError error{};
        EXPECT_EQ(cndCreateExposure(&deviceDesc(), &desc, &exposure, &error), CND_SUCCESS)
            << error.message;
        CndExposureFrame frame = frameOf(radiance, settings);
        frame.display = view;
        frame.radianceImageLayout = VK_IMAGE_LAYOUT_GENERAL;
        const gpu::Buffer texels =
            readback("display texels", VkDeviceSize(picture.width) * picture.height * 4);
        context().submitAndWait([&](VkCommandBuffer cmd) {
            transition(cmd, radiance.image.get(), VK_IMAGE_ASPECT_COLOR_BIT,
                       VK_IMAGE_LAYOUT_SHADER_READ_ONLY_OPTIMAL, VK_IMAGE_LAYOUT_GENERAL);
            transition(cmd, image, VK_IMAGE_ASPECT_COLOR_BIT, VK_IMAGE_LAYOUT_UNDEFINED,
                       VK_IMAGE_LAYOUT_GENERAL);
            EXPECT_EQ(cndRecordExposure(exposure, cmd, &frame, &error), CND_SUCCESS)
                << error.message;
            transition(cmd, image, VK_IMAGE_ASPECT_COLOR_BIT, VK_IMAGE_LAYOUT_GENERAL,
                       VK_IMAGE_LAYOUT_TRANSFER_SRC_OPTIMAL);
            const VkBufferImageCopy copy{.imageSubresource = {VK_IMAGE_ASPECT_COLOR_BIT, 0, 0, 1},
                                         .imageExtent = {picture.width, picture.height, 1}};
            vkCmdCopyImageToBuffer(cmd, image, VK_IMAGE_LAYOUT_TRANSFER_SRC_OPTIMAL, texels.get(),
                                   1, &copy);
            fullBarrier(cmd);
        });
        cndDestroyExposure(exposure);
        const auto read = texels.as<uint32_t>();
        return {read.begin(), read.end()};
    }
    // Tells whether the device writes such images without a format in the shader.
    bool writes(VkFormat format) const
    {
        VkFormatProperties3 more{.sType = VK_STRUCTURE_TYPE_FORMAT_PROPERTIES_3};
        VkFormatProperties2 properties{.sType = VK_STRUCTURE_TYPE_FORMAT_PROPERTIES_2,
                                       .pNext = &more};
        vkGetPhysicalDeviceFormatProperties2(context().info().handle, format, &properties);
        constexpr VkFormatFeatureFlags2 needs =
            VK_FORMAT_FEATURE_2_STORAGE_IMAGE_BIT |
            VK_FORMAT_FEATURE_2_STORAGE_WRITE_WITHOUT_FORMAT_BIT;
        return (more.optimalTilingFeatures & needs) == needs;
    }
};

TEST_F(DisplayFormats, EightBitsAreTheSameInEveryOrder)
{
    const Picture picture = ramps();
    CndExposureSettings settings = manualSettings(0, CND_TONEMAP_PBR_NEUTRAL);
    settings.dither = VK_TRUE;
    const std::vector<uint32_t> rgba = show(VK_FORMAT_R8G8B8A8_UNORM, picture, settings);
    if (!writes(VK_FORMAT_B8G8R8A8_UNORM))
        GTEST_SKIP() << "the device cannot write B8G8R8A8_UNORM as a storage image";
    const std::vector<uint32_t> bgra = show(VK_FORMAT_B8G8R8A8_UNORM, picture, settings);
    for (size_t i = 0; i < rgba.size(); ++i)
        ASSERT_EQ(bgra[i],
                  (rgba[i] & 0xFF00FF00u) | (rgba[i] & 0xFFu) << 16 | (rgba[i] >> 16 & 0xFFu));
}

TEST_F(DisplayFormats, TenBitsHaveFinerSteps)
{
    const Picture picture = ramps();
    const CndExposureSettings settings = manualSettings(0, CND_TONEMAP_NONE);
    const double exposure = reference::exposureFromEv100(0, 0, settings.middleGrey);
    for (const VkFormat format :
         {VK_FORMAT_A2B10G10R10_UNORM_PACK32, VK_FORMAT_A2R10G10B10_UNORM_PACK32}) {
        if (!writes(format))
            continue;
        const std::vector<uint32_t> shown = show(format, picture, settings);
        double worst = 0;
        for (size_t i = 0; i < shown.size(); ++i) {
            EXPECT_EQ(shown[i] >> 30, 3u);
            for (uint32_t c = 0; c < 3; ++c) {
                const uint32_t place = format == VK_FORMAT_A2R10G10B10_UNORM_PACK32 ? 2 - c : c;
                const double code = shown[i] >> 10 * place & 0x3FFu;
                const double linear = std::min(exposure * double(picture.rgba[4 * i + c]), 1.0);
                worst = std::max(worst, std::abs(code - 1023 * reference::srgbEncode(linear)));
            }
        }
        EXPECT_LT(worst, 0.51); // rounded to the nearest step
    }
}

TEST_F(DisplayFormats, AnSrgbImageIsWrittenThroughAViewWithoutSrgb)
{
    const Picture picture = ramps();
    const CndExposureSettings settings = manualSettings(0, CND_TONEMAP_PBR_NEUTRAL);
    const MutableImage srgb = createSrgb(device(), picture.width, picture.height);
    EXPECT_EQ(show(VK_FORMAT_R8G8B8A8_UNORM, picture, settings, srgb.image.get(), srgb.view.get()),
              show(VK_FORMAT_R8G8B8A8_UNORM, picture, settings));
}

} // namespace
} // namespace candelabra::test
