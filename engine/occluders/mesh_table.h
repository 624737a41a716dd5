// SPDX-License-Identifier: Apache-2.0
// The meshes of occluders: their triangles in the order of their trees, and how these reach the
// device. The nodes of the tree over instances are in the same buffer as theirs.
#pragma once

#include <span>
#include <vector>

#include "gpu/id_table.h"
#include "gpu/uploaded_buffer.h"
#include "occluders/free_ranges.h"
#include "occluders/neighbours.h"
#include "occluders/occluder_input.h"
#include "occluders/occluder_tree.h"
#include "occluders/refit_plan.h"

namespace candelabra::lighting
{

class MeshTable
{
public:
    struct Mesh {
        uint32_t firstNode, nodeCount;
        uint32_t firstTriangle, triangleCount;
        uint32_t vertexCount;
        uint32_t users; // instances
        // The vertices of each triangle, in the order of the tree: positions may be replaced.
        std::vector<glm::uvec3> corners;
        Neighbours neighbours; // of the triangles when the mesh was added
        // Positions on the device; without a buffer those of the host are in use.
        DevicePositions onDevice;
        // The range of plans() that then holds the plan of its tree, and after it its corners.
        uint32_t firstPlan;
        RefitPlan plan;
        bool toRefit; // the boxes on the device have to be fitted

        uint32_t planWords() const { return plan.words + 3 * triangleCount; }
    };

    // `capacity`: triangles for which to make room. `instanceNodeCapacity`: the same for the nodes
    // of the tree over instances. `device` and `recordings` must outlive the table.
    MeshTable(const gpu::Device& device, gpu::Recordings& recordings, uint32_t capacity,
              uint32_t instanceNodeCapacity);

    // Each call does all that it is asked for, or throws gpu::Failure and leaves the table as it
    // was.
    void add(std::span<const OccluderMesh> meshes, OccluderMeshId* ids);
    // `positions`: as OccluderMesh::positions, as many as the mesh has. Also prepares the upload of
    // the tree over instances.
    void replacePositions(OccluderMeshId id, const float* positions, uint32_t stride);
    // Throws gpu::Failure if one of these is out of range.
    void check(std::span<const DevicePositions> positions);
    // `positions`: checked.
    void replacePositionsOnDevice(std::span<const DevicePositions> positions);
    void remove(std::span<const OccluderMeshId> ids);

    // Makes room for so many nodes of the tree over instances, and for their upload. If it has to
    // move them, all of them are to be written anew. Throws gpu::Failure and then leaves everything
    // as it was.
    void reserveInstanceNodes(uint32_t count);
    // The nodes for which there is room, until the next call that makes room.
    std::span<gpu::OccluderNode> instanceNodes()
    {
        return std::span(nodes_.contents).subspan(instanceNodes_.first, instanceNodes_.used);
    }
    // The next upload takes so many of them, or all, which are written before.
    void markInstanceNodes(uint32_t first, uint32_t count) noexcept
    {
        nodes_.changed(instanceNodes_.first + first, count);
    }
    void markInstanceNodes() noexcept { markInstanceNodes(0, instanceNodes_.used); }
    uint32_t firstInstanceNode() const { return instanceNodes_.first; }

    bool has(OccluderMeshId id) const { return ids_.has(id); }
    Mesh& operator[](OccluderMeshId id) { return meshes_[gpu::IdTable::slotOf(id)]; }
    const Mesh& operator[](OccluderMeshId id) const { return meshes_[gpu::IdTable::slotOf(id)]; }
    std::span<const gpu::OccluderNode> nodesOf(const Mesh& mesh) const
    {
        return std::span(nodes_.contents).subspan(mesh.firstNode, mesh.nodeCount);
    }
    // What uploads bring to the device. refit_occluders then replaces some of it.
    std::span<const gpu::OccluderNode> allNodes() const { return nodes_.contents; }
    std::span<const gpu::OccluderTriangle> allTriangles() const { return triangles_.contents; }
    std::span<const gpu::OccluderNeighbours> allNeighbours() const { return neighbours_.contents; }

    // The meshes with positions on the device.
    std::span<const OccluderMeshId> onDevice() const { return onDevice_; }

    bool isChanged() const;
    // Afterwards the trees of meshes whose toRefit is set have to be fitted.
    void recordUpload(const gpu::Frame& frame, uint64_t recording) noexcept;
    const gpu::Buffer& nodes() const { return nodes_.buffer.buffer(); }
    const gpu::Buffer& triangles() const { return triangles_.buffer.buffer(); }
    const gpu::Buffer& neighbours() const { return neighbours_.buffer.buffer(); }
    const gpu::Buffer& plans() const { return plans_.buffer.buffer(); } // words

private:
    // An array in which each mesh has a range.
    template <typename T>
    struct Pool {
        std::vector<T> contents{};
        gpu::UploadedBuffer buffer;

        // Makes room for `end` elements. `changed` of them will be written, in `count` ranges.
        void reserve(size_t end, VkDeviceSize changed, size_t count);
        void write(uint32_t first, std::span<const T> elements) noexcept;
        void changed(uint32_t first, size_t count) noexcept;
        bool isChanged(uint32_t first, size_t count) const
        {
            return buffer.isChanged(first * sizeof(T), count * sizeof(T));
        }
    };
    struct Built;
    struct Planned;
    static Built build(const OccluderMesh& mesh);
    Planned planFor(const DevicePositions& positions) const;
    void reservePlans(std::span<const Planned> planned);
    void leaveDevice(OccluderMeshId id) noexcept;
    void makeRoom(std::span<const Built> built);
    void giveBack(const Mesh& mesh) noexcept;

    const gpu::Device& device_;
    uint32_t instanceNodeCapacity_;
    // The range of the tree over instances, and how many of its nodes may be in use.
    struct {
        uint32_t first = 0, room = 0, used = 0;
    } instanceNodes_;
    gpu::IdTable ids_;
    std::vector<Mesh> meshes_; // indexed by slot
    std::vector<OccluderMeshId> onDevice_;
    FreeRanges nodeRanges_, triangleRanges_, planRanges_;
    Pool<gpu::OccluderNode> nodes_;
    Pool<gpu::OccluderTriangle> triangles_;
    Pool<gpu::OccluderNeighbours> neighbours_; // as triangles_
    Pool<uint32_t> plans_;
};

} // namespace candelabra::lighting
