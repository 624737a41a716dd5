// SPDX-License-Identifier: Apache-2.0
#include "surfaces/host_gbuffer.h"

namespace candelabra::surfaces
{
namespace
{

static_assert(gpu::GBUFFER_LAYOUT_FULL == CND_GBUFFER_FULL);
static_assert(gpu::GBUFFER_LAYOUT_COMPACT == CND_GBUFFER_COMPACT);
static_assert(gpu::GBUFFER_LAYOUT_HOST == CND_GBUFFER_HOST);
static_assert(gpu::GBUFFER_LAYOUT_CUSTOM == CND_GBUFFER_CUSTOM);
static_assert(gpu::GBUFFER_NORMAL_UNORM == CND_NORMAL_UNORM);
static_assert(gpu::GBUFFER_NORMAL_SNORM == CND_NORMAL_SNORM);
static_assert(gpu::GBUFFER_NORMAL_OCTAHEDRAL_UNORM == CND_NORMAL_OCTAHEDRAL_UNORM);
static_assert(gpu::GBUFFER_NORMAL_OCTAHEDRAL_SNORM == CND_NORMAL_OCTAHEDRAL_SNORM);
static_assert(gpu::GBUFFER_ROUGHNESS_ALPHA == CND_ROUGHNESS_ALPHA);
static_assert(gpu::GBUFFER_ROUGHNESS_SMOOTHNESS == CND_ROUGHNESS_SMOOTHNESS);

uint32_t codeOf(CndGBufferLayout layout, const CndGBufferDesc& d)
{
    const uint32_t always = layout | d.depthKind << gpu::GBUFFER_DEPTH_KIND_SHIFT;
    if (layout != CND_GBUFFER_HOST)
        return always;
    return always | d.normalEncoding << gpu::GBUFFER_NORMAL_SHIFT |
           d.normalSpace << gpu::GBUFFER_WORLD_SHIFT |
           d.roughnessKind << gpu::GBUFFER_ROUGHNESS_KIND_SHIFT |
           d.reflectance << gpu::GBUFFER_SPECULAR_COLOUR_SHIFT |
           d.roughness << gpu::GBUFFER_ROUGHNESS_SHIFT |
           d.metalness << gpu::GBUFFER_METALNESS_SHIFT | d.f90 << gpu::GBUFFER_F90_SHIFT;
}

bool readsSpecular(CndGBufferLayout layout, const CndGBufferDesc& d)
{
    if (layout != CND_GBUFFER_HOST)
        return layout == CND_GBUFFER_FULL;
    return d.reflectance == CND_REFLECTANCE_SPECULAR || d.roughness >= CND_CHANNEL_SPECULAR_R ||
           d.metalness >= CND_CHANNEL_SPECULAR_R;
}

} // namespace

std::array<gpu::Binding, 6> GBufferViews::bindings() const
{
    using gpu::Binding;
    return {Binding::sampled(gpu::GBUFFER_PACKED_NORMAL, packed[0]),
            Binding::sampled(gpu::GBUFFER_PACKED_ALBEDO, packed[1]),
            Binding::sampled(gpu::GBUFFER_PACKED_SPECULAR, packed[2]),
            Binding::sampled(gpu::GBUFFER_NORMAL, floats[0]),
            Binding::sampled(gpu::GBUFFER_ALBEDO, floats[1]),
            Binding::sampled(gpu::GBUFFER_SPECULAR, floats[2])};
}

std::array<gpu::Binding, 2> GBufferViews::normalBindings() const
{
    return {gpu::Binding::sampled(gpu::GBUFFER_PACKED_NORMAL, packed[0]),
            gpu::Binding::sampled(gpu::GBUFFER_NORMAL, floats[0])};
}

GBufferSource::GBufferSource(const gpu::Device& device, CndGBufferLayout layout,
                             const CndGBufferDesc& desc)
    : desc_(desc)
{
    checkGBuffer(device, layout, desc);
    code_ = codeOf(layout, desc);
    readsSpecular_ = readsSpecular(layout, desc);
    if (!isPacked())
        standIn_ = gpu::createImage(device, "no packed G-buffer", VK_FORMAT_R32_UINT, 1, 1,
                                    VK_IMAGE_USAGE_SAMPLED_BIT, VK_IMAGE_ASPECT_COLOR_BIT);
}

float GBufferSource::dielectricF0() const
{
    return desc_.dielectricF0 > 0 ? desc_.dielectricF0 : gpu::DIELECTRIC_F0;
}

void GBufferSource::record(const gpu::Frame& frame) noexcept
{
    if (standInReady_ || isPacked())
        return;
    standInReady_ = true;
    frame.layoutBarrier(standIn_.image.get(), VK_IMAGE_LAYOUT_SHADER_READ_ONLY_OPTIMAL);
}

} // namespace candelabra::surfaces
