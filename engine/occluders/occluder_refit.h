// SPDX-License-Identifier: Apache-2.0
// Fits the trees of occluders on the device to positions that are written there.
#pragma once

#include <array>
#include <list>

#include "occluders/instance_table.h"
#include "occluders/mesh_table.h"
#include "shared/refit_occluders.h"

namespace candelabra::lighting
{

class OccluderRefit
{
public:
    // Both must outlive it.
    OccluderRefit(const gpu::Device& device, gpu::Recordings& recordings);
    OccluderRefit(const OccluderRefit&) = delete; // pending_ points into it
    OccluderRefit& operator=(const OccluderRefit&) = delete;

    // Does everything for the next recording that can fail, if `meshes` meshes have positions on
    // the device.
    void prepare(size_t meshes);
    // Fits the trees of the meshes whose toRefit is set, which is cleared, and then the tree over
    // instances, after the upload of what has changed. `recording`: number of this recording. The
    // caller puts barriers before and after.
    void record(const gpu::Frame& frame, uint64_t recording, MeshTable& meshes,
                const InstanceTable& instances) noexcept;

private:
    struct Sets {
        gpu::Bindings bindings;
        uint32_t count;         // a set per tree
        uint64_t recording = 0; // number of the recording that uses them; 0: none yet
    };
    struct Tree {
        uint32_t set;
        RefitPlan plan;
        gpu::RefitOccludersParams params;
    };
    Tree treeOf(const MeshTable::Mesh& mesh, uint32_t set) const noexcept;
    void write(uint32_t set, const MeshTable& meshes, const InstanceTable& instances,
               const gpu::Buffer& plans, const gpu::Binding& positions) const noexcept;
    void dispatchLeaves(const gpu::Frame& frame, const Tree& tree, uint32_t kind) const noexcept;
    void dispatchSubtrees(const gpu::Frame& frame, const Tree& tree) const noexcept;
    void dispatchTop(const gpu::Frame& frame, const Tree& tree) const noexcept;

    const gpu::Device& device_;
    gpu::Recordings& recordings_;
    std::array<gpu::Kernel<gpu::RefitOccludersParams>, gpu::REFIT_KINDS> kernels_; // by kind
    std::list<Sets> sets_;    // a list does not move its elements
    Sets* pending_ = nullptr; // for the next recording
};

} // namespace candelabra::lighting
