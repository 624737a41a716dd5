// SPDX-License-Identifier: Apache-2.0
#include "gpu/host_gbuffer_harness.h"
#include "gpu/fill_image.h"

#include <cmath>
#include <cstring>
#include <stdexcept>

#include <glm/gtc/packing.hpp>

namespace candelabra::test
{
namespace
{

// A texel format. In all of these the channels follow one another from the lowest bit on.
struct Texel {
    VkFormat format;
    int bits[4];
    enum { Unorm, Snorm, Srgb, Half, Float } numbers;
};

constexpr Texel texelFormats[] = {
    {VK_FORMAT_R32_SFLOAT, {32}, Texel::Float},
    {VK_FORMAT_R8G8_UNORM, {8, 8}, Texel::Unorm},
    {VK_FORMAT_R8G8B8A8_UNORM, {8, 8, 8, 8}, Texel::Unorm},
    {VK_FORMAT_R8G8B8A8_SNORM, {8, 8, 8, 8}, Texel::Snorm},
    {VK_FORMAT_R8G8B8A8_SRGB, {8, 8, 8, 8}, Texel::Srgb},
    {VK_FORMAT_A2B10G10R10_UNORM_PACK32, {10, 10, 10, 2}, Texel::Unorm},
    {VK_FORMAT_R16G16_UNORM, {16, 16}, Texel::Unorm},
    {VK_FORMAT_R16G16_SNORM, {16, 16}, Texel::Snorm},
    {VK_FORMAT_R16G16B16A16_SFLOAT, {16, 16, 16, 16}, Texel::Half},
    {VK_FORMAT_R32G32B32A32_SFLOAT, {32, 32, 32, 32}, Texel::Float}};

double encodeSrgb(double x)
{
    return x <= 0.0031308 ? 12.92 * x : 1.055 * std::pow(x, 1 / 2.4) - 0.055;
}

double decodeSrgb(double x)
{
    return x <= 0.04045 ? x / 12.92 : std::pow((x + 0.055) / 1.055, 2.4);
}

// Returns the code that stores a value, and the value that it decodes to.
std::pair<uint32_t, double> encode(const Texel& t, int channel, double value)
{
    if (t.numbers == Texel::Float)
        return {glm::floatBitsToUint(float(value)), double(float(value))};
    if (t.numbers == Texel::Half) {
        const uint16_t code = glm::packHalf1x16(float(value));
        return {code, double(glm::unpackHalf1x16(code))};
    }
    const bool isSigned = t.numbers == Texel::Snorm;
    const bool srgb = t.numbers == Texel::Srgb && channel < 3;
    const double scale = std::exp2(t.bits[channel] - (isSigned ? 1 : 0)) - 1;
    const double stored = std::clamp(srgb ? encodeSrgb(value) : value, isSigned ? -1.0 : 0.0, 1.0);
    const long code = std::lround(stored * scale);
    const double read = double(code) / scale;
    const uint32_t mask = uint32_t(std::exp2(t.bits[channel]) - 1);
    return {uint32_t(code) & mask, srgb ? decodeSrgb(read) : read};
}

template <typename T>
void append(std::vector<std::byte>& out, const T& value)
{
    const auto* bytes = reinterpret_cast<const std::byte*>(&value);
    out.insert(out.end(), bytes, bytes + sizeof value);
}

// Octahedral encoding (Cigolle et al. 2014): the lower half is folded over the corners.
glm::dvec2 toOctahedron(const glm::dvec3& n)
{
    const glm::dvec3 p = n / (std::abs(n.x) + std::abs(n.y) + std::abs(n.z));
    if (p.z >= 0)
        return glm::dvec2(p);
    return {std::copysign(1 - std::abs(p.y), p.x), std::copysign(1 - std::abs(p.x), p.y)};
}

glm::dvec3 fromOctahedron(const glm::dvec2& p)
{
    const double z = 1 - std::abs(p.x) - std::abs(p.y);
    if (z >= 0)
        return glm::normalize(glm::dvec3(p, z));
    return glm::normalize(glm::dvec3(std::copysign(1 - std::abs(p.y), p.x),
                                     std::copysign(1 - std::abs(p.x), p.y), z));
}

bool isOctahedral(const CndGBufferDesc& d)
{
    return d.normalEncoding == CND_NORMAL_OCTAHEDRAL_UNORM ||
           d.normalEncoding == CND_NORMAL_OCTAHEDRAL_SNORM;
}

bool isUnorm(const CndGBufferDesc& d)
{
    return d.normalEncoding == CND_NORMAL_UNORM || d.normalEncoding == CND_NORMAL_OCTAHEDRAL_UNORM;
}

double roughnessToStored(CndRoughnessKind kind, double perceptual)
{
    return kind == CND_ROUGHNESS_ALPHA        ? perceptual * perceptual
           : kind == CND_ROUGHNESS_SMOOTHNESS ? 1 - perceptual
                                              : perceptual;
}

double roughnessFromStored(CndRoughnessKind kind, double stored)
{
    return kind == CND_ROUGHNESS_ALPHA        ? std::sqrt(stored)
           : kind == CND_ROUGHNESS_SMOOTHNESS ? 1 - stored
                                              : stored;
}

double f0OfDielectrics(const CndGBufferDesc& d)
{
    return d.dielectricF0 > 0 ? double(d.dielectricF0) : 0.04;
}

// Returns the surface as the FULL layout stores it.
CpuSurface fullSurface(const CndGBufferDesc& d, const HostSurface& s, double depth)
{
    const glm::dvec3 f0 = glm::mix(glm::dvec3(f0OfDielectrics(d)), s.baseColour, s.metalness);
    return {.depth = float(depth),
            .normal = s.normal,
            .perceptualRoughness = s.perceptualRoughness,
            .albedo = s.baseColour * (1 - s.metalness),
            .F0F90 = glm::dvec4(f0, 1)};
}

} // namespace

glm::dvec4 appendTexel(std::vector<std::byte>& out, VkFormat format, const glm::dvec4& value)
{
    for (const Texel& t : texelFormats) {
        if (t.format != format)
            continue;
        glm::dvec4 read(0, 0, 0, 1); // channels that do not exist read as these values
        uint64_t packed[2] = {};
        int bit = 0;
        for (int c = 0; c < 4 && t.bits[c]; ++c) {
            const auto [code, meant] = encode(t, c, value[c]);
            packed[bit / 64] |= uint64_t(code) << bit % 64;
            bit += t.bits[c];
            read[c] = meant;
        }
        const auto* bytes = reinterpret_cast<const std::byte*>(packed);
        out.insert(out.end(), bytes, bytes + bit / 8);
        return read;
    }
    throw std::logic_error("appendTexel does not know the format");
}

double appendDepth(std::vector<std::byte>& out, VkFormat format, double depth)
{
    if (format == VK_FORMAT_D16_UNORM) {
        const auto code = uint16_t(std::lround(depth * 65535));
        append(out, code);
        return code / 65535.0;
    }
    if (format == VK_FORMAT_X8_D24_UNORM_PACK32) {
        const auto code = uint32_t(std::lround(depth * 16777215));
        append(out, code);
        return code / 16777215.0;
    }
    append(out, float(depth));
    return double(float(depth));
}

HostPacking::HostPacking(const CndGBufferDesc& desc, uint32_t width, uint32_t height,
                         const CndCamera& camera, float clearDepth)
    : out_{.desc = desc, .width = width, .height = height}, storedFromView_(1)
{
    out_.asFull = {.width = width, .height = height, .camera = camera, .clearDepth = clearDepth};
    out_.unrounded = out_.asFull;
    if (desc.normalSpace == CND_NORMALS_WORLD) {
        glm::dmat4 viewFromWorld;
        std::memcpy(&viewFromWorld, camera.viewFromWorld, sizeof viewFromWorld);
        storedFromView_ = glm::transpose(glm::dmat3(viewFromWorld));
    }
}

double HostPacking::addDepth(double depth)
{
    const CndGBufferDesc& d = out_.desc;
    if (d.depthKind == CND_DEPTH_PROJECTED)
        return appendDepth(out_.depth, d.depthFormat, depth);
    const CpuGBuffer& g = out_.asFull;
    const uint32_t pixel = uint32_t(g.depth.size());
    const bool surface = float(depth) != g.clearDepth;
    CpuGBuffer one = g; // with this pixel
    one.depth.push_back(float(depth));
    const glm::dvec3 view =
        surface ? viewPosition(one, pixel % g.width, pixel / g.width) : glm::dvec3(0);
    glm::dmat4 viewFromWorld;
    std::memcpy(&viewFromWorld, g.camera.viewFromWorld, sizeof viewFromWorld);
    const glm::dvec4 clear(double(g.clearDepth)); // the frame's clearDepth, of whatever kind
    glm::dvec4 stored = clear;
    if (surface && d.depthKind == CND_DEPTH_LINEAR)
        stored = glm::dvec4(-view.z / (d.depthUnit > 0 ? double(d.depthUnit) : 1));
    else if (surface && d.depthKind == CND_DEPTH_POSITION_VIEW)
        stored = glm::dvec4(view, 0.5);
    else if (surface)
        stored = glm::dvec4(glm::dvec3(glm::inverse(viewFromWorld) * glm::dvec4(view, 1)), 0.5);
    appendTexel(out_.depth, d.depthFormat, stored);
    return depth;
}

void HostPacking::add(const HostSurface& s, double depth)
{
    const CndGBufferDesc& d = out_.desc;
    glm::dvec4 images[3]{};
    glm::dvec3 normal = storedFromView_ * glm::normalize(s.normal);
    if (isOctahedral(d))
        normal = glm::dvec3(toOctahedron(normal), 0);
    images[0] = glm::dvec4(isUnorm(d) ? 0.5 + 0.5 * normal : normal, 0);
    const bool specular = d.reflectance == CND_REFLECTANCE_SPECULAR;
    const CpuSurface exact = fullSurface(d, s, depth);
    images[1] = glm::dvec4(specular ? exact.albedo : s.baseColour, 0);
    images[2] = specular ? exact.F0F90 : glm::dvec4(0);
    const auto channel = [&](CndGBufferChannel c) -> double& {
        return images[(c - 1) / 4][(c - 1) % 4];
    };
    if (d.roughness != CND_CHANNEL_NONE)
        channel(d.roughness) = roughnessToStored(d.roughnessKind, s.perceptualRoughness);
    if (d.metalness != CND_CHANNEL_NONE)
        channel(d.metalness) = s.metalness;
    if (d.f90 != CND_CHANNEL_NONE)
        channel(d.f90) = 1;

    const VkFormat formats[3] = {d.normalRoughnessFormat, d.albedoFormat, d.specularFormat};
    for (int i = 0; i < 3; ++i)
        images[i] = appendTexel(out_.images[i], formats[i], images[i]);
    const double readDepth = addDepth(depth);
    addPixel(out_.unrounded, fullSurface(d, s, readDepth));

    // Decode what was stored, following the same description backwards.
    HostSurface read;
    normal = glm::dvec3(images[0]);
    normal = isUnorm(d) ? 2.0 * normal - 1.0 : normal;
    if (isOctahedral(d))
        normal = fromOctahedron(glm::dvec2(normal));
    read.normal = glm::transpose(storedFromView_) * normal;
    read.perceptualRoughness = d.roughness != CND_CHANNEL_NONE
                                   ? roughnessFromStored(d.roughnessKind, channel(d.roughness))
                                   : double(d.constantRoughness);
    read.metalness =
        d.metalness != CND_CHANNEL_NONE ? channel(d.metalness) : double(d.constantMetalness);
    read.baseColour = glm::dvec3(images[1]);
    CpuSurface full = fullSurface(d, read, readDepth);
    if (specular) {
        full.albedo = glm::dvec3(images[1]);
        full.F0F90 =
            glm::dvec4(glm::dvec3(images[2]), d.f90 != CND_CHANNEL_NONE ? channel(d.f90) : 1);
    }
    addPixel(out_.asFull, full);
}

HostGBufferTest::HostImages HostGBufferTest::uploadHost(const HostPixels& p)
{
    const CndGBufferDesc& d = p.desc;
    const VkFormat formats[4] = {d.normalRoughnessFormat, d.albedoFormat, d.specularFormat,
                                 d.depthFormat};
    HostImages images;
    for (int i = 0; i < 4; ++i) {
        const bool isDepth =
            i == 3 && formats[3] != VK_FORMAT_R32_SFLOAT && d.depthKind == CND_DEPTH_PROJECTED;
        const VkImageAspectFlags aspect =
            isDepth ? VK_IMAGE_ASPECT_DEPTH_BIT : VK_IMAGE_ASPECT_COLOR_BIT;
        const bool stencil = formats[i] == VK_FORMAT_D32_SFLOAT_S8_UINT;
        gpu::Image& image = i == 3 ? images.depth : images.colour[i];
        image =
            gpu::createImage(device(), "host G-buffer", formats[i], p.width, p.height,
                             VK_IMAGE_USAGE_SAMPLED_BIT | VK_IMAGE_USAGE_TRANSFER_DST_BIT, aspect);
        const gpu::Buffer data = upload("host G-buffer data", i == 3 ? p.depth : p.images[i]);
        context().submitAndWait([&](VkCommandBuffer cmd) {
            fillImage(cmd, data, image.image.get(), p.width, p.height, aspect,
                      stencil ? VK_IMAGE_ASPECT_STENCIL_BIT : 0);
        });
    }
    return images;
}

} // namespace candelabra::test
