// SPDX-License-Identifier: Apache-2.0
#include "measure/frame/surfaces.h"

#include <algorithm>
#include <cmath>

#include "render/camera.h"
#include "render/readback.h"
#include "shared/gbuffer_data.h"

namespace candelabra::app
{
namespace
{

template <typename T>
std::vector<T> read(const VulkanContext& context, const gpu::Image& image,
                    VkImageAspectFlags aspect, size_t words)
{
    const std::vector<uint8_t> bytes =
        readTexels(context, image, aspect, VK_IMAGE_LAYOUT_SHADER_READ_ONLY_OPTIMAL,
                   {{0, 0}, {image.width, image.height}}, uint32_t(words * sizeof(T)));
    std::vector<T> out(bytes.size() / sizeof(T));
    std::copy(bytes.begin(), bytes.end(), reinterpret_cast<uint8_t*>(out.data()));
    return out;
}

// The direction whose octahedral mapping is `p` (Meyer et al. 2010): the sphere is folded onto [-1,
// 1]^2 through an octahedron.
glm::dvec3 unfolded(const glm::dvec2& p)
{
    glm::dvec3 n(p, 1 - std::abs(p.x) - std::abs(p.y));
    const double fold = std::max(-n.z, 0.0);
    n.x += n.x >= 0 ? -fold : fold;
    n.y += n.y >= 0 ? -fold : fold;
    return glm::normalize(n);
}

double signedCode(uint32_t code, uint32_t bits)
{
    const int32_t k = int32_t(code << (32 - bits)) >> (32 - bits);
    return double(k) / double((1u << (bits - 1)) - 1);
}

// Decodes sRGB (IEC 61966-2-1).
double linearOfSrgb(double s)
{
    return s <= 0.04045 ? s / 12.92 : std::pow((s + 0.055) / 1.055, 2.4);
}

// Decodes a unit float with `mantissa` bits of mantissa (shared/gbuffer_data.h).
double unitFloat(uint32_t code, uint32_t mantissa)
{
    const uint32_t bits = code == 0 ? 0 : code + 1;
    const int exponent = int(bits >> mantissa);
    const double fraction = std::ldexp(double(bits & ((1u << mantissa) - 1)), -int(mantissa));
    return exponent == 0 ? std::ldexp(fraction, -7) : std::ldexp(1 + fraction, exponent - 8);
}

// Decodes a colour of layout FULL with unit floats of 21 bits.
glm::dvec3 colourFull(const uint32_t* words)
{
    const uint32_t blue = words[0] >> 21 | (words[1] >> 21 & 0x3ff) << 11;
    return {unitFloat(words[0] & 0x1fffff, gpu::COLOUR_MANTISSA),
            unitFloat(words[1] & 0x1fffff, gpu::COLOUR_MANTISSA),
            unitFloat(blue, gpu::COLOUR_MANTISSA)};
}

// Sets F0 and specular weight from those of layout FULL.
void decodeSpecularFull(const uint32_t* words, reference::Material& out)
{
    if (words[1] >> 31) {
        out.f0 = colourFull(words);
        out.specularWeight = 1;
        return;
    }
    out.f0 = {unitFloat(words[0] & 0xffff, gpu::COLOUR_MANTISSA_SHORT),
              unitFloat(words[0] >> 16, gpu::COLOUR_MANTISSA_SHORT),
              unitFloat(words[1] & 0xffff, gpu::COLOUR_MANTISSA_SHORT)};
    out.specularWeight = (words[1] >> 16) / double((1u << gpu::F90_BITS) - 1);
}

} // namespace

Surfaces::Surfaces(const VulkanContext& context, const Renderer& renderer,
                   const FrameOptions& frame)
    : size_(renderer.size()),
      compact_(renderer.targets().layout == CND_GBUFFER_COMPACT),
      camera_(renderer.lightingFrame(0, frame).camera)
{
    const double* v = camera_.viewFromWorld;
    const glm::dmat3 viewFromWorld(v[0], v[1], v[2], v[4], v[5], v[6], v[8], v[9], v[10]);
    worldFromView_ = glm::transpose(viewFromWorld); // the inverse, because it is a rotation
    eye_ = worldFromView_ * -glm::dvec3(v[12], v[13], v[14]);
    eyeIsPoint_ = camera_.clipFromView[11] != 0;
    const gbuffer::Targets& t = renderer.targets();
    depth_ = read<float>(context, t.depth, VK_IMAGE_ASPECT_DEPTH_BIT, 1);
    normalRoughness_ =
        read<uint32_t>(context, t.normalRoughness, VK_IMAGE_ASPECT_COLOR_BIT, compact_ ? 1 : 2);
    albedo_ = read<uint32_t>(context, t.albedo, VK_IMAGE_ASPECT_COLOR_BIT, compact_ ? 1 : 2);
    if (!compact_)
        specular_ = read<uint32_t>(context, t.specular, VK_IMAGE_ASPECT_COLOR_BIT, 2);
}

glm::dvec3 Surfaces::viewPosition(uint32_t x, uint32_t y, double depth) const
{
    const float* m = camera_.clipFromView; // columns
    const double z = (m[14] - depth * m[15]) / (depth * m[11] - m[10]);
    const double w = m[11] * z + m[15];
    const double ndcX = (2.0 * x + 1) / size_.width - 1, ndcY = (2.0 * y + 1) / size_.height - 1;
    return {(ndcX * w - m[8] * z - m[12]) / m[0], (ndcY * w - m[9] * z - m[13]) / m[5], z};
}

std::optional<reference::SurfacePoint> Surfaces::pointAt(uint32_t x, uint32_t y) const
{
    const size_t i = index(x, y);
    if (depth_[i] == clearDepth)
        return std::nullopt;
    const glm::dvec3 inView = viewPosition(x, y, depth_[i]);
    glm::dvec2 codes;
    if (compact_) {
        const uint32_t bits = gpu::NORMAL_BITS_COMPACT, word = normalRoughness_[i];
        codes = {signedCode(word, bits), signedCode(word >> bits, bits)};
    } else {
        const uint32_t bits = gpu::NORMAL_BITS_FULL;
        codes = {signedCode(normalRoughness_[2 * i], bits),
                 signedCode(normalRoughness_[2 * i + 1], bits)};
    }
    return reference::SurfacePoint{
        .position = eye_ + worldFromView_ * inView,
        .normal = worldFromView_ * unfolded(codes),
        .toEye = worldFromView_ * (eyeIsPoint_ ? glm::normalize(-inView) : glm::dvec3(0, 0, 1))};
}

reference::Material Surfaces::materialAt(uint32_t x, uint32_t y) const
{
    const size_t i = index(x, y);
    reference::Material out;
    double roughness = 0;
    if (compact_) {
        const uint32_t word = normalRoughness_[i], rgba = albedo_[i];
        glm::dvec3 base;
        for (int c = 0; c < 3; ++c)
            base[c] = linearOfSrgb((rgba >> (8 * c) & 0xff) / 255.0);
        const double metalness = (rgba >> 24) / 255.0;
        const uint32_t unlit = gpu::NORMAL_ROUGHNESS_UNLIT_COMPACT;
        const double lit = (word & 0xfffu) == unlit ? 0 : 1;
        roughness = (word >> 24) / 255.0;
        out.diffuseAlbedo = base * (1 - metalness) * lit;
        out.f0 = glm::mix(glm::dvec3(gpu::DIELECTRIC_F0), base, metalness) * lit;
        out.specularWeight = lit;
    } else {
        const uint32_t* words = &normalRoughness_[2 * i];
        roughness = unitFloat(words[0] >> 23 | words[1] >> 23 << 9, gpu::ROUGHNESS_MANTISSA);
        out.diffuseAlbedo = colourFull(&albedo_[2 * i]);
        decodeSpecularFull(&specular_[2 * i], out);
    }
    out.alpha = std::max(roughness * roughness, 0.002); // the floor of CND_GBUFFER_FULL
    return out;
}

std::optional<SeenSurface> Surfaces::at(uint32_t x, uint32_t y) const
{
    const auto point = pointAt(x, y);
    if (!point)
        return std::nullopt;
    return SeenSurface{*point, materialAt(x, y)};
}

} // namespace candelabra::app
