// SPDX-License-Identifier: Apache-2.0
#include "view/dark_proofs.h"

namespace candelabra::lighting
{

using gpu::Binding;

DarkProofs::DarkProofs(const Module& module, const Clusters& clusters, const Shadows& shadows,
                       uint32_t slots)
    : module_(module),
      clusters_(clusters),
      shadows_(shadows),
      capacity_(clusters.blockPages()),
      records_(gpu::createBuffer(
          module.device, "asked proofs",
          sizeof(gpu::WorkList) + capacity_ * VkDeviceSize(sizeof(gpu::ProofRecord)),
          VK_BUFFER_USAGE_STORAGE_BUFFER_BIT | VK_BUFFER_USAGE_INDIRECT_BUFFER_BIT |
              VK_BUFFER_USAGE_TRANSFER_DST_BIT,
          gpu::MemoryUse::Scratch)),
      askSets_(module.kernels.askProofs.createBindings(slots * CND_LIGHT_TYPE_COUNT)),
      proveSets_(module.kernels.proveDark.createBindings(slots))
{
}

void DarkProofs::writeBindings(const FramePlan& plan, const Inputs& in) const
{
    using namespace gpu;
    const uint32_t slot = plan.frame.frameSlot;
    for (uint32_t type = 0; type < CND_LIGHT_TYPE_COUNT; ++type)
        if (module_.lights.typeCounts()[type])
            askSets_.write(slot * CND_LIGHT_TYPE_COUNT + type,
                           {Binding::of(ASK_PROOFS_CLUSTERS, clusters_.clusters()),
                            Binding::of(ASK_PROOFS_LISTS, clusters_.lists(type).heads),
                            Binding::of(ASK_PROOFS_ENTRIES, clusters_.entries()),
                            Binding::of(ASK_PROOFS_RECORDS, records_)});
    const gpu::Buffer& neighbours = module_.occluders->meshes().neighbours();
    BindingList occluders;
    occluders.add(shadows_.occluderBindings(slot));
    occluders.add(shadows_.occluderTexels());
    proveSets_.write(slot,
                     {Binding::ofTexels(LIGHT_CORE_TEXELS, in.core),
                      Binding::of(LIGHT_CORE, in.core), Binding::of(PROVE_DARK_SHAPES, in.shapes),
                      in.uniforms.at(slot), Binding::of(PROVE_DARK_CLUSTERS, clusters_.clusters()),
                      Binding::of(PROVE_DARK_ENTRIES, clusters_.entries()),
                      Binding::of(PROVE_DARK_RECORDS, records_),
                      Shadows::counters(in.counters, PROVE_DARK_COUNTERS),
                      // Before there are occluders, a buffer that nothing reads stands for theirs.
                      Binding::of(PROVE_DARK_NEIGHBOURS, neighbours.get() ? neighbours : records_)},
                     occluders);
}

void DarkProofs::record(const gpu::Frame& f, const FramePlan& p) const noexcept
{
    const gpu::UntimedFrame u(f); // the kernels share one row of times
    const gpu::WorkList none{.groupsX = gpu::PROOF_ROW, .groupsY = 0, .groupsZ = 1};
    f.device.CmdUpdateBuffer(f.cmd, records_.get(), 0, sizeof none, &none);
    f.barrier();
    const auto [first, count] = clusters_.blockClusters(p.tileCount);
    for (uint32_t type = 0; type < CND_LIGHT_TYPE_COUNT; ++type)
        if (p.lights[type] && !isDistant(type))
            module_.kernels.askProofs.dispatchInRows(
                u, askSets_.set(f.slot * CND_LIGHT_TYPE_COUNT + type),
                {.firstCluster = first,
                 .clusterCount = count,
                 .capacity = capacity_,
                 .lightType = type},
                gpu::divideUp(count, gpu::ASK_PROOFS_GROUP));
    f.barrier();
    module_.kernels.proveDark.dispatchIndirect(u, proveSets_.set(f.slot), {}, records_);
    f.timer.stamp(f.cmd, module_.kernels.proveDark.name());
}

} // namespace candelabra::lighting
