// SPDX-License-Identifier: Apache-2.0
// The occluders of a module: meshes that the host gave, instances of them, and their way to the
// device.
#pragma once

#include <functional>
#include <optional>
#include <span>

#include "occluders/instance_table.h"
#include "occluders/mesh_table.h"
#include "occluders/occluder_refit.h"

namespace candelabra::lighting
{

// Returns the number of occluders in the largest set that a device with these limits can take.
uint32_t maxOccluders(const VkPhysicalDeviceLimits& limits);

class OccluderSet
{
public:
    // Prepares everything outside of the set that room for `places` records of instances needs:
    // the buffers of views. If it throws, the set stays as it was.
    using Prepare = std::function<void(uint32_t places)>;

    // Creates an empty set with room for so many triangles and instances; 0: none until they are
    // added. `device` and `recordings` must outlive the set.
    OccluderSet(const gpu::Device& device, gpu::Recordings& recordings, uint32_t triangleCapacity,
                uint32_t instanceCapacity, Prepare prepare);
    OccluderSet(const OccluderSet&) = delete; // its members point to one another
    OccluderSet& operator=(const OccluderSet&) = delete;

    // The seven calls that hosts make. Each does all that it is asked for, or throws gpu::Failure
    // and leaves the set as it was. The spans of one call have the same size.
    void addMeshes(std::span<const OccluderMesh> meshes, OccluderMeshId* ids);
    void replacePositions(OccluderMeshId id, const float* positions, uint32_t stride);
    void replacePositionsOnDevice(std::span<const DevicePositions> positions);
    void removeMeshes(std::span<const OccluderMeshId> ids);
    void add(std::span<const OccluderInstance> instances, OccluderId* ids);
    void update(std::span<const OccluderId> ids, std::span<const OccluderInstance> instances);
    void remove(std::span<const OccluderId> ids);

    // Identifies the occluders: every call that changes an instance, or replaces positions, gives
    // the set another number, from 1.
    uint64_t number() const { return number_; }
    const MeshTable& meshes() const { return meshes_; }
    const InstanceTable& instances() const { return instances_; }
    // Tells whether there are changes that no recording has uploaded yet.
    bool isChanged() const { return meshes_.isChanged() || instances_.isChanged(); }
    // Records the upload of what has changed since the last recording. The caller puts barriers
    // before and after. `recording`: number of this recording.
    void recordUpload(const gpu::Frame& frame, uint64_t recording) noexcept;
    // Tells whether a mesh has, or has had, positions on the device.
    bool refits() const { return refit_.has_value(); }
    // Fits the trees to what is on the device, if it may have changed: after recordUpload() of the
    // same recording, with barriers before and after.
    void recordRefit(const gpu::Frame& frame, uint64_t recording) noexcept;

private:
    void check(const char* call, std::span<const OccluderInstance> instances,
               std::span<const OccluderId> ids = {}) const;
    void reserve(size_t removed, size_t added);
    void prepareRefit(size_t moreMeshes = 0);

    const gpu::Device& device_;
    gpu::Recordings& recordings_;
    Prepare prepare_;
    MeshTable meshes_;
    InstanceTable instances_;
    std::optional<OccluderRefit> refit_; // from the first positions on the device on
    bool refitIsDue_ = false;
    uint64_t number_ = 0;
};

} // namespace candelabra::lighting
