// SPDX-License-Identifier: Apache-2.0
#include "lights/light_set.h"

#include <algorithm>
#include <cmath>
#include <numeric>

#include "candelabra_shaders.h"
#include "lights/light_limits.h"
#include "lights/pack_lights.h"

namespace candelabra::lighting
{
namespace
{

// Light buffers start with this capacity and grow by half, so that a growing scene reallocates
// rarely. A light takes 64 bytes of records and 68 of staging.
constexpr uint32_t defaultCapacity = 1024;

// The extent of the lights is estimated again when more than one light in editsPerExtent has been
// edited: the estimate costs as much as sorting 1024 numbers four times.
constexpr uint32_t editsPerExtent = 16;

void checkSet(const gpu::Device& device, const CndLightSet& set)
{
    if (set.structSize != sizeof set)
        gpu::failArgument("CndLightSet: structSize is " + std::to_string(set.structSize) +
                          ", this library expects " + std::to_string(sizeof set));
    if (set.count && !set.lights)
        gpu::failArgument("CndLightSet: lights is null but count is " + std::to_string(set.count));
    if (set.deviceLights)
        checkDeviceLights(device, *set.deviceLights);
}

} // namespace

LightSet::LightSet(const gpu::Device& device, gpu::Recordings& recordings, uint32_t capacity,
                   Prepare prepare)
    : device_(device),
      recordings_(recordings),
      prepare_(std::move(prepare)),
      firstCapacity_(capacity ? capacity : defaultCapacity),
      sorting_(device),
      lightEdits_(device, spirv::light_edits_comp),
      deviceLights_(device),
      polygons_(device, recordings),
      lights_(polygons_)
{
    requireRoom("CndLightingDesc: lightCapacity", capacity);
    capacity_ = capacityFor(0);
    store_ = createStore(capacity_);
}

void LightSet::requireRoom(const char* what, uint64_t count) const
{
    if (count > maxLights(device_.limits))
        gpu::failUnsupported(std::string(what) + ": " + std::to_string(count) +
                             " lights are more than the device can take, " +
                             std::to_string(maxLights(device_.limits)));
}

// Throws gpu::Failure if a view could not store the shapes of so many lights with their corners.
void LightSet::requireShapes(const char* what, const LightTypeCounts& types) const
{
    const uint64_t polygons = types[CND_LIGHT_POLYGON];
    const uint64_t lights = capacityFor(std::accumulate(types.begin(), types.end(), 0u));
    const uint64_t room = device_.limits.maxStorageBufferRange / sizeof(gpu::LightShape);
    if (polygons && lights + polygons * gpu::CORNER_SHAPES > room)
        gpu::failUnsupported(std::string(what) + ": " + std::to_string(polygons) +
                             " polygon lights are more than the device can take besides room for " +
                             std::to_string(lights) + " lights");
}

void LightSet::set(const CndLightSet& set)
{
    checkSet(device_, set);
    const CndDeviceLights* const device = set.deviceLights;
    const uint64_t total = uint64_t(set.count) + (device ? device->maxCount : 0);
    requireRoom("CndLightSet", total);
    for (const double o : set.origin)
        if (!std::isfinite(o))
            gpu::failArgument("CndLightSet: origin must be finite");
    const std::span lights(set.lights, set.count);
    auto [types, boxes] = validateLights("CndLightSet", lights);
    if (device) {
        types[device->type] += device->maxCount;
        InfluenceBox& box = boxes[device->type]; // only the device knows where its lights are
        box = endlessBox(box.layers | layersOf(device->layers));
    }
    requireShapes("CndLightSet", types);
    const uint32_t capacity = capacityFor(uint32_t(total));
    recordings_.freeRetired();
    prepare_(capacity, types);
    lights_.reserveSet(set.count);
    polygons_.reserveSet(types[CND_LIGHT_POLYGON]);
    std::shared_ptr<gpu::Bindings> bindings;
    if (device)
        bindings = deviceLights_.prepare(*device, capacity > capacity_);
    if (bindings) // recordings may still use the ones that these replace
        recordings_.retire(deviceLights_.bindings());
    grow(capacity, false);
    Staging& staging = freeStaging(); // nothing after this can fail
    if (device)
        deviceLights_.take(*device, store_.records, std::move(bindings));
    else
        deviceLights_.takeNone();
    firstRecord_ = device ? device->maxCount : 0;
    lights_.set(lights, staging.memory);
    pending_ = &staging;
    carriedFrom_ = VK_NULL_HANDLE;
    onDevice_ = 0;
    typeCounts_ = types;
    count_ = uint32_t(total);
    deviceLightsPending_ = device;
    ++number_;
    std::copy_n(set.origin, 3, origin_);
    extent_ = currentExtent();
    editsSinceExtent_ = 0;
    influenceBoxes_ = boxes;
}

void LightSet::add(std::span<const CndLight> lights, CndLightId* ids)
{
    if (lights.empty())
        return;
    const uint64_t total = uint64_t(count_) + lights.size();
    requireRoom("cndAddLights", total);
    auto [types, boxes] = validateLights("cndAddLights", lights);
    const uint32_t polygons = types[CND_LIGHT_POLYGON];
    for (uint32_t type = 0; type < CND_LIGHT_TYPE_COUNT; ++type)
        types[type] += typeCounts_[type];
    requireShapes("cndAddLights", types);
    polygons_.reserve(polygons, polygons);
    lights_.add(lights, ids, prepareEdit(types, 0, lights.size()));
    finishEdit(types, boxes, lights.size());
}

void LightSet::update(std::span<const CndLightId> ids, std::span<const CndLight> lights)
{
    if (ids.empty())
        return;
    lights_.check("cndUpdateLights", ids);
    const auto [with, boxes] = validateLights("cndUpdateLights", lights, ids);
    LightTypeCounts types = typeCounts_;
    for (const CndLightId id : ids)
        --types[lights_.typeOf(id)];
    for (uint32_t type = 0; type < CND_LIGHT_TYPE_COUNT; ++type)
        types[type] += with[type];
    requireShapes("cndUpdateLights", types);
    size_t newPolygons = 0;
    for (size_t i = 0; with[CND_LIGHT_POLYGON] && i < ids.size(); ++i)
        newPolygons +=
            lights[i].type == CND_LIGHT_POLYGON && lights_.typeOf(ids[i]) != CND_LIGHT_POLYGON;
    polygons_.reserve(with[CND_LIGHT_POLYGON], newPolygons);
    lights_.update(ids, lights, prepareEdit(types, 0, 0));
    finishEdit(types, boxes, ids.size());
}

void LightSet::remove(std::span<const CndLightId> ids)
{
    if (ids.empty())
        return;
    lights_.check("cndRemoveLights", ids);
    LightTypeCounts types = typeCounts_;
    for (const CndLightId id : ids)
        --types[lights_.typeOf(id)];
    lights_.remove(ids, prepareEdit(types, ids.size(), 0));
    finishEdit(types, influenceBoxesOf({}), ids.size());
}

// Does everything in an edit that can fail. Returns where the records are to be staged. `types`:
// the number of lights of each type after the edit.
const LightTable::Staging& LightSet::prepareEdit(const LightTypeCounts& types, size_t removed,
                                                 size_t added)
{
    const uint32_t capacity = capacityFor(count_ + uint32_t(added));
    recordings_.freeRetired();
    prepare_(capacity, types);
    lights_.reserveEdits(removed, added);
    std::shared_ptr<gpu::Bindings> bindings;
    if (deviceLights_.present() && capacity > capacity_)
        bindings = deviceLights_.prepare(deviceLights_.lights(), true);
    grow(capacity, true);
    if (bindings)
        deviceLights_.take(deviceLights_.lights(), store_.records, std::move(bindings));
    pending_ = &freeStaging();
    return pending_->memory;
}

// `boxes`: of the lights that were added or updated.
void LightSet::finishEdit(const LightTypeCounts& types, const InfluenceBoxes& boxes,
                          size_t edits) noexcept
{
    // Lights that were replaced or removed stay in the boxes until their type has no lights.
    const InfluenceBoxes none = influenceBoxesOf({});
    for (uint32_t type = 0; type < CND_LIGHT_TYPE_COUNT; ++type)
        if (!typeCounts_[type])
            influenceBoxes_[type] = none[type];
    widenBoxes(influenceBoxes_, boxes);
    typeCounts_ = types;
    count_ = firstRecord_ + lights_.count();
    ++number_;
    editsSinceExtent_ += uint32_t(edits);
    if (editsSinceExtent_ > lights_.count() / editsPerExtent) {
        extent_ = currentExtent();
        editsSinceExtent_ = 0;
    }
}

LightTypeCounts LightSet::countsInLayers(uint32_t layers) const
{
    LightTypeCounts out = typeCounts_;
    for (uint32_t type = 0; type < CND_LIGHT_TYPE_COUNT; ++type)
        if (!(influenceBoxes_[type].layers & layers))
            out[type] = 0;
    return out;
}

LightTypeCounts LightSet::countsInView(const CndCamera& camera, uint32_t layers) const
{
    LightTypeCounts out = countsInLayers(layers);
    for (uint32_t type = 0; type < CND_LIGHT_TYPE_COUNT; ++type)
        if (out[type] && !reachesView(influenceBoxes_[type], origin_, camera))
            out[type] = 0;
    return out;
}

LightExtent LightSet::currentExtent() const noexcept
{
    const LightExtent host = lights_.extent();
    if (!deviceLights_.present())
        return host;
    uint32_t distant = 0;
    for (uint32_t type = 0; type < CND_LIGHT_TYPE_COUNT; ++type)
        distant += isDistant(type) ? typeCounts_[type] : 0;
    return extentWith(host, lights_.count() - distant, deviceLights_.lights());
}

// Returns a staging buffer that no recording in flight reads.
LightSet::Staging& LightSet::freeStaging()
{
    if (pending_) // its upload is not recorded yet, so it can take more changes
        return *pending_;
    const uint64_t running = recordings_.oldestRunning();
    for (Staging& staging : store_.staging)
        if (staging.recording < running)
            return staging;
    store_.staging.push_back(createStaging(capacity_, store_.records));
    device_.say(CND_MESSAGE_INFO,
                "lights have %u staging buffers of %llu bytes now, because frames in flight "
                "still read the others",
                uint32_t(store_.staging.size()),
                (unsigned long long)store_.staging.back().buffer.size);
    return store_.staging.back();
}

LightSet::Staging LightSet::createStaging(uint32_t capacity, const gpu::Buffer& records) const
{
    // The places begin where every device lets the range of a storage buffer begin.
    constexpr VkDeviceSize alignment = 256;
    const VkDeviceSize bytes = capacity * recordBytes;
    const VkDeviceSize placesAt = (bytes + alignment - 1) / alignment * alignment;
    Staging out;
    out.buffer =
        gpu::createBuffer(device_, "light staging", placesAt + capacity * sizeof(uint32_t),
                          VK_BUFFER_USAGE_STORAGE_BUFFER_BIT | VK_BUFFER_USAGE_TRANSFER_SRC_BIT,
                          gpu::MemoryUse::Upload);
    out.memory = {out.buffer.as<gpu::LightRecord>().first(capacity),
                  out.buffer.as<uint32_t>().subspan(placesAt / sizeof(uint32_t), capacity)};
    out.bindings = lightEdits_.createBindings(1);
    out.bindings.write(
        0, {{.binding = gpu::LIGHT_EDITS_STAGED, .buffer = out.buffer.get(), .range = bytes},
            {.binding = gpu::LIGHT_EDITS_PLACES, .buffer = out.buffer.get(), .offset = placesAt},
            gpu::Binding::of(gpu::LIGHT_EDITS_RECORDS, records)});
    return out;
}

LightSet::Store LightSet::createStore(uint32_t capacity) const
{
    Store store;
    store.records =
        gpu::createBuffer(device_, "light records", capacity * recordBytes,
                          VK_BUFFER_USAGE_STORAGE_BUFFER_BIT | VK_BUFFER_USAGE_TRANSFER_SRC_BIT |
                              VK_BUFFER_USAGE_TRANSFER_DST_BIT,
                          gpu::MemoryUse::Device);
    store.sort = sorting_.createState(capacity, store.records);
    store.staging.push_back(createStaging(capacity, store.records)); // the first upload needs one
    return store;
}

// Returns the capacity for a set of `count` lights, which is at least the present capacity.
uint32_t LightSet::capacityFor(uint32_t count) const
{
    if (capacity_ && count <= capacity_)
        return capacity_;
    const uint32_t wanted = std::max({count, firstCapacity_, capacity_ + capacity_ / 2});
    return std::min(wanted, maxLights(device_.limits));
}

// Replaces the store by a larger one unless the capacity stays. `keepRecords`: the next recording
// copies the old records into the new ones; otherwise all lights are uploaded again.
void LightSet::grow(uint32_t capacity, bool keepRecords)
{
    if (capacity == capacity_)
        return;
    // Everything is allocated before anything is replaced: a failure leaves the old set in place.
    Store store = createStore(capacity);
    const VkBuffer old = store_.records.get();
    Staging& staging = store.staging.front();
    const bool keepStaging = keepRecords && pending_;
    if (keepStaging)
        lights_.stageAnew(staging.memory);
    if (deviceLights_.bindings())
        recordings_.retire(deviceLights_.bindings());
    // The next recording may copy the old records, so it still needs the old store.
    recordings_.replaceAfterNext(store_, std::move(store));
    const uint32_t previous = std::exchange(capacity_, capacity);
    deviceLights_.forgetBindings();
    if (!carriedFrom_ && onDevice_)
        carriedFrom_ = old;
    if (!keepRecords)
        carriedFrom_ = VK_NULL_HANDLE;
    pending_ = keepStaging ? &staging : nullptr;
    device_.say(CND_MESSAGE_INFO,
                "buffers of lights grew from room for %u to room for %u lights; "
                "CndLightingDesc::lightCapacity makes room at creation",
                previous, capacity);
}

void LightSet::recordUpload(const gpu::Frame& frame, uint64_t recording) noexcept
{
    polygons_.recordUpload(frame, recording);
    if (!pending_)
        return;
    pending_->recording = recording;
    const VkBuffer records = store_.records.get();
    if (carriedFrom_) {
        const VkBufferCopy all{.size = onDevice_ * recordBytes};
        device_.CmdCopyBuffer(frame.cmd, carriedFrom_, records, 1, &all);
        frame.barrier();
    }
    const LightTable::Upload upload = lights_.take();
    if (upload.all && upload.records) {
        const VkBufferCopy all{.dstOffset = firstRecord_ * recordBytes,
                               .size = upload.records * recordBytes};
        device_.CmdCopyBuffer(frame.cmd, pending_->buffer.get(), records, 1, &all);
    } else if (upload.records) {
        lightEdits_.dispatchInRows(
            gpu::UntimedFrame(frame), pending_->bindings.set(0),
            {.count = upload.records, .firstRecord = firstRecord_},
            gpu::divideUp(upload.records, gpu::LIGHT_EDITS_GROUP / gpu::LIGHT_EDITS_LANES));
    }
    if (deviceLightsPending_) {
        deviceLights_.recordReset(frame);
        frame.barrier();
        deviceLights_.record(frame);
    }
    if (count_) {
        frame.barrier();
        sorting_.record(frame, store_.sort, typeCounts_, extent_);
    }
    carriedFrom_ = VK_NULL_HANDLE;
    onDevice_ = count_;
    pending_ = nullptr;
    deviceLightsPending_ = false;
}

void LightSet::recordDeviceCounts(const gpu::Frame& frame,
                                  const gpu::Buffer& counters) const noexcept
{
    if (!deviceLights_.present())
        return;
    static_assert(offsetof(gpu::LightingCounters, rejectedLights) ==
                  offsetof(gpu::LightingCounters, deviceLights) +
                      offsetof(gpu::DeviceLightCounts, rejected));
    const VkBufferCopy copy{.dstOffset = offsetof(gpu::LightingCounters, deviceLights),
                            .size = sizeof(gpu::DeviceLightCounts)};
    device_.CmdCopyBuffer(frame.cmd, deviceLights_.counts().get(), counters.get(), 1, &copy);
}

} // namespace candelabra::lighting
