// SPDX-License-Identifier: Apache-2.0
// The bindings with which the host's own shaders light points by the lights of a view
// (lib/forward.glsl).
#pragma once

#include "gpu/kernel.h"
#include "shared/forward_data.h"
#include "surfaces/host_kernels.h"

namespace candelabra::lighting
{

// What the sets of a module have for shadows. A shader with rays in a module without, or a shader
// that walks in one with rays, might find nothing and show no shadows. So each fits its own layout,
// and validation tells when a pipeline is made of the other.
enum class ForwardShadows { None, OfOccluders, OfRays };
ForwardShadows forwardShadows(const CndLightingDesc& desc, const surfaces::HostKernels& kernels);

// Creates the layout of the descriptor sets, or none if `stages` is 0. Throws gpu::Failure if
// `stages` has other stages than vertex, fragment and compute.
gpu::Handle<VkDescriptorSetLayout>
createForwardLayout(const gpu::Device& device, VkShaderStageFlags stages, ForwardShadows shadows);

// The descriptor sets of one view, one per slot, and the buffer with the view's ForwardView.
class ForwardLights
{
public:
    ForwardLights() = default; // for hosts without such shaders: wanted() is false
    // `device` must outlive it.
    ForwardLights(const gpu::Device& device, VkShaderStageFlags stages, ForwardShadows shadows,
                  uint32_t slots);
    bool wanted() const { return stages_ != 0; }
    VkDescriptorSet set(uint32_t slot) const { return sets_.set(slot); }

    struct Inputs {
        const gpu::Buffer &core, &shapes, &nodes, &ids, &directionalAlbedo;
    };
    // `shadows`: the bindings that ForwardShadows asks for.
    void write(uint32_t slot, const Inputs& inputs, std::span<const gpu::Binding> shadows) const;
    // Both do nothing unless wanted(). recordBegin makes the commands that follow wait until the
    // host's shaders have read the previous frame's lights, and writes `view`. recordEnd makes what
    // the commands before it have written visible to the host's shaders.
    void recordBegin(const gpu::Frame& frame, const gpu::ForwardView& view) const noexcept;
    void recordEnd(const gpu::Frame& frame) const noexcept;

private:
    VkShaderStageFlags stages_ = 0;
    gpu::Buffer view_;
    gpu::Bindings sets_;
};

} // namespace candelabra::lighting
