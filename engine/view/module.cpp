// SPDX-License-Identifier: Apache-2.0
#include "view/module.h"

#include "candelabra_shaders.h"
#include "gpu/image_format.h"
#include "lights/light_limits.h"

namespace candelabra::lighting
{

Kernels::Kernels(const gpu::Device& device, const surfaces::HostKernels& host,
                 const CndLightingDesc& desc, uint32_t gbuffer, bool withIds)
    : prepareLights(device, spirv::prepare_lights_comp, {{gpu::PREPARE_LIGHTS_WITH_IDS, withIds}}),
      clusters(device, host, gbuffer, findsDiffuseTiles(desc)),
      shade(device, host, gbuffer, desc),
      influence(desc.influenceByError ? InfluenceKernels(device, desc.radianceFormat)
                                      : InfluenceKernels()),
      surfaceOverlay(device,
                     gpu::FormattedSpirv(host.used(spirv::surface_overlay_comp),
                                         gpu::SURFACE_OVERLAY_IMAGE, desc.overlayFormat,
                                         gpu::StorageUse::Write),
                     {{gpu::SPEC_GBUFFER, gbuffer}}, host.setLayout())
{
    if (desc.gbuffer.depthKind != CND_DEPTH_PROJECTED)
        projectDepth = {device, spirv::project_depth_comp, {{gpu::SPEC_GBUFFER, gbuffer}}};
    if (desc.shadows.points) {
        prepareOccluders = PreparedOccluders::createKernel(device);
        polygonFacets = {device,
                         spirv::polygon_facets_comp,
                         {{gpu::SPEC_VISIBILITY_POINTS, desc.shadows.points}}};
        askProofs = {device, spirv::ask_proofs_comp};
        proveDark = {device, spirv::prove_dark_comp, {{gpu::SPEC_FOR_CPU, forCpu(device)}}};
        askPairs = {device, spirv::ask_pairs_comp};
        listOccluders = {device, spirv::list_occluders_comp, {{gpu::SPEC_FOR_CPU, forCpu(device)}}};
        for (uint32_t tileClass = 0; tileClass < shade.tileClasses(); ++tileClass)
            countShadows[tileClass] = {
                device, spirv::count_shadows_comp, {{gpu::SPEC_TILE_CLASS, tileClass}}};
    }
}

} // namespace candelabra::lighting
