// SPDX-License-Identifier: Apache-2.0
// The lights of a module: the set that the host gave, its edits since, the buffers that hold it,
// and its way to the device.
#pragma once

#include <deque>
#include <functional>
#include <memory>
#include <span>

#include "gpu/recordings.h"
#include "lights/device_lights.h"
#include "lights/influence_box.h"
#include "lights/light_order.h"
#include "lights/light_table.h"
#include "lights/light_types.h"

namespace candelabra::lighting
{

class LightSet
{
public:
    // Makes ready what lights of these types, and room for `capacity` lights, need outside of the
    // set: pipelines, and the buffers of views. It is called while the old set is still in place,
    // and may throw: then the old set stays.
    using Prepare = std::function<void(uint32_t capacity, const LightTypeCounts& types)>;

    // An empty set. `capacity`: CndLightingDesc::lightCapacity. `device` and `recordings` must
    // outlive it.
    LightSet(const gpu::Device& device, gpu::Recordings& recordings, uint32_t capacity,
             Prepare prepare);
    LightSet(const LightSet&) = delete; // its objects point to one another
    LightSet& operator=(const LightSet&) = delete;

    // The calls of the host. They throw gpu::Failure and leave the set as it was, or do all that
    // they are asked for.
    void set(const CndLightSet& set);
    void add(std::span<const CndLight> lights, CndLightId* ids); // `ids`: as many as lights
    void update(std::span<const CndLightId> ids, std::span<const CndLight> lights);
    void remove(std::span<const CndLightId> ids);

    // Copies what has changed since the last recording to the device and sorts it there. The caller
    // puts barriers before and after. `recording`: its number.
    void recordUpload(const gpu::Frame& frame, uint64_t recording) noexcept;
    // Copies what the device found of the lights that the host left on it into LightingCounters.
    void recordDeviceCounts(const gpu::Frame& frame, const gpu::Buffer& counters) const noexcept;

    uint32_t count() const { return count_; }
    uint32_t capacity() const { return capacity_; } // lights for which there is room
    // Identifies the lights: every call that changes them gives the set another number, from 1.
    uint64_t number() const { return number_; }
    const double* origin() const { return origin_; }
    const LightExtent& extent() const { return extent_; }
    const LightTypeCounts& typeCounts() const { return typeCounts_; }
    // Lights by type, 0 for types of which no light has one of these layers.
    LightTypeCounts countsInLayers(uint32_t layers) const;
    // Lights by type, 0 for types of which no light has one of these layers or none reaches the
    // view.
    LightTypeCounts countsInView(const CndCamera& camera, uint32_t layers) const;
    // There are lights that no recording has uploaded yet.
    bool isChanged() const { return pending_ != nullptr; }
    bool hasDeviceLights() const { return deviceLights_.present(); }
    bool deviceLightsChanged() const { return deviceLightsPending_; }

    const gpu::Buffer& records() const { return store_.records; }    // LightRecord, in no order
    const gpu::Buffer& order() const { return store_.sort.keys[0]; } // LightKey: sorted records

private:
    struct Staging {
        gpu::Buffer buffer;
        uint64_t recording = 0; // number of the recording that copies from it, 0: none yet
    };
    // The buffers with a place for every light.
    struct Store {
        gpu::Buffer records; // the device's lights first, then the host's
        LightOrder::State sort;
        std::deque<Staging> staging; // elements stay where they are when it grows
    };
    Store createStore(uint32_t capacity) const;
    gpu::Buffer createStaging(uint32_t capacity) const;
    void requireRoom(const char* what, uint64_t count) const;
    uint32_t capacityFor(uint32_t count) const;
    void grow(uint32_t capacity, bool keepRecords);
    Staging& freeStaging();
    LightTable::Records prepareEdit(const LightTypeCounts& types, size_t edits, size_t added);
    void finishEdit(const LightTypeCounts& types, std::span<const CndLight> lights,
                    size_t edits) noexcept;
    LightTable::Records hostRecords(const Staging& staging) const;
    LightExtent currentExtent() const noexcept;

    const gpu::Device& device_;
    gpu::Recordings& recordings_;
    Prepare prepare_;
    uint32_t firstCapacity_; // room that the set has from the beginning
    LightOrder sorting_;
    DeviceLights deviceLights_;
    LightTable lights_; // the host's
    uint32_t count_ = 0, capacity_ = 0;
    uint64_t number_ = 0;
    double origin_[3]{};
    LightTypeCounts typeCounts_{};
    InfluenceBoxes influenceBoxes_{};
    LightExtent extent_;
    uint32_t editsSinceExtent_ = 0; // edits since `extent_` was estimated

    Store store_;
    Staging* pending_ = nullptr; // holds what no recording has uploaded yet
    bool deviceLightsPending_ = false;
    VkBuffer carriedFrom_ = VK_NULL_HANDLE; // smaller records that the next recording copies
    uint32_t onDevice_ = 0;                 // records that recordings so far have filled
    uint32_t firstRecord_ = 0;              // of the host's lights
};

} // namespace candelabra::lighting
