// SPDX-License-Identifier: Apache-2.0
// How the light set of a Lighting changes: edits, the buffers they need, and their way to the
// device.
#include <algorithm>
#include <cstring>

#include "lighting/lighting.h"

namespace candelabra::lighting
{
namespace
{

// Light buffers start with this capacity and grow by half, so that a growing scene reallocates
// rarely; the smallest is 64 + 64 bytes per light.
constexpr uint32_t defaultCapacity = 1024;

// Where lights are is looked up again after as many edits as this share of them: that costs as much
// as sorting 1024 numbers four times.
constexpr uint32_t editsPerExtent = 16;

constexpr VkDeviceSize recordBytes = sizeof(gpu::LightRecord);

} // namespace

void Lighting::addLights(std::span<const CndLight> lights, CndLightId* ids)
{
    if (lights.empty())
        return;
    const uint64_t total = uint64_t(lightCount_) + lights.size();
    requireRoom("cndAddLights", total);
    validateLights(lights);
    LightTypeCounts counts = countTypes(lights);
    for (uint32_t type = 0; type < CND_LIGHT_TYPE_COUNT; ++type)
        counts[type] += typeCounts_[type];
    const LightTable::Records staging = prepareEdit(counts, lights.size(), lights.size());
    for (size_t i = 0; i < lights.size(); ++i)
        ids[i] = lights_.add(lights[i], staging);
    finishEdit(counts, lights, lights.size());
}

void Lighting::updateLights(std::span<const CndLightId> ids, std::span<const CndLight> lights)
{
    if (ids.empty())
        return;
    lights_.check("cndUpdateLights", ids);
    validateLights(lights);
    LightTypeCounts counts = typeCounts_;
    for (size_t i = 0; i < ids.size(); ++i) {
        --counts[lights_.typeOf(ids[i])];
        ++counts[lights[i].type];
    }
    const LightTable::Records staging = prepareEdit(counts, ids.size(), 0);
    for (size_t i = 0; i < ids.size(); ++i)
        lights_.update(ids[i], lights[i], staging);
    finishEdit(counts, lights, ids.size());
}

void Lighting::removeLights(std::span<const CndLightId> ids)
{
    if (ids.empty())
        return;
    lights_.check("cndRemoveLights", ids);
    LightTypeCounts counts = typeCounts_;
    for (const CndLightId id : ids)
        --counts[lights_.typeOf(id)];
    const LightTable::Records staging = prepareEdit(counts, ids.size(), 0);
    for (const CndLightId id : ids)
        lights_.remove(id, staging);
    finishEdit(counts, {}, ids.size());
}

void Lighting::requirePipelines(const LightTypeCounts& counts)
{
    for (uint32_t type = 0; type < CND_LIGHT_TYPE_COUNT; ++type)
        if (counts[type] && kernels_.shade.require(type))
            device_.say(CND_MESSAGE_INFO,
                        "lights of CndLightType %u are new: their pipelines were made now, while "
                        "the lights were set; CndLightingDesc::lightTypes makes them at creation",
                        type);
}

// All of an edit that can fail. `counts`: of the set with it.
LightTable::Records Lighting::prepareEdit(const LightTypeCounts& counts, size_t edits, size_t added)
{
    const uint32_t count = lightCount_ + uint32_t(added);
    requirePipelines(counts);
    freeRetired();
    lights_.reserveEdits(edits, added);
    std::shared_ptr<gpu::Bindings> bindings;
    if (deviceLights_.present() && count > lightCapacity_)
        bindings = deviceLights_.prepare(deviceLights_.lights(), true);
    grow(count, counts, true);
    if (bindings)
        deviceLights_.take(deviceLights_.lights(), store_.records, std::move(bindings));
    pending_ = &freeStaging();
    return hostRecords(*pending_);
}

void Lighting::finishEdit(const LightTypeCounts& counts, std::span<const CndLight> lights,
                          size_t edits) noexcept
{
    // What was replaced or removed stays in the boxes, until a type has no lights.
    const ReachBoxes none = reachOf({});
    for (uint32_t type = 0; type < CND_LIGHT_TYPE_COUNT; ++type)
        if (!typeCounts_[type])
            reach_[type] = none[type];
    widen(reach_, reachOf(lights));
    typeCounts_ = counts;
    lightCount_ = firstRecord_ + lights_.count();
    ++lightSet_;
    editsSinceExtent_ += uint32_t(edits);
    if (editsSinceExtent_ > lights_.count() / editsPerExtent) {
        extent_ = currentExtent();
        editsSinceExtent_ = 0;
    }
}

LightTable::Records Lighting::hostRecords(const Staging& staging) const
{
    return staging.buffer.as<gpu::LightRecord>().subspan(firstRecord_);
}

LightExtent Lighting::currentExtent() const noexcept
{
    const LightExtent host = lights_.extent();
    if (!deviceLights_.present())
        return host;
    const uint32_t distant =
        typeCounts_[CND_LIGHT_DIRECTIONAL] + typeCounts_[CND_LIGHT_DISTANT_SPHERE];
    return extentWith(host, lights_.count() - distant, deviceLights_.lights());
}

Lighting::Staging& Lighting::freeStaging()
{
    if (pending_) // never recorded: more of the same
        return *pending_;
    const uint64_t running = oldest(&View::oldestRunning);
    for (Staging& staging : store_.staging)
        if (staging.recording < running)
            return staging;
    store_.staging.emplace_back(createStaging(lightCapacity_));
    device_.say(CND_MESSAGE_INFO,
                "lights have %zu staging buffers of %llu bytes now, because frames in flight "
                "still read the others",
                store_.staging.size(), (unsigned long long)store_.staging.back().buffer.size);
    return store_.staging.back();
}

gpu::Buffer Lighting::createStaging(uint32_t capacity) const
{
    return gpu::createBuffer(device_, "light staging", capacity * recordBytes,
                             VK_BUFFER_USAGE_TRANSFER_SRC_BIT, gpu::MemoryUse::Upload);
}

Lighting::Store Lighting::createStore(uint32_t capacity) const
{
    Store store;
    store.records =
        gpu::createBuffer(device_, "light records", capacity * recordBytes,
                          VK_BUFFER_USAGE_STORAGE_BUFFER_BIT | VK_BUFFER_USAGE_TRANSFER_SRC_BIT |
                              VK_BUFFER_USAGE_TRANSFER_DST_BIT,
                          gpu::MemoryUse::Device);
    store.sort = kernels_.order.createState(capacity, store.records);
    store.staging.emplace_back(createStaging(capacity)); // what fills the new records
    return store;
}

void Lighting::grow(uint32_t count, const LightTypeCounts& counts, bool keepRecords)
{
    if (lightCapacity_ && count <= lightCapacity_) {
        for (View* view : views_)
            view->makeRoom(counts);
        return;
    }
    const uint32_t least = desc_.lightCapacity ? desc_.lightCapacity : defaultCapacity;
    const uint32_t wanted = std::max({count, least, lightCapacity_ + lightCapacity_ / 2});
    const uint32_t previous = lightCapacity_;
    const uint32_t capacity = std::min(wanted, maxLights(device_.limits));
    // Everything is allocated before anything is replaced: a failure leaves the old set in place.
    Store store = createStore(capacity);
    const VkBuffer old = store_.records.get();
    Staging& staging = store.staging.front();
    const bool keepStaging = keepRecords && pending_;
    if (keepStaging)
        std::memcpy(staging.buffer.mapped, pending_->buffer.mapped, lightCount_ * recordBytes);
    try {
        lightCapacity_ = capacity;
        for (View* view : views_)
            view->makeRoom(counts);
        if (deviceLights_.bindings())
            retired_.push_back({deviceLights_.bindings(), recordings_});
        replace(store_, std::move(store), recordings_ + 1); // which may copy the old records
    } catch (...) {
        lightCapacity_ = previous;
        throw;
    }
    deviceLights_.forgetBindings();
    if (!carriedFrom_ && onDevice_)
        carriedFrom_ = old;
    if (!keepRecords)
        carriedFrom_ = VK_NULL_HANDLE;
    pending_ = keepStaging ? &staging : nullptr;
    if (previous)
        device_.say(CND_MESSAGE_INFO,
                    "buffers of lights grew from room for %u to room for %u lights; "
                    "CndLightingDesc::lightCapacity makes room at creation",
                    previous, capacity);
}

void Lighting::recordUpload(const gpu::Frame& frame, uint64_t recording) noexcept
{
    if (!pending_)
        return;
    pending_->recording = recording;
    const VkBuffer records = store_.records.get();
    if (carriedFrom_) {
        const VkBufferCopy all{.size = onDevice_ * recordBytes};
        device_.CmdCopyBuffer(frame.cmd, carriedFrom_, records, 1, &all);
        frame.barrier();
    }
    const auto& [moves, uploads] = lights_.take(firstRecord_);
    if (!moves.empty()) {
        device_.CmdCopyBuffer(frame.cmd, records, records, uint32_t(moves.size()), moves.data());
        frame.barrier();
    }
    if (!uploads.empty())
        device_.CmdCopyBuffer(frame.cmd, pending_->buffer.get(), records, uint32_t(uploads.size()),
                              uploads.data());
    if (deviceLightsPending_) {
        deviceLights_.recordReset(frame);
        frame.barrier();
        deviceLights_.record(frame);
    }
    if (lightCount_) {
        frame.barrier();
        kernels_.order.record(frame, store_.sort, lightCount_, extent_);
    }
    carriedFrom_ = VK_NULL_HANDLE;
    onDevice_ = lightCount_;
    pending_ = nullptr;
    deviceLightsPending_ = false;
}

} // namespace candelabra::lighting
