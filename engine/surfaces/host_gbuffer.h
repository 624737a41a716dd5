// SPDX-License-Identifier: Apache-2.0
// How the surfaces of a host are read: what of its G-buffer is checked, and what the shaders of
// kernels/common/read_gbuffer.glsl get.
#pragma once

#include <string>

#include "gpu/failure.h"
#include "gpu/kernel.h"
#include "shared/host_gbuffer.h"

namespace candelabra::surfaces
{

// Throws gpu::Failure, with a sentence, when the layout cannot be, or cannot be of the formats that
// are told, or the device cannot read those.
void checkGBuffer(const gpu::Device& device, CndGBufferLayout layout, const CndGBufferDesc& desc);

// What a frame binds. Each normal binding has an image that it can read, whichever is used.
struct GBufferViews {
    VkImageView packedNormal, hostNormal, albedo, specular, depth;
};

// One layout, for all views.
class GBufferSource
{
public:
    // Checks the layout (checkGBuffer).
    GBufferSource(const gpu::Device& device, CndGBufferLayout layout, const CndGBufferDesc& desc);

    // The value of SPEC_GBUFFER.
    uint32_t code() const { return code_; }
    float dielectricF0() const { return dielectricF0_; }

    // Throws gpu::Failure where a view that is read is null. Frames of both modules that shade
    // surfaces have the same members for them.
    template <typename Frame>
    void requireImages(const char* frameName, const Frame& f) const
    {
        const auto require = [&](const char* name, VkImageView view) {
            if (!view)
                gpu::failArgument(std::string(frameName) + ": " + name + " is null");
        };
        require("depth", f.depth);
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
        const VkImageView albedo = isCustom() ? f.depth : f.albedo; // any that is read as floats
        return {.packedNormal = isPacked() ? f.normalRoughness : standIn_.view.get(),
                .hostNormal = isHosts() ? f.normalRoughness : albedo,
                .albedo = albedo,
                .specular = f.specular && !isCustom() ? f.specular : albedo,
                .depth = f.depth};
    }

    // The first time: makes the image that stands in for packed normals readable.
    void record(const gpu::Frame& frame) noexcept;

private:
    uint32_t layout() const { return code_ & gpu::GBUFFER_LAYOUT_MASK; }
    bool isHosts() const { return layout() == gpu::GBUFFER_LAYOUT_HOST; }
    bool isCustom() const { return layout() == gpu::GBUFFER_LAYOUT_CUSTOM; }
    bool isPacked() const { return !isHosts() && !isCustom(); }

    uint32_t code_;
    float dielectricF0_;
    bool readsSpecular_;
    gpu::Image standIn_; // with a layout of the host's, or none
    bool standInReady_ = false;
};

} // namespace candelabra::surfaces
