// SPDX-License-Identifier: Apache-2.0
// Checks the host's description of its G-buffer.
#include <algorithm>
#include <cmath>
#include <iterator>
#include <string>

#include "gpu/format_name.h"
#include "surfaces/host_gbuffer.h"

namespace candelabra::surfaces
{
namespace
{

// The values that a format stores: 0 and more, both signs, or sRGB-encoded colours.
enum class Numbers { Unsigned, Signed, Encoded };

struct ColourFormat {
    VkFormat format;
    uint32_t channels;
    Numbers numbers;

    std::string name() const { return gpu::formatName(format); }
};

#define FORMAT(name, channels, numbers)                                                            \
    {                                                                                              \
        VK_FORMAT_##name, channels, Numbers::numbers                                               \
    }
// The formats of G-buffer images that shaders read as floats.
constexpr ColourFormat colourFormats[] = {FORMAT(R8_UNORM, 1, Unsigned),
                                          FORMAT(R8_SNORM, 1, Signed),
                                          FORMAT(R8G8_UNORM, 2, Unsigned),
                                          FORMAT(R8G8_SNORM, 2, Signed),
                                          FORMAT(R5G6B5_UNORM_PACK16, 3, Unsigned),
                                          FORMAT(R8G8B8A8_UNORM, 4, Unsigned),
                                          FORMAT(R8G8B8A8_SNORM, 4, Signed),
                                          FORMAT(R8G8B8A8_SRGB, 4, Encoded),
                                          FORMAT(B8G8R8A8_UNORM, 4, Unsigned),
                                          FORMAT(B8G8R8A8_SRGB, 4, Encoded),
                                          FORMAT(A8B8G8R8_UNORM_PACK32, 4, Unsigned),
                                          FORMAT(A8B8G8R8_SNORM_PACK32, 4, Signed),
                                          FORMAT(A8B8G8R8_SRGB_PACK32, 4, Encoded),
                                          FORMAT(A2R10G10B10_UNORM_PACK32, 4, Unsigned),
                                          FORMAT(A2B10G10R10_UNORM_PACK32, 4, Unsigned),
                                          FORMAT(A2B10G10R10_SNORM_PACK32, 4, Signed),
                                          FORMAT(B10G11R11_UFLOAT_PACK32, 3, Unsigned),
                                          FORMAT(E5B9G9R9_UFLOAT_PACK32, 3, Unsigned),
                                          FORMAT(R16_UNORM, 1, Unsigned),
                                          FORMAT(R16_SNORM, 1, Signed),
                                          FORMAT(R16_SFLOAT, 1, Signed),
                                          FORMAT(R16G16_UNORM, 2, Unsigned),
                                          FORMAT(R16G16_SNORM, 2, Signed),
                                          FORMAT(R16G16_SFLOAT, 2, Signed),
                                          FORMAT(R16G16B16A16_UNORM, 4, Unsigned),
                                          FORMAT(R16G16B16A16_SNORM, 4, Signed),
                                          FORMAT(R16G16B16A16_SFLOAT, 4, Signed),
                                          FORMAT(R32_SFLOAT, 1, Signed),
                                          FORMAT(R32G32_SFLOAT, 2, Signed),
                                          FORMAT(R32G32B32A32_SFLOAT, 4, Signed)};
#undef FORMAT

constexpr VkFormat depthFormats[] = {VK_FORMAT_D16_UNORM,           VK_FORMAT_D16_UNORM_S8_UINT,
                                     VK_FORMAT_X8_D24_UNORM_PACK32, VK_FORMAT_D24_UNORM_S8_UINT,
                                     VK_FORMAT_D32_SFLOAT,          VK_FORMAT_D32_SFLOAT_S8_UINT,
                                     VK_FORMAT_R32_SFLOAT};

[[noreturn]] void fail(const std::string& sentence)
{
    gpu::failArgument("CndGBufferDesc: " + sentence);
}

void requireSampled(const gpu::Device& device, const char* member, VkFormat format)
{
    VkFormatProperties2 properties{.sType = VK_STRUCTURE_TYPE_FORMAT_PROPERTIES_2};
    device.GetPhysicalDeviceFormatProperties2(device.physicalDevice, format, &properties);
    if (!(properties.formatProperties.optimalTilingFeatures & VK_FORMAT_FEATURE_SAMPLED_IMAGE_BIT))
        gpu::failUnsupported(std::string("CndGBufferDesc: the device cannot sample ") + member +
                             ", whose format is " + gpu::formatName(format));
}

// One of the three colour images of a frame.
struct Image {
    const char* name;
    VkFormat format;
    const ColourFormat* known; // null: the host has not told the format
    uint32_t taken;            // how many channels, from red on, hold the normal or a colour
    const char* takenBy;
};

const ColourFormat* findColourFormat(const gpu::Device& device, const char* image, VkFormat format)
{
    if (format == VK_FORMAT_UNDEFINED)
        return nullptr;
    const auto* const known = std::ranges::find(colourFormats, format, &ColourFormat::format);
    const std::string member = std::string(image) + "Format";
    if (known == std::end(colourFormats))
        fail(member + " " + gpu::formatName(format) +
             " is no colour format that shaders read as floats");
    requireSampled(device, member.c_str(), format);
    return known;
}

void checkTaken(const Image& image)
{
    if (image.known && image.known->channels < image.taken)
        fail(std::string(image.takenBy) + " needs " + std::to_string(image.taken) + " channels, " +
             image.name + "Format " + image.known->name() + " has " +
             std::to_string(image.known->channels));
}

// Checks the channel of a scalar, such as roughness, which shares an image with other values.
void checkChannel(const char* member, CndGBufferChannel channel, const Image (&images)[3])
{
    constexpr const char* letters[] = {"red", "green", "blue", "alpha"};
    if (uint32_t(channel) > CND_CHANNEL_SPECULAR_A)
        fail(std::string(member) + " is not a CndGBufferChannel");
    if (channel == CND_CHANNEL_NONE)
        return;
    const Image& image = images[(channel - 1) / 4];
    const uint32_t component = uint32_t(channel - 1) % 4;
    const std::string where =
        std::string(member) + " is " + letters[component] + " of " + image.name;
    if (component < image.taken)
        fail(where + ", where " + image.takenBy + " is");
    if (!image.known)
        return;
    if (component >= image.known->channels)
        fail(where + ", which its format " + image.known->name() + " has not");
    if (image.known->numbers == Numbers::Encoded && component < 3)
        fail(where + ", whose format " + image.known->name() + " decodes it as a colour");
}

void checkNormal(const CndGBufferDesc& d, const Image& image)
{
    const bool isSigned =
        d.normalEncoding == CND_NORMAL_SNORM || d.normalEncoding == CND_NORMAL_OCTAHEDRAL_SNORM;
    if (!image.known)
        return;
    const std::string format = std::string("normalRoughnessFormat ") + image.known->name();
    if (image.known->numbers == Numbers::Encoded)
        fail(format + " decodes normals as colours");
    if (isSigned && image.known->numbers == Numbers::Unsigned)
        fail(format + " has no negative values, which normalEncoding asks for");
    const bool isSnorm = image.known->numbers == Numbers::Signed &&
                         std::string(image.known->name()).find("SNORM") != std::string::npos;
    if (!isSigned && isSnorm)
        fail(format + " holds negative values, normalEncoding says 0..1");
}

void checkEnumerators(const CndGBufferDesc& d)
{
    const auto check = [](const char* what, int value, int last) {
        if (value < 0 || value > last)
            fail(what);
    };
    check("normalEncoding is not a CndNormalEncoding", d.normalEncoding,
          CND_NORMAL_OCTAHEDRAL_SNORM);
    check("normalSpace is not a CndNormalSpace", d.normalSpace, CND_NORMALS_WORLD);
    check("roughnessKind is not a CndRoughnessKind", d.roughnessKind, CND_ROUGHNESS_SMOOTHNESS);
    check("reflectance is not a CndReflectance", d.reflectance, CND_REFLECTANCE_SPECULAR);
}

void checkConstants(const CndGBufferDesc& d)
{
    if (d.roughness == CND_CHANNEL_NONE && !(d.constantRoughness > 0 && d.constantRoughness <= 1))
        fail("roughness names no channel: constantRoughness must then be above 0 and at most 1");
    if (d.roughness != CND_CHANNEL_NONE && d.constantRoughness != 0)
        fail("constantRoughness is set, but roughness names a channel");
    if (!(d.constantMetalness >= 0 && d.constantMetalness <= 1))
        fail("constantMetalness must be 0..1");
    if (d.metalness != CND_CHANNEL_NONE && d.constantMetalness != 0)
        fail("constantMetalness is set, but metalness names a channel");
}

// Checks the members about depth, which every layout has.
void checkDepth(const gpu::Device& device, const CndGBufferDesc& d)
{
    if (uint32_t(d.depthKind) > CND_DEPTH_POSITION_WORLD)
        fail("depthKind is not a CndDepthKind");
    if (!(d.depthUnit >= 0 && std::isfinite(d.depthUnit)))
        fail("depthUnit must be finite and >= 0");
    if (d.depthUnit > 0 && d.depthKind != CND_DEPTH_LINEAR)
        fail("depthUnit is set, but depthKind is not CND_DEPTH_LINEAR");
    if (d.depthFormat == VK_FORMAT_UNDEFINED)
        return;
    if (d.depthKind == CND_DEPTH_PROJECTED) {
        if (std::ranges::find(depthFormats, d.depthFormat) == std::end(depthFormats))
            fail("depthFormat " + gpu::formatName(d.depthFormat) +
                 " is neither a depth format nor VK_FORMAT_R32_SFLOAT");
        requireSampled(device, "depthFormat", d.depthFormat);
        return;
    }
    const ColourFormat& format = *findColourFormat(device, "depth", d.depthFormat);
    if (format.numbers == Numbers::Encoded)
        fail(std::string("depthFormat ") + format.name() + " decodes depths as colours");
    const bool positions = d.depthKind != CND_DEPTH_LINEAR;
    if (positions && (format.channels < 4 || format.numbers != Numbers::Signed))
        fail(std::string("depthFormat ") + format.name() +
             " cannot hold positions, which need four channels and both signs");
}

} // namespace

void checkGBuffer(const gpu::Device& device, CndGBufferLayout layout, const CndGBufferDesc& d)
{
    if (uint32_t(layout) > CND_GBUFFER_CUSTOM)
        gpu::failArgument("gbufferLayout is not a CndGBufferLayout");
    checkDepth(device, d);
    if (layout != CND_GBUFFER_HOST) {
        if (d.roughness != CND_CHANNEL_NONE || d.constantRoughness != 0)
            fail("members besides those about depth are filled in, but gbufferLayout is not "
                 "CND_GBUFFER_HOST");
        return;
    }
    checkEnumerators(d);
    const bool octahedral = d.normalEncoding == CND_NORMAL_OCTAHEDRAL_UNORM ||
                            d.normalEncoding == CND_NORMAL_OCTAHEDRAL_SNORM;
    const bool specularColour = d.reflectance == CND_REFLECTANCE_SPECULAR;
    const auto image = [&](const char* name, VkFormat format, uint32_t taken, const char* takenBy) {
        return Image{name, format, findColourFormat(device, name, format), taken, takenBy};
    };
    const Image images[3] = {
        image("normalRoughness", d.normalRoughnessFormat, octahedral ? 2 : 3, "the normal"),
        image("albedo", d.albedoFormat, 3, specularColour ? "the albedo" : "the base colour"),
        image("specular", d.specularFormat, specularColour ? 3 : 0, "F0")};
    for (const Image& i : images)
        checkTaken(i);
    checkNormal(d, images[0]);
    checkConstants(d);
    checkChannel("roughness", d.roughness, images);
    checkChannel("metalness", d.metalness, images);
    checkChannel("f90", d.f90, images);
    if (d.roughness != CND_CHANNEL_NONE && (d.roughness == d.metalness || d.roughness == d.f90))
        fail("roughness is in the channel of another quantity");
    if (specularColour &&
        (d.metalness != CND_CHANNEL_NONE || d.constantMetalness != 0 || d.dielectricF0 != 0))
        fail("metalness, constantMetalness and dielectricF0 are of CND_REFLECTANCE_METALNESS, "
             "reflectance is "
             "CND_REFLECTANCE_SPECULAR");
    if (!specularColour && d.f90 != CND_CHANNEL_NONE)
        fail("f90 is of CND_REFLECTANCE_SPECULAR, reflectance is CND_REFLECTANCE_METALNESS");
    if (!(d.dielectricF0 >= 0 && d.dielectricF0 <= 1))
        fail("dielectricF0 must be 0..1");
}

void checkLayouts(const char* frameName, VkImageLayout gbuffer, VkImageLayout depth)
{
    constexpr VkImageLayout ofDepth[] = {
        VK_IMAGE_LAYOUT_DEPTH_STENCIL_READ_ONLY_OPTIMAL, VK_IMAGE_LAYOUT_DEPTH_READ_ONLY_OPTIMAL,
        VK_IMAGE_LAYOUT_DEPTH_READ_ONLY_STENCIL_ATTACHMENT_OPTIMAL};
    if (!gpu::canBeRead(gbuffer))
        gpu::failArgument(std::string(frameName) +
                          ": gbufferImageLayout must be SHADER_READ_ONLY_OPTIMAL, "
                          "READ_ONLY_OPTIMAL or GENERAL");
    if (!gpu::canBeRead(depth) && std::ranges::find(ofDepth, depth) == std::end(ofDepth))
        gpu::failArgument(std::string(frameName) +
                          ": depthImageLayout is no layout in which shaders read depth: it may be "
                          "GENERAL, or a read-only layout of shaders or of depth");
}

} // namespace candelabra::surfaces
