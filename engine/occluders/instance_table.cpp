// SPDX-License-Identifier: Apache-2.0
#include "occluders/instance_table.h"

#include <algorithm>
#include <cmath>

#include <glm/mat3x3.hpp>

#include "gpu/double_single.h"
#include "shared/lighting_data.h"

namespace candelabra::lighting
{
namespace
{

constexpr VkDeviceSize occluderRecordBytes = sizeof(gpu::OccluderRecord);
// A tree is made anew when the surface of its nodes has grown by this factor, or when so large a
// share of its places is without an instance.
constexpr double surfaceGrowth = 2;
constexpr uint32_t removedShare = 2; // one half

glm::dvec3 positionOf(const gpu::OccluderRecord& record)
{
    return glm::dvec3(record.positionHi) + glm::dvec3(record.positionLo);
}

} // namespace

InstanceTable::InstanceTable(const gpu::Device& device, gpu::Recordings& recordings,
                             MeshTable& meshes, uint32_t capacity)
    : meshes_(meshes),
      recordBuffer_(device, recordings, "occluder records", capacity * occluderRecordBytes),
      planBuffer_(device, recordings, "plan of occluders", 0)
{
}

// Any edit may lead to a new tree, so that there must be room for the upload of everything.
void InstanceTable::reserve(size_t removed, size_t added, bool fitted)
{
    const size_t most = added ? count() + added : placed_.size();
    ids_.reserve(removed, added);
    gpu::reserveMore(placed_, added);
    gpu::reserveMore(records_, added);
    const size_t room = placed_.capacity();
    items_.reserve(room);
    sortedPlaced_.reserve(room);
    sortedRecords_.reserve(std::max(room, records_.capacity()));
    coordinates_.reserve(room);
    leaves_.reserve(room);
    parents_.reserve(2 * room);
    if (!most)
        return;
    recordBuffer_.reserve(most * occluderRecordBytes, most * occluderRecordBytes, 1);
    meshes_.reserveInstanceNodes(uint32_t(2 * most));
    if (fitted) {
        const uint32_t words = maxRefitPlanWords(uint32_t(2 * most));
        planWords_.resize(std::max<size_t>(planWords_.size(), words));
        heights_.resize(std::max(heights_.size(), 2 * most));
        planBuffer_.reserve(words * sizeof(uint32_t), words * sizeof(uint32_t), 1);
    }
    isFitted_ = fitted;
}

void InstanceTable::add(std::span<const OccluderInstance> instances, OccluderId* ids) noexcept
{
    if (!count())
        layers_ = 0;
    dropTree();
    for (size_t i = 0; i < instances.size(); ++i) {
        const uint32_t place = places();
        ids[i] = ids_.add(place);
        placed_.push_back({.slot = gpu::IdTable::slotOf(ids[i]), .mesh = instances[i].mesh});
        ++meshes_[instances[i].mesh].users;
        records_.emplace_back();
        write(place, instances[i]);
    }
}

void InstanceTable::update(std::span<const OccluderId> ids,
                           std::span<const OccluderInstance> instances) noexcept
{
    for (size_t i = 0; i < ids.size(); ++i) {
        const uint32_t place = ids_.place(gpu::IdTable::slotOf(ids[i]));
        --meshes_[placed_[place].mesh].users;
        ++meshes_[instances[i].mesh].users;
        placed_[place].mesh = instances[i].mesh;
        write(place, instances[i]);
        fitAncestors(place);
    }
}

void InstanceTable::remove(std::span<const OccluderId> ids) noexcept
{
    for (const OccluderId id : ids)
        remove(gpu::IdTable::slotOf(id));
    if (treeIsMade_ && removed_ > places() / removedShare)
        dropTree();
}

void InstanceTable::remove(uint32_t slot) noexcept
{
    const uint32_t place = ids_.place(slot);
    --meshes_[placed_[place].mesh].users;
    ids_.remove(slot);
    if (treeIsMade_) {
        placed_[place].slot = gpu::IdTable::none;
        records_[place].flags = 0;
        recordBuffer_.markChanged(place * occluderRecordBytes, occluderRecordBytes);
        ++removed_;
        return;
    }
    moveTo(place, places() - 1);
    placed_.pop_back();
    records_.pop_back();
}

void InstanceTable::fit(OccluderMeshId mesh) noexcept
{
    const auto isOfMesh = [&](uint32_t place) {
        return placed_[place].slot != gpu::IdTable::none && placed_[place].mesh == mesh;
    };
    for (uint32_t place = 0; place < places(); ++place)
        if (isOfMesh(place))
            setBox(place);
    for (uint32_t place = 0; treeIsMade_ && place < places(); ++place)
        if (isOfMesh(place))
            fitAncestors(place);
}

void InstanceTable::write(uint32_t place, const OccluderInstance& instance) noexcept
{
    const MeshTable::Mesh& mesh = meshes_[instance.mesh];
    const double* const m = instance.worldFromMesh;
    const gpu::DoubleSingle position(glm::dvec3(m[3], m[7], m[11]));
    gpu::OccluderRecord& record = records_[place];
    for (int row = 0; row < 3; ++row)
        for (int column = 0; column < 3; ++column)
            record.worldFromLocal[column][row] = float(m[4 * row + column]);
    record.positionHi = position.hi;
    record.positionLo = position.lo;
    record.firstNode = mesh.firstNode;
    record.firstTriangle = mesh.firstTriangle;
    const uint32_t layers = instance.layers ? instance.layers : gpu::ALL_LAYERS;
    record.flags = layers | 1u << (gpu::OCCLUDER_LAYERS_SHIFT + instance.occluderLayer);
    record.surfaceError = instance.surfaceError;
    layers_ |= layers;
    setBox(place);
    if (treeIsMade_)
        recordBuffer_.markChanged(place * occluderRecordBytes, occluderRecordBytes);
}

// Sets the box in the world around the box of the mesh. It is wider by what a float32 transform of
// its points may add.
void InstanceTable::setBox(uint32_t place) noexcept
{
    constexpr double rounding = 1e-6;
    const gpu::OccluderRecord& record = records_[place];
    const Box mesh = boxOf(meshes_.nodesOf(meshes_[placed_[place].mesh])[0]);
    const glm::dvec3 low(mesh.low), high(mesh.high);
    glm::dvec3 centre = positionOf(record), half(0);
    for (int axis = 0; axis < 3; ++axis) {
        const glm::dvec3 column(record.worldFromLocal[axis]);
        const double farthest = std::max(std::abs(low[axis]), std::abs(high[axis]));
        centre += column * ((low[axis] + high[axis]) / 2);
        half += glm::abs(column) * ((high[axis] - low[axis]) / 2 + rounding * farthest);
    }
    placed_[place].low = centre - half;
    placed_[place].high = centre + half;
}

// Returns the box of an instance relative to the tree's origin, rounded outwards.
Box InstanceTable::boxAt(uint32_t place) const noexcept
{
    Box box;
    for (int axis = 0; axis < 3; ++axis) {
        box.low[axis] = std::nextafter(float(placed_[place].low[axis] - origin_[axis]), -FLT_MAX);
        box.high[axis] = std::nextafter(float(placed_[place].high[axis] - origin_[axis]), FLT_MAX);
    }
    return box;
}

void InstanceTable::fitAncestors(uint32_t place) noexcept
{
    if (!treeIsMade_)
        return;
    const std::span nodes = meshes_.instanceNodes();
    for (uint32_t node = leaves_[place];; node = parents_[node]) {
        const Box before = boxOf(nodes[node]);
        const Box box = fittedBox(nodes, node, [&](uint32_t i) { return boxAt(i); });
        if (box == before)
            break;
        nodes[node].low = box.low;
        nodes[node].high = box.high;
        meshes_.markInstanceNodes(node, 1);
        surface_ += halfSurface(box) - halfSurface(before);
        if (node == 0)
            break;
    }
    if (surface_ > surfaceGrowth * surfaceAtFirst_)
        dropTree();
}

// Leaves it to the next recording to make the tree anew. Places without an instance vanish.
void InstanceTable::dropTree() noexcept
{
    meshes_.markInstanceNodes(); // also if there is no tree: more nodes may be in use than before
    if (!treeIsMade_)
        return;
    treeIsMade_ = false;
    uint32_t kept = 0;
    for (uint32_t place = 0; place < places(); ++place)
        if (placed_[place].slot != gpu::IdTable::none)
            moveTo(kept++, place);
    placed_.resize(kept);
    records_.resize(kept);
    removed_ = 0;
}

void InstanceTable::moveTo(uint32_t place, uint32_t from) noexcept
{
    if (place == from)
        return;
    placed_[place] = placed_[from];
    records_[place] = records_[from];
    ids_.place(placed_[place].slot) = place;
}

void InstanceTable::makeTree() noexcept
{
    chooseOrigin();
    items_.resize(places());
    for (uint32_t place = 0; place < places(); ++place)
        items_[place] = {boxAt(place), place};
    buildTree(items_, gpu::OCCLUDER_LEAF_INSTANCES, meshes_.instanceNodes());
    sortByTree();
    findParents();
    surface_ = 0;
    for (const gpu::OccluderNode& node : nodes())
        surface_ += halfSurface(boxOf(node));
    surfaceAtFirst_ = surface_;
    recordBuffer_.markChanged(0, records_.size() * occluderRecordBytes);
    treeIsMade_ = true;
    planIsMade_ = false;
}

// Chooses the median of the boxes' centres, so that coordinates relative to it are small wherever
// most instances are.
void InstanceTable::chooseOrigin() noexcept
{
    coordinates_.resize(places());
    const auto median = coordinates_.begin() + places() / 2;
    for (int axis = 0; axis < 3 && places(); ++axis) {
        for (uint32_t place = 0; place < places(); ++place)
            coordinates_[place] = (placed_[place].low[axis] + placed_[place].high[axis]) / 2;
        std::nth_element(coordinates_.begin(), median, coordinates_.end());
        origin_[axis] = *median;
    }
}

void InstanceTable::sortByTree() noexcept
{
    sortedPlaced_.resize(places());
    sortedRecords_.resize(places());
    layers_ = 0;
    for (uint32_t place = 0; place < places(); ++place) {
        sortedPlaced_[place] = placed_[items_[place].index];
        sortedRecords_[place] = records_[items_[place].index];
        ids_.place(sortedPlaced_[place].slot) = place;
        layers_ |= sortedRecords_[place].flags & gpu::ALL_LAYERS;
    }
    placed_.swap(sortedPlaced_);
    records_.swap(sortedRecords_);
}

void InstanceTable::findParents() noexcept
{
    const std::span tree = nodes();
    parents_.assign(tree.size(), 0);
    leaves_.resize(places());
    for (uint32_t node = 0; node < tree.size(); ++node) {
        if (tree[node].leaf)
            for (uint32_t place = leafFirst(tree[node]); place < leafEnd(tree[node]); ++place)
                leaves_[place] = node;
        else
            parents_[node + 1] = parents_[tree[node + 1].skip] = node;
    }
}

void InstanceTable::makePlan() noexcept
{
    plan_ = writeRefitPlan(nodes(), heights_, planWords_);
    planBuffer_.markChanged(0, plan_.words * sizeof(uint32_t));
    planIsMade_ = true;
}

void InstanceTable::recordUpload(const gpu::Frame& frame, uint64_t recording) noexcept
{
    if (!treeIsMade_)
        makeTree();
    if (isFitted_ && !planIsMade_)
        makePlan();
    recordBuffer_.recordUpload(frame, recording, std::as_bytes(std::span(records_)));
    planBuffer_.recordUpload(frame, recording,
                             std::as_bytes(std::span(planWords_).first(plan_.words)));
}

} // namespace candelabra::lighting
