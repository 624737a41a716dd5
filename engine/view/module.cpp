// SPDX-License-Identifier: Apache-2.0
#include "view/module.h"

#include "candelabra_shaders.h"

namespace candelabra::lighting
{

Kernels::Kernels(const gpu::Device& device, const surfaces::HostKernels& host,
                 const CndLightingDesc& desc, uint32_t gbuffer, bool withIds)
    : prepareLights(device, spirv::prepare_lights_comp, {{gpu::PREPARE_LIGHTS_WITH_IDS, withIds}}),
      clusters(device, host, gbuffer, tileClassesOf(desc)),
      shade(device, host, gbuffer, desc.specularMethods, tileClassesOf(desc),
            desc.influenceByError),
      influence(desc.influenceByError ? InfluenceKernels(device) : InfluenceKernels()),
      surfaceOverlay(device, host.of(spirv::surface_overlay_comp), {{gpu::SPEC_GBUFFER, gbuffer}},
                     host.setLayout())
{
}

} // namespace candelabra::lighting
