// SPDX-License-Identifier: Apache-2.0
// Hosts as they are found: each draws the same scene in its own way, with its own kind of depth, in
// its own world, and into radiance of its own format. The lit image is that of the native path:
// layout FULL, reversed depth, a right-handed world, 32-bit radiance.
#include <iostream>
#include <tuple>

#include <glm/gtc/packing.hpp>

#include "gpu/lighting_harness.h"
#include "gpu/raster_host.h"
#include "harness/full_tests.h"
#include "render/image_barrier.h"

namespace candelabra::test
{
namespace
{

constexpr uint32_t sceneWidth = 72, sceneHeight = 52;
constexpr VkFormat floatRadiance = VK_FORMAT_R32G32B32A32_SFLOAT,
                   halfRadiance = VK_FORMAT_R16G16B16A16_SFLOAT;
constexpr CndSpecularMethod sceneMethod = CND_SPECULAR_KARIS;
constexpr const char* passNames[] = {"dynamic rendering", "render pass"};
constexpr const char* worldNames[] = {"right-handed", "y down", "left-handed"};
constexpr const char* depthNames[] = {"Reversed", "Standard",     "OpenGl",
                                      "Linear",   "PositionView", "PositionWorld"};

using Pixels = std::vector<glm::vec4>;

constexpr app::ImageAccess overwritten{VK_PIPELINE_STAGE_2_COMPUTE_SHADER_BIT,
                                       VK_ACCESS_2_SHADER_STORAGE_WRITE_BIT,
                                       VK_IMAGE_LAYOUT_UNDEFINED};

class HostTest : public LightingTest
{
protected:
    CndLighting createLighting(const HostCase& host, VkFormat radiance)
    {
        const CndLightingDesc desc{.structSize = sizeof desc,
                                   .framesInFlight = 2,
                                   .gbufferLayout =
                                       host.native ? CND_GBUFFER_FULL : CND_GBUFFER_HOST,
                                   .specularMethods = 1u << sceneMethod,
                                   .shading = CND_SHADING_CLUSTERED_BIT,
                                   .gbuffer = gbufferOf(host),
                                   .radianceFormat = radiance};
        CndLighting lighting{};
        CndError error{};
        EXPECT_EQ(cndCreateLighting(&deviceDesc(), &desc, &lighting, &error), CND_SUCCESS)
            << error.message;
        return lighting;
    }

    // Draws and lights the scene twice in one command buffer, so that synchronization validation
    // sees the way from the second frame back to the first one's images. Returns the second image.
    Pixels light(CndLighting lighting, const HostCase& host, VkFormat format,
                 const std::vector<CndLight>& lights)
    {
        CndError error{};
        const CndLightingViewDesc viewDesc{
            .structSize = sizeof viewDesc, .maxWidth = sceneWidth, .maxHeight = sceneHeight};
        CndLightingView view{};
        EXPECT_EQ(cndCreateLightingView(lighting, &viewDesc, &view, &error), CND_SUCCESS)
            << error.message;
        setLights(lighting, lights);
        const RasterHost raster(device(), host, sceneWidth, sceneHeight);
        const gpu::Image radiance =
            gpu::createImage(device(), "host radiance", format, sceneWidth, sceneHeight,
                             VK_IMAGE_USAGE_STORAGE_BIT | VK_IMAGE_USAGE_TRANSFER_DST_BIT |
                                 VK_IMAGE_USAGE_TRANSFER_SRC_BIT,
                             VK_IMAGE_ASPECT_COLOR_BIT);
        CndLightingFrame frame = raster.frame();
        frame.radiance = radiance.view.get();
        frame.specularMethod = sceneMethod;
        context().submitAndWait([&](VkCommandBuffer cmd) {
            for (frame.frameSlot = 0; frame.frameSlot < 2; ++frame.frameSlot) {
                raster.draw(cmd);
                app::clearForCompute(cmd, radiance.image.get(), overwritten);
                // A second frame may keep the lists of the first one, and its depths.
                frame.surfacesUnchanged = frame.frameSlot && host.pass == HostPass::RenderPass;
                EXPECT_EQ(cndRecordLighting(view, cmd, &frame, &error), CND_SUCCESS)
                    << error.message;
            }
        });
        cndDestroyLightingView(view);
        return read(radiance);
    }

    Pixels native()
    {
        const HostCase host{.native = true};
        const CndLighting lighting = createLighting(host, floatRadiance);
        Pixels out = light(lighting, host, floatRadiance, lightsOf(host));
        cndDestroyLighting(lighting);
        return out;
    }

private:
    Pixels read(const gpu::Image& radiance)
    {
        const uint32_t texel = radiance.format == floatRadiance  ? 16
                               : radiance.format == halfRadiance ? 8
                                                                 : 4;
        const std::vector<std::byte> bytes =
            readImage(radiance, VK_IMAGE_ASPECT_COLOR_BIT, VK_IMAGE_LAYOUT_GENERAL, texel);
        Pixels out(size_t(sceneWidth) * sceneHeight);
        for (size_t i = 0; i < out.size(); ++i) {
            uint64_t packed = 0;
            if (texel == 16) {
                std::memcpy(&out[i], &bytes[16 * i], 16);
                continue;
            }
            std::memcpy(&packed, &bytes[texel * i], texel);
            out[i] = texel == 8 ? glm::unpackHalf4x16(packed)
                                : glm::vec4(glm::unpackF2x11_1x10(uint32_t(packed)), 1);
        }
        return out;
    }
};

class Hosts : public HostTest, public ::testing::WithParamInterface<std::tuple<HostDepth, VkFormat>>
{
};

TEST_P(Hosts, AreLitLikeTheNativePath)
{
    const auto [depth, format] = GetParam();
    const Pixels expected = native();
    // Each of the three types of light rounds the sum to a half float, up or down.
    const double allowed = 1e-3 + (format == halfRadiance ? 3 * std::exp2(-10) : 0);
    const CndLighting lighting = createLighting({.depth = depth}, format);
    double worst = 0;
    for (const HostPass pass : {HostPass::DynamicRendering, HostPass::RenderPass})
        for (const HostWorld world :
             {HostWorld::RightHanded, HostWorld::YDown, HostWorld::LeftHanded}) {
            const HostCase host{.pass = pass, .depth = depth, .world = world};
            const Pixels lit = light(lighting, host, format, lightsOf(host));
            const double difference = maxRelativeDifference(lit, expected);
            EXPECT_LT(difference, allowed)
                << passNames[int(pass)] << ", " << worldNames[int(world)];
            worst = std::max(worst, difference);
            // The comparison would notice a rectangle that faces the wrong way.
            if (pass == HostPass::DynamicRendering) {
                EXPECT_GT(maxRelativeDifference(light(lighting, host, format, lightsOf(host, true)),
                                                expected),
                          0.05)
                    << worldNames[int(world)];
            }
        }
    cndDestroyLighting(lighting);
    std::cout << "largest difference of the peak: " << worst << '\n';
}

// Returns every kind of depth. The format of radiance does not depend on it, so half floats are
// tested with one kind, and with all kinds in full tests.
static std::vector<std::tuple<HostDepth, VkFormat>> hosts()
{
    std::vector<std::tuple<HostDepth, VkFormat>> out;
    for (const HostDepth depth :
         {HostDepth::Reversed, HostDepth::Standard, HostDepth::OpenGl, HostDepth::Linear,
          HostDepth::PositionView, HostDepth::PositionWorld}) {
        out.emplace_back(depth, floatRadiance);
        if (depth == HostDepth::Reversed || fullTests())
            out.emplace_back(depth, halfRadiance);
    }
    return out;
}

INSTANTIATE_TEST_SUITE_P(Host, Hosts, ::testing::ValuesIn(hosts()), [](const auto& test) {
    return std::string(depthNames[int(std::get<0>(test.param))]) +
           (std::get<1>(test.param) == halfRadiance ? "Halves" : "Floats");
});

class RadianceFormats : public HostTest
{
};

TEST_F(RadianceFormats, ElevenBits)
{
    constexpr VkFormat format = VK_FORMAT_B10G11R11_UFLOAT_PACK32;
    VkFormatProperties3 more{.sType = VK_STRUCTURE_TYPE_FORMAT_PROPERTIES_3};
    VkFormatProperties2 properties{.sType = VK_STRUCTURE_TYPE_FORMAT_PROPERTIES_2, .pNext = &more};
    vkGetPhysicalDeviceFormatProperties2(context().info().handle, format, &properties);
    constexpr VkFormatFeatureFlags2 needs = VK_FORMAT_FEATURE_2_STORAGE_IMAGE_BIT |
                                            VK_FORMAT_FEATURE_2_STORAGE_READ_WITHOUT_FORMAT_BIT |
                                            VK_FORMAT_FEATURE_2_STORAGE_WRITE_WITHOUT_FORMAT_BIT;
    const HostCase host;
    if ((more.optimalTilingFeatures & needs) != needs) {
        const CndLightingDesc desc{
            .structSize = sizeof desc, .framesInFlight = 1, .radianceFormat = format};
        CndLighting lighting{};
        CndError error{};
        EXPECT_EQ(cndCreateLighting(&deviceDesc(), &desc, &lighting, &error),
                  CND_ERROR_UNSUPPORTED);
        EXPECT_NE(std::string(error.message).find("radianceFormat"), std::string::npos);
        GTEST_SKIP() << "the device cannot add to B10G11R11_UFLOAT_PACK32: " << error.message;
    }
    const CndLighting lighting = createLighting(host, format);
    const double difference =
        maxRelativeDifference(light(lighting, host, format, lightsOf(host)), native());
    std::cout << "largest difference of the peak: " << difference << '\n';
    EXPECT_LT(difference, 1e-3 + 3 * std::exp2(-5)); // blue has 6 bits, with the leading one
    cndDestroyLighting(lighting);
}

// A value that is too large for a half float is stored as the largest half float.
TEST_F(RadianceFormats, HalvesSaturate)
{
    const HostCase host;
    std::vector<CndLight> lights = lightsOf(host);
    for (CndLight& light : lights)
        for (float& channel : light.emission)
            channel *= 1e5f;
    const CndLighting lighting = createLighting(host, halfRadiance);
    size_t largest = 0;
    for (const glm::vec4& pixel : light(lighting, host, halfRadiance, lights))
        for (int c = 0; c < 3; ++c) {
            EXPECT_LE(pixel[c], 65504);
            largest += pixel[c] == 65504;
        }
    EXPECT_GT(largest, 1000u);
    cndDestroyLighting(lighting);
}

} // namespace
} // namespace candelabra::test
