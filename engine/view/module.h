// SPDX-License-Identifier: Apache-2.0
// All views of a lighting module share this: its pipelines, its lights, its table, and the
// description that it was created with. Lighting owns all of this and passes it to each view.
#pragma once

#include "gpu/recordings.h"
#include "lights/light_set.h"
#include "occluders/occluder_set.h"
#include "occluders/prepared_occluders.h"
#include "shading/influence.h"
#include "shading/shade_kernels.h"
#include "shared/project_depth.h"
#include "shared/surface_overlay.h"
#include "surfaces/host_gbuffer.h"
#include "surfaces/host_kernels.h"
#include "tables/dfg_table.h"

namespace candelabra::lighting
{

struct Kernels {
    // `gbuffer`: value of SPEC_GBUFFER. `withIds`: prepare_lights writes the ids of lights.
    // `device` and `host` must outlive this object.
    Kernels(const gpu::Device& device, const surfaces::HostKernels& host,
            const CndLightingDesc& desc, uint32_t gbuffer, bool withIds);
    gpu::Kernel<gpu::PrepareLightsParams> prepareLights;
    ClusterKernels clusters;
    ShadeKernels shade;
    InfluenceKernels influence; // empty without CndLightingDesc::influenceByError
    gpu::Kernel<gpu::SurfaceOverlayParams> surfaceOverlay;
    gpu::Kernel<gpu::ProjectDepthParams> projectDepth; // empty if hosts' depth is projected
    // Empty without CndLightingDesc::shadows.
    PreparedOccluders::Kernel prepareOccluders;
    gpu::Kernel<gpu::PolygonFacetsParams> polygonFacets;
    gpu::Kernel<gpu::AskProofsParams> askProofs;
    gpu::Kernel<gpu::NoParams> proveDark;
    gpu::Kernel<gpu::AskPairsParams> askPairs;
    gpu::Kernel<gpu::ListOccludersParams> listOccluders;
    gpu::Kernel<gpu::CountShadowsParams> countShadows[gpu::TILE_CLASSES];
};

struct Module {
    const gpu::Device& device;
    const CndLightingDesc& desc;
    gpu::Recordings& recordings;
    surfaces::GBufferSource& gbuffer;
    const surfaces::HostKernels& hostKernels;
    const Kernels& kernels;
    tables::DfgTable& albedoTable;
    LightSet& lights;
    OccluderSet* occluders; // null without CndLightingDesc::shadows
};

// Tells whether ids of lights are needed on the device: forward shaders of the host and functions
// of the host in our kernels may read them.
inline bool readsLightIds(const CndLightingDesc& desc)
{
    return desc.forwardStages || desc.hostKernels.count;
}

} // namespace candelabra::lighting
