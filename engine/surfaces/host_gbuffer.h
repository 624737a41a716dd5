// SPDX-License-Identifier: Apache-2.0
// Prepares the reading of a host's G-buffer: checks of its layout, and the layout and images as
// kernels/common/read_gbuffer.glsl takes them.
#pragma once

#include <array>
#include <string>

#include "gpu/failure.h"
#include "gpu/kernel.h"
#include "shared/host_gbuffer_data.h"
#include "surfaces/stored_depth.h"

namespace candelabra::surfaces
{

// Throws gpu::Failure, with a sentence, if the layout contradicts itself or the formats that the
// host has told, or if the device cannot sample these formats.
void checkGBuffer(const gpu::Device& device, CndGBufferLayout layout, const CndGBufferDesc& desc);

// Throws gpu::Failure if shaders cannot read images in these layouts of a frame, which may be
// VK_IMAGE_LAYOUT_UNDEFINED (CndLightingFrame::gbufferImageLayout).
void checkLayouts(const char* frameName, VkImageLayout gbuffer, VkImageLayout depth);

// The images that the kernels of a frame bind. Normals, albedo and specular have two bindings each,
// of which a layout uses one at most; the others get some image of a type that they can read.
struct GBufferViews {
    std::array<gpu::SampledImage, 3> packed; // textures of integers: normals, albedo, specular
    std::array<gpu::SampledImage, 3> floats; // the same as textures of floats
    gpu::SampledImage depth;

    // Returns the bindings of a kernel, apart from depth, whose first one is `first`.
    std::array<gpu::Binding, 6> bindings() const;
    // Returns those of a kernel that reads only normals.
    std::array<gpu::Binding, 2> normalBindings() const;
};

// The layout of the G-buffer, which is the same for all views of a module.
class GBufferSource
{
public:
    // Checks the layout (checkGBuffer).
    GBufferSource(const gpu::Device& device, CndGBufferLayout layout, const CndGBufferDesc& desc);

    // Returns the layout as the value of the specialisation constant SPEC_GBUFFER.
    uint32_t code() const { return code_; }
    const CndGBufferDesc& desc() const { return desc_; }
    float dielectricF0() const;
    // Tells whether the depth image holds depth of the frame's projection.
    bool depthIsProjected() const { return desc_.depthKind == CND_DEPTH_PROJECTED; }

    // Throws gpu::Failure if an image view that kernels read is null, or cannot be read in the
    // layout that the frame says, or if clearDepth cannot be what pixels are cleared to. `f` is a
    // CndLightingFrame or a CndEnvironmentFrame, and `frameName` the name of its type.
    template <typename Frame>
    void requireImages(const char* frameName, const Frame& f) const
    {
        const auto require = [&](const char* name, VkImageView view) {
            if (!view)
                gpu::failArgument(std::string(frameName) + ": " + name + " is null");
        };
        require("depth", f.depth);
        checkLayouts(frameName, f.gbufferImageLayout, f.depthImageLayout);
        checkClearDepth(frameName, desc_.depthKind, f.camera, f.clearDepth);
        if (isCustom())
            return;
        require("normalRoughness", f.normalRoughness);
        require("albedo", f.albedo);
        if (readsSpecular_)
            require("specular", f.specular);
    }
    template <typename Frame>
    GBufferViews views(const Frame& f) const
    {
        using gpu::SampledImage;
        const SampledImage normals = SampledImage::of(f.normalRoughness, f.gbufferImageLayout);
        const SampledImage albedo = SampledImage::of(f.albedo, f.gbufferImageLayout);
        const SampledImage specular = SampledImage::of(f.specular, f.gbufferImageLayout);
        const SampledImage depth = SampledImage::of(f.depth, f.depthImageLayout);
        const SampledImage integers = isPacked() ? normals : SampledImage{standIn_.view.get()};
        GBufferViews v{{integers, integers, integers}, {depth, depth, depth}, depth};
        if (isFull())
            v.packed = {normals, albedo, specular};
        else if (!isCustom())
            v.floats = {isHosts() ? normals : albedo, albedo, readsSpecular_ ? specular : albedo};
        return v;
    }

    // The first call records the barrier after which kernels may read the image that is bound
    // where the host has no texture of integers.
    void record(const gpu::Frame& frame) noexcept;

private:
    uint32_t layout() const { return code_ & gpu::GBUFFER_LAYOUT_MASK; }
    bool isFull() const { return layout() == gpu::GBUFFER_LAYOUT_FULL; }
    bool isHosts() const { return layout() == gpu::GBUFFER_LAYOUT_HOST; }
    bool isCustom() const { return layout() == gpu::GBUFFER_LAYOUT_CUSTOM; }
    bool isPacked() const { return !isHosts() && !isCustom(); }

    CndGBufferDesc desc_;
    uint32_t code_;
    bool readsSpecular_;
    gpu::Image standIn_; // of one texel, bound as textures of integers if the layout has none
    bool standInReady_ = false;
};

} // namespace candelabra::surfaces
