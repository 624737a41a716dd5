// SPDX-License-Identifier: Apache-2.0
// How the G-buffer of a host is read: checks of its layout, and the layout and images as
// kernels/common/read_gbuffer.glsl takes them.
#pragma once

#include <array>
#include <string>

#include "gpu/failure.h"
#include "gpu/kernel.h"
#include "shared/host_gbuffer.h"

namespace candelabra::surfaces
{

// Throws gpu::Failure, with a sentence, if the layout contradicts itself or the formats that the
// host has told, or if the device cannot sample these formats.
void checkGBuffer(const gpu::Device& device, CndGBufferLayout layout, const CndGBufferDesc& desc);

// The images that the kernels of a frame bind. Normals, albedo and specular have two bindings each,
// of which a layout uses one at most; the others get some image of a type that they can read.
struct GBufferViews {
    std::array<VkImageView, 3> packed; // textures of integers: normals, albedo, specular
    std::array<VkImageView, 3> floats; // the same as textures of floats
    VkImageView depth;

    // Returns the bindings of a kernel, apart from depth, whose first one is `first`.
    std::array<gpu::Binding, 6> bindings(uint32_t first) const;
    // Returns those of a kernel that reads only normals.
    std::array<gpu::Binding, 2> normalBindings(uint32_t first) const;
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
        const VkImageView integers = isPacked() ? f.normalRoughness : standIn_.view.get();
        GBufferViews v{{integers, integers, integers}, {f.depth, f.depth, f.depth}, f.depth};
        if (isFull()) {
            v.packed = {f.normalRoughness, f.albedo, f.specular};
        } else if (!isCustom()) {
            const VkImageView normal = isHosts() ? f.normalRoughness : f.albedo;
            v.floats = {normal, f.albedo, readsSpecular_ ? f.specular : f.albedo};
        }
        return v;
    }

    // The first call records a barrier that makes the stand-in for textures of integers readable.
    void record(const gpu::Frame& frame) noexcept;

private:
    uint32_t layout() const { return code_ & gpu::GBUFFER_LAYOUT_MASK; }
    bool isFull() const { return layout() == gpu::GBUFFER_LAYOUT_FULL; }
    bool isHosts() const { return layout() == gpu::GBUFFER_LAYOUT_HOST; }
    bool isCustom() const { return layout() == gpu::GBUFFER_LAYOUT_CUSTOM; }
    bool isPacked() const { return !isHosts() && !isCustom(); }

    uint32_t code_;
    float dielectricF0_;
    bool readsSpecular_;
    gpu::Image standIn_; // of one texel, bound as textures of integers if the layout has none
    bool standInReady_ = false;
};

} // namespace candelabra::surfaces
