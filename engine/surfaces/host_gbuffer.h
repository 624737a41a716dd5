// SPDX-License-Identifier: Apache-2.0
// How the G-buffer of a host is read: checks of its layout, and the layout and images as
// kernels/common/read_gbuffer.glsl takes them.
#pragma once

#include <string>

#include "gpu/failure.h"
#include "gpu/kernel.h"
#include "shared/host_gbuffer.h"

namespace candelabra::surfaces
{

// Throws gpu::Failure, with a sentence, if the layout contradicts itself or the formats that the
// host has told, or if the device cannot sample these formats.
void checkGBuffer(const gpu::Device& device, CndGBufferLayout layout, const CndGBufferDesc& desc);

// The images that the kernels of a frame bind. There are two bindings for normals, of which a
// layout uses one; the other one gets an image of a type that it can read.
struct GBufferViews {
    VkImageView packedNormal, hostNormal, albedo, specular, depth;
};

// The layout of the G-buffer, which is the same for all views of a module.
class GBufferSource
{
public:
    // Checks the layout (checkGBuffer).
    GBufferSource(const gpu::Device& device, CndGBufferLayout layout, const CndGBufferDesc& desc);

    // Returns the layout as the value of the specialisation constant SPEC_GBUFFER.
    uint32_t code() const { return code_; }
    float dielectricF0() const { return dielectricF0_; }

    // Throws gpu::Failure if an image view that kernels read is null. `f` is a CndLightingFrame or
    // a CndEnvironmentFrame, and `frameName` the name of its type.
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
        // Kernels do not read albedo with a custom layout: any image of floats will do.
        const VkImageView albedo = isCustom() ? f.depth : f.albedo;
        return {.packedNormal = isPacked() ? f.normalRoughness : standIn_.view.get(),
                .hostNormal = isHosts() ? f.normalRoughness : albedo,
                .albedo = albedo,
                .specular = f.specular && !isCustom() ? f.specular : albedo,
                .depth = f.depth};
    }

    // The first call records a barrier that makes the stand-in for packed normals readable.
    void record(const gpu::Frame& frame) noexcept;

private:
    uint32_t layout() const { return code_ & gpu::GBUFFER_LAYOUT_MASK; }
    bool isHosts() const { return layout() == gpu::GBUFFER_LAYOUT_HOST; }
    bool isCustom() const { return layout() == gpu::GBUFFER_LAYOUT_CUSTOM; }
    bool isPacked() const { return !isHosts() && !isCustom(); }

    uint32_t code_;
    float dielectricF0_;
    bool readsSpecular_;
    gpu::Image standIn_; // of one texel, bound as packed normals if the layout has none
    bool standInReady_ = false;
};

} // namespace candelabra::surfaces
