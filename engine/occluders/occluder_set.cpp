// SPDX-License-Identifier: Apache-2.0
#include "occluders/occluder_set.h"

#include <algorithm>
#include <cmath>
#include <string>

#include <glm/geometric.hpp>

#include "shared/lighting_data.h"

namespace candelabra::lighting
{
namespace
{

constexpr double maxOccluderCoordinate = 1e15, minColumn = 1e-15;
constexpr double minDeterminant = 1e-4; // of columns of unit length
static_assert(occluderLayerCount == gpu::OCCLUDER_LAYER_COUNT);

// Returns what is wrong with the transform of an instance; empty: nothing.
std::string whyTransformInvalid(const double (&m)[12])
{
    for (int i = 0; i < 12; ++i)
        if (!(std::abs(m[i]) <= maxOccluderCoordinate)) // also for NaN
            return "worldFromMesh[" + std::to_string(i) + "] is " + std::to_string(m[i]) +
                   ", must be finite and within 1e15";
    glm::dvec3 columns[3];
    for (int i = 0; i < 3; ++i) {
        columns[i] = {m[i], m[4 + i], m[8 + i]};
        const double length = glm::length(columns[i]);
        if (!(length >= minColumn && length <= maxOccluderCoordinate))
            return "column " + std::to_string(i) +
                   " of worldFromMesh has a length beyond 1e-15..1e15";
        columns[i] /= length;
    }
    const double determinant = glm::dot(columns[0], glm::cross(columns[1], columns[2]));
    if (std::abs(determinant) < minDeterminant)
        return "worldFromMesh is singular: the determinant of its columns, each divided by its "
               "length, is " +
               std::to_string(determinant) + ", must be beyond 1e-4 or -1e-4";
    return {};
}

// The same for everything in an instance but its mesh.
std::string whyOccluderInvalid(const OccluderInstance& instance)
{
    if (!(instance.surfaceError >= 0 && instance.surfaceError <= FLT_MAX))
        return "surfaceError is " + std::to_string(instance.surfaceError) +
               ", must be finite and >= 0";
    if (instance.occluderLayer >= occluderLayerCount)
        return "occluderLayer is " + std::to_string(instance.occluderLayer) + ", must be below 6";
    if (instance.layers & ~gpu::ALL_LAYERS)
        return "layers has bits beyond CND_LAYER_COUNT";
    return whyTransformInvalid(instance.worldFromMesh);
}

uint32_t checkedCapacity(const char* name, uint32_t capacity, uint64_t most)
{
    if (capacity > most)
        gpu::failUnsupported(std::string("CndShadowDesc: ") + name + " is " +
                             std::to_string(capacity) + ", the device can take " +
                             std::to_string(most));
    return capacity;
}

// Returns how many nodes of the tree over so many instances there may be. They share a buffer with
// those of the meshes, about one per triangle.
uint32_t checkedNodeCapacity(const gpu::Device& device, uint32_t triangles, uint32_t instances)
{
    checkedCapacity("instanceCapacity", instances, maxOccluders(device.limits));
    const uint64_t bytes =
        (uint64_t(triangles) + 2 * uint64_t(instances)) * sizeof(gpu::OccluderNode);
    if (bytes > device.limits.maxStorageBufferRange)
        gpu::failUnsupported(
            "CndShadowDesc: triangleCapacity and instanceCapacity need a buffer of " +
            std::to_string(bytes) +
            " bytes for nodes, more than the device's maxStorageBufferRange, " +
            std::to_string(device.limits.maxStorageBufferRange));
    return 2 * instances;
}

uint64_t maxMeshTriangles(const gpu::Device& device)
{
    return device.limits.maxStorageBufferRange / sizeof(gpu::OccluderTriangle);
}

} // namespace

uint32_t maxOccluders(const VkPhysicalDeviceLimits& limits)
{
    // The largest buffer with an element per instance. Two nodes per instance take less.
    return uint32_t(limits.maxStorageBufferRange / sizeof(gpu::OccluderInstance));
}

OccluderSet::OccluderSet(const gpu::Device& device, gpu::Recordings& recordings,
                         uint32_t triangleCapacity, uint32_t instanceCapacity, Prepare prepare)
    : device_(device),
      recordings_(recordings),
      prepare_(std::move(prepare)),
      meshes_(device, recordings,
              checkedCapacity("triangleCapacity", triangleCapacity, maxMeshTriangles(device)),
              checkedNodeCapacity(device, triangleCapacity, instanceCapacity)),
      instances_(device, recordings, meshes_, instanceCapacity)
{
}

void OccluderSet::addMeshes(std::span<const OccluderMesh> meshes, OccluderMeshId* ids)
{
    if (meshes.empty())
        return;
    recordings_.freeRetired();
    prepareRefit();
    meshes_.add(meshes, ids);
}

void OccluderSet::replacePositions(OccluderMeshId id, const float* positions, uint32_t stride)
{
    recordings_.freeRetired();
    prepareRefit();
    instances_.reserve(0, 0, refits()); // the boxes of its instances change
    meshes_.replacePositions(id, positions, stride);
    instances_.fit(id);
    ++number_;
}

void OccluderSet::replacePositionsOnDevice(std::span<const DevicePositions> positions)
{
    if (positions.empty())
        return;
    meshes_.check(positions);
    recordings_.freeRetired();
    const bool isFirst = !refit_;
    if (isFirst)
        refit_.emplace(device_, recordings_);
    try {
        prepareRefit(size_t(std::ranges::count_if(positions, [&](const DevicePositions& p) {
            return !meshes_[p.mesh].onDevice.buffer;
        })));
    } catch (...) {
        if (isFirst)
            refit_.reset(); // recordings would need what could not be made
        throw;
    }
    instances_.reserve(0, 0, true);
    meshes_.replacePositionsOnDevice(positions);
    ++number_;
}

void OccluderSet::removeMeshes(std::span<const OccluderMeshId> ids)
{
    if (ids.empty())
        return;
    meshes_.remove(ids);
}

void OccluderSet::check(const char* call, std::span<const OccluderInstance> instances,
                        std::span<const OccluderId> ids) const
{
    for (size_t i = 0; i < instances.size(); ++i) {
        const OccluderMeshId mesh = instances[i].mesh;
        if (!meshes_.has(mesh))
            gpu::failArgument(
                std::string(call) + ": " +
                gpu::noneHasId(gpu::elementIs("instances", i, ".mesh", mesh), "occluder mesh"));
        const std::string why = whyOccluderInvalid(instances[i]);
        if (!why.empty())
            gpu::failArgument(std::string(call) + ": instances[" + std::to_string(i) + "]" +
                              (ids.empty() ? "" : " (id " + std::to_string(ids[i]) + ")") + ": " +
                              why);
    }
}

void OccluderSet::reserve(size_t removed, size_t added)
{
    // Additions make the tree anew, without the places of removed instances.
    const uint64_t places = added ? instances_.count() + uint64_t(added) : instances_.places();
    if (places > maxOccluders(device_.limits))
        gpu::failUnsupported("cndAddOccluders: " + std::to_string(places) +
                             " occluders are more than the device can take, " +
                             std::to_string(maxOccluders(device_.limits)));
    recordings_.freeRetired();
    if (added && prepare_)
        prepare_(uint32_t(places));
    prepareRefit();
    instances_.reserve(removed, added, refits());
}

// Every edit may need it: the next recording uploads what the host knows of boxes.
void OccluderSet::prepareRefit(size_t moreMeshes)
{
    if (refit_)
        refit_->prepare(meshes_.onDevice().size() + moreMeshes);
}

void OccluderSet::add(std::span<const OccluderInstance> instances, OccluderId* ids)
{
    if (instances.empty())
        return;
    check("cndAddOccluders", instances);
    reserve(0, instances.size());
    instances_.add(instances, ids);
    ++number_;
}

void OccluderSet::update(std::span<const OccluderId> ids,
                         std::span<const OccluderInstance> instances)
{
    if (ids.empty())
        return;
    instances_.check("cndUpdateOccluders", ids);
    check("cndUpdateOccluders", instances, ids);
    reserve(0, 0);
    instances_.update(ids, instances);
    ++number_;
}

void OccluderSet::remove(std::span<const OccluderId> ids)
{
    if (ids.empty())
        return;
    instances_.check("cndRemoveOccluders", ids);
    reserve(ids.size(), 0);
    instances_.remove(ids);
    ++number_;
}

void OccluderSet::recordUpload(const gpu::Frame& frame, uint64_t recording) noexcept
{
    refitIsDue_ = refit_ && isChanged();
    instances_.recordUpload(frame, recording);
    meshes_.recordUpload(frame, recording);
}

void OccluderSet::recordRefit(const gpu::Frame& frame, uint64_t recording) noexcept
{
    if (std::exchange(refitIsDue_, false))
        refit_->record(frame, recording, meshes_, instances_);
}

} // namespace candelabra::lighting
