// SPDX-License-Identifier: Apache-2.0
#include "occluders/occluder_refit.h"

#include "candelabra_shaders.h"
#include "gpu/double_single.h"

namespace candelabra::lighting
{
namespace
{

// Where the range of a descriptor begins that holds positions from a byte on.
VkDeviceSize rangeBegin(const gpu::Device& device, VkDeviceSize offset)
{
    return offset - offset % device.limits.minStorageBufferOffsetAlignment;
}

gpu::Binding positionsOf(const gpu::Device& device, const MeshTable::Mesh& mesh)
{
    const DevicePositions& p = mesh.onDevice;
    const VkDeviceSize begin = rangeBegin(device, p.offset), position = 3 * sizeof(float);
    const VkDeviceSize stride = p.stride ? p.stride : position;
    return {.binding = gpu::REFIT_OCCLUDERS_POSITIONS,
            .buffer = p.buffer,
            .offset = begin,
            .range = p.offset - begin + (mesh.vertexCount - 1) * stride + position};
}

} // namespace

OccluderRefit::OccluderRefit(const gpu::Device& device, gpu::Recordings& recordings)
    : device_(device), recordings_(recordings)
{
    for (uint32_t kind = 0; kind < gpu::REFIT_KINDS; ++kind)
        kernels_[kind] = {device, spirv::refit_occluders_comp, {{gpu::SPEC_REFIT, kind}}};
}

void OccluderRefit::prepare(size_t meshes)
{
    const uint32_t count = uint32_t(meshes) + 1; // the tree over instances
    if (pending_ && pending_->count >= count)
        return;
    const uint64_t inUse = recordings_.oldestPending();
    const auto isFree = [&](const Sets& s) { return s.recording < inUse; };
    auto next =
        std::ranges::find_if(sets_, [&](const Sets& s) { return isFree(s) && s.count >= count; });
    if (next == sets_.end()) {
        sets_.push_front({kernels_[0].createBindings(count), count});
        next = sets_.begin();
    }
    pending_ = &*next; // nothing before this has changed what the next recording uses
    std::erase_if(sets_, [&](const Sets& s) { return isFree(s) && s.count < count; });
}

void OccluderRefit::write(uint32_t set, const MeshTable& meshes, const InstanceTable& instances,
                          const gpu::Buffer& plans, const gpu::Binding& positions) const noexcept
{
    // Without instances nothing reads their records.
    const gpu::Buffer& records = instances.recordBuffer();
    pending_->bindings.write(
        set, {gpu::Binding::of(gpu::REFIT_OCCLUDERS_NODES, meshes.nodes()),
              gpu::Binding::of(gpu::REFIT_OCCLUDERS_TRIANGLES, meshes.triangles()),
              gpu::Binding::of(gpu::REFIT_OCCLUDERS_PLAN, plans), positions,
              gpu::Binding::of(gpu::REFIT_OCCLUDERS_RECORDS, records.get() ? records : plans)});
}

OccluderRefit::Tree OccluderRefit::treeOf(const MeshTable::Mesh& mesh, uint32_t set) const noexcept
{
    const DevicePositions& p = mesh.onDevice;
    const VkDeviceSize first = p.offset - rangeBegin(device_, p.offset);
    return {.set = set,
            .plan = mesh.plan,
            .params = {.firstNode = mesh.firstNode,
                       .plan = mesh.firstPlan,
                       .firstTriangle = mesh.firstTriangle,
                       .corners = mesh.firstPlan + mesh.plan.words,
                       .positions = uint32_t(first / sizeof(uint32_t)),
                       .stride = p.stride ? p.stride / uint32_t(sizeof(uint32_t)) : 3}};
}

void OccluderRefit::dispatchLeaves(const gpu::Frame& f, const Tree& tree,
                                   uint32_t kind) const noexcept
{
    gpu::RefitOccludersParams params = tree.params;
    params.groupCount = tree.plan.subtreeGroups;
    kernels_[kind].dispatchInRows(f, pending_->bindings.set(tree.set), params, params.groupCount);
}

void OccluderRefit::dispatchSubtrees(const gpu::Frame& f, const Tree& tree) const noexcept
{
    gpu::RefitOccludersParams params = tree.params;
    params.groupCount = tree.plan.subtreeGroups;
    params.firstRound = 1;
    kernels_[gpu::REFIT_INNER_NODES].dispatchInRows(f, pending_->bindings.set(tree.set), params,
                                                    params.groupCount);
}

void OccluderRefit::dispatchTop(const gpu::Frame& f, const Tree& tree) const noexcept
{
    gpu::RefitOccludersParams params = tree.params;
    params.firstGroup = tree.plan.subtreeGroups;
    params.groupCount = 1;
    if (tree.plan.hasTop)
        kernels_[gpu::REFIT_INNER_NODES].dispatch(f, pending_->bindings.set(tree.set), params, 1);
}

void OccluderRefit::record(const gpu::Frame& f, uint64_t recording, MeshTable& meshes,
                           const InstanceTable& instances) noexcept
{
    const gpu::UntimedFrame u(f); // the dispatches share one row of times
    uint32_t set = 0;
    const auto forEachMesh = [&](auto&& dispatch) {
        set = 0;
        for (const OccluderMeshId id : meshes.onDevice())
            if (const MeshTable::Mesh& mesh = meshes[id]; mesh.toRefit)
                dispatch(mesh, treeOf(mesh, set++));
        f.barrier();
    };
    forEachMesh([&](const MeshTable::Mesh& mesh, const Tree& tree) {
        write(tree.set, meshes, instances, meshes.plans(), positionsOf(device_, mesh));
        dispatchLeaves(u, tree, gpu::REFIT_MESH_LEAVES);
    });
    forEachMesh([&](const MeshTable::Mesh&, const Tree& tree) { dispatchSubtrees(u, tree); });
    forEachMesh([&](const MeshTable::Mesh&, const Tree& tree) { dispatchTop(u, tree); });
    for (const OccluderMeshId id : meshes.onDevice())
        meshes[id].toRefit = false;
    if (instances.plan().words) { // otherwise there are no instances
        const gpu::DoubleSingle origin(instances.origin());
        const Tree tree{.set = set,
                        .plan = instances.plan(),
                        .params = {.originHi = origin.hi,
                                   .originLo = origin.lo,
                                   .firstNode = meshes.firstInstanceNode()}};
        const gpu::Buffer& plan = instances.planBuffer();
        write(set, meshes, instances, plan,
              gpu::Binding::of(gpu::REFIT_OCCLUDERS_POSITIONS, plan)); // which nothing reads
        dispatchLeaves(u, tree, gpu::REFIT_INSTANCE_LEAVES);
        f.barrier();
        dispatchSubtrees(u, tree);
        f.barrier();
        dispatchTop(u, tree);
    }
    f.timer.stamp(f.cmd, kernels_[0].name());
    pending_->recording = recording;
    pending_ = nullptr;
}

} // namespace candelabra::lighting
