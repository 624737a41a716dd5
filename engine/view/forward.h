// SPDX-License-Identifier: Apache-2.0
// What shaders of the host's bind to find the lights of a view (shaders/lib/forward.glsl).
#pragma once

#include "gpu/kernel.h"
#include "shared/forward.h"

namespace candelabra::lighting
{

gpu::Handle<VkDescriptorSetLayout> createForwardLayout(const gpu::Device& device,
                                                       VkShaderStageFlags stages);

// The descriptor sets and constants by which the host's shaders find the lights of one view.
class ForwardLights
{
public:
    ForwardLights() = default; // none
    // `device` must outlive it.
    ForwardLights(const gpu::Device& device, VkShaderStageFlags stages, uint32_t slots);
    bool wanted() const { return stages_ != 0; }
    VkDescriptorSet set(uint32_t slot) const { return sets_.set(slot); }

    struct Inputs {
        const gpu::Buffer &core, &shapes, &nodes, &ids, &directionalAlbedo, &transformedCosines;
    };
    void write(uint32_t slot, const Inputs& inputs) const;
    // Waits for shaders that read what the commands behind write; and at the end, for what these
    // wrote. Nothing when none are wanted.
    void recordBegin(const gpu::Frame& frame, const gpu::ForwardView& view) const noexcept;
    void recordEnd(const gpu::Frame& frame) const noexcept;

private:
    VkShaderStageFlags stages_ = 0;
    gpu::Buffer view_;
    gpu::Bindings sets_;
};

} // namespace candelabra::lighting
