// SPDX-License-Identifier: Apache-2.0
// The instances of occluders and the tree over their boxes, and how these reach the device. An
// instance has a place. The leaves of the tree have consecutive places, so additions wait for the
// next recording, which makes the tree anew. A removed instance leaves a place that is in no layer.
#pragma once

#include <span>
#include <vector>

#include "gpu/id_table.h"
#include "gpu/uploaded_buffer.h"
#include "occluders/mesh_table.h"
#include "occluders/occluder_input.h"
#include "occluders/occluder_tree.h"

namespace candelabra::lighting
{

class InstanceTable
{
public:
    // `capacity`: instances for which to make room. `device`, `recordings` and `meshes` must
    // outlive the table.
    InstanceTable(const gpu::Device& device, gpu::Recordings& recordings, MeshTable& meshes,
                  uint32_t capacity);

    // Throws gpu::Failure naming `call` and an id that no instance has, or that is given twice.
    void check(const char* call, std::span<const OccluderId> ids)
    {
        ids_.check(call, "occluder", ids);
    }
    // Does everything in an edit that can fail. `fitted`: from the next recording on the device
    // fits the tree (refit_occluders).
    void reserve(size_t removed, size_t added, bool fitted);
    void add(std::span<const OccluderInstance> instances, OccluderId* ids) noexcept;
    void update(std::span<const OccluderId> ids,
                std::span<const OccluderInstance> instances) noexcept;
    void remove(std::span<const OccluderId> ids) noexcept;
    // Fits the tree to the instances of a mesh whose positions have been replaced.
    void fit(OccluderMeshId mesh) noexcept;

    uint32_t count() const { return places() - removed_; }
    // How many records there are, those of removed instances included.
    uint32_t places() const { return uint32_t(records_.size()); }
    // The layers of all instances, and perhaps of some that have been replaced or removed.
    uint32_t layers() const { return count() ? layers_ : 0; }

    bool isChanged() const
    {
        return !treeIsMade_ || recordBuffer_.isChanged() || (isFitted_ && !planIsMade_);
    }
    // Makes the tree anew if it needs that, and records the upload of what has changed but for the
    // nodes, which MeshTable keeps and uploads.
    void recordUpload(const gpu::Frame& frame, uint64_t recording) noexcept;

    // The following hold after recordUpload().
    const glm::dvec3& origin() const { return origin_; } // of the tree, in the world
    std::span<const gpu::OccluderNode> nodes() const
    {
        const std::span all = meshes_.instanceNodes();
        return all.first(places() ? all[0].skip : 0);
    }
    std::span<const gpu::OccluderRecord> records() const { return records_; }
    const gpu::Buffer& recordBuffer() const { return recordBuffer_.buffer(); }
    // The plan of the tree, if the device fits it.
    const RefitPlan& plan() const { return plan_; }
    const gpu::Buffer& planBuffer() const { return planBuffer_.buffer(); }

private:
    struct Placed {
        uint32_t slot; // none: removed
        OccluderMeshId mesh;
        glm::dvec3 low{0}, high{0}; // its box in the world
    };
    void write(uint32_t place, const OccluderInstance& instance) noexcept;
    void setBox(uint32_t place) noexcept;
    Box boxAt(uint32_t place) const noexcept;
    void fitAncestors(uint32_t place) noexcept;
    void remove(uint32_t slot) noexcept;
    void dropTree() noexcept;
    void moveTo(uint32_t place, uint32_t from) noexcept;
    void makeTree() noexcept;
    void chooseOrigin() noexcept;
    void sortByTree() noexcept;
    void findParents() noexcept;
    void makePlan() noexcept;

    MeshTable& meshes_;
    gpu::IdTable ids_;
    std::vector<Placed> placed_;               // by place
    std::vector<gpu::OccluderRecord> records_; // by place, as the device has them after an upload
    uint32_t removed_ = 0;                     // places without an instance
    uint32_t layers_ = 0;

    bool treeIsMade_ = true; // otherwise no place is without an instance
    glm::dvec3 origin_{0};
    std::vector<uint32_t> parents_;           // by node; the root's is itself
    std::vector<uint32_t> leaves_;            // by place
    double surface_ = 0, surfaceAtFirst_ = 0; // of all nodes, now and when the tree was made

    bool isFitted_ = false;   // by the device
    bool planIsMade_ = false; // for the present tree
    RefitPlan plan_;
    std::vector<uint32_t> planWords_;
    std::vector<uint8_t> heights_;

    // Memory for makeTree().
    std::vector<TreeItem> items_;
    std::vector<Placed> sortedPlaced_;
    std::vector<gpu::OccluderRecord> sortedRecords_;
    std::vector<double> coordinates_;

    gpu::UploadedBuffer recordBuffer_, planBuffer_;
};

} // namespace candelabra::lighting
