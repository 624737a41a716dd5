// SPDX-License-Identifier: Apache-2.0
// The lights of a module: the set that the host gave, its edits since, the buffers that hold it,
// and its way to the device.
#pragma once

#include <deque>
#include <functional>
#include <span>

#include "gpu/recordings.h"
#include "lights/device_lights.h"
#include "lights/influence_box.h"
#include "lights/light_order.h"
#include "lights/light_table.h"
#include "lights/light_types.h"
#include "shared/light_edits.h"

namespace candelabra::lighting
{

class LightSet
{
public:
    // Prepares everything outside of the set that lights of these types and room for `capacity`
    // lights need: pipelines, and the buffers of views. It is called while the old set is still in
    // place. If it throws, the old set stays.
    using Prepare = std::function<void(uint32_t capacity, const LightTypeCounts& types)>;

    // Creates an empty set. `capacity`: CndLightingDesc::lightCapacity. `device` and `recordings`
    // must outlive the set.
    LightSet(const gpu::Device& device, gpu::Recordings& recordings, uint32_t capacity,
             Prepare prepare);
    LightSet(const LightSet&) = delete; // its members point to one another
    LightSet& operator=(const LightSet&) = delete;

    // The four calls that hosts make. Each does all that it is asked for, or throws gpu::Failure
    // and leaves the set as it was.
    void set(const CndLightSet& set);
    void add(std::span<const CndLight> lights, CndLightId* ids); // writes one id per light
    void update(std::span<const CndLightId> ids, std::span<const CndLight> lights);
    void remove(std::span<const CndLightId> ids);

    // Records the upload of the lights that have changed since the last recording, and the sort of
    // all lights. The caller puts barriers before and after. `recording`: number of this recording.
    void recordUpload(const gpu::Frame& frame, uint64_t recording) noexcept;
    // Records the copy of the counts of the device's lights (accepted and rejected) into
    // LightingCounters.
    void recordDeviceCounts(const gpu::Frame& frame, const gpu::Buffer& counters) const noexcept;

    uint32_t count() const { return count_; }
    uint32_t capacity() const { return capacity_; } // lights for which there is room
    // Identifies the lights: every call that changes them gives the set another number, from 1.
    uint64_t number() const { return number_; }
    const double* origin() const { return origin_; }
    const LightExtent& extent() const { return extent_; }
    const LightTypeCounts& typeCounts() const { return typeCounts_; }
    // Returns the number of lights of each type, or 0 for a type without a light in these layers.
    LightTypeCounts countsInLayers(uint32_t layers) const;
    // The same, and 0 also for a type whose lights all end outside the camera's view.
    LightTypeCounts countsInView(const CndCamera& camera, uint32_t layers) const;
    // Tells whether there are changes that no recording has uploaded yet.
    bool isChanged() const { return pending_ || polygons_.isChanged(); }
    bool hasDeviceLights() const { return deviceLights_.present(); }
    bool deviceLightsChanged() const { return deviceLightsPending_; }

    const gpu::Buffer& records() const { return store_.records; } // gpu::LightRecord, unsorted
    // gpu::PolygonRecord; some other buffer if there never was a polygon
    const gpu::Buffer& polygons() const
    {
        return polygons_.buffer() ? *polygons_.buffer() : records();
    }
    const gpu::Buffer& order() const { return store_.sort.keys[0]; } // gpu::LightKey, sorted

private:
    struct Staging {
        gpu::Buffer buffer;
        LightTable::Staging memory; // of the buffer
        gpu::Bindings bindings;     // of light_edits
        uint64_t recording = 0;     // number of the recording that copies from it; 0: none yet
    };
    // The buffers whose size depends on the number of lights.
    struct Store {
        gpu::Buffer records; // the device's lights first, then the host's
        LightOrder::State sort;
        std::deque<Staging> staging; // a deque does not move its elements when it grows
    };
    Store createStore(uint32_t capacity) const;
    Staging createStaging(uint32_t capacity, const gpu::Buffer& records) const;
    void requireRoom(const char* what, uint64_t count) const;
    uint32_t capacityFor(uint32_t count) const;
    void grow(uint32_t capacity, bool keepRecords);
    Staging& freeStaging();
    void requireShapes(const char* what, const LightTypeCounts& types) const;
    const LightTable::Staging& prepareEdit(const LightTypeCounts& types, size_t removed,
                                           size_t added);
    void finishEdit(const LightTypeCounts& types, const InfluenceBoxes& boxes,
                    size_t edits) noexcept;
    LightExtent currentExtent() const noexcept;

    const gpu::Device& device_;
    gpu::Recordings& recordings_;
    Prepare prepare_;
    uint32_t firstCapacity_; // the capacity at creation
    LightOrder sorting_;
    gpu::Kernel<gpu::LightEditsParams> lightEdits_;
    DeviceLights deviceLights_;
    PolygonTable polygons_;
    LightTable lights_; // the host's lights
    uint32_t count_ = 0, capacity_ = 0;
    uint64_t number_ = 0;
    double origin_[3]{};
    LightTypeCounts typeCounts_{};
    InfluenceBoxes influenceBoxes_{};
    LightExtent extent_;
    uint32_t editsSinceExtent_ = 0; // edits since `extent_` was estimated

    Store store_;
    Staging* pending_ = nullptr;       // holds the changes that no recording has uploaded yet
    bool deviceLightsPending_ = false; // no recording has filled the device lights' records yet
    // The smaller buffer of records that the next recording copies into the present one, or null.
    VkBuffer carriedFrom_ = VK_NULL_HANDLE;
    uint32_t onDevice_ = 0;    // how many records the recordings so far have filled
    uint32_t firstRecord_ = 0; // index of the first record of the host's lights
};

} // namespace candelabra::lighting
