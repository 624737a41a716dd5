// SPDX-License-Identifier: Apache-2.0
#include "occluders/mesh_table.h"

#include <algorithm>
#include <cmath>
#include <cstring>
#include <string>

#include "shared/refit_occluders.h"

namespace candelabra::lighting
{
namespace
{

constexpr const char* addCall = "cndAddOccluderMeshes";
constexpr const char* deviceCall = "cndReplaceOccluderPositionsOnDevice";
constexpr uint32_t positionBytes = 3 * sizeof(float);
constexpr uint32_t maxTriangles = 1u << 28; // of a mesh: leaves hold the first one's index

// The positions of a mesh in the host's memory.
class Positions
{
public:
    Positions(const float* first, uint32_t stride, uint32_t count)
        : first_(first), stride_((stride ? stride : positionBytes) / sizeof(float)), count_(count)
    {
    }
    // -0 becomes +0, so that equal positions have equal bits.
    glm::vec3 operator[](uint32_t i) const
    {
        const float* const p = first_ + size_t(i) * stride_;
        return glm::vec3(p[0], p[1], p[2]) + 0.0f;
    }
    gpu::OccluderTriangle triangle(const glm::uvec3& corners) const
    {
        return {{(*this)[corners.x], (*this)[corners.y], (*this)[corners.z]}};
    }
    // `name` is that of the first position, such as "meshes[3]: positions".
    void check(const std::string& name) const
    {
        for (uint32_t i = 0; i < count_; ++i) {
            const float* const p = first_ + size_t(i) * stride_;
            for (int axis = 0; axis < 3; ++axis)
                if (!(std::abs(p[axis]) <= gpu::MAX_OCCLUDER_COORDINATE)) // also for NaN
                    gpu::failArgument(name + "[" + std::to_string(i) + "][" + std::to_string(axis) +
                                      "] is " + std::to_string(p[axis]) +
                                      ", must be finite and within 1e15");
        }
    }

private:
    const float* first_;
    size_t stride_; // floats
    uint32_t count_;
};

void checkStride(const std::string& name, uint32_t stride)
{
    if (stride && (stride < positionBytes || stride % sizeof(float)))
        gpu::failArgument(name + "stride is " + std::to_string(stride) +
                          ", must be 0 or a multiple of 4 that is at least 12");
}

void checkMesh(const OccluderMesh& mesh, size_t index)
{
    const std::string name = std::string(addCall) + ": meshes[" + std::to_string(index) + "]: ";
    if (!mesh.positions)
        gpu::failArgument(name + "positions is null");
    checkStride(name, mesh.stride);
    if (mesh.triangleCount < 1 || mesh.triangleCount > maxTriangles)
        gpu::failArgument(name + "triangleCount is " + std::to_string(mesh.triangleCount) +
                          ", must be 1..2^28");
    const uint32_t corners = 3 * mesh.triangleCount;
    if (!mesh.indices && mesh.vertexCount != corners)
        gpu::failArgument(name + "vertexCount is " + std::to_string(mesh.vertexCount) +
                          ", must be 3 triangleCount = " + std::to_string(corners) +
                          " without indices");
    for (uint32_t i = 0; mesh.indices && i < corners; ++i)
        if (mesh.indices[i] >= mesh.vertexCount)
            gpu::failArgument(name + "indices[" + std::to_string(i) + "] is " +
                              std::to_string(mesh.indices[i]) + ", must be below vertexCount, " +
                              std::to_string(mesh.vertexCount));
    Positions(mesh.positions, mesh.stride, mesh.vertexCount).check(name + "positions");
}

void requireRange(const char* call, const gpu::Device& device, uint64_t count,
                  uint64_t elementBytes)
{
    if (const uint64_t room = device.limits.maxStorageBufferRange; count * elementBytes > room)
        gpu::failUnsupported(std::string(call) + ": the occluders need a buffer of " +
                             std::to_string(count * elementBytes) +
                             " bytes, more than the device's maxStorageBufferRange, " +
                             std::to_string(room));
}

Box boxOf(const gpu::OccluderTriangle& triangle)
{
    Box box;
    for (const glm::vec3& corner : triangle.corners)
        box.add(corner);
    return box;
}

} // namespace

// A mesh that is not in the table yet.
struct MeshTable::Built {
    std::vector<gpu::OccluderNode> nodes;
    std::vector<gpu::OccluderTriangle> triangles;
    Mesh mesh;
};

MeshTable::Built MeshTable::build(const OccluderMesh& mesh)
{
    const Positions positions(mesh.positions, mesh.stride, mesh.vertexCount);
    const auto cornersOf = [&](uint32_t triangle) {
        const uint32_t first = 3 * triangle;
        const uint32_t* const i = mesh.indices ? mesh.indices + first : nullptr;
        return i ? glm::uvec3(i[0], i[1], i[2]) : glm::uvec3(first, first + 1, first + 2);
    };
    std::vector<TreeItem> items(mesh.triangleCount);
    for (uint32_t i = 0; i < mesh.triangleCount; ++i)
        items[i] = {boxOf(positions.triangle(cornersOf(i))), i};
    Built out;
    out.nodes.resize(2 * items.size() - 1);
    out.nodes.resize(buildTree(items, gpu::OCCLUDER_LEAF_TRIANGLES, out.nodes));
    out.triangles.reserve(items.size());
    out.mesh.corners.reserve(items.size());
    for (const TreeItem& item : items) {
        out.mesh.corners.push_back(cornersOf(item.index));
        out.triangles.push_back(positions.triangle(out.mesh.corners.back()));
    }
    out.mesh.neighbours = findNeighbours(out.triangles);
    out.mesh.nodeCount = uint32_t(out.nodes.size());
    out.mesh.triangleCount = mesh.triangleCount;
    out.mesh.vertexCount = mesh.vertexCount;
    out.mesh.users = 0;
    out.mesh.onDevice = {};
    out.mesh.toRefit = false;
    return out;
}

template <typename T>
void MeshTable::Pool<T>::reserve(size_t end, VkDeviceSize changed, size_t count)
{
    end = std::max(end, contents.size());
    gpu::reserveMore(contents, end - contents.size());
    buffer.reserve(end * sizeof(T), changed * sizeof(T), count);
}

template <typename T>
void MeshTable::Pool<T>::write(uint32_t first, std::span<const T> elements) noexcept
{
    contents.resize(std::max<size_t>(contents.size(), first + elements.size()));
    std::ranges::copy(elements, contents.begin() + first);
    changed(first, elements.size());
}

template <typename T>
void MeshTable::Pool<T>::changed(uint32_t first, size_t count) noexcept
{
    buffer.markChanged(VkDeviceSize(first) * sizeof(T), count * sizeof(T));
}

MeshTable::MeshTable(const gpu::Device& device, gpu::Recordings& recordings, uint32_t capacity,
                     uint32_t instanceNodeCapacity)
    : device_(device),
      instanceNodeCapacity_(instanceNodeCapacity),
      nodes_{.buffer = {device, recordings, "occluder nodes",
                        (VkDeviceSize(capacity) + instanceNodeCapacity) * sizeof(gpu::OccluderNode),
                        true}},
      triangles_{.buffer = {device, recordings, "occluder triangles",
                            capacity * VkDeviceSize(sizeof(gpu::OccluderTriangle)), true}},
      neighbours_{.buffer = {device, recordings, "occluder neighbours",
                             capacity * VkDeviceSize(sizeof(gpu::OccluderNeighbours))}},
      plans_{.buffer = {device, recordings, "occluder plans", 0}}
{
}

void MeshTable::giveBack(const Mesh& mesh) noexcept
{
    nodeRanges_.give(mesh.firstNode, mesh.nodeCount);
    triangleRanges_.give(mesh.firstTriangle, mesh.triangleCount);
}

// Does everything in an addition that can fail, after the ranges have been taken.
void MeshTable::makeRoom(std::span<const Built> built)
{
    requireRange(addCall, device_, nodeRanges_.end(), sizeof(gpu::OccluderNode));
    requireRange(addCall, device_, triangleRanges_.end(), sizeof(gpu::OccluderTriangle));
    VkDeviceSize nodes = 0, triangles = 0;
    for (const Built& b : built) {
        nodes += b.nodes.size();
        triangles += b.triangles.size();
    }
    nodes_.reserve(nodeRanges_.end(), nodes, built.size());
    triangles_.reserve(triangleRanges_.end(), triangles, built.size());
    neighbours_.reserve(triangleRanges_.end(), triangles, built.size());
}

void MeshTable::add(std::span<const OccluderMesh> meshes, OccluderMeshId* ids)
{
    uint64_t triangles = 0;
    for (size_t i = 0; i < meshes.size(); ++i) {
        checkMesh(meshes[i], i);
        triangles += meshes[i].triangleCount;
    }
    requireRange(addCall, device_, triangles, sizeof(gpu::OccluderTriangle));
    std::vector<Built> built;
    for (const OccluderMesh& mesh : meshes)
        built.push_back(build(mesh));
    ids_.reserve(0, built.size());
    gpu::reserveMore(meshes_, built.size());
    nodeRanges_.reserve(built.size());
    triangleRanges_.reserve(built.size());
    for (Built& b : built) {
        b.mesh.firstNode = nodeRanges_.take(b.mesh.nodeCount);
        b.mesh.firstTriangle = triangleRanges_.take(b.mesh.triangleCount);
    }
    try {
        makeRoom(built);
    } catch (...) {
        for (const Built& b : built)
            giveBack(b.mesh);
        throw;
    }
    for (size_t i = 0; i < built.size(); ++i) { // nothing after this can fail
        Built& b = built[i];
        nodes_.write(b.mesh.firstNode, b.nodes);
        triangles_.write(b.mesh.firstTriangle, b.triangles);
        neighbours_.write(b.mesh.firstTriangle, b.mesh.neighbours);
        ids[i] = ids_.add(0);
        const uint32_t slot = gpu::IdTable::slotOf(ids[i]);
        if (slot == meshes_.size())
            meshes_.emplace_back();
        meshes_[slot] = std::move(b.mesh);
    }
}

void MeshTable::reserveInstanceNodes(uint32_t count)
{
    const auto [first, present, used] = instanceNodes_;
    if (count <= present) {
        nodes_.reserve(nodeRanges_.end(), count, 1);
        instanceNodes_.used = count;
        return;
    }
    nodeRanges_.reserve(1);
    const uint64_t most = device_.limits.maxStorageBufferRange / sizeof(gpu::OccluderNode);
    uint32_t room = std::max({count, present + present / 2, instanceNodeCapacity_});
    if (uint64_t(nodeRanges_.end()) + room > most)
        room = count;
    const uint32_t moved = nodeRanges_.take(room);
    try {
        requireRange("cndAddOccluders", device_, nodeRanges_.end(), sizeof(gpu::OccluderNode));
        nodes_.reserve(nodeRanges_.end(), count, 1);
        nodes_.contents.resize(std::max<size_t>(nodes_.contents.size(), moved + room));
    } catch (...) {
        nodeRanges_.give(moved, room);
        throw;
    }
    if (present)
        nodeRanges_.give(first, present);
    instanceNodes_ = {moved, room, count};
    markInstanceNodes();
}

void MeshTable::replacePositions(OccluderMeshId id, const float* positions, uint32_t stride)
{
    const char* const call = "cndReplaceOccluderPositions";
    if (!has(id))
        gpu::failArgument(std::string(call) + ": " +
                          gpu::noneHasId("mesh is " + std::to_string(id), "occluder mesh"));
    checkStride(std::string(call) + ": ", stride);
    Mesh& mesh = (*this)[id];
    const Positions from(positions, stride, mesh.vertexCount);
    from.check(std::string(call) + ": positions");
    nodes_.reserve(nodeRanges_.end(), VkDeviceSize(mesh.nodeCount) + instanceNodes_.used, 2);
    triangles_.reserve(triangleRanges_.end(), mesh.triangleCount, 1);
    neighbours_.reserve(triangleRanges_.end(), mesh.triangleCount, 1);
    leaveDevice(id); // nothing after this can fail
    const std::span triangles =
        std::span(triangles_.contents).subspan(mesh.firstTriangle, mesh.triangleCount);
    for (uint32_t i = 0; i < mesh.triangleCount; ++i)
        triangles[i] = from.triangle(mesh.corners[i]);
    copyNeighboursThatMeet(
        triangles, mesh.neighbours,
        std::span(neighbours_.contents).subspan(mesh.firstTriangle, mesh.triangleCount));
    const std::span nodes = std::span(nodes_.contents).subspan(mesh.firstNode, mesh.nodeCount);
    fitTree(nodes, [&](uint32_t i) { return boxOf(triangles[i]); });
    nodes_.changed(mesh.firstNode, mesh.nodeCount);
    triangles_.changed(mesh.firstTriangle, mesh.triangleCount);
    neighbours_.changed(mesh.firstTriangle, mesh.triangleCount);
}

void MeshTable::check(std::span<const DevicePositions> positions)
{
    std::vector<OccluderMeshId> ids;
    for (const DevicePositions& p : positions)
        ids.push_back(p.mesh);
    ids_.check(deviceCall, "occluder mesh", ids, "positions", ".mesh");
    const uint64_t room = device_.limits.maxStorageBufferRange;
    for (size_t i = 0; i < positions.size(); ++i) {
        const DevicePositions& p = positions[i];
        const std::string name =
            std::string(deviceCall) + ": positions[" + std::to_string(i) + "]: ";
        if (!p.buffer)
            gpu::failArgument(name + "buffer is null");
        if (p.offset % sizeof(uint32_t))
            gpu::failArgument(name + "offset is " + std::to_string(p.offset) +
                              ", must be a multiple of 4");
        checkStride(name, p.stride);
        const uint64_t stride = p.stride ? p.stride : positionBytes;
        const uint64_t bytes = ((*this)[p.mesh].vertexCount - 1) * stride + positionBytes;
        // The range of a descriptor may have to begin before the first position.
        if (bytes + device_.limits.minStorageBufferOffsetAlignment > room)
            gpu::failUnsupported(name + "they take " + std::to_string(bytes) +
                                 " bytes, too many for the device's maxStorageBufferRange, " +
                                 std::to_string(room));
    }
}

// The plan of a mesh whose positions are not on the device yet, before it has a range.
struct MeshTable::Planned {
    OccluderMeshId id;
    std::vector<uint32_t> words; // with the corners
    RefitPlan plan;
    uint32_t first = 0;
};

MeshTable::Planned MeshTable::planFor(const DevicePositions& positions) const
{
    const Mesh& mesh = (*this)[positions.mesh];
    Planned out{.id = positions.mesh};
    out.words.resize(maxRefitPlanWords(mesh.nodeCount));
    std::vector<uint8_t> heights(mesh.nodeCount);
    out.plan = writeRefitPlan(nodesOf(mesh), heights, out.words);
    out.words.resize(out.plan.words);
    for (const glm::uvec3& corners : mesh.corners)
        out.words.insert(out.words.end(), {corners.x, corners.y, corners.z});
    return out;
}

// Does everything for these plans that can fail, after their ranges have been taken.
void MeshTable::reservePlans(std::span<const Planned> planned)
{
    requireRange(deviceCall, device_, planRanges_.end(), sizeof(uint32_t));
    VkDeviceSize words = 0, triangles = 0;
    for (const Planned& p : planned) {
        words += p.words.size();
        triangles += (*this)[p.id].triangleCount;
    }
    plans_.reserve(planRanges_.end(), words, planned.size());
    neighbours_.reserve(triangleRanges_.end(), triangles, planned.size());
}

void MeshTable::replacePositionsOnDevice(std::span<const DevicePositions> positions)
{
    std::vector<Planned> planned;
    for (const DevicePositions& p : positions)
        if (!(*this)[p.mesh].onDevice.buffer)
            planned.push_back(planFor(p));
    gpu::reserveMore(onDevice_, planned.size());
    planRanges_.reserve(planned.size());
    for (Planned& p : planned)
        p.first = planRanges_.take(uint32_t(p.words.size()));
    try {
        reservePlans(planned);
    } catch (...) {
        for (const Planned& p : planned)
            planRanges_.give(p.first, uint32_t(p.words.size()));
        throw;
    }
    for (const Planned& p : planned) { // nothing after this can fail
        Mesh& mesh = (*this)[p.id];
        mesh.firstPlan = p.first;
        mesh.plan = p.plan;
        plans_.write(p.first, p.words);
        onDevice_.push_back(p.id);
        copyNeighboursOfVertices(
            mesh.corners, mesh.neighbours,
            std::span(neighbours_.contents).subspan(mesh.firstTriangle, mesh.triangleCount));
        neighbours_.changed(mesh.firstTriangle, mesh.triangleCount);
    }
    for (const DevicePositions& p : positions) {
        (*this)[p.mesh].onDevice = p;
        (*this)[p.mesh].toRefit = true;
    }
}

// Forgets the mesh's positions on the device, if it has any.
void MeshTable::leaveDevice(OccluderMeshId id) noexcept
{
    Mesh& mesh = (*this)[id];
    if (!mesh.onDevice.buffer)
        return;
    planRanges_.give(mesh.firstPlan, mesh.planWords());
    std::erase(onDevice_, id);
    mesh.onDevice = {};
    mesh.toRefit = false;
}

void MeshTable::remove(std::span<const OccluderMeshId> ids)
{
    ids_.check("cndRemoveOccluderMeshes", "occluder mesh", ids);
    for (size_t i = 0; i < ids.size(); ++i)
        if (const uint32_t users = (*this)[ids[i]].users)
            gpu::failArgument("cndRemoveOccluderMeshes: " + gpu::elementIs("ids", i, "", ids[i]) +
                              ", a mesh that has " + std::to_string(users) +
                              (users == 1 ? " occluder" : " occluders"));
    ids_.reserve(ids.size(), 0);
    for (const OccluderMeshId id : ids) {
        leaveDevice(id);
        giveBack((*this)[id]);
        (*this)[id] = {};
        ids_.remove(gpu::IdTable::slotOf(id));
    }
}

bool MeshTable::isChanged() const
{
    return nodes_.buffer.isChanged() || triangles_.buffer.isChanged() ||
           std::ranges::any_of(onDevice_, [&](OccluderMeshId id) { return (*this)[id].toRefit; });
}

void MeshTable::recordUpload(const gpu::Frame& frame, uint64_t recording) noexcept
{
    // An upload of blocks in which a mesh has a part brings back what the host knows of it.
    for (const OccluderMeshId id : onDevice_) {
        Mesh& mesh = (*this)[id];
        mesh.toRefit = mesh.toRefit || nodes_.isChanged(mesh.firstNode, mesh.nodeCount) ||
                       triangles_.isChanged(mesh.firstTriangle, mesh.triangleCount);
    }
    plans_.buffer.recordUpload(frame, recording, std::as_bytes(std::span(plans_.contents)));
    nodes_.buffer.recordUpload(frame, recording, std::as_bytes(std::span(nodes_.contents)));
    triangles_.buffer.recordUpload(frame, recording, std::as_bytes(std::span(triangles_.contents)));
    neighbours_.buffer.recordUpload(frame, recording,
                                    std::as_bytes(std::span(neighbours_.contents)));
}

} // namespace candelabra::lighting
