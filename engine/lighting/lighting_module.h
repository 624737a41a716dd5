// SPDX-License-Identifier: Apache-2.0
// Lighting: owns what all views of a lighting module share, and knows the views.
#pragma once

#include "view/view.h"

namespace candelabra::lighting
{

class Lighting
{
public:
    Lighting(const CndDeviceDesc& device, const CndLightingDesc& desc);
    Lighting(const Lighting&) = delete; // its members point to one another
    Lighting& operator=(const Lighting&) = delete;

    const gpu::Device& device() const { return device_; }
    LightSet& lights() { return lights_; }
    // Throws gpu::Failure without CndLightingDesc::shadows. `call`: for the message.
    OccluderSet& occluders(const char* call);
    // May be called while another thread uses the module.
    void addPipelines(const CndLightingPipelines& added);
    VkDescriptorSetLayout forwardLayout() const; // throws gpu::Failure when there is none

    // The parts of the module that views need. They must outlive the views.
    const Module& module() const { return module_; }
    // The buffers of the views added here grow with the light set.
    void add(View* view) { views_.push_back(view); }
    void remove(View* view) { std::erase(views_, view); }

private:
    void prepare(uint32_t lightCapacity, const LightTypeCounts& types);

    gpu::Device device_;
    CndLightingDesc desc_;
    surfaces::GBufferSource gbuffer_;
    surfaces::HostKernels hostKernels_;
    Kernels kernels_;
    tables::DfgTable albedoTable_;
    gpu::Handle<VkDescriptorSetLayout> forwardLayout_;
    gpu::Recordings recordings_;
    LightSet lights_;
    std::optional<OccluderSet> occluders_;
    std::vector<View*> views_;
    Module module_;
};

} // namespace candelabra::lighting

// What the handles of the C ABI point to.
struct CndLighting_T {
    candelabra::lighting::Lighting impl;
};
