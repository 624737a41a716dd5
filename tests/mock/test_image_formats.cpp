// SPDX-License-Identifier: Apache-2.0
// Formats and layouts of the images that hosts pass: what is accepted, and the sentence for every
// other value.
#include <string>

#include <gtest/gtest.h>

#include "candelabra/candelabra.hpp"
#include "candelabra_shaders.h"
#include "gpu/format_name.h"
#include "gpu/image_format.h"
#include "gpu/spirv_words.h"
#include "mock/mock_vulkan.h"
#include "shared/lighting_data.h"

namespace candelabra::test
{
namespace
{

TEST(ImageFormats, RadianceHasOneOfThree)
{
    MockVulkan vulkan;
    const auto lighting = [&](VkFormat format) {
        return std::string(
            Lighting::create(vulkan.desc(), {.framesInFlight = 1, .radianceFormat = format})
                .error()
                .message);
    };
    const auto environment = [&](VkFormat format) {
        return std::string(
            Environment::create(vulkan.desc(), {.framesInFlight = 1, .radianceFormat = format})
                .error()
                .message);
    };
    for (const VkFormat format :
         {VK_FORMAT_UNDEFINED, VK_FORMAT_R32G32B32A32_SFLOAT, VK_FORMAT_R16G16B16A16_SFLOAT,
          VK_FORMAT_B10G11R11_UFLOAT_PACK32}) {
        EXPECT_EQ(lighting(format), "");
        EXPECT_EQ(environment(format), "");
    }
    const std::string refused = "radianceFormat is VK_FORMAT_R8G8B8A8_UNORM, must be "
                                "VK_FORMAT_R32G32B32A32_SFLOAT, VK_FORMAT_R16G16B16A16_SFLOAT or "
                                "VK_FORMAT_B10G11R11_UFLOAT_PACK32";
    EXPECT_EQ(lighting(VK_FORMAT_R8G8B8A8_UNORM), "CndLightingDesc: " + refused);
    EXPECT_EQ(environment(VK_FORMAT_R8G8B8A8_UNORM), "CndEnvironmentDesc: " + refused);
}

TEST(ImageFormats, DisplaysHaveOneOfFour)
{
    MockVulkan vulkan;
    const auto exposure = [&](VkFormat format) {
        return std::string(
            Exposure::create(vulkan.desc(), {.framesInFlight = 1, .displayFormat = format})
                .error()
                .message);
    };
    for (const VkFormat format :
         {VK_FORMAT_UNDEFINED, VK_FORMAT_R8G8B8A8_UNORM, VK_FORMAT_B8G8R8A8_UNORM,
          VK_FORMAT_A2B10G10R10_UNORM_PACK32, VK_FORMAT_A2R10G10B10_UNORM_PACK32})
        EXPECT_EQ(exposure(format), "");
    EXPECT_EQ(exposure(VK_FORMAT_R16G16B16A16_SFLOAT),
              "CndExposureDesc: displayFormat is VK_FORMAT_R16G16B16A16_SFLOAT, must be "
              "VK_FORMAT_R8G8B8A8_UNORM, "
              "VK_FORMAT_B8G8R8A8_UNORM, VK_FORMAT_A2B10G10R10_UNORM_PACK32 or "
              "VK_FORMAT_A2R10G10B10_UNORM_PACK32");
    EXPECT_EQ(
        exposure(VK_FORMAT_B8G8R8A8_SRGB),
        "CndExposureDesc: displayFormat is VK_FORMAT_B8G8R8A8_SRGB, which shaders cannot write: "
        "create the image with VK_IMAGE_CREATE_MUTABLE_FORMAT_BIT, give a _UNORM view of it, "
        "and name that view's format here");
    const auto lighting = Lighting::create(
        vulkan.desc(), {.framesInFlight = 1, .overlayFormat = VK_FORMAT_R8G8B8A8_SRGB});
    EXPECT_TRUE(
        std::string(lighting.error().message)
            .starts_with("CndLightingDesc: overlayFormat is VK_FORMAT_R8G8B8A8_SRGB, which"));
}

// In the code of a kernel, the engine changes only the type of one image. Everything else, also an
// image of the host with the same type, keeps its meaning.
TEST(ImageFormats, OneImageOfAKernelChangesItsType)
{
    for (const gpu::Spirv* kernel : spirv::shade_tiles_comp)
        for (const VkFormat format : {VK_FORMAT_R32G32B32A32_SFLOAT, VK_FORMAT_R16G16B16A16_SFLOAT,
                                      VK_FORMAT_B10G11R11_UFLOAT_PACK32}) {
            const gpu::FormattedSpirv made(*kernel, gpu::RADIANCE_IMAGE, format,
                                           gpu::StorageUse::ReadAndWrite);
            const std::span<const uint32_t> words = made.get().words;
            EXPECT_EQ(gpu::reflect(made.get()), gpu::reflect(*kernel));
            if (format == VK_FORMAT_R32G32B32A32_SFLOAT) {
                EXPECT_EQ(words.data(), kernel->words.data());
                continue;
            }
            // A type, a pointer to it, and two capabilities if the type names no format.
            const size_t more = format == VK_FORMAT_R16G16B16A16_SFLOAT ? 13 : 13 + 4;
            EXPECT_EQ(words.size(), kernel->words.size() + more);
            size_t types = 0;
            for (size_t i = gpu::headerWords; i < words.size(); i += words[i] >> 16)
                types += gpu::opcode(&words[i]) == gpu::OpTypeImage &&
                         words[i + 8] == (more == 13 ? gpu::FormatRgba16f : gpu::FormatUnknown) &&
                         words[i + 7] == 2; // a storage image
            EXPECT_EQ(types, 1u);
        }
}

TEST(ImageLayouts, OnlyLayoutsThatShadersReadIn)
{
    MockVulkan vulkan;
    auto lighting = Lighting::create(vulkan.desc(), {.framesInFlight = 1});
    auto view = lighting.value().createView({.maxWidth = 8, .maxHeight = 8});
    auto exposure = Exposure::create(vulkan.desc(), {.framesInFlight = 1});
    const VkImageView any = MockVulkan::imageView();
    CndLightingFrame frame{.width = 8,
                           .height = 8,
                           .camera = MockVulkan::camera(),
                           .normalRoughness = any,
                           .albedo = any,
                           .specular = any,
                           .depth = any,
                           .radiance = any,
                           .specularMethod = CND_SPECULAR_CONIC};
    CndExposureFrame shown{
        .width = 8, .height = 8, .radiance = any, .settings = defaultExposureSettings()};
    const VkCommandBuffer cmd = MockVulkan::commandBuffer();
    for (const VkImageLayout layout :
         {VK_IMAGE_LAYOUT_GENERAL, VK_IMAGE_LAYOUT_SHADER_READ_ONLY_OPTIMAL,
          VK_IMAGE_LAYOUT_READ_ONLY_OPTIMAL}) {
        frame.gbufferImageLayout = frame.depthImageLayout = shown.radianceImageLayout = layout;
        EXPECT_TRUE(view.value().record(cmd, frame));
        EXPECT_TRUE(exposure.value().record(cmd, shown));
    }
    for (const VkImageLayout layout :
         {VK_IMAGE_LAYOUT_DEPTH_STENCIL_READ_ONLY_OPTIMAL, VK_IMAGE_LAYOUT_DEPTH_READ_ONLY_OPTIMAL,
          VK_IMAGE_LAYOUT_DEPTH_READ_ONLY_STENCIL_ATTACHMENT_OPTIMAL}) {
        frame.depthImageLayout = layout;
        EXPECT_TRUE(view.value().record(cmd, frame));
    }
    frame.depthImageLayout = VK_IMAGE_LAYOUT_DEPTH_ATTACHMENT_OPTIMAL;
    EXPECT_STREQ(view.value().record(cmd, frame).error().message,
                 "CndLightingFrame: depthImageLayout is no layout in which shaders read depth: it "
                 "may be GENERAL, or a read-only layout of shaders or of depth");
    frame.gbufferImageLayout = VK_IMAGE_LAYOUT_COLOR_ATTACHMENT_OPTIMAL;
    EXPECT_STREQ(view.value().record(cmd, frame).error().message,
                 "CndLightingFrame: gbufferImageLayout must be SHADER_READ_ONLY_OPTIMAL, "
                 "READ_ONLY_OPTIMAL or GENERAL");
    shown.radianceImageLayout = VK_IMAGE_LAYOUT_TRANSFER_SRC_OPTIMAL;
    EXPECT_STREQ(exposure.value().record(cmd, shown).error().message,
                 "CndExposureFrame: radianceImageLayout must be SHADER_READ_ONLY_OPTIMAL, "
                 "READ_ONLY_OPTIMAL or GENERAL");
    vulkan.finish(vulkan.submit());
}

TEST(ImageFormats, MessagesNameThem)
{
    EXPECT_EQ(gpu::formatName(VK_FORMAT_UNDEFINED), "VK_FORMAT_UNDEFINED");
    EXPECT_EQ(gpu::formatName(VK_FORMAT_R16G16B16A16_SFLOAT), "VK_FORMAT_R16G16B16A16_SFLOAT");
    EXPECT_EQ(gpu::formatName(VK_FORMAT_ASTC_12x12_SRGB_BLOCK), "VK_FORMAT_ASTC_12x12_SRGB_BLOCK");
    EXPECT_EQ(gpu::formatName(VkFormat(185)), "VkFormat 185");
    for (int format = 0; format < 185; ++format) // all formats of Vulkan 1.0
        EXPECT_TRUE(gpu::formatName(VkFormat(format)).starts_with("VK_FORMAT_")) << format;
}

} // namespace
} // namespace candelabra::test
