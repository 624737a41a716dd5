// SPDX-License-Identifier: Apache-2.0
// Layouts of a host's G-buffer: valid ones are accepted, and every mistake gets its own sentence.
#include <cmath>
#include <string>

#include <gtest/gtest.h>

#include "candelabra/candelabra.hpp"
#include "mock/mock_vulkan.h"

namespace candelabra::test
{
namespace
{

// World-space normals with 10 bits; base colour; roughness and metalness packed.
CndGBufferDesc common()
{
    return {.normalEncoding = CND_NORMAL_UNORM,
            .normalSpace = CND_NORMALS_WORLD,
            .roughness = CND_CHANNEL_SPECULAR_R,
            .metalness = CND_CHANNEL_SPECULAR_G,
            .normalRoughnessFormat = VK_FORMAT_A2B10G10R10_UNORM_PACK32,
            .albedoFormat = VK_FORMAT_R8G8B8A8_SRGB,
            .specularFormat = VK_FORMAT_R8G8_UNORM,
            .depthFormat = VK_FORMAT_D24_UNORM_S8_UINT};
}

// Diffuse albedo with smoothness; specular colour with F90.
CndGBufferDesc specularColour()
{
    return {.normalEncoding = CND_NORMAL_OCTAHEDRAL_SNORM,
            .roughness = CND_CHANNEL_ALBEDO_A,
            .roughnessKind = CND_ROUGHNESS_SMOOTHNESS,
            .reflectance = CND_REFLECTANCE_SPECULAR,
            .f90 = CND_CHANNEL_SPECULAR_A,
            .normalRoughnessFormat = VK_FORMAT_R16G16_SNORM,
            .albedoFormat = VK_FORMAT_R8G8B8A8_SRGB,
            .specularFormat = VK_FORMAT_R8G8B8A8_SRGB,
            .depthFormat = VK_FORMAT_R32_SFLOAT};
}

// A host whose surfaces all have the same roughness and metalness.
CndGBufferDesc constants()
{
    return {.constantRoughness = 0.5f, .constantMetalness = 1};
}

// A host that stores a share of the distance to its far plane.
CndGBufferDesc linear()
{
    CndGBufferDesc d = common();
    d.depthFormat = VK_FORMAT_R16_SFLOAT;
    d.depthKind = CND_DEPTH_LINEAR;
    d.depthUnit = 500;
    return d;
}

// Returns what both modules say about the layout; empty if they accept it.
std::string sentence(const CndGBufferDesc& gbuffer, CndGBufferLayout layout = CND_GBUFFER_HOST)
{
    MockVulkan vulkan;
    const auto lighting = Lighting::create(
        vulkan.desc(), {.framesInFlight = 1, .gbufferLayout = layout, .gbuffer = gbuffer});
    const auto environment = Environment::create(
        vulkan.desc(), {.framesInFlight = 1, .gbufferLayout = layout, .gbuffer = gbuffer});
    EXPECT_STREQ(lighting.error().message, environment.error().message);
    EXPECT_EQ(bool(lighting), lighting.error().code == CND_SUCCESS);
    return lighting.error().message;
}

struct Mistake {
    const char* says;
    CndGBufferDesc (*from)();
    void (*make)(CndGBufferDesc&);
};

// The exact message for each mistake, after "CndGBufferDesc: ".
const Mistake mistakes[] = {
    {"roughness names no channel: constantRoughness must then be above 0 and at most 1", common,
     [](CndGBufferDesc& d) { d.roughness = CND_CHANNEL_NONE; }},
    {"roughness names no channel: constantRoughness must then be above 0 and at most 1", constants,
     [](CndGBufferDesc& d) { d.constantRoughness = std::nanf(""); }},
    {"constantRoughness is set, but roughness names a channel", common,
     [](CndGBufferDesc& d) { d.constantRoughness = 0.5f; }},
    {"constantMetalness is set, but metalness names a channel", common,
     [](CndGBufferDesc& d) { d.constantMetalness = 0.5f; }},
    {"constantMetalness must be 0..1", constants,
     [](CndGBufferDesc& d) { d.constantMetalness = -1; }},
    {"depthKind is not a CndDepthKind", common,
     [](CndGBufferDesc& d) { d.depthKind = CndDepthKind(4); }},
    {"depthUnit is set, but depthKind is not CND_DEPTH_LINEAR", common,
     [](CndGBufferDesc& d) { d.depthUnit = 100; }},
    {"depthUnit must be finite and >= 0", linear, [](CndGBufferDesc& d) { d.depthUnit = -1; }},
    {"depthFormat VK_FORMAT_R8G8B8A8_SRGB decodes depths as colours", linear,
     [](CndGBufferDesc& d) { d.depthFormat = VK_FORMAT_R8G8B8A8_SRGB; }},
    {"depthFormat VK_FORMAT_R16_SFLOAT cannot hold positions, which need four channels and both "
     "signs",
     linear,
     [](CndGBufferDesc& d) {
         d.depthKind = CND_DEPTH_POSITION_WORLD;
         d.depthUnit = 0;
     }},
    {"depthFormat VK_FORMAT_R16G16B16A16_UNORM cannot hold positions, which need four channels and "
     "both "
     "signs",
     linear,
     [](CndGBufferDesc& d) {
         d.depthKind = CND_DEPTH_POSITION_VIEW;
         d.depthUnit = 0;
         d.depthFormat = VK_FORMAT_R16G16B16A16_UNORM;
     }},
    {"normalEncoding is not a CndNormalEncoding", common,
     [](CndGBufferDesc& d) { d.normalEncoding = CndNormalEncoding(4); }},
    {"normalSpace is not a CndNormalSpace", common,
     [](CndGBufferDesc& d) { d.normalSpace = CndNormalSpace(2); }},
    {"roughnessKind is not a CndRoughnessKind", common,
     [](CndGBufferDesc& d) { d.roughnessKind = CndRoughnessKind(3); }},
    {"reflectance is not a CndReflectance", common,
     [](CndGBufferDesc& d) { d.reflectance = CndReflectance(2); }},
    {"metalness is not a CndGBufferChannel", common,
     [](CndGBufferDesc& d) { d.metalness = CndGBufferChannel(13); }},
    {"roughness is blue of normalRoughness, where the normal is", common,
     [](CndGBufferDesc& d) { d.roughness = CND_CHANNEL_NORMAL_B; }},
    {"metalness is red of albedo, where the base colour is", common,
     [](CndGBufferDesc& d) { d.metalness = CND_CHANNEL_ALBEDO_R; }},
    {"roughness is green of specular, where F0 is", specularColour,
     [](CndGBufferDesc& d) { d.roughness = CND_CHANNEL_SPECULAR_G; }},
    {"roughness is in the channel of another quantity", common,
     [](CndGBufferDesc& d) { d.roughness = CND_CHANNEL_SPECULAR_G; }},
    {"metalness is blue of specular, which its format VK_FORMAT_R8G8_UNORM has not", common,
     [](CndGBufferDesc& d) { d.metalness = CND_CHANNEL_SPECULAR_B; }},
    {"roughness is red of specular, whose format VK_FORMAT_R8G8B8A8_SRGB decodes it as a colour",
     common, [](CndGBufferDesc& d) { d.specularFormat = VK_FORMAT_R8G8B8A8_SRGB; }},
    {"metalness, constantMetalness and dielectricF0 are of CND_REFLECTANCE_METALNESS, reflectance "
     "is "
     "CND_REFLECTANCE_SPECULAR",
     specularColour, [](CndGBufferDesc& d) { d.dielectricF0 = 0.05f; }},
    {"f90 is of CND_REFLECTANCE_SPECULAR, reflectance is CND_REFLECTANCE_METALNESS", common,
     [](CndGBufferDesc& d) { d.f90 = CND_CHANNEL_ALBEDO_A; }},
    {"dielectricF0 must be 0..1", common, [](CndGBufferDesc& d) { d.dielectricF0 = 1.5f; }},
    {"normalRoughnessFormat VK_FORMAT_R16G16_UINT is no colour format that shaders read as floats",
     common, [](CndGBufferDesc& d) { d.normalRoughnessFormat = VK_FORMAT_R16G16_UINT; }},
    {"the normal needs 3 channels, normalRoughnessFormat VK_FORMAT_R16G16_UNORM has 2", common,
     [](CndGBufferDesc& d) { d.normalRoughnessFormat = VK_FORMAT_R16G16_UNORM; }},
    {"normalRoughnessFormat VK_FORMAT_R8G8B8A8_SRGB decodes normals as colours", common,
     [](CndGBufferDesc& d) { d.normalRoughnessFormat = VK_FORMAT_R8G8B8A8_SRGB; }},
    {"normalRoughnessFormat VK_FORMAT_R16G16_UNORM has no negative values, which normalEncoding "
     "asks for",
     specularColour, [](CndGBufferDesc& d) { d.normalRoughnessFormat = VK_FORMAT_R16G16_UNORM; }},
    {"normalRoughnessFormat VK_FORMAT_R8G8B8A8_SNORM holds negative values, normalEncoding says "
     "0..1",
     common, [](CndGBufferDesc& d) { d.normalRoughnessFormat = VK_FORMAT_R8G8B8A8_SNORM; }},
    {"the base colour needs 3 channels, albedoFormat VK_FORMAT_R8G8_UNORM has 2", common,
     [](CndGBufferDesc& d) { d.albedoFormat = VK_FORMAT_R8G8_UNORM; }},
    {"depthFormat VK_FORMAT_R16_SFLOAT is neither a depth format nor VK_FORMAT_R32_SFLOAT", common,
     [](CndGBufferDesc& d) { d.depthFormat = VK_FORMAT_R16_SFLOAT; }},
};

TEST(HostGBuffer, LayoutsThatCanBe)
{
    EXPECT_EQ(sentence(common()), "");
    EXPECT_EQ(sentence(specularColour()), "");
    CndGBufferDesc untold = common();
    untold.normalRoughnessFormat = untold.albedoFormat = untold.specularFormat =
        untold.depthFormat = VK_FORMAT_UNDEFINED;
    EXPECT_EQ(sentence(untold), "");
    CndGBufferDesc dielectric = common();
    dielectric.metalness = CND_CHANNEL_NONE;
    EXPECT_EQ(sentence(dielectric), "");
    EXPECT_EQ(sentence(constants()), "");
    EXPECT_EQ(sentence(linear()), "");
    CndGBufferDesc positions = common();
    positions.depthKind = CND_DEPTH_POSITION_WORLD;
    positions.depthFormat = VK_FORMAT_R16G16B16A16_SFLOAT;
    EXPECT_EQ(sentence(positions), "");
}

// The depth image is described for every layout.
TEST(HostGBuffer, DepthIsDescribedForEveryLayout)
{
    const CndGBufferDesc depth{.depthFormat = VK_FORMAT_R32_SFLOAT, .depthKind = CND_DEPTH_LINEAR};
    EXPECT_EQ(sentence(depth, CND_GBUFFER_FULL), "");
    EXPECT_EQ(sentence(depth, CND_GBUFFER_COMPACT), "");
    CndGBufferDesc wrong = depth;
    wrong.depthKind = CndDepthKind(7);
    EXPECT_EQ(sentence(wrong, CND_GBUFFER_FULL), "CndGBufferDesc: depthKind is not a CndDepthKind");
}

TEST(HostGBuffer, EveryMistakeHasItsSentence)
{
    for (const Mistake& mistake : mistakes) {
        CndGBufferDesc gbuffer = mistake.from();
        mistake.make(gbuffer);
        EXPECT_EQ(sentence(gbuffer), std::string("CndGBufferDesc: ") + mistake.says);
    }
}

TEST(HostGBuffer, LayoutAndDescriptionBelongTogether)
{
    EXPECT_EQ(sentence(common(), CND_GBUFFER_FULL),
              "CndGBufferDesc: members besides those about depth are filled in, but gbufferLayout "
              "is not CND_GBUFFER_HOST");
    EXPECT_EQ(sentence({}, CndGBufferLayout(4)), "gbufferLayout is not a CndGBufferLayout");
}

TEST(HostGBuffer, FramesNeedTheImagesThatAreRead)
{
    MockVulkan vulkan;
    for (const bool readsSpecular : {false, true}) {
        CndGBufferDesc gbuffer = common();
        if (!readsSpecular) {
            gbuffer.roughness = CND_CHANNEL_NORMAL_A;
            gbuffer.metalness = CND_CHANNEL_ALBEDO_A;
        }
        auto lighting = Lighting::create(
            vulkan.desc(),
            {.framesInFlight = 1, .gbufferLayout = CND_GBUFFER_HOST, .gbuffer = gbuffer});
        ASSERT_TRUE(lighting) << lighting.error().message;
        auto view = lighting.value().createView({.maxWidth = 8, .maxHeight = 8});
        ASSERT_TRUE(view) << view.error().message;
        const VkImageView any = MockVulkan::imageView();
        CndLightingFrame frame{.width = 8,
                               .height = 8,
                               .camera = MockVulkan::camera(),
                               .normalRoughness = any,
                               .albedo = any,
                               .depth = any};
        const VkCommandBuffer cmd = MockVulkan::commandBuffer();
        const auto overlay = view.value().recordOverlay(cmd, frame, {.image = any});
        EXPECT_EQ(bool(overlay), !readsSpecular) << overlay.error().message;
        EXPECT_STREQ(overlay.error().message,
                     readsSpecular ? "CndLightingFrame: specular is null" : "");
        frame.specular = any;
        EXPECT_TRUE(view.value().recordOverlay(cmd, frame, {.image = any}));
        for (const auto& [member, name] :
             {std::pair{&CndLightingFrame::normalRoughness, "normalRoughness"},
              {&CndLightingFrame::albedo, "albedo"},
              {&CndLightingFrame::depth, "depth"}}) {
            CndLightingFrame without = frame;
            without.*member = VK_NULL_HANDLE;
            const auto refused = view.value().recordOverlay(cmd, without, {.image = any});
            EXPECT_EQ(refused.error().message,
                      "CndLightingFrame: " + std::string(name) + " is null");
        }
        const auto nothing = view.value().recordOverlay(cmd, frame, {});
        EXPECT_STREQ(nothing.error().message, "CndSurfaceOverlay: image is null");
        const auto unknown = view.value().recordOverlay(
            cmd, frame, {.quantity = CndSurfaceQuantity(7), .image = any});
        EXPECT_STREQ(unknown.error().message,
                     "CndSurfaceOverlay: quantity is not a CndSurfaceQuantity");
        const auto unlit = view.value().record(cmd, frame);
        EXPECT_STREQ(unlit.error().message, "CndLightingFrame: radiance is null");
        frame.radiance = any;
        frame.specularMethod = CND_SPECULAR_NONE;
        const auto noMethod = view.value().record(cmd, frame);
        EXPECT_STREQ(noMethod.error().message,
                     "CndLightingFrame: specularMethod 1 is not among "
                     "CndLightingDesc::specularMethods; 0 means the first of these");
        frame.specularMethod = CND_SPECULAR_DEFAULT;
        EXPECT_TRUE(view.value().record(cmd, frame));
        vulkan.finish(vulkan.submit());
    }
}

} // namespace
} // namespace candelabra::test
